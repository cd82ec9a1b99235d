#include "apps/cli/verify_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/cli/html.h"
#include "apps/cli/session.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr std::size_t kColumns = 7;
constexpr std::array<const char*, kColumns> kHeads = {"case",  "quantity", "measured", "expected",
                                                      "error", "gate",     "verdict"};
constexpr std::size_t kFirstNumber = 2, kLastNumber = 5;  // of the columns: set flush right
constexpr std::size_t kMostSeries = 6;                    // that a plot has colours for
constexpr std::size_t kLegend = 78, kLegendMark = 5;      // about as many characters, in all and per series

using Row = std::array<std::string, kColumns>;

std::string Number(double number) {
  return std::isfinite(number) ? Text("%.6g", number) : "none";
}

Row RowOf(const VerifyCase& of, const Reading& reading) {
  std::string error = "none";
  if (std::isfinite(reading.measured))
    error = reading.share ? Text("%+.3f %%", 100 * reading.error) : Text("%.1e", reading.error);
  return {of.name, reading.what, Number(reading.measured),           Number(reading.expected),
          error,   reading.gate, reading.Holds() ? "holds" : "FAILS"};
}

std::string JsonNumber(double number) {
  return std::isfinite(number) ? FormatNumber(number) : "null";
}

std::string FormatReadings(const FinishedCase& finished) {
  std::string html = "<div class=\"scroll\"><table>\n<tr>";
  for (std::size_t k = 1; k < kColumns; ++k) html += Element("th", kHeads[k]);
  html += "</tr>\n";
  for (const Reading& reading : finished.result.readings) {
    const Row row = RowOf(*finished.of, reading);
    html += reading.Holds() ? "<tr class=\"holds\">" : "<tr class=\"fails\">";
    for (std::size_t k = 1; k + 1 < kColumns; ++k) html += Element("td", row[k]);
    html += "<td class=\"verdict\">" + EscapeHtml(row[kColumns - 1]) + "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

/// The error of each quantity against how finely it was computed.
Plot PlotOf(const Refinement& refinement) {
  Plot plot;
  plot.title = "Error and " + refinement.axis;
  plot.x = {.label = refinement.axis + ", relative", .logarithmic = true, .min = {}, .max = {}};
  plot.y = {.label = "|error|", .logarithmic = true, .min = {}, .max = {}};
  const std::vector<Reading>& readings = refinement.results[0].readings;
  // As many of them as the legend has room for, evenly among all.
  std::size_t widest = 0;
  for (const Reading& reading : readings) widest = std::max(widest, CountCharacters(reading.what));
  const std::size_t shown =
      std::min({readings.size(), kMostSeries, std::max<std::size_t>(1, kLegend / (widest + kLegendMark))});
  for (std::size_t s = 0; s < shown; ++s) {
    const std::size_t at = shown < 2 ? 0 : s * (readings.size() - 1) / (shown - 1);
    Series series{refinement.results[0].readings[at].what, {}, true};
    for (std::size_t k = 0; k < refinement.factors.size(); ++k) {
      if (at >= refinement.results[k].readings.size()) continue;
      series.points.push_back({refinement.factors[k], std::abs(refinement.results[k].readings[at].error)});
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// All errors of a refinement as a table.
std::string FormatRefinement(const Refinement& refinement) {
  std::string html =
      "<div class=\"scroll\"><table>" + Element("caption", "Error by " + refinement.axis) + "\n<tr><th></th>";
  for (const double factor : refinement.factors) html += Element("th", "× " + FormatNumber(factor));
  html += "</tr>\n";
  for (std::size_t c = 0; c < refinement.results[0].readings.size(); ++c) {
    html += "<tr>" + Element("td", refinement.results[0].readings[c].what);
    for (const CaseResult& result : refinement.results) {
      html += Element("td", c < result.readings.size() && std::isfinite(result.readings[c].error)
                                ? Text(result.readings[c].share ? "%+.3f %%" : "%.1e",
                                       (result.readings[c].share ? 100 : 1) * result.readings[c].error)
                                : "none");
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string FormatCase(const FinishedCase& finished) {
  const VerifyCase& of = *finished.of;
  std::string html = "<h3 id=\"" + EscapeHtml(of.name) + "\">" + EscapeHtml(of.title) + "</h3>\n<p>" +
                     EscapeHtml(of.law) + " <span class=\"soft\">(" + EscapeHtml(of.source) + ")</span></p>\n" +
                     FormatReadings(finished);
  if (!finished.result.note.empty()) html += "<p class=\"soft\">" + EscapeHtml(finished.result.note) + "</p>\n";
  std::string plots;
  for (const Plot& plot : finished.result.plots) plots += FormatSvg(plot);
  for (const Refinement& refinement : finished.refinements) plots += FormatSvg(PlotOf(refinement));
  if (!plots.empty()) html += "<div class=\"plots\">\n" + plots + "</div>\n";
  for (const Refinement& refinement : finished.refinements) html += FormatRefinement(refinement);
  return html + "<pre><code>percale verify --only " + EscapeHtml(of.name) + "</code></pre>\n";
}

}  // namespace

int VerifyReport::Readings() const {
  int count = 0;
  for (const FinishedCase& finished : cases) count += static_cast<int>(finished.result.readings.size());
  return count;
}

int VerifyReport::Holding() const {
  int count = 0;
  for (const FinishedCase& finished : cases) {
    for (const Reading& reading : finished.result.readings) count += reading.Holds() ? 1 : 0;
  }
  return count;
}

std::string FormatTable(const VerifyReport& report) {
  Row head;
  std::copy(kHeads.begin(), kHeads.end(), head.begin());
  std::vector<Row> rows = {head};
  for (const FinishedCase& finished : report.cases) {
    for (const Reading& reading : finished.result.readings) rows.push_back(RowOf(*finished.of, reading));
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kColumns; ++k) widths[k] = std::max(widths[k], CountCharacters(row[k]));
  }
  std::string text, subject, last;
  std::size_t at = 0;
  const auto print = [&](const Row& row) {
    std::string line;
    for (std::size_t k = 0; k < kColumns; ++k) {
      const std::string pad(widths[k] - CountCharacters(row[k]), ' ');
      const bool right = k >= kFirstNumber && k <= kLastNumber;
      line += (k > 0 ? "  " : "") + (right ? pad + row[k] : row[k] + pad);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  print(rows[at++]);
  for (const FinishedCase& finished : report.cases) {
    if (subject != finished.of->subject) {
      subject = finished.of->subject;
      text += "\n" + subject + "\n";
    }
    for (std::size_t c = 0; c < finished.result.readings.size(); ++c) {
      Row row = rows[at++];
      if (row[0] == last)
        row[0].clear();
      else
        last = row[0];
      print(row);
    }
  }
  return text;
}

std::string FormatPage(const VerifyReport& report) {
  constexpr std::string_view kTitle = "Percale against closed forms";
  std::string html = OpenPage(kTitle, kTitle) + "<p class=\"lead\">";
  html +=
      EscapeHtml(Text("%d of %d quantities lie within their gates. Computed by the fabric engine of Percale %s, each "
                      "step solved to rounding.",
                      report.Holding(), report.Readings(), report.version.c_str()));
  html += "</p>\n<div class=\"scroll\"><table class=\"overview\">\n";
  for (const FinishedCase& finished : report.cases) {
    const bool holds = finished.result.Holds();
    html += Text("<tr class=\"%s\"><td>", holds ? "holds" : "fails") + EscapeHtml(finished.of->subject) +
            "</td><td><a href=\"#" + EscapeHtml(finished.of->name) + "\">" + EscapeHtml(finished.of->title) +
            "</a></td><td class=\"verdict\">" + (holds ? "holds" : "FAILS") + "</td></tr>\n";
  }
  html += "</table></div>\n";
  std::string subject;
  for (const FinishedCase& finished : report.cases) {
    if (subject != finished.of->subject) {
      subject = finished.of->subject;
      html += Element("h2", subject) + "\n";
    }
    html += FormatCase(finished);
  }
  return html.append(ClosePage());
}

std::string FormatJson(const VerifyReport& report) {
  std::string cases;
  for (const FinishedCase& finished : report.cases) {
    std::string readings;
    for (const Reading& reading : finished.result.readings) {
      readings += (readings.empty() ? "\n   {" : ",\n   {") + std::string("\"quantity\": ") + Quote(reading.what) +
                  ", \"measured\": " + JsonNumber(reading.measured) +
                  ", \"expected\": " + JsonNumber(reading.expected) + ", \"error\": " + JsonNumber(reading.error) +
                  ", \"relative\": " + (reading.share ? "true" : "false") + ", \"low\": " + JsonNumber(reading.low) +
                  ", \"high\": " + JsonNumber(reading.high) + ", \"holds\": " + (reading.Holds() ? "true" : "false") +
                  "}";
    }
    const VerifyCase& of = *finished.of;
    cases += (cases.empty() ? "\n  {" : ",\n  {") + std::string("\"name\": ") + Quote(of.name) +
             ", \"subject\": " + Quote(of.subject) + ", \"title\": " + Quote(of.title) + ", \"law\": " + Quote(of.law) +
             ", \"note\": " + Quote(finished.result.note) + ",\n   \"readings\": [" + readings + "]}";
  }
  return "{\"version\": " + Quote(report.version) +
         Text(", \"readings\": %d, \"holding\": %d,\n \"cases\": [", report.Readings(), report.Holding()) + cases +
         "]}\n";
}

}  // namespace percale::cli
