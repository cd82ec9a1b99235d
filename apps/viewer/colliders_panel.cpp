#include <imgui.h>

#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"
#include "percale/parameters.h"

namespace percale::viewer {

void DrawCollidersPanel(Session& session, UiState& state) {
  for (const char* group : {"sphere", "plane"}) {
    const std::size_t count = FindGroup(group)->count(session.scene());
    for (std::size_t i = 0; i < count; ++i) {
      ImGui::TextDisabled("%s", (group + (count > 1 ? " " + std::to_string(i) : std::string())).c_str());
      for (const Parameter& parameter : Parameters()) {
        if (parameter.group == group) ParameterRow(session, state, group, parameter.name, static_cast<int>(i));
      }
    }
  }
}

}  // namespace percale::viewer
