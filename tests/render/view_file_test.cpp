#include "render/view_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base64.h"
#include "io/atomic_file.h"
#include "percale/checkpoint_file.h"

using namespace percale;
namespace fs = std::filesystem;

namespace {

fs::path Folder() {
  const fs::path folder = fs::temp_directory_path() / "percale_view_file_test";
  fs::create_directories(folder);
  return folder;
}

World MakeWorld() {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = cloth.numHeightPoints = 30;
  cloth.thickness = 0.01;
  cloth.pinned = {{0, 0}};
  scene.cloths = {cloth};
  World world(scene);
  for (int i = 0; i < 5; ++i) world.Step();
  world.AddBall({{0.5, 1.5, 0.5}, {0.1, -3, 0}, 0.1, 20});
  for (int i = 0; i < 2; ++i) world.Step();
  return world;
}

View MakeView(const Scene& scene) {
  View view = View::ForScene(scene);
  view.look.shader = "Phong";
  view.camera.Orbit(31, -17, 400, 300);
  view.wireframe = true;
  view.sphereLatitudes = 12;
  view.heatMap = {Quantity::Speed, ValueRange{0.1, 2.5}};
  view.overlays.pins = view.overlays.boxes = true;
  view.uniforms = {{"u_shininess", {0.1f, 0, 0}}, {"u_upper", {0.25f, 1e-20f, 1}}};
  view.textures[2] = TextPath("/a folder/\"é\".png");
  return view;
}

/// The texts of a picture, written and read back as a view; the message of a failure.
std::string Failure(const std::vector<PngText>& texts) {
  const fs::path file = Folder() / "picture.png";
  REQUIRE(WritePng(file, MakeImage(3, 2), {.text = texts}));
  const auto read = ReadPictureView(file);
  return read ? std::string() : read.diagnostics().front().message;
}

}  // namespace

TEST_CASE("a picture tells all that it shows, to the bit") {
  World world = MakeWorld();
  WorldState state;
  world.Save(state);
  const View view = MakeView(world.scene());
  REQUIRE(Failure(DescribePicture(world.scene(), view, 7, &state)).empty());
  const Result<ViewFile> opened = OpenViewFile(Folder() / "picture.png");
  REQUIRE(opened);
  REQUIRE(opened->view);
  CHECK(opened->frame == 7);
  CHECK(opened->scene.look.shader == "Phong");
  CHECK(opened->view->look.shader == "Phong");
  CHECK(opened->view->camera.position() == view.camera.position());
  CHECK(opened->view->wireframe);
  CHECK(opened->view->sphereLatitudes == 12);
  CHECK(opened->view->heatMap == view.heatMap);
  CHECK(opened->view->overlays == view.overlays);
  CHECK(opened->view->uniforms == view.uniforms);
  CHECK(opened->view->textures == view.textures);
  REQUIRE(opened->state);
  World other(*opened->state->scene);
  other.Restore(*opened->state);
  for (int i = 0; i < 5; ++i) {
    REQUIRE(other.StateHash() == world.StateHash());
    other.Step();
    world.Step();
  }
  // Without a state there is the frame.
  REQUIRE(Failure(DescribePicture(world.scene(), view, 7, nullptr)).empty());
  CHECK_FALSE(OpenViewFile(Folder() / "picture.png")->state);
}

