#include "apps/cli/figure_judges.h"
#include "apps/cli/figure_studies.h"
#include "core/text.h"

namespace percale::cli {
namespace {

void JudgeResolution(const Table& sphere, Findings& findings) {
  const auto coarse = [&](const char* column) { return sphere.At(0, column); };
  const auto fine = [&](const char* column) { return Last(sphere, column); };
  const double coarseError = coarse("displaced_rms"), fineError = fine("displaced_rms");
  const double coarseChange = coarse("displacement_change"), fineChange = fine("displacement_change");
  findings.claims.push_back(
      {"displacement-resolution",
       kShaders,
       true,
       "Displacement mapping gains much from a finer sphere.",
       Text("The drawn surface departs from the exact displaced one by %.1f mm (root mean square) at 16 x 16 and %.1f "
            "mm at 128 x 128; the picture from that of a sphere too fine to tell by %.1f and %.1f levels of 255.",
            1e3 * coarseError, 1e3 * fineError, coarseChange, fineChange),
       Holds(coarseChange / fineChange > 3 && fineError < coarseError),
       {{"rms at 16", coarseError},
        {"rms at 128", fineError},
        {"change at 16", coarseChange},
        {"change at 128", fineChange}}});

  const double coarseBump = coarse("bump_change"), fineBump = fine("bump_change");
  findings.claims.push_back(
      {"bump-resolution",
       kShaders,
       true,
       "Bump mapping gains nothing from a finer sphere.",
       Text("Away from its outline the picture changes by %.2f levels of 255 at 16 x 16 and %.2f at 128 x 128: nobody "
            "sees it. Only the outline has corners at 16.",
            coarseBump, fineBump),
       Holds(coarseBump < 2),
       {{"change at 16", coarseBump}, {"change at 128", fineBump}}});
}

void JudgeLight(const Table& light, Findings& findings) {
  const double difference = light.At(0, "difference"), colors = light.At(0, "ambient_colors");
  findings.claims.push_back(
      {"blinn-phong",
       kShaders,
       false,
       "Ambient light gives every place the same colour, and the three kinds of light simply add up.",
       Text("Figure 31 has %.0f colour%s on the cloth. The sum of figures 31, 32 and 33 differs from figure 34 by at "
            "most %.0f of 255, which is rounding. The write-up calls all four figure 31 in its text.",
            colors, colors == 1 ? "" : "s", difference),
       Holds(colors == 1 && difference <= 2),
       {{"difference", difference}, {"ambient colours", colors}}});
}

Series ResolutionSeries(const Table& sphere, const char* name, const char* column, double scale) {
  Series series{name, {}, true};
  for (std::size_t i = 0; i < sphere.rows.size(); ++i)
    series.points.push_back({sphere.At(i, "resolution"), scale * sphere.At(i, column)});
  return series;
}

void PlotResolution(const Table& sphere, Findings& findings) {
  findings.plots.push_back({kShaders,
                            {"The drawn surface against the exact one (sphere)",
                             {"latitudes and longitudes", true, {}, {}},
                             {"distance, root mean square [mm]", true, {}, {}},
                             {ResolutionSeries(sphere, "displaced", "displaced_rms", 1e3),
                              ResolutionSeries(sphere, "not displaced (bump)", "smooth_rms", 1e3)}}});
  findings.plots.push_back({kShaders,
                            {"The picture against that of a very fine sphere",
                             {"latitudes and longitudes", true, {}, {}},
                             {"mean difference per pixel, of 255", false, 0.0, {}},
                             {ResolutionSeries(sphere, "Displacement", "displacement_change", 1),
                              ResolutionSeries(sphere, "Bump", "bump_change", 1)}}});
}

PartTable ResolutionTable(const Table& sphere) {
  PartTable table{
      kShaders,
      "What a finer sphere gains",
      {"-a, -o", "displaced surface, rms", "greatest", "smooth surface, rms", "picture, Displacement", "Bump"},
      {}};
  for (std::size_t i = 0; i < sphere.rows.size(); ++i) {
    const auto at = [&](const char* column) { return sphere.At(i, column); };
    table.rows.push_back({Text("%.0f", at("resolution")), Text("%.2f mm", 1e3 * at("displaced_rms")),
                          Text("%.1f mm", 1e3 * at("displaced_max")), Text("%.3f mm", 1e3 * at("smooth_rms")),
                          Text("%.2f of 255", at("displacement_change")), Text("%.2f of 255", at("bump_change"))});
  }
  return table;
}

}  // namespace

void JudgeShaders(const Measured& measured, Findings& findings) {
  const Table& sphere = measured.at(kSphereStudy);
  JudgeResolution(sphere, findings);
  JudgeLight(measured.at(kLightStudy), findings);
  PlotResolution(sphere, findings);
  findings.tables.push_back(ResolutionTable(sphere));
}

}  // namespace percale::cli
