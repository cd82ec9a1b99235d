#include "apps/viewer/scene_source.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/atomic_file.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"
#include "render/view_file.h"

namespace percale::viewer {
namespace {

namespace fs = std::filesystem;

/// Sets what the command line wants where the file does not say otherwise. Returns what would not do: the rest of the
/// scene is good.
Diagnostics ApplyOptions(const ViewerOptions& options, const ViewFile& file, Scene& scene) {
  // A checkpoint or a picture states all of its values.
  for (const Preset& preset : options.presets) {
    if (!file.view && !file.state) ApplyBelow(preset, file.origins, scene);
  }
  Diagnostics problems;
  for (const std::string& assignment : options.set) {
    const auto applied = ApplyAssignment(scene, assignment);
    if (applied) continue;
    for (Diagnostic d : applied.diagnostics()) {
      d.severity = Severity::Warning;
      problems.push_back(std::move(d));
    }
  }
  return problems;
}

/// The files that the scene names for its cloths and colliders, or nothing for each that has none.
std::vector<std::string> Meshes(const Scene& scene) {
  std::vector<std::string> files;
  for (const ClothSettings& cloth : scene.cloths) files.push_back(cloth.mesh);
  for (const ColliderSettings& collider : scene.colliders) {
    files.push_back(collider.mesh);
    files.push_back(collider.cache);
  }
  return files;
}

/// Without the path that it begins with.
std::string_view WithoutPath(const Diagnostic& d) {
  return std::string_view(d.message).substr(std::min(d.message.find(": "), d.message.size()));
}

}  // namespace

SceneSource::SceneSource(const ViewerOptions& options)
    : options_(options), file_(options.sceneFile), browsed_(options.sceneFile), scene_(options.scene) {
  Watch();
}

Result<SceneReading> SceneSource::Read(const fs::path& file) const {
  // Reading a pipe would wait for a writer, and the window with it.
  std::error_code ignored;
  if (fs::is_other(fs::status(file, ignored)))
    return MakeError(PathText(file), "expected a scene file, got a device or pipe");
  const Result<ViewFile> opened = OpenViewFile(file, options_.root);
  if (!opened) return opened.diagnostics();
  SceneReading reading{.scene = opened->scene};
  reading.statesShader = opened->view || opened->state || opened->origins.count("/look/shader") > 0;
  Diagnostics problems;
  if (file == options_.sceneFile) problems = ApplyOptions(options_, *opened, reading.scene);
  if (const Status loaded = LoadMeshes(reading.scene); !loaded) return loaded.diagnostics();
  const Diagnostics checked = CheckScene(reading.scene);
  if (HasErrors(checked)) return checked;
  // What CheckScene warns of is told as a property of the settings, which sliders can mend. The loader
  // names a value as the file does, so that the paths of the two may differ.
  for (const Diagnostic& d : opened.diagnostics()) {
    const bool isOfSettings = std::any_of(checked.begin(), checked.end(),
                                          [&](const Diagnostic& c) { return WithoutPath(c) == WithoutPath(d); });
    if (!isOfSettings) problems.push_back(d);
  }
  return {std::move(reading), std::move(problems)};
}

Result<SceneReading> SceneSource::ReadAgain() {
  for (FileWatch& watch : watches_) watch.Accept();
  return Read(file_);
}

void SceneSource::Adopt(const fs::path& file, const Scene& scene) {
  file_ = browsed_ = file;
  scene_ = scene;
  Watch();
}

void SceneSource::Adopt(const Scene& scene) {
  const bool others = Meshes(scene) != Meshes(scene_);
  scene_ = scene;
  if (others) Watch();
}

bool SceneSource::Changed() {
  bool changed = false;  // All are looked at, each time.
  for (FileWatch& watch : watches_) changed = watch.Changed() || changed;
  return changed;
}

void SceneSource::Watch() {
  watches_.assign(1, FileWatch(file_));
  for (const std::string& mesh : Meshes(scene_)) {
    if (!mesh.empty()) watches_.emplace_back(MeshFile(scene_, mesh));
  }
}

fs::path SceneSource::Folder() const {
  return browsed_.parent_path().empty() ? "." : browsed_.parent_path();
}

std::vector<fs::path> SceneSource::Files() const {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(Folder(), error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".json") files.push_back(browsed_.parent_path() / entry->path().filename());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<fs::path> SceneSource::Next(int by) const {
  const std::vector<fs::path> files = Files();
  if (files.empty()) return MakeError(PathText(Folder()), "there is no scene file (*.json) in this folder");
  const int count = static_cast<int>(files.size());
  const auto found = std::lower_bound(files.begin(), files.end(), browsed_);
  int at = static_cast<int>(found - files.begin());
  // From a file that is no more, forwards leads to the one that stands in its place.
  if ((found == files.end() || *found != browsed_) && by > 0) --at;
  return files[static_cast<std::size_t>(((at + by) % count + count) % count)];
}

}  // namespace percale::viewer
