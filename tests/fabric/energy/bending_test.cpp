// Bending, and folds that set.

#include "fabric/energy/bending.h"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <type_traits>
#include <vector>

#include "math/splitmix64.h"
#include "tests/fabric/energy/energy_checks.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

namespace {

using test::Dense, test::Flat;

constexpr BendingStiffness kStiffness{2e-4, 4e-5, 1e-4, 3e-5};

using Corners = std::array<MaterialPoint, 3>;

/// Reflection of corner k of a triangle at the midpoint of the edge across: its neighbour in a lattice.
MaterialPoint Reflected(const Corners& p, std::size_t k) {
  const MaterialPoint &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
  return {a.u + b.u - p[k].u, a.v + b.v - p[k].v};
}
double Area(const MaterialPoint& a, const MaterialPoint& b, const MaterialPoint& c) {
  return 0.5 * std::fabs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v));
}

/// A triangle and the points across its edges; without one where `across` says so.
struct Patch {
  std::array<MaterialPoint, 6> material;
  BendingMatrix<double> matrix;
  std::array<HingeWeights<double>, 3> weights;
};
V Flat3(const MaterialPoint& p) {
  return {p.u, p.v, 0};
}
Patch MakePatch(const std::array<MaterialPoint, 6>& material, const BendingStiffness& stiffness,
                const std::array<bool, 3>& across = {true, true, true}) {
  Patch patch{material, {}, {}};
  const MaterialPoint p[3] = {material[0], material[1], material[2]};
  double area[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const MaterialPoint &a = material[(k + 1) % 3], &b = material[(k + 2) % 3];
    area[k] = across[k] ? Area(a, b, material[3 + k]) : 0;
    if (across[k]) patch.weights[k] = MakeHingeWeights(Flat3(a), Flat3(b), Flat3(material[k]), Flat3(material[3 + k]));
  }
  patch.matrix = MakeBendingMatrix(stiffness, p, area);
  return patch;
}
Patch LatticePatch(const Corners& p, const BendingStiffness& stiffness,
                   const std::array<bool, 3>& across = {true, true, true}) {
  return MakePatch({p[0], p[1], p[2], Reflected(p, 0), Reflected(p, 1), Reflected(p, 2)}, stiffness, across);
}
template <class F>
Points Raised(const Patch& patch, const F& height) {
  Points x;
  for (const MaterialPoint& p : patch.material) x.push_back({p.u, p.v, height(p)});
  return x;
}
EdgeAngles<double> Angles(const Points& x) {
  EdgeAngles<double> angles;
  for (std::size_t k = 0; k < 3; ++k) angles.edge[k] = HingeAngle(x[(k + 1) % 3], x[(k + 2) % 3], x[k], x[3 + k]);
  return angles;
}
VectorXd AnglesGradient(const Points& x, const EdgeAngles<double>& moment) {
  Points g(6);
  for (std::size_t k = 0; k < 3; ++k) {
    const Hinge<double> hinge = HingeGradient(x[(k + 1) % 3], x[(k + 2) % 3], x[k], x[3 + k]);
    g[(k + 1) % 3] += hinge.gradient[0] * moment.edge[k];
    g[(k + 2) % 3] += hinge.gradient[1] * moment.edge[k];
    g[k] += hinge.gradient[2] * moment.edge[k];
    g[3 + k] += hinge.gradient[3] * moment.edge[k];
  }
  return Flat(g);
}
MatrixXd Dense(const BendingHessian<double>& t) {
  MatrixXd h(18, 18);
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      h.block<3, 3>(3 * i, 3 * j) = Dense(t.block[Upper6(i, j)]);
      h.block<3, 3>(3 * j, 3 * i) = Dense(t.block[Upper6(i, j)]).transpose();
    }
  }
  return h;
}
MatrixXd GaussNewtonOf(const BendingMatrix<double>& m, const Points& x) {
  Hinge<double> hinge[3];
  for (std::size_t k = 0; k < 3; ++k) hinge[k] = HingeGradient(x[(k + 1) % 3], x[(k + 2) % 3], x[k], x[3 + k]);
  return Dense(GaussNewton(m, hinge));
}
QuadraticBending<double> QuadraticOf(const Patch& patch) {
  return MakeQuadraticBending(patch.matrix, {patch.weights[0], patch.weights[1], patch.weights[2]});
}
BendingGradient<double> QuadraticGradientOf(const QuadraticBending<double>& q, const Points& x) {
  return QuadraticGradient(q, {x[0], x[1], x[2], x[3], x[4], x[5]});
}

