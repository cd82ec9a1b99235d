#include "render/view_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base64.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"
#include "percale/checkpoint_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr const char *kScene = "percale:scene", *kView = "percale:view", *kFrame = "percale:frame",
                     *kState = "percale:state";
constexpr double kMostFrames = 1e8;

std::string FormatView(const View& view) {
  std::string text = "{\"version\":" + std::to_string(kVersion) +
                     ",\"wireframe\":" + (view.wireframe ? "true" : "false") + ",\"sphere\":[" +
                     std::to_string(view.sphereLatitudes) + "," + std::to_string(view.sphereLongitudes) +
                     "],\"heat_map\":{\"quantity\":" + Quote(Describe(view.heatMap.quantity).name);
  if (const auto& range = view.heatMap.range)
    text += ",\"range\":[" + FormatNumber(range->low) + "," + FormatNumber(range->high) + "]";
  text += "},\"overlays\":[";
  for (const OverlayInfo& overlay : AllOverlays()) {
    if (view.overlays.*overlay.shown) text += (text.back() == '[' ? "" : ",") + Quote(overlay.name);
  }
  text += "],\"uniforms\":{";
  const char* comma = "";
  for (const auto& [name, value] : view.uniforms) {
    text += comma + Quote(name) + ":[";
    for (std::size_t i = 0; i < value.size(); ++i) text += (i ? "," : "") + FormatNumber(double(value[i]));
    text += "]";
    comma = ",";
  }
  text += "},\"textures\":[";
  for (std::size_t i = 0; i < view.textures.size(); ++i) text += (i ? "," : "") + Quote(PathText(view.textures[i]));
  return text + "]}";
}

bool ReadHeatMap(const JsonDocument& doc, JsonIndex object, HeatMapSettings& heatMap) {
  const JsonIndex quantity = doc.Member(object, "quantity"), range = doc.Member(object, "range");
  if (object == 0 || quantity == 0 || doc.Kind(quantity) != JsonKind::Text) return false;
  int known = 0;
  while (known < kQuantities && Describe(static_cast<Quantity>(known)).name != doc.Text(quantity)) ++known;
  if (known == kQuantities) return false;
  heatMap.quantity = static_cast<Quantity>(known);
  if (range == 0) return true;
  const std::vector<JsonIndex> ends = doc.Children(range);
  for (const JsonIndex end : ends) {
    if (doc.Kind(end) != JsonKind::Number) return false;
  }
  if (ends.size() != 2 || !(doc.Number(ends[0]) < doc.Number(ends[1]))) return false;
  heatMap.range = ValueRange{doc.Number(ends[0]), doc.Number(ends[1])};
  return true;
}

