// Vertex caches of colliders: what is in a file, and what is wrong with it.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "io/scene_text.h"
#include "percale/mesh_file.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

/// A tetrahedron with a vertex of no triangle in between and a doubled corner, which welding closes.
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 7 7 7\nv 0 1 0\nv 0 0 1\nv 0 0 0\nf 1 4 2\nf 1 2 5\nf 6 5 4\nf 2 4 5\n";
constexpr int kPoints = 6;

using Samples = std::vector<std::vector<float>>;

std::string PointCache(const Samples& samples, std::int32_t points = kPoints, float rate = 1, float start = 1) {
  std::string bytes("POINTCACHE2\0", 12);
  const auto add = [&](const auto& number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); };
  add(std::int32_t{1});
  add(points);
  add(start);
  add(rate);
  add(static_cast<std::int32_t>(samples.size()));
  for (const std::vector<float>& sample : samples) {
    for (const float x : sample) add(x);
  }
  return bytes;
}

/// Big-endian, as they stand in a file.
std::string Bytes(std::int32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(static_cast<std::uint32_t>(number) >> shift & 0xff);
  return bytes;
}
std::string Bytes(float number) {
  std::int32_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  return Bytes(bits);
}

std::string Mdd(const std::vector<float>& times, const Samples& samples, std::int32_t points = kPoints) {
  std::string bytes = Bytes(static_cast<std::int32_t>(samples.size())) + Bytes(points);
  for (const float time : times) bytes += Bytes(time);
  for (const std::vector<float>& sample : samples) {
    for (const float x : sample) bytes += Bytes(x);
  }
  return bytes;
}

/// As it stands in the file, moved along x, its tip as high as `tip`.
std::vector<float> Sample(float x, float tip = 1) {
  return {x, 0, 0, x + 1, 0, 0, 7, 7, 7, x, 1, 0, x, 0, tip, x, 0, 0};
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

struct Folder {
  Folder() : path(fs::temp_directory_path() / "percale_vertex_cache_file_test") {
    fs::remove_all(path);
    fs::create_directories(path / "meshes");
    Write("meshes/body.obj", kTetrahedron);
    Write("meshes/walk.pc2", PointCache({Sample(0), Sample(0.5f), Sample(2)}));
  }
  ~Folder() { fs::remove_all(path); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
  }
  Result<Scene> Load(const std::string& more) const {
    Write("a.json",
          "{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {},\n\"collider\": {\"shape\": \"mesh\", \"mesh\": "
          "\"meshes/body.obj\",\n  " +
              more + "}}");
    return LoadScene(path / "a.json");
  }
  fs::path path;
};

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a collider brings its cache along, for the vertices that its mesh has") {
  const Folder folder;
  const Result<Scene> scene = folder.Load("\"cache\": \"meshes/walk.pc2\", \"cache_start\": 0.5");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  const ColliderSettings& body = scene->colliders[0];
  REQUIRE(body.loadedCache);
  CHECK(body.loaded->mesh.positions.size() == 4);
  CHECK(body.loaded->mesh.sourceCount == kPoints);
  CHECK(body.loadedCache->samples == 3);
  CHECK(body.loadedCache->spacing == 1);
  for (std::size_t s = 0; s < 3; ++s) {
    const float x = s == 0 ? 0.0f : s == 1 ? 0.5f : 2.0f;
    const std::vector<float> expected = {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, 1};
    CHECK(std::equal(expected.begin(), expected.end(), body.loadedCache->positions.begin() + std::ptrdiff_t(12 * s)));
  }
  // Written and read, here and elsewhere.
  const Result<Scene> again = ParseScene(FormatScene(*scene), (folder.path / "c.json").string());
  REQUIRE_MESSAGE(again.ok(), Format(again.diagnostics()));
  CHECK(test::Same(*scene, *again));
  CHECK(*again->colliders[0].loadedCache == *body.loadedCache);
  CHECK_FALSE(EffectOf(*scene, *again));
  const Scene absolute = WithAbsolutePaths(*scene);
  CHECK_FALSE(HasErrors(CheckScene(absolute)));
  const Result<Scene> elsewhere = ParseScene(FormatScene(absolute), "no such folder/a.json");
  REQUIRE_MESSAGE(elsewhere.ok(), Format(elsewhere.diagnostics()));
  CHECK(elsewhere->colliders[0].loadedCache->positions == body.loadedCache->positions);
}

