#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "apps/cli/platform.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "percale/scene_file.h"
#include "render/child_process.h"
#include "render/gl_device.h"
#include "render/headless.h"
#include "render/shader_library.h"
#include "springs/kernels.h"

namespace percale::cli {
namespace {

std::string Compiler() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#elif defined(__GNUC__)
  return std::string("g++ ") + __VERSION__;
#elif defined(_MSC_VER)
  return "MSVC " + std::to_string(_MSC_VER);
#else
  return "unknown";
#endif
}

/// Prints what was found, line by line, and remembers whether all that is needed is there.
class Report {
 public:
  void Good(const char* what, const std::string& found) { Line("ok", what, found); }
  void Wanted(const char* what, const std::string& found) { Line("note", what, found); }
  void Missing(const char* what, const std::string& found) {
    Line("MISSING", what, found);
    complete_ = false;
  }
  bool complete() const { return complete_; }

 private:
  static void Line(const char* mark, const char* what, const std::string& found) {
    std::printf("%-8s %-14s %s\n", mark, what, found.c_str());
  }
  bool complete_ = true;
};

std::string OneLine(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += (text.empty() ? "" : "; ") + diagnostic.message;
  return text;
}

}  // namespace

int Doctor(const Options& options) {
  Report report;
  report.Good("version", std::string("percale ") + PERCALE_VERSION + ", " + PERCALE_BUILD_TYPE + " build");
  report.Good("system", SystemName());
  report.Good("compiler", Compiler());
  const unsigned cores = std::thread::hardware_concurrency();
  report.Good("cores", cores > 0 ? std::to_string(cores) : "unknown");
  report.Good("threads", PERCALE_THREADS);
  report.Good("instructions", springs::BestKernels().name);

  const auto root = FindRoot(options.root);
  if (root) {
    std::error_code code;
    report.Good("project", PathText(std::filesystem::absolute(*root, code).lexically_normal()));
    const auto shaders = ListShaders(*root / "shaders");
    if (shaders.empty())
      report.Missing("shaders", "there are no .frag files in " + PathText(*root / "shaders"));
    else
      report.Good("shaders", std::to_string(shaders.size()));
    const auto scene = LoadScene(*root / "scene" / "pinned2.json");
    if (scene)
      report.Good("scenes", "the default scene loads");
    else
      report.Missing("scenes", OneLine(scene.diagnostics()));
  } else {
    report.Missing("project", OneLine(root.diagnostics()));
  }

  auto context = HeadlessContext::Create();
  if (context) {
    const GraphicsInfo graphics = DescribeGraphics();
    report.Good("graphics", "OpenGL " + graphics.version + ", " + graphics.renderer +
                                (graphics.software ? " (drawn by the processor)" : "") + ", up to " +
                                std::to_string(graphics.maxSamples) + " samples per pixel");
  } else {
    report.Missing("graphics", OneLine(context.diagnostics()) + "; pictures and videos need it, simulate does not");
  }
  if (HasDisplay())
    report.Good("display",
                Environment("WAYLAND_DISPLAY").value_or(Environment("DISPLAY").value_or("the system's own")));
  else
    report.Wanted("display", "none (DISPLAY and WAYLAND_DISPLAY are not set): view needs one; shot and render do not");
  if (const auto ffmpeg = FindProgram("ffmpeg"); !ffmpeg.empty())
    report.Good("ffmpeg", PathText(ffmpeg));
  else
    report.Wanted("ffmpeg",
                  "not found: render writes numbered pictures instead of videos; on Debian: apt-get install ffmpeg");
  return report.complete() ? kDone : kFailed;
}

}  // namespace percale::cli
