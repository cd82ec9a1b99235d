#include "io/preset_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

using namespace percale;

namespace {

/// The messages of a preset that will not do.
std::string Problems(const std::string& text) {
  const Result<Preset> preset = ParsePreset(text, "a.json");
  return preset ? "" : Format(preset.diagnostics());
}

Scene SceneWithSphere() {
  Scene scene;
  scene.cloths.resize(2);
  scene.spheres.resize(1);
  return scene;
}

}  // namespace

TEST_CASE("the presets that are shipped are good, and say what they do") {
  const auto presets = ListPresets({"presets"});
  CHECK(presets.size() >= 8);
  for (const auto& entry : presets) {
    CAPTURE(entry.first);
    const Result<Preset> preset = LoadPreset(entry.second);
    REQUIRE(preset);
    CHECK(preset->name == entry.first);
    CHECK_FALSE(preset->description.empty());
    CHECK_FALSE(preset->values.empty());
    // On the scene that everyone begins with, none of them is unstable.
    Result<Scene> scene = LoadScene("scene/pinned2.json");
    REQUIRE(scene);
    for (const PresetAssignment& set : Assignments(*preset, *scene)) {
      set.parameter->set(*scene, static_cast<std::size_t>(set.index), set.value);
    }
    CHECK(CheckScene(*scene).empty());
  }
}

TEST_CASE("a preset sets every object, or the one that it names, and leaves out what the scene has not") {
  const auto preset = ParsePreset(
      R"({"set": {"cloth.ks": 800, "cloth.1.ks": 900, "plane.friction": 0.1, "simulation.gravity": [0, -1.62, 0]}})",
      "moon.json");
  REQUIRE(preset);
  CHECK(preset->name == "moon");
  const auto set = Assignments(*preset, SceneWithSphere());
  REQUIRE(set.size() == 4);
  CHECK(set[0].path == "/cloth/0/ks");
  CHECK(set[1].path == "/cloth/1/ks");
  CHECK(set[2].path == "/cloth/1/ks");
  CHECK(std::get<double>(set[2].value) == 900);
  CHECK(set[3].path == "/simulation/gravity");
  CHECK(set[3].place.line == 1);
}

TEST_CASE("what the scene file states wins over a preset below it") {
  const auto preset = ParsePreset(R"({"set": {"cloth.ks": 800, "cloth.damping": 1}})", "a.json");
  REQUIRE(preset);
  Scene scene = SceneWithSphere();
  const double before = scene.cloths[0].ks;
  std::vector<PresetAssignment> givesWay;
  const auto set = ApplyBelow(*preset, {{"/cloth/0/ks", {}}}, scene, &givesWay);
  CHECK(set.size() == 3);
  REQUIRE(givesWay.size() == 1);
  CHECK(givesWay[0].path == "/cloth/0/ks");
  CHECK(scene.cloths[0].ks == before);
  CHECK(scene.cloths[1].ks == 800);
  CHECK(scene.cloths[0].damping == 1);
}

TEST_CASE("what is wrong with a preset is told with its place") {
  CHECK(Problems("{\"set\": {\n \"cloth.ks\": -5}}").find("a.json:2:14: error: cloth.ks: ") != std::string::npos);
  CHECK(Problems("{\"set\": {\n \"cloth.ks\": -5}}").find("expected a number >= 0 N/m, got -5") != std::string::npos);
  CHECK(Problems(R"({"set": {"cloth.kss": 5}})").find("did you mean `ks`?") != std::string::npos);
  CHECK(Problems(R"({"set": {"cloth.kss": 5}})").find("a.json:1:10: error") != std::string::npos);
  CHECK(Problems(R"({"set": {"clot.ks": 5}})").find("did you mean `cloth`?") != std::string::npos);
  CHECK(Problems(R"({"set": {"cloth.enable_bending": 1}})").find("true or false") != std::string::npos);
  CHECK(Problems(R"({"sett": {}})").find("did you mean `set`?") != std::string::npos);
  CHECK(Problems(R"({"description": "x"})").find("/set: this key is missing") != std::string::npos);
  CHECK(Problems(R"({"description": 1, "set": 2})").find("/description: expected a text, got 1") != std::string::npos);
  CHECK(Problems("[]").find("expected a preset") != std::string::npos);
  CHECK(Problems("{").find("a.json:1") != std::string::npos);
  // Each problem, not only the first.
  CHECK(Problems("{\"set\": {\"cloth.ks\": -5, \"cloth.damping\": 200, \"x\": null}}").find("cloth.damping") !=
        std::string::npos);
}

TEST_CASE("an unknown preset is answered with the known ones") {
  const Result<Preset> preset = FindPreset("slik", {"presets"});
  REQUIRE_FALSE(preset);
  CHECK(preset.diagnostics()[0].message.find("did you mean `silk`?") != std::string::npos);
  CHECK(FindPreset("silk", {"no/such/folder", "presets"}));
  CHECK(FindPreset("presets/silk.json", {}));
  CHECK_FALSE(FindPreset("x", {}));
}

TEST_CASE("a saved preset holds what differs, and makes it again") {
  const Scene from = SceneWithSphere();
  Scene to = from;
  to.cloths[0].ks = 700;
  to.cloths[0].damping = to.cloths[1].damping = 3;
  to.spheres[0].friction = 0.9;
  to.simulation.gravity = {1, 2, 3};
  to.camera.azimuth = 30;  // Where one looks from is no property of the cloth.
  const std::string text = FormatPreset("mine", from, to);
  const auto preset = ParsePreset(text, "mine.json");
  REQUIRE(preset);
  CHECK(preset->description == "mine");
  CHECK(preset->values.size() == 4);
  CHECK(text.find("\"cloth.0.ks\": 700") != std::string::npos);
  CHECK(text.find("\"cloth.damping\": 3") != std::string::npos);
  Scene again = from;
  for (const PresetAssignment& set : Assignments(*preset, again)) {
    set.parameter->set(again, static_cast<std::size_t>(set.index), set.value);
  }
  again.camera = to.camera;
  CHECK(FormatScene(again) == FormatScene(to));
}
