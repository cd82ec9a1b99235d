#include <imgui.h>

#include <cstdio>
#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/presets.h"
#include "apps/viewer/widgets.h"
#include "io/preset_file.h"

namespace percale::viewer {

void DrawPresetsPanel(Session& session, UiState& state) {
  ImGui::SetNextItemWidth(-1);
  if (BeginList(session, state, "preset", "Sets several parameters at once. The files are in the folder presets/.",
                "apply a preset")) {
    for (const auto& preset : ListPresets(state.presetFolders)) {
      if (ImGui::Selectable(preset.first.c_str())) ApplyPreset(preset.second, session);
      const Result<Preset> read = ImGui::IsItemHovered() ? LoadPreset(preset.second) : Result<Preset>(Preset{});
      Control(session, state, "preset/" + preset.first, read ? read->description : "This file cannot be read.");
    }
    ImGui::EndCombo();
  }
  char name[64];
  std::snprintf(name, sizeof name, "%s", state.presetName.c_str());
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x / 2);
  if (ImGui::InputTextWithHint("##name", "name of a new one", name, sizeof name)) state.presetName = name;
  Control(session, state, "preset name",
          "Of the preset that Save makes: it holds the parameters that differ from the scene file. Without a name it "
          "is called after the scene.");
  ImGui::SameLine();
  ActionButton(session, state, "save_preset");
}

}  // namespace percale::viewer