TEST_CASE("a picture whose texts are lost, changed or of another version is told") {
  World world = MakeWorld();
  WorldState state;
  world.Save(state);
  const std::vector<PngText> good = DescribePicture(world.scene(), MakeView(world.scene()), 7, &state);
  REQUIRE(good.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<PngText> texts = good;
    texts.erase(texts.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(Failure(texts).find("lost some of its texts") != std::string::npos);
  }
  const auto changed = [&](std::size_t which, const std::string& from, const std::string& to) {
    std::vector<PngText> texts = good;
    const std::size_t at = texts[which].text.find(from);
    REQUIRE(at != std::string::npos);
    texts[which].text.replace(at, from.size(), to);
    const std::string failure = Failure(texts);
    CAPTURE(failure);
    return failure;
  };
  CHECK(changed(1, "\"version\":1", "\"version\":9").find("version 9") != std::string::npos);
  CHECK(changed(1, "\"wireframe\":true", "\"wireframe\":5").find("damaged") != std::string::npos);
  CHECK(changed(1, "{", "[").find("damaged") != std::string::npos);
  CHECK(changed(2, "7", "-7").find("percale:frame") != std::string::npos);
  CHECK(changed(2, "7", "8").find("not one of its scene") != std::string::npos);
  CHECK(changed(0, "0.01", "0.02").find("not one of its scene") != std::string::npos);
  CHECK_FALSE(changed(0, "\"cloth\"", "\"cloath\"").empty());
  for (const std::size_t at : {std::size_t{5}, std::size_t{401}, good[3].text.size() - 9}) {
    std::vector<PngText> texts = good;
    texts[3].text[at] = texts[3].text[at] == 'A' ? 'B' : 'A';
    CHECK_FALSE(Failure(texts).empty());
  }
  CHECK(changed(3, "A", "*").find("base64") != std::string::npos);
  std::vector<PngText> texts = good;
  texts[3].text.resize(texts[3].text.size() - 4);
  CHECK(Failure(texts).find("cut short") != std::string::npos);
}

/// A project in a folder of its own, with a sheet of four vertices that is a mesh.
fs::path MakeProject() {
  const fs::path project = Folder() / "project";
  fs::remove_all(project);
  fs::create_directories(project / "scene/meshes");
  std::ofstream(project / "scene/meshes/sheet.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
  std::ofstream(project / "scene/a.json") << R"({"simulation": {"engine": "fabric"},
    "cloth": {"shape": "mesh", "mesh": "meshes/sheet.obj"}})";
  return project;
}

TEST_CASE("a picture names no folder of the machine, and finds its meshes from its own folder or the project's") {
  const fs::path project = MakeProject();
  const std::string there = (project / "scene/meshes/sheet.obj").string();
  Result<Scene> scene = LoadScene(project / "scene/a.json");
  REQUIRE_MESSAGE(scene.ok(), Format(scene.diagnostics()));
  SUBCASE("as the scene names them") {}
  SUBCASE("with absolute paths in the scene") {
    *scene = WithAbsolutePaths(*scene);
    REQUIRE(scene->cloths[0].mesh == there);
  }
  World world(*scene);
  world.Step();
  WorldState state;
  world.Save(state);
  const View view = View::ForScene(*scene);
  const auto write = [&](const fs::path& picture, const fs::path& from, const WorldState* with) {
    const std::vector<PngText> texts = DescribePicture(*scene, view, 1, with, from);
    for (const PngText& text : texts) {
      const std::string plain = text.keyword == "percale:state" ? FromBase64(text.text).value() : text.text;
      CHECK(plain.find(project.string()) == std::string::npos);
    }
    fs::create_directories(picture.parent_path());
    REQUIRE(WritePng(picture, MakeImage(3, 2), {.text = texts}));
  };
  const auto findsIt = [&](const fs::path& picture, const fs::path& from) {
    const Result<ViewFile> opened = OpenViewFile(picture, from);
    REQUIRE_MESSAGE(opened.ok(), Format(opened.diagnostics()));
    CHECK(opened->scene.cloths[0].mesh == there);
    REQUIRE(opened->state);
    CHECK(opened->state->scene->cloths[0].mesh == there);
    World other(*opened->state->scene);
    other.Restore(*opened->state);
    CHECK(other.StateHash() == world.StateHash());
  };
  const fs::path elsewhere = Folder() / "elsewhere/picture.png", beside = project / "scene/picture.png";
  write(elsewhere, project, &state);
  findsIt(elsewhere, project);
  // Without a project, names go from the scene's folder.
  write(beside, {}, &state);
  findsIt(beside, {});
  write(elsewhere, {}, nullptr);
  const Result<ViewFile> lost = OpenViewFile(elsewhere, project);
  REQUIRE_FALSE(lost);
  const std::string message = Format(lost.diagnostics());
  CHECK_MESSAGE(message.find("needs the file \"meshes/sheet.obj\", which was looked for from these folders: ") !=
                    std::string::npos,
                message);
  CHECK(message.find(elsewhere.parent_path().string()) != std::string::npos);
  fs::remove_all(project);
  fs::remove_all(elsewhere.parent_path());
}

TEST_CASE("a picture of others tells nothing, and that is told") {
  CHECK(Failure({{"Title", "A cat"}}).empty());
  CHECK_FALSE(ReadPictureView(Folder() / "picture.png")->has_value());
  const Result<ViewFile> opened = OpenViewFile(Folder() / "picture.png");
  REQUIRE_FALSE(opened);
  CHECK(opened.diagnostics().front().message.find("does not tell what it shows") != std::string::npos);
  CHECK_FALSE(ReadPictureView(Folder() / "missing.png"));
}
