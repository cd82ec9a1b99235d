#include "apps/cli/session.h"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <vector>

#include "apps/cli/platform.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"
#include "render/camera.h"
#include "render/view_file.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultScene = "scene/pinned2.json";

bool IsRoot(const fs::path& folder) {
  std::error_code code;
  return fs::is_directory(folder / "shaders", code) && fs::is_directory(folder / "scene", code);
}

/// A preset that an option names. On failure prints what is wrong and returns the exit code.
std::variant<Preset, int> ReadPreset(const Options& options, const std::string& option, const std::string& name) {
  auto preset = FindPreset(name, PresetFolders(options));
  if (preset) return *preset;
  Diagnostics errors = preset.diagnostics();
  const bool hasPlace = !errors.front().place.file.empty();
  for (Diagnostic& error : errors) {
    if (error.place.file.empty()) error.message = option + ": " + error.message;
  }
  PrintDiagnostics(errors);
  return hasPlace ? kInvalid : kUsage;
}

/// "a.json:3:7"
std::string PlaceText(const Place& place) {
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

/// Sets what the presets state and the scene file does not. Returns an exit code.
int ApplyPresets(const Options& options, Session& session) {
  if (!options.presets.empty() && (session.state || session.view)) {
    PrintError("--preset: " + PathText(session.file) +
               " states every parameter itself, which wins; with --set preset=" + ShellWord(options.presets.front()) +
               " the preset does");
    return kUsage;
  }
  for (const std::string& name : options.presets) {
    auto read = ReadPreset(options, "--preset", name);
    if (const int* code = std::get_if<int>(&read)) return *code;
    const Preset& preset = std::get<Preset>(read);
    std::vector<PresetAssignment> givesWay;
    for (const PresetAssignment& set : ApplyBelow(preset, session.origins, session.scene, &givesWay)) {
      session.assignments[set.path] = "--preset " + ShellWord(name) + ", " + PlaceText(set.place);
    }
    if (!givesWay.empty()) {
      std::string paths;
      for (const PresetAssignment& way : givesWay) paths += (paths.empty() ? "" : ", ") + way.path;
      PrintDiagnostics({MakeNote("--preset " + ShellWord(name) + ": the scene file states " + paths +
                                 " itself, which wins; with --set preset=" + ShellWord(name) + " the preset does")});
    }
    session.presets.push_back(preset);
  }
  return kDone;
}

/// Applies the assignments. Returns an exit code.
int ApplySettings(const Options& options, Session& session) {
  constexpr std::string_view kPreset = "preset=";
  for (const std::string& option : options.set) {
    const std::string origin = "--set " + ShellWord(option);
    if (option.rfind(kPreset, 0) == 0) {
      auto read = ReadPreset(options, "--set preset", option.substr(kPreset.size()));
      if (const int* code = std::get_if<int>(&read)) return *code;
      for (const PresetAssignment& set : Assignments(std::get<Preset>(read), session.scene)) {
        Choose(*set.parameter, session.scene, static_cast<std::size_t>(set.index), set.value);
        session.assignments[set.path] = origin + ", " + PlaceText(set.place);
        std::string path = set.path.substr(1);
        std::replace(path.begin(), path.end(), '/', '.');
        session.set.push_back(path + "=" + FormatValue(set.value));
      }
      continue;
    }
    const auto paths = ApplyAssignment(session.scene, option);
    if (!paths) {
      Diagnostics errors = paths.diagnostics();
      for (Diagnostic& error : errors) error.message = "--set " + error.message;
      PrintDiagnostics(errors);
      return kUsage;
    }
    for (const std::string& path : *paths) session.assignments[path] = origin;
    session.set.push_back(option);
  }
  return kDone;
}

/// The key of a parameter as --set takes it: "cloth.ks", or "cloth.1.ks" where there are several.
std::string SetPath(const Parameter& parameter, const ParameterGroup& group, std::size_t index, std::size_t count) {
  std::string path(parameter.group);
  if (group.isArray && count > 1) path += "." + std::to_string(index);
  return path + "." + std::string(parameter.name);
}

}  // namespace

