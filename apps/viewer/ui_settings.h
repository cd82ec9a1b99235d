#pragma once
/// \file
/// What the viewer keeps from one start to the next: one JSON file in the user's configuration folder.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"

namespace percale::viewer {

/// Where a window is and how large, as on a display of ordinary density [pixel].
struct WindowPlace {
  int x = 0, y = 0, width = 0, height = 0;
};

struct UiSettings {
  std::optional<WindowPlace> window;
  bool panelsVisible = true;
  bool consoleVisible = false;
  std::map<std::string, bool> panelsOpen;   ///< By title; one that is not here is as its table says.
  std::vector<std::string> recentScenes;    ///< Files with their folders, the latest first.
  std::vector<std::string> recentCommands;  ///< Of the palette, the latest first.
  std::set<std::string> usedHints;          ///< Actions that the user has found: no more hints about them.
};

/// Puts `text` first in a list of recent things, which has it once and does not grow beyond what is useful.
void Remember(std::vector<std::string>& recent, std::string_view text);

/// A file that is missing holds nothing. What cannot be read is told, and left at its default.
UiSettings LoadUiSettings(const std::filesystem::path& file, Diagnostics& problems);

/// Replaces the file, and makes its folder if need be.
Status SaveUiSettings(const std::filesystem::path& file, const UiSettings& settings);

}  // namespace percale::viewer
