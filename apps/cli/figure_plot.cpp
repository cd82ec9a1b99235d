#include "apps/cli/figure_plot.h"

#include <algorithm>
#include <cmath>

#include "apps/cli/html.h"
#include "core/text.h"
#include "render/ticks.h"

namespace percale::cli {
namespace {

// The picture, in units of its own [pixel at full size].
constexpr double kWidth = 640, kHeight = 400;
constexpr double kLeft = 74, kRight = 620, kTop = 62, kBottom = 346;
constexpr int kMostSteps = 8;                       // between the numbers of an axis
constexpr double kLegendMark = 46, kCharacter = 7;  // widths: of a mark and the room around it, and of a character

/// An axis between two places of the picture.
class Scale {
 public:
  Scale(const Axis& axis, double low, double high, double from, double to)
      : logarithmic_(axis.logarithmic), hasFloor_(axis.min.has_value()), from_(from), to_(to) {
    low_ = axis.min.value_or(low);
    high_ = axis.max.value_or(high);
    if (logarithmic_) {
      low_ = std::log10(low_);
      high_ = std::log10(high_);
    }
    if (high_ <= low_) high_ = low_ + 1;
    const double margin = 0.04 * (high_ - low_);
    if (!axis.min) low_ -= margin;
    if (!axis.max) high_ += margin;
  }

  bool Shows(double value) const { return !logarithmic_ || value > 0 || hasFloor_; }
  double operator()(double value) const {
    const double at = !logarithmic_ ? value : value > 0 ? std::log10(value) : low_;
    return from_ + (std::clamp(at, low_, high_) - low_) / (high_ - low_) * (to_ - from_);
  }

  std::vector<double> Ticks() const {
    if (!logarithmic_) return percale::Ticks(low_, high_, kMostSteps);
    std::vector<double> ticks;
    const int step = std::max(1, int(std::ceil((high_ - low_) / kMostSteps)));  // decades
    const bool few = high_ - low_ < 2;
    for (int power = int(std::floor(low_)); power <= high_; ++power) {
      for (const double part : {1.0, 2.0, 5.0}) {
        const double at = power + std::log10(part);
        if (at >= low_ && at <= high_ && power % step == 0 && (few || part == 1)) ticks.push_back(std::pow(10, at));
      }
    }
    return ticks;
  }

 private:
  bool logarithmic_, hasFloor_;
  double low_, high_, from_, to_;
};

std::string TickLabel(double value) {
  const double power = value > 0 ? std::log10(value) : 0;
  if (value != 0 && (power < -2.5 || power > 4.5) && power == std::round(power)) {
    const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string label = power < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(int(std::abs(power)))) label += digits[digit - '0'];
    return label;
  }
  std::string label = Text("%.6g", std::abs(value) < 1e-12 ? 0 : value);
  return label[0] == '-' ? "−" + label.substr(1) : label;
}

std::string Label(double x, double y, const char* anchor, const std::string& text) {
  return Text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor) + EscapeHtml(text) + "</text>\n";
}

std::string Line(const char* kind, double x1, double y1, double x2, double y2) {
  return Text("<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", kind, x1, y1, x2, y2);
}

std::string FormatAxes(const Plot& plot, const Scale& x, const Scale& y) {
  std::string svg;
  for (const double tick : x.Ticks()) {
    svg += Line("grid", x(tick), kTop, x(tick), kBottom) + Label(x(tick), kBottom + 18, "middle", TickLabel(tick));
  }
  for (const double tick : y.Ticks()) {
    svg += Line("grid", kLeft, y(tick), kRight, y(tick)) + Label(kLeft - 8, y(tick) + 4.5, "end", TickLabel(tick));
  }
  svg += Line("axis", kLeft, kBottom, kRight, kBottom) + Line("axis", kLeft, kTop, kLeft, kBottom);
  svg += Label((kLeft + kRight) / 2, kHeight - 12, "middle", plot.x.label);
  svg += Text("<text transform=\"translate(16 %.1f) rotate(-90)\" text-anchor=\"middle\">", (kTop + kBottom) / 2) +
         EscapeHtml(plot.y.label) + "</text>\n";
  return svg;
}

std::string FormatSeries(const Series& series, std::size_t number, const Scale& x, const Scale& y) {
  std::string path, marks;
  for (const PlotPoint& point : series.points) {
    if (!x.Shows(point.x) || !y.Shows(point.y)) continue;
    path += Text("%c%.1f %.1f", path.empty() ? 'M' : 'L', x(point.x), y(point.y));
    if (!series.marked) continue;
    marks += Text("<circle class=\"mark\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"><title>", x(point.x), y(point.y)) +
             EscapeHtml(series.name + Text(": %.6g, %.6g", point.x, point.y)) + "</title></circle>\n";
  }
  return Text("<g class=\"s%zu\">", number) + "<path d=\"" + path + "\"/>\n" + marks + "</g>\n";
}

/// In one row, or in columns of two where names are long.
std::string FormatLegend(const Plot& plot) {
  const std::size_t count = plot.series.size();
  if (count < 2) return {};
  std::size_t longest = 0;
  for (const Series& series : plot.series) longest = std::max(longest, CountCharacters(series.name));
  const double needed = kLegendMark + kCharacter * double(longest);
  const std::size_t rows = double(count) * needed > kRight - kLeft ? 2 : 1;
  const double width = (kRight - kLeft) / double((count + rows - 1) / rows);
  std::string svg;
  for (std::size_t i = 0; i < count; ++i) {
    const double left = kLeft + width * double(i / rows);
    const double y = rows == 1 ? 44 : i % rows == 0 ? 36 : 53;
    svg += Text("<g class=\"s%zu\"><path d=\"M%.1f %.1fL%.1f %.1f\"/></g>", i, left, y, left + 26, y) +
           Label(left + 32, y + 4.5, "start", plot.series[i].name);
  }
  return svg;
}

}  // namespace

std::string FormatSvg(const Plot& plot) {
  double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
  for (const Series& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      if ((plot.x.logarithmic && point.x <= 0) || (plot.y.logarithmic && point.y <= 0)) continue;
      left = std::min(left, point.x);
      right = std::max(right, point.x);
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
  }
  if (left > right) left = right = low = high = 1;  // nothing to show
  const Scale x(plot.x, left, right, kLeft, kRight), y(plot.y, low, high, kBottom, kTop);
  std::string svg = Text("<svg class=\"plot\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", kWidth, kHeight) +
                    EscapeHtml(plot.title) + "\">\n";
  svg += "<text class=\"title\" x=\"14\" y=\"22\">" + EscapeHtml(plot.title) + "</text>\n";
  svg += FormatLegend(plot) + FormatAxes(plot, x, y);
  for (std::size_t i = 0; i < plot.series.size(); ++i) svg += FormatSeries(plot.series[i], i, x, y);
  return svg + "</svg>\n";
}

std::string FormatSvgFile(const Plot& plot) {
  std::string svg = FormatSvg(plot);
  constexpr std::string_view kTag = "<svg ";
  svg.insert(svg.find(">\n") + 2, "<style>" + std::string(PageStyle()) + "</style>\n");
  return svg.insert(kTag.size(), "xmlns=\"http://www.w3.org/2000/svg\" ");
}

}  // namespace percale::cli