void PrintError(const std::string& message) {
  std::fflush(stdout);
  std::fprintf(stderr, "percale: error: %s\n", message.c_str());
}

void PrintDiagnostics(const Diagnostics& diagnostics) {
  std::fflush(stdout);
  for (const Diagnostic& diagnostic : diagnostics) {
    const std::string text = (diagnostic.place.file.empty() ? "percale: " : "") + Format(diagnostic);
    std::fwrite(text.data(), 1, text.size(), stderr);
  }
}

Result<fs::path> FindRoot(const std::string& asked) {
  if (!asked.empty()) {
    if (IsRoot(TextPath(asked))) return TextPath(asked);
    return MakeError("-r: expected the project's folder, which holds shaders/ and scene/, got " + Quote(asked, 200));
  }
  std::vector<fs::path> candidates = {".", "..", "../..", "../../.."};
  if (const fs::path program = ExecutablePath(); !program.empty()) {
    const fs::path folder = program.parent_path();
    candidates.push_back(folder / ".." / "share" / "percale");
    fs::path above = folder;
    for (int i = 0; i < 4; ++i) {  // build/release/bin, and deeper
      candidates.push_back(above);
      above = above.parent_path();
    }
  }
  for (const fs::path& candidate : candidates) {
    if (IsRoot(candidate)) {
      std::error_code code;
      const fs::path whole = fs::weakly_canonical(candidate, code);
      return code || !candidate.is_absolute() ? candidate : whole;
    }
  }
  return MakeError(
      "the project's folder, which holds shaders/ and scene/, was not found from here; name it with -r DIR");
}

Result<fs::path> ResolveScene(const Options& options, const std::string& name) {
  std::error_code code;
  if (!name.empty()) {
    const fs::path file = TextPath(name);
    if (fs::exists(file, code) || file.is_absolute()) return file;
    if (const auto root = FindRoot(options.root); root && fs::exists(*root / file, code)) return *root / file;
    return file;  // loading it tells what is wrong
  }
  const auto root = FindRoot(options.root);
  if (!root) return root.diagnostics();
  if (*root == ".") return fs::path(kDefaultScene);
  return *root / kDefaultScene;
}

std::variant<Session, int> OpenSession(const Options& options) {
  if (!options.root.empty()) {  // a wrong -r is told even where the folder is not needed
    if (const auto root = FindRoot(options.root); !root) {
      PrintDiagnostics(root.diagnostics());
      return kUsage;
    }
  }
  const auto file = ResolveScene(options, options.scene);
  if (!file) {
    PrintDiagnostics(file.diagnostics());
    return kFailed;
  }
  Session session;
  session.file = *file;
  const auto root = FindRoot(options.root);
  auto opened = OpenViewFile(*file, root ? *root : fs::path());
  if (!opened) {
    PrintDiagnostics(opened.diagnostics());
    return kInvalid;
  }
  session.scene = std::move(opened->scene);
  session.origins = std::move(opened->origins);
  session.view = std::move(opened->view);
  session.width = opened->width, session.height = opened->height;
  session.state = std::move(opened->state);
  session.frame = opened->frame;
  Diagnostics warnings = opened.diagnostics();

  if (const int code = ApplyPresets(options, session); code != kDone) return code;
  if (const int code = ApplySettings(options, session); code != kDone) return code;
  if (!options.shader.empty()) {
    session.scene.look.shader = options.shader;
    session.assignments["/look/shader"] = "--shader " + ShellWord(options.shader);
  }
  if (!options.set.empty() || !options.presets.empty()) {
    if (const Status loaded = LoadMeshes(session.scene); !loaded) {
      PrintDiagnostics(loaded.diagnostics());
      return kInvalid;
    }
    // What the file's warnings said may no longer hold.
    warnings = CheckScene(session.scene);
    for (Diagnostic& warning : warnings) {
      if (warning.place.file.empty())
        warning.place.file = PathText(session.file) + (options.set.empty() ? " with --preset" : " with --set");
    }
  }
  PrintDiagnostics(warnings);
  if (HasErrors(warnings)) return kInvalid;
  if (options.printConfig) {
    PrintConfiguration(options, session);
    return kDone;
  }
  return session;
}

