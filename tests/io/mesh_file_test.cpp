#include "percale/mesh_file.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "io/atomic_file.h"
#include "io/cache_kind.h"

using namespace percale;
namespace fs = std::filesystem;

namespace {

/// An empty folder that goes away with the test.
class Folder {
 public:
  Folder() {
    for (int i = 0;; ++i) {
      path_ = fs::temp_directory_path() / ("percale mesh_file " + std::to_string(i));
      if (fs::create_directory(path_)) break;
    }
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  int Count() const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(path_)) count += entry.exists() ? 1 : 0;
    return count;
  }

 private:
  fs::path path_;
};

std::string Contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void Put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

Scene SmallScene(int width, int height) {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = width;
  cloth.numHeightPoints = height;
  cloth.pinned = {{0, 0}};
  scene.cloths = {cloth};
  return scene;
}

/// splitmix64, so that the damage below is the same everywhere.
struct Random {
  std::uint64_t state;
  std::uint64_t operator()() {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
};

}  // namespace

TEST_CASE("A file appears at Commit, and not before") {
  const Folder folder;
  auto file = AtomicFile::Create(folder / "a.txt");
  REQUIRE(file);
  CHECK(file->Write("new"));
  CHECK_FALSE(fs::exists(folder / "a.txt"));
  CHECK(file->Commit());
  CHECK(Contents(folder / "a.txt") == "new");
  CHECK(folder.Count() == 1);
}

TEST_CASE("A file that is given up leaves the old one as it was") {
  const Folder folder;
  Put(folder / "a.txt", "old");
  {
    auto file = AtomicFile::Create(folder / "a.txt");
    REQUIRE(file);
    CHECK(file->Write("new"));
    AtomicFile moved = std::move(*file);
    CHECK(moved.Write("er"));
  }
  CHECK(Contents(folder / "a.txt") == "old");
  CHECK(folder.Count() == 1);
}

TEST_CASE("Two writers of one file do not meet") {
  const Folder folder;
  auto first = AtomicFile::Create(folder / "a.txt");
  auto second = AtomicFile::Create(folder / "a.txt");
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->path() != second->path());
  CHECK(first->path().extension() == ".txt");
  CHECK(first->Write("first"));
  CHECK(second->Write("second"));
  CHECK(second->Commit());
  CHECK(first->Commit());
  CHECK(Contents(folder / "a.txt") == "first");
  CHECK(folder.Count() == 1);
}

TEST_CASE("Bytes can be put in afterwards") {
  const Folder folder;
  auto file = AtomicFile::Create(folder / "a.txt");
  REQUIRE(file);
  CHECK(file->Write("0123456789"));
  CHECK(file->WriteAt(2, "ab", 2));
  CHECK(file->Write("end"));
  CHECK(file->CommitAs(folder / "b.txt"));
  CHECK(Contents(folder / "b.txt") == "01ab456789end");
  CHECK(folder.Count() == 1);
}

