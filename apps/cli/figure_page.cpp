#include "apps/cli/figure_page.h"

#include <algorithm>
#include <cmath>

#include "apps/cli/html.h"
#include "apps/cli/session.h"
#include "core/base64.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --page: #fbfaf7; --card: #fff; --ink: #1d2126; --soft: #5c646e; --line: #dcd9d2;
  --holds: #00664a; --partly: #8a5a00; --fails: #a8321a; --s0: #0072b2; --s1: #d55e00; --s2: #009e73; --s3: #b0568f;
  --s4: #b98300; --s5: #3c6fc9; }
@media (prefers-color-scheme: dark) { :root { --page: #15181b; --card: #1e2226; --ink: #e8e6e1; --soft: #a4abb3;
  --line: #373d43; --holds: #4cc9a0; --partly: #e6b34a; --fails: #f28b70; --s0: #56b4e9; --s1: #f08a48; --s2: #3fc79b;
  --s3: #dd93c0; --s4: #e6b84a; --s5: #8fb0f0; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 84rem; margin: 0 auto; padding: 1.5rem clamp(.8rem, 3vw, 2.5rem) 4rem; }
h1 { font-size: clamp(1.6rem, 4vw, 2.3rem); line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.45rem; margin: 3rem 0 .8rem; border-bottom: 2px solid var(--line); padding-bottom: .3rem; }
h3 { font-size: 1.1rem; margin: 2rem 0 .6rem; }
p.lead, .soft { color: var(--soft); }
a { color: var(--s0); }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .4rem 1.2rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 24rem), 1fr)); gap: 1.2rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #404040; }
figcaption { padding: .8rem 1rem 1rem; }
figcaption b { font-weight: 650; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem .9rem; margin: .7rem 0; font-size: .9rem; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
pre { margin: .6rem 0 0; padding: .6rem .7rem; overflow-x: auto; background: var(--page); border: 1px solid var(--line);
  border-radius: .4rem; font: .78rem/1.45 ui-monospace, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
.claim { background: var(--card); border: 1px solid var(--line); border-left: .35rem solid var(--line);
  border-radius: .4rem; padding: .6rem 1rem; margin: .6rem 0; }
.claim p { margin: .25rem 0; }
.claim.holds { border-left-color: var(--holds); }
.claim.partly { border-left-color: var(--partly); }
.claim.fails { border-left-color: var(--fails); }
.verdict { font-weight: 650; white-space: nowrap; }
.holds .verdict { color: var(--holds); }
.partly .verdict { color: var(--partly); }
.fails .verdict { color: var(--fails); }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 30rem), 1fr)); gap: 1.2rem; margin: 1.2rem 0; }
.plot { display: block; width: 100%; height: auto; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; }
.plot text { fill: var(--ink); font: 13px system-ui, sans-serif; }
.plot .title { font-weight: 650; font-size: 15px; }
.plot .grid { stroke: var(--line); stroke-width: 1; }
.plot .axis { stroke: var(--soft); stroke-width: 1.2; }
.plot path { fill: none; stroke-width: 2; stroke-linejoin: round; }
.plot .s0 path { stroke: var(--s0); } .plot .s0 .mark { fill: var(--s0); }
.plot .s1 path { stroke: var(--s1); stroke-dasharray: 7 3; } .plot .s1 .mark { fill: var(--s1); }
.plot .s2 path { stroke: var(--s2); stroke-dasharray: 2 3; } .plot .s2 .mark { fill: var(--s2); }
.plot .s3 path { stroke: var(--s3); } .plot .s4 path { stroke: var(--s4); } .plot .s5 path { stroke: var(--s5); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .4rem 0 1rem; font-size: .92rem; }
caption { text-align: left; font-weight: 650; padding: .4rem 0; }
th, td { padding: .35rem .8rem; border-bottom: 1px solid var(--line); text-align: right; font-variant-numeric: tabular-nums; }
td { white-space: nowrap; }
th { vertical-align: bottom; color: var(--soft); font-weight: 550; }
th:first-child, td:first-child { text-align: left; }
.overview td { text-align: left; white-space: normal; }
)";

std::string Element(const char* name, const std::string& text) {
  return Text("<%s>", name) + EscapeHtml(text) + Text("</%s>", name);
}

const char* VerdictClass(Verdict verdict) {
  return verdict == Verdict::Holds ? "holds" : verdict == Verdict::Partly ? "partly" : "fails";
}

