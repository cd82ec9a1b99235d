#pragma once
/// \file
/// The state of the user interface itself: what is open, selected and being typed. Nothing here
/// concerns the simulation.

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "apps/viewer/session.h"
#include "percale/world.h"

namespace percale::viewer {

/// A rectangle of the window [screen unit], from the top left.
struct Box {
  float x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

struct UiState {
  bool panelsVisible = true;
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

  /// What the pointer rests on, for its tooltip: the control's place, and since when [s].
  float hoveredAt[2] = {-1, -1};
  double hoveredSince = 0;

  std::size_t messagesSeen = 0;  ///< How long the list was when it was last drawn.

  /// Where the controls of the last picture are, by name, for the session log; unused without one.
  std::map<std::string, Box> boxes;
};

}  // namespace percale::viewer
