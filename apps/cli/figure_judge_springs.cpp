#include <algorithm>
#include <cmath>

#include "apps/cli/figure_judges.h"
#include "apps/cli/figure_studies.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr std::size_t kMoment = 120;  // frame that figures 14 and 17 show

// kDampings as curves.
constexpr NamedCourse kDampingCurves[] = {
    {"damping 0 %", kDampings[0].course},
    {"damping 0.2 %", kDampings[1].course},
    {"damping 1 %", kDampings[2].course},
};

/// How far numbers lie apart, as a share of the least.
double Spread(const std::vector<double>& numbers) {
  const auto ends = std::minmax_element(numbers.begin(), numbers.end());
  return *ends.second / *ends.first - 1;
}

/// The claim that a sweep makes no difference to the fall.
Claim EqualFalls(const char* id, bool stated, const char* statement, std::span<const SweepPoint> sweep,
                 const char* unit, const PointValue& fall) {
  const double spread = Spread(Values(sweep, fall));
  return {id,
          kIntegration,
          stated,
          statement,
          "The lowest point passes 0.2 m after " +
              List(sweep, unit, [&](const SweepPoint& p) { return Text("%.3f s", fall(p)); }) +
              Text(": they differ by %.1f %%.", 100 * spread),
          Holds(spread < 0.05),
          NamedValues(sweep, "fall_time", fall)};
}

void JudgeSagAndCreases(const Measured& measured, Findings& findings) {
  const PointValue lowest = LastOf(measured, "lowest_y"), folding = LastOf(measured, "folding");
  findings.claims.push_back(
      {"sag-ks", kIntegration, true, "The stiffer the springs, the less the sheet sags.",
       "Lowest point " + List(kStiffnesses, " N/m", [&](const SweepPoint& p) { return Meters(lowest(p)); }) + ".",
       Holds(Ascends(Values(kStiffnesses, lowest))), NamedValues(kStiffnesses, "lowest_y", lowest)});

  std::vector<double> softToStiff = Values(kStiffnesses, folding);
  std::reverse(softToStiff.begin(), softToStiff.end());
  findings.claims.push_back(
      {"creases-ks", kIntegration, false, "A stiff sheet has few creases; the softer the springs, the more.",
       "Mean angle between neighbouring squares at rest: " +
           List(kStiffnesses, " N/m", [&](const SweepPoint& p) { return Text("%.2f°", folding(p)); }) +
           ". From the softest to the stiffest it falls; where the limit on stretch holds the sheet, below 5000 N/m, "
           "the order is not strict.",
       !(folding(kStiffnesses[0]) > folding(kStiffnesses[5])) ? Verdict::Fails
       : Ascends(softToStiff)                                 ? Verdict::Holds
                                                              : Verdict::Partly,
       NamedValues(kStiffnesses, "folding", folding)});

  const double taut = lowest(kStiffnesses[5]), slack = Last(measured.at(kSlack), "lowest_y");
  findings.claims.push_back(
      {"figure-11",
       kIntegration,
       false,
       "A very high ks leaves the sheet straight; the write-up points to figure 11.",
       Text("That is figure 10, ks 100000 N/m: lowest point %.3f m. Figure 11 has ks 0 by its own caption, and hangs "
            "at %.3f m: the reference in the write-up is a slip.",
            taut, slack),
       Verdict::Partly,
       {{"lowest_y of figure 10", taut}, {"lowest_y of figure 11", slack}}});
}

