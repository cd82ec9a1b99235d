#include "apps/viewer/viewer.h"

#include <imgui.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/viewer/actions.h"
#include "apps/viewer/clock.h"
#include "apps/viewer/hand.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/session_log.h"
#include "apps/viewer/ui_settings.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/window.h"
#include "io/atomic_file.h"
#include "percale/parameters.h"
#include "render/gl_device.h"
#include "render/legend.h"

namespace percale {
namespace viewer {
namespace {

constexpr int kExitFailed = 1, kExitBadInput = 3, kExitNoGraphics = 5, kExitInterrupted = 130;
/// Pictures are drawn no more often than this, where the display does not hold them back itself [1/s].
constexpr double kMostPictures = 120;
/// After the last sign of life pictures are drawn for so long [s], and at least so many, since windows
/// take that many to find their size; then only when there is something new.
constexpr double kActiveTime = 0.5;
constexpr int kActivePictures = 3;
/// How long to sleep at most when nothing happens: files are to be looked at [s].
constexpr double kSleep = 0.05;
/// Samples per pixel of pictures for files, where time matters less.
constexpr int kFileSamples = 4;
/// Share of a new value in the smoothed times.
constexpr double kSmoothing = 0.1;
/// A window that was kept is opened no smaller and no larger [pixel].
constexpr int kLeastWidth = 320, kLeastHeight = 200, kMostSize = 8192;
constexpr const char* kSettingsSource = "kept settings";

volatile std::sig_atomic_t interrupted = 0;
extern "C" void OnInterrupt(int) {
  interrupted = 1;
}

/// The window with all that is in it.
class Viewer {
 public:
  Viewer(const ViewerOptions& options, Window& window, GlDevice& device, SessionLog log)
      : window_(window),
        device_(device),
        session_(options, device, std::move(log), &Window::Wake),
        settingsFile_(options.settings) {
    state_.presetFolders = options.presetFolders;
  }

  void LogStart(const ViewerOptions& options) {
    if (!session_.logged()) return;
    const GraphicsInfo graphics = DescribeGraphics();
    window_.Size(width_, height_);
    state_.scale = window_.scale();
    session_.log().Write(LogLine("start")
                             .Number("log", kLogVersion)
                             .Text("version", PERCALE_VERSION)
                             .Text("scene", PathText(options.sceneFile))
                             .Config(options.scene)
                             .Text("shader", session_.view().look.shader)
                             .Text("root", PathText(options.root))
                             .Number("width", width_)
                             .Number("height", height_)
                             .Number("samples", window_.samples())
                             .Text("renderer", graphics.renderer)
                             .Flag("software", graphics.software)
                             .Number("history", static_cast<double>(options.historyBudget))
                             .Number("frame", session_.snapshot().report.frame)
                             .Hash("hash", session_.snapshot().hash));
    for (const Action& action : Actions()) {
      session_.log().Write(
          LogLine("key").Text("name", action.name).Text("title", action.title).Text("keys", KeysText(action)));
    }
  }

  /// What was kept from the last time.
  void TakeSettings(UiSettings settings, const Diagnostics& problems) {
    state_.kept = std::move(settings);
    session_.messages().Set(kSettingsSource, problems);
  }

  int Run() {
    window_.Show();
    double activeUntil = 0, nextPicture = 0;
    int picturesDue = 0;
    while (!window_.ShouldClose() && !state_.quit && !interrupted) {
      double now = Now();
      window_.WaitForEvents(now < activeUntil || picturesDue > 0 ? nextPicture - now : kSleep);
      now = Now();
      const bool news = session_.Update(now);
      if (window_.TakeActivity() || news) {
        activeUntil = now + kActiveTime;
        picturesDue = kActivePictures;
      }
      if (now >= activeUntil && picturesDue <= 0 && !typing_ && !session_.recorder()) continue;
      if (now < nextPicture) continue;
      nextPicture = now + 1 / kMostPictures;
      if (window_.Minimized()) {
        HandleKeys(window_.TakeEvents());
        nextPicture = now + kSleep;
        continue;
      }
      DrawPicture();
      --picturesDue;
      // What takes some pictures is brought to its end, however slowly they come.
      if (state_.keyboardMoves > 0 || !state_.jump.empty()) picturesDue = kActivePictures;
    }
    KeepSettings();
    // A large cloth may need a while to finish its frame: the window need not stay for that.
    window_.Hide();
    session_.FinishFiles([this](const PictureOrder& order) { DrawOrder(order); });
    const int code = interrupted ? kExitInterrupted : 0;
    session_.log().Write(LogLine("exit").Number("code", code));
    return code;
  }

