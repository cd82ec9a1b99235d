#pragma once
/// \file
/// The interactive viewer.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/preset_file.h"
#include "percale/scene.h"
#include "percale/world.h"
#include "render/scene_view.h"

namespace percale {

struct ViewerOptions {
  Scene scene;                      ///< As loaded, with `set` applied; must pass CheckScene.
  std::filesystem::path sceneFile;  ///< Where it is from: watched, and read again when it changes and by F5.
  /// Where it stands: a checkpoint's or picture's state, else so many frames from the start.
  std::shared_ptr<const WorldState> state;
  int frame = 0;
  std::vector<Preset> presets;       ///< For what `sceneFile` does not state, each time it is read.
  std::vector<std::string> set;      ///< "PATH=VALUE", applied again each time `sceneFile` is read.
  std::filesystem::path root = ".";  ///< The project's folder, with shaders/ and textures/.
  View view;                         ///< What the window opens with.
  bool keepUniforms = true;          ///< Read and keep the values of shaders' parameters (render/shader_values.h).
  bool wholeUniforms = false;        ///< `view` has all of its shader's, so that those kept do not count.
  int width = 0, height = 0;         ///< Of the window, on a display of ordinary density [pixel]; 0: as last time.
  double uiScale = 0;                ///< Of text and controls; 0: as the display asks for.
  int samples = 0;                   ///< Per pixel; 0: 4, or 1 where the CPU draws.
  int threads = 0;                   ///< Of the simulation; 0: as many as there are cores.
  std::size_t historyBudget = std::size_t{256} << 20;  ///< Memory for past frames [bytes]; 0: none are kept.
  std::filesystem::path settings;                    ///< File of what is kept from one start to the next; empty: none.
  std::vector<std::filesystem::path> presetFolders;  ///< The user's own, where presets are saved, then others.
  std::filesystem::path log;                         ///< Session log (apps/viewer/session_log.h); empty: none.
};

/// Shows the scene in a window, paused, until the user closes it. Messages go to stderr. Returns an
/// exit code: 0 closed by the user, 1 the log cannot be written, 3 the scene or the shaders will not
/// do, 5 no display or no OpenGL 3.3 (with what to do about it), 130 interrupted from the terminal.
int RunViewer(const ViewerOptions& options);

/// The keys and what they do, as a table in Markdown.
std::string KeyTable();

}  // namespace percale
