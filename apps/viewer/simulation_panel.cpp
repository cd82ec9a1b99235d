#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawSimulationPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "simulation", "frames_per_second");
  ParameterRow(session, state, "simulation", "steps_per_frame");
}

}  // namespace percale::viewer
