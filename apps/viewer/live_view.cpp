#include "apps/viewer/live_view.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "apps/viewer/clock.h"
#include "io/atomic_file.h"
#include "render/shader_text.h"

namespace percale::viewer {
namespace {

std::string InputSource(const ShaderParameter& parameter) {
  return "input " + parameter.name;
}

/// Of what is wrong with a file that is drawn with.
std::string DrawingSource(const std::string& file) {
  return "drawing: " + file;
}

bool SameView(const OrbitCamera& a, const OrbitCamera& b) {
  return a.target() == b.target() && a.distance() == b.distance() && a.azimuth() == b.azimuth() &&
         a.elevation() == b.elevation();
}

}  // namespace

LiveView::LiveView(const ViewerOptions& options, GlDevice& device, SessionLog& log, Messages& messages, UndoStack& undo)
    : device_(device),
      shaders_(device.shaders()),
      log_(log),
      messages_(messages),
      undo_(undo),
      view_(options.view),
      cameraMoved_(!SameView(options.view.camera, OrbitCamera::ForScene(options.scene))),
      kept_(options.root / "shaders", options.keepUniforms),
      givenShader_(options.view.look.shader),
      givenUniforms_(options.view.uniforms),
      givenAreWhole_(options.wholeUniforms) {
  AdoptUniforms();
}

void LiveView::Show(View view) {
  givenShader_ = view.look.shader;
  givenUniforms_ = view.uniforms;
  givenAreWhole_ = true;
  view.look = view_.look;
  view_ = std::move(view);
  AdoptUniforms();
  log_.Write(LogLine("wireframe").Flag("visible", view_.wireframe));
}

// The camera.

void LiveView::Orbit(double dx, double dy, int width, int height) {
  view_.camera.Orbit(dx, dy, width, height);
  cameraMoved_ = cameraUnlogged_ = true;
}
void LiveView::Pan(double dx, double dy, int width, int height) {
  view_.camera.Pan(dx, dy, width, height);
  cameraMoved_ = cameraUnlogged_ = true;
}
void LiveView::Dolly(double steps) {
  view_.camera.Dolly(steps);
  cameraMoved_ = cameraUnlogged_ = true;
}
void LiveView::ResetCamera(const Scene& scene) {
  view_.camera = OrbitCamera::ForScene(scene);
  cameraMoved_ = false;
  cameraUnlogged_ = true;
}

// The look.

void LiveView::SetLook(const LookSettings& look) {
  const bool other = view_.look.shader != look.shader;
  view_.look = look;
  if (!other) return;
  AdoptUniforms();
  log_.Write(LogLine("shader").Text("name", view_.look.shader));
  TellProblems();
}

void LiveView::ToggleWireframe() {
  view_.wireframe = !view_.wireframe;
  log_.Write(LogLine("wireframe").Flag("visible", view_.wireframe));
}

void LiveView::SetHeatMap(const HeatMapSettings& settings) {
  view_.heatMap = settings;
  LogLine line("heat_map");
  line.Text("quantity", Describe(settings.quantity).name).Flag("fixed", settings.range.has_value());
  if (settings.range) line.Number("low", settings.range->low).Number("high", settings.range->high);
  log_.Write(line);
}

void LiveView::SetOverlays(const Overlays& overlays) {
  view_.overlays = overlays;
  LogLine line("overlays");
  for (const OverlayInfo& overlay : AllOverlays()) line.Flag(overlay.name, overlays.*overlay.shown);
  log_.Write(line);
}

void LiveView::SetTexture(std::size_t number, const std::filesystem::path& file) {
  std::filesystem::path& texture = view_.textures[number];
  undo_.Push({.label = "Texture", .texture = true, .textureBefore = texture, .textureAfter = file});
  texture = file;
  const std::string unused = UsesTexture(number) ? "" : ", which " + view_.look.shader + " does not use";
  messages_.Set("texture", {MakeNote(PathText(file), "is the shaders' texture " + std::to_string(number + 1) + unused +
                                                         "; Ctrl+Z takes it back")});
  LogTexture(number);
}

/// Whether the current shader draws with it.
bool LiveView::UsesTexture(std::size_t number) {
  const ShaderProgram* program = shaders_.Find(view_.look.shader);
  return program && program->Location("u_texture_" + std::to_string(number + 1)) >= 0;
}

void LiveView::LogTexture(std::size_t number) {
  log_.Write(LogLine("texture")
                 .Number("number", static_cast<double>(number + 1))
                 .Text("file", PathText(view_.textures[number])));
}

std::string LiveView::NextShader(int by) const {
  const std::vector<std::string>& names = shaders_.names();
  const int count = static_cast<int>(names.size());
  if (count == 0) return {};
  const auto found = std::find(names.begin(), names.end(), view_.look.shader);
  // From a shader that is no more, forwards leads to the first.
  const int at = found == names.end() ? (by > 0 ? -1 : 0) : static_cast<int>(found - names.begin());
  return names[static_cast<std::size_t>(((at + by) % count + count) % count)];
}

Status LiveView::CreateShader(const std::string& name) {
  const Result<std::filesystem::path> file = percale::CreateShader(shaders_.folder(), name);
  if (!file) return file.diagnostics();
  shaders_.ReloadChanged();
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(*file, error);
  messages_.Set("new shader",
                {MakeNote(PathText(error ? *file : whole.lexically_normal()),
                          "is the new shader: edit it in any editor; each time it is saved it shows here at once")});
  return Ok();
}

// The values of the shaders' parameters.

std::span<const ShaderParameter> LiveView::ShaderParameters() {
  return shaders_.Parameters(view_.look.shader);
}

UniformValue LiveView::Uniform(const ShaderParameter& parameter) const {
  return Chosen(parameter.name).value_or(parameter.defaultValue);
}

void LiveView::SetUniform(const ShaderParameter& parameter, const UniformValue& value) {
  const std::string path = InputSource(parameter) + " of " + view_.look.shader;
  if (undo_.Merges(path)) {
    undo_.Extend({{parameter.name, value}});
  } else {
    undo_.Push({.label = parameter.label,
                .path = path,
                .shader = view_.look.shader,
                .valuesBefore = {{parameter.name, Chosen(parameter.name)}},
                .valuesAfter = {{parameter.name, value}}});
  }
  Choose(view_.look.shader, {{parameter.name, value}});
  messages_.Set(InputSource(parameter), {});
}

void LiveView::RefuseUniform(const ShaderParameter& parameter, const std::string& why) {
  messages_.Set(InputSource(parameter), {MakeRefusal(parameter.label, why)});
}

void LiveView::ResetUniforms() {
  const std::string& shader = view_.look.shader;
  log_.Write(LogLine("uniforms").Text("shader", shader));
  Change change{.label = "Defaults of " + shader, .shader = shader};
  UniformValues values = view_.uniforms;
  values.merge(UniformValues(kept_.Of(shader, shaders_.Parameters(shader))));
  for (const auto& [name, value] : values) {
    change.valuesBefore[name] = value;
    change.valuesAfter[name] = std::nullopt;
  }
  if (shader == givenShader_) givenShader_.clear();
  if (values.empty()) return;
  Choose(shader, change.valuesAfter);
  undo_.Push(std::move(change));
}

/// What was chosen for a parameter of the current shader; nothing: its default.
std::optional<UniformValue> LiveView::Chosen(const std::string& uniform) const {
  const auto found = view_.uniforms.find(uniform);
  return found == view_.uniforms.end() ? std::nullopt : std::optional(found->second);
}

void LiveView::Choose(const std::string& shader, const ShaderValues& values) {
  for (const auto& [name, value] : values) {
    kept_.Set(shader, name, value, Now());
    if (shader != view_.look.shader) continue;  // It will have them when it is chosen again.
    if (value)
      view_.uniforms[name] = *value;
    else
      view_.uniforms.erase(name);
    LogLine line("uniform");
    line.Text("shader", shader).Text("name", name);
    if (value) line.Vector("value", {(*value)[0], (*value)[1], (*value)[2]});
    log_.Write(line);
  }
}

/// The values of the current shader: what came with it before what is kept.
void LiveView::AdoptUniforms() {
  const std::string& shader = view_.look.shader;
  const UniformValues kept = kept_.Of(shader, shaders_.Parameters(shader));
  view_.uniforms = shader == givenShader_ ? givenUniforms_ : UniformValues();
  if (shader != givenShader_ || !givenAreWhole_) view_.uniforms.insert(kept.begin(), kept.end());
  messages_.Set("values of " + shader, kept_.Problems(shader));
}

bool LiveView::Travel(const Change& change, bool forth) {
  if (change.texture) {
    view_.textures[0] = forth ? change.textureAfter : change.textureBefore;
    LogTexture(0);
    return true;
  }
  if (change.shader.empty()) return false;
  Choose(change.shader, forth ? change.valuesAfter : change.valuesBefore);
  return true;
}

// What comes by itself.

void LiveView::Update(double now) {
  kept_.WriteDue(now);
  if (!std::exchange(cameraUnlogged_, false)) return;
  const OrbitCamera& camera = view_.camera;
  log_.Write(LogLine("camera")
                 .Number("azimuth", camera.azimuth())
                 .Number("elevation", camera.elevation())
                 .Number("distance", camera.distance())
                 .Vector("target", camera.target()));
}

bool LiveView::LookAtFiles() {
  bool news = shaders_.ReloadChanged();
  if (news) {
    log_.Write(LogLine("reload").Text("what", "shaders"));
    TellProblems();
  }
  if (kept_.Changed(view_.look.shader)) {
    AdoptUniforms();
    log_.Write(LogLine("reload").Text("what", "uniforms"));
    news = true;
  }
  return LookAtTextures() || news;
}

/// Reads again what has changed; returns whether anything has.
bool LiveView::LookAtTextures() {
  std::vector<std::filesystem::path> changed;
  for (const std::filesystem::path& file : device_.TextureFiles()) {
    if (textureWatches_.try_emplace(file, file).first->second.Changed()) changed.push_back(file);
  }
  ReloadTextures(changed);
  return !changed.empty();
}

/// What is wrong with them is told with the next picture.
void LiveView::ReloadTextures(const std::vector<std::filesystem::path>& files) {
  // From before the reading on: what is saved meanwhile is seen at the next look.
  for (const std::filesystem::path& file : files) textureWatches_.insert_or_assign(file, FileWatch(file));
  for (const std::filesystem::path& file : device_.ReloadTextures(files)) {
    messages_.Set(DrawingSource(PathText(file)), {});
    log_.Write(LogLine("reload").Text("what", "texture").Text("file", PathText(file)));
  }
}

void LiveView::Reload() {
  shaders_.Reload();
  log_.Write(LogLine("reload").Text("what", "shaders"));
  TellProblems();
  ReloadTextures(device_.TextureFiles());
}

void LiveView::TellProblems() {
  reportedShaders_.insert(view_.look.shader);
  for (auto name = reportedShaders_.begin(); name != reportedShaders_.end();) {
    const std::vector<std::string>& known = shaders_.names();
    const bool isCurrent = *name == view_.look.shader;
    const bool exists = std::find(known.begin(), known.end(), *name) != known.end();
    const Diagnostics problems = isCurrent || exists ? shaders_.Problems(*name) : Diagnostics{};
    messages_.Set("shader " + *name, problems);
    if (problems.empty())
      name = reportedShaders_.erase(name);
    else
      ++name;
  }
}

void LiveView::TellDrawing(const Status& drawn, const Diagnostics& warnings) {
  // The shader's own problems are told already.
  const bool told = messages_.Holds("shader " + view_.look.shader);
  messages_.Set("drawing", drawn || told ? Diagnostics{} : drawn.diagnostics());
  for (const Diagnostic& warning : warnings) messages_.Add(DrawingSource(warning.place.file), warning);
}

}  // namespace percale::viewer
