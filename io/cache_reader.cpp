// CacheReader: the frames of a file with their triangles. Nothing in a file is believed before it is checked.

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/index.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"
#include "io/mesh_source.h"
#include "io/point_cache.h"
#include "percale/mesh_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

/// A mesh as it stands in a file.
struct ReadMesh {
  std::vector<Vec3> positions;
  std::vector<std::int32_t> corners;     // of the polygons, one after the other
  std::vector<std::size_t> polygonEnds;  // where the corners of each end
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> clothBegins;  // the first vertex of each cloth

  bool IsLike(const ReadMesh& o) const {
    return positions.size() == o.positions.size() && corners == o.corners && polygonEnds == o.polygonEnds;
  }
};

/// Where the vertices of each cloth begin: the objects "cloth0", "cloth1", ... that CacheWriter writes, if all
/// triangles keep to them.
std::vector<std::int32_t> ClothBegins(const PolygonSoup& soup) {
  const std::vector<std::int32_t> one = {0};
  std::vector<std::int32_t> begins;
  std::int32_t end = 0;
  for (std::size_t g = 0; g < soup.groups.size(); ++g) {
    const PolygonSoup::Group& group = soup.groups[g];
    if (group.name != "cloth" + std::to_string(g) || group.polygons.size() != 1) return one;
    const auto [first, last] = group.polygons[0];
    const auto corner = [&](std::size_t c) { return soup.corners.begin() + std::ptrdiff_t(c); };
    const auto [lowest, highest] =
        std::minmax_element(corner(soup.PolygonBegin(first)), corner(soup.polygonEnds[last - 1]));
    if (*lowest < end) return one;
    begins.push_back(begins.empty() ? 0 : *lowest);
    end = *highest + 1;
  }
  return begins.empty() || soup.groups.front().polygons[0].first != 0 ? one : begins;
}

Result<ReadMesh> LoadPolygons(const fs::path& file, CacheKind kind) {
  const auto source = MeshSource::Load(file);
  if (!source) return source.diagnostics();
  MeshMessages messages;
  PolygonSoup soup =
      kind == CacheKind::Ply ? ReadPlyPolygons(*source, 1, messages) : ReadObjPolygons(*source, 1, messages);
  if (messages.full()) messages.Add(MakeNote(PathText(file), "reading stopped here; there may be more errors"));
  if (messages.failed()) return messages.Take();
  ReadMesh mesh;
  mesh.triangles = TrianglesOf(soup, *source, messages);
  for (const Triangle& t : mesh.triangles) {
    if (t.a != t.b && t.b != t.c && t.c != t.a) continue;
    return MakeError(PathText(file), "a triangle has the same vertex twice (" + std::to_string(t.a) + ", " +
                                         std::to_string(t.b) + ", " + std::to_string(t.c) +
                                         ", counted from 0); expected three different ones; remove such triangles");
  }
  std::vector<bool> used(soup.positions.size());
  for (const std::int32_t v : soup.corners) used[Index(v)] = true;
  if (const auto loose = std::count(used.begin(), used.end(), false); loose > 0) {
    messages.Add(MakeWarning(PathText(file), std::to_string(loose) + (loose == 1 ? " vertex is" : " vertices are") +
                                                 " of no triangle; the file may have been cut short"));
  }
  mesh.clothBegins = ClothBegins(soup);
  mesh.positions = std::move(soup.positions);
  mesh.corners = std::move(soup.corners);
  mesh.polygonEnds = std::move(soup.polygonEnds);
  return {std::move(mesh), messages.Take()};
}

struct NumberedFile {
  int number = 0;
  fs::path path;
};

/// The files name_0001.obj and so on beside a name.obj, in the order of their numbers.
std::vector<NumberedFile> FindNumbered(const fs::path& file) {
  std::vector<NumberedFile> found;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const std::string start = PathText(file.stem()) + "_", extension = LowerExtension(file);
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const fs::path name = at->path().filename();
    const std::string stem = PathText(name.stem());
    if (LowerExtension(name) != extension || stem.compare(0, start.size(), start) != 0) continue;
    const std::string digits = stem.substr(start.size());
    constexpr std::size_t kFewest = 4, kMost = 9;
    if (digits.size() < kFewest || digits.size() > kMost) continue;
    if (digits.find_first_not_of("0123456789") != std::string::npos) continue;
    found.push_back({std::stoi(digits), file.has_parent_path() ? folder / name : name});
  }
  std::sort(found.begin(), found.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  return found;
}

struct CloseFile {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};

}  // namespace

struct CacheReader::Impl {
  fs::path file;
  CacheKind kind = CacheKind::Obj;
  ReadMesh mesh;  // of the first frame; of a .pc2 the one beside it
  std::vector<Cloth> cloths;
  int frames = 1;
  int next = 0;

  std::vector<NumberedFile> files;               // of meshes, one per frame
  std::unique_ptr<std::FILE, CloseFile> stream;  // of a .pc2
  std::vector<unsigned char> bytes;              // of one of its frames

  void MakeCloths() {
    const std::vector<std::int32_t>& begins = mesh.clothBegins;
    for (std::size_t c = 0; c < begins.size(); ++c) {
      const auto end = c + 1 < begins.size() ? begins[c + 1] : static_cast<std::int32_t>(mesh.positions.size());
      cloths.push_back({end - begins[c], {}});
    }
    for (const Triangle& t : mesh.triangles) {
      const auto cloth =
          Index(static_cast<std::int32_t>(std::upper_bound(begins.begin(), begins.end(), t.a) - begins.begin())) - 1;
      cloths[cloth].triangles.push_back({t.a - begins[cloth], t.b - begins[cloth], t.c - begins[cloth]});
    }
  }

