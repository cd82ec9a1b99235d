#pragma once
/// \file
/// The closed forms that `percale verify` measures against, in numbers without units where they have none.

#include <vector>

#include "apps/cli/figure_plot.h"

namespace percale::cli {

/// The shape of a strip that is clamped level at x = 0 and bends under its own weight without stretching, Γ = ρ g L³/B
/// (Rohde 1953, "Large deflections of a cantilever beam with uniformly distributed load"). Lengths in units of L, the
/// drop counted down.
struct HeavyElastica {
  std::vector<PlotPoint> shape;  ///< From the clamp to the tip: x, drop.
  double reach = 0, drop = 0;    ///< Of the tip.
};
/// 0 < gamma <= 5000.
HeavyElastica SolveHeavyElastica(double gamma);
/// The Γ at which the chord from clamp to tip hangs `angle` [rad] below the horizontal, 0 < angle < 1.5.
double GammaOfChord(double angle);

/// How far a rope of `length` > 1 hangs below its ends, which are level and 1 apart.
double CatenarySag(double length);

/// Period of a pendulum that swings up to `angle` [rad] on either side, over that of a small swing: 1 over the
/// arithmetic-geometric mean of 1 and cos(angle/2) (Gauss 1799).
double PendulumPeriod(double angle);

/// A strip without weight that hangs from a clamp straight down to a table, which rises under it until the strip folds:
/// the elastica clamped at one end, hinged at the other, its ends above each other (Sano, Yamaguchi, Wada 2017, "Slip
/// morphology of elastic strips on frictional rigid substrates"). Lengths in units of L.
struct PressedStrip {
  double shortening = 0;         ///< ε: how far the table has risen.
  double friction = 0;           ///< Of the end on the table: force along it over force across. Less of it lets go.
  std::vector<PlotPoint> shape;  ///< From the end on the table: sideways, up.
};
/// 0 < shortening <= 0.6.
PressedStrip SolvePressedStrip(double shortening);

/// 1/K of a strip cut at `angle` [rad] from the warp, from what strips along warp and weft measure (Jones 1999,
/// "Mechanics of composite materials", equation 2.97).
double StripCompliance(double warp, double weft, double poisson, double shear, double angle);

/// Γ/((1 - ν) √(2 (1 + ν))) at which a strip on edge, clamped at one end, turns out of its plane by its own weight
/// (Timoshenko and Gere 1961, "Theory of elastic stability", section 6.3, with the bending stiffness D (1 - ν²) and the
/// torsional stiffness 2 D (1 - ν) of a narrow plate).
inline constexpr double kLateralBuckling = 12.854;
/// ρ g L³/B at which a standing strip bends by its own weight: 9/4 j², j the first zero of the Bessel function J(-1/3)
/// (Greenhill 1881).
inline constexpr double kSelfBuckling = 7.83735;
/// P L²/B of a column clamped at one end and hinged at the other: the first q² with tan q = q.
inline constexpr double kClampedHingedColumn = 20.19073;
/// ω L² √(ρ/B) of a cantilever's first mode: the first q² with cos q cosh q = -1.
inline constexpr double kCantileverMode = 3.516015;

/// Shape of the mylar balloon, two discs of radius a joined at the rim and inflated: its radius over a, and its volume
/// over a³ (Paulsen 1994, "What is the shape of a mylar balloon?").
inline constexpr double kBalloonRadius = 0.76275976, kBalloonVolume = 1.2185;

}  // namespace percale::cli
