#include <imgui.h>

#include <cmath>

#include "apps/viewer/hand.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/ui_state.h"

namespace percale::viewer {
namespace {

// Vermilion, bluish green and sky blue: told apart by everyone (Okabe and Ito 2008).
constexpr ImU32 kColors[3] = {IM_COL32(213, 94, 0, 255), IM_COL32(0, 158, 115, 255), IM_COL32(86, 180, 233, 255)};
constexpr const char* kNames[3] = {"x", "y", "z"};

}  // namespace

void DrawGizmo(const Gizmo& gizmo, int axis, const UiState& state) {
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  const auto point = [&](int k) { return ImVec2(static_cast<float>(gizmo.x[k]), static_cast<float>(gizmo.y[k])); };
  const ImVec2 centre = point(0);
  for (int k = 0; k < 3; ++k) {
    const ImVec2 end = point(k + 1);
    const float dx = end.x - centre.x, dy = end.y - centre.y, length = std::hypot(dx, dy);
    const float thickness = (k == axis ? 5.0f : 3.0f) * state.scale;
    list->AddLine(centre, end, kColors[k], thickness);
    if (length < 1) continue;  // It points at the eye.
    const float ux = dx / length, uy = dy / length, tip = 12 * state.scale, half = 5 * state.scale;
    list->AddTriangleFilled({end.x + ux * tip, end.y + uy * tip}, {end.x - uy * half, end.y + ux * half},
                            {end.x + uy * half, end.y - ux * half}, kColors[k]);
    list->AddText({end.x + ux * 1.6f * tip, end.y + uy * 1.6f * tip - ImGui::GetFontSize() / 2}, kColors[k], kNames[k]);
  }
  list->AddCircleFilled(centre, 4 * state.scale, IM_COL32_WHITE);
}

}  // namespace percale::viewer
