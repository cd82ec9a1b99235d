#include <imgui.h>

#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"
#include "render/overlays.h"

namespace percale::viewer {
namespace {

constexpr float kBoxWidth = 90;  // [screen unit at scale 1]

void HeatMapChoice(Session& session, UiState& state, HeatMapSettings& settings) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Heat map");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (!BeginList(session, state, "heat map", "Colours the cloths by a quantity\n\nKey: T, one after the other",
                 std::string(Describe(settings.quantity).label)))
    return;
  for (int q = 0; q < kQuantities; ++q) {
    const auto quantity = static_cast<Quantity>(q);
    if (ImGui::Selectable(Describe(quantity).label.data(), quantity == settings.quantity)) settings.quantity = quantity;
    NoteBox(session, state, "heat map/" + std::string(Describe(quantity).name));
  }
  ImGui::EndCombo();
}

/// The values of the first and the last colour: as they are, or as they are typed.
void RangeRow(Session& session, UiState& state, HeatMapSettings& settings) {
  bool fixed = settings.range.has_value();
  if (ImGui::Checkbox("Fixed range", &fixed)) {
    if (fixed)
      settings.range = state.heatScale.range;
    else
      settings.range.reset();
  }
  Control(session, state, "heat map fixed",
          "The first and the last colour keep their values; else they follow the cloth");
  ValueRange range = settings.range.value_or(state.heatScale.range);
  const auto box = [&](const char* id, const char* name, double& value) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(kBoxWidth * state.scale);
    // What is typed counts when it is complete.
    ImGui::InputDouble(id, &value, 0, 0, "%.5g", ImGuiInputTextFlags_AutoSelectAll);
    const bool typed = ImGui::IsItemDeactivatedAfterEdit();
    Control(session, state, name, "The value of the first or the last colour");
    return typed;
  };
  const bool low = box("##low", "heat map low box", state.typedRange.low);
  const bool high = box("##high", "heat map high box", state.typedRange.high);
  if (low || high) {
    if (state.typedRange.low < state.typedRange.high) settings.range = state.typedRange;
  } else if (!ImGui::IsAnyItemActive()) {
    state.typedRange = range;
  }
}

}  // namespace

void DrawOverlaysPanel(Session& session, UiState& state) {
  HeatMapSettings heatMap = session.view().heatMap;
  HeatMapChoice(session, state, heatMap);
  const bool hasRange = heatMap.quantity != Quantity::None && heatMap.quantity != Quantity::Contact;
  if (hasRange && state.heatScale.quantity == heatMap.quantity) RangeRow(session, state, heatMap);
  if (heatMap != session.view().heatMap) session.liveView().SetHeatMap(heatMap);

  bool wireframe = session.view().wireframe;
  if (ImGui::Checkbox("Wireframe", &wireframe)) session.liveView().ToggleWireframe();
  Control(session, state, "overlay wireframe", "Springs over any shader\n\nKey: W");
  Overlays overlays = session.view().overlays;
  for (const OverlayInfo& overlay : AllOverlays()) {
    // Three to a line.
    if (overlay.shown != &Overlays::contacts) ImGui::SameLine();
    ImGui::Checkbox(overlay.label.data(), &(overlays.*overlay.shown));
    Control(session, state, "overlay " + std::string(overlay.name), std::string(overlay.help));
  }
  if (overlays != session.view().overlays) session.liveView().SetOverlays(overlays);
}

}  // namespace percale::viewer
