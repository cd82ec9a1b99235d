#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

/// All that the description table says of the continuum: what acts at once, then what makes another cloth.
void DrawFabricPanel(Session& session, UiState& state) {
  for (const Effect effect : {Effect::Live, Effect::Rebuild}) {
    for (const Parameter& parameter : Parameters()) {
      if (parameter.group == "cloth" && parameter.engine == Engine::Fabric && parameter.effect == effect) {
        ParameterRow(session, state, parameter.group, parameter.name, state.cloth);
      }
    }
  }
}

}  // namespace percale::viewer
