#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawWindPanel(Session& session, UiState& state) {
  ParameterRow(session, state, "wind", "velocity");
  ParameterRow(session, state, "wind", "drag");
  ParameterRow(session, state, "wind", "gustiness");
  ParameterRow(session, state, "wind", "gust_period");
}

}  // namespace percale::viewer
