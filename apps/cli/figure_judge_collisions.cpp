#include <algorithm>
#include <array>

#include "apps/cli/figure_judges.h"
#include "apps/cli/session.h"

namespace percale::cli {

void JudgeColliders(const Measured& measured, Findings& findings) {
  const PointValue lowest = LastOf(measured, "lowest_y");
  findings.claims.push_back(
      {"sphere-ks",
       kColliders,
       true,
       "On the sphere ks 500 hangs lower than 50000: relaxed against tight.",
       "Hem at " + List(kDrapes, " N/m", [&](const SweepPoint& p) { return Meters(lowest(p)); }) + ".",
       Holds(Ascends(Values(kDrapes, lowest))),
       {{"lowest_y at 500", lowest(kDrapes[0])}, {"lowest_y at 50000", lowest(kDrapes[2])}}});

  std::array<double, std::size(kPlanes)> moves;
  std::vector<std::string> said;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    moves[i] = ResidualMotion(measured.at(kPlanes[i].course));
    said.push_back(Small(moves[i]) + " per frame with \"" + kPlanes[i].name + "\"");
  }
  const bool twoMove = std::min(moves[0], moves[1]) > 1e-4, thirdRests = moves[2] < 1e-4;
  findings.claims.push_back(
      {"plane-rest",
       kColliders,
       false,
       "Of the three ways to put a point back above the plane, the first two keep a resting sheet moving in every "
       "step, and the third does not.",
       "Once down, the point that moves most goes " + Joined(said) + " (mean of the last second).",
       twoMove && thirdRests   ? Verdict::Holds
       : twoMove || thirdRests ? Verdict::Partly
                               : Verdict::Fails,
       {{"interpolate", moves[0]}, {"offset", moves[1]}, {"hold", moves[2]}}});

  findings.plots.push_back({kColliders,
                            {"Hem of the drape against ks (sphere)",
                             {"ks [N/m]", true, {}, {}},
                             {"lowest point [m]", false, {}, {}},
                             {SweepSeries("lowest point", kDrapes, lowest)}}});
  Plot motion = CoursePlot(measured, kPlanes, "move");
  motion.title = "Motion on the plane, by response";
  motion.y = {"farthest way of a point in a frame [m]", true, 1e-8, {}};
  findings.plots.push_back({kColliders, std::move(motion)});
}

}  // namespace percale::cli
