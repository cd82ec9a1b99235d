#include "apps/viewer/session.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "apps/viewer/hand_tools.h"
#include "io/atomic_file.h"
#include "mesh/cloth_model.h"

namespace percale::viewer {
namespace {

/// Files are looked at this often [s]; a change shows after two looks.
constexpr double kLookPeriod = 0.1;
/// While running, states are logged this often [s].
constexpr double kStatePeriod = 0.1;

std::string InputSource(const Parameter& parameter, int index) {
  return "input " + ValuePath(parameter, index);
}

std::string FirstError(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics) {
    if (d.severity == Severity::Error) return d.message;
  }
  return {};
}

/// Messages that concern the whole session are for the terminal as well.
bool GoesToTerminal(const std::string& source) {
  return source.rfind("settings", 0) != 0 && source.rfind("input ", 0) != 0 && source != "preset";
}

}  // namespace

Session::Session(const ViewerOptions& options, GlDevice& device, SessionLog log, std::function<void()> wake)
    : options_(options),
      log_(std::move(log)),
      messages_([this](const std::string& source, const Diagnostic* diagnostic) { Tell(source, diagnostic); }),
      scene_(options.scene),
      source_(options_),
      liveView_(options_, device, log_, messages_, undo_),
      background_(wake),
      wake_(wake),
      counter_(wake),
      playback_(options.scene, {options.threads, log_.enabled(), options.historyBudget, std::move(wake)}, log_) {
  scene_.look = view().look;
}

Session::~Session() = default;

/// To the terminal and the log; null: what `source` complained of is over.
void Session::Tell(const std::string& source, const Diagnostic* diagnostic) {
  if (!diagnostic) return log_.Write(LogLine("mended").Text("source", source));
  if (GoesToTerminal(source)) std::fputs(Format(*diagnostic).c_str(), stderr);
  LogLine line("message");
  line.Text("source", source).Text("severity", SeverityName(diagnostic->severity)).Text("text", diagnostic->message);
  if (!diagnostic->place.file.empty()) line.Text("file", diagnostic->place.file);
  if (diagnostic->place.line > 0) line.Number("line", diagnostic->place.line);
  if (diagnostic->place.column > 0) line.Number("column", diagnostic->place.column);
  log_.Write(line);
}

// Time.

void Session::ResetCloth() {
  const std::uint64_t command = playback_.Send({.kind = Command::Kind::Reset, .undoable = true});
  undo_.Push({.label = "Reset", .command = command});
}

void Session::SetHistoryBudget(std::size_t bytes) {
  if (bytes == snapshot().history.budget) return;
  toldFull_ = false;
  messages_.Set("history budget", {});
  playback_.Send({.kind = Command::Kind::Budget, .budget = bytes});
}

// Undo.

bool Session::Undo() {
  const Change* change = undo_.ToUndo();
  if (!change) return false;
  log_.Write(LogLine("undo").Text("label", change->label));
  undo_.Undone(Travel(*change, false));
  return true;
}

bool Session::Redo() {
  const Change* change = undo_.ToRedo();
  if (!change) return false;
  log_.Write(LogLine("redo").Text("label", change->label));
  undo_.Redone(Travel(*change, true));
  return true;
}

std::uint64_t Session::Travel(const Change& change, bool forth) {
  if (liveView_.Travel(change, forth)) return 0;
  const Scene& from = forth ? change.before : change.after;
  const Scene& to = forth ? change.after : change.before;
  if (const std::optional<Effect> effect = EffectOf(from, to)) {
    Scene settings = WithChange(scene_, from, to);
    LogLine line = DescribeSettings(settings);
    // With a state come its settings.
    AdoptSettings(std::move(settings), change.command == 0 ? *effect : Effect::View, {std::move(line)});
  }
  if (change.command == 0) return 0;
  return playback_.Send({.kind = Command::Kind::Restore, .undoable = true, .before = change.command});
}

// The hand.

void Session::Grip(int cloth, int vertex) {
  const Vec3& at = snapshot().cloths[static_cast<std::size_t>(cloth)].positions[static_cast<std::size_t>(vertex)];
  handles_ = {GripOf(scene_, cloth, vertex, at)};
  hand_ = at;
  undo_.Push({.label = "Drag", .command = SendHandles(true)});
}

void Session::MoveGrip(const Vec3& target) {
  hand_ = target;
  FollowHand();
}

