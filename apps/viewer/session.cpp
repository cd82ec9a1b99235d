#include "apps/viewer/session.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "apps/viewer/clock.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "render/shader_text.h"

namespace percale::viewer {
namespace {

/// Files are looked at this often [s]; a change shows after two looks.
constexpr double kLookPeriod = 0.1;
/// While running, states are logged this often [s].
constexpr double kStatePeriod = 0.1;

// A grip holds so much of the cloth's extent around it, but at least so many spacings of its grid.
constexpr double kGripShare = 0.06, kGripSpacings = 2.5;
// A ball, for a cloth of 1 m: its radius [m], its share of the cloths' mass, its speed [m/s]; and how many
// radii before the eye it starts, so that it does not fill the picture.
constexpr double kBallSize = 0.07, kBallMass = 0.1, kBallSpeed = 5, kBallStart = 6;
// A gust: its speed [m/s], how it pushes a cloth that faces it [m/s^2], how long it blows [s].
constexpr double kGustSpeed = 8, kGustPush = 30, kGustDuration = 0.8;

/// "/cloth/0/ks", or with kAll "/cloth/ks".
std::string Path(const Parameter& parameter, int index) {
  std::string path = "/" + std::string(parameter.group);
  if (FindGroup(parameter.group)->isArray && index != Session::kAll) path += "/" + std::to_string(index);
  return path + "/" + std::string(parameter.name);
}

std::string InputSource(const Parameter& parameter, int index) {
  return "input " + Path(parameter, index);
}
std::string InputSource(const ShaderParameter& parameter) {
  return "input " + parameter.name;
}

/// Of all settings at once.
LogLine SettingsLine(const Scene& scene) {
  return LogLine("settings").Config(scene);
}

/// One for each value that differs.
std::vector<LogLine> ValueLines(const Scene& before, const Scene& after) {
  std::vector<LogLine> lines;
  for (const auto& [parameter, index] : Differences(before, after)) {
    LogLine& line = lines.emplace_back("set");
    line.Text("path", Path(*parameter, static_cast<int>(index)));
    line.Json("value", FormatValue(parameter->get(after, index)));
  }
  return lines;
}

std::string FirstError(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics) {
    if (d.severity == Severity::Error) return d.message;
  }
  return {};
}

Diagnostic Refusal(std::string_view label, const std::string& why) {
  return MakeError(std::string(label) + ": " + why + "; the old value stays");
}

/// Of what is wrong with a file that is drawn with.
std::string DrawingSource(const std::string& file) {
  return "drawing: " + file;
}

/// Whether two scenes have the same values in all parameters of a group.
bool SameGroup(std::string_view group, const Scene& a, const Scene& b) {
  const std::vector<Difference> differences = Differences(a, b);
  return std::none_of(differences.begin(), differences.end(),
                      [&](const Difference& d) { return d.parameter->group == group; });
}

bool SameView(const OrbitCamera& a, const OrbitCamera& b) {
  return a.target() == b.target() && a.distance() == b.distance() && a.azimuth() == b.azimuth() &&
         a.elevation() == b.elevation();
}

/// Messages that concern the whole session are for the terminal as well.
bool GoesToTerminal(const std::string& source) {
  return source.rfind("settings", 0) != 0 && source.rfind("input ", 0) != 0 && source != "preset";
}

}  // namespace