/// "0.5 mm", "a whole second" and the like are for people: the same numbers stand in figures.json.
std::vector<std::pair<std::string, std::string>> MeasuredText(const ShownFigure& shown) {
  const Table& course = shown.course;
  const std::size_t row = course.rows.size() - 1;
  std::vector<std::pair<std::string, std::string>> lines = {
      {"lowest y", Text("%.4f m", course.At(row, "lowest_y"))},
      {"greatest stretch", Text("%.4f", course.At(row, "stretch"))},
  };
  if (row == 0) return lines;
  const auto rest = RestTime(course);
  lines.push_back({"at rest", rest ? Text("after %.2f s", *rest) : "not yet"});
  lines.push_back(
      {"residual motion", Text("%.2g mm per frame, mean of a second at most", 1e3 * ResidualMotion(course))});
  lines.push_back({"kinetic energy", Text("%.3g J", course.At(row, "kinetic_energy"))});
  return lines;
}

std::string FormatFigure(const ShownFigure& shown, int width, int height) {
  const Figure& figure = *shown.figure;
  std::string html =
      Text("<figure id=\"figure-%d\">\n<img width=\"%d\" height=\"%d\" alt=\"", figure.number, width, height) +
      EscapeHtml(figure.caption) + "\" src=\"data:image/png;base64," + ToBase64(shown.png) + "\">\n";
  html += Text("<figcaption><b>Figure %d.</b> ", figure.number) + EscapeHtml(figure.caption) + "\n<dl>\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    html += Element("dt", name) + Element("dd", value) + "\n";
  };
  line("scene", std::string("scene/") + figure.scene + ".json");
  for (const auto& parameter : shown.parameters) line(parameter.first, parameter.second);
  line("frame", Text("%d (%.2f s)", figure.frame, figure.frame / shown.framesPerSecond));
  line("shader", shown.shader);
  for (const auto& measured : MeasuredText(shown)) line(measured.first, measured.second);
  return html + "</dl>\n<pre><code>" + EscapeHtml(shown.command) + "</code></pre></figcaption>\n</figure>\n";
}

std::string FormatClaim(const Claim& claim) {
  return Text("<div class=\"claim %s\" id=\"claim-%s\">\n<p>", VerdictClass(claim.verdict), claim.id.c_str()) +
         EscapeHtml(claim.statement) + " <span class=\"verdict\">" + EscapeHtml(VerdictName(claim.verdict)) +
         "</span></p>\n<p class=\"soft\">" + EscapeHtml(claim.measurement) + "</p>\n</div>\n";
}

std::string FormatTable(const PartTable& table) {
  std::string html = "<div class=\"scroll\"><table>" + Element("caption", table.title) + "\n<tr>";
  for (const std::string& column : table.columns) html += Element("th", column);
  html += "</tr>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += Element("td", cell);
    html += "</tr>\n";
  }
  return html + "</table></div>\n" +
         (table.note.empty() ? "" : "<p class=\"soft\">" + EscapeHtml(table.note) + "</p>\n");
}

