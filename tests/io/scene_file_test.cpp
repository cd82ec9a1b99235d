#include "percale/scene_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "io/json_document.h"
#include "io/scene_text.h"

namespace percale {
namespace {

namespace fs = std::filesystem;
using test::OneOfEach;
using test::Same;

constexpr const char* kCourseScenes[] = {"pinned2", "pinned4", "sphere", "plane", "selfCollision"};

/// The cloth of the course's scenes, as an object with more keys at its end.
std::string Cloth(const std::string& more = "") {
  return "{\"width\": 1, \"height\": 1, \"num_width_points\": 50, \"num_height_points\": 50, \"thickness\": 0.0095, "
         "\"orientation\": 0, \"enable_structural\": true, \"enable_shearing\": true, \"enable_bending\": true, "
         "\"damping\": 0.2, \"density\": 150, \"ks\": 5000" +
         more + "}";
}

Scene Load(const std::string& text) {
  const Result<Scene> result = ParseScene(text, "test");
  REQUIRE_MESSAGE(result.ok(), Format(result.diagnostics()));
  return *result;
}

std::string Problems(const std::string& text) {
  const Result<Scene> result = ParseScene(text, "test");
  return Format(result.diagnostics());
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("Every scene of the project loads without a word") {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("scene")) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    const Result<Scene> scene = LoadScene(entry.path());
    CHECK_MESSAGE(scene.ok(), Format(scene.diagnostics()));
    CHECK_MESSAGE(scene.diagnostics().empty(), Format(scene.diagnostics()));
    if (!scene) continue;
    CHECK(scene->name == entry.path().string());
    const Result<Scene> again = ParseScene(FormatScene(*scene), "scene/again");
    REQUIRE_MESSAGE(again.ok(), Format(again.diagnostics()));
    CHECK(Same(*scene, *again));
    const bool ofTheCourse =
        std::count(std::begin(kCourseScenes), std::end(kCourseScenes), entry.path().stem().string()) > 0;
    if (!ofTheCourse) CHECK_FALSE(scene->camera.automatic);
  }
  CHECK(count >= 10);
}

TEST_CASE("The course's scenes have the course's values and no keys of ours") {
  const std::set<std::string> courseKeys = {"cloth",
                                            "sphere",
                                            "plane",
                                            "width",
                                            "height",
                                            "num_width_points",
                                            "num_height_points",
                                            "thickness",
                                            "orientation",
                                            "pinned",
                                            "enable_structural",
                                            "enable_shearing",
                                            "enable_bending",
                                            "damping",
                                            "density",
                                            "ks",
                                            "origin",
                                            "radius",
                                            "friction",
                                            "point",
                                            "normal"};
  for (const std::string name : kCourseScenes) {
    CAPTURE(name);
    const fs::path file = "scene/" + name + ".json";
    const Result<Scene> result = LoadScene(file);
    REQUIRE(result);
    const Scene& scene = *result;
    REQUIRE(scene.cloths.size() == 1);
    const ClothSettings& cloth = scene.cloths[0];
    const bool pinned2 = name == "pinned2", pinned4 = name == "pinned4", sphere = name == "sphere";
    CHECK(cloth.width == 1);
    CHECK(cloth.height == 1);
    CHECK(cloth.numWidthPoints == 50);
    CHECK(cloth.numHeightPoints == 50);
    CHECK(cloth.thickness == 0.0095);
    CHECK(cloth.damping == 0.2);
    CHECK(cloth.density == 150);
    CHECK(cloth.ks == 5000);
    CHECK((cloth.enableStructural && cloth.enableShearing && cloth.enableBending));
    CHECK(cloth.orientation == (name == "selfCollision" ? Orientation::Vertical : Orientation::Horizontal));
    std::vector<GridPoint> pins;
    if (pinned2) pins = {{0, 0}, {49, 0}};
    if (pinned4) pins = {{0, 0}, {49, 0}, {0, 49}, {49, 49}};
    CHECK(cloth.pinned == pins);
    REQUIRE(scene.spheres.size() == (sphere ? 1 : 0));
    if (sphere) {
      CHECK(scene.spheres[0].origin == Vec3{0.5, 0.2, 0.5});
      CHECK(scene.spheres[0].radius == 0.2);
      CHECK(scene.spheres[0].friction == 0.3);
    }
    REQUIRE(scene.planes.size() == (pinned2 || pinned4 || sphere ? 0 : 1));
    if (!scene.planes.empty()) {
      CHECK(scene.planes[0].point == Vec3{0, 0, 0});
      CHECK(scene.planes[0].normal == Vec3{0, 1, 0});
      CHECK(scene.planes[0].friction == 0.5);
    }
    CHECK(scene.simulation.framesPerSecond == 90);
    CHECK(scene.simulation.stepsPerFrame == 30);
    CHECK(scene.camera.automatic);

    const auto document = JsonDocument::Load(file);
    REQUIRE(document);
    for (const JsonIndex group : document->Children(0)) {
      CHECK(courseKeys.count(document->Key(group)) == 1);
      CHECK(document->Kind(group) == JsonKind::Object);
      for (const JsonIndex member : document->Children(group)) CHECK(courseKeys.count(document->Key(member)) == 1);
    }
  }
}

TEST_CASE("A scene survives being written and read, whatever it holds") {
  Scene scene = OneOfEach();
  CHECK(Same(Load(FormatScene(scene)), scene));
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].ks = 1.0 / 3;
  scene.cloths[1].origin = {-0.0, 1e-300, 123456.789012345678};
  scene.cloths[1].orientation = Orientation::Vertical;
  scene.spheres.resize(3);
  scene.spheres[2].radius = 0.1 + 0.2;
  scene.planesFirst = true;
  scene.simulation.hash = HashFunction::Brute;
  scene.simulation.planeResponse = PlaneResponse::Hold;
  scene.look.shader = "My \"own\" shader \xc3\xa9";
  scene.look.tangents = Tangents::FromUv;
  scene.camera.automatic = false;
  scene.pinMotions.clear();
  CHECK(Same(Load(FormatScene(scene)), scene));
}