TEST_CASE("a cache that was exported again, or for another mesh, is read again") {
  const Folder folder;
  const std::string keys = "\"cache\": \"meshes/walk.pc2\"";
  Scene scene = *folder.Load(keys);
  folder.Write("meshes/walk.pc2", PointCache({Sample(0), Sample(3)}));
  CHECK(EffectOf(scene, *folder.Load(keys)) == Effect::Rebuild);
  Scene changed = scene;
  changed.colliders[0].cacheRate = 24;
  CHECK(EffectOf(scene, changed) == Effect::Live);
  CHECK(CheckScene(changed).empty());
  changed.colliders[0].meshScale = 2;
  REQUIRE(LoadMeshes(changed).ok());
  CHECK_FALSE(HasErrors(CheckScene(changed)));
  CHECK(changed.colliders[0].loadedCache->samples == 2);
  changed.colliders[0].cache = "meshes/other.pc2";
  CHECK(HasErrors(CheckScene(changed)));
  folder.Write("meshes/other.pc2", PointCache({Sample(1)}, kPoints, 0));
  REQUIRE(LoadMeshes(changed).ok());
  CHECK(CheckScene(changed).empty());
}

TEST_CASE("What is wrong with a cache is told at its own place and at the scene's") {
  const Folder folder;
  const auto check = [&](const std::string& file, const std::string& bytes, const std::string& message,
                         const std::string& more = "") {
    if (!bytes.empty()) folder.Write(file, bytes);
    const Result<Scene> scene = folder.Load("\"cache\": \"" + file + "\"" + more);
    CHECK_FALSE(scene.ok());
    const std::string text = Format(scene.diagnostics());
    CHECK_MESSAGE(Contains(text, "a.json:3:12: error: /collider/cache: \"" + file + "\" cannot be used"), text);
    CHECK_MESSAGE(Contains(text, file + ": error: " + message), text);
    CHECK_FALSE(Contains(text, "LoadMeshes"));
  };
  const std::string good = PointCache({Sample(0), Sample(1)});
  check("none.pc2", "", "there is no such file");
  check("meshes", "", "expected a vertex cache that ends in .pc2 or .mdd, got no extension");
  check("walk.abc", good,
        "expected a vertex cache that ends in .pc2 or .mdd, got \".abc\"; export the animation as PointCache2 or MDD");
  check("empty.pc2", " ", "ends after 1 bytes, expected a PointCache2 header of 32 bytes; it was cut short");
  check("text.pc2", std::string(40, 'x'), "expected a PointCache2 file");
  check("cut.pc2", good.substr(0, good.size() - 5), "expected 2 frames of 6 points, 12 bytes each");
  check("no_samples.pc2", PointCache({}), "expected at least one sample, got none");
  check("five.pc2", PointCache({std::vector<float>(15, 0.5f)}, 5),
        "expected as many points per sample as the mesh \"body\" has vertices in its file, 6, got 5; export both");
  check("rate.pc2", PointCache({Sample(0)}, kPoints, -2), "expected a time between frames >= 0, got -2");
  check("rate_nan.pc2", PointCache({Sample(0)}, kPoints, std::numeric_limits<float>::quiet_NaN()),
        "expected a time between frames >= 0, got ");
  check("nan.pc2", PointCache({Sample(0), Sample(0, std::numeric_limits<float>::quiet_NaN())}),
        "sample 1, vertex 4 (counted from 0): expected a coordinate within 1000 km of the origin, got NaN");
  check("infinite.pc2", PointCache({Sample(std::numeric_limits<float>::infinity())}),
        "sample 0, vertex 0 (counted from 0): expected a coordinate within 1000 km of the origin, got Infinity");
  check("far.pc2", PointCache({Sample(2e6f)}), "sample 0, vertex 0 (counted from 0): expected a coordinate within");
  check("scaled.pc2", PointCache({Sample(0), Sample(600)}),
        "sample 1, vertex 0 (counted from 0): expected a coordinate", ", \"mesh_scale\": 10000");
  const auto failed = [&](const std::string& keys, const std::string& message) {
    const Result<Scene> scene = folder.Load(keys);
    CHECK_FALSE(scene.ok());
    CHECK_MESSAGE(Contains(Format(scene.diagnostics()), message), Format(scene.diagnostics()));
  };
  folder.Write("still.pc2", PointCache({Sample(0), Sample(1)}, kPoints, 0));
  failed(
      "\"cache\": \"still.pc2\"",
      "a.json:3:12: error: /collider/cache: the file states 0 from sample to sample, which is 0 s here; expected from "
      "1e-5 to 10000 s; state the samples per second in `cache_rate`, such as 24");
  CHECK(folder.Load("\"cache\": \"still.pc2\", \"cache_rate\": 24").ok());
  folder.Write("slow.pc2", PointCache({Sample(0), Sample(1)}, kPoints, 1e30f));
  failed("\"cache\": \"slow.pc2\"", "/collider/cache: the file states 1e30");
  failed("\"cache\": \"meshes/walk.pc2\", \"cache_rate\": -1",
         "/collider/cache_rate: expected a number >= 0 1/s, got -1");
  const Result<Scene> box = ParseScene(
      "{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {},\n\"collider\": {\"shape\": \"box\", \"cache\": "
      "\"a.pc2\"}}",
      "test");
  CHECK(Contains(Format(box.diagnostics()), "test:2:39: error: /collider/cache: expected none, for only the shape"));
}

