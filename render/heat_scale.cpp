#include "render/heat_scale.h"

#include <algorithm>
#include <iterator>

#include "render/ticks.h"

namespace percale {
namespace {

constexpr QuantityInfo kInfos[kQuantities] = {
    {"off", "Off", ""},        {"stretch", "Greatest stretch", ""},    {"compression", "Greatest compression", ""},
    {"speed", "Speed", "m/s"}, {"curvature", "Mean curvature", "1/m"}, {"contact", "Contact", ""},
};
constexpr std::string_view kNames[kQuantities] = {kInfos[0].name, kInfos[1].name, kInfos[2].name,
                                                  kInfos[3].name, kInfos[4].name, kInfos[5].name};
// A span shrinks when the value could grow by this much and still not need it.
constexpr double kUnused = 1.25;

}  // namespace

const QuantityInfo& Describe(Quantity quantity) {
  return kInfos[static_cast<std::size_t>(quantity)];
}

std::span<const std::string_view> QuantityNames() {
  return kNames;
}

Rgb HeatColor(double share) {
  const auto t = static_cast<float>(std::clamp(share, 0.0, 1.0));
  Rgb color{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t power = std::size(kViridis); power-- > 0;)
      color[channel] = color[channel] * t + kViridis[power][channel];
    color[channel] = std::clamp(color[channel], 0.0f, 1.0f);
  }
  return color;
}

double SteadySpan::Update(double value) {
  if (value > span_) span_ = RoundUp(value);
  const double enough = std::max(least_, kUnused * value);
  if (RoundUp(enough) < span_) span_ = RoundUp(enough);
  return span_;
}

}  // namespace percale
