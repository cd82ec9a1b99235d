#include "apps/cli/figure_page.h"

#include <algorithm>
#include <cmath>

#include "apps/cli/html.h"
#include "apps/cli/session.h"
#include "core/base64.h"
#include "core/text.h"

namespace percale::cli {
namespace {

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
  constexpr std::string_view kTitle = "The figures of the cloth simulator's write-up";
  std::string html = OpenPage(kTitle, kTitle);
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
  return html.append(ClosePage());
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