/// A triangle of good shape, its neighbours of any, all bent.
Patch AnyPatch(SplitMix64& random) {
  const auto near = [&](double u, double v) {
    return MaterialPoint{u + Within(random, -0.2, 0.2), v + Within(random, -0.2, 0.2)};
  };
  return MakePatch({near(0, 0), near(1, 0), near(0, 1), near(1, 1), near(-1, 1), near(1, -1)}, kStiffness);
}
Points Bent(const Patch& patch, SplitMix64& random) {
  return Raised(patch, [&](const MaterialPoint&) { return Within(random, -0.4, 0.4); });
}

double PlateEnergy(const BendingStiffness& b, double k11, double k22, double k12) {
  return 0.5 * (b.b11 * k11 * k11 + 2 * b.b12 * k11 * k22 + b.b22 * k22 * k22 + 4 * b.b33 * k12 * k12);
}
double Energy(const Patch& patch, const Points& x) {
  return Moments(patch.matrix, Angles(x), {}).energy;
}

}  // namespace

TEST_CASE("the derivative of an angle is that of its differences, and conserves momentum") {
  SplitMix64 random(11);
  for (int i = 0; i < kStates; ++i) {
    const Points x = Anywhere(random, 4);
    const Value value = [](const Points& p) { return HingeAngle(p[0], p[1], p[2], p[3]); };
    const Gradient gradient = [](const Points& p) {
      const Hinge<double> h = HingeGradient(p[0], p[1], p[2], p[3]);
      return Flat(Points(h.gradient, h.gradient + 4));
    };
    // Where it wraps, or a triangle is thin, differences say nothing.
    const double height1 = Norm(Cross(x[1] - x[0], x[2] - x[0])) / Norm(x[1] - x[0]);
    const double height2 = Norm(Cross(x[1] - x[0], x[3] - x[0])) / Norm(x[1] - x[0]);
    if (std::fabs(value(x)) > 3 || std::min(height1, height2) < 0.1) continue;
    CheckGradient(value, gradient, x, 1e-4);
    CheckMomentum(x, gradient(x));
    const Hinge<double> hinge = HingeGradient(x[0], x[1], x[2], x[3]), other = FromAcross(hinge);
    const Hinge<double> swapped = HingeGradient(x[1], x[0], x[3], x[2]);
    CHECK(hinge.angle == value(x));
    CHECK(swapped.angle == doctest::Approx(hinge.angle));
    for (int k = 0; k < 4; ++k) CHECK(Norm(other.gradient[k] - swapped.gradient[k]) <= 1e-12 / height1 / height2);
  }
}

TEST_CASE("an angle is the fold's: zero where flat, positive in a valley") {
  for (const double fold : {-3.0, -1.0, -1e-9, 0.0, 0.5, 2.0}) {
    const V flat{-2, 0.3, 0}, folded{3 * std::cos(fold), -0.7, 3 * std::sin(fold)};
    CHECK(HingeAngle<double>({0, -1, 0}, {0, 1, 0}, flat, folded) == doctest::Approx(fold));
  }
}

