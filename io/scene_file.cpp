#include "percale/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"
#include "mesh/cloth_model.h"
#include "mesh/collider_mesh.h"
#include "mesh/vertex_cache.h"
#include "percale/fabrics.h"
#include "percale/mesh_file.h"
#include "percale/parameters.h"

namespace percale {
namespace {

constexpr std::size_t kMostMessages = 1000;
constexpr double kLargestInt = 2147483647;

bool IsComment(std::string_view key) {
  return !key.empty() && key[0] == '_';
}

std::vector<std::string_view> SplitPath(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    path.remove_prefix(1);  // the '/'
    const std::size_t end = path.find('/');
    parts.push_back(path.substr(0, end));
    path = end == std::string_view::npos ? std::string_view() : path.substr(end);
  }
  return parts;
}

/// Whether the cloth or collider has a mesh to read, and does not hold it yet.
bool HasToRead(const ClothSettings& cloth) {
  if (cloth.shape != Shape::Mesh || cloth.mesh.empty()) return false;
  return !cloth.loaded || cloth.loaded->file != cloth.mesh || cloth.loaded->options != MeshOptionsOf(cloth);
}
bool HasToRead(const ColliderSettings& collider) {
  return !collider.mesh.empty() && LacksMesh(collider);
}

/// What only colliders need done.
Diagnostics Finish(ClothSettings&, LoadedMesh&) {
  return {};
}
Diagnostics Finish(ColliderSettings& collider, LoadedMesh& loaded) {
  collider.loadedCache.reset();  // it was read for another mesh
  loaded.openEdges = CountOpenEdges(loaded.mesh);
  return TurnOutwards(loaded.mesh);
}

/// Of a cloth or a collider.
Status ReadMesh(const Scene& scene, auto& settings) {
  const MeshOptions options = MeshOptionsOf(settings);
  const std::filesystem::path file = MeshFile(scene, settings.mesh);
  Result<RestMesh> mesh = LoadMesh(file, options);
  if (!mesh) return mesh.diagnostics();
  LoadedMesh loaded{settings.mesh, options, std::move(*mesh), 0};
  Diagnostics warnings = mesh.diagnostics();
  for (Diagnostic& warning : Finish(settings, loaded)) {
    warning.place.file = PathText(file);
    warnings.push_back(std::move(warning));
  }
  settings.loaded = std::make_shared<const LoadedMesh>(std::move(loaded));
  return {std::monostate{}, std::move(warnings)};
}

/// Of a collider that holds its mesh.
Status ReadCache(const Scene& scene, ColliderSettings& collider) {
  const std::filesystem::path file = MeshFile(scene, collider.cache);
  Result<VertexCache> cache = LoadVertexCache(file, collider.loaded->mesh, collider.meshScale);
  if (!cache) return cache.diagnostics();
  cache->file = collider.cache;
  Diagnostics warnings = cache.diagnostics();
  for (Diagnostic& warning : FindCacheProblems(collider.loaded->mesh, *cache, collider.meshScale)) {
    warning.place.file = PathText(file);
    warnings.push_back(std::move(warning));
  }
  collider.loadedCache = std::make_shared<const VertexCache>(std::move(*cache));
  return {std::monostate{}, std::move(warnings)};
}

/// Turns a document into a scene and collects everything that is wrong with it.
class SceneReader {
 public:
  SceneReader(const JsonDocument& document, Origins* origins) : document_(document), origins_(origins) {}

  Result<Scene> Read(const std::string& name) {
    scene_.name = name;
    if (document_.Kind(kRoot) != JsonKind::Object) {
      return document_.About(
          kRoot, Severity::Error,
          "expected a scene, a JSON object such as {\"cloth\": {...}}, got " + document_.Source(kRoot));
    }
    ReadEngine();
    JsonIndex sphere = 0, plane = 0;
    for (const JsonIndex member : document_.Children(kRoot)) {
      const std::string& key = document_.Key(member);
      if (IsComment(key)) continue;
      const ParameterGroup* group = FindGroup(key);
      if (!group) {
        ReportUnknown(member, "", {});
        continue;
      }
      if (key == "sphere") sphere = member;
      if (key == "plane") plane = member;
      ReadGroup(*group, member);
    }
    scene_.planesFirst = plane != 0 && sphere != 0 && plane < sphere;
    if (scene_.simulation.engine == Engine::Fabric) {
      ReadMeshes("cloth", scene_.cloths);
      ReadMeshes("collider", scene_.colliders);
      ReadCaches();
    }
    CheckWhole();
    return Finish();
  }

