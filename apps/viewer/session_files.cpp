// What of a Session has to do with files that it makes and opens: checkpoints, pictures, textures.

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

namespace percale::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrameMark = "-frame";
/// A picture that is opened runs to its frame in pieces of so many frames, so that it can be watched.
constexpr int kFramesAtOnce = 5;
/// Of pictures: nearly as small as 9, much faster.
constexpr int kPngLevel = 6;

Diagnostic Note(const fs::path& file, std::string message) {
  return MakeNote(PathText(file), std::move(message));
}

bool AllDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
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
  const std::string stem = PathText(sceneFile_.stem());
  const std::string ending = LowerExtension(sceneFile_);
  std::string_view name = stem;
  if (ending == ".percale" && !SceneOfCheckpoint(stem).empty()) name = SceneOfCheckpoint(stem);
  if (ending == ".png") name = WithoutNumber(stem);
  return Whole(TextPath(name));
}

void Session::SaveState() {
  saves_[Send({.kind = Command::Kind::Save})] = {SaveOrder::Checkpoint, view_};
}

void Session::TakePicture() {
  saves_[Send({.kind = Command::Kind::Save})] = {SaveOrder::Picture, view_};
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
  background_.Do([picture, order, stem = OutputStem()]() -> JobReport {
    const WorldState& state = *order.state;
    PngOptions png;
    png.level = kPngLevel;
    // Whether a hand has been at work nobody can tell from the settings, so the state is always told.
    png.text = DescribePicture(*state.scene, order.view, state.report.frame, &state);
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
    if (!report.file.empty() && log_.enabled())
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
  if (log_.enabled()) log_.Write(LogLine("record").Flag("recording", !recorder_->stopped()));
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
  if (!recorder_->stopped() && log_.enabled()) log_.Write(LogLine("record").Flag("recording", false));
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
  kept_.WriteAll();
  Update(Now());
}

/// Sends a state that has been read from a file.
std::uint64_t Session::SendState(const fs::path& file, std::shared_ptr<const WorldState> state, bool undoable) {
  Command command{.kind = Command::Kind::Load, .undoable = undoable, .state = std::move(state)};
  LogLine line = DescribeCommand(command);
  line.Text("file", PathText(Whole(file))).Config(*command.state->scene);
  wantsRunning_ = wantsLooping_ = false;
  handles_.clear();
  return Send(std::move(command), {std::move(line)});
}

/// From the start to a frame.
void Session::SendFrames(int frames) {
  for (; frames > 0; frames -= kFramesAtOnce)
    Send({.kind = Command::Kind::Step, .frames = std::min(frames, kFramesAtOnce)});
}

bool Session::LoadNewestState() {
  const std::string stem = PathText(OutputStem().filename());
  fs::path newest;
  fs::file_time_type newestTime{};
  for (const fs::path& folder : {fs::path("."), sceneFile_.parent_path()}) {
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
    Result<std::optional<ViewFile>> picture = ReadPictureView(file);
    if (!picture) {
      messages_.Set("open", picture.diagnostics());
      return false;
    }
    if (!*picture) {
      SetTexture(0, Whole(file));
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
  sceneFile_ = browsed_ = file;
  sceneWatch_ = FileWatch(file);
  fileScene_ = scene_ = opened.scene;
  if (opened.view) {
    givenShader_ = opened.view->look.shader;
    givenUniforms_ = opened.view->uniforms;
    givenAreWhole_ = true;
    opened.view->look = view_.look;
    view_ = std::move(*opened.view);
    if (log_.enabled()) log_.Write(LogLine("wireframe").Flag("visible", view_.wireframe));
  }
  AdoptLook();
  AdoptUniforms();
  messages_.Set("scene", {});
  messages_.Set("open", {});
  if (opened.state) {
    SendState(file, std::move(opened.state), false);
  } else {
    Run(false);
    SendSettings({LogLine("open").Text("scene", PathText(file)).Config(scene_)});
    Send({.kind = Command::Kind::Reset});
    SendFrames(opened.frame);
  }
  handles_.clear();
  undo_.Clear();
  ResetCamera();
  CheckSettings();
  return true;
}

void Session::SetTexture(std::size_t number, const fs::path& file) {
  fs::path& texture = view_.textures[number];
  undo_.Push({.label = "Texture", .texture = true, .textureBefore = texture, .textureAfter = file});
  texture = file;
  const bool uses = UsesTexture(number);
  messages_.Set("texture", {Note(file, "is the shaders' texture " + std::to_string(number + 1) +
                                           (uses ? "" : ", which " + view_.look.shader + " does not use") +
                                           "; Ctrl+Z takes it back")});
  LogTexture(number);
}

/// Whether the current shader draws with it.
bool Session::UsesTexture(std::size_t number) {
  const ShaderProgram* program = shaders_.Find(view_.look.shader);
  return program && program->Location("u_texture_" + std::to_string(number + 1)) >= 0;
}

void Session::LogTexture(std::size_t number) {
  if (!log_.enabled()) return;
  log_.Write(LogLine("texture")
                 .Number("number", static_cast<double>(number + 1))
                 .Text("file", PathText(view_.textures[number])));
}

}  // namespace percale::viewer