TEST_CASE("Objects stand alone or in arrays") {
  const Scene one =
      Load("{\"cloth\": " + Cloth() + ", \"sphere\": {\"origin\": [0,0,0], \"radius\": 1, \"friction\": 0}}");
  const Scene same =
      Load("{\"cloth\": [" + Cloth() + "], \"sphere\": [{\"origin\": [0,0,0], \"radius\": 1, \"friction\": 0}]}");
  CHECK(Same(one, same));
  const Scene two =
      Load("{\"cloth\": [" + Cloth() + ", " + Cloth(", \"seed\": 5") + "], \"sphere\": [], \"plane\": []}");
  REQUIRE(two.cloths.size() == 2);
  CHECK(two.cloths[0].seed == 184);
  CHECK(two.cloths[1].seed == 5);
  CHECK(two.spheres.empty());
}

TEST_CASE("Colliders act in the order of the file") {
  const std::string sphere = "\"sphere\": {\"origin\": [0,0,0], \"radius\": 1, \"friction\": 0}";
  const std::string plane = "\"plane\": {\"point\": [0,0,0], \"normal\": [0,1,0], \"friction\": 0}";
  const std::string cloth = "\"cloth\": " + Cloth();
  CHECK(Load("{" + plane + "," + cloth + "," + sphere + "}").planesFirst);
  CHECK_FALSE(Load("{" + sphere + "," + plane + "," + cloth + "}").planesFirst);
  CHECK_FALSE(Load("{" + cloth + "," + plane + "}").planesFirst);
}