 private:
  static constexpr JsonIndex kRoot = 0;
  static constexpr const char* kMeshKeys[] = {"shape",         "mesh", "mesh_scale",   "rest_shape",
                                              "metres_per_uv", "weld", "weld_distance"};

  void Error(JsonIndex value, const std::string& message) { Report(value, Severity::Error, message); }

  /// Keeps a message, or only counts it once there are many; at least one error is kept.
  void Report(JsonIndex value, Severity severity, const std::string& message) {
    const bool isError = severity == Severity::Error;
    if (diagnostics_.size() >= kMostMessages && (hasErrors_ || !isError)) {
      ++dropped_;
      return;
    }
    hasErrors_ = hasErrors_ || isError;
    diagnostics_.push_back(document_.About(value, severity, message));
  }

  /// The engine comes first: what a cloth may leave out depends on it.
  void ReadEngine() {
    const Parameter& engine = *FindParameter("simulation", "engine");
    const JsonIndex simulation = document_.Member(kRoot, "simulation");
    if (simulation == 0 || document_.Kind(simulation) != JsonKind::Object) return;
    const JsonIndex stated = document_.Member(simulation, "engine");
    if (stated == 0 || document_.Kind(stated) != JsonKind::Text) return;
    const Value value = document_.Text(stated);
    if (!CheckValue(engine, value)) Choose(engine, scene_, 0, value);
  }