TEST_CASE("the derivatives of bending are those of its energy") {
  SplitMix64 random(12);
  for (int i = 0; i < kStates; ++i) {
    const Patch patch = AnyPatch(random);
    const Points x = Bent(patch, random);
    const EdgeAngles<double> rest{{Within(random, -1, 1), Within(random, -1, 1), 0}};
    const BendingDamping<double> damping{2, {{0.1, -0.3, Within(random, -1, 1)}}};
    const auto moments = [&](const Points& p) { return Moments(patch.matrix, Angles(p), rest, damping); };
    const Value value = [&](const Points& p) { return moments(p).energy; };
    const Gradient gradient = [&](const Points& p) { return AnglesGradient(p, moments(p).moment); };
    CheckGradient(value, gradient, x, 1e-4);
    CheckMomentum(x, gradient(x));

    // Where there is no moment the Gauss-Newton matrix is exact.
    const EdgeAngles<double> here = Angles(x);
    const Gradient unbent = [&](const Points& p) {
      return AnglesGradient(p, Moments(patch.matrix, Angles(p), here).moment);
    };
    const MatrixXd h = GaussNewtonOf(patch.matrix, x);
    CheckHessian(unbent, h, x, 1e-4);
    CHECK(LeastEigenvalue(h) >= -1e-12 * h.norm());

    const QuadraticBending<double> q = QuadraticOf(patch);
    const Value quadratic = [&](const Points& p) { return QuadraticGradientOf(q, p).energy; };
    const Gradient quadraticGradient = [&](const Points& p) {
      const BendingGradient<double> g = QuadraticGradientOf(q, p);
      return Flat(Points(g.vertex, g.vertex + 6));
    };
    CheckGradient(quadratic, quadraticGradient, x, 1e-4);
    CheckMomentum(x, quadraticGradient(x));
    MatrixXd constant(18, 18);
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        constant.block<3, 3>(3 * r, 3 * c) =
            q.entry[r <= c ? Upper6(r, c) : Upper6(c, r)] * Eigen::Matrix3d::Identity();
      }
    }
    CheckHessian(quadraticGradient, constant, x, 1e-4);
    CHECK(LeastEigenvalue(constant) >= -1e-12 * constant.norm());
  }
}

TEST_CASE("bending that moves rigidly feels nothing, nor does its damping") {
  SplitMix64 random(13);
  for (int i = 0; i < kStates; ++i) {
    const Patch patch = AnyPatch(random);
    const Points bent = Bent(patch, random);
    const V axis = Jitter(random, 1);
    const Points turned = Moved(bent, axis, 2, Jitter(random, 1));
    const BendingMoments<double> still = Moments(patch.matrix, Angles(turned), Angles(bent), {5, Angles(bent)});
    CHECK(AnglesGradient(turned, still.moment).norm() <= 1e-12 * kStiffness.b11);
    const Points flat = Moved(Raised(patch, [](const MaterialPoint&) { return 0.0; }), axis, 1, Jitter(random, 1));
    CHECK(AnglesGradient(flat, Moments(patch.matrix, Angles(flat), {}).moment).norm() <= 1e-12 * kStiffness.b11);
    CHECK(std::fabs(QuadraticGradientOf(QuadraticOf(patch), flat).energy) <= 1e-14 * kStiffness.b11);
  }
}

TEST_CASE("a quadratic surface on a lattice has a plate's energy, whatever its curvature and the lattice") {
  SplitMix64 random(14);
  const double root = std::sqrt(3.0) / 2;
  const std::vector<Corners> lattices{{{{0, 0}, {1, 0}, {0, 1}}},
                                      {{{0, 0}, {1, 0}, {1, 1}}},
                                      {{{0, 0}, {1, 0}, {0.5, root}}},
                                      {{{0.1, -0.2}, {0.9, 0.3}, {0.2, 1.4}}}};
  for (const Corners& lattice : lattices) {
    for (const BendingStiffness& stiffness : {kStiffness, IsotropicBending(1e-4, 0.3)}) {
      const Patch patch = LatticePatch(lattice, stiffness);
      const double area = Area(lattice[0], lattice[1], lattice[2]);
      for (int i = 0; i < kStates; ++i) {
        const double small = 1e-5;  // so that slopes are angles
        const double k11 = small * Within(random, -1, 1), k22 = small * Within(random, -1, 1);
        const double k12 = small * Within(random, -1, 1);
        const Points x = Raised(
            patch, [&](const MaterialPoint& p) { return 0.5 * (k11 * p.u * p.u + k22 * p.v * p.v) + k12 * p.u * p.v; });
        const double expected = area * PlateEnergy(stiffness, k11, k22, k12);
        CHECK(Energy(patch, x) == doctest::Approx(expected).epsilon(1e-8));
        CHECK(QuadraticGradientOf(QuadraticOf(patch), x).energy == doctest::Approx(expected).epsilon(1e-8));
      }
    }
  }
  const BendingStiffness b = IsotropicBending(1e-4, 0.3);
  const double formula = 0.5 * (1e-4 * (4 + 9) + 2 * 0.3 * 1e-4 * 2 * 3 + 2 * (1 - 0.3) * 1e-4 * 25);
  CHECK(PlateEnergy(b, 2, 3, 5) == doctest::Approx(formula));
}

