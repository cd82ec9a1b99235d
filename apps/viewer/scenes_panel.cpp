#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"
#include "io/atomic_file.h"

namespace percale::viewer {

void DrawScenesPanel(Session& session, UiState& state) {
  const std::filesystem::path current = session.sceneFile();
  std::filesystem::path chosen;
  ImGui::SetNextItemWidth(-1);
  if (BeginList(session, state, "scene", "The scene files of the folder. Dropping a file onto the window opens it too.",
                PathText(current.filename()))) {
    for (const std::filesystem::path& file : session.SceneFiles()) {
      const std::string name = PathText(file.filename());
      if (ImGui::Selectable(name.c_str(), file == current)) chosen = file;
      if (file == current) ImGui::SetItemDefaultFocus();
      NoteBox(session, state, "scene/" + name);
    }
    ImGui::EndCombo();
  }
  const std::vector<std::string>& recent = state.kept.recentScenes;
  ImGui::SetNextItemWidth(-1);
  if (recent.size() > 1 &&
      BeginList(session, state, "recent scene", "Scenes that were open before, the latest first.", "recent scenes")) {
    for (std::size_t i = 1; i < recent.size(); ++i) {  // The first one is open.
      if (ImGui::Selectable(recent[i].c_str())) chosen = TextPath(recent[i]);
      NoteBox(session, state, "recent scene/" + recent[i]);
    }
    ImGui::EndCombo();
  }
  if (!chosen.empty()) session.OpenScene(chosen);
}

}  // namespace percale::viewer
