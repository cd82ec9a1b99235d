// Scenes whose cloths come from the files of meshes.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "io/scene_text.h"
#include "mesh/cloth_model.h"
#include "percale/checkpoint_file.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

/// A folder with the file of a mesh in `meshes`: two squares, the second with a vertex of its own at the seam.
struct Folder {
  Folder() : path(fs::temp_directory_path() / "percale_scene_mesh_test") {
    fs::remove_all(path);
    fs::create_directories(path / "meshes");
    Write("meshes/two.obj",
          "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 1 0 0.001\nv 9 9 9\n"
          "g left\nf 1 2 5 4\ng right\nf 7 3 6 5\n");
  }
  ~Folder() { fs::remove_all(path); }
  void Write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
  Result<Scene> Load(const std::string& cloth, const std::string& more = "") const {
    Write("a.json", "{\"simulation\": {\"engine\": \"fabric\"},\n \"cloth\": {\"shape\": \"mesh\",\n  \"mesh\": " +
                        cloth + "}" + more + "}");
    return LoadScene(path / "a.json");
  }
  std::string Problems(const std::string& cloth, const std::string& more = "") const {
    return Format(Load(cloth, more).diagnostics());
  }
  fs::path path;
};

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("A scene brings its mesh along") {
  const Folder folder;
  const Result<Scene> scene = folder.Load(
      "\"meshes/two.obj\", \"mesh_scale\": 0.5, \"pinned\": [3, [5, 0]], \"pinned_group\": \"left\"",
      ", \"patch\": {\"group\": \"right\", \"stretch\": 2},\n \"pin_motion\": {\"points\": [4], \"end\": 1, "
      "\"displacement\": [0, 1, 0]}");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  // The vertex of no triangle is told of, at the mesh.
  REQUIRE(scene.diagnostics().size() == 1);
  CHECK(Contains(scene.diagnostics()[0].place.file, "two.obj"));
  const ClothSettings& cloth = scene->cloths[0];
  REQUIRE(cloth.loaded);
  CHECK(cloth.loaded->mesh.positions.size() == 7);
  CHECK(cloth.loaded->mesh.positions[5] == Vec3{1, 0.5, 0});
  CHECK(PinnedVertices(cloth) == std::vector<std::int32_t>{0, 1, 3, 4, 5});
  World world(*scene);
  for (int frame = 0; frame < 3; ++frame) world.Step();
  CHECK_FALSE(world.report().divergence);
}

TEST_CASE("A scene with a mesh survives being written and read, here and elsewhere") {
  const Folder folder;
  const Result<Scene> scene = folder.Load(
      "\"meshes/two.obj\", \"weld\": true, \"weld_distance\": 0.01, \"pinned\": [0, 3], \"rotation\": [0, 90, 0]");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  CHECK(scene->cloths[0].loaded->mesh.positions.size() == 6);
  const Result<Scene> again = ParseScene(FormatScene(*scene), (folder.path / "other name.json").string());
  REQUIRE_MESSAGE(again.ok(), Format(again.diagnostics()));
  CHECK(test::Same(*scene, *again));
  CHECK(*again->cloths[0].loaded == *scene->cloths[0].loaded);
  CHECK_FALSE(EffectOf(*scene, *again));

  const Scene absolute = WithAbsolutePaths(*scene);
  CHECK_FALSE(HasErrors(CheckScene(absolute)));
  const Result<Scene> elsewhere = ParseScene(FormatScene(absolute), "no such folder/a.json");
  REQUIRE_MESSAGE(elsewhere.ok(), Format(elsewhere.diagnostics()));
  CHECK(elsewhere->cloths[0].loaded->mesh == scene->cloths[0].loaded->mesh);

  // So a checkpoint may be kept anywhere.
  World world(*scene);
  for (int frame = 0; frame < 3; ++frame) world.Step();
  WorldState state;
  world.Save(state);
  const Result<WorldState> read = ParseCheckpoint(FormatCheckpoint(state), "no such folder/a.percale");
  REQUIRE_MESSAGE(read.ok(), Format(read.diagnostics()));
  World other(*read->scene);
  other.Restore(*read);
  CHECK(other.StateHash() == world.StateHash());
}

