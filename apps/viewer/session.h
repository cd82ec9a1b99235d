#pragma once
/// \file
/// What a session of the viewer is, apart from its window: the scene as it is set now, the playback of its
/// simulation, the view, the messages, what can be undone, the files. Keys and panels call it; it knows neither.
/// Everything that happens is written to the session log.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/viewer/background.h"
#include "apps/viewer/frame_table.h"
#include "apps/viewer/intersection_counter.h"
#include "apps/viewer/live_view.h"
#include "apps/viewer/messages.h"
#include "apps/viewer/playback.h"
#include "apps/viewer/recorder.h"
#include "apps/viewer/scene_source.h"
#include "apps/viewer/session_log.h"
#include "apps/viewer/undo.h"
#include "apps/viewer/viewer.h"
#include "percale/parameters.h"
#include "render/image.h"
#include "render/scene_view.h"

namespace percale::viewer {

/// A picture that the user wants: of that state, so seen.
struct PictureOrder {
  std::shared_ptr<const WorldState> state;
  View view;
};

class Session {
 public:
  /// Every object of a group, in place of an index.
  static constexpr int kAll = -1;

  /// `device` must outlive the session. `wake` is called, on any thread, when Update has news.
  Session(const ViewerOptions& options, GlDevice& device, SessionLog log, std::function<void()> wake);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Takes what the simulation has done and looks at the watched files; call it once per picture, and
  /// at least ten times per second. `now` counts seconds. Returns whether there is anything new to show.
  bool Update(double now);

  // Time, and the newest state.
  Playback& playback() { return playback_; }
  const Playback& playback() const { return playback_; }
  const Snapshot& snapshot() const { return playback_.snapshot(); }
  void ResetCloth();
  void SetHistoryBudget(std::size_t bytes);

  // Undo.
  /// While the user holds a control, its changes count as one.
  void HoldChanges(bool held) { undo_.Hold(held); }
  bool Undo();
  bool Redo();
  const Change* ToUndo() const { return undo_.ToUndo(); }  ///< What Undo would take back, or null.
  const Change* ToRedo() const { return undo_.ToRedo(); }

  // The hand.
  /// Grips the cloth at a vertex, which MoveGrip then draws along. A grip on a pin carries the pin.
  void Grip(int cloth, int vertex);
  void MoveGrip(const Vec3& target);
  void LetGo();
  bool gripping() const { return !handles_.empty(); }
  /// Pins a vertex where it is, or lets it go.
  void TogglePin(int cloth, int vertex);
  /// A ball from before a point in a direction; its size, mass and speed suit the scene.
  void ShootBall(const Vec3& from, const Vec3& direction);
  /// A second of wind in a direction, strong enough for the cloth's weight.
  void BlowGust(const Vec3& direction);

  // Settings.
  const Scene& scene() const { return scene_; }  ///< As it is set now.
  /// Sets a parameter of object `index` of its group, or of kAll, if the value will do; else a
  /// message says why not, and the old value stays. Returns whether it was set.
  bool SetParameter(const Parameter& parameter, int index, const Value& value);
  /// All settings at once, as one change that `label` names, if they will do; else the result says why not.
  Status SetScene(const std::string& label, Scene settings);
  /// What was typed for a parameter will not do, and why.
  void Refuse(const Parameter& parameter, int index, const std::string& why);

  // What is seen.
  LiveView& liveView() { return liveView_; }
  const LiveView& liveView() const { return liveView_; }
  const View& view() const { return liveView_.view(); }
  void SetShader(const std::string& name);
  void CycleShader(int by);
  /// Makes a shader from the template, and draws with it.
  Status CreateShader(const std::string& name);

