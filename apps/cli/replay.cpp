#include <cinttypes>
#include <cstdio>
#include <optional>
#include <utility>

#include "apps/cli/platform.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "percale/mesh_file.h"
#include "render/view_file.h"
#ifdef PERCALE_HAS_VIEWER
#include "apps/viewer/replay.h"
#endif

namespace percale::cli {
#ifdef PERCALE_HAS_VIEWER
namespace {

/// All that a session has shown, on its way into a file.
class SessionRecorder {
 public:
  explicit SessionRecorder(const std::string& output) : output_(output) {}

  /// Adds the World as it is. False: that failed.
  bool Add(const World& world) {
    if (output_.empty()) return true;
    if (!writer_) {
      auto writer = CacheWriter::Open(TextPath(output_), 1.0 / world.scene().simulation.framesPerSecond);
      if (!writer) return Fail(writer.diagnostics());
      writer_ = std::move(*writer);
    }
    const Status added = writer_->Add(world, count_++);
    return added || Fail(added.diagnostics());
  }
  bool Finish() {
    if (!writer_) return true;
    const auto files = writer_->Finish();
    return files || Fail(files.diagnostics());
  }
  bool failed() const { return failed_; }

 private:
  bool Fail(const Diagnostics& why) {
    PrintDiagnostics(why);
    failed_ = true;
    return false;
  }

  const std::string& output_;
  std::optional<CacheWriter> writer_;
  int count_ = 0;
  bool failed_ = false;
};

}  // namespace
#endif

int Replay(const Options& options) {
#ifdef PERCALE_HAS_VIEWER
  if (options.scene.empty()) {
    PrintError(
        "replay: expected a session log, such as percale replay session.log; percale view --log FILE writes one");
    return kUsage;
  }
  CatchInterrupts();
  SessionRecorder recorder(options.output);
  const auto goOn = [&](const World& world) { return recorder.Add(world) && !Interrupted(); };
  const auto root = FindRoot(options.root);
  const auto load = [&](const std::filesystem::path& file) -> Result<WorldState> {
    Result<ViewFile> opened = OpenViewFile(file, root ? *root : std::filesystem::path());
    if (!opened) return opened.diagnostics();
    if (!opened->state) return MakeError(PathText(file), "expected a checkpoint or a picture that holds a state");
    return *opened->state;
  };
  const auto replayed =
      viewer::Replay(TextPath(options.scene), {.threads = options.threads, .loadState = load, .onFrame = goOn});
  PrintDiagnostics(replayed.diagnostics());
  if (!replayed) return kInvalid;
  if (!recorder.failed()) recorder.Finish();
  if (recorder.failed()) return kFailed;
  if (Interrupted()) {
    std::fprintf(stderr, "percale: interrupted after %d commands and %d frames\n", replayed->commands,
                 replayed->frames);
    return kInterrupted;
  }
  if (!replayed->difference.empty()) {
    PrintError(replayed->difference);
    return kFailed;
  }
  std::printf("%d commands, %d frames, %d states: equal to the last bit\n", replayed->commands, replayed->frames,
              replayed->states);
  std::printf("state   %016" PRIx64 "\n", replayed->hash);
  return kDone;
#else
  static_cast<void>(options);
  PrintError("this build has no viewer, and so no session logs");
  return kNoGraphics;
#endif
}

}  // namespace percale::cli
