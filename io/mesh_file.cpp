#include "percale/mesh_file.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

/// Bytes gathered before they go to the file.
constexpr std::size_t kBlock = std::size_t{1} << 16;
/// Digits that bring a coordinate of a mesh back to a nanometre within a metre.
constexpr int kMeshDigits = 9;
/// Digits that bring any double back to the bit.
constexpr int kTableDigits = 17;

/// Text and little-endian numbers on their way to a file.
class Sink {
 public:
  explicit Sink(AtomicFile& file) : file_(file) { bytes_.reserve(kBlock + 512); }

  void Text(std::string_view text) { Append(text.data(), text.size()); }
  void Char(char c) { Append(&c, 1); }
  /// As printf's %.*g in the C locale, whatever the program's locale is.
  void Decimal(double number, int digits) {
    char text[40];
    const int length = std::snprintf(text, sizeof text, "%.*g", digits, number);
    for (int i = 0; i < length; ++i) {
      const char c = text[i];
      if (c == '+' || c == '-' || c == 'e' || IsDigit(c)) continue;
      text[i] = '.';  // another decimal mark, perhaps of several bytes
      int end = i + 1;
      while (end < length && (static_cast<unsigned char>(text[end]) & 0x80) != 0) ++end;
      Append(text, std::size_t(i) + 1);
      Append(text + end, std::size_t(length - end));
      return;
    }
    Append(text, std::size_t(length));
  }
  void Whole(std::int64_t number) { Text(std::to_string(number)); }
  void Byte(std::uint8_t number) { Char(static_cast<char>(number)); }
  void Int32(std::int32_t number) { Little(static_cast<std::uint32_t>(number), 4); }
  void Float(float number) {
    std::uint32_t bits;
    std::memcpy(&bits, &number, 4);
    Little(bits, 4);
  }
  void Double(double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, 8);
    Little(bits, 8);
  }
  Status Flush() {
    const Status status = file_.Write(bytes_);
    bytes_.clear();
    return failed_ ? *failed_ : status;
  }

 private:
  void Little(std::uint64_t number, int bytes) {
    char text[8];
    for (int i = 0; i < bytes; ++i) text[i] = static_cast<char>((number >> (8 * i)) & 0xff);
    Append(text, std::size_t(bytes));
  }
  void Append(const char* data, std::size_t size) {
    bytes_.append(data, size);
    if (bytes_.size() < kBlock) return;
    if (Status status = file_.Write(bytes_); !status && !failed_) failed_ = std::move(status);
    bytes_.clear();
  }

  AtomicFile& file_;
  std::string bytes_;
  std::optional<Status> failed_;
};

std::int64_t VertexCount(const World& world) {
  std::int64_t count = 0;
  for (int c = 0; c < world.ClothCount(); ++c) count += std::int64_t(world.Cloth(c).positions().size());
  return count;
}

std::int64_t TriangleCount(const World& world) {
  std::int64_t count = 0;
  for (int c = 0; c < world.ClothCount(); ++c) count += std::int64_t(world.Cloth(c).triangles().size());
  return count;
}

/// Vertex normals of one cloth, weighted by area.
std::vector<Vec3> Normals(const ClothView& cloth) {
  const auto x = cloth.positions();
  std::vector<Vec3> normals(x.size());
  for (const Triangle& t : cloth.triangles()) {
    const Vec3 n = Cross(x[std::size_t(t.b)] - x[std::size_t(t.a)], x[std::size_t(t.c)] - x[std::size_t(t.a)]);
    for (const std::int32_t v : {t.a, t.b, t.c}) normals[std::size_t(v)] += n;
  }
  for (Vec3& n : normals) n = UnitOr(n, {0, 0, 1});
  return normals;
}

void WriteObj(Sink& sink, const World& world) {
  sink.Text("# Percale, in metres, y up\n");
  std::int64_t first = 1;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    sink.Text("o cloth");
    sink.Whole(c);
    sink.Char('\n');
    for (const Vec3& x : cloth.positions()) {
      sink.Text("v ");
      sink.Decimal(x.x, kMeshDigits);
      sink.Char(' ');
      sink.Decimal(x.y, kMeshDigits);
      sink.Char(' ');
      sink.Decimal(x.z, kMeshDigits);
      sink.Char('\n');
    }
    for (const Vec2& uv : cloth.uv()) {
      sink.Text("vt ");
      sink.Decimal(uv.x, kMeshDigits);
      sink.Char(' ');
      sink.Decimal(uv.y, kMeshDigits);
      sink.Char('\n');
    }
    for (const Vec3& n : Normals(cloth)) {
      sink.Text("vn ");
      sink.Decimal(n.x, 6);
      sink.Char(' ');
      sink.Decimal(n.y, 6);
      sink.Char(' ');
      sink.Decimal(n.z, 6);
      sink.Char('\n');
    }
    for (const Triangle& t : cloth.triangles()) {
      sink.Char('f');
      for (const std::int32_t v : {t.a, t.b, t.c}) {
        const std::string number = std::to_string(first + v);
        sink.Char(' ');
        sink.Text(number);
        sink.Char('/');
        sink.Text(number);
        sink.Char('/');
        sink.Text(number);
      }
      sink.Char('\n');
    }
    first += std::int64_t(cloth.positions().size());
  }
}

