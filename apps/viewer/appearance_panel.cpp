#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawAppearancePanel(Session& session, UiState& state) {
  ShaderRow(session, state);
  ParameterRow(session, state, "look", "color");
  ParameterRow(session, state, "look", "normal_scaling");
  ParameterRow(session, state, "look", "height_scaling");
  ParameterRow(session, state, "look", "tangents");
  // Setting one does not change the shader, so the parameters stay where they are.
  for (const ShaderParameter& parameter : session.ShaderParameters()) UniformRow(session, state, parameter);
}

}  // namespace percale::viewer
