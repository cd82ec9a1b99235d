#pragma once
/// \file
/// Plots as SVG inside an HTML page, whose style sheet gives the colours.

#include <optional>
#include <string>
#include <vector>

namespace percale::cli {

struct PlotPoint {
  double x = 0, y = 0;
};

/// One line of a plot. On a logarithmic axis points at or below 0 lie on the stated minimum, or are left out
/// where there is none.
struct Series {
  std::string name;
  std::vector<PlotPoint> points;
  bool marked = false;  ///< A mark, with its numbers, on each point: for few points.
};

struct Axis {
  std::string label;  ///< With the unit: "ks [N/m]".
  bool logarithmic = false;
  std::optional<double> min, max;  ///< What is shown; none: what there is.
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;  ///< At most six have a colour of their own.
};

/// The plot as an <svg> element of class "plot", with a legend where there are several series. Its title and
/// labels may be any text. Without points it has axes alone.
std::string FormatSvg(const Plot& plot);
/// The same as a file of its own, which brings the style sheet.
std::string FormatSvgFile(const Plot& plot);

}  // namespace percale::cli