Session::Session(const ViewerOptions& options, GlDevice& device, SessionLog log, std::function<void()> wake)
    : options_(options),
      device_(device),
      shaders_(device.shaders()),
      log_(std::move(log)),
      messages_([this](const std::string& source, const Diagnostic* diagnostic) {
        if (diagnostic && GoesToTerminal(source)) std::fputs(Format(*diagnostic).c_str(), stderr);
        if (!log_.enabled()) return;
        LogLine line(diagnostic ? "message" : "mended");
        line.Text("source", source);
        if (diagnostic) {
          line.Text("severity", SeverityName(diagnostic->severity)).Text("text", diagnostic->message);
          if (!diagnostic->place.file.empty()) line.Text("file", diagnostic->place.file);
          if (diagnostic->place.line > 0) line.Number("line", diagnostic->place.line);
          if (diagnostic->place.column > 0) line.Number("column", diagnostic->place.column);
        }
        log_.Write(line);
      }),
      scene_(options.scene),
      fileScene_(options.scene),
      sceneFile_(options.sceneFile),
      browsed_(options.sceneFile),
      sceneWatch_(options.sceneFile),
      background_(wake),
      wake_(wake),
      kept_(options.root / "shaders", options.keepUniforms),
      givenShader_(options.view.look.shader),
      givenUniforms_(options.view.uniforms),
      givenAreWhole_(options.wholeUniforms),
      simulation_(options.scene, {options.threads, log_.enabled(), options.historyBudget, std::move(wake)}) {
  view_ = options_.view;
  scene_.look = view_.look;
  cameraMoved_ = !SameView(view_.camera, OrbitCamera::ForScene(scene_));
  AdoptUniforms();
  simulation_.TakeSnapshot(snapshot_);
}

Session::~Session() = default;

// Time.

bool Session::running() const {
  return lastDone_ == lastSent_ ? snapshot_.running : wantsRunning_;
}

bool Session::looping() const {
  return lastDone_ == lastSent_ ? snapshot_.looping : wantsLooping_;
}

std::uint64_t Session::Send(Command command) {
  LogLine line = DescribeCommand(command);
  return Send(std::move(command), {std::move(line)});
}

std::uint64_t Session::Send(Command command, std::vector<LogLine> lines) {
  lastSent_ = simulation_.Send(std::move(command));
  for (LogLine& line : lines) log_.Write(line.Number("command", static_cast<double>(lastSent_)));
  return lastSent_;
}

void Session::Run(bool running) {
  wantsRunning_ = running;
  wantsLooping_ = false;
  Send({.kind = running ? Command::Kind::Run : Command::Kind::Pause});
}

void Session::TogglePause() {
  Run(!running() && !looping());
}

bool Session::StepOneFrame() {
  if (running() || looping()) return false;
  Send({.kind = Command::Kind::Step, .frames = 1});
  return true;
}

void Session::ResetCloth() {
  const std::uint64_t command = Send({.kind = Command::Kind::Reset, .undoable = true});
  undo_.Push({.label = "Reset", .command = command});
}

bool Session::Seek(int frame) {
  const HistoryInfo& history = snapshot_.history;
  if (frame < history.firstFrame || frame > history.lastFrame) return false;
  wantsRunning_ = wantsLooping_ = false;
  soughtFrame_ = frame;
  sought_ = Send({.kind = Command::Kind::Seek, .frame = frame});
  return true;
}

int Session::frame() const {
  return sought_ > lastDone_ && sought_ == lastSent_ ? soughtFrame_ : snapshot_.report.frame;
}

bool Session::StepBack() {
  return Seek(frame() - 1);
}

bool Session::StepForward() {
  return Seek(frame() + 1) || StepOneFrame();
}

bool Session::ToggleLoop() {
  if (looping()) {
    Run(false);
    return true;
  }
  if (snapshot_.history.budget == 0) return false;
  wantsRunning_ = false;
  wantsLooping_ = true;
  Send({.kind = Command::Kind::Loop});
  return true;
}

void Session::SetHistoryBudget(std::size_t bytes) {
  if (bytes == snapshot_.history.budget) return;
  toldFull_ = false;
  messages_.Set("history budget", {});
  Send({.kind = Command::Kind::Budget, .budget = bytes});
}

// Undo.

bool Session::Undo() {
  const Change* change = undo_.ToUndo();
  if (!change) return false;
  if (log_.enabled()) log_.Write(LogLine("undo").Text("label", change->label));
  undo_.Undone(Travel(*change, false));
  return true;
}

bool Session::Redo() {
  const Change* change = undo_.ToRedo();
  if (!change) return false;
  if (log_.enabled()) log_.Write(LogLine("redo").Text("label", change->label));
  undo_.Redone(Travel(*change, true));
  return true;
}