void JudgeOscillation(const Measured& measured, Findings& findings) {
  const auto rest = [&](const SweepPoint& point) { return RestTime(measured.at(point.course)); };
  const auto soft = rest(kStiffnesses[1]), usual = rest(kStiffnesses[3]), stiff = rest(kStiffnesses[5]);
  const double length = Last(measured.at(kStiffnesses[1].course), "time");
  const auto say = [&](const SweepPoint& point) {
    const auto time = rest(point);
    return time ? Text("%.2f s", *time) : Text("more than %.1f s", length);
  };
  findings.claims.push_back(
      {"oscillation-ks",
       kIntegration,
       false,
       "A soft sheet goes on oscillating for longer than a stiff one.",
       "At rest after: " + List(kStiffnesses, " N/m", say) +
           ". Soft sheets tremble on: the limit on stretch pulls at them in every step.",
       Holds(soft.value_or(INFINITY) > stiff.value_or(INFINITY) || (usual && stiff && *usual > *stiff)),
       {{"rest at 500", soft.value_or(-1)},
        {"rest at 5000", usual.value_or(-1)},
        {"rest at 100000", stiff.value_or(-1)}}});
}

void JudgeDensity(const Measured& measured, Findings& findings) {
  const PointValue lowest = LastOf(measured, "lowest_y"), folding = LastOf(measured, "folding");
  findings.claims.push_back(
      {"sag-density", kIntegration, false, "A denser sheet sags deeper.",
       "Lowest point " + List(kDensities, " g/cm²", [&](const SweepPoint& p) { return Meters(lowest(p)); }) + ".",
       Holds(lowest(kDensities[0]) > lowest(kDensities[2]) && lowest(kDensities[2]) > lowest(kDensities[5])),
       NamedValues(kDensities, "lowest_y", lowest)});

  const double light = folding(kDensities[0]), heavy = folding(kDensities[3]);
  findings.claims.push_back({"folds-density", kIntegration, false,
                             "At 100 g/cm² (figure 16) there are more folds than at 1 g/cm² (figure 13).",
                             Text("Mean angle between neighbouring squares: %.2f° against %.2f°.", heavy, light),
                             Holds(heavy > light), NamedValues(kDensities, "folding", folding)});

  const double farthest = measured.at(kRatioStudy).At(0, "farthest");
  findings.claims.push_back({"ratio",
                             kIntegration,
                             true,
                             "Density and ks trade off: an equal ks / density gives an equal shape at rest.",
                             "5000 N/m at 5 g/cm² and 1000 N/m at 1 g/cm²: no point of one is farther than " +
                                 Small(farthest) + " from its place in the other.",
                             Holds(farthest < 1e-6),
                             {{"farthest", farthest}}});
}

void JudgeNoDamping(const Measured& measured, Findings& findings) {
  const Table& undamped = measured.at(kDampings[0].course);
  const double move = ResidualMotion(undamped), energy = Last(undamped, "kinetic_energy");
  const std::string usual = Seconds(RestTime(measured.at(kDampings[1].course)));
  findings.claims.push_back(
      {"damping-0",
       kIntegration,
       true,
       "Without damping the sheet never comes to rest.",
       Text("After %.1f s a point still moves %s in a frame, and %.2f J of kinetic energy are left; with damping 0.2 "
            "the sheet was at rest after %s.",
            Last(undamped, "time"), Small(move).c_str(), energy, usual.c_str()),
       Holds(!RestTime(undamped) && move > 5e-3),
       {{"move", move}, {"kinetic_energy", energy}}});
}