TEST_CASE("Changed settings load their mesh, or tell why not") {
  const Folder folder;
  folder.Write("meshes/one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  Scene scene = *folder.Load("\"meshes/two.obj\"");
  const std::shared_ptr<const LoadedMesh> before = scene.cloths[0].loaded;
  REQUIRE(LoadMeshes(scene));
  CHECK(scene.cloths[0].loaded == before);  // nothing to do
  scene.cloths[0].mesh = "meshes/one.obj";
  CHECK(HasErrors(CheckScene(scene)));
  REQUIRE(LoadMeshes(scene));
  CHECK(CheckScene(scene).empty());
  CHECK(scene.cloths[0].loaded->mesh.triangles.size() == 1);
  scene.cloths[0].meshScale = 3;
  REQUIRE(LoadMeshes(scene));
  CHECK(scene.cloths[0].loaded->mesh.positions[1] == Vec3{3, 0, 0});
  scene.cloths[0].mesh = "meshes/none.obj";
  const Status failed = LoadMeshes(scene);
  REQUIRE_FALSE(failed.ok());
  CHECK(Contains(Format(failed.diagnostics()), "there is no such file"));
}

TEST_CASE("A mesh that cannot be used is told at its own place and at the scene's") {
  const Folder folder;
  folder.Write("meshes/bad.obj", "v 0 0 0\nv 1 x 0\nf 1 2 3\n");
  const auto check = [&](const std::string& cloth, std::initializer_list<const char*> expected) {
    const Result<Scene> scene = folder.Load(cloth);
    CHECK_FALSE(scene.ok());
    const std::string text = Format(scene.diagnostics());
    for (const char* part : expected) CHECK_MESSAGE(Contains(text, part), std::string(part) << " in\n" << text);
  };
  check("\"meshes/bad.obj\", \"pinned\": [1]",
        {"a.json:3:11: error: /cloth/mesh: \"meshes/bad.obj\" cannot be used", "bad.obj:2:"});
  check("\"meshes/none.obj\"", {"a.json:3:11: error: /cloth/mesh: ", "none.obj: error: there is no such file"});
  check("\"meshes\"", {"/cloth/mesh: "});
  check("\"\"", {"a.json:3:11: error: /cloth/mesh: expected the file of a mesh"});
  check("\"meshes/two.obj\", \"rest_shape\": \"texture\"", {"/cloth/mesh: ", "texture coordinates"});
  check("\"meshes/two.obj\", \"weld\": true, \"weld_distance\": 1e-12", {"/cloth/mesh: ", "distance for welding"});
  check("\"meshes/two.obj\", \"pinned\": [7]", {"/cloth/pinned/0: expected a vertex of the mesh, from 0 to 6, got 7"});
  check("\"meshes/two.obj\", \"pinned\": [1.5]", {"/cloth/pinned/0: expected a whole number"});
  check("\"meshes/two.obj\", \"pinned\": [\"left\"]", {"or the number of a vertex, got \"left\""});
  check("\"meshes/two.obj\", \"pinned_group\": \"lft\"", {"/cloth/pinned_group: ", "did you mean `left`?"});
  // What follows from the mesh is not told beside it.
  CHECK_FALSE(Contains(folder.Problems("\"meshes/none.obj\", \"pinned\": [1]"), "/cloth/pinned"));
  CHECK_FALSE(Contains(folder.Problems("\"meshes/none.obj\"", ", \"patch\": {\"group\": \"x\"}"), "/patch"));
  CHECK_FALSE(Contains(folder.Problems("5"), "is not loaded"));
  // The engine springs does not look at it.
  Scene springs = test::OneOfEach();
  springs.patches.clear();
  std::string text = FormatScene(springs);
  text.insert(text.find("\"width\""), "\"shape\": \"mesh\", \"mesh\": \"a.obj\", ");
  const std::string problems = Format(ParseScene(text, "b").diagnostics());
  CHECK(Contains(problems, "error: /cloth/shape: expected \"grid\", the one shape of the engine springs"));
  CHECK_FALSE(Contains(problems, "a.obj:"));
}

