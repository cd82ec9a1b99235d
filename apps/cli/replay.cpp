#include <cinttypes>
#include <cstdio>

#include "apps/cli/platform.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "render/view_file.h"
#ifdef PERCALE_HAS_VIEWER
#include "apps/viewer/replay.h"
#endif

namespace percale::cli {

int Replay(const Options& options) {
#ifdef PERCALE_HAS_VIEWER
  if (options.scene.empty()) {
    PrintError(
        "replay: expected a session log, such as percale replay session.log; percale view --log FILE writes one");
    return kUsage;
  }
  CatchInterrupts();
  const auto goOn = [](const World&) { return !Interrupted(); };
  const auto load = [](const std::filesystem::path& file) -> Result<WorldState> {
    Result<ViewFile> opened = OpenViewFile(file);
    if (!opened) return opened.diagnostics();
    if (!opened->state) return MakeError(PathText(file), "expected a checkpoint or a picture that holds a state");
    return *opened->state;
  };
  const auto replayed =
      viewer::Replay(TextPath(options.scene), {.threads = options.threads, .loadState = load, .onFrame = goOn});
  PrintDiagnostics(replayed.diagnostics());
  if (!replayed) return kInvalid;
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