std::uint64_t Session::Travel(const Change& change, bool forth) {
  if (change.texture) {
    view_.textures[0] = forth ? change.textureAfter : change.textureBefore;
    LogTexture(0);
    return 0;
  }
  if (!change.shader.empty()) {
    ChooseValues(change.shader, forth ? change.valuesAfter : change.valuesBefore);
    return 0;
  }
  const Scene& from = forth ? change.before : change.after;
  const Scene& to = forth ? change.after : change.before;
  if (const std::optional<Effect> effect = EffectOf(from, to)) {
    Scene settings = WithChange(scene_, from, to);
    LogLine line = SettingsLine(settings);
    // With a state come its settings.
    AdoptSettings(std::move(settings), change.command == 0 ? *effect : Effect::View, {std::move(line)});
  }
  if (change.command == 0) return 0;
  wantsRunning_ = wantsLooping_ = false;
  return Send({.kind = Command::Kind::Restore, .undoable = true, .before = change.command});
}

// The hand.

void Session::Grip(int cloth, int vertex) {
  const ClothSettings& sheet = scene_.cloths[static_cast<std::size_t>(cloth)];
  const double spacing = std::max(sheet.width / (sheet.numWidthPoints - 1), sheet.height / (sheet.numHeightPoints - 1));
  Handle handle{.cloth = cloth, .vertex = vertex};
  handle.target = snapshot_.cloths[static_cast<std::size_t>(cloth)].positions[static_cast<std::size_t>(vertex)];
  handle.radius = std::max(kGripShare * std::max(sheet.width, sheet.height), kGripSpacings * spacing);
  handles_ = {handle};
  undo_.Push({.label = "Drag", .command = SendHandles(true)});
}

void Session::MoveGrip(const Vec3& target) {
  if (handles_.empty() || handles_[0].target == target) return;
  handles_[0].target = target;
  if (Check(handles_[0])) return;  // beyond the world
  SendHandles(false);
}

void Session::LetGo() {
  if (handles_.empty()) return;
  handles_.clear();
  Send({.kind = Command::Kind::Handles});
}

/// While time stands the cloth is put where the hand is, else it is drawn there.
std::uint64_t Session::SendHandles(bool undoable) {
  const Command::Kind kind = running() ? Command::Kind::Handles : Command::Kind::Place;
  return Send({.kind = kind, .undoable = undoable, .handles = handles_});
}

void Session::TogglePin(int cloth, int vertex) {
  const ClothSettings& sheet = scene_.cloths[static_cast<std::size_t>(cloth)];
  const GridPoint point{vertex % sheet.numWidthPoints, vertex / sheet.numWidthPoints};
  std::vector<GridPoint> pinned = sheet.pinned;
  if (std::erase(pinned, point) == 0) pinned.push_back(point);
  SetParameter(*FindParameter("cloth", "pinned"), cloth, pinned);
}

void Session::ShootBall(const Vec3& from, const Vec3& direction) {
  double extent = 0, mass = 0;
  for (const ClothSettings& cloth : scene_.cloths) {
    extent = std::max({extent, cloth.width, cloth.height});
    mass += cloth.width * cloth.height * cloth.density;
  }
  Ball ball;
  ball.radius = kBallSize * extent;
  ball.position = from + UnitOr(direction, {0, 0, -1}) * (kBallStart * ball.radius);
  ball.mass = mass > 0 ? kBallMass * mass : 1;
  ball.velocity = UnitOr(direction, {0, 0, -1}) * (kBallSpeed * std::sqrt(extent));
  if (Check(ball)) return;
  const std::uint64_t command = Send({.kind = Command::Kind::Ball, .undoable = true, .ball = ball});
  undo_.Push({.label = "Ball", .command = command});
}

void Session::BlowGust(const Vec3& direction) {
  double density = 0;
  for (const ClothSettings& cloth : scene_.cloths) density = std::max(density, cloth.density);
  Gust gust;
  gust.velocity = UnitOr(direction, {0, 0, -1}) * kGustSpeed;
  gust.drag = std::max({scene_.wind.drag, kGustPush * density / kGustSpeed, 0.01});
  gust.duration = kGustDuration;
  const std::uint64_t command = Send({.kind = Command::Kind::Gust, .undoable = true, .gust = gust});
  undo_.Push({.label = "Gust of wind", .command = command});
}

// Settings.

