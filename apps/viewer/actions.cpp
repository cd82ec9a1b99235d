#include "apps/viewer/actions.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "apps/viewer/panels.h"
#include "apps/viewer/presets.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/viewer.h"

namespace percale::viewer {
namespace {

using enum SpecialKey;

constexpr std::size_t kLeastHistory = std::size_t{64} << 20;  // That an action sets [bytes].

constexpr Key Typed(char character) {
  return {.character = character};
}
constexpr Key Control(char character, bool shift = false) {
  return {.character = character, .control = true, .shift = shift};
}
constexpr Key Press(SpecialKey special) {
  return {.special = special};
}

bool ToggleOverlay(Session& session, bool Overlays::*shown) {
  Overlays overlays = session.view().overlays;
  overlays.*shown = !(overlays.*shown);
  session.liveView().SetOverlays(overlays);
  return true;
}

bool ToggleHelp(Session& session, UiState& state) {
  state.helpVisible = !state.helpVisible;
  session.log().Write(LogLine("help").Flag("visible", state.helpVisible));
  return true;
}

void LogInspector(Session& session, const UiState& state) {
  session.log().Write(LogLine("inspector").Flag("visible", state.inspectorVisible).Flag("held", state.inspectorHeld));
}

/// From the picture to the panels, to the console, to the picture, past what cannot be seen.
void MoveKeyboard(UiState& state) {
  KeyboardIn& in = state.keyboardIn;
  if (in == KeyboardIn::Picture && state.kept.panelsVisible)
    in = KeyboardIn::Panels;
  else if (in != KeyboardIn::Console && state.kept.consoleVisible)
    in = KeyboardIn::Console;
  else
    in = KeyboardIn::Picture;
  state.keyboardMoves = kKeyboardMoves;
}

// clang-format off
constexpr Action kActions[] = {
    {.name = "pause", .category = "Simulation", .title = "Run or pause", .help = "Run or pause the simulation",
     .key = Typed('p'),
     .run = [](Session& session, UiState&) { session.playback().TogglePause(); return true; }},
    {.name = "step", .category = "Simulation", .title = "One frame", .help = "One frame, while paused",
     .key = Typed('n'), .repeats = true,
     .enabled = [](const Session& session, const UiState&) { return !session.playback().running(); },
     .run = [](Session& session, UiState&) { return session.playback().StepOneFrame(); }},
    {.name = "reset", .category = "Simulation", .title = "Reset the cloth", .help = "Cloth back to its start",
     .key = Typed('r'),
     .run = [](Session& session, UiState&) { session.ResetCloth(); return true; }},
    {.name = "step_back", .category = "Simulation", .title = "One frame back", .help = "One frame back in the history",
     .key = Typed(','), .repeats = true,
     .run = [](Session& session, UiState&) { return session.playback().StepBack(); }},
    {.name = "step_forward", .category = "Simulation", .title = "One frame forth",
     .help = "One frame forth; after the last of the history, a new one",
     .key = Typed('.'), .repeats = true,
     .run = [](Session& session, UiState&) { return session.playback().StepForward(); }},
    {.name = "first_frame", .category = "Simulation", .title = "First frame", .help = "First frame of the history",
     .key = Press(Home),
     .run = [](Session& session, UiState&) { return session.playback().Seek(session.snapshot().history.firstFrame); }},
    {.name = "last_frame", .category = "Simulation", .title = "Last frame", .help = "Last frame of the history",
     .key = Press(End),
     .run = [](Session& session, UiState&) { return session.playback().Seek(session.snapshot().history.lastFrame); }},
    {.name = "loop", .category = "Simulation", .title = "Loop the history",
     .help = "Show the history again and again, or stop",
     .key = Typed('l'),
     .run = [](Session& session, UiState&) { return session.playback().ToggleLoop(); }},
    {.name = "more_history", .category = "Simulation", .title = "More memory for the history",
     .help = "Twice the memory for the history, or 64 MB where it is off",
     .run = [](Session& session, UiState&) {
       session.SetHistoryBudget(std::max(2 * session.snapshot().history.budget, kLeastHistory));
       return true;
     }},
    {.name = "less_history", .category = "Simulation", .title = "Less memory for the history",
     .help = "Half the memory for the history; below 64 MB none",
     .enabled = [](const Session& session, const UiState&) { return session.snapshot().history.budget > 0; },
     .run = [](Session& session, UiState&) {
       const std::size_t half = session.snapshot().history.budget / 2;
       session.SetHistoryBudget(half < kLeastHistory ? 0 : half);
       return true;
     }},
    {.name = "ball", .category = "Simulation", .title = "Shoot a ball", .help = "Shoot a ball to where the pointer is",
     .key = Typed('x'),
     .run = [](Session& session, UiState& state) {
       session.ShootBall(session.view().camera.position(), state.pointerRay);
       return true;
     }},
    {.name = "gust", .category = "Simulation", .title = "Gust of wind", .help = "A gust of wind away from the eye",
     .key = Typed('g'),
     .run = [](Session& session, UiState&) {
       session.BlowGust(session.view().camera.target() - session.view().camera.position());
       return true;
     }},

    {.name = "undo", .category = "Edit", .title = "Undo", .help = "Take back what was changed last",
     .key = Control('z'), .repeats = true,
     .enabled = [](const Session& session, const UiState&) { return session.ToUndo() != nullptr; },
     .run = [](Session& session, UiState&) { return session.Undo(); }},
    {.name = "redo", .category = "Edit", .title = "Redo", .help = "Change again what was taken back",
     .key = Control('y'), .otherKey = Control('z', true), .repeats = true,
     .enabled = [](const Session& session, const UiState&) { return session.ToRedo() != nullptr; },
     .run = [](Session& session, UiState&) { return session.Redo(); }},

    {.name = "reset_camera", .category = "View", .title = "Reset the camera", .help = "Camera back to its start",
     .key = Typed(' '),
     .run = [](Session& session, UiState&) { session.liveView().ResetCamera(session.scene()); return true; }},
    {.name = "previous_shader", .category = "View", .title = "Previous shader", .help = "Previous shader",
     .key = Typed('['), .repeats = true,
     .run = [](Session& session, UiState&) { session.CycleShader(-1); return true; }},
    {.name = "next_shader", .category = "View", .title = "Next shader", .help = "Next shader",
     .key = Typed(']'), .repeats = true,
     .run = [](Session& session, UiState&) { session.CycleShader(1); return true; }},
    {.name = "wireframe", .category = "View", .title = "Wireframe", .help = "Springs over any shader",
     .key = Typed('w'),
     .run = [](Session& session, UiState&) { session.liveView().ToggleWireframe(); return true; }},
    {.name = "heat_map", .category = "View", .title = "Heat map",
     .help = "Next heat map: stretch, compression, speed, curvature, contact, off",
     .key = Typed('t'), .repeats = true,
     .run = [](Session& session, UiState&) {
       const int now = static_cast<int>(session.view().heatMap.quantity);
       session.liveView().SetHeatMap({static_cast<Quantity>((now + 1) % kQuantities), {}});
       return true;
     }},
    {.name = "normals", .category = "View", .title = "Normals", .help = "Normals of the vertices",
     .run = [](Session& session, UiState&) { return ToggleOverlay(session, &Overlays::normals); }},
    {.name = "pins", .category = "View", .title = "Pins", .help = "Points that are held",
     .run = [](Session& session, UiState&) { return ToggleOverlay(session, &Overlays::pins); }},
    {.name = "contacts", .category = "View", .title = "Contacts", .help = "What touches cloth or a collider, and with what force",
     .key = Typed('o'),
     .run = [](Session& session, UiState&) { return ToggleOverlay(session, &Overlays::contacts); }},
    {.name = "cones", .category = "View", .title = "Friction cones",
     .help = "Friction cones of contacts, with the force in each",
     .key = Typed('f'),
     .run = [](Session& session, UiState&) { return ToggleOverlay(session, &Overlays::cones); }},
    {.name = "boxes", .category = "View", .title = "Boxes of the spatial map",
     .help = "Boxes of the spatial map that points share",
     .run = [](Session& session, UiState&) { return ToggleOverlay(session, &Overlays::boxes); }},
    {.name = "inspector", .category = "View", .title = "Inspector", .help = "Tell of the vertex under the pointer",
     .key = {.character = 'i', .control = true},
     .run = [](Session& session, UiState& state) {
       state.inspectorVisible = !state.inspectorVisible;
       state.inspectorHeld = false;
       state.inspectedLogged = {};
       LogInspector(session, state);
       return true;
     }},
    {.name = "hold_vertex", .category = "View", .title = "Inspector: hold the vertex",
     .help = "Keep telling of this vertex, or follow the pointer again",
     .key = {.character = 'i', .control = true, .shift = true},
     .enabled = [](const Session&, const UiState& state) { return state.inspectorVisible && state.inspected.cloth >= 0; },
     .run = [](Session& session, UiState& state) {
       state.inspectorHeld = !state.inspectorHeld;
       LogInspector(session, state);
       return true;
     }},

    {.name = "new_shader", .category = "View", .title = "New shader", .help = "Make a shader from a template",
     .run = [](Session&, UiState& state) { state.newShader.emplace(); return true; }},
    {.name = "reset_uniforms", .category = "View", .title = "Reset the shader's values",
     .help = "The shader's parameters back to their defaults",
     .enabled = [](const Session& session, const UiState&) { return session.liveView().HasOwnUniforms(); },
     .run = [](Session& session, UiState&) { session.liveView().ResetUniforms(); return true; }},

    {.name = "previous_scene", .category = "Scene", .title = "Previous scene",
     .help = "Previous scene file of the folder",
     .key = Typed('{'),
     .run = [](Session& session, UiState&) { session.CycleScene(-1); return true; }},
    {.name = "next_scene", .category = "Scene", .title = "Next scene", .help = "Next scene file of the folder",
     .key = Typed('}'),
     .run = [](Session& session, UiState&) { session.CycleScene(1); return true; }},
    {.name = "save_state", .category = "Scene", .title = "Save a checkpoint",
     .help = "Save the state to NAME-frameN.percale in the current folder",
     .key = Control('s'),
     .run = [](Session& session, UiState&) { session.SaveState(); return true; }},
    {.name = "load_state", .category = "Scene", .title = "Load the newest checkpoint",
     .help = "Back to the newest checkpoint of this scene",
     .key = Control('l'),
     .run = [](Session& session, UiState&) { return session.LoadNewestState(); }},
    {.name = "picture", .category = "Scene", .title = "Take a picture",
     .help = "Picture to NAME-1.png, -2, ...; dropped here it brings all this back",
     .key = Press(F12),
     .run = [](Session& session, UiState&) { session.TakePicture(); return true; }},
    {.name = "record", .category = "Scene", .title = "Record a film",
     .help = "Record the picture to NAME-1.mp4, -2, ..., or end it",
     .key = Press(F9),
     .run = [](Session& session, UiState&) { return session.ToggleRecording(); }},
    {.name = "reload", .category = "Scene", .title = "Reload all files",
     .help = "Read scene, shaders, textures again",
     .key = Press(F5),
     .run = [](Session& session, UiState&) { session.Reload(); return true; }},
    {.name = "save_preset", .category = "Scene", .title = "Save as preset",
     .help = "Save what differs from the scene file as a preset",
     .run = [](Session& session, UiState& state) {
       if (state.presetFolders.empty()) return false;
       return SavePreset(std::exchange(state.presetName, {}), state.presetFolders.front(), session);
     }},

    {.name = "palette", .category = "Window", .title = "Find any command",
     .help = "Find any command, parameter, shader, scene or preset",
     .key = Control('k'),
     .run = [](Session& session, UiState& state) {
       if (state.palette.open)
         ClosePalette(session, state);
       else
         OpenPalette(session, state);
       return true;
     }},
    {.name = "focus", .category = "Window", .title = "Keys to panels or picture",
     .help = "Keyboard into the panels and back: arrows, Enter; Esc returns",
     .key = Press(F6), .otherKey = {.special = Tab, .control = true},
     .run = [](Session&, UiState& state) { MoveKeyboard(state); return true; }},
    {.name = "console", .category = "Window", .title = "Console", .help = "All messages of this session",
     .key = Typed('c'),
     .run = [](Session& session, UiState& state) {
       state.kept.consoleVisible = !state.kept.consoleVisible;
       session.log().Write(LogLine("console").Flag("visible", state.kept.consoleVisible));
       return true;
     }},
    {.name = "panels", .category = "Window", .title = "Hide or show the panels", .help = "Hide or show the panels",
     .key = Press(Tab),
     .run = [](Session& session, UiState& state) {
       state.kept.panelsVisible = !state.kept.panelsVisible;
       session.log().Write(LogLine("panels").Flag("visible", state.kept.panelsVisible));
       return true;
     }},
    {.name = "plots", .category = "Window", .title = "Plots", .help = "Plots of energy, stretch, moves and times",
     .key = Typed('m'),
     .run = [](Session& session, UiState& state) {
       state.plotsVisible = !state.plotsVisible;
       session.log().Write(
           LogLine("plots").Flag("visible", state.plotsVisible).Flag("held", state.plotsHeld.has_value()));
       return true;
     }},
    {.name = "export_plots", .category = "Window", .title = "Export the plots",
     .help = "Write the plots' numbers to a CSV file",
     .enabled = [](const Session& session, const UiState&) { return !session.frames().rows().empty(); },
     .run = [](Session& session, UiState& state) { session.ExportPlots(ShownFrames(session, state)); return true; }},
    {.name = "help", .category = "Window", .title = "Help", .help = "Help: keys and mouse",
     .key = Press(F1),
     .run = [](Session& session, UiState& state) { return ToggleHelp(session, state); }},
    {.name = "quit", .category = "Window", .title = "Quit", .help = "Quit; or close the help, where it is open",
     .key = Press(Escape),
     .run = [](Session& session, UiState& state) {
       if (state.helpVisible) return ToggleHelp(session, state);
       state.quit = true;
       return true;
     }},
};
// clang-format on

constexpr MouseHelp kMouse[] = {
    {"Left drag", "Turn the view"},
    {"Right drag, Ctrl + left drag", "Shift the view"},
    {"Wheel", "Nearer and farther"},
    {"Shift + left drag", "Drag cloth, a pin or a collider"},
    {"Shift + click", "Pin the cloth, or let it go"},
    {"Drag an arrow", "Move a collider along an axis"},
    {"Drop a file", "Open a scene, checkpoint or picture; another PNG is a texture"},
};

std::string_view SpecialName(SpecialKey special) {
  constexpr std::string_view kNames[] = {"",      "Esc", "Tab",  "Enter", "Delete", "Home", "End", "Left",
                                         "Right", "Up",  "Down", "F1",    "F2",     "F3",   "F4",  "F5",
                                         "F6",    "F7",  "F8",   "F9",    "F10",    "F11",  "F12"};
  static_assert(std::size(kNames) == static_cast<std::size_t>(F12) + 1);
  return kNames[static_cast<std::size_t>(special)];
}

char Upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
char Lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::string KeyText(const Key& key) {
  std::string text;
  if (key.control) text += "Ctrl+";
  if (key.shift) text += "Shift+";
  if (key.special != None)
    text += SpecialName(key.special);
  else if (key.character == ' ')
    text += "Space";
  else if (key.character != 0)
    text += Upper(key.character);
  return text;
}

std::span<const Action> Actions() {
  return kActions;
}
std::span<const MouseHelp> MouseGestures() {
  return kMouse;
}

const Action& FindAction(std::string_view name) {
  return *std::find_if(std::begin(kActions), std::end(kActions), [&](const Action& a) { return a.name == name; });
}

std::string KeysText(const Action& action) {
  return KeyText(action.key) + (action.otherKey ? ", " + KeyText(action.otherKey) : "");
}

void RunAction(const Action& action, Session& session, UiState& state) {
  // The line comes before what the action causes, so a refusal has one of its own.
  session.log().Write(LogLine("action").Text("name", action.name).Text("key", KeyText(action.key)));
  NoteUsed(action.name, state);
  const bool can = !action.enabled || action.enabled(session, state);
  if (!can || !action.run(session, state)) session.log().Write(LogLine("ignored").Text("name", action.name));
}

void RunAction(const Key& key, bool repeated, Session& session, UiState& state) {
  if (!key) return;
  Key meant = key;
  meant.character = Lower(key.character);
  for (const Action& action : kActions) {
    if (action.key != meant && action.otherKey != meant) continue;
    if (!repeated || action.repeats) RunAction(action, session, state);
    return;
  }
}

bool BelongsToTextInput(const Key& key) {
  if (key.special == Tab) return !key.control;
  if (key.special != None) return key.special < F1;
  // Mark all, copy, paste, cut, redo, undo.
  return !key.control || std::string_view("acvxyz").find(Lower(key.character)) != std::string_view::npos;
}

bool BelongsToControls(const Key& key) {
  return key.special == None ? key.character == ' ' && !key.control : BelongsToTextInput(key);
}

}  // namespace percale::viewer

namespace percale {

std::string KeyTable() {
  const auto row = [](std::string_view key, std::string_view help, std::string_view category) {
    return "| " + std::string(key) + " | " + std::string(help) + " | " + std::string(category) + " |\n";
  };
  std::string table = row("key", "does", "") + "|---|---|---|\n";
  for (const viewer::Action& action : viewer::Actions()) {
    const std::string keys = viewer::KeysText(action);
    table += row(keys.empty() ? "Ctrl+K, then its name" : keys, action.help, action.category);
  }
  for (const viewer::MouseHelp& mouse : viewer::MouseGestures()) table += row(mouse.gesture, mouse.help, "Mouse");
  return table;
}

}  // namespace percale