  /// What is wrong with a mesh is told at its own place, and follows the messages of the scene. Of cloths or colliders.
  void ReadMeshes(const std::string& group, auto& owners) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
      const std::string index = std::to_string(i), object = "/" + group + "/" + index;
      const bool known = std::none_of(std::begin(kMeshKeys), std::end(kMeshKeys),
                                      [&](const char* key) { return failed_.count(object + "/" + key) > 0; });
      if (!known || !HasToRead(owners[i])) continue;
      const Status read = ReadMesh(scene_, owners[i]);
      TakeMessages(read, {group, index, "mesh"}, owners[i].mesh);
    }
  }

  void ReadCaches() {
    for (std::size_t i = 0; i < scene_.colliders.size(); ++i) {
      ColliderSettings& collider = scene_.colliders[i];
      if (!collider.loaded || !LacksCache(collider)) continue;
      TakeMessages(ReadCache(scene_, collider), {"collider", std::to_string(i), "cache"}, collider.cache);
    }
  }

  /// Of a file that the value at `parts` names.
  void TakeMessages(const Status& read, const std::array<std::string, 3>& parts, const std::string& file) {
    meshMessages_.insert(meshMessages_.end(), read.diagnostics().begin(), read.diagnostics().end());
    if (read) return;
    auto [value, path] = Locate({parts.begin(), parts.end()});
    Error(value, path + ": " + Quote(file, 80) + " cannot be used; what is wrong with it follows");
    failed_.insert("/" + parts[0] + "/" + parts[1] + "/" + parts[2]);
  }

  void ReadGroup(const ParameterGroup& group, JsonIndex value) {
    const std::string path = "/" + std::string(group.name);
    if (group.isArray && document_.Kind(value) == JsonKind::Array) {
      const std::vector<JsonIndex> objects = document_.Children(value);
      group.resize(scene_, objects.size());
      for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::string place = path + "/" + std::to_string(i);
        ReadObject(group, i, objects[i], place, place);
      }
      return;
    }
    if (document_.Kind(value) != JsonKind::Object) {
      Error(value, path + ": expected an object" + (group.isArray ? " or an array of objects" : "") + ", got " +
                       document_.Source(value));
      failed_.insert(path);
      return;
    }
    group.resize(scene_, 1);
    ReadObject(group, 0, value, path, group.isArray ? path + "/0" : path);
  }

  /// `path` is how the file reads, `canonical` how it would with every group in an array.
  void ReadObject(const ParameterGroup& group, std::size_t index, JsonIndex object, const std::string& path,
                  const std::string& canonical) {
    if (document_.Kind(object) != JsonKind::Object) {
      Error(object, path + ": expected an object, got " + document_.Source(object));
      failed_.insert(canonical);
      return;
    }
    std::set<std::string_view> stated;
    if (group.name == "cloth" && scene_.simulation.engine == Engine::Fabric) SetFabric(scene_.cloths[index], Fabric{});
    std::vector<JsonIndex> members = document_.Children(object);
    std::stable_partition(members.begin(), members.end(), [&](JsonIndex member) {
      const Parameter* parameter = FindParameter(group.name, document_.Key(member));
      return parameter && parameter->choose;
    });
    for (const JsonIndex member : members) {
      const std::string& key = document_.Key(member);
      if (IsComment(key)) continue;
      const Parameter* parameter = FindParameter(group.name, key);
      if (!parameter) {
        ReportUnknown(member, path, group.name);
        failed_.insert(canonical + "/" + key);
        continue;
      }
      stated.insert(parameter->name);
      const std::string valuePath = path + "/" + key;
      const std::optional<Value> value = Convert(*parameter, member, valuePath);
      const std::optional<std::string> problem = value ? CheckValue(*parameter, *value) : std::nullopt;
      if (problem) Error(member, valuePath + ": " + *problem);
      if (!value || problem) {
        failed_.insert(canonical + "/" + key);
        continue;
      }
      Choose(*parameter, scene_, index, *value);
      if (!IsHeeded(*parameter, scene_)) {
        const std::string_view engine =
            FindParameter("simulation", "engine")->choices[static_cast<std::size_t>(*parameter->engine)];
        Report(member, Severity::Warning, valuePath + ": only the engine " + Quote(engine) + " heeds this");
      }
      if (origins_) (*origins_)[canonical + "/" + key] = document_.PlaceOf(member);
    }
    for (const Parameter& parameter : Parameters()) {
      if (parameter.group != group.name || !IsRequired(parameter, scene_) || stated.count(parameter.name) > 0) continue;
      failed_.insert(canonical + "/" + std::string(parameter.name));
      Error(object, path + "/" + std::string(parameter.name) + ": this key is missing; expected " +
                        DescribeExpected(parameter) + ", such as " + FormatValue(DefaultValue(parameter)));
    }
    // Who places the camera by hand does not want it placed automatically, unless they say so.
    if (group.name == "camera" && !stated.empty() && stated.count("automatic") == 0) scene_.camera.automatic = false;
  }

  /// The value of the parameter's kind, not yet checked against its range; reports what is none.
  std::optional<Value> Convert(const Parameter& parameter, JsonIndex value, const std::string& path) {
    const auto wrong = [&] {
      Error(value, path + ": expected " + DescribeExpected(parameter) + ", got " + document_.Source(value));
      return std::nullopt;
    };
    const JsonKind kind = document_.Kind(value);
    switch (parameter.kind) {
      case ValueKind::Number:
      case ValueKind::Integer:
        if (kind != JsonKind::Number) return wrong();
        return document_.Number(value);
      case ValueKind::Boolean:
        if (kind != JsonKind::Boolean) return wrong();
        return document_.Boolean(value);
      case ValueKind::Choice:
      case ValueKind::Text:
        if (kind != JsonKind::Text) return wrong();
        return document_.Text(value);
      case ValueKind::Vector: {
        if (kind != JsonKind::Array) return wrong();
        const std::vector<JsonIndex> parts = document_.Children(value);
        if (parts.size() != 3) return wrong();
        double numbers[3] = {};
        for (std::size_t k = 0; k < 3; ++k) {
          if (!ReadNumber(parts[k], path + "/" + std::to_string(k), numbers[k])) return std::nullopt;
        }
        return Vec3{numbers[0], numbers[1], numbers[2]};
      }
      case ValueKind::GridPoints:
        break;
    }
    if (kind != JsonKind::Array) return wrong();
    return ConvertPoints(value, path);
  }

  std::optional<Value> ConvertPoints(JsonIndex value, const std::string& path) {
    std::vector<GridPoint> points;
    bool good = true;
    const std::vector<JsonIndex> elements = document_.Children(value);
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const std::string place = path + "/" + std::to_string(k);
      if (document_.Kind(elements[k]) == JsonKind::Number) {
        double vertex = 0;
        good = ReadWhole(elements[k], place, vertex) && good;
        if (good) points.push_back({static_cast<int>(vertex), 0});
        continue;
      }
      const bool isArray = document_.Kind(elements[k]) == JsonKind::Array;
      const std::vector<JsonIndex> ij = document_.Children(elements[k]);
      if (!isArray || ij.size() != 2) {
        Error(elements[k], place + ": expected a point [i, j], two whole numbers, or the number of a vertex, got " +
                               document_.Source(elements[k]));
        good = false;
        continue;
      }
      double numbers[2] = {};
      const bool whole0 = ReadWhole(ij[0], place + "/0", numbers[0]),
                 whole1 = ReadWhole(ij[1], place + "/1", numbers[1]);
      good = good && whole0 && whole1;
      if (good) points.push_back({static_cast<int>(numbers[0]), static_cast<int>(numbers[1])});
    }
    if (!good) return std::nullopt;
    return points;
  }

  bool ReadNumber(JsonIndex value, const std::string& path, double& number) {
    if (document_.Kind(value) != JsonKind::Number) {
      Error(value, path + ": expected a number, got " + document_.Source(value));
      return false;
    }
    number = document_.Number(value);
    return true;
  }
  bool ReadWhole(JsonIndex value, const std::string& path, double& number) {
    const bool isNumber = document_.Kind(value) == JsonKind::Number;
    number = isNumber ? document_.Number(value) : 0;
    if (isNumber && std::trunc(number) == number && std::abs(number) <= kLargestInt) return true;
    Error(value, path + ": expected a whole number, got " + document_.Source(value));
    return false;
  }

  /// A key that nothing knows, at the top level (`path` empty) or in an object of `group`.
  void ReportUnknown(JsonIndex member, const std::string& path, std::string_view group) {
    const std::string& key = document_.Key(member);
    std::vector<std::string_view> known;
    std::string owners;
    if (group.empty()) {
      for (const ParameterGroup& g : ParameterGroups()) known.push_back(g.name);
    } else if (FindGroup(key)) {
      owners = "; it belongs to the top level of the file";
    }
    for (const Parameter& parameter : Parameters()) {
      if (parameter.group == group) known.push_back(parameter.name);
      if (parameter.name == key) {
        owners += (owners.empty() ? "; it belongs in `" : " or `") + std::string(parameter.group) + "`";
      }
    }
    std::string hint = owners.empty() ? DidYouMean(key, known) : owners;
    if (hint.empty()) {
      hint = "; known are ";
      for (std::size_t k = 0; k < known.size(); ++k) hint += (k > 0 ? ", " : "") + std::string(known[k]);
      hint += ", and keys that begin with '_' for comments";
    }
    const std::string quoted = Quote(key, 40);  // its escapes, without the quotes
    if (diagnostics_.size() >= kMostMessages && hasErrors_) {
      ++dropped_;
      return;
    }
    hasErrors_ = true;
    diagnostics_.push_back(document_.AboutKey(
        member, Severity::Error, path + "/" + quoted.substr(1, quoted.size() - 2) + ": unknown key" + hint));
  }

  /// What concerns several values at once, at the place of the value that it names.
  void CheckWhole() {
    for (Diagnostic& found : CheckScene(scene_)) {
      const std::size_t colon = found.message.find(": ");
      const std::string canonical = found.message.substr(0, colon);
      const std::vector<std::string_view> parts = SplitPath(canonical);
      if (FollowsFromFailure(canonical, parts, found.severity)) continue;
      auto [value, path] = Locate(parts);
      Report(value, found.severity, path + found.message.substr(colon));
    }
  }

  /// Whether the scene only has that problem because a value that could not be read stands at its
  /// default.
  bool FollowsFromFailure(const std::string& path, const std::vector<std::string_view>& parts,
                          Severity severity) const {
    const std::string group = "/" + std::string(parts[0]);
    const std::string object =
        FindGroup(parts[0])->isArray && parts.size() > 1 ? group + "/" + std::string(parts[1]) : group;
    if (failed_.count(group) > 0 || failed_.count(path) > 0) return true;
    if (severity != Severity::Error) return FailedBelow(object) || FailedBelow("/simulation");
    if (group == "/pin_motion" || group == "/patch" || group == "/tether")
      return FailedBelow(object) || FailedBelow("/cloth");
    if (group == "/collider_motion") return FailedBelow(object) || failed_.count("/collider") > 0;
    if (group == "/collider") return FailedBelow(object);
    if (group != "/cloth") return false;
    for (const char* name :
         {"/width", "/height", "/num_width_points", "/num_height_points", "/pinned", "/radius", "/rings"}) {
      if (failed_.count(object + name) > 0) return true;
    }
    for (const char* name : kMeshKeys) {
      if (failed_.count(object + "/" + name) > 0) return true;
    }
    return failed_.count(object) > 0;
  }
  bool FailedBelow(const std::string& object) const {
    const auto next = failed_.lower_bound(object + "/");
    return failed_.count(object) > 0 ||
           (next != failed_.end() && next->compare(0, object.size() + 1, object + "/") == 0);
  }

  /// The value with that canonical path, or the nearest above it that the file states; and the path
  /// as the file would write it.
  std::pair<JsonIndex, std::string> Locate(const std::vector<std::string_view>& parts) {
    std::string path;
    JsonIndex value = kRoot;
    bool found = true;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const bool isIndexOfSingle = k == 1 && FindGroup(parts[0])->isArray && document_.Kind(value) == JsonKind::Object;
      if (isIndexOfSingle) continue;
      path += "/" + std::string(parts[k]);
      if (!found) continue;
      JsonIndex next = 0;
      if (document_.Kind(value) == JsonKind::Object) {
        next = document_.Member(value, parts[k]);
      } else if (const auto index = ParseNumber(parts[k])) {
        const auto [entry, isNew] = children_.try_emplace(value);
        std::vector<JsonIndex>& children = entry->second;
        if (isNew) children = document_.Children(value);
        if (*index < static_cast<double>(children.size())) next = children[static_cast<std::size_t>(*index)];
      }
      found = next != 0;
      if (found) value = next;
    }
    return {value, path};
  }

  Result<Scene> Finish() {
    std::stable_sort(diagnostics_.begin(), diagnostics_.end(), [](const Diagnostic& a, const Diagnostic& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    if (dropped_ > 0) {
      Diagnostic& rest = diagnostics_.emplace_back();
      rest.severity = Severity::Note;
      rest.place.file = scene_.name;
      rest.message = "and " + std::to_string(dropped_) + " more problems";
    }
    diagnostics_.insert(diagnostics_.end(), meshMessages_.begin(), meshMessages_.end());
    if (hasErrors_) return std::move(diagnostics_);
    return {std::move(scene_), std::move(diagnostics_)};
  }

  const JsonDocument& document_;
  Origins* origins_;
  Scene scene_;
  std::set<std::string> failed_;  ///< Canonical paths of values that are missing, unknown or wrong.
  std::map<JsonIndex, std::vector<JsonIndex>> children_;  ///< Of arrays that messages pointed into.
  Diagnostics diagnostics_, meshMessages_;
  bool hasErrors_ = false;
  std::size_t dropped_ = 0;  ///< Messages beyond those kept.
};

Result<Scene> ReadScene(const Result<JsonDocument>& document, const std::string& name, Origins* origins) {
  if (origins) origins->clear();
  if (!document) return document.diagnostics();
  return SceneReader(*document, origins).Read(name);
}

// The schema.

std::string Range(const Parameter& p) {
  std::string out;
  if (std::isfinite(p.min))
    out += (p.minExclusive ? ", \"exclusiveMinimum\": " : ", \"minimum\": ") + FormatNumber(p.min);
  if (std::isfinite(p.max)) out += ", \"maximum\": " + FormatNumber(p.max);
  return out;
}

std::string TypeSchema(const Parameter& p) {
  switch (p.kind) {
    case ValueKind::Number:
      return "\"type\": \"number\"" + Range(p);
    case ValueKind::Integer:
      return "\"type\": \"integer\"" + Range(p);
    case ValueKind::Boolean:
      return "\"type\": \"boolean\"";
    case ValueKind::Choice: {
      std::string out = "\"enum\": [";
      for (std::size_t k = 0; k < p.choices.size(); ++k) out += (k > 0 ? ", " : "") + Quote(p.choices[k]);
      return out + "]";
    }
    case ValueKind::Text:
      return std::string("\"type\": \"string\"") +
             (DefaultValue(p) == Value(std::string()) ? "" : ", \"minLength\": 1");
    case ValueKind::Vector:
      return "\"type\": \"array\", \"items\": {\"type\": \"number\"" + Range(p) + "}, \"minItems\": 3, \"maxItems\": 3";
    case ValueKind::GridPoints:
      break;
  }
  return "\"type\": \"array\", \"items\": {\"anyOf\": [{\"type\": \"array\", \"items\": {\"type\": \"integer\", "
         "\"minimum\": 0}, \"minItems\": 2, \"maxItems\": 2}, {\"type\": \"integer\", \"minimum\": 0}]}";
}

std::string GroupSchema(const ParameterGroup& group) {
  std::string properties, required;
  for (const Parameter& p : Parameters()) {
    if (p.group != group.name) continue;
    const std::string unit = p.unit.empty() ? "" : " [" + std::string(p.unit) + "]";
    properties += (properties.empty() ? "" : ",\n") + std::string("        ") + Quote(p.name) + ": {" + TypeSchema(p) +
                  ", \"title\": " + Quote(p.label) + ", \"description\": " + Quote(std::string(p.help) + unit) +
                  ", \"default\": " + FormatValue(DefaultValue(p)) + "}";
    if (p.required && group.name != "cloth") required += (required.empty() ? "" : ", ") + Quote(p.name);
  }
  return "    " + Quote(group.name) + ": {\n      \"type\": \"object\",\n      \"description\": " + Quote(group.help) +
         ",\n      \"properties\": {\n" + properties + "\n      },\n      \"required\": [" + required +
         "],\n      \"patternProperties\": {\"^_\": true},\n      \"additionalProperties\": false\n    }";
}

/// Cloths of the course state everything; those of fabric nothing: see IsRequired.
std::string ClassicClothSchema() {
  std::string required;
  for (const Parameter& p : Parameters()) {
    if (p.group == "cloth" && p.required) required += (required.empty() ? "" : ", ") + Quote(p.name);
  }
  return "  \"if\": {\"properties\": {\"simulation\": {\"properties\": {\"engine\": {\"const\": \"fabric\"}},\n"
         "         \"required\": [\"engine\"]}}, \"required\": [\"simulation\"]},\n"
         "  \"else\": {\"properties\": {\"cloth\": {\"anyOf\": [{\"type\": \"object\", \"required\": [" +
         required + "]},\n    {\"type\": \"array\", \"items\": {\"required\": [" + required + "]}}]}}},\n";
}

// The files that a scene names.

/// Calls visit(name, loaded) for each mesh and cache that has a name.
template <class Visit>
void ForEachFile(Scene& scene, Visit&& visit) {
  const auto visitMeshes = [&](auto& owners) {
    for (auto& owner : owners) {
      if (!owner.mesh.empty()) visit(owner.mesh, owner.loaded);
    }
  };
  visitMeshes(scene.cloths);
  visitMeshes(scene.colliders);
  for (ColliderSettings& collider : scene.colliders) {
    if (!collider.cache.empty()) visit(collider.cache, collider.loadedCache);
  }
}

/// Gives a file another name, and what was read of it along with it.
template <class Loaded>
void Rename(std::string& name, std::shared_ptr<const Loaded>& loaded, std::string to) {
  name = std::move(to);
  if (!loaded) return;
  Loaded renamed = *loaded;
  renamed.file = name;
  loaded = std::make_shared<const Loaded>(std::move(renamed));
}

std::optional<std::filesystem::path> AbsolutePath(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error).lexically_normal();
  if (error) return std::nullopt;
  return absolute;
}