 private:
  /// For the next start.
  void KeepSettings() {
    if (settingsFile_.empty()) return;
    WindowPlace place;
    window_.Place(place.x, place.y, place.width, place.height);
    if (!window_.Minimized()) state_.kept.window = place;
    const Status saved = SaveUiSettings(settingsFile_, state_.kept);
    if (saved) return;
    Diagnostics problems = saved.diagnostics();
    for (Diagnostic& problem : problems) {
      problem.severity = Severity::Warning;
      problem.message += "; what the viewer was to keep for the next start is lost";
    }
    session_.messages().Set(kSettingsSource, problems);
  }

  void RememberScene() {
    if (session_.sceneFile() == rememberedScene_) return;
    rememberedScene_ = session_.sceneFile();
    std::error_code ignored;
    const std::filesystem::path whole = std::filesystem::absolute(rememberedScene_, ignored).lexically_normal();
    Remember(state_.kept.recentScenes, PathText(whole));
  }

  void HandleKeys(const std::vector<InputEvent>& events) {
    for (const InputEvent& event : events) {
      if (event.kind == InputEvent::Kind::Drop) session_.OpenFile(event.file);
      if (event.kind == InputEvent::Kind::Key) HandleKey(event);
    }
  }

  void HandleKey(const InputEvent& event) {
    if (state_.newShader && event.key.special == SpecialKey::Escape) return state_.newShader.reset();
    if (TakePaletteKey(event.key, session_, state_)) return;
    // ImGui goes on to want text for a picture after the box has had its Enter.
    const bool typing = ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive();
    if ((typing || Window::HasLists()) && BelongsToTextInput(event.key)) {
      if (!typing && event.key.special == SpecialKey::Escape) Window::CloseLists();
      return;
    }
    if (state_.keyboardIn != KeyboardIn::Picture && BelongsToControls(event.key)) {
      // Unless it has just ended what was going on in a control.
      if (event.key.special == SpecialKey::Escape && !controlBusy_) LeavePanels();
      return;
    }
    RunAction(event.key, event.repeated, session_, state_);
  }

  void LeavePanels() {
    state_.keyboardIn = KeyboardIn::Picture;
    state_.keyboardMoves = kKeyboardMoves;
  }

  /// Gives the keyboard to whom it is to go.
  void MoveKeyboard() {
    const bool visible =
        state_.keyboardIn == KeyboardIn::Panels ? state_.kept.panelsVisible : state_.kept.consoleVisible;
    const bool leaves = ImGui::IsMouseClicked(0) && !ImGui::GetIO().WantCaptureMouse;
    if (state_.keyboardIn != KeyboardIn::Picture && (!visible || leaves)) LeavePanels();
    if (state_.keyboardMoves > 0 && --state_.keyboardMoves == 0) {
      constexpr const char* kNames[] = {nullptr, kPanelsTitle, kConsoleTitle};
      Window::FocusPanels(kNames[static_cast<std::size_t>(state_.keyboardIn)]);
    }
  }

  /// Writes that another control than in the last picture has the keyboard, the pointer or what is typed.
  void LogControl(const char* event, const std::string& name, std::string& logged) {
    if (name == logged) return;
    logged = name;
    session_.log().Write(LogLine(event).Text("name", name));
  }

  /// The part of the window that shows the picture: all but the panels [screen unit].
  int PictureWidth() const {
    if (!state_.kept.panelsVisible) return width_;
    return std::max(width_ - static_cast<int>(PanelColumnWidth(state_)), 1);
  }

