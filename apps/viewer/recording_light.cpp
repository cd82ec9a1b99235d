#include <imgui.h>

#include <cstdio>

#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"

namespace percale::viewer {

void DrawRecordingLight(const Session& session, const UiState& state, float pictureWidth) {
  const auto seconds = session.RecordedSeconds();
  if (!seconds) return;
  char text[40];
  std::snprintf(text, sizeof text, "%.0f s", *seconds);
  const float margin = 10 * state.scale, radius = 5 * state.scale;
  const ImVec2 size = ImGui::CalcTextSize(text), padding{6 * state.scale, 3 * state.scale};
  const float left = pictureWidth - margin - size.x - 3 * radius;
  ImDrawList* const list = ImGui::GetForegroundDrawList();
  list->AddRectFilled({left - padding.x, margin - padding.y},
                      {pictureWidth - margin + padding.x, margin + size.y + padding.y}, IM_COL32(20, 20, 20, 170),
                      3 * state.scale);
  list->AddCircleFilled({left + radius, margin + size.y / 2}, radius, IM_COL32(235, 60, 50, 255));
  list->AddText({left + 3 * radius, margin}, ImGui::GetColorU32(ImGuiCol_Text), text);
}

}  // namespace percale::viewer