void WritePly(Sink& sink, const World& world, int frame) {
  sink.Text("ply\nformat binary_little_endian 1.0\ncomment Percale, in metres, y up, frame ");
  sink.Whole(frame);
  sink.Text("\nelement vertex ");
  sink.Whole(VertexCount(world));
  sink.Text(
      "\nproperty double x\nproperty double y\nproperty double z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face ");
  sink.Whole(TriangleCount(world));
  sink.Text("\nproperty list uchar int vertex_indices\nend_header\n");
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    const auto x = cloth.positions();
    const std::vector<Vec3> normals = Normals(cloth);
    for (std::size_t v = 0; v < x.size(); ++v) {
      for (const double value : {x[v].x, x[v].y, x[v].z}) sink.Double(value);
      for (const double value : {normals[v].x, normals[v].y, normals[v].z}) sink.Float(float(value));
      for (const double value : {cloth.uv()[v].x, cloth.uv()[v].y}) sink.Float(float(value));
    }
  }
  std::int32_t first = 0;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    for (const Triangle& t : cloth.triangles()) {
      sink.Byte(3);
      for (const std::int32_t v : {t.a, t.b, t.c}) sink.Int32(first + v);
    }
    first += std::int32_t(cloth.positions().size());
  }
}

void WriteRows(Sink& sink, const World& world, int frame) {
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    const std::string start = std::to_string(frame) + "," + std::to_string(c) + ",";
    std::int64_t vertex = 0;
    for (const Vec3& x : cloth.positions()) {
      sink.Text(start);
      sink.Whole(vertex++);
      for (const double value : {x.x, x.y, x.z}) {
        sink.Char(',');
        sink.Decimal(value, kTableDigits);
      }
      sink.Char('\n');
    }
  }
}

// The header of PointCache2: 12 bytes of signature, int32 version, int32 points, float start, float
// time between samples, int32 samples; then three floats per point and sample.
constexpr std::string_view kPc2Signature{"POINTCACHE2\0", 12};
constexpr long kPc2SamplesAt = 28;

void WritePc2Header(Sink& sink, std::int32_t points, double start, double frameSeconds) {
  sink.Text(kPc2Signature);
  sink.Int32(1);
  sink.Int32(points);
  sink.Float(float(start));
  sink.Float(float(frameSeconds));
  sink.Int32(0);  // known at the end
}

/// "name_0001.obj" for name.obj.
fs::path Numbered(const fs::path& file, int frame) {
  char number[24];
  std::snprintf(number, sizeof number, "_%04d", frame);
  fs::path name = file.stem();
  name += number;
  name += file.extension();
  return file.parent_path() / name;
}

/// The positions are numbers, and within the range of the format.
Status CheckPositions(const World& world, const fs::path& file, int frame, double limit) {
  for (int c = 0; c < world.ClothCount(); ++c) {
    const auto x = world.Cloth(c).positions();
    for (std::size_t v = 0; v < x.size(); ++v) {
      const Vec3& p = x[v];
      if (IsFinite(p) && std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit) continue;
      return MakeError(PathText(file), "frame " + std::to_string(frame) + " was not written: cloth " +
                                           std::to_string(c) + ", vertex " + std::to_string(v) + " is at (" +
                                           FormatNumber(p.x) + ", " + FormatNumber(p.y) + ", " + FormatNumber(p.z) +
                                           "), beyond what the file can hold");
    }
  }
  return Ok();
}

}  // namespace

struct CacheWriter::Impl {
  struct Frame {
    AtomicFile file;
    int number;
  };

  fs::path target;
  CacheKind kind = CacheKind::Csv;
  double frameSeconds = 0;
  std::vector<Frame> files;        // one, or one per frame
  std::optional<AtomicFile> mesh;  // beside a .pc2
  std::int64_t vertices = 0;       // of every frame
  std::int64_t triangles = 0;
  int frames = 0;
  bool failed = false;

  bool OneFilePerFrame() const { return kind == CacheKind::Obj || kind == CacheKind::Ply; }
  fs::path MeshPath() const {
    fs::path path = target;
    path += ".obj";
    return path;
  }

  Status Begin(const World& world, int frame) {
    vertices = VertexCount(world);
    triangles = TriangleCount(world);
    if (vertices > std::numeric_limits<std::int32_t>::max()) {
      return MakeError(PathText(target),
                       "cannot hold " + std::to_string(vertices) + " vertices; the format ends at 2147483647");
    }
    if (kind == CacheKind::Csv) return files[0].file.Write("frame,cloth,vertex,x,y,z\n");
    if (kind != CacheKind::Pc2) return Ok();
    Sink header(files[0].file);
    const double start = frame == 0 ? 0 : world.report().time;
    WritePc2Header(header, std::int32_t(vertices), start, frameSeconds);
    if (Status status = header.Flush(); !status) return status;
    auto beside = AtomicFile::Create(MeshPath());
    if (!beside) return beside.diagnostics();
    mesh = std::move(*beside);
    Sink sink(*mesh);
    WriteObj(sink, world);
    if (Status status = sink.Flush(); !status) return status;
    return mesh->Close();
  }