/// Draws what is gripped to the hand.
void Session::FollowHand() {
  if (handles_.empty()) return;
  Handle handle = handles_[0];
  handle.target = hand_;
  const auto cloth = static_cast<std::size_t>(handle.cloth), vertex = static_cast<std::size_t>(handle.vertex);
  const std::vector<ClothCopy>& cloths = snapshot().cloths;
  if (playback_.running() && cloth < cloths.size() && vertex < cloths[cloth].positions.size()) {
    const ClothCopy& copy = cloths[cloth];
    const Vec3& at = copy.positions[vertex];
    handle.target = LeadOf(handle, at, hand_);
    const ClothTopology& topology = *copy.topology;
    if (std::binary_search(topology.pinned.begin(), topology.pinned.end(), handle.vertex)) {
      handle.target =
          at + CarriedWay(handle.vertex, handle.target - at, copy.positions, topology.springs, topology.restLengths);
    }
  }
  if (handle == handles_[0] || Check(handle)) return;  // the same, or beyond the world
  handles_ = {handle};
  SendHandles(false);
}

void Session::LetGo() {
  if (handles_.empty()) return;
  handles_.clear();
  playback_.Send({.kind = Command::Kind::Handles});
}

/// While time stands the cloth is put where the hand is, else it is drawn there.
std::uint64_t Session::SendHandles(bool undoable) {
  const Command::Kind kind = playback_.running() ? Command::Kind::Handles : Command::Kind::Place;
  return playback_.Send({.kind = kind, .undoable = undoable, .handles = handles_});
}

void Session::TogglePin(int cloth, int vertex) {
  const ClothSettings& sheet = scene_.cloths[static_cast<std::size_t>(cloth)];
  const GridPoint point = PointOf(sheet, vertex);
  std::vector<GridPoint> pinned = sheet.pinned;
  if (const VertexGroup* const group = FindVertexGroup(sheet, sheet.pinnedGroup);
      group && std::binary_search(group->vertices.begin(), group->vertices.end(), vertex)) {
    // To free one of a group, the others are named one by one.
    Scene changed = scene_;
    ClothSettings& named = changed.cloths[static_cast<std::size_t>(cloth)];
    named.pinned.clear();
    named.pinnedGroup.clear();
    for (const std::int32_t v : PinnedVertices(sheet)) {
      if (v != vertex) named.pinned.push_back(PointOf(sheet, v));
    }
    SetScene("Pinned points", std::move(changed));
    return;
  }
  if (std::erase(pinned, point) == 0) pinned.push_back(point);
  SetParameter(*FindParameter("cloth", "pinned"), cloth, pinned);
}

void Session::ShootBall(const Vec3& from, const Vec3& direction) {
  const Ball ball = BallFrom(scene_, from, direction);
  if (Check(ball)) return;
  const std::uint64_t command = playback_.Send({.kind = Command::Kind::Ball, .undoable = true, .ball = ball});
  undo_.Push({.label = "Ball", .command = command});
}

void Session::BlowGust(const Vec3& direction) {
  const Gust gust = GustTowards(scene_, direction);
  const std::uint64_t command = playback_.Send({.kind = Command::Kind::Gust, .undoable = true, .gust = gust});
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
    if (!group.isArray || index == kAll || static_cast<std::size_t>(index) == i) Choose(parameter, changed, i, value);
  }
  const Status set = ChangeSettings(std::string(parameter.label), ValuePath(parameter, index), std::move(changed));
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
  messages_.Set(InputSource(parameter, index), {MakeRefusal(parameter.label, why)});
}

Status Session::ChangeSettings(const std::string& label, const std::string& path, Scene settings) {
  const std::optional<Effect> effect = EffectOf(scene_, settings);
  if (!effect) return Ok();
  if (const Status loaded = LoadMeshes(settings); !loaded) return loaded;
  if (const Diagnostics checked = CheckScene(settings); HasErrors(checked)) return checked;
  const bool merges = undo_.Merges(path);
  // Of changes that are merged, the state before the first leads back.
  const bool undoable = effect == Effect::Rebuild && !merges;
  Change change{.label = label, .path = path, .before = scene_, .after = settings};
  std::vector<LogLine> lines =
      path.empty() ? std::vector{DescribeSettings(settings)} : DescribeValues(scene_, settings);
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
  liveView_.SetLook(scene_.look);
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
  return lastApply_ = playback_.Send(std::move(apply), std::move(lines));
}

/// The settings that a state has brought along. What is seen stays as the user wants it.
void Session::FollowSettings(Scene settings) {
  settings.look = scene_.look;
  settings.camera = scene_.camera;
  if (!EffectOf(scene_, settings)) return;
  LogLine line = DescribeSettings(settings);
  AdoptSettings(std::move(settings), Effect::View, {std::move(line)});
}

/// Warnings about the settings as they are now. Those that a slider has left behind are not kept.
void Session::CheckSettings() {
  messages_.Set("settings", CheckScene(scene_), true);
}

void Session::SetShader(const std::string& name) {
  scene_.look.shader = name;
  liveView_.SetLook(scene_.look);
}

