#include "io/preset_file.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

/// A scene with one object of each kind, for checking values.
Scene OneOfEach() {
  Scene scene;
  for (const ParameterGroup& group : ParameterGroups()) group.resize(scene, 1);
  return scene;
}

std::string JsonOf(const JsonDocument& document, JsonIndex value) {
  switch (document.Kind(value)) {
    case JsonKind::Boolean:
      return document.Boolean(value) ? "true" : "false";
    case JsonKind::Number:
      return FormatNumber(document.Number(value));
    case JsonKind::Text:
      return Quote(document.Text(value));
    case JsonKind::Array: {
      std::string json;
      for (const JsonIndex child : document.Children(value)) {
        json += (json.empty() ? "" : ", ") + JsonOf(document, child);
      }
      return "[" + json + "]";
    }
    case JsonKind::Object:
    case JsonKind::Null:
      break;
  }
  return document.Source(value);
}

/// The message of an assignment without the assignment at its front, which the place replaces.
std::string WithoutAssignment(const std::string& message, const std::string& assignment) {
  const std::string front = Quote(assignment, 80) + ": ";
  return message.rfind(front, 0) == 0 ? message.substr(front.size()) : message;
}

Result<Preset> Read(const Result<JsonDocument>& read, const fs::path& file) {
  if (!read) return read.diagnostics();
  const JsonDocument& document = *read;
  Preset preset;
  preset.name = PathText(file.stem());
  Diagnostics errors;
  const auto error = [&](JsonIndex value, const std::string& message) {
    errors.push_back(document.About(value, Severity::Error, message));
  };
  if (document.Kind(0) != JsonKind::Object) {
    error(0, "expected a preset, {\"description\": ..., \"set\": {...}}, got " + document.Source(0));
    return errors;
  }
  JsonIndex set = 0;
  for (const JsonIndex member : document.Children(0)) {
    const std::string& key = document.Key(member);
    constexpr std::string_view kKeys[] = {"description", "set"};
    if (key.rfind('_', 0) == 0) continue;  // A comment, as in scenes.
    if (key == "description") {
      if (document.Kind(member) == JsonKind::Text)
        preset.description = document.Text(member);
      else
        error(member, "/description: expected a text, got " + document.Source(member));
    } else if (key == "set") {
      set = member;
    } else {
      errors.push_back(document.AboutKey(
          member, Severity::Error,
          "unknown key " + Quote(key, 40) + DidYouMean(key, kKeys) + "; the keys of a preset are description and set"));
    }
  }
  if (set == 0) {
    error(0, "/set: this key is missing; expected an object of values, such as {\"cloth.ks\": 800}");
  } else if (document.Kind(set) != JsonKind::Object) {
    error(set, "/set: expected an object of values, such as {\"cloth.ks\": 800}, got " + document.Source(set));
  } else {
    Scene scene = OneOfEach();
    for (const JsonIndex member : document.Children(set)) {
      const std::string& path = document.Key(member);
      if (path.rfind('_', 0) == 0) continue;
      const std::string value = JsonOf(document, member), assignment = path + "=" + value;
      // A path with an index is checked as the one object there is here.
      const std::size_t first = path.find('.'), last = path.rfind('.');
      const bool indexed = first != last && ParseNumber(std::string_view(path).substr(first + 1, last - first - 1));
      const std::string plain = indexed ? path.substr(0, first) + path.substr(last) : path;
      const auto applied = ApplyAssignment(scene, plain + "=" + value);
      if (applied) {
        preset.values.push_back({path, value, document.PlaceOf(member)});
        continue;
      }
      const bool known = first != std::string::npos && FindParameter(path.substr(0, first), path.substr(last + 1));
      const std::string message =
          path + ": " + WithoutAssignment(applied.diagnostics().front().message, plain + "=" + value);
      errors.push_back(known ? document.About(member, Severity::Error, message)
                             : document.AboutKey(member, Severity::Error, message));
    }
  }
  if (!errors.empty()) return errors;
  return preset;
}

}  // namespace

Result<Preset> LoadPreset(const fs::path& file) {
  return Read(JsonDocument::Load(file), file);
}

