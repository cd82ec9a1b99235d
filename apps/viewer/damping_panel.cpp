#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawDampingPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "cloth", "damping", state.cloth);
}

}  // namespace percale::viewer
