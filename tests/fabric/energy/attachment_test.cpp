// Handles, tethers and inertia: energies of single vertices.

#include "fabric/energy/attachment.h"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

#include "fabric/energy/inertia.h"
#include "math/splitmix64.h"
#include "tests/fabric/energy/energy_checks.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

TEST_CASE("the derivatives of handles, tethers and inertia are those of their energies") {
  SplitMix64 random(21);
  for (int i = 0; i < kStates; ++i) {
    const V anchor = Jitter(random, 1), far = anchor + Jitter(random, 1) + V{2, 0, 0};
    const std::vector<std::function<PointEnergy<double>(const V&)>> energies{
        [&](const V& x) { return Handle(30.0, anchor, x); },
        [&](const V& x) { return TetherEnergy(30.0, anchor, 0.7, x); },
        [&](const V& x) { return Inertia(3e-4 * 300 * 300, x - anchor); }};
    for (const auto& energy : energies) {
      const Value value = [&](const Points& x) { return energy(x[0]).energy; };
      const Gradient gradient = [&](const Points& x) { return Flat(Points{energy(x[0]).gradient}); };
      CheckGradient(value, gradient, {far}, 1e-4);
      CheckHessian(gradient, Dense(energy(far).hessian), {far}, 1e-4);
      CHECK(LeastEigenvalue(Dense(energy(anchor + Jitter(random, 1)).hessian)) >= -1e-12);
    }
  }
}

TEST_CASE("a tether is slack up to its length, also at its anchor") {
  const V anchor{1, 2, 3};
  for (const V& offset : {V{0, 0, 0}, V{0.5, 0, 0}, V{0, 0, -0.699}}) {
    const PointEnergy<double> slack = TetherEnergy(30.0, anchor, 0.7, anchor + offset);
    CHECK(slack.energy == 0);
    CHECK(Norm(slack.gradient) == 0);
    CHECK(Dense(slack.hessian).norm() == 0);
  }
  const PointEnergy<double> none = TetherEnergy(30.0, anchor, 0.0, anchor);
  CHECK((Norm(none.gradient) == 0 && Finite(none.hessian)));
  const PointEnergy<float> single = TetherEnergy(30.0F, Vector3<float>{1, 2, 3}, 0.0F, Vector3<float>{1, 2, 3});
  CHECK((Finite(ToDouble(single.gradient)) && Finite(single.hessian)));
}

TEST_CASE("single vertices: float agrees with double, and two side by side with each alone") {
  SplitMix64 random(24);
  for (int i = 0; i < kStates; ++i) {
    const Points x = Anywhere(random, 2), y = Anywhere(random, 2);
    const PointEnergy<double> taut = TetherEnergy(30.0, x[0], 0.7, x[1]), slack = TetherEnergy(30.0, y[0], 0.7, y[1]);
    const PointEnergy<Two> tethers = TetherEnergy(Two(30), Pair(x[0], y[0]), Two(0.7), Pair(x[1], y[1]));
    const PointEnergy<float> tautF = TetherEnergy(30.0F, ToFloat(x[0]), 0.7F, ToFloat(x[1]));
    CHECK(
        (Same(tethers.gradient, taut.gradient, slack.gradient) && Same(tethers.hessian, taut.hessian, slack.hessian)));
    CHECK(Norm(ToDouble(tautF.gradient) - taut.gradient) <= 1e-5 * 30);
  }
}
