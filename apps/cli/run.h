#pragma once
/// \file
/// Running a scene frame by frame, as simulate, shot and render do.

#include <array>
#include <functional>
#include <string>

#include "apps/cli/options.h"
#include "apps/cli/session.h"
#include "percale/world.h"

namespace percale::cli {

/// The World of the session: at its start, or where its checkpoint or picture stands.
World MakeWorld(const Options& options, const Session& session);

constexpr int kDefaultFrames = 300;  // of a simulation or a film whose options state none

/// How long to run.
struct RunPlan {
  int firstFrame = 0;  ///< The World stands there.
  int frames = 0;      ///< The last one, at most, counted from the start.
  bool untilRest = false;
};

/// The plan that the options state for a World as it stands; `defaultFrames` more where they state none.
RunPlan PlanRun(const Options& options, const World& world, int defaultFrames);

enum class RunEnd {
  Finished,     ///< All frames done.
  AtRest,       ///< Came to rest.
  NotAtRest,    ///< Was to come to rest, and did not within the limit.
  Interrupted,  ///< Ctrl+C.
  Diverged,     ///< The World stands at its last good frame.
  Failed,       ///< The receiver of the frames could not go on, and has said why.
};

/// What the frames of a run add up to.
struct RunTotals {
  std::array<double, kStageCount> stageSeconds{};
  double wallSeconds = 0;  ///< Of the steps alone.
  double greatestStretch = 0;
  std::int64_t selfContacts = 0, colliderContacts = 0, limitedSprings = 0;
  std::int64_t jumps = 0, mostIntersections = 0, splits = 0;
  std::int64_t contactBytes = 0;  // as they were last,
  int contactsGrewIn = 0;         // and since which frame
};

/// Gives frame 0 and then each frame to `onFrame`, which returns an exit code, kDone to go on.
/// A divergence is reported on stderr with the command that reproduces it.
RunEnd Run(World& world, const RunPlan& plan, const Options& options, const Session& session,
           const std::function<int()>& onFrame, RunTotals* totals = nullptr);

/// The exit code that belongs to the end of a run (kDone for those that are no failure). What
/// onFrame returned belongs to RunEnd::Failed.
int CodeOf(RunEnd end);

}  // namespace percale::cli