  void DrawPicture() {
    const double begin = Now();
    int width = 0, height = 0;
    window_.Size(width, height);
    if (width < 1 || height < 1) return;
    if (width != width_ || height != height_ || state_.scale != window_.scale()) {
      width_ = width;
      height_ = height;
      state_.scale = window_.scale();
      session_.log().Write(LogLine("window")
                               .Number("width", width)
                               .Number("height", height)
                               .Number("scale", static_cast<double>(state_.scale)));
    }
    SmoothTimes();
    RememberScene();

    controlBusy_ = ImGui::IsAnyItemActive() || Window::HasLists();
    window_.BeginPanels(state_.keyboardIn != KeyboardIn::Picture);
    const std::vector<InputEvent> events = window_.TakeEvents();
    // Whose a press is depends on where it was made, not on where the pointer is by now.
    for (const InputEvent& event : events) {
      hand_.Take(event, !Window::OverPanels(event.x, event.y), {PictureWidth(), height_}, session_);
    }
    MoveKeyboard();
    HandleKeys(events);
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    state_.pointerRay =
        session_.view().camera.Ray(double(pointer.x) - 0.5, double(pointer.y) - 0.5, PictureWidth(), height_);
    state_.boxes.clear();
    hand_.Follow(session_);
    session_.HoldChanges(hand_.dragging() || ImGui::IsMouseDown(ImGuiMouseButton_Left));
    DrawGizmo();
    state_.focusedControl.clear();
    state_.hoveredControl.clear();
    state_.activeControl.clear();
    if (!state_.jump.empty()) state_.kept.panelsVisible = true;
    DrawPanels();
    LogControl("focus", state_.focusedControl, loggedFocus_);
    LogControl("hover", state_.hoveredControl, loggedHover_);
    LogControl("active", state_.activeControl, loggedActive_);
    // What the keys and panels have just changed shows at once.
    session_.Update(Now());
    DrawScene();
    Record();
    for (const PictureOrder& order : session_.TakePictureOrders()) DrawOrder(order);
    DrawLegends(state_);
    window_.EndPanels();
    window_.SetTitle(session_.Title());
    LogBoxes();
    state_.drawSeconds += kSmoothing * (Now() - begin - state_.drawSeconds);
    window_.Present();
    session_.CountPicture();
    typing_ = ImGui::GetIO().WantTextInput;
  }

  void DrawPanels() {
    const float width = static_cast<float>(width_), height = static_cast<float>(height_);
    const float pictureWidth = static_cast<float>(PictureWidth());
    float free = height;  // Of the picture, above the time bar.
    if (state_.kept.panelsVisible) {
      DrawStatusLine(session_, state_, pictureWidth);
      DrawPanelColumn(session_, state_, width, height);
      free -= DrawTimeBar(session_, state_, pictureWidth, height);
      DrawMessages(session_, state_, pictureWidth, free);
    }
    DrawPlotsWindow(session_, state_, pictureWidth, free);
    DrawInspector(session_, state_, PictureWidth(), height_);
    DrawConsole(session_, state_, pictureWidth, free);
    DrawHelp(session_, state_, width, height);
    DrawNewShader(session_, state_, pictureWidth, height);
    DrawRecordingLight(session_, state_, pictureWidth);
    DrawPalette(session_, state_, width, height);
  }

  void DrawGizmo() {
    const auto selected = hand_.Selected(session_);
    const auto gizmo = selected ? GizmoOf(*selected, session_, {PictureWidth(), height_}) : std::nullopt;
    if (gizmo) percale::viewer::DrawGizmo(*gizmo, hand_.axis(), state_);
  }

  /// Size of the picture [pixel].
  PictureSize Pixels() const {
    int pixels = 0, rows = 0;
    window_.FramebufferSize(pixels, rows);
    return {std::max(1, static_cast<int>(static_cast<double>(pixels) * PictureWidth() / width_)), std::max(rows, 1)};
  }

  /// A picture for a file: of its own state, since the simulation may have gone on.
  void DrawOrder(const PictureOrder& order) {
    const Snapshot& snapshot = session_.snapshot();
    const PictureSize size = Pixels();
    Result<RenderTarget> target = RenderTarget::Create(size.width, size.height, kFileSamples);
    if (!target) return session_.FailPicture(target.diagnostics());
    const WorldState& state = *order.state;
    shapes_.clear();
    orderVelocities_.resize(state.cloths.size());
    for (std::size_t c = 0; c < state.cloths.size() && c < snapshot.cloths.size(); ++c) {
      const ClothTopology& topology = *snapshot.cloths[c].topology;
      // Another cloth has taken its place since.
      if (topology.uv.size() != state.cloths[c].positions.size()) return session_.TakePicture();
      const WorldState::Cloth& cloth = state.cloths[c];
      std::vector<Vec3>& velocities = orderVelocities_[c];
      velocities.resize(cloth.positions.size());
      for (std::size_t i = 0; i < velocities.size(); ++i)
        velocities[i] = (cloth.positions[i] - cloth.previous[i]) / state.scene->TimeStep();
      shapes_.push_back({cloth.positions, topology.uv, topology.triangles, topology.springs, topology.rest, velocities,
                         topology.pinned, topology.restLengths});
    }
    target->Bind();
    const DrawList& list =
        sceneView_.Update(*state.scene, shapes_, order.view, size.width, size.height, state.balls, state.report.time,
                          order.view.ShowsForces() ? ReadContacts(state) : std::vector<ContactForce>());
    if (const Status drawn = device_.Draw(list, size.width, size.height); !drawn)
      return session_.FailPicture(drawn.diagnostics());
    Image image = target->Read();
    DrawLegend(image, list.heatScale);
    session_.KeepPicture(std::move(image), order);
  }

