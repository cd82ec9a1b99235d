#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawWindPanel(Session& session, UiState& state) {
  for (const char* name :
       {"velocity", "drag", "gustiness", "gust_period", "air_density", "drag_coefficient", "lift_coefficient"}) {
    ParameterRow(session, state, "wind", name);
  }
}

}  // namespace percale::viewer
