#include "apps/cli/progress.h"

#include <algorithm>
#include <cstdio>

#include "apps/cli/platform.h"
#include "apps/cli/session.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr double kInterval = 0.1;  // s

}  // namespace

Progress::Progress(ProgressKind kind, std::string what, int frames)
    : kind_(kind),
      what_(std::move(what)),
      frames_(frames),
      start_(Clock::now()),
      shown_(start_ - std::chrono::hours(1)) {
  if (kind_ == ProgressKind::Automatic) kind_ = IsTerminal(stderr) ? ProgressKind::Bar : ProgressKind::None;
}

Progress::~Progress() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void Progress::Update(const StepReport& report) {
  if (kind_ == ProgressKind::None) return;
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - shown_).count() < kInterval) return;
  shown_ = now;
  if (kind_ == ProgressKind::Json)
    ShowJson(report, false);
  else
    ShowBar(report);
}

void Progress::Finish(const StepReport& report) {
  if (kind_ == ProgressKind::Json) ShowJson(report, true);
}

void Progress::ShowJson(const StepReport& report, bool last) {
  const std::string line = Text(
      "{\"verb\": \"%s\", \"frame\": %d, \"frames\": %d, \"time\": %s, \"wall\": %.3f, "
      "\"kineticEnergy\": %s, \"greatestMove\": %s, \"atRest\": %s, \"done\": %s}\n",
      what_.c_str(), report.frame, frames_, FormatNumber(report.time).c_str(),
      std::chrono::duration<double>(Clock::now() - start_).count(), FormatNumber(report.kineticEnergy).c_str(),
      FormatNumber(report.greatestMove).c_str(), report.atRest ? "true" : "false", last ? "true" : "false");
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void Progress::ShowBar(const StepReport& report) {
  const double done = frames_ > 0 ? std::min(1.0, double(report.frame) / frames_) : 1;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::string left = what_ + " ";
  const std::string right = Text(" %d/%d  %.0f s left", report.frame, frames_, done > 0 ? elapsed / done - elapsed : 0);
  const int room = std::min(TerminalWidth() - 1 - int(left.size() + right.size()) - 2, 40);
  std::string bar;
  if (room >= 5) {
    const int full = int(done * room);
    bar = "[" + std::string(std::size_t(full), '#') + std::string(std::size_t(room - full), ' ') + "]";
  }
  std::fprintf(stderr, "\r%s%s%s\033[K", left.c_str(), bar.c_str(), right.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace percale::cli