bool Session::SetParameter(const Parameter& parameter, int index, const Value& value) {
  if (const auto problem = CheckValue(parameter, value)) {
    Refuse(parameter, index, *problem);
    return false;
  }
  const ParameterGroup& group = *FindGroup(parameter.group);
  Scene changed = scene_;
  for (std::size_t i = 0; i < group.count(scene_); ++i) {
    if (!group.isArray || index == kAll || static_cast<std::size_t>(index) == i) parameter.set(changed, i, value);
  }
  const Status set = ChangeSettings(std::string(parameter.label), Path(parameter, index), std::move(changed));
  if (set)
    messages_.Set(InputSource(parameter, index), {});
  else
    Refuse(parameter, index, FirstError(set.diagnostics()));
  return set.ok();
}

Status Session::SetScene(const std::string& label, Scene settings) {
  return ChangeSettings(label, {}, std::move(settings));
}

void Session::Refuse(const Parameter& parameter, int index, const std::string& why) {
  messages_.Set(InputSource(parameter, index), {Refusal(parameter.label, why)});
}

Status Session::ChangeSettings(const std::string& label, const std::string& path, Scene settings) {
  const std::optional<Effect> effect = EffectOf(scene_, settings);
  if (!effect) return Ok();
  if (const Diagnostics checked = CheckScene(settings); HasErrors(checked)) return checked;
  const bool merges = undo_.Merges(path);
  // Of changes that are merged, the state before the first leads back.
  const bool undoable = effect == Effect::Rebuild && !merges;
  Change change{.label = label, .path = path, .before = scene_, .after = settings};
  std::vector<LogLine> lines = path.empty() ? std::vector{SettingsLine(settings)} : ValueLines(scene_, settings);
  const std::uint64_t command = AdoptSettings(std::move(settings), *effect, std::move(lines), undoable);
  if (undoable) change.command = command;
  if (merges)
    undo_.Extend(scene_);
  else
    undo_.Push(std::move(change));
  return Ok();
}

std::uint64_t Session::AdoptSettings(Scene settings, Effect effect, std::vector<LogLine> lines, bool undoable) {
  scene_ = std::move(settings);
  AdoptLook();
  std::uint64_t command = 0;
  if (effect == Effect::View) {
    for (const LogLine& line : lines) log_.Write(line);
  } else {
    command = SendSettings(std::move(lines), undoable);
  }
  CheckSettings();
  return command;
}

std::uint64_t Session::SendSettings(std::vector<LogLine> lines, bool undoable) {
  if (undoable) {
    for (LogLine& line : lines) line.Flag("undoable", true);
  }
  Command apply{.kind = Command::Kind::Apply, .undoable = undoable, .scene = std::make_unique<Scene>(scene_)};
  return lastApply_ = Send(std::move(apply), std::move(lines));
}

/// The settings that a state has brought along. What is seen stays as the user wants it.
void Session::FollowSettings(Scene settings) {
  settings.look = scene_.look;
  settings.camera = scene_.camera;
  if (!EffectOf(scene_, settings)) return;
  LogLine line = SettingsLine(settings);
  AdoptSettings(std::move(settings), Effect::View, {std::move(line)});
}

/// Warnings about the settings as they are now. Those that a slider has left behind are not kept.
void Session::CheckSettings() {
  messages_.Set("settings", CheckScene(scene_), true);
}

// View.

/// Draws as the scene's look says.
void Session::AdoptLook() {
  const bool other = view_.look.shader != scene_.look.shader;
  view_.look = scene_.look;
  if (!other) return;
  AdoptUniforms();
  if (log_.enabled()) log_.Write(LogLine("shader").Text("name", view_.look.shader));
  RefreshShaderMessages();
}

void Session::Orbit(double dx, double dy, int width, int height) {
  view_.camera.Orbit(dx, dy, width, height);
  cameraMoved_ = cameraUnlogged_ = true;
}
void Session::Pan(double dx, double dy, int width, int height) {
  view_.camera.Pan(dx, dy, width, height);
  cameraMoved_ = cameraUnlogged_ = true;
}
void Session::Dolly(double steps) {
  view_.camera.Dolly(steps);
  cameraMoved_ = cameraUnlogged_ = true;
}
void Session::ResetCamera() {
  view_.camera = OrbitCamera::ForScene(scene_);
  cameraMoved_ = false;
  cameraUnlogged_ = true;
}