/// Reads what FormatView has written into the view. Returns what is wrong, or nothing.
std::string ReadView(const std::string& text, const std::string& name, View& view) {
  const Result<JsonDocument> parsed = JsonDocument::Parse(text, name);
  if (!parsed) return "its " + std::string(kView) + " is damaged: " + parsed.diagnostics().front().message;
  const JsonDocument& doc = *parsed;
  const std::string damaged = "its " + std::string(kView) + " is damaged";
  const auto isNumber = [&](JsonIndex i) { return doc.Kind(i) == JsonKind::Number; };
  const JsonIndex version = doc.Member(0, "version");
  if (version == 0 || !isNumber(version)) return damaged;
  if (doc.Number(version) != kVersion) {
    return "it is a picture of version " + doc.Source(version) + ", and this program reads version " +
           std::to_string(kVersion) + "; open it with the version of Percale that wrote it";
  }
  const JsonIndex wireframe = doc.Member(0, "wireframe");
  const std::vector<JsonIndex> sphere = doc.Children(doc.Member(0, "sphere"));
  const std::vector<JsonIndex> textures = doc.Children(doc.Member(0, "textures"));
  const JsonIndex uniforms = doc.Member(0, "uniforms");
  if (wireframe == 0 || doc.Kind(wireframe) != JsonKind::Boolean || sphere.size() != 2 ||
      textures.size() != view.textures.size() || uniforms == 0)
    return damaged;
  view.wireframe = doc.Boolean(wireframe);
  if (!ReadHeatMap(doc, doc.Member(0, "heat_map"), view.heatMap)) return damaged;
  for (const JsonIndex shown : doc.Children(doc.Member(0, "overlays"))) {
    const auto overlays = AllOverlays();
    const auto found = std::find_if(overlays.begin(), overlays.end(), [&](const OverlayInfo& overlay) {
      return doc.Kind(shown) == JsonKind::Text && overlay.name == doc.Text(shown);
    });
    if (found == overlays.end()) return damaged;
    view.overlays.*found->shown = true;
  }
  for (const JsonIndex i : sphere) {
    if (!isNumber(i) || !(doc.Number(i) >= 3 && doc.Number(i) <= 4096)) return damaged;
  }
  view.sphereLatitudes = static_cast<int>(doc.Number(sphere[0]));
  view.sphereLongitudes = static_cast<int>(doc.Number(sphere[1]));
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (doc.Kind(textures[i]) != JsonKind::Text) return damaged;
    view.textures[i] = TextPath(doc.Text(textures[i]));
  }
  for (const JsonIndex uniform : doc.Children(uniforms)) {
    const std::vector<JsonIndex> numbers = doc.Children(uniform);
    UniformValue value{};
    if (numbers.size() != value.size()) return damaged;
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!isNumber(numbers[i])) return damaged;
      value[i] = static_cast<float>(doc.Number(numbers[i]));
    }
    view.uniforms[doc.Key(uniform)] = value;
  }
  return {};
}

/// Whether two scenes are the same but for what is seen of them.
bool SameButLook(Scene a, const Scene& b) {
  a.look = b.look;
  a.camera = b.camera;
  return FormatScene(a) == FormatScene(b);
}

/// The names of meshes and caches in the text of a scene.
std::vector<std::string> NamedFiles(const JsonDocument& doc) {
  std::vector<std::string> files;
  for (const char* group : {"cloth", "collider"}) {
    const JsonIndex member = doc.Member(0, group);
    if (member == 0) continue;
    const bool several = doc.Kind(member) == JsonKind::Array;
    for (const JsonIndex object : several ? doc.Children(member) : std::vector<JsonIndex>{member}) {
      for (const char* key : {"mesh", "cache"}) {
        const JsonIndex name = doc.Member(object, key);
        if (name != 0 && doc.Kind(name) == JsonKind::Text && !doc.Text(name).empty()) files.push_back(doc.Text(name));
      }
    }
  }
  return files;
}

/// The first folder from which the names of all files lead to one. `name`: of the picture, for the message where none
/// is.
Result<fs::path> FolderOfFiles(const std::string& sceneText, const std::vector<fs::path>& folders,
                               const std::string& name) {
  const Result<JsonDocument> doc = JsonDocument::Parse(sceneText, name + " (its scene)");
  if (!doc) return doc.diagnostics();
  const std::vector<std::string> files = NamedFiles(*doc);
  const auto missing = [&](const fs::path& folder) {
    return std::find_if(files.begin(), files.end(), [&](const std::string& file) {
      std::error_code error;
      return !fs::exists(folder / TextPath(file), error);
    });
  };
  for (const fs::path& folder : folders) {
    if (missing(folder) == files.end()) return folder;
  }
  std::string places;
  for (const fs::path& folder : folders)
    places += (places.empty() ? "" : ", ") + (folder.empty() ? std::string(".") : PathText(folder));
  return MakeError(name, "its scene needs the file " + Quote(*missing(folders.back()), 200) +
                             ", which was looked for from these folders: " + places +
                             "; put the picture beside the scene that it shows, or start from that folder");
}

}  // namespace

