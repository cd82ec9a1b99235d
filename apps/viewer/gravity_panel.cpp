#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawGravityPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "simulation", "gravity");
}

}  // namespace percale::viewer