  /// The picture that has just been drawn, for the film.
  void Record() {
    Recorder* const recorder = session_.recorder();
    const double now = Now();
    if (!recorder || !recorder->Wants(now)) return;
    const PictureSize size = Pixels();
    if (recorder->width() == 0 || (recorder->width() == size.width && recorder->height() == size.height)) {
      AddToFilm(ReadFramebuffer(size.width, size.height), now);
      return;
    }
    // The window has changed its size, the film cannot.
    if (!filmTarget_ || filmTarget_->width() != recorder->width() || filmTarget_->height() != recorder->height()) {
      filmTarget_.reset();
      Result<RenderTarget> target = RenderTarget::Create(recorder->width(), recorder->height(), window_.samples());
      if (!target) return;  // The picture before stays.
      filmTarget_.emplace(std::move(*target));
    }
    filmTarget_->Bind();
    Draw(recorder->width(), recorder->height());
    AddToFilm(filmTarget_->Read(), now);
  }

  void AddToFilm(Image image, double now) {
    DrawLegend(image, scale_);
    session_.recorder()->Add(std::move(image), now);
  }

  void DrawScene() {
    const auto [columns, rows] = Pixels();
    const Status drawn = Draw(columns, rows);
    state_.heatScale = scale_;
    state_.arrowForce = arrowForce_;
    session_.liveView().TellDrawing(drawn, device_.TakeWarnings());
  }

  Status Draw(int columns, int rows) {
    const Snapshot& snapshot = session_.snapshot();
    shapes_.clear();
    for (const ClothCopy& cloth : snapshot.cloths) {
      const ClothTopology& topology = *cloth.topology;
      shapes_.push_back({cloth.positions, topology.uv, topology.triangles, topology.springs, topology.rest,
                         cloth.velocities, topology.pinned, topology.restLengths});
    }
    session_.playback().WantContacts(session_.view().ShowsForces());
    const DrawList& list = sceneView_.Update(*snapshot.scene, shapes_, session_.view(), columns, rows, snapshot.balls,
                                             snapshot.report.time, snapshot.contacts);
    scale_ = list.heatScale;
    arrowForce_ = list.arrowForce;
    return device_.Draw(list, columns, rows);
  }

  void SmoothTimes() {
    const Snapshot& snapshot = session_.snapshot();
    if (snapshot.report.step == smoothedStep_) return;
    // The first frame counts as it is.
    const double share = state_.frameSeconds == 0 || snapshot.report.step < smoothedStep_ ? 1 : kSmoothing;
    smoothedStep_ = snapshot.report.step;
    state_.frameSeconds += share * (snapshot.frameSeconds - state_.frameSeconds);
    for (std::size_t i = 0; i < state_.stageSeconds.size(); ++i)
      state_.stageSeconds[i] += share * (snapshot.report.stageSeconds[i] - state_.stageSeconds[i]);
  }

  void LogBoxes() {
    if (!session_.logged()) return;
    const auto write = [&](const std::string& name, const Box& box) {
      session_.log().Write(LogLine("widget")
                               .Text("name", name)
                               .Number("x", static_cast<double>(box.x))
                               .Number("y", static_cast<double>(box.y))
                               .Number("width", static_cast<double>(box.width))
                               .Number("height", static_cast<double>(box.height)));
    };
    // A window that opens takes a picture or two to find its size: what still moves is not told.
    for (const auto& [name, box] : state_.boxes) {
      const auto last = lastBoxes_.find(name), logged = loggedBoxes_.find(name);
      if (last == lastBoxes_.end() || !(last->second == box)) continue;
      if (logged != loggedBoxes_.end() && logged->second == box) continue;
      write(name, box);
      loggedBoxes_[name] = box;
    }
    for (auto logged = loggedBoxes_.begin(); logged != loggedBoxes_.end();) {
      if (state_.boxes.find(logged->first) != state_.boxes.end()) {
        ++logged;
        continue;
      }
      write(logged->first, {});
      logged = loggedBoxes_.erase(logged);
    }
    std::swap(lastBoxes_, state_.boxes);
  }

