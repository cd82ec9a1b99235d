#include <imgui.h>

#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "io/atomic_file.h"

namespace percale::viewer {

void DrawStatusLine(const Session& session, const UiState& state) {
  std::string text = PathText(session.sceneFile().filename());
  if (session.snapshot().report.divergence)
    text += "   blown up: R starts over";
  else if (session.running())
    text += "   running: P pauses";
  else
    text += "   paused: P runs, N steps one frame";
  text += "   F1 help";
  const float margin = 10 * state.scale;
  const ImVec2 at{margin, margin};
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 padding{6 * state.scale, 3 * state.scale};
  list->AddRectFilled({at.x - padding.x, at.y - padding.y}, {at.x + size.x + padding.x, at.y + size.y + padding.y},
                      IM_COL32(20, 20, 20, 170), 3 * state.scale);
  list->AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

}  // namespace percale::viewer