void Session::SetShader(const std::string& name) {
  scene_.look.shader = name;
  AdoptLook();
}

void Session::CycleShader(int by) {
  const std::vector<std::string>& names = shaders_.names();
  const int count = static_cast<int>(names.size());
  if (count == 0) return;
  const auto found = std::find(names.begin(), names.end(), view_.look.shader);
  // From a shader that is no more, forwards leads to the first.
  const int at = found == names.end() ? (by > 0 ? -1 : 0) : static_cast<int>(found - names.begin());
  SetShader(names[static_cast<std::size_t>(((at + by) % count + count) % count)]);
}

void Session::ToggleWireframe() {
  view_.wireframe = !view_.wireframe;
  if (log_.enabled()) log_.Write(LogLine("wireframe").Flag("visible", view_.wireframe));
}

void Session::SetHeatMap(const HeatMapSettings& settings) {
  view_.heatMap = settings;
  if (!log_.enabled()) return;
  LogLine line("heat_map");
  line.Text("quantity", Describe(settings.quantity).name).Flag("fixed", settings.range.has_value());
  if (settings.range) line.Number("low", settings.range->low).Number("high", settings.range->high);
  log_.Write(line);
}

void Session::SetOverlays(const Overlays& overlays) {
  view_.overlays = overlays;
  if (!log_.enabled()) return;
  LogLine line("overlays");
  for (const OverlayInfo& overlay : AllOverlays()) line.Flag(overlay.name, overlays.*overlay.shown);
  log_.Write(line);
}

void Session::ExportPlots(std::span<const FrameRow> rows) {
  const Result<std::filesystem::path> file = ExportFrames(rows, sceneFile_);
  messages_.Set("export", file ? Diagnostics{} : file.diagnostics());
  if (file && log_.enabled()) log_.Write(LogLine("export").Text("file", PathText(*file)));
}

std::span<const ShaderParameter> Session::ShaderParameters() {
  return shaders_.Parameters(view_.look.shader);
}

UniformValue Session::Uniform(const ShaderParameter& parameter) const {
  return Chosen(parameter.name).value_or(parameter.defaultValue);
}

void Session::SetUniform(const ShaderParameter& parameter, const UniformValue& value) {
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
  ChooseValues(view_.look.shader, {{parameter.name, value}});
  messages_.Set(InputSource(parameter), {});
}

void Session::ResetUniforms() {
  const std::string& shader = view_.look.shader;
  if (log_.enabled()) log_.Write(LogLine("uniforms").Text("shader", shader));
  Change change{.label = "Defaults of " + shader, .shader = shader};
  UniformValues values = view_.uniforms;
  values.merge(UniformValues(kept_.Of(shader, shaders_.Parameters(shader))));
  for (const auto& [name, value] : values) {
    change.valuesBefore[name] = value;
    change.valuesAfter[name] = std::nullopt;
  }
  if (shader == givenShader_) givenShader_.clear();
  if (values.empty()) return;
  ChooseValues(shader, change.valuesAfter);
  undo_.Push(std::move(change));
}

/// What was chosen for a parameter of the current shader; nothing: its default.
std::optional<UniformValue> Session::Chosen(const std::string& uniform) const {
  const auto found = view_.uniforms.find(uniform);
  return found == view_.uniforms.end() ? std::nullopt : std::optional(found->second);
}

void Session::ChooseValues(const std::string& shader, const ShaderValues& values) {
  for (const auto& [name, value] : values) {
    kept_.Set(shader, name, value, Now());
    if (shader != view_.look.shader) continue;  // It will have them when it is chosen again.
    if (value)
      view_.uniforms[name] = *value;
    else
      view_.uniforms.erase(name);
    if (!log_.enabled()) continue;
    LogLine line("uniform");
    line.Text("shader", shader).Text("name", name);
    if (value) line.Vector("value", {(*value)[0], (*value)[1], (*value)[2]});
    log_.Write(line);
  }
}

