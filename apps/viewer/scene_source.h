#pragma once
/// \file
/// Where the scene comes from: its file, read anew when it changes, and the others of its folder.

#include <filesystem>
#include <vector>

#include "apps/viewer/file_watch.h"
#include "apps/viewer/viewer.h"
#include "percale/diagnostic.h"
#include "percale/scene.h"

namespace percale::viewer {

/// What a scene file says.
struct SceneReading {
  Scene scene;
  bool statesShader = false;  ///< Else the one in use may stay.
};

class SceneSource {
 public:
  /// At the scene file of the options, which must outlive it.
  explicit SceneSource(const ViewerOptions& options);

  const std::filesystem::path& file() const { return file_; }
  const Scene& scene() const { return scene_; }  ///< As the file had it when it was read last.

  /// Reads any scene, checkpoint or picture, for the options' file with their assignments.
  Result<SceneReading> Read(const std::filesystem::path& file) const;
  /// Reads the file as it is now.
  Result<SceneReading> ReadAgain();
  /// `scene` was read from `file`, which is the scene's from now on.
  void Adopt(const std::filesystem::path& file, const Scene& scene);
  /// What ReadAgain has read counts.
  void Adopt(const Scene& scene);
  /// Whether the file, or that of one of its meshes, was saved since it was read. See FileWatch.
  bool Changed();

  /// The scene files of the folder that the current one is in, by name.
  std::vector<std::filesystem::path> Files() const;
  /// The one that follows in that folder, or with `by` < 0 the one before. Fails where there is none.
  Result<std::filesystem::path> Next(int by) const;
  /// The one that others follow from now on, also when it cannot be read.
  void BrowseTo(const std::filesystem::path& file) { browsed_ = file; }

 private:
  std::filesystem::path Folder() const;
  void Watch();

  const ViewerOptions& options_;
  std::filesystem::path file_;
  std::filesystem::path browsed_;
  Scene scene_;
  std::vector<FileWatch> watches_;  // the file, and the meshes' files
};

}  // namespace percale::viewer