std::string FormatOverview(const Findings& findings) {
  std::string html =
      "<h2 id=\"claims\">What the write-up claims, and what we measured</h2>\n<div class=\"scroll\"><table "
      "class=\"overview\">\n";
  for (const Claim& claim : findings.claims) {
    html += Text("<tr class=\"%s\"><td><a href=\"#claim-%s\">", VerdictClass(claim.verdict), claim.id.c_str()) +
            EscapeHtml(claim.statement) + "</a></td><td class=\"verdict\">" + EscapeHtml(VerdictName(claim.verdict)) +
            "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

std::string FormatFindings(const Findings& findings, int part) {
  std::string claims, plots, tables;
  for (const Claim& claim : findings.claims) {
    if (claim.part == part) claims += FormatClaim(claim);
  }
  for (const PartPlot& plot : findings.plots) {
    if (plot.part == part) plots += FormatSvg(plot.plot);
  }
  for (const PartTable& table : findings.tables) {
    if (table.part == part) tables += FormatTable(table);
  }
  if (claims.empty()) return {};
  return "<h3>What the write-up says of it, measured</h3>\n" + claims +
         (plots.empty() ? "" : "<div class=\"plots\">\n" + plots + "</div>\n") + tables;
}

std::string JsonNumber(double number) {
  return std::isfinite(number) ? FormatNumber(number) : "null";
}

std::string FigureData(const ShownFigure& shown) {
  const Figure& figure = *shown.figure;
  const std::size_t row = shown.course.rows.size() - 1;
  return Text("{\"number\": %d, \"file\": ", figure.number) + Quote(FigureFile(figure.number)) +
         ", \"course\": " + Quote(figure.course()) + Text(", \"frame\": %d", figure.frame) +
         ", \"shader\": " + Quote(shown.shader) + ", \"command\": " + Quote(shown.command) +
         ", \"caption\": " + Quote(figure.caption) + ", \"lowest_y\": " + JsonNumber(shown.course.At(row, "lowest_y")) +
         ", \"stretch\": " + JsonNumber(shown.course.At(row, "stretch")) +
         ", \"rest_time\": " + JsonNumber(RestTime(shown.course).value_or(NAN)) +
         ", \"residual_motion\": " + JsonNumber(ResidualMotion(shown.course)) + "}";
}

std::string ClaimData(const Claim& claim) {
  std::string numbers;
  for (const auto& number : claim.numbers) {
    numbers += (numbers.empty() ? "" : ", ") + Quote(number.first) + ": " + JsonNumber(number.second);
  }
  return "{\"id\": " + Quote(claim.id) + Text(", \"stated\": %s", claim.stated ? "true" : "false") +
         ", \"verdict\": " + Quote(VerdictName(claim.verdict)) + ", \"statement\": " + Quote(claim.statement) +
         ", \"measurement\": " + Quote(claim.measurement) + ", \"numbers\": {" + numbers + "}}";
}

}  // namespace

std::string FormatPage(const FigurePage& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>The figures of the cloth simulator's write-up</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>";
  html += kStyle;
  html += "</style>\n</head>\n<body>\n<main>\n<h1>The figures of the cloth simulator's write-up</h1>\n";
  html +=
      "<p class=\"lead\">" +
      EscapeHtml(Text("%zu of %d figures, made by Percale %s at %d x %d pixels. Below each stands the command that "
                      "makes it again. A frame is 1/90 s; densities are shown in g/cm² as in the course, a tenth of "
                      "the file's kg/m². “At rest” means that no point has moved more than 1 mm in a frame for 30 "
                      "frames on end.",
                      page.figures.size(), kFigureCount, page.version.c_str(), page.width, page.height)) +
      "</p>\n<nav><ul>\n";
  const auto parts = FigureParts();
  if (page.findings) html += "<li><a href=\"#claims\">Claims</a></li>\n";
  for (std::size_t i = 0; i < parts.size(); ++i)
    html += Text("<li><a href=\"#part-%zu\">", i + 1) + EscapeHtml(parts[i].title) + "</a></li>\n";
  html += "</ul></nav>\n";
  if (page.findings) html += FormatOverview(*page.findings);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    html += Text("<section id=\"part-%zu\">\n", i + 1) + Element("h2", parts[i].title) + "\n<p class=\"lead\">" +
            EscapeHtml(parts[i].question) + "</p>\n<div class=\"figures\">\n";
    for (const ShownFigure& shown : page.figures) {
      if (shown.figure->number >= parts[i].first && shown.figure->number <= parts[i].last)
        html += FormatFigure(shown, page.width, page.height);
    }
    html += "</div>\n";
    if (page.findings) html += FormatFindings(*page.findings, int(i));
    html += "</section>\n";
  }
  return html + "</main>\n</body>\n</html>\n";
}

std::string FormatPageData(const FigurePage& page) {
  std::string figures, claims, tables;
  const auto list = [](const std::vector<std::string>& texts) {
    std::string json;
    for (const std::string& text : texts) json += (json.empty() ? "" : ", ") + Quote(text);
    return "[" + json + "]";
  };
  for (const ShownFigure& shown : page.figures) figures += (figures.empty() ? "\n  " : ",\n  ") + FigureData(shown);
  if (page.findings) {
    for (const Claim& claim : page.findings->claims) claims += (claims.empty() ? "\n  " : ",\n  ") + ClaimData(claim);
    for (const PartTable& table : page.findings->tables) {
      std::string rows;
      for (const auto& row : table.rows) rows += (rows.empty() ? "" : ", ") + list(row);
      tables += (tables.empty() ? "\n  {" : ",\n  {") + std::string("\"title\": ") + Quote(table.title) +
                ", \"columns\": " + list(table.columns) + ", \"rows\": [" + rows + "]}";
    }
  }
  return "{\"version\": " + Quote(page.version) + Text(", \"width\": %d, \"height\": %d,\n", page.width, page.height) +
         " \"figures\": [" + figures + "],\n \"claims\": [" + claims + "],\n \"tables\": [" + tables + "]}\n";
}

}  // namespace percale::cli
