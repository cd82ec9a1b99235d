#pragma once
/// \file
/// The panels, each in a file of its own, and the column that holds them.

#include <span>
#include <string>
#include <string_view>

#include "apps/viewer/frame_table.h"

namespace percale::viewer {

class Session;
struct Gizmo;
struct UiState;

/// Names of the windows that can have the keyboard.
constexpr const char* kPanelsTitle = "Panels";
constexpr const char* kConsoleTitle = "Console";

/// A function that draws what a panel holds.
using PanelContent = void(Session& session, UiState& state);

struct Panel {
  const char* title;
  bool openAtStart;
  PanelContent* draw;
  bool (*hasContent)(const Session&) = nullptr;  ///< Null: always.
};

/// From top to bottom: the course's in its order, then Percale's own.
std::span<const Panel> Panels();

PanelContent DrawSpringsPanel, DrawParametersPanel, DrawFabricPanel, DrawSimulationPanel, DrawDampingPanel,
    DrawGravityPanel, DrawAppearancePanel, DrawScenesPanel, DrawPresetsPanel, DrawCollisionsPanel, DrawCollidersPanel,
    DrawWindPanel, DrawOverlaysPanel, DrawStatisticsPanel;

/// Width of the column at the right that holds the panels [screen unit].
float PanelColumnWidth(const UiState& state);
/// The column, for a window of that size [screen unit].
void DrawPanelColumn(Session& session, UiState& state, float width, float height);
/// What is wrong, at the lower edge of the picture; nothing when nothing is.
void DrawMessages(Session& session, UiState& state, float pictureWidth, float height);
/// Frames that are kept, at the lower edge of the picture; nothing without a history. Returns its height [screen unit].
float DrawTimeBar(Session& session, UiState& state, float pictureWidth, float height);
/// "history 12 / 256 MB"; empty without one.
std::string HistoryText(const Session& session);
/// While recording, a red dot and the seconds so far, in the upper right corner of the picture.
void DrawRecordingLight(const Session& session, const UiState& state, float pictureWidth);
/// Asks for the name of a new shader, where the user wants one.
void DrawNewShader(Session& session, UiState& state, float pictureWidth, float height);
/// In the upper left corner of the picture: paused or running, and which key helps.
/// Below it, until the user has found them, the keys to begin with.
void DrawStatusLine(Session& session, UiState& state, float pictureWidth);
/// The user has found the key of that action.
void NoteUsed(std::string_view action, UiState& state);
/// All messages of the session, over the lower part of the picture.
void DrawConsole(Session& session, UiState& state, float pictureWidth, float height);
/// The command palette, in the upper part of the window.
void DrawPalette(Session& session, UiState& state, float width, float height);
/// The arrows at a sphere or plane that can be moved, that of `axis` brighter.
void DrawGizmo(const Gizmo& gizmo, int axis, const UiState& state);
/// What the colours of a heat map and the arrows of contacts mean, below the status line; nothing without them.
void DrawLegends(const UiState& state);
/// The vertex under the pointer, beside it.
void DrawInspector(Session& session, UiState& state, int pictureWidth, int height);
/// Energies, stretch, moves and times of the last frames.
void DrawPlotsWindow(Session& session, UiState& state, float pictureWidth, float height);
/// The frames that the plots show: the newest, or those that are held.
std::span<const FrameRow> ShownFrames(Session& session, const UiState& state);
/// Holds the plots at the frames that they show, or lets them go on.
void HoldPlots(Session& session, UiState& state, bool hold);
/// Keys and mouse, in the middle of the window.
void DrawHelp(const Session& session, UiState& state, float width, float height);

}  // namespace percale::viewer
