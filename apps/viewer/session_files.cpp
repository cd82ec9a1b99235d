// What of a Session has to do with files that it makes and opens: scenes, checkpoints, pictures, films, tables.

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "apps/viewer/clock.h"
#include "apps/viewer/session.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "percale/checkpoint_file.h"
#include "render/view_file.h"

namespace percale::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrameMark = "-frame";
/// Of pictures: nearly as small as 9, much faster.
constexpr int kPngLevel = 6;

Diagnostic Note(const fs::path& file, std::string message) {
  return MakeNote(PathText(file), std::move(message));
}

bool AllDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), IsDigit);
}

/// "pinned2" of "pinned2-12"; the text itself where there is no number.
std::string_view WithoutNumber(std::string_view stem) {
  const std::size_t dash = stem.rfind('-');
  return dash != std::string_view::npos && dash > 0 && AllDigits(stem.substr(dash + 1)) ? stem.substr(0, dash) : stem;
}

/// "pinned2" of "pinned2-frame30" and "pinned2-frame30-2"; empty for what is not the stem of a checkpoint.
std::string_view SceneOfCheckpoint(std::string_view stem) {
  stem = WithoutNumber(stem);
  const std::size_t mark = stem.rfind(kFrameMark);
  const bool marked = mark != std::string_view::npos && AllDigits(stem.substr(mark + kFrameMark.size()));
  return marked ? stem.substr(0, mark) : std::string_view();
}

fs::path Whole(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::absolute(file, error);
  return error ? file : whole.lexically_normal();
}

/// Whether two scenes have the same values in all parameters of a group.
bool SameGroup(std::string_view group, const Scene& a, const Scene& b) {
  const std::vector<Difference> differences = Differences(a, b);
  return std::none_of(differences.begin(), differences.end(),
                      [&](const Difference& d) { return d.parameter->group == group; });
}

/// Writes a checkpoint beside those there are.
JobReport WriteCheckpoint(const WorldState& state, const fs::path& stem) {
  fs::path named = stem;
  named += std::string(kFrameMark) + std::to_string(state.report.frame);
  fs::path file = named;
  file += ".percale";
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(file, ignored))) file = NumberedName(named, ".percale");
  if (const Status saved = SaveCheckpoint(file, state); !saved) return {"checkpoint", {}, saved.diagnostics()};
  return {"checkpoint", file, {Note(file, "the state of frame " + std::to_string(state.report.frame) + " is saved")}};
}

}  // namespace

/// Files that are made are called after the scene, also when it came from such a file.
fs::path Session::OutputStem() const {
  const std::string stem = PathText(sceneFile().stem());
  const std::string ending = LowerExtension(sceneFile());
  std::string_view name = stem;
  if (ending == ".percale" && !SceneOfCheckpoint(stem).empty()) name = SceneOfCheckpoint(stem);
  if (ending == ".png") name = WithoutNumber(stem);
  return Whole(TextPath(name));
}

void Session::SaveState() {
  saves_[playback_.Send({.kind = Command::Kind::Save})] = {SaveOrder::Checkpoint, view()};
}

void Session::TakePicture() {
  saves_[playback_.Send({.kind = Command::Kind::Save})] = {SaveOrder::Picture, view()};
}

/// The state that was to be saved has come.
void Session::KeepState(std::uint64_t command, std::shared_ptr<const WorldState> state) {
  const auto order = saves_.find(command);
  if (order == saves_.end()) return;
  if (order->second.what == SaveOrder::Picture) {
    pictureOrders_.push_back({std::move(state), std::move(order->second.view)});
  } else {
    // Look and camera are not the simulation's business, but belong to the scene.
    auto whole = std::make_shared<WorldState>(*state);
    Scene scene = *state->scene;
    scene.look = order->second.view.look;
    scene.camera = order->second.view.camera.Settings();
    whole->scene = std::make_shared<const Scene>(std::move(scene));
    background_.Do([whole, stem = OutputStem()] { return WriteCheckpoint(*whole, stem); });
  }
  saves_.erase(order);
}

std::vector<PictureOrder> Session::TakePictureOrders() {
  return std::exchange(pictureOrders_, {});
}