void Session::CycleShader(int by) {
  if (const std::string next = liveView_.NextShader(by); !next.empty()) SetShader(next);
}

Status Session::CreateShader(const std::string& name) {
  const Status made = liveView_.CreateShader(name);
  if (made) SetShader(name);
  return made;
}

// What comes by itself.

bool Session::Update(double now) {
  bool news = playback_.Update();
  if (news)
    ReadSnapshot(now);
  else if (stateUnlogged_ && now >= lastState_ + kStatePeriod)
    LogState(now);
  news |= ReadReports(background_.TakeReports());
  news |= ReadFilm();
  if (counter_.TakeNews()) {
    news = true;
    LogIntersections();
  }
  if (const std::string failure = playback_.TakeFailure(); !failure.empty()) {
    messages_.Set("simulation", {MakeError(failure + "; open another scene file to go on, or close the viewer")});
    news = true;
  }
  if (now >= nextLook_) {
    if (nextLook_ == 0) Begin();
    nextLook_ = now + kLookPeriod;
    news |= liveView_.LookAtFiles();
    if (source_.Changed()) {
      ReloadScene();
      news = true;
    }
  }
  liveView_.Update(now);
  return news;
}

/// The first look, when the log has its first line.
void Session::Begin() {
  CheckSettings();
  liveView_.TellProblems();
  counter_.Offer(snapshot());
  if (!options_.state) return playback_.StepFrames(options_.frame);
  SendState(source_.file(), options_.state, false);
  if (!options_.set.empty()) SendSettings({DescribeSettings(scene_)});
}

void Session::ReadSnapshot(double now) {
  for (const Executed& done : snapshot().executed) {
    if (done.scene && done.command > lastApply_) FollowSettings(*done.scene);
    if (done.state) KeepState(done.command, done.state);
    if (!done.failure.empty()) {
      messages_.Set("history", {MakeError(done.failure)});
      SendSettings({DescribeSettings(scene_)});  // Those that the panels show.
    } else if (done.state || done.scene) {
      messages_.Set("history", {});
    }
  }
  counter_.Offer(snapshot());
  if (playback_.running()) FollowHand();  // What it could not reach yet may have come nearer.
  for (const StepReport& report : snapshot().reports) frames_.Add(report);
  Diagnostics problems;
  if (const auto& divergence = snapshot().report.divergence) {
    const std::string where = snapshot().cloths.size() > 1 ? " of cloth " + std::to_string(divergence->cloth) : "";
    problems.push_back(MakeError("the simulation blew up at step " + std::to_string(divergence->step) + ", vertex " +
                                 std::to_string(divergence->vertex) + where + ": " + divergence->cause + "; " +
                                 divergence->remedy + "; then press R"));
  }
  messages_.Set("divergence", problems);
  if (snapshot().history.full && !toldFull_) {
    toldFull_ = true;
    messages_.Set("history budget",
                  {MakeNote("the history has filled the memory it may take: from now on the oldest frames go")});
  }
  stateUnlogged_ = true;
  if (!snapshot().executed.empty() || now >= lastState_ + kStatePeriod) LogState(now);
}

void Session::LogState(double now) {
  lastState_ = now;
  stateUnlogged_ = false;
  if (!log_.enabled()) return;
  double lowest = snapshot().cloths.empty() ? 0 : snapshot().cloths[0].positions[0].y;
  for (const ClothCopy& cloth : snapshot().cloths) {
    for (const Vec3& p : cloth.positions) lowest = std::min(lowest, p.y);
  }
  const StepReport& report = snapshot().report;
  log_.Write(LogLine("state")
                 .Number("frame", report.frame)
                 .Number("step", static_cast<double>(report.step))
                 .Number("time", report.time)
                 .Flag("running", snapshot().running)
                 .Hash("hash", snapshot().hash)
                 .Number("lowest", lowest)
                 .Number("stretch", report.greatestStretch)
                 .Number("energy", report.kineticEnergy)
                 .Flag("rest", report.atRest)
                 .Number("ms", snapshot().frameSeconds * 1000)
                 .Number("drawn", static_cast<double>(pictures_)));
}

/// Where the count is another one.
void Session::LogIntersections() {
  const auto found = intersections();
  if (!found || found->count == loggedIntersections_) return;
  loggedIntersections_ = found->count;
  log_.Write(LogLine("intersections")
                 .Number("frame", found->frame)
                 .Number("count", static_cast<double>(found->count))
                 .Number("ms", found->seconds * 1000));
}

std::string Session::Title() const {
  return PathText(sceneFile().filename()) + " - Percale" + (playback_.running() ? "" : " (paused)");
}

}  // namespace percale::viewer