  Window& window_;
  GlDevice& device_;
  Session session_;
  UiState state_;
  Hand hand_;
  SceneView sceneView_;
  std::vector<ClothShape> shapes_;
  std::optional<RenderTarget> filmTarget_;
  std::vector<std::vector<Vec3>> orderVelocities_;      // Of a picture for a file.
  HeatScale scale_;                                     // Of what was drawn last...
  double arrowForce_ = 0;                               // ...and of its longest arrow [N].
  std::map<std::string, Box> lastBoxes_, loggedBoxes_;  // Of the last picture, and as the log has them.
  int width_ = 0, height_ = 0;                          // Of the window [screen unit].
  std::int64_t smoothedStep_ = 0;
  bool typing_ = false;
  bool controlBusy_ = false;  // A control was in use, or a list open, in the last picture.
  std::string loggedFocus_, loggedHover_, loggedActive_;
  std::filesystem::path settingsFile_, rememberedScene_;
};

/// Where the window was last time, unless the options say otherwise.
WindowSettings MakeWindowSettings(const ViewerOptions& options, const UiSettings& kept) {
  WindowSettings settings;
  if (kept.window) {
    settings.width = std::clamp(kept.window->width, kLeastWidth, kMostSize);
    settings.height = std::clamp(kept.window->height, kLeastHeight, kMostSize);
    settings.position = {kept.window->x, kept.window->y};
  }
  if (options.width > 0) settings.width = options.width;
  if (options.height > 0) settings.height = options.height;
  settings.uiScale = options.uiScale;
  settings.samples = options.samples;
  settings.title = "Percale";
  return settings;
}

int Fail(const Diagnostics& diagnostics, int code) {
  for (const Diagnostic& diagnostic : diagnostics) {
    std::fputs(((diagnostic.place.file.empty() ? "percale: " : "") + Format(diagnostic)).c_str(), stderr);
  }
  return code;
}

/// Ctrl+C in the terminal ends the loop, while this lives.
class InterruptHandler {
 public:
  InterruptHandler() : interrupt_(std::signal(SIGINT, OnInterrupt)), terminate_(std::signal(SIGTERM, OnInterrupt)) {
    interrupted = 0;
  }
  ~InterruptHandler() {
    std::signal(SIGINT, interrupt_);
    std::signal(SIGTERM, terminate_);
  }

 private:
  void (*interrupt_)(int);
  void (*terminate_)(int);
};

}  // namespace
}  // namespace viewer

int RunViewer(const ViewerOptions& options) {
  using namespace viewer;
  if (const Diagnostics problems = CheckScene(options.scene); HasErrors(problems)) return Fail(problems, kExitBadInput);
  if (ListShaders(options.root / "shaders").empty()) {
    return Fail({MakeError(PathText(options.root / "shaders"),
                           "expected shaders (*.frag) in this folder, found none; name the project's folder with -r")},
                kExitBadInput);
  }
  SessionLog log;
  if (!options.log.empty()) {
    Result<SessionLog> opened = SessionLog::Open(options.log);
    if (!opened) return Fail(opened.diagnostics(), kExitFailed);
    log = std::move(*opened);
  }
  Diagnostics problems;
  UiSettings kept;
  if (!options.settings.empty()) kept = LoadUiSettings(options.settings, problems);
  Result<Window> window = Window::Open(MakeWindowSettings(options, kept));
  if (!window) return Fail(window.diagnostics(), kExitNoGraphics);
  Result<GlDevice> device = GlDevice::Create(options.root);
  if (!device) return Fail(device.diagnostics(), kExitNoGraphics);
  const InterruptHandler handler;
  Viewer viewer(options, *window, *device, std::move(log));
  viewer.LogStart(options);
  viewer.TakeSettings(std::move(kept), problems);
  return viewer.Run();
}

}  // namespace percale