void Session::KeepPicture(Image image, const PictureOrder& order) {
  auto picture = std::make_shared<const Image>(std::move(image));
  background_.Do([picture, order, stem = OutputStem(), root = options_.root]() -> JobReport {
    const WorldState& state = *order.state;
    PngOptions png;
    png.level = kPngLevel;
    // Whether a hand has been at work nobody can tell from the settings, so the state is always told.
    png.text = DescribePicture(*state.scene, order.view, state.report.frame, &state, root);
    png.text.insert(png.text.begin(), {"Software", std::string("Percale ") + PERCALE_VERSION});
    const fs::path file = NumberedName(stem, ".png");
    if (const Status written = WritePng(file, *picture, png); !written) return {"picture", {}, written.diagnostics()};
    JobReport report{"picture",
                     file,
                     {Note(file, "frame " + std::to_string(state.report.frame) +
                                     "; drop it on the "
                                     "window to come back to it")}};
    if (state.Bytes() > kMostStateInPicture)
      report.diagnostics = {Note(file, "the state is too large to be in it; Ctrl+S saves it in a file of its own")};
    return report;
  });
}

/// Tells what has been saved.
bool Session::ReadReports(const std::vector<JobReport>& reports) {
  for (const JobReport& report : reports) {
    messages_.Set("saving a " + report.what, report.diagnostics);
    if (!report.file.empty())
      log_.Write(LogLine("saved").Text("what", report.what).Text("file", PathText(report.file)));
  }
  return !reports.empty();
}

bool Session::ToggleRecording() {
  if (recorder_ && recorder_->stopped()) return false;
  if (recorder_)
    recorder_->Stop(Now());
  else
    recorder_ = std::make_unique<Recorder>(OutputStem(), Now(), wake_);
  log_.Write(LogLine("record").Flag("recording", !recorder_->stopped()));
  return true;
}

std::optional<double> Session::RecordedSeconds() const {
  if (!recorder_ || recorder_->stopped()) return std::nullopt;
  return recorder_->seconds(Now());
}

bool Session::ReadFilm() {
  if (!recorder_) return false;
  const bool ended = recorder_->ended();  // Before its last report is taken.
  const bool news = ReadReports(recorder_->TakeReports());
  if (!ended) return news;
  if (!recorder_->stopped()) log_.Write(LogLine("record").Flag("recording", false));
  const std::vector<JobReport> last = recorder_->TakeReports();
  recorder_.reset();
  ReadReports(last);
  return true;
}

void Session::FinishFiles(const std::function<void(const PictureOrder&)>& draw) {
  if (recorder_) recorder_->Stop(Now());
  const auto isOver = [this] {
    if (!messages_.Holds("simulation") && !saves_.empty()) return false;
    return !recorder_ || recorder_->ended();
  };
  for (bool over = false; !over;) {
    over = isOver();
    Update(Now());
    for (const PictureOrder& order : TakePictureOrders()) draw(order);
    if (!over) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  background_.Finish();
  liveView_.Finish();
  Update(Now());
}

/// Sends a state that has been read from a file.
std::uint64_t Session::SendState(const fs::path& file, std::shared_ptr<const WorldState> state, bool undoable) {
  Command command{.kind = Command::Kind::Load, .undoable = undoable, .state = std::move(state)};
  LogLine line = DescribeCommand(command);
  line.Text("file", PathText(Whole(file))).Config(*command.state->scene);
  handles_.clear();
  return playback_.Send(std::move(command), {std::move(line)});
}

bool Session::LoadNewestState() {
  const std::string stem = PathText(OutputStem().filename());
  fs::path newest;
  fs::file_time_type newestTime{};
  for (const fs::path& folder : {fs::path("."), sceneFile().parent_path()}) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      const fs::path& file = entry->path();
      if (LowerExtension(file) != ".percale" || SceneOfCheckpoint(PathText(file.stem())) != stem) continue;
      std::error_code ignored;
      const fs::file_time_type time = fs::last_write_time(file, ignored);
      if (!newest.empty() && time <= newestTime) continue;
      newest = file;
      newestTime = time;
    }
  }
  if (newest.empty()) {
    messages_.Set("open", {MakeError("there is no checkpoint " + stem + "-frame*.percale here or beside the scene; " +
                                     "Ctrl+S saves one")});
    return false;
  }
  Result<WorldState> loaded = LoadCheckpoint(newest);
  if (!loaded) {
    messages_.Set("open", loaded.diagnostics());
    return false;
  }
  auto state = std::make_shared<const WorldState>(std::move(*loaded));
  Change change{.label = "Load a checkpoint", .before = scene_, .after = *state->scene};
  change.command = SendState(newest, state, true);
  AdoptSettings(*state->scene, Effect::View, {});
  undo_.Push(std::move(change));
  messages_.Set("open", {Note(Whole(newest), "frame " + std::to_string(state->report.frame) + "; Ctrl+Z goes back")});
  return true;
}