  // Files.
  void Reload();
  /// Another scene, paused at its start. When it cannot be read the old one stays.
  bool OpenScene(const std::filesystem::path& file);
  /// A scene, checkpoint, or picture that tells what it shows; another picture becomes the first texture.
  bool OpenFile(const std::filesystem::path& file);
  /// Saves the state to NAME-frameN.percale in the current folder.
  void SaveState();
  /// To the newest such file, of the current folder and the scene's. Can be undone. Returns whether there is one.
  bool LoadNewestState();
  /// Orders a picture of what is shown, to be called NAME-1.png, NAME-2.png, ... in the current folder.
  void TakePicture();
  /// Pictures to be drawn and handed to KeepPicture.
  std::vector<PictureOrder> TakePictureOrders();
  void KeepPicture(Image image, const PictureOrder& order);
  void FailPicture(const Diagnostics& why) { messages_.Set("saving a picture", why); }
  /// Starts a film, or ends it. Returns false while the one before is not ended yet.
  bool ToggleRecording();
  /// The film under way, or null; it wants pictures.
  Recorder* recorder() { return recorder_ && !recorder_->stopped() ? recorder_.get() : nullptr; }
  std::optional<double> RecordedSeconds() const;
  /// At the end: waits until everything that was to be saved is. `draw` draws the pictures of orders.
  void FinishFiles(const std::function<void(const PictureOrder&)>& draw);
  /// The scene file that follows the current one in its folder, or with `by` < 0 the one before.
  void CycleScene(int by);
  const std::filesystem::path& sceneFile() const { return source_.file(); }
  /// The scene files of the folder that the current one is in, by name.
  std::vector<std::filesystem::path> SceneFiles() const { return source_.Files(); }

  /// How often cloth passes through cloth, in the newest frame of which that is known.
  std::optional<IntersectionCounter::Result> intersections() const { return counter_.result(); }
  FrameTable& frames() { return frames_; }  ///< What the last frames did.
  const FrameTable& frames() const { return frames_; }
  /// Writes some of them as a table into the current folder.
  void ExportPlots(std::span<const FrameRow> rows);
  Messages& messages() { return messages_; }
  SessionLog& log() { return log_; }
  bool logged() const { return log_.enabled(); }
  std::string Title() const;
  void CountPicture() { ++pictures_; }

 private:
  void Tell(const std::string& source, const Diagnostic* diagnostic);
  void Begin();
  void StartAnew(Scene scene, std::shared_ptr<const WorldState> state, int frame);
  void ReloadScene();
  std::filesystem::path OutputStem() const;
  void KeepState(std::uint64_t command, std::shared_ptr<const WorldState> state);
  bool ReadReports(const std::vector<JobReport>& reports);
  bool ReadFilm();
  std::uint64_t SendState(const std::filesystem::path& file, std::shared_ptr<const WorldState> state, bool undoable);
  void CheckSettings();
  void ReadSnapshot(double now);
  void LogState(double now);
  void LogIntersections();
  /// The one way in which the user changes settings: as a change that can be undone, and that is merged with the one
  /// before it while what `path` names is held. Keeps the state where the cloth is to start anew.
  Status ChangeSettings(const std::string& label, const std::string& path, Scene settings);
  /// The one way to other settings: draws with them, logs `lines`, and sends them unless they have an effect on the
  /// view alone, or the simulation has them already. Returns the number of the command, or 0.
  std::uint64_t AdoptSettings(Scene settings, Effect effect, std::vector<LogLine> lines, bool undoable = false);
  void FollowSettings(Scene settings);
  /// Sends the settings as they are.
  std::uint64_t SendSettings(std::vector<LogLine> lines, bool undoable = false);
  std::uint64_t SendHandles(bool undoable);
  void FollowHand();
  /// Takes a change back, or does it again; returns the command whose state before it leads back, or 0.
  std::uint64_t Travel(const Change& change, bool forth);

  const ViewerOptions options_;
  SessionLog log_;
  Messages messages_;
  UndoStack undo_;
  Scene scene_;
  SceneSource source_;
  LiveView liveView_;
  FrameTable frames_;
  std::vector<Handle> handles_;
  Vec3 hand_;  // To where what is gripped is drawn [m].
  struct SaveOrder {
    enum What { Checkpoint, Picture } what;
    View view;
  };
  std::map<std::uint64_t, SaveOrder> saves_;  // By the command that hands out the state.
  std::vector<PictureOrder> pictureOrders_;
  Background background_;
  std::function<void()> wake_;
  std::unique_ptr<Recorder> recorder_;
  IntersectionCounter counter_;
  Playback playback_;
  std::uint64_t lastApply_ = 0;
  double nextLook_ = 0;    // At the files [s].
  double lastState_ = -1;  // Logged [s].
  bool stateUnlogged_ = false;
  bool toldFull_ = false;  // That the history has reached its budget.
  std::optional<std::int64_t> loggedIntersections_;
  std::int64_t pictures_ = 0;
};

}  // namespace percale::viewer