TEST_CASE("hinges alone are three times too stiff along a grid line, and nine times along the diagonal") {
  const Corners lattice{{{0, 0}, {1, 0}, {1, 1}}};  // diagonal along (1, 1)
  const double rigidity = 1e-4, small = 1e-5;
  const Patch patch = LatticePatch(lattice, IsotropicBending(rigidity, 0));
  const auto hinges = [&](double k11, double k22, double k12) {
    const EdgeAngles<double> angles = Angles(Raised(
        patch, [&](const MaterialPoint& p) { return 0.5 * (k11 * p.u * p.u + k22 * p.v * p.v) + k12 * p.u * p.v; }));
    double energy = 0;  // of half of each hinge, over the triangle's area ½
    for (std::size_t k = 0; k < 3; ++k) {
      const MaterialPoint &a = lattice[(k + 1) % 3], &b = lattice[(k + 2) % 3];
      const double squared = (b.u - a.u) * (b.u - a.u) + (b.v - a.v) * (b.v - a.v);
      energy += 0.5 * 0.5 * rigidity * 3 * squared * angles.edge[k] * angles.edge[k];
    }
    return energy / 0.5;
  };
  const double plate = 0.5 * rigidity * small * small;
  CHECK(hinges(small, 0, 0) == doctest::Approx(3 * plate).epsilon(1e-8));
  CHECK(hinges(small / 2, small / 2, small / 2) == doctest::Approx(9 * plate).epsilon(1e-8));
  CHECK(hinges(small / 2, small / 2, -small / 2) == doctest::Approx(3 * plate).epsilon(1e-8));
}

TEST_CASE("a free edge carries no moment: a narrow strip bends with the rigidity of a beam") {
  // One row of squares along u: in either triangle of a square the edge along u is free.
  const double rigidity = 1e-4, poisson = 0.3, small = 1e-5;
  const auto energy = [&](const BendingStiffness& stiffness) {
    const Corners lower{{{0, 0}, {1, 0}, {1, 1}}};
    const Patch patch = LatticePatch(lower, stiffness, {true, true, false});
    return Energy(patch, Raised(patch, [&](const MaterialPoint& p) { return 0.5 * small * p.u * p.u; })) / 0.5;
  };
  const double half = 0.5 * small * small;
  CHECK(energy(IsotropicBending(rigidity, poisson)) ==
        doctest::Approx(half * rigidity * (1 - poisson * poisson)).epsilon(1e-8));
  CHECK(energy(OrthotropicBending(3e-4, 1e-4, 0.4, 2e-5)) == doctest::Approx(half * 3e-4).epsilon(1e-8));
  const BendingStiffness strip = OrthotropicBending(1e-4, 1e-4, 0.3, 1e-4 / 2.6);
  const BendingStiffness plate = IsotropicBending(1e-4 / (1 - 0.09), 0.3);
  CHECK(strip.b11 == doctest::Approx(plate.b11));
  CHECK(strip.b12 == doctest::Approx(plate.b12));
  CHECK(strip.b33 == doctest::Approx(plate.b33));

  // Condensing is minimising over the free angle.
  const Corners any{{{0, 0}, {1.1, 0.2}, {0.3, 0.8}}};
  const BendingMatrix<double> full = LatticePatch(any, kStiffness).matrix;
  const BendingMatrix<double> free = LatticePatch(any, kStiffness, {true, false, true}).matrix;
  const EdgeAngles<double> angles{{0.3, 0, -0.2}};
  EdgeAngles<double> best = angles;
  best.edge[1] = -(full * angles).edge[1] / full.diagonal[1];
  CHECK(Moments(free, angles, {}).energy == doctest::Approx(Moments(full, best, {}).energy));
  CHECK(free.diagonal[1] == 0);
  for (const double entry : LatticePatch(any, kStiffness, {false, false, false}).matrix.diagonal) CHECK(entry == 0);
}

