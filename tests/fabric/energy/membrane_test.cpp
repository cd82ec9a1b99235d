// Stretch and shear.

#include "fabric/energy/membrane.h"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "math/splitmix64.h"
#include "tests/fabric/energy/energy_checks.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

namespace {

using test::Dense, test::Flat;

MatrixXd Dense(const MembraneTangent<double>& t) {
  MatrixXd h(6, 6);
  h << Dense(t.uu), Dense(t.uv), Dense(t.uv).transpose(), Dense(t.vv);
  return h;
}
MatrixXd Dense(const TriangleHessian<double>& t) {
  MatrixXd h(9, 9);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    h.block<3, 3>(3 * k, 3 * k) = Dense(t.diagonal[k]);
    h.block<3, 3>(3 * k, 3 * l) = Dense(t.next[k]);
    h.block<3, 3>(3 * l, 3 * k) = Dense(t.next[k]).transpose();
  }
  return h;
}
VectorXd Flat(const TriangleGradient<double>& g) {
  return Flat(Points(g.corner, g.corner + 3));
}

struct Triangle {
  std::array<MaterialPoint, 3> material;
  RestTriangle<double> rest;
};
Triangle AnyTriangle(SplitMix64& random) {
  Triangle t;
  do {
    for (MaterialPoint& p : t.material) p = {Within(random, -1, 1), Within(random, -1, 1)};
    t.rest = MakeRestTriangle(t.material[0], t.material[1], t.material[2]);
  } while (t.rest.area < 0.1);
  return t;
}
Points AtRest(const Triangle& t) {
  Points x;
  for (const MaterialPoint& p : t.material) x.push_back({p.u, p.v, 0});
  return x;
}
DeformationGradient<double> AnyDeformation(SplitMix64& random) {
  return {Jitter(random, 1.2), Jitter(random, 1.2)};
}
StVenantKirchhoff<double> Limited() {
  StVenantKirchhoff<double> law = OrthotropicMembrane(300, 120, 0.3, 40);
  law.limitU = 0.05, law.limitV = 0.1;
  law.limitStiffnessU = 900, law.limitStiffnessV = 700;
  return law;
}
const StableNeoHookean<double> kNeoHookean = NeoHookeanMembrane(261, 0.24);

template <class Law, class... More>
void CheckMembrane(const Law& law, SplitMix64& random, const More&... more) {
  const Triangle t = AnyTriangle(random);
  const Points x = Anywhere(random, 3);
  const auto deformation = [&](const Points& p) { return Deformation(t.rest, p[0], p[1], p[2]); };
  const Value value = [&](const Points& p) { return t.rest.area * Stress(law, deformation(p), more...).energy; };
  const Gradient gradient = [&](const Points& p) {
    return Flat(CornerGradient(t.rest, Stress(law, deformation(p), more...)));
  };
  CheckGradient(value, gradient, x, 1e-4);
  CheckHessian(gradient, Dense(CornerHessian(t.rest, Tangent(law, deformation(x), kExact, more...))), x, 1e-4);
  CheckMomentum(x, gradient(x));
  for (const double floor : {0.0, 30.0}) {
    const MatrixXd h = Dense(Tangent(law, deformation(x), floor, more...));
    CHECK(LeastEigenvalue(h) >= -floor - 1e-12 * h.norm());
  }
}

/// The projection that an eigen-decomposition gives.
MatrixXd Projected(const MatrixXd& a, double floor) {
  const Spectrum spectrum = SpectrumOf(a);
  const VectorXd raised = spectrum.values.cwiseMax(-floor);
  return spectrum.vectors * raised.asDiagonal() * spectrum.vectors.transpose();
}

}  // namespace

TEST_CASE("the derivatives of the membranes are those of their energies") {
  SplitMix64 random(1);
  for (int i = 0; i < kStates; ++i) {
    CheckMembrane(OrthotropicMembrane(300, 120, 0.3, 40), random);
    CheckMembrane(Limited(), random);
    const MembraneDamping<double> damping{Within(random, 0, 3), GreenStrain(AnyDeformation(random))};
    CheckMembrane(Limited(), random, damping);
    CheckMembrane(kNeoHookean, random);
  }
}

TEST_CASE("the clamp of the neo-Hookean second derivative is the projection of the exact one") {
  SplitMix64 random(2);
  for (int i = 0; i < kStates; ++i) {
    const DeformationGradient<double> f = AnyDeformation(random);
    const MatrixXd exact = Dense(Tangent(kNeoHookean, f, kExact));
    for (const double floor : {0.0, 20.0}) {
      CHECK((Dense(Tangent(kNeoHookean, f, floor)) - Projected(exact, floor)).norm() <= 1e-9 * exact.norm());
    }
  }
}

