#include "apps/viewer/actions.h"

#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"

namespace percale::viewer {
namespace {

using enum SpecialKey;

// clang-format off
constexpr Action kActions[] = {
    {"pause", "P", "Run or pause the simulation", 'p', None, false,
     [](Session& session, UiState&) { session.TogglePause(); return true; }},
    {"step", "N", "One frame, while paused", 'n', None, true,
     [](Session& session, UiState&) { return session.StepOneFrame(); }},
    {"reset", "R", "Cloth back to its start", 'r', None, false,
     [](Session& session, UiState&) { session.ResetCloth(); return true; }},
    {"reset_camera", "Space", "Camera back to its start", ' ', None, false,
     [](Session& session, UiState&) { session.ResetCamera(); return true; }},
    {"previous_shader", "[", "Previous shader", '[', None, true,
     [](Session& session, UiState&) { session.CycleShader(-1); return true; }},
    {"next_shader", "]", "Next shader", ']', None, true,
     [](Session& session, UiState&) { session.CycleShader(1); return true; }},
    {"previous_scene", "{", "Previous scene file of the folder", '{', None, false,
     [](Session& session, UiState&) { session.CycleScene(-1); return true; }},
    {"next_scene", "}", "Next scene file of the folder", '}', None, false,
     [](Session& session, UiState&) { session.CycleScene(1); return true; }},
    {"reload", "F5", "Read scene, shaders, textures again", 0, F5, false,
     [](Session& session, UiState&) { session.Reload(); return true; }},
    {"panels", "Tab", "Hide or show the panels", 0, Tab, false,
     [](Session& session, UiState& state) {
       state.panelsVisible = !state.panelsVisible;
       session.log().Write(LogLine("panels").Flag("visible", state.panelsVisible));
       return true;
     }},
    {"help", "F1", "This help", 0, F1, false,
     [](Session& session, UiState& state) {
       state.helpVisible = !state.helpVisible;
       session.log().Write(LogLine("help").Flag("visible", state.helpVisible));
       return true;
     }},
    {"quit", "Esc", "Quit", 0, Escape, false,
     [](Session&, UiState& state) { state.quit = true; return true; }},
};
// clang-format on

constexpr MouseHelp kMouse[] = {
    {"Left drag", "Turn the view"},
    {"Right drag, Ctrl + left drag", "Shift the view"},
    {"Wheel", "Nearer and farther"},
    {"Drop a scene file", "Open it"},
};

}  // namespace

std::span<const Action> Actions() {
  return kActions;
}
std::span<const MouseHelp> MouseGestures() {
  return kMouse;
}

void RunAction(char character, SpecialKey special, bool repeated, Session& session, UiState& state) {
  if (character >= 'A' && character <= 'Z') character = static_cast<char>(character - 'A' + 'a');
  for (const Action& action : kActions) {
    const bool meant = special == None ? character != 0 && action.character == character : action.special == special;
    if (!meant) continue;
    if (repeated && !action.repeats) return;
    // The line comes before what the action causes, so a refusal has one of its own.
    session.log().Write(LogLine("action").Text("name", action.name).Text("key", action.key));
    if (!action.run(session, state)) session.log().Write(LogLine("ignored").Text("name", action.name));
    return;
  }
}

}  // namespace percale::viewer
