#include "apps/cli/bench_page.h"

#include <algorithm>

#include "apps/cli/figure_plot.h"
#include "apps/cli/html.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr double kLeastError = 1e-4;  // shown: below, the converged run has no more digits
constexpr double kMostError = 10;

/// Error against time of all methods on one sheet.
Plot ErrorAgainstTime(const bench::FabricTable& table) {
  Plot plot;
  plot.title = Text("%d × %d vertices, %g times cotton's stiffness", table.side, table.side, table.stiffness);
  plot.x = {.label = "time per frame, one thread [ms]", .logarithmic = true, .min = {}, .max = {}};
  plot.y = {.label = "error of the stretch", .logarithmic = true, .min = kLeastError, .max = kMostError};
  for (const bench::FabricRun& run : table.runs) {
    if (plot.series.empty() || plot.series.back().name != run.method) plot.series.push_back({run.method, {}, true});
    plot.series.back().points.push_back({run.milliseconds, std::clamp(run.error, kLeastError, kMostError)});
  }
  return plot;
}

Plot CostPerVertex(const bench::FabricBench& bench) {
  Plot plot;
  plot.title = "Time per vertex and frame at the defaults";
  plot.x = {.label = "vertices", .logarithmic = true, .min = {}, .max = {}};
  plot.y = {.label = "ns per vertex", .logarithmic = false, .min = 0, .max = {}};
  plot.series = {{"one thread", {}, true}, {std::to_string(bench.threads) + " threads", {}, true}};
  for (const bench::FabricScale& scale : bench.scales) {
    const double vertices = static_cast<double>(scale.side) * scale.side;
    plot.series[0].points.push_back({vertices, scale.one});
    plot.series[1].points.push_back({vertices, scale.many});
  }
  if (bench.threads == 1) plot.series.pop_back();
  return plot;
}

std::string FormatTargets(const bench::FabricBench& bench) {
  std::string html = "<div class=\"scroll\"><table class=\"overview\">\n";
  html += "<tr><th>target</th><th>goal</th><th>measured</th><th></th></tr>\n";
  for (const bench::FabricTarget& target : bench.Targets()) {
    html += Text("<tr class=\"%s\">", target.holds ? "holds" : "fails") + Element("td", target.what) +
            Element("td", target.goal) + Element("td", target.measured) + "<td class=\"verdict\">" +
            (target.holds ? "holds" : "MISSED") + "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string FormatBenchPage(const bench::FabricBench& bench, const std::string& version) {
  std::string html =
      OpenPage("Percale: speed of the fabric engine", "Speed of the fabric engine") + "<p class=\"lead\">";
  html += EscapeHtml(
      Text("Percale %s. A square metre of cloth falls into its weight, held along a tenth of its upper edge at either "
           "corner. Errors are those of the 99th-percentile stretch beyond 1, against a run that was iterated until "
           "nothing changed. All numbers come from one run of the program; compare them with each other, not with "
           "those of another machine.",
           version.c_str()));
  html += "</p>\n" + FormatTargets(bench) + "<h2>Error against time</h2>\n<div class=\"plots\">\n";
  for (const bench::FabricTable& table : bench.tables) html += FormatSvg(ErrorAgainstTime(table));
  html += "</div>\n<h2>Cost per vertex</h2>\n<div class=\"plots\">\n" + FormatSvg(CostPerVertex(bench)) + "</div>\n";
  html += "<h2>All numbers</h2>\n" + Element("pre", bench::FormatTables(bench));
  return html.append(ClosePage());
}

std::vector<std::pair<std::string, std::string>> FormatBenchPlots(const bench::FabricBench& bench) {
  std::vector<std::pair<std::string, std::string>> plots;
  const bench::FabricTable* largest = nullptr;  // of cotton as it is
  for (const bench::FabricTable& table : bench.tables) {
    if (table.stiffness == 1 && (!largest || table.side > largest->side)) largest = &table;
  }
  if (largest) plots.emplace_back("fabric_error.svg", FormatSvgFile(ErrorAgainstTime(*largest)));
  plots.emplace_back("fabric_cost.svg", FormatSvgFile(CostPerVertex(bench)));
  return plots;
}

}  // namespace percale::cli
