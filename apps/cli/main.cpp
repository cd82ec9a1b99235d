#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>

#include "apps/cli/options.h"
#include "apps/cli/platform.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"

namespace percale::cli {
namespace {

int RunVerb(const Options& options) {
  switch (options.verb) {
    case Verb::View:
      return View(options);
    case Verb::Simulate:
      return Simulate(options);
    case Verb::Shot:
      return Shot(options);
    case Verb::Render:
      return Render(options);
    case Verb::Replay:
      return Replay(options);
    case Verb::Figures:
      return Figures(options);
    case Verb::Check:
      return Check(options);
    case Verb::Verify:
      return Verify(options);
    case Verb::Info:
      return Info(options);
    case Verb::Doctor:
      return Doctor(options);
    case Verb::Bench:
      return Bench(options);
    case Verb::Version:
      return Version();
  }
  return kUsage;
}

int Main(int argc, char** argv) {
  LetWritesFail();
  int code = kFailed;
  try {
    const auto parsed = ParseCommandLine(Utf8Arguments(argc, argv));
    code = std::holds_alternative<int>(parsed) ? std::get<int>(parsed) : RunVerb(std::get<Options>(parsed));
  } catch (const std::bad_alloc&) {
    PrintError("there is not enough memory; use fewer points");
    code = kFailed;
  } catch (const std::exception& error) {
    PrintError(std::string("unexpected: ") + error.what());
    code = kFailed;
  }
  // Buffered output may fail only now. A reader that has seen enough and closed the pipe is no failure.
  errno = 0;
  if ((std::fflush(stdout) != 0 || std::ferror(stdout)) && errno != EPIPE) {
    PrintError("standard output cannot be written");
    if (code == kDone) code = kFailed;
  }
  return code;
}

}  // namespace
}  // namespace percale::cli

int main(int argc, char** argv) {
  return percale::cli::Main(argc, argv);
}