TEST_CASE("a symmetric matrix of two by two is clamped as by its eigenvalues") {
  SplitMix64 random(3);
  for (int i = 0; i < kStates; ++i) {
    const double a = Within(random, -1, 1), b = Within(random, -1, 1), c = Within(random, -1, 1);
    const double floor = i % 2 == 0 ? 0 : 0.3;
    const Symmetric2<double> s = ClampedEigenvalues<double>({a, b, c}, floor);
    Eigen::Matrix2d dense, clamped;
    dense << a, c, c, b;
    clamped << s.a, s.c, s.c, s.b;
    CHECK((clamped - Projected(dense, floor)).norm() <= 1e-14);
  }
}

TEST_CASE("a membrane that moves rigidly feels nothing, nor does its damping") {
  SplitMix64 random(4);
  for (int i = 0; i < kStates; ++i) {
    const Triangle t = AnyTriangle(random);
    const Points rest = AtRest(t), x = Moved(rest, Jitter(random, 1), Within(random, -3, 3), Jitter(random, 1));
    const DeformationGradient<double> f = Deformation(t.rest, x[0], x[1], x[2]);
    const StVenantKirchhoff<double> law = Limited();
    CHECK(Stress(law, f).energy <= 1e-24 * law.c11);
    CHECK(Flat(CornerGradient(t.rest, Stress(law, f))).norm() <= 1e-12 * law.c11);
    CHECK(Flat(CornerGradient(t.rest, Stress(kNeoHookean, f))).norm() <= 1e-12 * law.c11);
    CHECK(std::fabs(Stress(kNeoHookean, f).energy) <= 1e-12 * law.c11);

    const Points bent = Anywhere(random, 3), turned = Moved(bent, Jitter(random, 1), 2, Jitter(random, 1));
    const MembraneDamping<double> damping{5, GreenStrain(Deformation(t.rest, bent[0], bent[1], bent[2]))};
    const DeformationGradient<double> g = Deformation(t.rest, turned[0], turned[1], turned[2]);
    const MembraneStress<double> with = Stress(law, g, damping), without = Stress(law, g);
    CHECK(Norm(with.pu - without.pu) + Norm(with.pv - without.pv) <= 1e-11 * (Norm(with.pu) + Norm(with.pv)));
  }
}

TEST_CASE("damping takes work out of any straining, at the rate of its constant") {
  const StVenantKirchhoff<double> law = IsotropicMembrane(100, 0.2);
  const DeformationGradient<double> start{{1, 0, 0}, {0, 1, 0}}, end{{1 + 1e-6, 0, 0}, {0, 1, 0}};
  const double beta = 0.02, h = 0.01;
  const double damped = Stress(law, end, {beta / h, GreenStrain(start)}).pu.x - Stress(law, end).pu.x;
  CHECK(damped == doctest::Approx(law.c11 * beta * 1e-6 / h).epsilon(1e-5));
}

TEST_CASE("both membranes answer small strain alike") {
  const StVenantKirchhoff<double> linear = IsotropicMembrane(261, 0.24);
  const DeformationGradient<double> rest{{1, 0, 0}, {0, 1, 0}};
  CHECK((Dense(Tangent(linear, rest, kExact)) - Dense(Tangent(kNeoHookean, rest, kExact))).norm() <=
        1e-10 * linear.c11);
}

TEST_CASE("patch: a linear displacement gives the same stress in every triangle, and balance inside") {
  SplitMix64 random(5);
  const V fu{1.1, 0.05, 0.2}, fv{-0.1, 0.9, 0.3};
  const std::vector<MaterialPoint> ring{{1, 0}, {0.6, 0.9}, {-0.4, 0.8}, {-1, 0.1}, {-0.3, -0.9}, {0.7, -0.6}};
  const MaterialPoint centre{0.13, -0.21};
  const auto at = [&](const MaterialPoint& p) { return fu * p.u + fv * p.v + V{3, 1, 2}; };
  const StVenantKirchhoff<double> law = Limited();
  const MembraneStress<double> expected = Stress(law, DeformationGradient<double>{fu, fv});
  V onCentre{}, onCentreNeo{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const MaterialPoint& a = ring[i];
    const MaterialPoint& b = ring[(i + 1) % ring.size()];
    const RestTriangle<double> rest = MakeRestTriangle(centre, a, b);
    const DeformationGradient<double> f = Deformation(rest, at(centre), at(a), at(b));
    const MembraneStress<double> stress = Stress(law, f);
    CHECK(Norm(stress.pu - expected.pu) + Norm(stress.pv - expected.pv) <= 1e-10 * Norm(expected.pu));
    onCentre += CornerGradient(rest, stress).corner[0];
    onCentreNeo += CornerGradient(rest, Stress(kNeoHookean, f)).corner[0];
  }
  CHECK(Norm(onCentre) <= 1e-10 * Norm(expected.pu));
  CHECK(Norm(onCentreNeo) <= 1e-10 * Norm(expected.pu));
}

