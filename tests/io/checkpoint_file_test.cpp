#include "percale/checkpoint_file.h"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "percale/parameters.h"

using namespace percale;
namespace fs = std::filesystem;

namespace {

fs::path Folder() {
  const fs::path folder = fs::temp_directory_path() / "percale_checkpoint_test";
  fs::create_directories(folder);
  return folder;
}

Scene FullScene() {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = 7;
  cloth.numHeightPoints = 9;
  cloth.thickness = 0.01;
  cloth.ks = 1234.5678901234567;
  cloth.pinned = {{0, 0}, {6, 0}};
  scene.cloths = {cloth, cloth};
  scene.cloths[1].origin = {0, 0.5, 0};
  scene.cloths[1].pinned.clear();
  scene.spheres.push_back({{0.5, 0.2, 0.5}, 0.2, 0.3});
  scene.planes.push_back({{0, -0.5, 0}, {0, 1, 0}, 0.5});
  scene.pinMotions.push_back(
      {.cloth = 0, .points = {{6, 0}}, .start = 0.1, .end = 0.4, .displacement = {-0.2, 0.1, 0}});
  scene.wind = {{1, 0, 2}, 0.5, 0.3, 0.8};
  REQUIRE_FALSE(HasErrors(CheckScene(scene)));
  return scene;
}

World MakeWorld() {
  World world(FullScene());
  for (int i = 0; i < 12; ++i) world.Step();
  world.SetHandles({{1, 20, {0.3, 1.2, 0.4}, 0.15, 20}});
  world.AddBall({{0.5, 1.5, 0.5}, {0.1, -3, 0}, 0.1, 20});
  world.AddGust({{0, 8, 2}, 300, world.report().time + 0.05, 0.4});
  for (int i = 0; i < 3; ++i) world.Step();
  return world;
}

std::string Read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void Write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}
/// The message of a failure, or nothing.
std::string Failure(const fs::path& file) {
  const Result<WorldState> state = LoadCheckpoint(file);
  return state ? std::string() : state.diagnostics().front().message;
}

}  // namespace

TEST_CASE("a World goes on from a checkpoint to the same bits") {
  const fs::path file = Folder() / "state.percale";
  World world = MakeWorld();
  WorldState state;
  world.Save(state);
  REQUIRE(SaveCheckpoint(file, state));
  const Result<WorldState> loaded = LoadCheckpoint(file);
  REQUIRE_MESSAGE(loaded, Failure(file));
  CHECK(loaded->report.frame == 15);
  CHECK(loaded->report.greatestStretch == state.report.greatestStretch);
  CHECK(loaded->handles == state.handles);
  CHECK(loaded->balls == state.balls);
  CHECK(loaded->gusts == state.gusts);
  World other(*loaded->scene);
  other.Restore(*loaded);
  CHECK(other.StateHash() == world.StateHash());
  for (int i = 0; i < 20; ++i) {
    world.Step();
    other.Step();
    REQUIRE(other.StateHash() == world.StateHash());
  }
}

TEST_CASE("each cut and each changed byte is told") {
  const fs::path file = Folder() / "good.percale", broken = Folder() / "broken.percale";
  WorldState state;
  MakeWorld().Save(state);
  REQUIRE(SaveCheckpoint(file, state));
  const std::string bytes = Read(file);
  REQUIRE(bytes.size() > 1000);
  for (std::size_t size = 0; size < bytes.size(); size += size < 40 ? 1 : 97) {
    Write(broken, bytes.substr(0, size));
    CAPTURE(size);
    REQUIRE_FALSE(Failure(broken).empty());
  }
  for (std::size_t at = 0; at < bytes.size(); at += at < 40 ? 1 : 61) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x41);
    Write(broken, changed);
    CAPTURE(at);
    REQUIRE_FALSE(Failure(broken).empty());
  }
}

TEST_CASE("what is no checkpoint is told by what it is") {
  const fs::path file = Folder() / "other.percale";
  CHECK(Failure(Folder() / "missing.percale") == "there is no such file");
  CHECK(Failure(Folder()).find("no ordinary file") != std::string::npos);
  Write(file, "");
  CHECK(Failure(file).find("empty file") != std::string::npos);
  Write(file, "{\"cloth\": 5}");
  CHECK(Failure(file).find("something else") != std::string::npos);
  WorldState state;
  MakeWorld().Save(state);
  REQUIRE(SaveCheckpoint(file, state));
  std::string bytes = Read(file);
  bytes[8] = 77;
  Write(file, bytes);
  CHECK(Failure(file).find("version 77") != std::string::npos);
  CHECK_FALSE(SaveCheckpoint(Folder() / "missing" / "a.percale", state));
}

TEST_CASE("a state that no World can be in is refused") {
  const fs::path file = Folder() / "impossible.percale";
  const auto refused = [&](auto change, const std::string& why) {
    WorldState state;
    MakeWorld().Save(state);
    change(state);
    REQUIRE(SaveCheckpoint(file, state));
    CAPTURE(Failure(file));
    CHECK(Failure(file).find(why) != std::string::npos);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](WorldState& s) { s.cloths[1].positions.pop_back(); }, "cloth 1 has 62 points, and its grid 63");
  refused([](WorldState& s) { s.cloths[0].anchors.clear(); }, "another number of pins");
  refused([&](WorldState& s) { s.cloths[0].previous[3].y = nan; }, "a position that is no number");
  refused([](WorldState& s) { s.handles[0].vertex = 63; }, "a vertex that does not exist");
  refused([](WorldState& s) { s.handles[0].cloth = -1; }, "a vertex that does not exist");
  refused([](WorldState& s) { s.handles[0].radius = 0; }, "a handle's radius");
  refused([](WorldState& s) { s.balls[0].mass = -1; }, "a ball's mass");
  refused([](WorldState& s) { s.balls.resize(100, s.balls[0]); }, "100 balls");
  refused([&](WorldState& s) { s.gusts[0].start = nan; }, "a gust's start");
  refused([](WorldState& s) { s.report.frame = -1; }, "below 0");
  refused([](WorldState& s) { s.cloths.pop_back(); }, "got another");
}
