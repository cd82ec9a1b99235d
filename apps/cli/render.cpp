#include "apps/cli/pictures.h"
#include "apps/cli/platform.h"
#include "apps/cli/run.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"

namespace percale::cli {

int Render(const Options& options) {
  auto opened = OpenSession(options);
  if (const int* code = std::get_if<int>(&opened)) return *code;
  const Session& session = std::get<Session>(opened);
  const std::filesystem::path file = options.output.empty() ? DefaultOutput(session, ".mp4") : TextPath(options.output);
  if (!file.extension().empty() && LowerExtension(file) != ".mp4") {
    PrintError("-o: expected a name that ends in .mp4, or that of a new folder for pictures, got " +
               ShellWord(options.output));
    return kUsage;
  }
  auto studio = OpenStudio(options, session);
  if (const int* code = std::get_if<int>(&studio)) return *code;
  CatchInterrupts();
  World world = MakeWorld(options, session);
  return Film(std::get<Studio>(studio), world, options, session, file, kDefaultFrames);
}

}  // namespace percale::cli