TEST_CASE("what bends in one direction alone gives no energy away, whichever edges are free") {
  SplitMix64 random(31);
  for (const BendingStiffness& b : {BendingStiffness{0, 0, 1, 0}, {1, 0, 0, 0}, {1e-5, 0, 1, 0}, {0, 0, 0, 1}}) {
    for (int i = 0; i < kStates; ++i) {
      const double skew = i == 0 ? 0 : Within(random, -0.3, 0.3), u = i == 0 ? 1 : Within(random, 0.1, 2);
      const Corners any{{{0, 0}, {u, skew}, {-skew, 1}}};
      for (int free = 0; free < 8; ++free) {
        const std::array<bool, 3> across{(free & 1) == 0, (free & 2) == 0, (free & 4) == 0};
        const BendingMatrix<double> m = LatticePatch(any, b, across).matrix, whole = LatticePatch(any, b).matrix;
        Eigen::Matrix3d dense;
        dense << m.diagonal[0], m.next[0], m.next[2], m.next[0], m.diagonal[1], m.next[1], m.next[2], m.next[1],
            m.diagonal[2];
        const double scale = whole.diagonal[0] + whole.diagonal[1] + whole.diagonal[2];
        const VectorXd eigenvalues = SpectrumOf(dense).values;
        CHECK(eigenvalues(0) >= -1e-9 * scale);
        CHECK(eigenvalues(2) <= (1 + 1e-9) * scale);
      }
    }
  }
}

TEST_CASE("on a jittered mesh a quadratic surface has nearly a plate's energy") {
  constexpr int kSide = 24;
  SplitMix64 random(15);
  std::vector<MaterialPoint> points;
  for (int j = 0; j <= kSide; ++j) {
    for (int i = 0; i <= kSide; ++i) {
      points.push_back({i + Within(random, -0.2, 0.2), j + Within(random, -0.2, 0.2)});
    }
  }
  const auto at = [&](int i, int j) { return points[static_cast<std::size_t>(j * (kSide + 1) + i)]; };
  const double small = 1e-6;
  const double curvatures[][3] = {{1, 0, 0}, {0, 1, 0},  {0.5, 0.5, 0.5}, {0.5, 0.5, -0.5},
                                  {1, 1, 0}, {1, -1, 0}, {0, 0, 1}};
  for (const auto& k : curvatures) {
    double energy = 0, area = 0;
    for (int j = 1; j + 1 < kSide; ++j) {
      for (int i = 1; i + 1 < kSide; ++i) {
        const std::array<MaterialPoint, 6> halves[2] = {
            {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i + 2, j + 1), at(i, j + 1), at(i, j - 1)},
            {at(i, j), at(i + 1, j + 1), at(i, j + 1), at(i + 1, j + 2), at(i - 1, j), at(i + 1, j)}};
        for (const std::array<MaterialPoint, 6>& half : halves) {
          const Patch patch = MakePatch(half, IsotropicBending(1e-4, 0.3));
          energy += Energy(patch, Raised(patch, [&](const MaterialPoint& p) {
                             return small * (0.5 * (k[0] * p.u * p.u + k[1] * p.v * p.v) + k[2] * p.u * p.v);
                           }));
          area += Area(half[0], half[1], half[2]);
        }
      }
    }
    const double expected = area * PlateEnergy(IsotropicBending(1e-4, 0.3), small * k[0], small * k[1], small * k[2]);
    CHECK(energy / expected > 1);
    CHECK(energy / expected < 1.2);
  }
}