/// The values of the current shader: what came with it before what is kept.
void Session::AdoptUniforms() {
  const std::string& shader = view_.look.shader;
  const UniformValues kept = kept_.Of(shader, shaders_.Parameters(shader));
  view_.uniforms = shader == givenShader_ ? givenUniforms_ : UniformValues();
  if (shader != givenShader_ || !givenAreWhole_) view_.uniforms.insert(kept.begin(), kept.end());
  messages_.Set("values of " + shader, kept_.Problems(shader));
}

Status Session::CreateShader(const std::string& name) {
  const Result<std::filesystem::path> file = percale::CreateShader(shaders_.folder(), name);
  if (!file) return file.diagnostics();
  shaders_.ReloadChanged();
  SetShader(name);
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(*file, error);
  messages_.Set("new shader",
                {MakeNote(PathText(error ? *file : whole.lexically_normal()),
                          "is the new shader: edit it in any editor; each time it is saved it shows here at once")});
  return Ok();
}

void Session::RefuseUniform(const ShaderParameter& parameter, const std::string& why) {
  messages_.Set(InputSource(parameter), {Refusal(parameter.label, why)});
}

/// What is wrong with the current shader, and with those that something was wrong with before.
void Session::RefreshShaderMessages() {
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

// Files.

bool Session::Load(const std::filesystem::path& file, const std::string& source, Scene& scene, bool& statesShader) {
  // Reading a pipe would wait for a writer, and the window with it.
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_other(status)) {
    messages_.Set(source, {MakeError(PathText(file), "expected a scene file, got a device or pipe")});
    return false;
  }
  Result<ViewFile> opened = OpenViewFile(file);
  Result<Scene> loaded = opened ? Result<Scene>(std::move(opened->scene), opened.diagnostics()) : opened.diagnostics();
  if (!loaded) {
    messages_.Set(source, loaded.diagnostics());
    return false;
  }
  statesShader = opened->view || opened->state || opened->origins.count("/look/shader") > 0;
  Diagnostics problems;
  if (file == options_.sceneFile) {
    // A checkpoint or a picture states all of its values.
    for (const Preset& preset : options_.presets) {
      if (!opened->view && !opened->state) ApplyBelow(preset, opened->origins, *loaded);
    }
    for (const std::string& assignment : options_.set) {
      const auto applied = ApplyAssignment(*loaded, assignment);
      if (applied) continue;
      for (Diagnostic d : applied.diagnostics()) {
        d.severity = Severity::Warning;  // The rest of the scene is good.
        problems.push_back(std::move(d));
      }
    }
  }
  const Diagnostics checked = CheckScene(*loaded);
  if (HasErrors(checked)) {
    messages_.Set(source, checked);
    return false;
  }
  // What CheckScene warns of is told as a property of the settings, which sliders can mend. The loader
  // names a value as the file does, so that the paths of the two may differ.
  const auto withoutPath = [](const Diagnostic& d) {
    return std::string_view(d.message).substr(std::min(d.message.find(": "), d.message.size()));
  };
  for (const Diagnostic& d : loaded.diagnostics()) {
    const bool isOfSettings = std::any_of(checked.begin(), checked.end(),
                                          [&](const Diagnostic& c) { return withoutPath(c) == withoutPath(d); });
    if (!isOfSettings) problems.push_back(d);
  }
  messages_.Set(source, problems);
  scene = std::move(*loaded);
  return true;
}

void Session::ReloadScene() {
  sceneWatch_.Accept();
  Scene loaded;
  bool statesShader = false;
  if (!Load(sceneFile_, "scene", loaded, statesShader)) return;
  // The file's values count, but what the user chose to see stays unless the file has changed it.
  const bool sameLook = SameGroup("look", loaded, fileScene_), sameCamera = SameGroup("camera", loaded, fileScene_);
  fileScene_ = loaded;
  if (sameLook) loaded.look = scene_.look;
  const Effect effect = EffectOf(scene_, loaded).value_or(Effect::View);
  LogLine line = LogLine("reload").Text("what", "scene").Text("file", PathText(sceneFile_)).Config(loaded);
  AdoptSettings(std::move(loaded), effect, {std::move(line)});
  if (!cameraMoved_ || !sameCamera) ResetCamera();
}

