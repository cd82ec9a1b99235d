#include <imgui.h>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawSimulationPanel(Session& session, UiState& state) {
  ActionButton(session, state, "pause");
  ImGui::SameLine();
  ActionButton(session, state, "step");
  ImGui::SameLine();
  ActionButton(session, state, "reset");
  ParameterRow(session, state, "simulation", "frames_per_second");
  ParameterRow(session, state, "simulation", "steps_per_frame");
}

}  // namespace percale::viewer
