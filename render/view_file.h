#pragma once
/// \file
/// Files that bring a view back: scenes, checkpoints, and pictures that tell what they show.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/scene.h"
#include "percale/scene_file.h"
#include "percale/world.h"
#include "render/image.h"
#include "render/scene_view.h"

namespace percale {

/// A larger state is not stored in a picture: a checkpoint is the place for it [bytes].
inline constexpr std::size_t kMostStateInPicture = std::size_t{64} << 20;

/// What a file opens.
struct ViewFile {
  Scene scene;
  Origins origins;            ///< Of a scene file's values.
  std::optional<View> view;   ///< Of a picture.
  int width = 0, height = 0;  ///< Of a picture [pixel].
  /// Of a checkpoint; of a picture, where it may have seen more than its scene tells: a hand, a ball, settings
  /// that changed on the way. Its scene is `scene` but for look and camera.
  std::shared_ptr<const WorldState> state;
  int frame = 0;  ///< Without a state: so many frames from the start lead to what the picture shows.
};

/// Reads a checkpoint (NAME.percale), a picture (NAME.png), or else a scene file. Fails as those do, and on a
/// picture that does not tell what it shows. `project`: the project's folder, where meshes of pictures may be.
Result<ViewFile> OpenViewFile(const std::filesystem::path& file, const std::filesystem::path& project = {});

/// The texts of a picture that bring back what it shows: `scene` with look and camera as in the view, and
/// the state at its frame, or null where `frame` frames from the start lead there. Meshes and caches are named as from
/// the project's folder, or the scene's own (WithPortablePaths).
std::vector<PngText> DescribePicture(const Scene& scene, const View& view, int frame, const WorldState* state,
                                     const std::filesystem::path& project = {});

/// Reads what a picture tells; nothing where it is a picture of others. Its meshes and caches may lie where they do as
/// seen from the picture's folder, from the current one, or from the project's. Fails when it is none, or cut, when its
/// texts are damaged or of another version, and when a file is in none of those folders.
Result<std::optional<ViewFile>> ReadPictureView(const std::filesystem::path& file,
                                                const std::filesystem::path& project = {});

}  // namespace percale
