#include "apps/viewer/panels.h"

#include <imgui.h>

#include <string>
#include <utility>

#include "apps/viewer/palette.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kColumnWidth = 384;  // [screen unit at scale 1]

bool HasSprings(const Session& session) {
  return session.scene().simulation.engine == Engine::Springs;
}
bool HasFabric(const Session& session) {
  return session.scene().simulation.engine == Engine::Fabric;
}
bool HasColliders(const Session& session) {
  const Scene& scene = session.scene();
  return !scene.spheres.empty() || !scene.planes.empty() || !scene.colliders.empty();
}

constexpr Panel kPanels[] = {
    {"Spring types", true, DrawSpringsPanel, HasSprings},
    {"Parameters", true, DrawParametersPanel},
    {"Fabric", true, DrawFabricPanel, HasFabric},
    {"Simulation", true, DrawSimulationPanel},
    {"Damping", true, DrawDampingPanel, HasSprings},
    {"Gravity", true, DrawGravityPanel},
    {"Appearance", true, DrawAppearancePanel},
    {"Scenes", false, DrawScenesPanel},
    {"Presets", false, DrawPresetsPanel},
    {"Collisions", false, DrawCollisionsPanel},
    {"Colliders", false, DrawCollidersPanel, HasColliders},
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
    const std::string shape = c.shape == Shape::Grid
                                  ? std::to_string(c.numWidthPoints) + " x " + std::to_string(c.numHeightPoints)
                              : c.shape == Shape::Disc ? "disc"
                                                       : c.mesh;
    return "cloth " + std::to_string(cloth) + " (" + shape + ")";
  };
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Settings of");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (!BeginList(session, state, "cloth choice", "Whose settings the panels show and set.", name(state.cloth))) return;
  for (int cloth = Session::kAll; cloth < count; ++cloth) {
    if (ImGui::Selectable(name(cloth).c_str(), cloth == state.cloth)) state.cloth = cloth;
    NoteBox(session, state, "cloth choice/" + (cloth < 0 ? std::string("all") : std::to_string(cloth)));
  }
  ImGui::EndCombo();
}

/// Its header, and below it the panel when it is open.
void DrawPanel(const Panel& panel, Session& session, UiState& state) {
  const std::string name = std::string("panel ") + panel.title;
  bool& isOpen = state.kept.panelsOpen.try_emplace(panel.title, panel.openAtStart).first->second;
  if (state.jump == name) state.jumpHere = state.jumpFound = true;
  ImGui::SetNextItemOpen(isOpen || state.jumpSearching);
  const bool open = ImGui::CollapsingHeader(panel.title);
  if (open != isOpen && !state.jumpSearching) {
    isOpen = open;
    session.log().Write(LogLine("panel").Text("name", panel.title).Flag("open", open));
  }
  Control(session, state, name, open ? "Closes this panel." : "Opens this panel.");
  if (!open) return;
  const bool found = state.jumpFound;
  ImGui::PushID(panel.title);
  panel.draw(session, state);
  ImGui::PopID();
  ImGui::Dummy({0, 2 * state.scale});
  if (state.jumpFound && !found) isOpen = true;
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
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (state.keyboardIn != KeyboardIn::Panels) flags |= ImGuiWindowFlags_NoNav;
  // A parameter that is jumped to is looked for in all panels, and found in the next picture.
  state.jumpSearching = !state.jump.empty() && !state.jumpFound;
  if (ImGui::Begin(kPanelsTitle, nullptr, flags)) {
    NoteWindow(session, state, "panels");
    DrawClothChoice(session, state);
    for (const Panel& panel : kPanels) {
      if (!panel.hasContent || panel.hasContent(session)) DrawPanel(panel, session, state);
    }
  }
  ImGui::End();
  if (!state.jumpSearching) {
    state.jumpFound = false;
  } else if (!state.jumpFound) {  // No panel shows it: it is set where it was named.
    OpenPalette(session, state, std::exchange(state.jump, {}) + " ");
  }
  state.jumpSearching = false;
}

}  // namespace percale::viewer
