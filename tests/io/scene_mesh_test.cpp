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

}  // namespace
}  // namespace percale