TEST_CASE("fitted bending is exact for quadratic surfaces on any mesh, and equals the other on a lattice") {
  SplitMix64 random(18);
  const auto fitted = [](const Patch& patch, const bool(&present)[3]) {
    const auto& q = patch.material;
    return MakeFittedBendingMatrix(kStiffness, {q[0], q[1], q[2]}, {q[3], q[4], q[5]}, present);
  };
  for (const Corners& lattice : {Corners{{{0, 0}, {1, 0}, {1, 1}}}, Corners{{{0.1, -0.2}, {0.9, 0.3}, {0.2, 1.4}}}}) {
    for (int free = 0; free < 8; ++free) {
      const bool present[3] = {(free & 1) == 0, (free & 2) == 0, (free & 4) == 0};
      const Patch patch = LatticePatch(lattice, kStiffness, {present[0], present[1], present[2]});
      const BendingMatrix<double> fit = fitted(patch, present);
      for (int k = 0; k < 3; ++k) {
        CHECK(std::fabs(fit.diagonal[k] - patch.matrix.diagonal[k]) <= 1e-12 * kStiffness.b11);
        CHECK(std::fabs(fit.next[k] - patch.matrix.next[k]) <= 1e-12 * kStiffness.b11);
      }
    }
  }
  for (int i = 0; i < kStates; ++i) {
    const auto near = [&](double u, double v) {
      return MaterialPoint{u + Within(random, -0.15, 0.15), v + Within(random, -0.15, 0.15)};
    };
    Patch patch = MakePatch({near(0, 0), near(1, 0), near(1, 1), near(2, 1), near(0, 1), near(0, -1)}, kStiffness);
    patch.matrix = fitted(patch, {true, true, true});
    const double small = 1e-5, k11 = small * Within(random, -1, 1), k22 = small * Within(random, -1, 1);
    const double k12 = small * Within(random, -1, 1);
    const double expected =
        Area(patch.material[0], patch.material[1], patch.material[2]) * PlateEnergy(kStiffness, k11, k22, k12);
    CHECK(Energy(patch, Raised(patch, [&](const MaterialPoint& p) {
                   return 0.5 * (k11 * p.u * p.u + k22 * p.v * p.v) + k12 * p.u * p.v;
                 })) == doctest::Approx(expected).epsilon(1e-8));
  }
}

TEST_CASE("fitted bending is finite, positive and bounded where the six points determine no surface") {
  const double third = 2 * std::numbers::pi / 3, wide = 1;
  const auto onCircle = [](double angle) { return MaterialPoint{std::cos(angle), std::sin(angle)}; };
  for (const double off : {0.0, 1e-9, 1e-3, 0.1}) {  // six points of a regular hexagon, but for `off`
    const MaterialPoint p[3] = {onCircle(0), onCircle(third), onCircle(2 * third)};
    const MaterialPoint across[3] = {{-1 - off, 0}, onCircle(2.5 * third), onCircle(0.5 * third)};
    double areas[3];
    for (int k = 0; k < 3; ++k) areas[k] = Area(p[(k + 1) % 3], p[(k + 2) % 3], across[k]);
    const BendingMatrix<double> m = MakeFittedBendingMatrix(kStiffness, p, across, {true, true, true});
    const BendingMatrix<double> plain = MakeBendingMatrix(kStiffness, p, areas);
    Eigen::Matrix3d dense;
    dense << m.diagonal[0], m.next[0], m.next[2], m.next[0], m.diagonal[1], m.next[1], m.next[2], m.next[1],
        m.diagonal[2];
    const Eigen::Vector3d eigenvalues = SpectrumOf(dense).values;
    CHECK(eigenvalues(0) > 0);
    CHECK(eigenvalues(2) <= 1.0001 * kFitCap * (plain.diagonal[0] + plain.diagonal[1] + plain.diagonal[2]));
  }
  for (const double width : {0.0, 1e-300, 1e-12}) {
    for (const bool all : {true, false}) {
      const BendingMatrix<double> m = MakeFittedBendingMatrix(
          kStiffness, {{0, 0}, {wide, 0}, {0.5, width}}, {{0.7, 1}, {0.2, width}, {0.5, -width}}, {all, true, true});
      for (int k = 0; k < 3; ++k) CHECK((std::isfinite(m.diagonal[k]) && std::isfinite(m.next[k])));
    }
  }
}

