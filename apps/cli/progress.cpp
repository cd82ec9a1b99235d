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

/// Whether the next is to be shown; if so, it counts as shown.
bool Progress::IsDue() {
  if (kind_ == ProgressKind::None) return false;
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - shown_).count() < kInterval) return false;
  shown_ = now;
  return true;
}

double Progress::Elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::Update(const StepReport& report) {
  if (!IsDue()) return;
  if (kind_ == ProgressKind::Json)
    ShowJson(report, false);
  else
    ShowBar(report.frame);
}

void Progress::Finish(const StepReport& report) {
  if (kind_ == ProgressKind::Json) ShowJson(report, true);
}

void Progress::Update(int done) {
  if (!IsDue()) return;
  if (kind_ == ProgressKind::Json)
    ShowJson(done, false);
  else
    ShowBar(done);
}

void Progress::Finish(int done) {
  if (kind_ == ProgressKind::Json) ShowJson(done, true);
}

void Progress::ShowJson(const StepReport& report, bool last) {
  const std::string line = Text(
      "{\"verb\": \"%s\", \"frame\": %d, \"frames\": %d, \"time\": %s, \"wall\": %.3f, "
      "\"kineticEnergy\": %s, \"greatestMove\": %s, \"atRest\": %s, \"done\": %s}\n",
      what_.c_str(), report.frame, frames_, FormatNumber(report.time).c_str(), Elapsed(),
      FormatNumber(report.kineticEnergy).c_str(), FormatNumber(report.greatestMove).c_str(),
      report.atRest ? "true" : "false", last ? "true" : "false");
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void Progress::ShowJson(int done, bool last) {
  std::fprintf(stderr, "{\"verb\": \"%s\", \"progress\": %.4f, \"wall\": %.3f, \"done\": %s}\n", what_.c_str(),
               frames_ > 0 ? double(done) / frames_ : 1.0, Elapsed(), last ? "true" : "false");
  std::fflush(stderr);
}

void Progress::ShowBar(int count) {
  const double done = frames_ > 0 ? std::min(1.0, double(count) / frames_) : 1;
  const double elapsed = Elapsed();
  const std::string left = what_ + " ";
  const std::string right = Text(" %d/%d  %.0f s left", count, frames_, done > 0 ? elapsed / done - elapsed : 0);
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
