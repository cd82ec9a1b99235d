#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawParametersPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "cloth", "density", state.cloth);
  ParameterRow(session, state, "cloth", "ks", state.cloth);
}

}  // namespace percale::viewer