TEST_CASE("a triangle across a seam unfolds to where it would be without") {
  SplitMix64 random(19);
  for (int i = 0; i < kStates; ++i) {
    const MaterialPoint from{0, 0}, to{1.3, 0.4}, corner{0.2, 0.9}, apex{Within(random, 0, 2), -1};
    const double angle = Within(random, -3, 3), mirror = i % 2 == 0 ? 1 : -1;
    const auto panel = [&](const MaterialPoint& p) {
      return MaterialPoint{5 + std::cos(angle) * p.u - mirror * std::sin(angle) * p.v,
                           -2 + std::sin(angle) * p.u + mirror * std::cos(angle) * p.v};
    };
    const MaterialPoint back = UnfoldedApex(from, to, corner, panel(from), panel(to), panel(apex));
    CHECK(back.u == doctest::Approx(apex.u));
    CHECK(back.v == doctest::Approx(apex.v));
    const MaterialPoint other = UnfoldedApex(to, from, corner, panel(to), panel(from), panel(apex));
    CHECK(other.v == doctest::Approx(apex.v));
  }
}

TEST_CASE("the quadratic jump of slope is 2 sin(θ/2) long while the hinge is not stretched, and forgets affine maps") {
  SplitMix64 random(16);
  for (int i = 0; i < kStates; ++i) {
    const V x0{0, -1, 0}, x1{0, 1, 0}, x2{-Within(random, 0.5, 2), Within(random, -1, 1), 0};
    const double reach = Within(random, 0.5, 2), along = Within(random, -1, 1), fold = Within(random, -3, 3);
    const HingeWeights<double> c = MakeHingeWeights(x0, x1, x2, {reach, along, 0});
    const V x3{reach * std::cos(fold), along, reach * std::sin(fold)};
    const auto jump = [&](const V& p0, const V& p1, const V& p2, const V& p3) {
      return p0 * c.vertex[0] + p1 * c.vertex[1] + p2 * c.vertex[2] + p3 * c.vertex[3];
    };
    CHECK(Norm(jump(x0, x1, x2, x3)) == doctest::Approx(2 * std::fabs(std::sin(fold / 2))));
    const V a = Jitter(random, 2), b = Jitter(random, 2), d = Jitter(random, 2);
    const auto affine = [&](const V& p) { return a * p.x + b * p.y + d; };
    CHECK(Norm(jump(affine(x0), affine(x1), affine(x2), affine({reach, along, 0}))) <= 1e-13);
    const HingeWeights<double> folded = MakeHingeWeights(x0, x1, x2, x3);
    for (int k = 0; k < 4; ++k) CHECK(folded.vertex[k] == doctest::Approx(c.vertex[k]));
  }
}

TEST_CASE("bending of degenerate triangles stays finite") {
  const std::vector<Points> degenerate{
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}},       {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}},       {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-20, 0}, {0.5, -1e-20, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0}},   {{0, 0, 0}, {1e-20, 0, 0}, {0, 1, 0}, {0, -1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}, {0.5, 0, 1}}};
  for (const Points& x : degenerate) {
    const Hinge<double> h = HingeGradient(x[0], x[1], x[2], x[3]);
    const Hinge<float> f = HingeGradient(ToFloat(x[0]), ToFloat(x[1]), ToFloat(x[2]), ToFloat(x[3]));
    CHECK((std::isfinite(h.angle) && std::isfinite(f.angle)));
    for (int k = 0; k < 4; ++k) CHECK((Finite(h.gradient[k]) && Finite(ToDouble(f.gradient[k]))));
    const HingeWeights<double> c = MakeHingeWeights(x[0], x[1], x[2], x[3]);
    for (const double weight : c.vertex) CHECK(std::isfinite(weight));
  }
  for (const double width : {0.0, 1e-300, 1e-12}) {
    const BendingMatrix<double> m =
        MakeBendingMatrix(kStiffness, {{0, 0}, {1, 0}, {0.5, width}}, {0.5 * width, 0, 0.3});
    for (int k = 0; k < 3; ++k) CHECK((std::isfinite(m.diagonal[k]) && std::isfinite(m.next[k])));
  }
}

