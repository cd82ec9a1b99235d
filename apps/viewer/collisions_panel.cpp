#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawCollisionsPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "simulation", "self_collision");
  ParameterRow(session, state, "cloth", "thickness", state.cloth);
  ParameterRow(session, state, "simulation", "hash");
  ParameterRow(session, state, "simulation", "plane_response");
}

}  // namespace percale::viewer
