#include <imgui.h>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {

void DrawSpringsPanel(Session& session, UiState& state) {
  ParameterTick(session, state, "cloth", "enable_structural", state.cloth);
  ImGui::SameLine();
  ParameterTick(session, state, "cloth", "enable_shearing", state.cloth);
  ImGui::SameLine();
  ParameterTick(session, state, "cloth", "enable_bending", state.cloth);
}

}  // namespace percale::viewer