void Session::Reload() {
  ReloadScene();
  shaders_.Reload();
  if (log_.enabled()) log_.Write(LogLine("reload").Text("what", "shaders"));
  RefreshShaderMessages();
  ReloadTextures(device_.TextureFiles());
}

/// What is wrong with them is told with the next picture.
void Session::ReloadTextures(const std::vector<std::filesystem::path>& files) {
  // From before the reading on: what is saved meanwhile is seen at the next look.
  for (const std::filesystem::path& file : files) textureWatches_.insert_or_assign(file, FileWatch(file));
  for (const std::filesystem::path& file : device_.ReloadTextures(files)) {
    messages_.Set(DrawingSource(PathText(file)), {});
    if (log_.enabled()) log_.Write(LogLine("reload").Text("what", "texture").Text("file", PathText(file)));
  }
}

/// Reads again what has changed; returns whether anything has.
bool Session::LookAtTextures() {
  std::vector<std::filesystem::path> changed;
  for (const std::filesystem::path& file : device_.TextureFiles()) {
    if (textureWatches_.try_emplace(file, file).first->second.Changed()) changed.push_back(file);
  }
  ReloadTextures(changed);
  return !changed.empty();
}

bool Session::OpenScene(const std::filesystem::path& file) {
  browsed_ = file;
  Scene loaded;
  bool statesShader = false;
  if (!Load(file, "open", loaded, statesShader)) return false;
  const std::string shader = scene_.look.shader;
  sceneFile_ = file;
  sceneWatch_ = FileWatch(file);
  fileScene_ = loaded;
  scene_ = std::move(loaded);
  if (!statesShader) scene_.look.shader = shader;
  AdoptLook();
  messages_.Set("scene", {});
  Run(false);
  SendSettings({LogLine("open").Text("scene", PathText(file)).Config(scene_)});
  Send({.kind = Command::Kind::Reset});
  handles_.clear();
  undo_.Clear();
  ResetCamera();
  CheckSettings();
  return true;
}

std::vector<std::filesystem::path> Session::SceneFiles() const {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  const std::filesystem::path folder = browsed_.parent_path().empty() ? "." : browsed_.parent_path();
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".json") files.push_back(browsed_.parent_path() / entry->path().filename());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void Session::CycleScene(int by) {
  const std::vector<std::filesystem::path> files = SceneFiles();
  if (files.empty()) {
    const std::filesystem::path folder = browsed_.parent_path().empty() ? "." : browsed_.parent_path();
    messages_.Set("open", {MakeError(PathText(folder), "there is no scene file (*.json) in this folder")});
    return;
  }
  const int count = static_cast<int>(files.size());
  const auto found = std::lower_bound(files.begin(), files.end(), browsed_);
  int at = static_cast<int>(found - files.begin());
  // From a file that is no more, forwards leads to the one that stands in its place.
  if ((found == files.end() || *found != browsed_) && by > 0) --at;
  OpenScene(files[static_cast<std::size_t>(((at + by) % count + count) % count)]);
}

// What comes by itself.

bool Session::Update(double now) {
  bool news = false;
  if (simulation_.TakeSnapshot(snapshot_)) {
    ReadSnapshot(now);
    news = true;
  } else if (stateUnlogged_ && now >= lastState_ + kStatePeriod) {
    LogState(now);
  }
  news |= ReadReports(background_.TakeReports());
  news |= ReadFilm();
  kept_.WriteDue(now);
  if (const std::string failure = simulation_.TakeFailure(); !failure.empty()) {
    messages_.Set("simulation", {MakeError(failure + "; open another scene file to go on, or close the viewer")});
    news = true;
  }
  if (now >= nextLook_) {
    if (nextLook_ == 0) {  // The first look, when the log has its first line.
      CheckSettings();
      RefreshShaderMessages();
      if (options_.state) SendState(sceneFile_, options_.state, false);
      if (options_.state && !options_.set.empty()) SendSettings({SettingsLine(scene_)});
      if (!options_.state) SendFrames(options_.frame);
    }
    nextLook_ = now + kLookPeriod;
    if (shaders_.ReloadChanged()) {
      if (log_.enabled()) log_.Write(LogLine("reload").Text("what", "shaders"));
      RefreshShaderMessages();
      news = true;
    }
    if (kept_.Changed(view_.look.shader)) {
      AdoptUniforms();
      if (log_.enabled()) log_.Write(LogLine("reload").Text("what", "uniforms"));
      news = true;
    }
    news |= LookAtTextures();
    if (sceneWatch_.Changed()) {
      ReloadScene();
      news = true;
    }
  }
  if (cameraUnlogged_) {
    const OrbitCamera& camera = view_.camera;
    if (log_.enabled()) {
      log_.Write(LogLine("camera")
                     .Number("azimuth", camera.azimuth())
                     .Number("elevation", camera.elevation())
                     .Number("distance", camera.distance())
                     .Vector("target", camera.target()));
    }
    cameraUnlogged_ = false;
  }
  return news;
}