Result<ViewFile> OpenViewFile(const fs::path& file, const fs::path& project) {
  const std::string ending = LowerExtension(file);
  if (ending == ".percale") {
    Result<WorldState> state = LoadCheckpoint(file);
    if (!state) return state.diagnostics();
    ViewFile opened;
    opened.scene = *state->scene;
    opened.state = std::make_shared<const WorldState>(std::move(*state));
    return opened;
  }
  if (ending == ".png") {
    Result<std::optional<ViewFile>> picture = ReadPictureView(file, project);
    if (!picture) return picture.diagnostics();
    if (*picture) return std::move(**picture);
    return MakeError(PathText(file),
                     "this picture does not tell what it shows; percale shot and F12 of the viewer make such that do");
  }
  ViewFile opened;
  Result<Scene> scene = LoadScene(file, &opened.origins);
  if (!scene) return scene.diagnostics();
  opened.scene = std::move(*scene);
  return {std::move(opened), scene.diagnostics()};
}

std::vector<PngText> DescribePicture(const Scene& scene, const View& view, int frame, const WorldState* state,
                                     const fs::path& project) {
  Scene seen = scene;
  seen.look = view.look;
  seen.camera = view.camera.Settings();
  std::vector<PngText> texts = {{kScene, FormatScene(WithPortablePaths(std::move(seen), project))},
                                {kView, FormatView(view)},
                                {kFrame, std::to_string(frame)}};
  // Texts of a PNG hold no zeros. The file compresses base64 back to the size of the bytes.
  if (state && state->Bytes() <= kMostStateInPicture) {
    const std::string ofState = FormatScene(WithPortablePaths(*state->scene, project));
    texts.push_back({kState, ToBase64(FormatCheckpoint(*state, ofState))});
  }
  return texts;
}

Result<std::optional<ViewFile>> ReadPictureView(const fs::path& file, const fs::path& project) {
  const std::string name = PathText(file);
  std::vector<PngText> texts;
  const Result<Image> image = ReadPng(file, &texts);
  if (!image) return image.diagnostics();
  const auto find = [&](std::string_view keyword) -> const std::string* {
    for (const PngText& text : texts) {
      if (text.keyword == keyword) return &text.text;
    }
    return nullptr;
  };
  const std::string *sceneText = find(kScene), *viewText = find(kView), *frameText = find(kFrame),
                    *stateText = find(kState);
  if (!sceneText && !viewText && !stateText) return std::optional<ViewFile>();
  const auto fail = [&](const std::string& why) { return MakeError(name, why); };
  if (!sceneText || !viewText || !frameText)
    return fail("the picture has lost some of its texts (percale:scene, percale:view, percale:frame)");

  ViewFile opened;
  View view;
  if (const std::string problem = ReadView(*viewText, name, view); !problem.empty()) return fail(problem);
  std::vector<fs::path> folders = {file.parent_path(), "."};
  if (!project.empty()) folders.push_back(project);
  const Result<fs::path> folder = FolderOfFiles(*sceneText, folders, name);
  if (!folder) return folder.diagnostics();
  // As if the picture lay in the folder where its files are.
  const std::string placed = PathText(*folder / file.filename());
  Result<Scene> scene = ParseScene(*sceneText, placed + " (its scene)");
  if (!scene) return scene.diagnostics();
  opened.scene = WithAbsolutePaths(std::move(*scene));
  const View seen = View::ForScene(opened.scene);
  view.look = seen.look;
  view.camera = seen.camera;
  opened.view = std::move(view);
  opened.width = image->width, opened.height = image->height;
  const std::optional<double> frame = ParseNumber(*frameText);
  if (!frame || !(*frame >= 0 && *frame <= kMostFrames && *frame == std::floor(*frame)))
    return fail("its percale:frame is damaged: expected a whole number >= 0, got " + Quote(*frameText, 40));
  opened.frame = static_cast<int>(*frame);
  if (stateText) {
    const std::optional<std::string> bytes = FromBase64(*stateText);
    if (!bytes) return fail("its percale:state is damaged: expected base64");
    Result<WorldState> state = ParseCheckpoint(*bytes, placed + " (its state)");
    if (!state) return state.diagnostics();
    state->scene = std::make_shared<const Scene>(WithAbsolutePaths(*state->scene));
    if (!SameButLook(*state->scene, opened.scene) || state->report.frame != opened.frame)
      return fail("its texts have been changed: its state is not one of its scene at its frame");
    opened.state = std::make_shared<const WorldState>(std::move(*state));
  }
  return std::optional<ViewFile>(std::move(opened));
}

}  // namespace percale