bool Session::OpenFile(const fs::path& file) {
  const std::string ending = LowerExtension(file);
  if (ending != ".percale" && ending != ".png") return OpenScene(file);
  ViewFile opened;
  if (ending == ".png") {
    Result<std::optional<ViewFile>> picture = ReadPictureView(file, options_.root);
    if (!picture) {
      messages_.Set("open", picture.diagnostics());
      return false;
    }
    if (!*picture) {
      liveView_.SetTexture(0, Whole(file));
      return true;
    }
    opened = std::move(**picture);
  } else {
    Result<ViewFile> checkpoint = OpenViewFile(file);
    if (!checkpoint) {
      messages_.Set("open", checkpoint.diagnostics());
      return false;
    }
    opened = std::move(*checkpoint);
  }
  messages_.Set("open", {});
  source_.Adopt(file, opened.scene);
  if (opened.view) liveView_.Show(std::move(*opened.view));
  StartAnew(std::move(opened.scene), std::move(opened.state), opened.frame);
  return true;
}

bool Session::OpenScene(const fs::path& file) {
  source_.BrowseTo(file);
  Result<SceneReading> read = source_.Read(file);
  messages_.Set("open", read.diagnostics());
  if (!read) return false;
  source_.Adopt(file, read->scene);
  if (!read->statesShader) read->scene.look.shader = scene_.look.shader;
  StartAnew(std::move(read->scene), nullptr, 0);
  return true;
}

void Session::CycleScene(int by) {
  const Result<fs::path> next = source_.Next(by);
  if (next)
    OpenScene(*next);
  else
    messages_.Set("open", next.diagnostics());
}

/// With another scene, paused at a state of it, or so many frames from its start.
void Session::StartAnew(Scene scene, std::shared_ptr<const WorldState> state, int frame) {
  AdoptSettings(std::move(scene), Effect::View, {});
  messages_.Set("scene", {});
  if (state) {
    SendState(sceneFile(), std::move(state), false);
  } else {
    playback_.Run(false);
    SendSettings({LogLine("open").Text("scene", PathText(sceneFile())).Config(scene_)});
    playback_.Send({.kind = Command::Kind::Reset});
    playback_.StepFrames(frame);
  }
  handles_.clear();
  undo_.Clear();
  liveView_.ResetCamera(scene_);
}

/// The file's values count, but what the user chose to see stays unless the file has changed it.
void Session::ReloadScene() {
  Result<SceneReading> read = source_.ReadAgain();
  messages_.Set("scene", read.diagnostics());
  if (!read) return;
  Scene& loaded = read->scene;
  const bool sameLook = SameGroup("look", loaded, source_.scene());
  const bool sameCamera = SameGroup("camera", loaded, source_.scene());
  source_.Adopt(loaded);
  if (sameLook) loaded.look = scene_.look;
  const Effect effect = EffectOf(scene_, loaded).value_or(Effect::View);
  LogLine line = LogLine("reload").Text("what", "scene").Text("file", PathText(sceneFile())).Config(loaded);
  AdoptSettings(std::move(loaded), effect, {std::move(line)});
  if (!liveView_.cameraMoved() || !sameCamera) liveView_.ResetCamera(scene_);
}

void Session::Reload() {
  ReloadScene();
  liveView_.Reload();
}

void Session::ExportPlots(std::span<const FrameRow> rows) {
  const Result<fs::path> file = ExportFrames(rows, sceneFile());
  messages_.Set("export", file ? Diagnostics{} : file.diagnostics());
  if (file) log_.Write(LogLine("export").Text("file", PathText(*file)));
}

}  // namespace percale::viewer