TEST_CASE("Keys that begin with '_' are comments anywhere") {
  CHECK(Same(
      Load("{\"_a\": [{}], \"cloth\": " + Cloth(", \"_ks\": \"x\", \"_\": null, \"_\": 1") + ", \"_\": 1, \"_\": 2}"),
      Load("{\"cloth\": " + Cloth() + "}")));
}

TEST_CASE("A byte-order mark and Windows line ends change nothing but are no part of a place") {
  const std::string text = "{\r\n\"cloth\": " + Cloth() + "\r\n}\r\n";
  CHECK(Same(Load("\xef\xbb\xbf" + text), Load(text)));
  const Result<Scene> marked = ParseScene("\xef\xbb\xbf{\"x\": 1}", "test");
  REQUIRE_FALSE(marked.ok());
  CHECK(marked.diagnostics().back().place.column == 2);
}

TEST_CASE("The camera is placed by hand as soon as the file says how, unless it says otherwise") {
  const auto camera = [](const std::string& keys) {
    return Load("{\"cloth\": " + Cloth() + ", \"camera\": {" + keys + "}}").camera;
  };
  CHECK(camera("").automatic);
  CHECK(camera("\"_comment\": 1").automatic);
  CHECK_FALSE(camera("\"distance\": 3").automatic);
  CHECK(camera("\"distance\": 3, \"automatic\": true").automatic);
  CHECK_FALSE(camera("\"automatic\": false").automatic);
}

TEST_CASE("All problems of a file are reported, sorted by place") {
  const std::string text =
      "{\n"
      "  \"clth\": 1,\n"
      "  \"ks\": 5,\n"
      "  \"cloth\": " +
      Cloth(",\n    \"pinned\": [[0, 0], [60, 0], [\"a\", 1]],\n    \"densty\": 3,\n    \"origin\": [0, 1]") +
      ",\n"
      "  \"sphere\": [{\"origin\": [0, 0, 0], \"radius\": -1, \"friction\": 2}, {\"radius\": 1}],\n"
      "  \"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 0, 0], \"friction\": \"x\"},\n"
      "  \"simulation\": {\"gravty\": [0, 0, 0], \"hash\": \"exakt\", \"wind\": 1},\n"
      "  \"pin_motion\": {\"end\": 1, \"displacement\": [0, 0, 0], \"start\": 2, \"cloth\": 4}\n"
      "}\n";
  const Result<Scene> result = ParseScene(text, "test");
  REQUIRE_FALSE(result.ok());
  const std::string report = Format(result.diagnostics());
  for (const char* expected : {
           "test:2:3: error: /clth: unknown key (did you mean `cloth`?)",
           "test:3:3: error: /ks: unknown key; it belongs in `cloth`",
           "test:5:34: error: /cloth/pinned/2/0: expected a whole number, got \"a\"",
           "test:6:5: error: /cloth/densty: unknown key (did you mean `density`?)",
           "test:7:15: error: /cloth/origin: expected an array of three numbers in m, got an array of 2",
           "test:8:46: error: /sphere/0/radius: expected a number > 0 m, got -1",
           "test:8:62: error: /sphere/0/friction: expected a number from 0 to 1, got 2",
           "error: /sphere/1/origin: this key is missing",
           "error: /sphere/1/friction: this key is missing",
           "error: /plane/normal: expected a direction",
           "error: /plane/friction: expected a number from 0 to 1, got \"x\"",
           "error: /simulation/gravty: unknown key (did you mean `gravity`?)",
           "error: /simulation/hash: expected one of",
           "error: /simulation/wind: unknown key; it belongs to the top level of the file",
       }) {
    CHECK_MESSAGE(Contains(report, expected), std::string(expected) << " in\n" << report);
  }
  const auto before = [](const Diagnostic& a, const Diagnostic& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  };
  CHECK(std::is_sorted(result.diagnostics().begin(), result.diagnostics().end(), before));
  // The pin (60, 0) cannot be judged while the list has no value; it comes up once that is mended.
  CHECK(Contains(Problems("{\"cloth\": " + Cloth(", \"pinned\": [[60, 0]]") + "}"),
                 "/cloth/pinned/0: expected a point of the grid"));
}

