#include <cstdio>
#include <system_error>

#include "apps/cli/pictures.h"
#include "apps/cli/platform.h"
#include "apps/cli/run.h"
#include "apps/cli/verbs.h"
#include "apps/viewer/viewer.h"
#include "io/atomic_file.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

/// Long enough for the sheet of the default scene to fall and swing back.
constexpr int kDemonstrationFrames = 300;
constexpr const char* kDemonstrationShader = "Phong";

}  // namespace

int View(const Options& options) {
#ifdef PERCALE_HAS_VIEWER
  if (options.keys) {
    std::fputs(KeyTable().c_str(), stdout);
    return kDone;
  }
#endif
  if (options.bare && !HasDisplay() && !options.printConfig) return ShowWithoutDisplay(options);
  auto opened = OpenSession(options);
  if (const int* code = std::get_if<int>(&opened)) return *code;
  if (!HasDisplay()) {
    PrintError(
        "there is no display for a window (DISPLAY and WAYLAND_DISPLAY are not set); percale shot and percale render "
        "draw without one, and with ssh -X the window opens on your machine");
    return kNoGraphics;
  }
#ifdef PERCALE_HAS_VIEWER
  const Session& session = std::get<Session>(opened);
  const auto root = FindRoot(options.root);
  if (!root) {
    PrintDiagnostics(root.diagnostics());
    return kFailed;
  }
  ViewerOptions viewer;
  viewer.scene = session.scene;
  viewer.sceneFile = session.file;
  viewer.state = session.state;
  viewer.frame = session.frame;
  viewer.presets = session.presets;
  viewer.set = session.set;
  viewer.root = *root;
  viewer.view = MakeView(options, session.scene, session.view);
  if (!options.uniforms.empty()) {
    ShaderLibrary shaders(*root / "shaders");
    const int code = ApplyUniforms(options, shaders.Parameters(viewer.view.look.shader), viewer.view);
    if (code != kDone) return code;
  }
  viewer.keepUniforms = !options.shaderDefaults;
  viewer.wholeUniforms = session.view.has_value();
  if (options.sizeGiven) {
    viewer.width = options.width;
    viewer.height = options.height;
  }
  viewer.uiScale = options.uiScale.value_or(0);
  const fs::path config = ConfigFolder();
  if (!options.fresh && !config.empty()) viewer.settings = config / "viewer.json";
  viewer.presetFolders = PresetFolders(options);
  viewer.samples = options.samples.value_or(0);
  viewer.threads = options.threads;
  viewer.historyBudget = static_cast<std::size_t>(options.historyMegabytes * (1 << 20));
  viewer.log = TextPath(options.log);
  return RunViewer(viewer);
#else
  PrintError("this build has no viewer; percale shot and percale render draw without one");
  return kNoGraphics;
#endif
}

int ShowWithoutDisplay(const Options& options) {
  std::fprintf(stderr, "percale: there is no display for the viewer; making a picture and a video instead\n");
  Options run = options;
  if (run.shader.empty()) run.shader = kDemonstrationShader;
  run.verb = Verb::Render;
  auto opened = OpenSession(run);
  if (const int* code = std::get_if<int>(&opened)) return *code;
  const Session& session = std::get<Session>(opened);

  const fs::path folder = "out";
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) {
    PrintDiagnostics({MakeError(PathText(folder), "the folder cannot be made: " + code.message())});
    return kFailed;
  }
  auto studio = OpenStudio(run, session);
  if (const int* failure = std::get_if<int>(&studio)) return *failure;
  CatchInterrupts();
  World world = MakeWorld(run, session);
  const int filmed = Film(std::get<Studio>(studio), world, run, session, folder / DefaultOutput(session, ".mp4"),
                          kDemonstrationFrames);
  if (filmed != kDone && filmed != kInterrupted) return filmed;
  const fs::path picture = folder / DefaultOutput(session, ".png");
  if (const int failure = WritePicture(std::get<Studio>(studio), world, session, picture); failure != kDone)
    return failure;
  std::printf("%s: frame %d, %.4g s\n", PathText(picture).c_str(), world.report().frame, world.report().time);
  return filmed;
}

}  // namespace percale::cli
