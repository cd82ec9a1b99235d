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
  for (const char* name :
       {"engine", "frames_per_second", "steps_per_frame", "newton_iterations", "linear_iterations", "tolerance"}) {
    ParameterRow(session, state, "simulation", name);
  }
}

}  // namespace percale::viewer
