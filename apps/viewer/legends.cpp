#include <imgui.h>

#include <string>
#include <utility>

#include "apps/viewer/panels.h"
#include "apps/viewer/ui_state.h"
#include "core/text.h"
#include "render/overlays.h"
#include "render/ticks.h"

namespace percale::viewer {
namespace {

constexpr float kTop = 64, kLeft = 10, kLegendWidth = 240, kBarHeight = 14;  // [screen unit at scale 1]
constexpr int kTicks = 5, kParts = 64;
constexpr ImU32 kGround = IM_COL32(20, 20, 20, 170);

ImU32 ColorOf(const Rgb& color) {
  return ImGui::ColorConvertFloat4ToU32({color[0], color[1], color[2], 1});
}

/// Returns its lower end [screen unit].
float DrawHeatLegend(const UiState& state) {
  const HeatScale& heat = state.heatScale;
  if (heat.quantity == Quantity::None) return kTop * state.scale;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float scale = state.scale, text = ImGui::GetTextLineHeight(), pad = 8 * scale;
  const float left = kLeft * scale, top = kTop * scale;
  const ImVec2 bar{left + 2 * pad, top + text + pad};
  const float width = kLegendWidth * scale, height = kBarHeight * scale;
  const float bottom = bar.y + height + text + pad;
  list.AddRectFilled({left, top}, {bar.x + width + 2 * pad, bottom}, kGround, 3 * scale);
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  const QuantityInfo& info = Describe(heat.quantity);
  const std::string title = std::string(info.label) + (info.unit.empty() ? "" : " (" + std::string(info.unit) + ")");
  list.AddText({bar.x, top + pad / 2}, ink, title.c_str());
  const auto centred = [&](float x, const std::string& label) {
    list.AddText({x - ImGui::CalcTextSize(label.c_str()).x / 2, bar.y + height + 2 * scale}, ink, label.c_str());
  };
  if (heat.quantity == Quantity::Contact) {
    for (int k = 0; k < 3; ++k) {
      const float x = bar.x + static_cast<float>(k) * width / 3;
      list.AddRectFilled({x, bar.y}, {x + width / 3, bar.y + height}, ColorOf(kContactColors[k]));
      centred(x + width / 6, std::string(kContactLabels[k]));
    }
    return bottom + pad;
  }
  for (int k = 0; k < kParts; ++k) {
    const float x = bar.x + static_cast<float>(k) * width / kParts;
    const ImU32 a = ColorOf(HeatColor(double(k) / kParts)), b = ColorOf(HeatColor(double(k + 1) / kParts));
    list.AddRectFilledMultiColor({x, bar.y}, {x + width / kParts, bar.y + height}, a, b, b, a);
  }
  const double span = heat.range.high - heat.range.low;
  const std::vector<double> ticks = Ticks(heat.range.low, heat.range.high, kTicks);
  for (const double tick : ticks) {
    const float x = bar.x + static_cast<float>((tick - heat.range.low) / span) * width;
    list.AddLine({x, bar.y + height}, {x, bar.y + height + 3 * scale}, ink, scale);
    centred(x, TickText(tick, ticks.size() > 1 ? ticks[1] - ticks[0] : span));
  }
  return bottom + pad;
}

void DrawForceLegend(const UiState& state, float top) {
  if (!(state.arrowForce > 0)) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float pad = 8 * state.scale, text = ImGui::GetTextLineHeight(), left = kLeft * state.scale;
  const std::string longest = "longest arrow " + Text("%.3g N", state.arrowForce);
  constexpr std::pair<const char*, const Rgb*> kKinds[] = {{"sticks", &kStickColor}, {"slides", &kSlideColor}};
  float width = ImGui::CalcTextSize(longest.c_str()).x + 2 * pad;
  for (const auto& [name, color] : kKinds) width += ImGui::CalcTextSize(name).x + text + 2 * pad;
  list.AddRectFilled({left, top}, {left + width, top + text + pad}, kGround, 3 * state.scale);
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  const float y = top + pad / 2;
  float x = left + pad;
  for (const auto& [name, color] : kKinds) {
    list.AddCircleFilled({x + text / 2, y + text / 2}, text / 3, ColorOf(*color));
    list.AddText({x + text + pad / 2, y}, ink, name);
    x += ImGui::CalcTextSize(name).x + text + 2 * pad;
  }
  list.AddText({x, y}, ink, longest.c_str());
}

}  // namespace

void DrawLegends(const UiState& state) {
  DrawForceLegend(state, DrawHeatLegend(state));
}

}  // namespace percale::viewer