TEST_CASE("a strip cut at any angle has the modulus of the closed form") {
  const double warp = 300, weft = 120, poisson = 0.3, shear = 25;
  const StVenantKirchhoff<double> law = OrthotropicMembrane(warp, weft, poisson, shear);
  CHECK(StripStiffness(law, 0) == doctest::Approx(warp));
  CHECK(StripStiffness(law, std::numbers::pi / 2) == doctest::Approx(weft));
  const double diagonal = 4 / (1 / warp + 1 / weft - 2 * poisson / warp + 1 / shear);
  CHECK(StripStiffness(law, std::numbers::pi / 4) == doctest::Approx(diagonal));
  const StVenantKirchhoff<double> isotropic = IsotropicMembrane(261, 0.24);
  for (const double angle : {0.0, 0.3, 0.8, 1.2}) CHECK(StripStiffness(isotropic, angle) == doctest::Approx(261));

  // Along the strip the stretch is given; across it and in shear the energy is least, by Newton on three unknowns.
  for (const double angle : {0.0, std::numbers::pi / 4, std::numbers::pi / 2, 0.3}) {
    const V along{std::cos(angle), std::sin(angle), 0}, across{-std::sin(angle), std::cos(angle), 0};
    const double strain = 1e-5;
    // F = along ⊗ along (1 + strain) + across ⊗ (p along + q across); the columns are F's on the material axes.
    const auto deformation = [&](double p, double q) {
      const V side = across * q + along * p;
      return DeformationGradient<double>{along * ((1 + strain) * along.x) + side * across.x,
                                         along * ((1 + strain) * along.y) + side * across.y};
    };
    double p = 0, q = 1;
    for (int i = 0; i < 20; ++i) {
      const DeformationGradient<double> f = deformation(p, q);
      const MembraneStress<double> s = Stress(law, f);
      const MatrixXd h = Dense(Tangent(law, f, kExact));
      Eigen::Matrix<double, 6, 2> columns;
      columns << along.x * across.x, across.x * across.x, along.y * across.x, across.y * across.x, 0, 0,
          along.x * across.y, across.x * across.y, along.y * across.y, across.y * across.y, 0, 0;
      const Eigen::Vector2d g = columns.transpose() * Flat(Points{s.pu, s.pv});
      const Eigen::Vector2d step = -SolutionOf(columns.transpose() * h * columns, g);
      p += step(0), q += step(1);
    }
    const double energy = Stress(law, deformation(p, q)).energy;
    CHECK(2 * energy / (strain * strain) == doctest::Approx(StripStiffness(law, angle)).epsilon(1e-4));
  }
}

TEST_CASE("constants that make no rest shape are told") {
  CHECK(IsPositiveDefinite(OrthotropicMembrane(300, 120, 0.3, 40)));
  CHECK_FALSE(IsPositiveDefinite(OrthotropicMembrane(300, 120, 0.3, 0)));
  CHECK_FALSE(IsPositiveDefinite(OrthotropicMembrane(100, 400, 0.6, 40)));  // ν² E_v / E_u = 1.44
}

TEST_CASE("the strain limit acts beyond it only, and joins smoothly") {
  StVenantKirchhoff<double> bare = Limited();
  bare.limitStiffnessU = bare.limitStiffnessV = 0;
  const auto stretched = [](double green) {
    return DeformationGradient<double>{{std::sqrt(1 + 2 * green), 0, 0}, {0, 1, 0}};
  };
  CHECK(Stress(Limited(), stretched(0.049)).energy == Stress(bare, stretched(0.049)).energy);
  const double over = 1e-3;
  CHECK(Stress(Limited(), stretched(0.05 + over)).energy - Stress(bare, stretched(0.05 + over)).energy ==
        doctest::Approx(900.0 / 3 * over * over * over));
}