/// A cube of 1 m at the origin, two triangles a side; the first `faces` sides of it.
std::string Cube(bool insideOut, int faces = 6) {
  std::string text;
  for (int v = 0; v < 8; ++v)
    text += "v " + std::to_string(v & 1) + " " + std::to_string(v >> 1 & 1) + " " + std::to_string(v >> 2 & 1) + "\n";
  const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (int f = 0; f < faces; ++f) {
    text += "f";
    for (int k = 0; k < 4; ++k) text += " " + std::to_string(quads[f][insideOut ? 3 - k : k]);
    text += "\n";
  }
  return text;
}

double VolumeOf(const RestMesh& mesh) {
  double volume = 0;
  const auto at = [&](std::int32_t v) { return mesh.positions[static_cast<std::size_t>(v)]; };
  for (const Triangle& t : mesh.triangles) volume += Dot(at(t.a), Cross(at(t.b), at(t.c))) / 6;
  return volume;
}

TEST_CASE("A collider brings its mesh along, closed at its seams and turned outwards") {
  const Folder folder;
  folder.Write("meshes/cube.obj", Cube(false));
  folder.Write("meshes/in.obj", Cube(true));
  folder.Write("meshes/open.obj", Cube(false, 5));
  // Each side with corners of its own, as for a texture.
  std::string seams;
  const std::string cube = Cube(false);
  for (int f = 0; f < 6; ++f) seams += cube.substr(0, cube.find('f'));
  const int quads[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (int f = 0; f < 6; ++f) {
    seams += "f";
    for (const int v : quads[f]) seams += " " + std::to_string(v + 8 * f);
    seams += "\n";
  }
  folder.Write("meshes/seams.obj", seams);
  const auto load = [&](const std::string& collider) {
    folder.Write("b.json",
                 "{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {},\n\"collider\":\n{\"shape\": \"mesh\", " +
                     collider + "}}");
    return LoadScene(folder.path / "b.json");
  };
  const auto text = [&](const std::string& collider) { return Format(load(collider).diagnostics()); };

  const Result<Scene> scene = load("\"mesh\": \"meshes/cube.obj\", \"mesh_scale\": 2");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  CHECK(scene.diagnostics().empty());
  CHECK(VolumeOf(scene->colliders[0].loaded->mesh) == doctest::Approx(8));
  const Result<Scene> again = ParseScene(FormatScene(*scene), (folder.path / "c.json").string());
  REQUIRE(again.ok());
  CHECK(test::Same(*scene, *again));
  CHECK(*again->colliders[0].loaded == *scene->colliders[0].loaded);
  const Result<Scene> elsewhere = ParseScene(FormatScene(WithAbsolutePaths(*scene)), "no such folder/a.json");
  REQUIRE_MESSAGE(elsewhere.ok(), Format(elsewhere.diagnostics()));
  Scene changed = *scene;
  changed.colliders[0].meshScale = 1;
  CHECK(HasErrors(CheckScene(changed)));
  REQUIRE(LoadMeshes(changed));
  CHECK(CheckScene(changed).empty());
  CHECK(EffectOf(*scene, changed) == Effect::Rebuild);

  CHECK(load("\"mesh\": \"meshes/seams.obj\"").diagnostics().empty());
  CHECK(load("\"mesh\": \"meshes/seams.obj\"")->colliders[0].loaded->openEdges == 0);

  const Result<Scene> turned = load("\"mesh\": \"meshes/in.obj\"");
  REQUIRE(turned.ok());
  CHECK(VolumeOf(turned->colliders[0].loaded->mesh) == doctest::Approx(1));
  INFO(Format(turned.diagnostics()));
  CHECK(Contains(Format(turned.diagnostics()), "in.obj: warning: the mesh is inside out: its volume is -1 m^3"));

  CHECK(Contains(text("\"mesh\": \"meshes/open.obj\""),
                 "warning: /collider/two_sided: the mesh is open: 4 edges have one triangle only"));
  CHECK(load("\"mesh\": \"meshes/open.obj\", \"two_sided\": true").diagnostics().empty());
}

TEST_CASE("A mesh that is named, but whose shape is another, is warned of") {
  for (const std::string object : {"cloth", "collider"}) {
    const auto text = [&](const std::string& shape) {
      return Format(ParseScene("{\"simulation\": {\"engine\": \"fabric\"}, \"" + object + "\": [{" + shape +
                                   "\"mesh\": \"no.obj\"}]}",
                               "a.json")
                        .diagnostics());
    };
    INFO(text(""));
    CHECK(Contains(text(""), "warning: /" + object + "/0/mesh: \"no.obj\" is not read, for `shape` says otherwise"));
    CHECK(!Contains(text("\"shape\": \"mesh\", "), "is not read, for"));
  }
}

TEST_CASE("Of pieces of a collider each is turned outwards, but for the wall of a hollow") {
  const Folder folder;
  const auto piece = [](bool insideOut, double scale, const Vec3& at) {
    RestMesh mesh;
    for (int v = 0; v < 8; ++v)
      mesh.positions.push_back(at + scale * Vec3{double(v & 1), double(v >> 1 & 1), double(v >> 2 & 1)});
    const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::string out;
    for (const Vec3& p : mesh.positions)
      out += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (const auto& q : quads) {
      out += "f";
      for (int k = 0; k < 4; ++k) out += " " + std::to_string(q[insideOut ? 3 - k : k] - 8);
      out += "\n";
    }
    return out;
  };
  folder.Write("meshes/three.obj",
               piece(false, 1, {}) + piece(true, 0.5, {0.25, 0.25, 0.25}) + piece(true, 1, {3, 0, 0}));
  folder.Write("b.json",
               "{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {}, \"collider\": {\"shape\": \"mesh\", "
               "\"mesh\": \"meshes/three.obj\"}}");
  const Result<Scene> scene = LoadScene(folder.path / "b.json");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  CHECK(VolumeOf(scene->colliders[0].loaded->mesh) == doctest::Approx(1 - 0.125 + 1));
  REQUIRE(scene.diagnostics().size() == 1);
  CHECK(Contains(Format(scene.diagnostics()), "piece 2 of the mesh is inside out: its volume is -1 m^3"));
}

TEST_CASE("What is wrong with a collider is told at its place") {
  const Folder folder;
  folder.Write("meshes/bad.obj", "v 0 0 0\nv 1 x 0\nf 1 2 3\n");
  const auto check = [&](const std::string& more, std::initializer_list<const char*> expected) {
    const Result<Scene> scene = ParseScene("{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {},\n" + more + "}",
                                           (folder.path / "a.json").string());
    CHECK_FALSE(scene.ok());
    const std::string text = Format(scene.diagnostics());
    for (const char* part : expected) CHECK_MESSAGE(Contains(text, part), std::string(part) << " in\n" << text);
    CHECK_FALSE(Contains(text, "LoadMeshes"));
  };
  check("\"collider\": {\"shape\": \"mesh\", \"mesh\": \"meshes/bad.obj\"}",
        {"a.json:2:39: error: /collider/mesh: \"meshes/bad.obj\" cannot be used", "bad.obj:2:"});
  check("\"collider\": {\"shape\": \"mesh\", \"mesh\": \"none.obj\"}", {"there is no such file"});
  check("\"collider\": {\"shape\": \"mesh\"}", {"a.json:2:13: error: /collider/mesh: expected the file of a mesh"});
  check("\"collider\": {\"shape\": \"mesh\", \"mesh\": \"meshes/two.obj\", \"mesh_scale\": 0}",
        {"/collider/mesh_scale: expected a number > 0 m, got 0"});
  check("\"collider\": {\"shape\": \"ball\"}", {"a.json:2:23: error: /collider/shape: expected one of \"sphere\", "});
  check("\"collider\": {\"size\": [1, 2]}",
        {"/collider/size: expected an array of three numbers > 0 m, got an array of 2"});
  check("\"collider\": [{}, {\"radius\": -1}]",
        {"a.json:2:29: error: /collider/1/radius: expected a number > 0 m, got -1"});
  check("\"collider\": {\"friction\": 11}", {"/collider/friction: expected a number from 0 to 10, got 11"});
  check("\"collider\": {\"frictoin\": 1}", {"/collider/frictoin: unknown key (did you mean `friction`?)"});
  check("\"collider\": 5", {"/collider: expected an object or an array of objects, got 5"});
  check("\"collider\": {\"shape\": \"torus\", \"radius\": 0.1, \"tube_radius\": 0.1}",
        {"a.json:2:62: error: /collider/tube_radius: expected less than the radius"});
  check("\"collider_motion\": {\"end\": 1}", {"/collider_motion/collider: there is no collider that could move"});
  check("\"collider\": {}, \"collider_motion\": [{\"end\": 1}, {\"collider\": 1, \"end\": 1}]",
        {"a.json:2:62: error: /collider_motion/1/collider: expected the index of a collider, 0 as there is only one, "
         "got 1"});
  check("\"collider\": {}, \"collider_motion\": {\"start\": 2, \"end\": 1}",
        {"a.json:2:56: error: /collider_motion/end: expected a time after the start at 2 s, got 1 s"});
  check("\"collider\": {}, \"collider_motion\": {\"start\": 2}", {"/collider_motion/end: this key is missing"});
  check("\"collider\": {}, \"collider_motion\": {\"end\": 1, \"angle\": 9, \"axis\": [0, 0, 0]}",
        {"/collider_motion/axis: expected a direction"});
}

TEST_CASE("A motion that leaps is warned of unless it says that it jumps, and a mesh that is flat") {
  const Folder folder;
  const auto text = [&](const std::string& more) {
    const Result<Scene> scene = ParseScene("{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {},\n" + more + "}",
                                           (folder.path / "a.json").string());
    CHECK(scene.ok());
    return Format(scene.diagnostics());
  };
  const std::string motion = "\"collider\": {\"radius\": 0.1}, \"collider_motion\": {\"start\": 1, ";
  const std::string leap =
      "warning: /collider_motion: goes up to 0.5 m in a step of 0.0166 s, farther than the collider is "
      "large, 0.2 m; slow it down, raise simulation.steps_per_frame, or set `jump` to true";
  CHECK(Contains(text(motion + "\"end\": 1.01, \"displacement\": [0, 0.5, 0]}"), leap));
  CHECK(Contains(text(motion + "\"end\": 1.01, \"angle\": 90, \"centre\": [1, 0, 0]}"), "goes up to 1.57 m"));
  CHECK(text(motion + "\"end\": 1.01, \"displacement\": [0, 0.5, 0], \"jump\": true}").empty());
  CHECK(text(motion + "\"end\": 1, \"displacement\": [0, 0.5, 0], \"jump\": true}").empty());
  CHECK(text(motion + "\"end\": 1.1, \"displacement\": [0, 0.5, 0]}").empty());
  CHECK(text(motion + "\"end\": 1.01, \"angle\": 90}").empty());
  folder.Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 3 4\nf 1 4 2\n");
  CHECK(Contains(text("\"collider\": {\"shape\": \"mesh\", \"mesh\": \"flat.obj\"}"),
                 "flat.obj: warning: the mesh is flat: it is closed and has no volume"));
}

TEST_CASE("A motion's centre is the collider's own unless one is stated") {
  const auto own = [](const std::string& keys) {
    const Result<Scene> scene = ParseScene(
        "{\"simulation\": {\"engine\": \"fabric\"}, \"cloth\": {}, \"collider\": {}, \"collider_motion\": {\"end\": 1" +
            keys + "}}",
        "test");
    REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
    return scene->colliderMotions[0].ownCentre;
  };
  CHECK(own(""));
  CHECK_FALSE(own(", \"centre\": [0, 0, 0]"));
  CHECK(own(", \"own_centre\": true, \"centre\": [0, 0, 0]"));
  CHECK_FALSE(own(", \"own_centre\": false"));
}

}  // namespace
}  // namespace percale
