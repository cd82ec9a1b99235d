#include "apps/viewer/presets.h"

#include <system_error>
#include <utility>

#include "apps/viewer/session.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/preset_file.h"
#include "percale/scene_file.h"

namespace percale::viewer {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = "preset";

}  // namespace

void ApplyPreset(const fs::path& file, Session& session) {
  const Result<Preset> preset = LoadPreset(file);
  if (!preset) {
    session.messages().Set(kSource, preset.diagnostics());
    return;
  }
  session.log().Write(LogLine("preset").Text("name", preset->name));
  Scene changed = session.scene();
  const std::vector<PresetAssignment> assignments = Assignments(*preset, changed);
  for (const PresetAssignment& set : assignments) {
    Choose(*set.parameter, changed, static_cast<std::size_t>(set.index), set.value);
  }
  if (const Status set = session.SetScene("Preset " + preset->name, std::move(changed)); !set) {
    session.messages().Set(kSource, set.diagnostics());
    return;
  }
  const std::string what =
      preset->description.empty() ? std::to_string(assignments.size()) + " values set" : preset->description;
  session.messages().Set(kSource, {MakeNote("preset " + preset->name + ": " + what)});
}

bool SavePreset(const std::string& name, const fs::path& folder, Session& session) {
  const auto refuse = [&](const Diagnostics& why) {
    session.messages().Set(kSource, why);
    return false;
  };
  if (name.find_first_of("/\\:*?\"<>|") != std::string::npos || name.rfind('.', 0) == 0)
    return refuse({MakeError("preset " + Quote(name, 60) +
                             ": expected a name that can be a file's: letters, digits, "
                             "'-' and '_'")});
  const Result<Scene> file = LoadScene(session.sceneFile());
  if (!file) return refuse(file.diagnostics());
  const std::string text =
      FormatPreset("Saved from " + PathText(session.sceneFile().filename()), *file, session.scene());
  const Result<Preset> saved = ParsePreset(text, folder);
  if (!saved) return refuse(saved.diagnostics());
  if (saved->values.empty())
    return refuse({MakeError("no preset was saved: every parameter is as the scene file has it; change some first")});

  std::error_code error;
  fs::create_directories(folder, error);  // What fails here fails below, with its place.
  const fs::path path =
      name.empty() ? NumberedName(folder / session.sceneFile().stem(), ".json") : folder / TextPath(name + ".json");
  if (fs::exists(path, error))
    return refuse({MakeError(PathText(path), "there is a preset of this name; choose another, or delete the file")});
  if (const Status written = WriteFile(path, text); !written) return refuse(written.diagnostics());
  session.log().Write(LogLine("preset_saved").Text("file", PathText(path)));
  session.messages().Set(kSource, {MakeNote("preset " + PathText(path.stem()) + " saved as " + PathText(path) + ": " +
                                            std::to_string(saved->values.size()) + " values")});
  return true;
}

}  // namespace percale::viewer
