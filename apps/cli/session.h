#pragma once
/// \file
/// What most verbs begin with: finding the project and loading the scene as the command line wants it.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/cli/options.h"
#include "io/preset_file.h"
#include "percale/diagnostic.h"
#include "percale/scene.h"
#include "percale/scene_file.h"
#include "percale/world.h"
#include "render/scene_view.h"

namespace percale::cli {

/// A scene with the command line's presets and assignments applied. A checkpoint or a picture brings along
/// where it stands (render/view_file.h).
struct Session {
  Scene scene;
  std::filesystem::path file;
  std::optional<percale::View> view;
  int width = 0, height = 0;  ///< Of a picture that was opened [pixel].
  std::shared_ptr<const WorldState> state;
  int frame = 0;                                   ///< From the start, without a state.
  std::vector<Preset> presets;                     ///< Of --preset.
  std::vector<std::string> set;                    ///< Of --set, presets there replaced by what they set.
  Origins origins;                                 ///< Places in the file.
  std::map<std::string, std::string> assignments;  ///< By path ("/cloth/0/ks"): the option that won.
};

/// Messages to stderr; those that concern no file are marked as the program's.
void PrintDiagnostics(const Diagnostics& diagnostics);
void PrintError(const std::string& message);

/// The folder that holds shaders/ and scene/: `asked`, or when that is empty searched for from the
/// current folder upwards, around the program, and where it is installed.
Result<std::filesystem::path> FindRoot(const std::string& asked);

/// Loads the scene. On failure prints what is wrong and returns the exit code. When
/// --print-config is given, prints the configuration and returns kDone.
std::variant<Session, int> OpenSession(const Options& options);

/// The scene file that is meant: a name that does not lead to a file from here is also tried from
/// the project's folder.
Result<std::filesystem::path> ResolveScene(const Options& options, const std::string& name);

/// Where presets are: the user's own, then the project's.
std::vector<std::filesystem::path> PresetFolders(const Options& options);

/// The scene with the camera that the command line asks for.
Scene SeenScene(const Options& options, const Scene& scene);

/// Every parameter with its value and where it comes from, to stdout.
void PrintConfiguration(const Options& options, const Session& session);

/// A word of a command line, quoted for a shell where need be.
std::string ShellWord(const std::string& word);

/// The options that make the same scene again: "scene/a.json --set cloth.ks=5".
std::string SceneArguments(const Options& options, const Session& session);

/// Counts and sizes with separators and units a person reads at a glance: "12.5 MB".
std::string Megabytes(double bytes);

}  // namespace percale::cli
