#include "apps/cli/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "apps/cli/platform.h"
#include "apps/cli/progress.h"
#include "io/atomic_file.h"

namespace percale::cli {
namespace {

constexpr int kMostFrames = 100'000'000;

int FramesOf(double seconds, const Scene& scene) {
  // 3.3 s at 90 frames per second are 297, although the product may be a hair more.
  const double frames = std::ceil(seconds * scene.simulation.framesPerSecond - 1e-6);
  return int(std::clamp(frames, 0.0, double(kMostFrames)));
}

void ReportDivergence(const World& world, const RunPlan& plan, const Options& options, const Session& session) {
  const StepReport& report = world.report();
  const Divergence& divergence = *report.divergence;
  std::fflush(stdout);
  std::fprintf(stderr,
               "%s: error: the simulation diverged in step %lld (frame %d): cloth %d, vertex %d left all bounds\n",
               PathText(session.file).c_str(), static_cast<long long>(divergence.step), report.frame + 1,
               divergence.cloth, divergence.vertex);
  if (!divergence.cause.empty()) std::fprintf(stderr, "  cause: %s\n", divergence.cause.c_str());
  if (!divergence.remedy.empty()) std::fprintf(stderr, "  remedy: %s\n", divergence.remedy.c_str());
  std::fprintf(stderr, "  kept: %d good frames\n", report.frame);
  std::fprintf(stderr, "  reproduce: percale simulate %s --frames %d\n", SceneArguments(options, session).c_str(),
               report.frame + 1 - plan.firstFrame);
}

}  // namespace

World MakeWorld(const Options& options, const Session& session) {
  World world(session.state ? *session.state->scene : session.scene, {.threads = options.threads});
  if (session.state) {
    world.Restore(*session.state);
    if (!options.set.empty()) world.Apply(session.scene);
  }
  while (!session.state && world.report().frame < session.frame && !world.report().divergence && !Interrupted())
    world.Step();
  return world;
}

RunPlan PlanRun(const Options& options, const World& world, int defaultFrames) {
  const Scene& scene = world.scene();
  RunPlan plan;
  plan.firstFrame = world.report().frame;
  plan.untilRest = options.untilRest;
  plan.frames = defaultFrames;
  if (options.untilRest) plan.frames = std::max(1, FramesOf(options.limit, scene));
  const auto most = options.frames    ? options.frames
                    : options.frame   ? options.frame
                    : options.seconds ? std::optional<int>(FramesOf(*options.seconds, scene))
                                      : std::nullopt;
  if (most) plan.frames = options.untilRest ? std::min(plan.frames, *most) : *most;
  // A picture is asked for by its frame or time; all others by how much there is to do.
  if (!most || options.verb != Verb::Shot) plan.frames = std::min(plan.firstFrame + plan.frames, kMostFrames);
  return plan;
}

RunEnd Run(World& world, const RunPlan& plan, const Options& options, const Session& session,
           const std::function<int()>& onFrame, RunTotals* totals) {
  Progress progress(options.progress, std::string(VerbName(options.verb)), plan.frames);
  RunTotals ignored;
  RunTotals& sums = totals ? *totals : ignored;
  RunEnd end = RunEnd::Finished;
  if (onFrame() != kDone) return RunEnd::Failed;
  while (world.report().frame < plan.frames) {
    if (Interrupted()) {
      end = RunEnd::Interrupted;
      break;
    }
    const auto before = std::chrono::steady_clock::now();
    const StepReport& report = world.Step();
    sums.wallSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    for (std::size_t i = 0; i < sums.stageSeconds.size(); ++i) sums.stageSeconds[i] += report.stageSeconds[i];
    if (report.divergence) {
      end = RunEnd::Diverged;
      break;
    }
    sums.greatestStretch = std::max(sums.greatestStretch, report.greatestStretch);
    sums.selfContacts += report.selfContacts;
    sums.colliderContacts += report.colliderContacts;
    sums.limitedSprings += report.limitedSprings;
    sums.jumps += report.jumps;
    sums.splits += report.splits;
    if (report.contactBytes > sums.contactBytes) sums.contactsGrewIn = report.frame;
    sums.contactBytes = report.contactBytes;
    sums.mostIntersections = std::max(sums.mostIntersections, report.intersections);
    progress.Update(report);
    if (onFrame() != kDone) return RunEnd::Failed;
    if (plan.untilRest && report.atRest) {
      end = RunEnd::AtRest;
      break;
    }
  }
  progress.Finish(world.report());
  if (end == RunEnd::Diverged) {
    ReportDivergence(world, plan, options, session);
  } else if (end == RunEnd::Interrupted) {
    std::fprintf(stderr, "percale: interrupted after frame %d; what was done is kept\n", world.report().frame);
  } else if (end == RunEnd::Finished && plan.untilRest) {
    end = RunEnd::NotAtRest;
    std::fprintf(stderr,
                 "%s: warning: did not come to rest within %d frames (%.4g s); in the last one a point moved %.3g mm\n",
                 PathText(session.file).c_str(), plan.frames - plan.firstFrame, world.report().time,
                 world.report().greatestMove * 1e3);
  }
  return end;
}

int CodeOf(RunEnd end) {
  switch (end) {
    case RunEnd::Interrupted:
      return kInterrupted;
    case RunEnd::Diverged:
      return kDiverged;
    case RunEnd::Failed:
      return kFailed;
    case RunEnd::Finished:
    case RunEnd::AtRest:
    case RunEnd::NotAtRest:
      break;
  }
  return kDone;
}

}  // namespace percale::cli
