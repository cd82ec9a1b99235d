#include <imgui.h>

#include <string>
#include <string_view>

#include "apps/viewer/actions.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/style.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

void Row(std::string_view key, std::string_view help) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextColored(AccentColor(), "%s", std::string(key).c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(help.data(), help.data() + help.size());
}

void Heading(std::string_view text) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", std::string(text).c_str());
}

}  // namespace

void DrawHelp(const Session& session, UiState& state, float width, float height) {
  if (!state.helpVisible) return;
  ImGui::SetNextWindowPos({width / 2, height / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {width, height});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_HorizontalScrollbar;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  const bool shown = ImGui::Begin("Keys and mouse", &state.helpVisible, kFlags);
  ImGui::PopStyleVar();
  if (shown) {
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX)) {
      std::string_view category;
      for (const Action& action : Actions()) {
        if (action.category != category) Heading(category = action.category);
        Row(KeysText(action), action.help);
      }
      Heading("Mouse");
      for (const MouseHelp& mouse : MouseGestures()) Row(mouse.gesture, mouse.help);
      ImGui::EndTable();
    }
    ImGui::Separator();
    ImGui::TextDisabled("Click a number to type one; point at a name to read what it means.");
    ImGui::TextDisabled("Scenes, shaders and textures are read again whenever they are saved.");
    NoteWindow(session, state, "help");
  }
  ImGui::End();
}

}  // namespace percale::viewer
