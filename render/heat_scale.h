#pragma once
/// \file
/// Heat maps: what a cloth can be coloured by, and with which colours.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace percale {

/// What a heat map shows of each vertex (world/measure.h).
enum class Quantity { None, Stretch, Compression, Speed, Curvature, Contact };
inline constexpr int kQuantities = 6;

struct QuantityInfo {
  std::string_view name;   ///< On the command line: "stretch".
  std::string_view label;  ///< "Greatest stretch".
  std::string_view unit;   ///< "m/s"; empty for plain numbers.
};
/// How the quantity is named.
const QuantityInfo& Describe(Quantity quantity);
/// All names, in the order of Quantity: "off" first.
std::span<const std::string_view> QuantityNames();

struct ValueRange {
  double low = 0, high = 1;
  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

struct HeatMapSettings {
  Quantity quantity = Quantity::None;
  std::optional<ValueRange> range;  ///< Of the colours, low < high; none: follows the values.
  friend bool operator==(const HeatMapSettings&, const HeatMapSettings&) = default;
};

/// The colours of a picture: those of a quantity, over a range.
struct HeatScale {
  Quantity quantity = Quantity::None;
  ValueRange range;
};

using Rgb = std::array<float, 3>;

/// Viridis (Smith and van der Walt 2015, CC0) by polynomials of degree 6, from tools/fit_viridis.py: no
/// channel is off by more than 2.6 / 255. By rising power of the share.
inline constexpr Rgb kViridis[] = {
    {0.276861f, 0.003747f, 0.337654f},      {-0.135816f, 1.489409f, 0.955591f},  {2.075495f, -0.729540f, 5.112634f},
    {-13.150927f, -2.017846f, -40.498203f}, {20.132427f, 7.301663f, 97.251702f}, {-5.889868f, -7.900479f, -101.257020f},
    {-2.324781f, 2.757846f, 38.233310f},
};
/// Of no contact, cloth, collider: blue, yellow and vermilion of Okabe and Ito 2008, "Color universal
/// design", which differ in lightness too.
inline constexpr Rgb kContactColors[] = {{0, 0.447f, 0.698f}, {0.941f, 0.894f, 0.259f}, {0.835f, 0.369f, 0}};
inline constexpr std::string_view kContactLabels[] = {"none", "cloth", "collider"};

/// The colour at a share 0..1 of the range; beyond it that of the end.
Rgb HeatColor(double share);

/// Follows the values without following each of them: a round number that is at least the value, and
/// shrinks only when the value leaves much of it unused.
class SteadySpan {
 public:
  /// `least` > 0: the span to begin with.
  explicit SteadySpan(double least) : least_(least), span_(least) {}
  /// Takes the next value >= 0; returns the span, at least `least`.
  double Update(double value);

 private:
  double least_, span_;
};

}  // namespace percale