/// The path that leads down from the folder to the file, or nothing where the file is not in it.
std::optional<std::filesystem::path> PathFrom(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const auto from = AbsolutePath(folder.empty() ? std::filesystem::path(".") : folder), to = AbsolutePath(file);
  if (!from || !to) return std::nullopt;
  const std::filesystem::path path = to->lexically_relative(*from);
  if (path.empty() || *path.begin() == "..") return std::nullopt;
  return path;
}

}  // namespace

Result<Scene> LoadScene(const std::filesystem::path& file, Origins* origins) {
  return ReadScene(JsonDocument::Load(file), file.string(), origins);
}

Result<Scene> ParseScene(const std::string& text, const std::string& name, Origins* origins) {
  return ReadScene(JsonDocument::Parse(text, name), name, origins);
}

std::filesystem::path MeshFile(const Scene& scene, const std::string& mesh) {
  return TextPath(scene.name).parent_path() / TextPath(mesh);
}

Status LoadMeshes(Scene& scene) {
  Diagnostics warnings;
  if (scene.simulation.engine != Engine::Fabric) return Ok();
  const auto readAll = [&](auto& owners) -> Status {
    for (auto& owner : owners) {
      if (!HasToRead(owner)) continue;
      const Status read = ReadMesh(scene, owner);
      if (!read) return read.diagnostics();
      warnings.insert(warnings.end(), read.diagnostics().begin(), read.diagnostics().end());
    }
    return Ok();
  };
  if (Status read = readAll(scene.cloths); !read) return read;
  if (Status read = readAll(scene.colliders); !read) return read;
  for (ColliderSettings& collider : scene.colliders) {
    if (!collider.loaded || !LacksCache(collider)) continue;
    const Status read = ReadCache(scene, collider);
    if (!read) return read.diagnostics();
    warnings.insert(warnings.end(), read.diagnostics().begin(), read.diagnostics().end());
  }
  return {std::monostate{}, std::move(warnings)};
}

