#pragma once
/// \file
/// The state of the user interface itself: what is open, selected and being typed. Nothing here
/// concerns the simulation.

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/frame_table.h"
#include "apps/viewer/palette.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_settings.h"
#include "mesh/engine_types.h"
#include "percale/world.h"
#include "render/heat_scale.h"

namespace percale::viewer {

/// A rectangle of the window [screen unit], from the top left.
struct Box {
  float x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

/// Who gets the arrow keys, Enter, Space and Tab.
enum class KeyboardIn { Picture, Panels, Console };
constexpr int kKeyboardMoves = 2;  // Pictures.
/// The name that is being typed for a new shader.
struct NewShaderInput {
  char name[65] = {};
  bool fresh = true;    ///< The box is to get the keyboard.
  std::string problem;  ///< With the name before.
};

struct UiState {
  UiSettings kept;  ///< From one start to the next.
  bool helpVisible = false;
  bool quit = false;
  int cloth = Session::kAll;  ///< Whose settings the panels show and set.
  Vec3 pointerRay{0, 0, -1};  ///< From the eye to what the pointer is over, of length 1.
  float scale = 1;            ///< Of text and controls: 1 on a display of ordinary density.

  /// The number that is being typed: the id of its box, and the text so far.
  unsigned editedBox = 0;
  std::string editedText;

  /// Stage times, smoothed so that they can be read [s].
  std::array<double, kStageCount> stageSeconds{};
  double frameSeconds = 0;
  double drawSeconds = 0;  ///< Of a picture and the panels [s].

  std::optional<NewShaderInput> newShader;
  /// The colours of the last picture, and the range that is being typed for them.
  HeatScale heatScale;
  double arrowForce = 0;  ///< Of its longest arrow of contact [N]; 0: none.
  ValueRange typedRange;

  bool plotsVisible = false;
  std::optional<std::vector<FrameRow>> plotsHeld;  ///< Shown in place of the newest frames.
  std::optional<double> plotCursor;                ///< The time that is pointed at [s].
  std::vector<double> plotRatios;                  ///< Memory for measuring.

  bool inspectorVisible = false;
  bool inspectorHeld = false;  ///< Stays with the vertex, wherever the pointer is.
  VertexRef inspected, inspectedLogged;
  float inspectorSize[2] = {};  ///< As it was last drawn [screen unit].

  Palette palette;
  std::vector<std::filesystem::path> presetFolders;  ///< Where they are saved, then others.
  std::string presetName;                            ///< Typed for the next one to be saved.
  std::string consoleFilter;
  std::array<bool, 3> consoleShows{true, true, true};  ///< By Severity.
  /// To be shown and given the keyboard: a parameter ("cloth.ks"), or "panel Gravity"; empty: none.
  std::string jump;
  bool jumpSearching = false;  ///< All panels are open in this picture, to see which one has it.
  bool jumpFound = false;      ///< One of them has.
  bool jumpHere = false;       ///< The next control is it.
  KeyboardIn keyboardIn = KeyboardIn::Picture;
  int keyboardMoves = 0;       ///< Pictures until it goes there; the window there has to know before.
  std::string focusedControl;  ///< That has the keyboard, by its name in the log.
  std::string hoveredControl;  ///< That the pointer is over.
  std::string activeControl;   ///< That is held down, edited, or takes what is typed.

  std::string hintLogged, tooltipLogged;  ///< The hint, and whose tooltip, the log has.

  /// What the pointer rests on, for its tooltip: the control's place, and since when [s].
  float hoveredAt[2] = {-1, -1};
  double hoveredSince = 0;

  std::size_t messagesSeen = 0, consoleSeen = 0;  ///< How long the lists were when they were last drawn.

  /// Where the controls of the last picture are, by name, for the session log; unused without one.
  std::map<std::string, Box> boxes;
};

}  // namespace percale::viewer