TEST_CASE("What follows from a broken value is not reported beside it") {
  // With 100 points along the width the pin is fine; the width's points are what is wrong.
  std::string text =
      "{\"cloth\": " + Cloth(", \"pinned\": [[80, 0]]") + ", \"pin_motion\": {\"end\": 1, \"displacement\": [0,0,0]}}";
  text.replace(text.find("\"num_width_points\": 50"), 22, "\"num_width_points\": \"100\"");
  const Result<Scene> result = ParseScene(text, "test");
  REQUIRE_FALSE(result.ok());
  CHECK_MESSAGE(result.diagnostics().size() == 1, Format(result.diagnostics()));
}

TEST_CASE("Warnings point at the value and leave the scene usable") {
  std::string text = "{\n\"cloth\":\n" + Cloth() + "}";
  text.replace(text.find("\"ks\": 5000"), 10, "\"ks\": 5e6");
  const Result<Scene> result = ParseScene(text, "test");
  REQUIRE(result);
  REQUIRE(result.diagnostics().size() == 1);
  const Diagnostic& warning = result.diagnostics()[0];
  CHECK(warning.severity == Severity::Warning);
  CHECK(warning.message.rfind("/cloth/ks: 5000000 N/m is above the stable limit", 0) == 0);
  const Place expected = test::PlaceAt(text, text.find("5e6"));
  CHECK(warning.place.line == expected.line);
  CHECK(warning.place.column == expected.column);

  const std::string inArray = Problems("{\"cloth\": [" + Cloth() + "," + Cloth(", \"pinned\": [[0,0],[0,0]]") + "]}");
  CHECK_MESSAGE(Contains(inArray, "warning: /cloth/1/pinned/1: [0, 0] is pinned already"), inArray);
}

TEST_CASE("A flood of problems is cut off, with their number") {
  std::string text = "{\"cloth\": {\"pinned\": [[\"x\", 0]";
  for (int k = 1; k < 5000; ++k) text += ", [\"x\", 0]";
  text += "]}}";
  const Result<Scene> result = ParseScene(text, "test");
  REQUIRE_FALSE(result.ok());
  CHECK(result.diagnostics().size() == 1001);
  CHECK(result.diagnostics().back().message == "and 4012 more problems");
}

TEST_CASE("A grid beyond memory is refused before anything is allocated") {
  std::string text = "{\"cloth\": " + Cloth() + "}";
  text.replace(text.find("\"num_width_points\": 50"), 22, "\"num_width_points\": 1000000");
  text.replace(text.find("\"num_height_points\": 50"), 23, "\"num_height_points\": 1000000");
  CHECK(Contains(Problems(text), "/cloth/num_width_points: expected at most"));
}

TEST_CASE("Files that cannot be read say so, with the nearest name") {
  const auto problem = [](const fs::path& file) {
    const Result<Scene> result = LoadScene(file);
    REQUIRE_FALSE(result.ok());
    return Format(result.diagnostics());
  };
  CHECK(Contains(problem("scene/pined2.json"), "there is no such file (did you mean scene/pinned2.json?)"));
  CHECK(Contains(problem("scene/zzzzzzzz.json"), "there is no such file\n"));
  CHECK(Contains(problem("no such folder/a.json"), "nor a folder \"no such folder\""));
  CHECK(Contains(problem("scene"), "this is a folder"));

  const fs::path file = fs::temp_directory_path() / "percale_unreadable_scene.json";
  std::ofstream(file) << "{}";
  fs::permissions(file, fs::perms::none);
  const bool readable = std::ifstream(file).is_open();  // as root everything is
  if (!readable) CHECK(Contains(problem(file), "cannot be opened"));
  fs::permissions(file, fs::perms::owner_all);
  fs::remove(file);

  const fs::path link = fs::temp_directory_path() / "percale_dangling_scene.json";
  std::error_code error;
  fs::remove(link);
  fs::create_symlink("nowhere.json", link, error);  // not everyone may, on Windows
  if (!error) CHECK(Contains(problem(link), "this is a link to nowhere.json, and there is no such file"));
  fs::remove(link);
}

