#include "apps/viewer/panels.h"

#include <imgui.h>

#include <string>
#include <vector>

#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kColumnWidth = 384;  // [screen unit at scale 1]

bool HasColliders(const Session& session) {
  return !session.scene().spheres.empty() || !session.scene().planes.empty();
}

constexpr Panel kPanels[] = {
    {"Spring types", true, DrawSpringsPanel},
    {"Parameters", true, DrawParametersPanel},
    {"Simulation", true, DrawSimulationPanel},
    {"Damping", true, DrawDampingPanel},
    {"Gravity", true, DrawGravityPanel},
    {"Appearance", true, DrawAppearancePanel},
    {"Collisions", false, DrawCollisionsPanel},
    {"Spheres and planes", false, DrawCollidersPanel, HasColliders},
    {"Wind", false, DrawWindPanel},
    {"Overlays", false, DrawOverlaysPanel},
    {"Statistics", true, DrawStatisticsPanel},
};

/// Which cloth the panels are about, where there are several.
void DrawClothChoice(Session& session, UiState& state) {
  const int count = static_cast<int>(session.scene().cloths.size());
  if (state.cloth >= count) state.cloth = Session::kAll;
  if (count < 2) {
    state.cloth = Session::kAll;
    return;
  }
  const auto name = [&](int cloth) {
    if (cloth == Session::kAll) return "all " + std::to_string(count) + " cloths";
    const ClothSettings& c = session.scene().cloths[static_cast<std::size_t>(cloth)];
    return "cloth " + std::to_string(cloth) + " (" + std::to_string(c.numWidthPoints) + " x " +
           std::to_string(c.numHeightPoints) + ")";
  };
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Settings of");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  NoteNextBox(session, state, "cloth choice");
  if (!ImGui::BeginCombo("##cloth", name(state.cloth).c_str())) return;
  for (int cloth = Session::kAll; cloth < count; ++cloth) {
    if (ImGui::Selectable(name(cloth).c_str(), cloth == state.cloth)) state.cloth = cloth;
    NoteBox(session, state, "cloth choice/" + (cloth < 0 ? std::string("all") : std::to_string(cloth)));
  }
  ImGui::EndCombo();
}

}  // namespace

std::span<const Panel> Panels() {
  return kPanels;
}

float PanelColumnWidth(const UiState& state) {
  return kColumnWidth * state.scale;
}

void DrawPanelColumn(Session& session, UiState& state, float width, float height) {
  const float columnWidth = PanelColumnWidth(state);
  ImGui::SetNextWindowPos({width - columnWidth, 0});
  ImGui::SetNextWindowSize({columnWidth, height});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                      ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("Panels", nullptr, kFlags)) {
    NoteWindow(session, state, "panels");
    DrawClothChoice(session, state);
    for (const Panel& panel : kPanels) {
      if (panel.hasContent && !panel.hasContent(session)) continue;
      const bool open = ImGui::CollapsingHeader(panel.title, panel.openAtStart ? ImGuiTreeNodeFlags_DefaultOpen : 0);
      NoteBox(session, state, std::string("panel ") + panel.title);
      if (!open) continue;
      ImGui::PushID(panel.title);
      panel.draw(session, state);
      ImGui::PopID();
      ImGui::Dummy({0, 2 * state.scale});
    }
  }
  ImGui::End();
}

}  // namespace percale::viewer
