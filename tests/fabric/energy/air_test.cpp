// Wind and enclosed air.

#include "fabric/energy/air.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>

#include "math/splitmix64.h"
#include "tests/fabric/energy/energy_checks.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

TEST_CASE("the derivatives of wind and of volume are those of their energies") {
  SplitMix64 random(22);
  const Air<double> air{1.2, 1.2, 0.05, 0.4};
  const double h = 1.0 / 300;
  for (int i = 0; i < kStates; ++i) {
    const Points start = Anywhere(random, 3), x = Anywhere(random, 3);
    const WindLoad<double> load = MakeWindLoad(air, Jitter(random, 8), start[0], start[1], start[2], Jitter(random, 3));
    const auto wind = [&](const Points& p) {
      V mean{};
      for (std::size_t k = 0; k < 3; ++k) mean += (p[k] - start[k]) * (1.0 / 3);
      return Wind(load, mean, h);
    };
    const Value value = [&](const Points& p) { return wind(p).energy; };
    const Gradient gradient = [&](const Points& p) { return Flat(Points(3, wind(p).gradient)); };
    CheckGradient(value, gradient, x, 1e-4);
    const MatrixXd hessian = Dense(wind(x).hessian).replicate(3, 3);
    CheckHessian(gradient, hessian, x, 1e-4);
    CHECK(LeastEigenvalue(hessian) >= -1e-12 * hessian.norm());

    const Value volume = [](const Points& p) { return Volume(p[0], p[1], p[2]).volume; };
    const Gradient volumeGradient = [](const Points& p) {
      const EnclosedVolume<double> v = Volume(p[0], p[1], p[2]);
      return Flat(Points(v.gradient, v.gradient + 3));
    };
    CheckGradient(volume, volumeGradient, x, 1e-4);
  }
}

TEST_CASE("a plate in the wind is dragged with the coefficient it faces the wind with, and lifted across") {
  const V x0{0, 0, 0}, x1{2, 0, 0}, x2{0, 1, 0};  // area 1, normal z
  const double density = 1.2, speed = 5, dynamic = 0.5 * density * speed * speed;
  const Air<double> plate{density, 1.2, 0.05, 0};
  const auto force = [&](const Air<double>& air, const V& wind) {
    return Wind(MakeWindLoad(air, wind, x0, x1, x2, V{}), V{}, 0.01).gradient * -3.0;
  };
  CHECK(Norm(force(plate, {0, 0, speed}) - V{0, 0, dynamic * 1.2}) <= 1e-12);
  CHECK(Norm(force(plate, {speed, 0, 0}) - V{dynamic * 0.05, 0, 0}) <= 1e-12);
  CHECK(Norm(force(plate, {0, 0, -speed}) + force(plate, {0, 0, speed})) <= 1e-12);
  // A quarter turn between the two: drag and lift of the formula.
  const double root = std::sqrt(0.5);
  const V along{root, 0, root}, across{-root, 0, root}, oblique = along * speed;
  CHECK(Dot(force(plate, oblique), along) == doctest::Approx(dynamic * (0.05 + 1.15 / 2)));
  CHECK(Dot(force(plate, oblique), across) == doctest::Approx(dynamic * 1.15 / 2));
  const Air<double> lifting{density, 1.2, 0.05, 0.4};
  const V more = force(lifting, oblique) - force(plate, oblique);
  CHECK(Norm(more - across * (dynamic * 0.4 / 2)) <= 1e-12);
  // The sign of the normal does not matter; moving with the wind there is no force.
  const V flipped = Wind(MakeWindLoad(lifting, oblique, x0, x2, x1, V{}), V{}, 0.01).gradient * -3.0;
  CHECK(Norm(flipped - force(lifting, oblique)) <= 1e-12);
  CHECK(Norm(Wind(MakeWindLoad(lifting, oblique, x0, x1, x2, oblique), oblique * 0.01, 0.01).gradient) == 0);
  const WindLoad<double> none = MakeWindLoad(lifting, V{}, x0, x0, x0, V{});
  CHECK((Finite(none.drag) && Finite(none.lift)));
}

TEST_CASE("a closed surface encloses its volume wherever it is, and pressure on it has no net force") {
  const V shift{3, -1, 2};
  const Points x{shift, shift + V{1, 0, 0}, shift + V{0, 2, 0}, shift + V{0, 0, 3}};
  const std::size_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  double volume = 0;
  Points gradient(4);
  for (const auto& face : faces) {
    const EnclosedVolume<double> v = Volume(x[face[0]], x[face[1]], x[face[2]]);
    volume += v.volume;
    for (std::size_t k = 0; k < 3; ++k) gradient[face[k]] += v.gradient[k];
  }
  CHECK(volume == doctest::Approx(1));
  CheckMomentum(x, Flat(gradient));
}

TEST_CASE("air: float agrees with double, and two side by side with each alone") {
  SplitMix64 random(24);
  for (int i = 0; i < kStates; ++i) {
    const Points x = Anywhere(random, 4), y = Anywhere(random, 4);
    const auto load = [](const Points& p) {
      return MakeWindLoad(Air<double>{1.2, 1.2, 0.05, 0.4}, p[3], p[0], p[1], p[2], V{});
    };
    const WindEnergy<double> one = Wind(load(x), x[1], 0.01), other = Wind(load(y), y[1], 0.01);
    const WindLoad<float> loadF = MakeWindLoad(Air<float>{1.2F, 1.2F, 0.05F, 0.4F}, ToFloat(x[3]), ToFloat(x[0]),
                                               ToFloat(x[1]), ToFloat(x[2]), Vector3<float>{});
    const WindLoad<Two> load2 = MakeWindLoad(Air<Two>{Two(1.2), Two(1.2), Two(0.05), Two(0.4)}, Pair(x[3], y[3]),
                                             Pair(x[0], y[0]), Pair(x[1], y[1]), Pair(x[2], y[2]), Vector3<Two>{});
    const WindEnergy<Two> both = Wind(load2, Pair(x[1], y[1]), Two(0.01));
    CHECK(Norm(ToDouble(Wind(loadF, ToFloat(x[1]), 0.01F).gradient) - one.gradient) <= 1e-5 * Norm(one.gradient));
    CHECK((Same(both.gradient, one.gradient, other.gradient) && Same(both.hessian, one.hessian, other.hessian)));
  }
}
