#pragma once
/// \file
/// A plot of curves over a common axis, drawn with Dear ImGui.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/heat_scale.h"

namespace percale::viewer {

struct PlotCurve {
  std::string label;
  Rgb color{};
  std::vector<double> y;  ///< One per point of the axis; NaN: not known, passed over.
};

struct Plot {
  std::string title;
  std::string unit;      ///< Of y.
  bool stacked = false;  ///< Each curve upon the one before, from 0 on, filled.
  std::vector<PlotCurve> curves;
};

/// Draws the plot as wide as the window and `height` high [screen unit], in a scale of text and lines.
/// `x` ascends. `cursor`, the x that is pointed at, is set where the pointer is over this plot, and
/// shown with its values if it is set.
void DrawPlot(const Plot& plot, std::span<const double> x, const std::string& xUnit, float height, float scale,
              std::optional<double>& cursor);

}  // namespace percale::viewer