void JudgeHighDamping(const Measured& measured, Findings& findings) {
  const PointValue fall = FallTimeOf(measured);
  const double slow = fall(kDampings[2]) / fall(kDampings[1]);
  findings.claims.push_back({"damping-1",
                             kIntegration,
                             true,
                             "High damping makes the sheet fall much slower.",
                             "The lowest point passes 0.2 m after " +
                                 List(kDampings, " %", [&](const SweepPoint& p) { return Text("%.2f s", fall(p)); }) +
                                 Text(": %.1f times as long at 1 %% as at 0.2 %%.", slow),
                             Holds(slow > 2),
                             {{"times slower", slow}}});

  const Table& damped = measured.at(kDampings[2].course);
  const double waves = measured.at(kDampings[0].course).At(kMoment, "folding"), smooth = damped.At(kMoment, "folding");
  findings.claims.push_back(
      {"damping-creases",
       kIntegration,
       false,
       "High damping smooths the sheet (figures 14 and 17).",
       Text("1.33 s after the start the mean angle between neighbouring squares is %.2f° without damping and %.2f° at "
            "1 %%.",
            waves, smooth),
       Holds(smooth < waves),
       {{"folding at 0", waves}, {"folding at 1", smooth}}});

  const auto rest = RestTime(damped);
  const double move = ResidualMotion(damped);
  findings.claims.push_back(
      {"damping-waves",
       kIntegration,
       false,
       "At high damping small waves run through the sheet without ever stopping.",
       Text("At 1 %% the sheet comes to rest after %s; over the last second no point moves more than %s in a frame.",
            Seconds(rest).c_str(), Small(move).c_str()),
       Holds(!rest && move > 1e-4),
       {{"rest", rest.value_or(-1)}, {"move", move}}});
}

void PlotSweeps(const Measured& measured, Findings& findings) {
  const PointValue lowest = LastOf(measured, "lowest_y"), fall = FallTimeOf(measured);
  const auto plot = [&](const char* title, std::span<const SweepPoint> sweep, const char* x, const Axis& y,
                        const PointValue& value) {
    findings.plots.push_back({kIntegration, {title, {x, true, {}, {}}, y, {SweepSeries(title, sweep, value)}}});
  };
  const Axis sag = {"lowest point [m]", false, {}, {}};
  plot("Sag against ks (pinned2, 15 g/cm²)", kStiffnesses, "ks [N/m]", sag, lowest);
  plot("Sag against density (pinned2, 5000 N/m)", kDensities, "density [g/cm²]", sag, lowest);
  plot("Fall time against ks (pinned2)", kStiffnesses, "ks [N/m]", {"time until 0.2 m [s]", false, 0.0, {}}, fall);
}

void PlotDampings(const Measured& measured, Findings& findings) {
  Plot energy = CoursePlot(measured, kDampingCurves, "kinetic_energy");
  energy.title = "Kinetic energy (pinned2)";
  energy.y = {"kinetic energy [J]", true, 1e-8, {}};
  findings.plots.push_back({kIntegration, std::move(energy)});
  Plot height = CoursePlot(measured, kDampingCurves, "lowest_y");
  height.title = "The fall (pinned2)";
  height.y.label = "lowest point [m]";
  findings.plots.push_back({kIntegration, std::move(height)});
}

}  // namespace

void JudgeMasses(const Measured& measured, Findings& findings) {
  const Table& springs = measured.at(kSpringsStudy);
  const double all = springs.At(0, "all"), square = springs.At(0, "no_shearing"), only = springs.At(0, "only_shearing");
  findings.claims.push_back(
      {"springs",
       kMasses,
       false,
       "Springs go only where both ends exist, and their kinds can be told apart.",
       Text("The sheet of 50 x 50 points has %.0f springs: %.0f without the shearing ones (structural and bending), "
            "%.0f shearing springs alone.",
            all, square, only),
       Holds(square + only == all),
       {{"all", all}, {"no shearing", square}, {"only shearing", only}}});
}

void JudgeIntegration(const Measured& measured, Findings& findings) {
  const PointValue fall = FallTimeOf(measured);
  JudgeSagAndCreases(measured, findings);
  findings.claims.push_back(
      EqualFalls("fall-ks", true, "The fall takes almost the same time whatever ks.", kStiffnesses, " N/m", fall));
  JudgeOscillation(measured, findings);
  findings.claims.push_back(EqualFalls(
      "fall-density", false, "Density makes no difference to how fast the sheet falls.", kDensities, " g/cm²", fall));
  JudgeDensity(measured, findings);
  JudgeNoDamping(measured, findings);
  JudgeHighDamping(measured, findings);
  PlotSweeps(measured, findings);
  PlotDampings(measured, findings);
}

}  // namespace percale::cli
