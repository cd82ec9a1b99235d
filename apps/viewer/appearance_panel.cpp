#include <imgui.h>

#include "apps/viewer/actions.h"
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
  for (const ShaderParameter& parameter : session.liveView().ShaderParameters()) UniformRow(session, state, parameter);
  if (ImGui::Button("New shader")) RunAction(FindAction("new_shader"), session, state);
  Control(session, state, "button new_shader", "Makes a shader from a template that explains itself");
  if (!session.liveView().HasOwnUniforms()) return;
  ImGui::SameLine();
  if (ImGui::Button("Reset to defaults")) RunAction(FindAction("reset_uniforms"), session, state);
  Control(session, state, "button reset_uniforms",
          "The shader's parameters as shaders/" + session.view().look.shader +
              ".frag has them; what the viewer has kept of them is forgotten");
}

}  // namespace percale::viewer