TEST_CASE("Origins name the place of what the file states, and nothing else") {
  const std::string text = "{\n \"cloth\": [" + Cloth() + ",\n" + Cloth(", \"seed\": 3") + "]}";
  Origins origins;
  REQUIRE(ParseScene(text, "name", &origins));
  CHECK(origins.count("/cloth/0/ks") == 1);
  CHECK(origins.count("/cloth/0/seed") == 0);
  REQUIRE(origins.count("/cloth/1/seed") == 1);
  CHECK(origins["/cloth/1/seed"].line == 3);
  CHECK(origins["/cloth/1/seed"].file == "name");
  CHECK(origins.size() == 25);
}

TEST_CASE("The schema describes every parameter as the table does") {
  const auto schema = JsonDocument::Parse(SceneSchema(), "schema");
  REQUIRE_MESSAGE(schema.ok(), Format(schema.diagnostics()));
  const JsonDocument& d = *schema;
  CHECK(d.Text(d.Member(0, "$schema")) == "https://json-schema.org/draft/2020-12/schema");
  const JsonIndex definitions = d.Member(0, "$defs"), top = d.Member(0, "properties");
  CHECK(d.Children(definitions).size() == ParameterGroups().size());
  for (const ParameterGroup& group : ParameterGroups()) {
    CAPTURE(std::string(group.name));
    CHECK(d.Member(top, group.name) != 0);
    const JsonIndex definition = d.Member(definitions, group.name);
    REQUIRE(definition != 0);
    CHECK_FALSE(d.Boolean(d.Member(definition, "additionalProperties")));
    const JsonIndex properties = d.Member(definition, "properties");
    std::set<std::string> required;
    for (const JsonIndex name : d.Children(d.Member(definition, "required"))) required.insert(d.Text(name));
    std::size_t count = 0;
    for (const Parameter& p : Parameters()) {
      if (p.group != group.name) continue;
      ++count;
      CAPTURE(std::string(p.name));
      const JsonIndex property = d.Member(properties, p.name);
      REQUIRE(property != 0);
      // What a cloth must state depends on the engine: see below.
      CHECK((p.required && group.name != "cloth") == (required.count(std::string(p.name)) == 1));
      CHECK((d.Member(property, "type") != 0 || d.Member(property, "enum") != 0));
      CHECK(d.Member(property, "default") != 0);
      if (p.kind == ValueKind::Number) {
        const JsonIndex bound = d.Member(property, p.minExclusive ? "exclusiveMinimum" : "minimum");
        REQUIRE(bound != 0);
        CHECK(d.Number(bound) == p.min);
        CHECK(d.Number(d.Member(property, "maximum")) == p.max);
      }
      if (p.kind == ValueKind::Choice) CHECK(d.Children(d.Member(property, "enum")).size() == p.choices.size());
    }
    CHECK(d.Children(properties).size() == count);
  }

  const JsonIndex cloths = d.Member(d.Member(d.Member(0, "else"), "properties"), "cloth");
  REQUIRE(cloths != 0);
  const JsonIndex one = d.Children(d.Member(cloths, "anyOf"))[0];
  std::set<std::string> required;
  for (const JsonIndex name : d.Children(d.Member(one, "required"))) required.insert(d.Text(name));
  for (const Parameter& p : Parameters()) {
    if (p.group == "cloth") CHECK(p.required == (required.count(std::string(p.name)) == 1));
  }
}

}  // namespace
}  // namespace percale