Result<Preset> ParsePreset(const std::string& text, const fs::path& file) {
  return Read(JsonDocument::Parse(text, PathText(file)), file);
}

std::map<std::string, fs::path> ListPresets(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::path> presets;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      if (LowerExtension(entry->path()) == ".json") presets.emplace(PathText(entry->path().stem()), entry->path());
    }
  }
  return presets;
}

Result<Preset> FindPreset(std::string_view name, const std::vector<fs::path>& folders) {
  const fs::path file = TextPath(name);
  if (LowerExtension(file) == ".json") return LoadPreset(file);
  const std::map<std::string, fs::path> presets = ListPresets(folders);
  const auto found = presets.find(std::string(name));
  if (found != presets.end()) return LoadPreset(found->second);
  std::vector<std::string_view> names;
  std::string list;
  for (const auto& preset : presets) {
    names.push_back(preset.first);
    list += (list.empty() ? "" : ", ") + preset.first;
  }
  return MakeError("there is no preset " + Quote(name, 60) + DidYouMean(name, names) + "; " +
                   (list.empty() ? "there are none" : "the presets are " + list));
}

std::vector<PresetAssignment> Assignments(const Preset& preset, const Scene& scene) {
  std::vector<PresetAssignment> assignments;
  Scene changed = scene;
  for (const PresetValue& value : preset.values) {
    const auto paths = ApplyAssignment(changed, value.path + "=" + value.value);
    if (!paths) continue;  // Every value was checked when it was read: the scene has no such object.
    const std::size_t first = value.path.find('.'), last = value.path.rfind('.');
    const Parameter* const parameter =
        FindParameter(std::string_view(value.path).substr(0, first), std::string_view(value.path).substr(last + 1));
    for (const std::string& path : *paths) {
      // "/cloth/1/ks" or "/wind/velocity"
      const std::size_t slash = path.find('/', 1);
      const bool indexed = path.rfind('/') != slash;
      const int index =
          indexed ? static_cast<int>(*ParseNumber(path.substr(slash + 1, path.rfind('/') - slash - 1))) : 0;
      assignments.push_back(
          {path, parameter, index, parameter->get(changed, static_cast<std::size_t>(index)), value.place});
    }
  }
  return assignments;
}

std::vector<PresetAssignment> ApplyBelow(const Preset& preset, const Origins& stated, Scene& scene,
                                         std::vector<PresetAssignment>* givesWay) {
  std::vector<PresetAssignment> set;
  for (PresetAssignment& assignment : Assignments(preset, scene)) {
    if (stated.count(assignment.path) > 0) {
      if (givesWay) givesWay->push_back(std::move(assignment));
      continue;
    }
    Choose(*assignment.parameter, scene, static_cast<std::size_t>(assignment.index), assignment.value);
    set.push_back(std::move(assignment));
  }
  return set;
}

std::string FormatPreset(std::string_view description, const Scene& from, const Scene& to) {
  std::string json;
  for (const Parameter& parameter : Parameters()) {
    if (parameter.group == "camera") continue;
    const ParameterGroup& group = *FindGroup(parameter.group);
    const std::size_t objects = group.count(to), count = std::min(objects, group.count(from));
    const auto differs = [&](std::size_t i) { return parameter.get(from, i) != parameter.get(to, i); };
    const auto add = [&](const std::string& path, std::size_t i) {
      json += (json.empty() ? "\n    " : ",\n    ") + Quote(path) + ": " + FormatValue(parameter.get(to, i));
    };
    const std::string front(parameter.group), back = "." + std::string(parameter.name);
    bool any = false, alike = true;
    for (std::size_t i = 0; i < count; ++i) {
      any |= differs(i);
      alike &= parameter.get(to, i) == parameter.get(to, 0);
    }
    if (!any) continue;
    if (alike && count == objects) {
      add(front + back, 0);
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (differs(i)) add(front + "." + std::to_string(i) + back, i);
    }
  }
  return "{\n  \"description\": " + Quote(description) + ",\n  \"set\": {" + json + (json.empty() ? "" : "\n  ") +
         "}\n}\n";
}

}  // namespace percale