TEST_CASE("membranes of no area, or collapsed, stay finite and bounded from below") {
  const RestTriangle<double> none = MakeRestTriangle({0, 0}, {1, 1}, {2, 2});
  CHECK(none.area == 0);
  const V x[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK(Stress(Limited(), Deformation(none, x[0], x[1], x[2])).energy * none.area == 0);

  const std::vector<DeformationGradient<double>> collapsed{
      {{0, 0, 0}, {0, 0, 0}},    {{1, 0, 0}, {1, 0, 0}},    {{1, 2, 3}, {-2, -4, -6}},    {{1, 0, 0}, {0, 0, 0}},
      {{1, 0, 0}, {1, 1e-9, 0}}, {{1, 0, 0}, {1, 2e-6, 0}}, {{1e-8, 0, 0}, {0, 1e-8, 0}}, {{1e3, 0, 0}, {0, 0, 1e-9}}};
  for (const DeformationGradient<double>& f : collapsed) {
    const MembraneStress<double> s = Stress(kNeoHookean, f);
    CHECK((std::isfinite(s.energy) && Finite(s.pu) && Finite(s.pv)));
    const MatrixXd h = Dense(Tangent(kNeoHookean, f, 0.0));
    CHECK(h.allFinite());
    CHECK(LeastEigenvalue(h) >= -1e-12 * h.norm());
    CHECK(Dense(Tangent(Limited(), f, 0.0)).allFinite());

    const DeformationGradient<float> g{ToFloat(f.u), ToFloat(f.v)};
    const StableNeoHookean<float> law{static_cast<float>(kNeoHookean.mu), static_cast<float>(kNeoHookean.lambdaPrime)};
    const MembraneTangent<float> t = Tangent(law, g, 0.0F);
    CHECK((Finite(t.uu) && Finite(t.uv) && Finite(t.vv) && Finite(ToDouble(Stress(law, g).pu))));
  }
}

TEST_CASE("membranes in float agree with double, and two side by side with each alone") {
  SplitMix64 random(6);
  for (int i = 0; i < kStates; ++i) {
    const StVenantKirchhoff<double> law = Limited();
    const auto single = [](double a) { return static_cast<float>(a); };
    const StVenantKirchhoff<float> lawF{single(law.c11),
                                        single(law.c12),
                                        single(law.c22),
                                        single(law.c33),
                                        single(law.limitU),
                                        single(law.limitV),
                                        single(law.limitStiffnessU),
                                        single(law.limitStiffnessV)};
    const StVenantKirchhoff<Two> law2{Two(law.c11),
                                      Two(law.c12),
                                      Two(law.c22),
                                      Two(law.c33),
                                      Two(law.limitU),
                                      Two(law.limitV),
                                      Two(law.limitStiffnessU),
                                      Two(law.limitStiffnessV)};
    const StableNeoHookean<float> neoF{single(kNeoHookean.mu), single(kNeoHookean.lambdaPrime)};
    const StableNeoHookean<Two> neo2{Two(kNeoHookean.mu), Two(kNeoHookean.lambdaPrime)};
    const DeformationGradient<double> f = AnyDeformation(random), g = AnyDeformation(random);
    const DeformationGradient<float> fF{ToFloat(f.u), ToFloat(f.v)};
    const DeformationGradient<Two> fg{Pair(f.u, g.u), Pair(f.v, g.v)};
    const auto check = [&](const auto& one, const auto& ofFloat, const auto& ofTwo) {
      const MembraneStress<double> s = Stress(one, f), other = Stress(one, g);
      const MembraneStress<float> sF = Stress(ofFloat, fF);
      const double scale = Norm(s.pu) + Norm(s.pv) + law.c11;
      CHECK(Norm(ToDouble(sF.pu) - s.pu) + Norm(ToDouble(sF.pv) - s.pv) <= 1e-5 * scale);
      const MembraneStress<Two> both = Stress(ofTwo, fg);
      CHECK((Same(both.pu, s.pu, other.pu) && Same(both.pv, s.pv, other.pv) && both.energy.b == other.energy));
      const MembraneTangent<double> t = Tangent(one, f, 10.0), otherT = Tangent(one, g, 10.0);
      const MembraneTangent<float> tF = Tangent(ofFloat, fF, 10.0F);
      double worst = 0, greatest = 0;
      for (int k = 0; k < 9; ++k) {
        for (const double d : {tF.uu.m[k] - t.uu.m[k], tF.uv.m[k] - t.uv.m[k], tF.vv.m[k] - t.vv.m[k]}) {
          worst = std::max(worst, std::fabs(d));
        }
        greatest = std::max({greatest, std::fabs(t.uu.m[k]), std::fabs(t.vv.m[k])});
      }
      CHECK(worst <= 1e-4 * greatest);
      const MembraneTangent<Two> bothT = Tangent(ofTwo, fg, Two(10.0));
      CHECK((Same(bothT.uu, t.uu, otherT.uu) && Same(bothT.uv, t.uv, otherT.uv) && Same(bothT.vv, t.vv, otherT.vv)));
    };
    check(law, lawF, law2);
    check(kNeoHookean, neoF, neo2);
  }
}
