#pragma once
/// \file
/// The legend of a heat map, drawn into a picture that has no other text.

#include "render/heat_scale.h"
#include "render/image.h"

namespace percale {

/// Where the bar of colours goes in a picture of that size [pixel]; columns x .. x + width - 1.
struct LegendBar {
  int x = 0, y = 0, width = 0, height = 0;
};
LegendBar PlaceLegend(int width, int height);

/// Draws title, bar and numbers into the upper left corner; nothing without a quantity, or where the
/// picture is too small.
void DrawLegend(Image& image, const HeatScale& scale);

}  // namespace percale