  Status Add(const World& world, int frame) {
    if (VertexCount(world) != vertices || TriangleCount(world) != triangles) {
      return MakeError(PathText(target), "frame " + std::to_string(frame) +
                                             " has another number of vertices than the first: " +
                                             std::to_string(VertexCount(world)) + " and " + std::to_string(vertices));
    }
    const double limit =
        kind == CacheKind::Pc2 ? double(std::numeric_limits<float>::max()) : std::numeric_limits<double>::max();
    if (Status status = CheckPositions(world, target, frame, limit); !status) return status;

    if (OneFilePerFrame()) {
      if (frames > 0) {
        if (files[0].file.straight()) {
          return MakeError(PathText(target),
                           "a device or pipe takes one frame of this format; write .csv, or to a file");
        }
        auto next = AtomicFile::Create(Numbered(target, frame));
        if (!next) return next.diagnostics();
        files.push_back({std::move(*next), frame});
      }
      files.back().number = frame;
    }
    AtomicFile& file = files.back().file;
    Sink sink(file);
    switch (kind) {
      case CacheKind::Csv:
        WriteRows(sink, world, frame);
        break;
      case CacheKind::Obj:
        WriteObj(sink, world);
        break;
      case CacheKind::Ply:
        WritePly(sink, world, frame);
        break;
      case CacheKind::Pc2:
        for (int c = 0; c < world.ClothCount(); ++c) {
          for (const Vec3& x : world.Cloth(c).positions()) {
            for (const double value : {x.x, x.y, x.z}) sink.Float(float(value));
          }
        }
        break;
    }
    Status status = sink.Flush();
    if (status && OneFilePerFrame()) status = file.Close();
    if (status) ++frames;
    return status;
  }
};

CacheWriter::CacheWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CacheWriter::~CacheWriter() = default;
CacheWriter::CacheWriter(CacheWriter&&) noexcept = default;
CacheWriter& CacheWriter::operator=(CacheWriter&&) noexcept = default;

Result<CacheWriter> CacheWriter::Open(const fs::path& file, double frameSeconds) {
  const auto kind = CacheKindOf(file);
  if (!kind) {
    const std::string extension = PathText(file.extension());
    return MakeError(PathText(file), "expected a file that ends in .csv, .obj, .ply or .pc2, got " +
                                         (extension.empty() ? "no extension" : Quote(extension, 20)));
  }
  auto impl = std::make_unique<Impl>();
  impl->target = file;
  impl->kind = *kind;
  impl->frameSeconds = frameSeconds;
  auto first = AtomicFile::Create(file);
  if (!first) return first.diagnostics();
  impl->files.push_back({std::move(*first), 0});
  return CacheWriter(std::move(impl));
}

Status CacheWriter::Add(const World& world, int frame) {
  if (impl_->failed) return MakeError(PathText(impl_->target), "an earlier frame could not be written");
  Status status = Ok();
  if (impl_->frames == 0) status = impl_->Begin(world, frame);
  if (status) status = impl_->Add(world, frame);
  impl_->failed = !status;
  return status;
}

Result<std::vector<fs::path>> CacheWriter::Finish() {
  const std::unique_ptr<Impl> impl = std::exchange(impl_, std::make_unique<Impl>());
  impl_->failed = true;
  impl_->target = impl->target;
  if (impl->failed) return MakeError(PathText(impl->target), "a frame could not be written");
  if (impl->frames == 0) return MakeError(PathText(impl->target), "there are no frames to write");

  if (impl->kind == CacheKind::Pc2) {
    const auto samples = static_cast<std::uint32_t>(impl->frames);
    std::array<unsigned char, 4> bytes{};
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<unsigned char>((samples >> (8 * i)) & 0xff);
    if (Status status = impl->files[0].file.WriteAt(kPc2SamplesAt, bytes.data(), bytes.size()); !status) {
      return status.diagnostics();
    }
  }
  // All data is on the disk before the first file appears.
  for (Impl::Frame& frame : impl->files) {
    if (Status status = frame.file.Close(); !status) return status.diagnostics();
  }
  std::vector<fs::path> written;
  const auto place = [&](AtomicFile& file, const fs::path& path) {
    Status status = file.target() == path ? file.Commit() : file.CommitAs(path);
    if (status) written.push_back(path);
    return status;
  };
  for (Impl::Frame& frame : impl->files) {
    const fs::path path = impl->files.size() > 1 ? Numbered(impl->target, frame.number) : impl->target;
    if (Status status = place(frame.file, path); !status) return status.diagnostics();
  }
  if (impl->mesh) {
    if (Status status = place(*impl->mesh, impl->MeshPath()); !status) return status.diagnostics();
  }
  return written;
}

}  // namespace percale