Scene WithAbsolutePaths(Scene scene) {
  ForEachFile(scene, [&](std::string& name, auto& loaded) {
    if (const auto file = AbsolutePath(MeshFile(scene, name))) Rename(name, loaded, PathText(*file));
  });
  return scene;
}

Scene WithPortablePaths(Scene scene, const std::filesystem::path& project) {
  const std::filesystem::path own = TextPath(scene.name).parent_path();
  bool inProject = !project.empty();
  ForEachFile(scene, [&](const std::string& name, auto&) {
    inProject = inProject && PathFrom(project, MeshFile(scene, name)).has_value();
  });
  ForEachFile(scene, [&](std::string& name, auto& loaded) {
    if (!inProject && !TextPath(name).is_absolute()) return;
    const auto path = PathFrom(inProject ? project : own, MeshFile(scene, name));
    if (path) Rename(name, loaded, PathText(*path));
  });
  return scene;
}

std::string FormatScene(const Scene& scene) {
  std::vector<std::string_view> order;
  for (const ParameterGroup& group : ParameterGroups()) order.push_back(group.name);
  if (scene.planesFirst) {
    std::iter_swap(std::find(order.begin(), order.end(), "sphere"), std::find(order.begin(), order.end(), "plane"));
  }

  const auto formatObject = [&](std::string_view group, std::size_t index, const std::string& indent) {
    std::string out;
    for (const Parameter& parameter : Parameters()) {
      if (parameter.group != group || !IsHeeded(parameter, scene)) continue;
      out += (out.empty() ? "{\n" : ",\n") + indent + "  " + Quote(parameter.name) + ": " +
             FormatValue(parameter.get(scene, index));
    }
    return out + "\n" + indent + "}";
  };
  std::string out;
  for (const std::string_view name : order) {
    const std::size_t count = FindGroup(name)->count(scene);
    if (count == 0) continue;
    out += (out.empty() ? "{\n  " : ",\n  ") + Quote(name) + ": ";
    if (count == 1) {
      out += formatObject(name, 0, "  ");
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) out += (i == 0 ? "[\n    " : ",\n    ") + formatObject(name, i, "    ");
    out += "\n  ]";
  }
  return out + "\n}\n";
}

std::string SceneSchema() {
  std::string definitions, properties, required;
  for (const ParameterGroup& group : ParameterGroups()) {
    const std::string one = "{\"$ref\": \"#/$defs/" + std::string(group.name) + "\"}";
    const std::string least = group.required ? ", \"minItems\": 1" : "";
    definitions += (definitions.empty() ? "" : ",\n") + GroupSchema(group);
    properties +=
        (properties.empty() ? "" : ",\n") + std::string("    ") + Quote(group.name) + ": " +
        (group.isArray ? "{\"anyOf\": [" + one + ", {\"type\": \"array\", \"items\": " + one + least + "}]}" : one);
    if (group.required) required += (required.empty() ? "" : ", ") + Quote(group.name);
  }
  return "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"Percale scene\",\n"
         "  \"type\": \"object\",\n  \"properties\": {\n" +
         properties + "\n  },\n  \"required\": [" + required + "],\n" + ClassicClothSchema() +
         "  \"patternProperties\": {\"^_\": true},\n  \"additionalProperties\": false,\n  \"$defs\": {\n" +
         definitions + "\n  }\n}\n";
}

}  // namespace percale
