#include <imgui.h>

#include <string>
#include <string_view>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"
#include "percale/parameters.h"

namespace percale::viewer {
namespace {

/// Whether a collider of that shape has the parameter.
bool Concerns(std::string_view name, ColliderShape shape) {
  using enum ColliderShape;
  if (name == "size") return shape == Box;
  if (name == "radius") return shape != Box && shape != Plane && shape != Mesh;
  if (name == "length") return shape == Capsule || shape == Cylinder || shape == Cone;
  if (name == "tube_radius") return shape == Torus;
  if (name == "mesh" || name == "mesh_scale" || name == "two_sided") return shape == Mesh;
  return true;
}

}  // namespace

void DrawCollidersPanel(Session& session, UiState& state) {
  for (const char* group : {"sphere", "plane", "collider", "collider_motion"}) {
    const std::string_view words = std::string_view(group) == "collider_motion" ? "motion of a collider" : group;
    const std::size_t count = FindGroup(group)->count(session.scene());
    for (std::size_t i = 0; i < count; ++i) {
      ImGui::TextDisabled("%s", (std::string(words) + (count > 1 ? " " + std::to_string(i) : std::string())).c_str());
      for (const Parameter& parameter : Parameters()) {
        if (parameter.group != group) continue;
        // The shape may change while its row is drawn.
        if (parameter.group == "collider" && !Concerns(parameter.name, session.scene().colliders[i].shape)) continue;
        ParameterRow(session, state, group, parameter.name, static_cast<int>(i));
      }
    }
  }
}

}  // namespace percale::viewer