TEST_CASE("bending in float agrees with double, and two side by side with each alone") {
  SplitMix64 random(17);
  for (int i = 0; i < kStates; ++i) {
    const Patch patch = AnyPatch(random);
    const Points x = Bent(patch, random), y = Bent(patch, random);
    const Hinge<double> h = HingeGradient(x[1], x[2], x[0], x[3]), g = HingeGradient(y[1], y[2], y[0], y[3]);
    const Hinge<float> f = HingeGradient(ToFloat(x[1]), ToFloat(x[2]), ToFloat(x[0]), ToFloat(x[3]));
    const Hinge<Two> both = HingeGradient(Pair(x[1], y[1]), Pair(x[2], y[2]), Pair(x[0], y[0]), Pair(x[3], y[3]));
    CHECK(f.angle == doctest::Approx(h.angle).epsilon(1e-5));
    CHECK((both.angle.a == h.angle && both.angle.b == g.angle));
    for (int k = 0; k < 4; ++k) {
      CHECK(Norm(ToDouble(f.gradient[k]) - h.gradient[k]) <= 1e-5 * Norm(h.gradient[2]));
      CHECK(Same(both.gradient[k], h.gradient[k], g.gradient[k]));
    }

    BendingMatrix<Two> m2;
    for (int k = 0; k < 3; ++k) m2.diagonal[k] = Two(patch.matrix.diagonal[k]), m2.next[k] = Two(patch.matrix.next[k]);
    const auto three = [](const auto& hinge) { return GaussNewton<std::decay_t<decltype(hinge.angle)>>; };
    const Hinge<Two> threeBoth[3] = {both, both, both};
    const Hinge<double> threeH[3] = {h, h, h}, threeG[3] = {g, g, g};
    const BendingHessian<Two> t2 = three(both)(m2, threeBoth);
    const BendingHessian<double> tH = GaussNewton(patch.matrix, threeH), tG = GaussNewton(patch.matrix, threeG);
    for (int k = 0; k < 21; ++k) CHECK(Same(t2.block[k], tH.block[k], tG.block[k]));

    // Far from the origin too, where float has the coordinates exactly.
    QuadraticBending<float> qF;
    const QuadraticBending<double> q = QuadraticOf(patch);
    for (int k = 0; k < 21; ++k) qF.entry[k] = static_cast<float>(q.entry[k]);
    Points far;
    const auto round = [](double a) { return std::round(a * 65536) / 65536; };  // a float below 256
    for (const V& p : x) far.push_back({round(100 + p.x), round(p.y), round(p.z)});
    const BendingGradient<double> gradient = QuadraticGradientOf(q, far);
    const BendingGradient<float> gradientF = QuadraticGradient(
        qF, {ToFloat(far[0]), ToFloat(far[1]), ToFloat(far[2]), ToFloat(far[3]), ToFloat(far[4]), ToFloat(far[5])});
    double scale = 0;
    for (const V& v : gradient.vertex) scale = std::max(scale, Norm(v));
    for (int k = 0; k < 6; ++k) CHECK(Norm(ToDouble(gradientF.vertex[k]) - gradient.vertex[k]) <= 1e-5 * scale);
  }
}

TEST_CASE("a fold beyond its yield sets: the elastic part returns to it, hardened, whatever the step") {
  const FoldYield<double> perfect{.angle = 0.5}, hard{.angle = 0.5, .hardening = 0.25};
  for (const double sign : {-1.0, 1.0}) {
    CHECK(YieldedRestAngle(sign * 0.6, {sign * 0.2, 0.0}, perfect).rest == sign * 0.2);
    const SetFold<double> set = YieldedRestAngle(sign * 2.0, {sign * 0.2, 0.0}, perfect);
    CHECK(set.rest == doctest::Approx(sign * 1.5));
    CHECK(set.moved == doctest::Approx(1.3));
    const SetFold<double> hardened = YieldedRestAngle(sign * 2.0, {0.0, 0.0}, hard);
    CHECK(std::fabs(sign * 2 - hardened.rest) == doctest::Approx(hard.angle + hard.hardening * hardened.moved));
    CHECK(YieldedRestAngle(sign * 2.0, hardened, hard).rest == doctest::Approx(hardened.rest));
  }
  // Creep: what is beyond decays exponentially, in one step as in many.
  const auto after = [](int steps) {
    SetFold<double> fold;
    const FoldYield<double> yield{.angle = 0.5, .share = CreepShare(3, 0.2 / steps)};
    for (int i = 0; i < steps; ++i) fold = YieldedRestAngle(2.0, fold, yield);
    return fold.rest;
  };
  CHECK(after(1) == doctest::Approx(1.5 * (1 - std::exp(-0.6))));
  CHECK(after(100) == doctest::Approx(after(1)));
}
