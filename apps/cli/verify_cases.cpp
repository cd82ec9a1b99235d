#include "apps/cli/verify_cases.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace percale::cli {
namespace {

constexpr VerifyCase kCases[] = {
    {"cantilever", "Bending", "A strip clamped level at one end, bent by its weight",
     "drop over reach of the tip, H/W, from θ'' = −Γ (1 − s) cos θ, Γ = ρ g L³/B", "Rohde 1953", VerifyCantilever,
     true},
    {"chord_angle", "Bending", "The fabric tester's strip, after ASTM D1388",
     "the chord from clamp to tip hangs at 41.5° where Γ = 8.0042", "Peirce 1930; Rohde 1953", VerifyChordAngle, true},
    {"lateral_buckling", "Bending", "A strip on edge, clamped at one end, that turns out of its plane by its weight",
     "critical Γ = 12.854 (1 − ν) √(2 (1 + ν)), Γ = ρ g L³/D", "Timoshenko, Gere 1961", VerifyLateralBuckling, true},
    {"self_buckling", "Bending", "A standing strip that bends by its weight", "critical ρ g L³/B = 7.8373",
     "Greenhill 1881", VerifySelfBuckling, true},
    {"columns", "Bending", "Columns pressed until they bend", "critical P L²/B = π², π²/4, 20.191, 4 π² by the ends",
     "Euler 1744", VerifyColumns, true},
    {"frequency", "Bending", "A cantilever that swings in its first mode", "f = 3.516/(2π L²) √(B/ρ)",
     "Euler, Bernoulli 1750", VerifyFrequency, true, true},
    {"hanging_sheet", "Membrane", "A sheet hung by its upper edge", "ΔL/L = ρ g L / (2 K)", "Hooke's law",
     VerifyHangingSheet},
    {"catenary", "Membrane", "A strip without stiffness, longer than the span of 1 m between its ends",
     "sag c (cosh(1/(2c)) − 1), where 2 c sinh(1/(2c)) = L", "the catenary", VerifyCatenary, true},
    {"patch", "Membrane", "A patch of irregular triangles, its border moved as a linear field",
     "every vertex follows, every triangle has the same strain", "the patch test of finite elements", VerifyPatch},
    {"orthotropy", "Membrane", "Strips cut along the warp, aslant and along the weft",
     "1/K = c⁴/K₁ + c² s² (1/G − 2 ν/K₁) + s⁴/K₂", "Jones 1999, eq. 2.97", VerifyOrthotropy, true},
    {"balloon", "Membrane", "Two discs of radius a joined at the rim and inflated, the mylar balloon",
     "radius 0.7628 a, volume 1.2185 a³", "Paulsen 1994", VerifyBalloon, true},
    {"free_motion", "Time", "A sheet that falls, flies, and is seen from another frame",
     "no force without a cause; no frame is special", "Galilei", VerifyFreeMotion},
    {"momentum", "Time", "A free sheet in motion, each vertex its own way", "Σ m v stays; inner forces turn nothing",
     "Newton's third law", VerifyMomentum},
    {"pendulum", "Time", "A mass on a strip that swings far", "T/T0 = 1/agm(1, cos(θ/2))", "Gauss 1799", VerifyPendulum,
     false, true},
    {"decay", "Time", "A mass on a strip that stretches and shrinks, damped by the integrator alone",
     "1/√(1 + ω² h²) per step", "backward Euler on one mode", VerifyDecay},
    {"order", "Time", "A strip that falls, with steps of h, h/2 and h/4", "log₂ of the ratio of differences is 1",
     "backward Euler is of first order", VerifyOrder},
    {"incline", "Contact", "A block of three sheets on a slope of tan α = 0.5",
     "sticks at μ = 0.51; else slides with g (sin α − μ cos α)", "Coulomb 1785", VerifyIncline},
    {"capstan", "Contact", "A belt half around a drum that turns under it", "ratio of forces e^(μπ)",
     "Euler 1769, Eytelwein 1832", VerifyCapstan, true},
    {"stick_slip", "Contact", "A hanging strip that a table presses into a fold until its end lets go",
     "μ = force along the table over force across it, of an elastica clamped above and hinged below",
     "Sano, Yamaguchi, Wada 2017; Romero et al. 2021", VerifyStickSlip},
    {"pinch", "Contact", "Cloth that two plates pinch, lift by 10 cm and hold for a minute", "no slip, no crossing",
     "Coulomb 1785", VerifyPinch},
    {"impact", "Contact", "A sheet that flies into another", "Σ m v stays", "Newton's third law", VerifyImpact},
    {"drape", "Drape", "A disc of cotton, 30 cm wide, over a pedestal of 18 cm, after Cusick",
     "shadow of the ring over the ring, 68 %", "Cusick 1965; measurements of cotton 60 to 76", VerifyDrape, true},
};

Reading MakeReading(std::string what, double measured, double expected, double low, double high, std::string gate) {
  Reading reading;
  reading.what = std::move(what);
  reading.measured = measured, reading.expected = expected;
  reading.low = low, reading.high = high;
  reading.gate = std::move(gate);
  reading.error = measured - expected;
  return reading;
}

}  // namespace

Reading Relative(std::string what, double measured, double expected, double share) {
  const double off = share * std::abs(expected);
  Reading reading = MakeReading(std::move(what), measured, expected, expected - off, expected + off,
                                FormatNumber(RoundDown(100 * share * (1 + 1e-12), 6)) + " %");
  reading.error /= expected;
  reading.share = true;
  return reading;
}

Reading Absolute(std::string what, double measured, double expected, double most) {
  return MakeReading(std::move(what), measured, expected, expected - most, expected + most, FormatNumber(most));
}

Reading Between(std::string what, double measured, double expected, double low, double high) {
  Reading reading =
      MakeReading(std::move(what), measured, expected, low, high, FormatNumber(low) + "–" + FormatNumber(high));
  reading.error /= expected;
  reading.share = true;
  return reading;
}

bool CaseResult::Holds() const {
  return std::all_of(readings.begin(), readings.end(), [](const Reading& reading) { return reading.Holds(); });
}

std::span<const VerifyCase> VerifyCases() {
  return kCases;
}

}  // namespace percale::cli