TEST_CASE("Permissions of the file that is replaced are kept") {
  const Folder folder;
  Put(folder / "a.txt", "old");
  fs::permissions(folder / "a.txt", fs::perms::owner_read | fs::perms::owner_write);
  auto file = AtomicFile::Create(folder / "a.txt");
  REQUIRE(file);
  CHECK(file->Commit());
  CHECK(fs::status(folder / "a.txt").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("What cannot be written is told with its place") {
  const Folder folder;
  for (const fs::path& path : {folder / "none/a.txt", folder / "", fs::path()}) {
    const auto file = AtomicFile::Create(path);
    REQUIRE_FALSE(file);
    CHECK(HasErrors(file.diagnostics()));
  }
  CHECK(folder.Count() == 0);
}

TEST_CASE("A full disk is noticed, at the latest at the end") {
  if (!fs::exists("/dev/full")) return;
  auto file = AtomicFile::Create("/dev/full");
  REQUIRE(file);
  CHECK(file->straight());
  CHECK(file->Write("x"));  // stays in the buffer
  const Status status = file->Commit();
  REQUIRE_FALSE(status);
  CHECK(status.diagnostics()[0].message.find("disk is full") != std::string::npos);
}

TEST_CASE("Kinds go by the ending") {
  CHECK(CacheKindOf("a.csv") == CacheKind::Csv);
  CHECK(CacheKindOf("a.b.OBJ") == CacheKind::Obj);
  CHECK(CacheKindOf("a.ply") == CacheKind::Ply);
  CHECK(CacheKindOf("a.Pc2") == CacheKind::Pc2);
  CHECK_FALSE(CacheKindOf("csv"));
  CHECK_FALSE(CacheKindOf("a.csv.gz"));
}

TEST_CASE("Without Finish nothing is left behind") {
  for (const char* name : {"a.csv", "a.obj", "a.ply", "a.pc2"}) {
    CAPTURE(name);
    const Folder folder;
    {
      World world(SmallScene(4, 3), {.threads = 1});
      auto writer = CacheWriter::Open(folder / name, 0.1);
      REQUIRE(writer);
      CHECK(writer->Add(world, 0));
      world.Step();
      CHECK(writer->Add(world, 1));
    }
    CHECK(folder.Count() == 0);
  }
}

TEST_CASE("A cache of no frames is an error, and no file") {
  const Folder folder;
  auto writer = CacheWriter::Open(folder / "a.csv", 0.1);
  REQUIRE(writer);
  CHECK_FALSE(writer->Finish());
  CHECK(folder.Count() == 0);
}

TEST_CASE("Frames of another mesh are refused, and then everything") {
  const Folder folder;
  World small(SmallScene(3, 3), {.threads = 1}), large(SmallScene(4, 4), {.threads = 1});
  auto writer = CacheWriter::Open(folder / "a.pc2", 0.1);
  REQUIRE(writer);
  CHECK(writer->Add(small, 0));
  CHECK_FALSE(writer->Add(large, 1));
  CHECK_FALSE(writer->Add(small, 2));
  CHECK_FALSE(writer->Finish());
  CHECK(folder.Count() == 0);
}

TEST_CASE("What is written is what is told of it") {
  const Folder folder;
  for (const char* name : {"a.csv", "a.pc2", "a.obj", "a.ply"}) {
    CAPTURE(name);
    World world(SmallScene(5, 4), {.threads = 1});
    auto writer = CacheWriter::Open(folder / name, 0.25);
    REQUIRE(writer);
    const bool several = CacheKindOf(name) == CacheKind::Csv || CacheKindOf(name) == CacheKind::Pc2;
    double lowest = 1e9;
    for (int frame = 0; frame < (several ? 3 : 1); ++frame) {
      CHECK(writer->Add(world, frame));
      for (const Vec3& x : world.Cloth(0).positions()) lowest = std::min(lowest, x.y);
      world.Step();
    }
    const auto files = writer->Finish();
    REQUIRE(files);
    CHECK((*files)[0] == folder / name);
    const auto info = ReadCacheInfo(folder / name);
    REQUIRE_MESSAGE(info, Format(info.diagnostics()));
    CHECK(info->frames == (several ? 3 : 1));
    CHECK(info->vertices == 20);
    CHECK(info->triangles == (several ? 0 : 24));
    CHECK(info->boxMin.y == doctest::Approx(lowest).epsilon(1e-7));
    CHECK(info->boxMax.y == doctest::Approx(1));
    if (CacheKindOf(name) == CacheKind::Pc2) CHECK(info->frameSeconds == 0.25);
  }
}

TEST_CASE("Meshes of other programs are understood") {
  const Folder folder;
  Put(folder / "a.obj",
      "# c\r\nmtllib x.mtl\r\nv +1 .5 -2.\r\nv 1e0 2 3 1.0\r\nv 0 0 0\r\nv 007 0 0\r\nf 1//1 2//1 3//1 4//1\r\nf -1 -2 "
      "-3\r\n");
  auto info = ReadCacheInfo(folder / "a.obj");
  REQUIRE_MESSAGE(info, Format(info.diagnostics()));
  CHECK(info->vertices == 4);
  CHECK(info->triangles == 3);
  CHECK(info->boxMin == Vec3{0, 0, -2});
  CHECK(info->boxMax == Vec3{7, 2, 3});

  Put(folder / "text.ply",
      "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\nproperty uchar red\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 255 0\n1 0 0 2\n0 3 0 "
      "0\n"
      "3 0 1 2\n");
  info = ReadCacheInfo(folder / "text.ply");
  REQUIRE_MESSAGE(info, Format(info.diagnostics()));
  CHECK(info->vertices == 3);
  CHECK(info->triangles == 1);
  CHECK(info->boxMax == Vec3{1, 3, 2});

  std::string big =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty short y\nproperty double "
      "z\nend_header\n";
  big += std::string("\x3f\x80\x00\x00", 4) + std::string("\xff\xfe", 2) + std::string("\x40\x08\0\0\0\0\0\0", 8);
  Put(folder / "big.ply", big);
  info = ReadCacheInfo(folder / "big.ply");
  REQUIRE_MESSAGE(info, Format(info.diagnostics()));
  CHECK(info->boxMin == Vec3{1, -2, 3});
}

TEST_CASE("Whatever is done to a file, it is read or refused") {
  const Folder folder;
  World world(SmallScene(4, 4), {.threads = 1});
  Random random{7};
  for (const char* name : {"a.csv", "a.pc2", "a.obj", "a.ply"}) {
    auto writer = CacheWriter::Open(folder / name, 0.25);
    REQUIRE(writer);
    CHECK(writer->Add(world, 0));
    if (CacheKindOf(name) == CacheKind::Csv || CacheKindOf(name) == CacheKind::Pc2) CHECK(writer->Add(world, 1));
    REQUIRE(writer->Finish());
    const std::string good = Contents(folder / name);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
      std::string bad = good;
      if (i % 4 == 0) bad.resize(random() % good.size());
      for (int k = i % 4; k > 0; --k)
        bad[random() % std::min<std::size_t>(bad.size(), i % 8 < 4 ? 64 : bad.size())] = char(random());
      const fs::path file = folder / (std::string("bad") + name);
      Put(file, bad);
      const auto info = ReadCacheInfo(file);
      if (info) {
        CHECK(info->vertices >= 0);
        CHECK(IsFinite(info->boxMin));
        CHECK(IsFinite(info->boxMax));
      } else {
        ++refused;
        CHECK(HasErrors(info.diagnostics()));
        CHECK(info.diagnostics()[0].place.file == PathText(file));
      }
    }
    CAPTURE(name);
    CHECK(refused >= 100);  // each cut, and more
  }
}

TEST_CASE("Cut short is never taken for whole") {
  const Folder folder;
  World world(SmallScene(3, 3), {.threads = 1});
  for (const char* name : {"a.pc2", "a.ply"}) {
    auto writer = CacheWriter::Open(folder / name, 0.25);
    REQUIRE(writer);
    CHECK(writer->Add(world, 0));
    REQUIRE(writer->Finish());
    const std::string good = Contents(folder / name);
    const fs::path file = folder / (std::string("cut") + name);
    for (std::size_t size = 0; size < good.size(); ++size) {
      Put(file, good.substr(0, size));
      CHECK_FALSE(ReadCacheInfo(file));
    }
  }
}

TEST_CASE("A text that was cut within a line is refused, or told") {
  const Folder folder;
  World world(SmallScene(3, 3), {.threads = 1});
  for (const char* name : {"a.csv", "a.obj"}) {
    auto writer = CacheWriter::Open(folder / name, 0.25);
    REQUIRE(writer);
    CHECK(writer->Add(world, 0));
    REQUIRE(writer->Finish());
    CHECK(ReadCacheInfo(folder / name).diagnostics().empty());
    const std::string good = Contents(folder / name);
    const fs::path file = folder / (std::string("cut") + name);
    for (std::size_t size = 1; size < good.size(); ++size) {
      if (good[size - 1] == '\n') continue;
      Put(file, good.substr(0, size));
      const auto info = ReadCacheInfo(file);
      CHECK(!info.diagnostics().empty());
      if (info) CHECK(info.diagnostics()[0].place.line > 0);
    }
  }
}

TEST_CASE("What is no file") {
  const Folder folder;
  CHECK_FALSE(ReadCacheInfo(folder / "none.obj"));
  fs::create_directory(folder / "folder.obj");
  CHECK_FALSE(ReadCacheInfo(folder / "folder.obj"));
  Put(folder / "a.xyz", "v 0 0 0\n");
  CHECK_FALSE(ReadCacheInfo(folder / "a.xyz"));
}

namespace {

/// Three frames of two cloths, of every second frame of a run, and what was written.
std::vector<std::vector<Vec3>> WriteTwoCloths(const fs::path& file, int frames) {
  Scene scene = SmallScene(5, 4);
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].numWidthPoints = 3;
  scene.cloths[1].origin = {0, 0.5, 0};
  World world(scene, {.threads = 1});
  auto writer = CacheWriter::Open(file, 0.25);
  REQUIRE(writer);
  std::vector<std::vector<Vec3>> written;
  for (int frame = 0; frame < frames; ++frame) {
    CHECK(writer->Add(world, 2 * frame));
    written.emplace_back();
    for (int c = 0; c < 2; ++c) {
      const auto x = world.Cloth(c).positions();
      written.back().insert(written.back().end(), x.begin(), x.end());
    }
    world.Step();
    world.Step();
  }
  REQUIRE(writer->Finish());
  return written;
}

/// All that went wrong when the frames of a file were read, or nothing.
std::string ReadAll(const fs::path& file) {
  auto reader = CacheReader::Open(file);
  if (!reader) return Format(reader.diagnostics());
  std::vector<Vec3> positions;
  std::size_t vertices = 0;
  for (const CacheReader::Cloth& cloth : reader->cloths()) {
    vertices += std::size_t(cloth.vertices);
    for (const Triangle& t : cloth.triangles) {
      for (const std::int32_t v : {t.a, t.b, t.c}) CHECK((v >= 0 && v < cloth.vertices));
    }
  }
  for (int frame = 0; frame < reader->frames(); ++frame) {
    const auto number = reader->Next(positions);
    if (!number) return Format(number.diagnostics());
    CHECK(positions.size() == vertices);
    for (const Vec3& x : positions) CHECK(IsFinite(x));
  }
  return "";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("The frames of a cache come back as they were written") {
  const Folder folder;
  for (const char* name : {"a.pc2", "b.obj", "c.ply"}) {
    CAPTURE(name);
    const auto written = WriteTwoCloths(folder / name, 3);
    auto reader = CacheReader::Open(folder / name);
    REQUIRE_MESSAGE(reader, Format(reader.diagnostics()));
    CHECK(reader.diagnostics().empty());
    CHECK(reader->frames() == 3);
    // A .ply does not say where a cloth ends.
    const bool one = CacheKindOf(name) == CacheKind::Ply;
    REQUIRE(reader->cloths().size() == (one ? 1 : 2));
    CHECK(reader->cloths()[0].vertices == (one ? 32 : 20));
    CHECK(reader->cloths()[0].triangles.size() == (one ? 36 : 24));
    if (!one) {
      CHECK(reader->cloths()[1].vertices == 12);
      CHECK(reader->cloths()[1].triangles.size() == 12);
      CHECK(reader->cloths()[1].triangles[0] == Triangle{0, 3, 1});
    }
    // Digits: floats, nine of them, all.
    const double error = CacheKindOf(name) == CacheKind::Pc2 ? 1e-7 : CacheKindOf(name) == CacheKind::Obj ? 1e-8 : 0;
    for (int frame = 0; frame < 3; ++frame) {
      std::vector<Vec3> positions;
      const auto number = reader->Next(positions);
      REQUIRE_MESSAGE(number, Format(number.diagnostics()));
      CHECK(*number == (CacheKindOf(name) == CacheKind::Pc2 ? frame : 2 * frame));
      REQUIRE(positions.size() == 32);
      for (std::size_t v = 0; v < 32; ++v) CHECK(Length(positions[v] - written[std::size_t(frame)][v]) <= error);
    }
  }
}

TEST_CASE("Meshes of other programs are one cloth, their polygons triangles") {
  const Folder folder;
  Put(folder / "a.obj", "o cloth1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nf 1 2 3 4\no cloth0\nf 1 2 5\n");
  auto reader = CacheReader::Open(folder / "a.obj");
  REQUIRE_MESSAGE(reader, Format(reader.diagnostics()));
  REQUIRE(reader->cloths().size() == 1);
  CHECK(reader->cloths()[0].vertices == 5);
  CHECK(reader->cloths()[0].triangles.size() == 3);
}

TEST_CASE("Caches that do not fit together are refused, with what was expected and found") {
  const Folder folder;
  CHECK(Contains(ReadAll(folder / "none.pc2"), "none.pc2: error: there is no such file"));
  CHECK(Contains(ReadAll(folder / "none.obj"), "none.obj: error: there is no such file"));
  CHECK(Contains(ReadAll(folder / "none.csv"), "no triangles; write the frames to .pc2, .obj or .ply"));
  CHECK(Contains(ReadAll(folder / "none.xyz"), "ends in .pc2, .obj or .ply, got \".xyz\""));
  fs::create_directory(folder / "folder.pc2");
  CHECK(Contains(ReadAll(folder / "folder.pc2"), "got a folder"));

  WriteTwoCloths(folder / "a.pc2", 2);
  CHECK(ReadAll(folder / "a.pc2").empty());
  const std::string good = Contents(folder / "a.pc2"), mesh = Contents(folder / "a.pc2.obj");
  fs::rename(folder / "a.pc2.obj", folder / "b.obj");
  CHECK(Contains(ReadAll(folder / "a.pc2"), "a.pc2.obj: error: there is no such file; \"a.pc2\" holds no triangles"));
  Put(folder / "a.pc2.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  CHECK(Contains(ReadAll(folder / "a.pc2"), "\"a.pc2.obj\" has vertices, 3, got 32"));
  Put(folder / "a.pc2.obj", mesh);
  Put(folder / "a.pc2", good.substr(0, 28) + std::string(4, '\0'));
  CHECK(Contains(ReadAll(folder / "a.pc2"), "expected at least one frame"));
  std::string bad = good;
  bad.replace(32 + 12 * 33, 4, std::string("\0\0\xc0\x7f", 4));
  Put(folder / "a.pc2", bad);
  CHECK(Contains(ReadAll(folder / "a.pc2"), "frame 1, point 1: expected a coordinate within 1000 km"));

  WriteTwoCloths(folder / "c.ply", 3);
  CHECK(ReadAll(folder / "c.ply").empty());
  fs::copy_file(folder / "b.obj", folder / "d_0000.obj");
  Put(folder / "d_0001.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  CHECK(Contains(ReadAll(folder / "d.obj"), "32 vertices and 36 faces, got another one, of 3 vertices and 1 face"));
  Put(folder / "twice.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 2\n");
  CHECK(Contains(ReadAll(folder / "twice.obj"), "the same vertex twice (0, 1, 1, counted from 0)"));
}

TEST_CASE("Whatever is done to the frames of a cache, they are read or refused") {
  const Folder folder;
  Random random{8};
  for (const char* name : {"a.pc2", "a.obj", "a.ply"}) {
    CAPTURE(name);
    WriteTwoCloths(folder / name, CacheKindOf(name) == CacheKind::Pc2 ? 2 : 1);
    const std::string good = Contents(folder / name);
    int refused = 0;
    for (int i = 0; i < 200; ++i) {
      std::string bad = good;
      if (i % 4 == 0) bad.resize(random() % good.size());
      for (int k = i % 4; k > 0; --k)
        bad[random() % std::min<std::size_t>(bad.size(), i % 8 < 4 ? 64 : bad.size())] = char(random());
      Put(folder / name, bad);
      refused += ReadAll(folder / name).empty() ? 0 : 1;
    }
    CHECK(refused >= 30);
  }
}
