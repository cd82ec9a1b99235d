// The fabric engine against closed forms of mechanics: the cases of `percale verify`, with coarser meshes.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_laws.h"

using namespace percale::cli;

namespace {

/// Half as many elements along an edge, where the gates allow it.
Effort CoarseEffort(const VerifyCase& of) {
  const std::set<std::string> needsAll = {"balloon"};
  return {.mesh = of.mesh && !needsAll.count(of.name) ? 0.5 : 1, .step = 1};
}

}  // namespace

TEST_CASE("cloth obeys the laws of mechanics") {
  for (const VerifyCase& of : VerifyCases()) {
    CAPTURE(of.name);
    const CaseResult result = of.run(CoarseEffort(of));
    CHECK(!result.readings.empty());
    for (const Reading& reading : result.readings) {
      CAPTURE(reading.what);
      CAPTURE(reading.expected);
      CHECK(reading.measured >= reading.low);
      CHECK(reading.measured <= reading.high);
    }
  }
}

TEST_CASE("cases have names of their own") {
  std::set<std::string> names;
  for (const VerifyCase& of : VerifyCases()) CHECK(names.insert(of.name).second);
}

TEST_CASE("a reading holds within its gate, and never where there is none") {
  CHECK(Relative("", 102, 100, 0.02).Holds());
  CHECK_FALSE(Relative("", 102.1, 100, 0.02).Holds());
  CHECK(Relative("", -99, -100, 0.02).Holds());
  CHECK(Absolute("", -1e-7, 0, 1e-6).Holds());
  CHECK_FALSE(Absolute("", 1.1e-6, 0, 1e-6).Holds());
  CHECK(Between("", 60, 68, 60, 76).Holds());
  CHECK_FALSE(Between("", 59.9, 68, 60, 76).Holds());
  CHECK_FALSE(Relative("", NAN, 1, 10).Holds());
  CHECK(Relative("", 1, 1, 0.005).gate == "0.5 %");
}

TEST_CASE("a heavy strip bends as published") {
  // Drop over reach; Γ up to 1000.
  const double table[][2] = {{0.1, 0.01250}, {1, 0.12456},  {2, 0.24667},  {4, 0.47765},   {8, 0.88433},
                             {10, 1.06680},  {20, 1.86393}, {50, 3.70556}, {100, 5.88810}, {1000, 21.3354}};
  for (const auto& [gamma, ratio] : table) {
    const HeavyElastica strip = SolveHeavyElastica(gamma);
    CHECK(strip.drop / strip.reach == doctest::Approx(ratio).epsilon(4e-4));
    CHECK(strip.shape.back().x == doctest::Approx(strip.reach));
  }
  // A small weight: ρ g L⁴ / (8 B).
  CHECK(SolveHeavyElastica(1e-3).drop == doctest::Approx(1e-3 / 8).epsilon(1e-5));
  CHECK(GammaOfChord(41.5 * std::numbers::pi / 180) == doctest::Approx(8.0042).epsilon(1e-5));
}

TEST_CASE("the other closed forms agree with published values") {
  const double sags[][2] = {{1.05, .139304}, {1.1, .200301}, {1.2, .292344}, {1.5, .502633}, {2, .796388}};
  for (const auto& [length, sag] : sags) CHECK(CatenarySag(length) == doctest::Approx(sag).epsilon(4e-6));
  // A strip pressed into a fold; ε is how far, then the friction that holds its end.
  const double holds[][2] = {{.05, .1035}, {.1, .1528}, {.2, .2378}, {.3, .3265}, {.4, .4344}};
  for (const auto& [shortening, friction] : holds) {
    const PressedStrip strip = SolvePressedStrip(shortening);
    CHECK(strip.shortening == doctest::Approx(shortening).epsilon(1e-6));
    CHECK(strip.friction == doctest::Approx(friction).epsilon(5e-4));
    CHECK(std::abs(strip.shape.back().x) < 1e-6);
    CHECK(strip.shape.back().y == doctest::Approx(1 - shortening).epsilon(1e-6));
  }
  CHECK(PendulumPeriod(std::numbers::pi / 4) == doctest::Approx(1.039973).epsilon(1e-6));
  CHECK(PendulumPeriod(std::numbers::pi / 2) == doctest::Approx(1.180341).epsilon(1e-6));
  CHECK(1 / StripCompliance(400, 200, .2, 80, 0) == doctest::Approx(400));
  CHECK(1 / StripCompliance(400, 200, .2, 80, std::numbers::pi / 2) == doctest::Approx(200));
  // An isotropic sheet is as stiff every way.
  CHECK(1 / StripCompliance(100, 100, .25, 40, 0.7) == doctest::Approx(100));
  CHECK(std::tan(std::sqrt(kClampedHingedColumn)) == doctest::Approx(std::sqrt(kClampedHingedColumn)).epsilon(1e-4));
  CHECK(std::cos(std::sqrt(kCantileverMode)) * std::cosh(std::sqrt(kCantileverMode)) ==
        doctest::Approx(-1).epsilon(1e-5));
}