std::vector<fs::path> PresetFolders(const Options& options) {
  std::vector<fs::path> folders;
  if (const fs::path folder = ConfigFolder(); !folder.empty()) folders.push_back(folder / "presets");
  if (const auto root = FindRoot(options.root)) folders.push_back(*root / "presets");
  return folders;
}

Scene SeenScene(const Options& options, const Scene& scene) {
  Scene seen = scene;
  if (!options.azimuth && !options.target) return seen;
  CameraSettings camera = OrbitCamera::ForScene(scene).Settings();
  camera.automatic = false;
  if (options.azimuth) camera.azimuth = *options.azimuth;
  if (options.elevation) camera.elevation = *options.elevation;
  if (options.distance) camera.distance = *options.distance;
  if (options.target) camera.target = {(*options.target)[0], (*options.target)[1], (*options.target)[2]};
  seen.camera = camera;
  return seen;
}

void PrintConfiguration(const Options& options, const Session& session) {
  const Scene scene = SeenScene(options, session.scene);
  std::map<std::string, std::string> assignments = session.assignments;
  if (options.azimuth) assignments["/camera/azimuth"] = assignments["/camera/elevation"] = "--camera";
  if (options.distance) assignments["/camera/distance"] = "--camera";
  if (options.target) assignments["/camera/target"] = "--target";
  struct Row {
    std::string path, value, unit, origin;
  };
  std::vector<Row> rows;
  std::size_t widest = 0, widestValue = 0;
  for (const Parameter& parameter : Parameters()) {
    const ParameterGroup& group = *FindGroup(parameter.group);
    const std::size_t count = group.count(scene);
    for (std::size_t i = 0; i < count; ++i) {
      const std::string object = "/" + std::string(parameter.group) + (group.isArray ? "/" + std::to_string(i) : "");
      const std::string path = object + "/" + std::string(parameter.name);
      Row row;
      row.path = SetPath(parameter, group, i, count);
      row.value = FormatValue(parameter.get(scene, i));
      row.unit = parameter.unit;
      if (const auto set = assignments.find(path); set != assignments.end()) {
        row.origin = set->second;
      } else if (const auto place = session.origins.find(path); place != session.origins.end()) {
        row.origin = PlaceText(place->second);
      } else {
        // Such as camera.automatic where the camera is stated.
        const bool isDefault = parameter.get(scene, i) == DefaultValue(parameter);
        row.origin = isDefault ? "default" : "follows from the rest";
      }
      widest = std::max(widest, row.path.size());
      widestValue = std::max(widestValue, row.value.size() + row.unit.size() + 1);
      rows.push_back(std::move(row));
    }
  }
  widestValue = std::min<std::size_t>(widestValue, 40);
  for (const Row& row : rows) {
    const std::string value = row.value + (row.unit.empty() ? "" : " " + row.unit);
    std::printf("%-*s = %-*s  # %s\n", int(widest), row.path.c_str(), int(widestValue), value.c_str(),
                row.origin.c_str());
  }
}

std::string ShellWord(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./=,:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string SceneArguments(const Options& options, const Session& session) {
  std::string text = ShellWord(PathText(session.file));
  for (const std::string& preset : options.presets) text += " --preset " + ShellWord(preset);
  for (const std::string& assignment : options.set) text += " --set " + ShellWord(assignment);
  return text;
}

std::string Megabytes(double bytes) {
  if (bytes < 1e4) return Text("%.0f bytes", bytes);
  if (bytes < 1e6) return Text("%.0f kB", bytes / 1e3);
  if (bytes < 1e9) return Text("%.1f MB", bytes / 1e6);
  return Text("%.1f GB", bytes / 1e9);
}

}  // namespace percale::cli