/// The tetrahedron at 0 s, and with the corner at the origin 3 along x at 0.5 s.
std::string HandWrittenMdd() {
  std::string bytes(
      "\0\0\0\x02"
      "\0\0\0\x06"
      "\0\0\0\0"
      "\x3f\0\0\0",
      16);  // 2 frames, 6 points, 0 s, 0.5 s
  const std::string zero("\0\0\0\0", 4), one("\x3f\x80\0\0", 4), seven("\x40\xe0\0\0", 4), three("\x40\x40\0\0", 4);
  bytes += zero + zero + zero + one + zero + zero + seven + seven + seven + zero + one + zero + zero + zero + one +
           zero + zero + zero;
  bytes += three + zero + zero + one + zero + zero + seven + seven + seven + zero + one + zero + zero + zero + one +
           three + zero + zero;
  return bytes;
}

TEST_CASE("an MDD file moves a mesh as a PointCache2 file does, its times in seconds") {
  const Folder folder;
  folder.Write("meshes/walk.mdd", HandWrittenMdd());
  const Result<Scene> scene = folder.Load("\"cache\": \"meshes/walk.mdd\"");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  const VertexCache& cache = *scene->colliders[0].loadedCache;
  CHECK(cache.samples == 2);
  CHECK(cache.spacing == 0.5);
  CHECK(cache.inSeconds);
  CHECK(cache.greatestMove == 3);
  CHECK(cache.positions == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  // Capitals make no difference, and the first time does not count.
  folder.Write("LATE.MDD", Mdd({9.25f, 9.5f, 9.75f}, {Sample(0), Sample(0.5f), Sample(2)}));
  const Result<Scene> late = folder.Load("\"cache\": \"LATE.MDD\"");
  REQUIRE_MESSAGE(late.ok(), Format(late.diagnostics()));
  CHECK(late->colliders[0].loadedCache->spacing == 0.25);
  CHECK(late->colliders[0].loadedCache->positions ==
        folder.Load("\"cache\": \"meshes/walk.pc2\"")->colliders[0].loadedCache->positions);
  // Times as programs round them: thirtieths of a second in floats, and in milliseconds.
  std::vector<float> rounded, milliseconds;
  for (int k = 0; k < 300; ++k) {
    rounded.push_back(1000 + static_cast<float>(k) / 30);
    milliseconds.push_back(std::round(1000 * static_cast<float>(k) / 30) / 1000);
  }
  for (const std::vector<float>& times : {rounded, milliseconds}) {
    folder.Write("long.mdd", Mdd(times, Samples(300, Sample(0))));
    const Result<Scene> loaded = folder.Load("\"cache\": \"long.mdd\"");
    REQUIRE_MESSAGE(loaded.ok(), Format(loaded.diagnostics()));
    CHECK(loaded->colliders[0].loadedCache->spacing == doctest::Approx(1.0 / 30).epsilon(1e-4));
  }
}

TEST_CASE("What is wrong with an MDD file is told") {
  const Folder folder;
  const auto check = [&](const std::string& bytes, const std::string& message) {
    folder.Write("bad.mdd", bytes);
    const Result<Scene> scene = folder.Load("\"cache\": \"bad.mdd\"");
    CHECK_FALSE(scene.ok());
    const std::string text = Format(scene.diagnostics());
    CHECK_MESSAGE(Contains(text, "a.json:3:12: error: /collider/cache: \"bad.mdd\" cannot be used"), text);
    CHECK_MESSAGE(Contains(text, "bad.mdd: error: " + message), text);
  };
  const Samples two = {Sample(0), Sample(1)};
  const std::string good = Mdd({0, 0.5f}, two);
  check(" ", "ends after 1 bytes, expected an MDD header of 8 bytes; it was cut short");
  check(good.substr(0, 12),
        "expected 2 frames of 6 points, 12 bytes each and 4 for its time, after the header, got 4 bytes");
  check(good.substr(0, good.size() - 1), "expected 2 frames of 6 points, 12 bytes each");
  check(good + "x", "expected 2 frames of 6 points, 12 bytes each");
  check(std::string(40, 'x'), "expected 2021161080 frames of 2021161080 points");
  check(PointCache(two), "expected 1347373390 frames of ");  // by its ending alone
  check(Bytes(std::int32_t{-1}) + Bytes(kPoints), "expected a number of frames >= 0, got -1");
  check(Bytes(std::int32_t{1}) + Bytes(std::int32_t{-6}), "expected a number of points >= 0, got -6");
  // Counts whose product overflows to the size of the file.
  check(Bytes(std::int32_t{0x40000000}) + Bytes(std::int32_t{0x7fffffff}) + std::string(64, '\0'),
        "expected 1073741824 frames of 2147483647 points");
  check(Mdd({}, {}), "expected at least one sample, got none");
  check(Mdd({0}, {std::vector<float>(15, 0.5f)}, 5),
        "expected as many points per sample as the mesh \"body\" has vertices in its file, 6, got 5; export both");
  check(Mdd({0, kNaN}, two), "the time of sample 1: expected a number, got NaN");
  check(Mdd({kInfinity, 0}, two), "the time of sample 0: expected a number, got Infinity");
  check(Mdd({1, 0.5f}, two), "expected times that rise, got 1 s at the first and 0.5 s at the last");
  check(Mdd({0, 0.5f, 2}, {Sample(0), Sample(1), Sample(2)}),
        "the time of sample 1: expected 1 s, for the times of samples must be even, got 0.5 s; export every frame");
  check(Mdd({0, 0.5f}, {Sample(0), Sample(0, kNaN)}),
        "sample 1, vertex 4 (counted from 0): expected a coordinate within 1000 km of the origin, got NaN");
  folder.Write("still.mdd", Mdd({0, 0}, two));
  CHECK(Contains(Format(folder.Load("\"cache\": \"still.mdd\"").diagnostics()),
                 "the file states 0 from sample to sample"));
  CHECK(folder.Load("\"cache\": \"still.mdd\", \"cache_rate\": 24").ok());
}

TEST_CASE("What cannot go well with a cache is warned of") {
  const Folder folder;
  const auto warned = [&](const std::string& keys) {
    const Result<Scene> scene = folder.Load(keys);
    REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
    return Format(scene.diagnostics());
  };
  CHECK(Contains(warned("\"cache_rate\": 5"),
                 "a.json:3:17: warning: /collider/cache_rate: the collider has no `cache` that it could belong to"));
  folder.Write("flip.pc2", PointCache({Sample(0), Sample(0, -1)}));
  CHECK(Contains(warned("\"cache\": \"flip.pc2\", \"cache_rate\": 1"),
                 "flip.pc2: warning: sample 1: the mesh is inside out: its volume is -0.166 m^3"));
  folder.Write("flat.pc2", PointCache({Sample(0), Sample(0), Sample(0, 0)}));
  CHECK(Contains(warned("\"cache\": \"flat.pc2\", \"cache_rate\": 1"), "sample 2: the mesh is inside out"));
  std::vector<float> large = Sample(0);
  for (float& x : large) x *= 100;
  folder.Write("large.pc2", PointCache({large}));
  CHECK(Contains(warned("\"cache\": \"large.pc2\""),
                 "large.pc2: warning: sample 0: edges of the mesh are 100 times as long as in its file"));
  CHECK_FALSE(Contains(warned("\"cache\": \"meshes/walk.pc2\", \"cache_rate\": 1"), "walk.pc2"));
  CHECK(Contains(
      warned("\"cache\": \"meshes/walk.pc2\""),
      "a.json:3:12: warning: /collider/cache: goes up to 1.5 m in a step of 0.0166 s, farther than the collider "
      "is large, 1 m; slow it down, raise simulation.steps_per_frame, or lower `cache_rate`"));
}

}  // namespace
}  // namespace percale