  Status OpenMeshes() {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) files = FindNumbered(file);
    if (files.empty()) files.push_back({0, file});
    frames = static_cast<int>(files.size());
    auto read = LoadPolygons(files[0].path, kind);
    if (!read) return read.diagnostics();
    mesh = std::move(*read);
    return {std::monostate{}, read.diagnostics()};
  }

  Status OpenPointCache() {
    std::error_code code;
    const fs::file_status status = fs::status(file, code);
    const std::string name = PathText(file);
    if (!fs::exists(status)) return MakeError(name, "there is no such file; check the name and the folder");
    if (!fs::is_regular_file(status))
      return MakeError(
          name, fs::is_directory(status) ? "expected a file, got a folder" : "expected a file, got a device or pipe");
    const std::uint64_t size = fs::file_size(file, code);
    errno = 0;
    stream.reset(OpenFile(file, "rb"));
    if (!stream || code) return MakeError(name, "cannot be read: " + std::generic_category().message(errno));
    std::array<unsigned char, kPointCacheHeadBytes> head{};
    if (size < head.size() || std::fread(head.data(), 1, head.size(), stream.get()) != head.size()) {
      return MakeError(name, "ends after " + std::to_string(size) +
                                 " bytes, expected a PointCache2 header of 32 bytes; it was cut short");
    }
    const auto parsed = ParsePointCacheHead(head, size, name);
    if (!parsed) return parsed.diagnostics();
    if (parsed->frames == 0) return MakeError(name, "expected at least one frame, got none");
    frames = parsed->frames;

    fs::path beside = file;
    beside += ".obj";
    if (!fs::exists(beside, code)) {
      return MakeError(PathText(beside), "there is no such file; " + Quote(PathText(file.filename())) +
                                             " holds no triangles, and its mesh is looked for under this name");
    }
    auto read = LoadPolygons(beside, CacheKind::Obj);
    if (!read) return read.diagnostics();
    mesh = std::move(*read);
    if (mesh.positions.size() != Index(parsed->points)) {
      return MakeError(name, "expected as many points per frame as " + Quote(PathText(beside.filename())) +
                                 " has vertices, " + std::to_string(mesh.positions.size()) + ", got " +
                                 std::to_string(parsed->points) + "; one of the two files is of another run");
    }
    bytes.resize(mesh.positions.size() * kPointCachePointBytes);
    return {std::monostate{}, read.diagnostics()};
  }

  Result<int> NextMesh(std::vector<Vec3>& positions) {
    const NumberedFile& frame = files[Index(next)];
    if (next++ == 0) {
      positions = mesh.positions;
      return frame.number;
    }
    auto read = LoadPolygons(frame.path, kind);
    if (!read) return read.diagnostics();
    if (!read->IsLike(mesh)) {
      const auto counts = [](const ReadMesh& m) {
        return std::to_string(m.positions.size()) + " vertices and " + std::to_string(m.polygonEnds.size()) +
               (m.polygonEnds.size() == 1 ? " face" : " faces");
      };
      return MakeError(PathText(frame.path), "expected the mesh of " + Quote(PathText(files[0].path.filename())) +
                                                 " with its vertices moved, " + counts(mesh) +
                                                 ", got another one, of " + counts(*read));
    }
    positions = std::move(read->positions);
    return {frame.number, read.diagnostics()};
  }

  Result<int> NextOfPointCache(std::vector<Vec3>& positions) {
    const int frame = next++;
    if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
      return MakeError(PathText(file), "reading stopped within frame " + std::to_string(frame) +
                                           "; the file changes or its disk fails");
    }
    positions.resize(mesh.positions.size());
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Vec3 x = positions[p] = PointCachePoint(&bytes[p * kPointCachePointBytes]);
      for (const double value : {x.x, x.y, x.z}) {
        if (const auto problem = CoordinateProblem(value, 1)) {
          return MakeError(PathText(file),
                           "frame " + std::to_string(frame) + ", point " + std::to_string(p) + ": " + *problem);
        }
      }
    }
    return frame;
  }
};

CacheReader::CacheReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CacheReader::~CacheReader() = default;
CacheReader::CacheReader(CacheReader&&) noexcept = default;
CacheReader& CacheReader::operator=(CacheReader&&) noexcept = default;

Result<CacheReader> CacheReader::Open(const fs::path& file) {
  const auto kind = CacheKindOf(file);
  if (!kind) {
    const std::string extension = PathText(file.extension());
    return MakeError(PathText(file), "expected a file that ends in .pc2, .obj or .ply, got " +
                                         (extension.empty() ? "no extension" : Quote(extension, 20)));
  }
  if (*kind == CacheKind::Csv) {
    return MakeError(PathText(file), "a table of points has no triangles; write the frames to .pc2, .obj or .ply");
  }
  auto impl = std::make_unique<Impl>();
  impl->file = file;
  impl->kind = *kind;
  const Status status = *kind == CacheKind::Pc2 ? impl->OpenPointCache() : impl->OpenMeshes();
  if (!status) return status.diagnostics();
  impl->MakeCloths();
  return {CacheReader(std::move(impl)), status.diagnostics()};
}

const std::vector<CacheReader::Cloth>& CacheReader::cloths() const {
  return impl_->cloths;
}

int CacheReader::frames() const {
  return impl_->frames;
}

Result<int> CacheReader::Next(std::vector<Vec3>& positions) {
  assert(impl_->next < impl_->frames);
  return impl_->kind == CacheKind::Pc2 ? impl_->NextOfPointCache(positions) : impl_->NextMesh(positions);
}

}  // namespace percale
