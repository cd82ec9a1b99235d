#include <cstdio>

#include "apps/cli/pictures.h"
#include "apps/cli/platform.h"
#include "apps/cli/run.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"

namespace percale::cli {

namespace fs = std::filesystem;

int Shot(const Options& asked) {
  auto opened = OpenSession(asked);
  if (const int* code = std::get_if<int>(&opened)) return *code;
  const Session& session = std::get<Session>(opened);
  Options options = asked;
  if (!asked.sizeGiven && session.width > 0) {  // A picture is drawn again as large as it is.
    options.width = session.width;
    options.height = session.height;
  }

  const fs::path file = options.output.empty() ? DefaultOutput(session, ".png") : TextPath(options.output);
  if (LowerExtension(file) != ".png" && options.output.rfind("/dev/", 0) != 0) {
    PrintError("-o: expected a name that ends in .png (or a whole number, the longitudes of spheres), got " +
               ShellWord(PathText(file)));
    return kUsage;
  }
  if (const int code = CheckWritable(file); code != kDone) return code;
  auto studio = OpenStudio(options, session);
  if (const int* code = std::get_if<int>(&studio)) return *code;

  CatchInterrupts();
  World world = MakeWorld(options, session);
  const RunPlan plan = PlanRun(options, world, 0);
  if (plan.frames < plan.firstFrame) {
    PrintError(PathText(session.file) + " stands at frame " + std::to_string(plan.firstFrame) +
               "; there is no way back to frame " + std::to_string(plan.frames));
    return kUsage;
  }
  const RunEnd end = Run(world, plan, options, session, [] { return int(kDone); });
  if (const int code = WritePicture(std::get<Studio>(studio), world, session, file); code != kDone) return code;
  std::fprintf(options.output == "/dev/stdout" ? stderr : stdout, "%s: frame %d, %.4g s%s\n", PathText(file).c_str(),
               world.report().frame, world.report().time, world.report().atRest ? ", at rest" : "");
  return CodeOf(end);
}

}  // namespace percale::cli