void Session::ReadSnapshot(double now) {
  for (const Executed& done : snapshot_.executed) {
    lastDone_ = std::max(lastDone_, done.command);
    if (log_.enabled()) {
      log_.Write(LogLine("done")
                     .Number("command", static_cast<double>(done.command))
                     .Number("at", done.at)
                     .Number("frame", done.frame)
                     .Hash("hash", done.hash)
                     .Flag("kept", done.stateKept));
    }
    if (done.scene && done.command > lastApply_) FollowSettings(*done.scene);
    if (done.state) KeepState(done.command, done.state);
    if (!done.failure.empty()) {
      messages_.Set("history", {MakeError(done.failure)});
      SendSettings({SettingsLine(scene_)});  // Those that the panels show.
    } else if (done.state || done.scene) {
      messages_.Set("history", {});
    }
  }
  for (const StepReport& report : snapshot_.reports) frames_.Add(report);
  Diagnostics problems;
  if (const auto& divergence = snapshot_.report.divergence) {
    const std::string where = snapshot_.cloths.size() > 1 ? " of cloth " + std::to_string(divergence->cloth) : "";
    problems.push_back(MakeError("the simulation blew up at step " + std::to_string(divergence->step) + ", vertex " +
                                 std::to_string(divergence->vertex) + where + ": " + divergence->cause + "; " +
                                 divergence->remedy + "; then press R"));
  }
  messages_.Set("divergence", problems);
  if (snapshot_.history.full && !toldFull_) {
    toldFull_ = true;
    messages_.Set("history budget",
                  {MakeNote("the history has filled the memory it may take: from now on the oldest frames go")});
  }
  stateUnlogged_ = true;
  if (!snapshot_.executed.empty() || now >= lastState_ + kStatePeriod) LogState(now);
}

void Session::LogState(double now) {
  lastState_ = now;
  stateUnlogged_ = false;
  if (!log_.enabled()) return;
  double lowest = snapshot_.cloths.empty() ? 0 : snapshot_.cloths[0].positions[0].y;
  for (const ClothCopy& cloth : snapshot_.cloths) {
    for (const Vec3& p : cloth.positions) lowest = std::min(lowest, p.y);
  }
  const StepReport& report = snapshot_.report;
  log_.Write(LogLine("state")
                 .Number("frame", report.frame)
                 .Number("step", static_cast<double>(report.step))
                 .Number("time", report.time)
                 .Flag("running", snapshot_.running)
                 .Hash("hash", snapshot_.hash)
                 .Number("lowest", lowest)
                 .Number("stretch", report.greatestStretch)
                 .Number("energy", report.kineticEnergy)
                 .Flag("rest", report.atRest)
                 .Number("ms", snapshot_.frameSeconds * 1000)
                 .Number("drawn", static_cast<double>(pictures_)));
}

std::string Session::Title() const {
  return PathText(sceneFile_.filename()) + " - Percale" + (running() ? "" : " (paused)");
}

void Session::ReportDrawing(const Status& drawn, const Diagnostics& warnings) {
  // The shader's own problems are told already.
  const bool told = messages_.Holds("shader " + view_.look.shader);
  messages_.Set("drawing", drawn || told ? Diagnostics{} : drawn.diagnostics());
  for (const Diagnostic& warning : warnings) messages_.Add(DrawingSource(warning.place.file), warning);
}

}  // namespace percale::viewer
