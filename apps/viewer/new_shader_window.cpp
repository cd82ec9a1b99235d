#include <imgui.h>

#include <cstdio>
#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawNewShader(Session& session, UiState& state, float pictureWidth, float height) {
  if (!state.newShader) return;
  NewShaderInput& input = *state.newShader;
  bool open = true;
  ImGui::SetNextWindowPos({pictureWidth / 2, height / 3}, ImGuiCond_Always, {0.5f, 0});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoNav;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  const bool shown = ImGui::Begin("New shader", &open, kFlags);
  ImGui::PopStyleVar();
  if (shown) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Name");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(220 * state.scale);
    if (input.fresh) ImGui::SetKeyboardFocusHere();
    input.fresh = false;
    const bool entered =
        ImGui::InputText("##name", input.name, sizeof input.name, ImGuiInputTextFlags_EnterReturnsTrue);
    Control(session, state, "new shader name", "Letters, digits, _ and -");
    ImGui::SameLine();
    const bool pressed = ImGui::Button("Create");
    Control(session, state, "new shader create", "Makes shaders/NAME.frag from a template that explains itself");
    if (!input.problem.empty()) {
      Wrapped(input.problem);
      NoteBox(session, state, "new shader problem");
    }
    if (entered || pressed) {
      const Status made = session.CreateShader(input.name);
      input.problem = made ? "" : made.diagnostics().front().message;
      open = !made;
      input.fresh = true;
    }
  }
  ImGui::End();
  if (!open) state.newShader.reset();
}

}  // namespace percale::viewer
