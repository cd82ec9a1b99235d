// Every kernel of every instruction set against the plain functions it stands for, and against each other to the bit.

#include "fabric/kernels.h"
#include "fabric/block_parts.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "fabric/fabric_model.h"
#include "fabric/system_matrix.h"
#include "math/splitmix64.h"
#include "tests/fabric/sheet.h"

using namespace percale;
using namespace percale::fabric;

namespace {

/// Triangles at random places, some without area at rest and some collapsed to a point or a line.
struct Triangles {
  explicit Triangles(int count) {
    const auto unit = [&] { return 2 * random.NextUnit() - 1; };
    for (int v = 0; v < 12; ++v) x.push_back({unit(), unit(), unit()}), mass.push_back(random.NextUnit());
    for (int t = 0; t < count; ++t) {
      const auto vertex = [&] { return static_cast<std::int32_t>(random.Next() % x.size()); };
      const std::int32_t a = vertex();
      triangles.push_back({a, t % 7 == 3 ? a : vertex(), t % 5 == 2 ? a : vertex()});
      chartTriangles.push_back({3 * t + 1, 3 * t, 3 * t + 2});
      const Vec2 b{1 + 0.3 * unit(), unit()}, c{0.5 * unit(), 1.0};
      chart.insert(chart.end(), {b, Vec2{0, 0}, t % 11 == 6 ? b : c});
      const auto corner = [&](std::int32_t p) { return MaterialPoint{chart[Index(p)].x, chart[Index(p)].y}; };
      rest.push_back(MakeRestTriangle(corner(3 * t + 1), corner(3 * t), corner(3 * t + 2)));
      strength.push_back(1 + t % 3);
      rest.back().area *= strength.back();
    }
    const std::size_t padded = Index(count + kTrianglePad);
    for (std::vector<double>* array : {&start[0], &start[1], &start[2]}) array->assign(padded, 0);
    for (std::size_t t = 0; t < rest.size(); ++t) {
      for (std::vector<double>& strain : start) strain[t] = 0.1 * unit();
      stiffening.push_back(random.NextUnit());
    }
    gradient.assign(3 * rest.size(), {7, 7, 7});
    hessian.assign(kHessianReals * rest.size(), 7);
  }

  MembraneArgs Arguments(int begin, int end, MembraneLaw law, double damping) {
    return {.begin = begin,
            .end = end,
            .triangles = triangles.data(),
            .x = x.data(),
            .chartTriangles = chartTriangles.data(),
            .chart = chart.data(),
            .strength = strength.data(),
            .law = law,
            .orthotropic = orthotropic,
            .neoHookean = neoHookean,
            .damping = damping,
            .startStrain = {start[0].data(), start[1].data(), start[2].data()},
            .mass = mass.data(),
            .bendStiffness = 3,
            .stiffening = stiffening.data(),
            .compression = 90,
            .outFirst = 0,
            .gradient = gradient.data(),
            .hessian = hessian.data()};
  }
  DeformationGradient<double> F(std::size_t t) const {
    const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
    return Deformation(rest[t], at(triangles[t].a), at(triangles[t].b), at(triangles[t].c));
  }

  double Buckling(std::size_t t) const {
    const double weight = mass[Index(triangles[t].a)] + mass[Index(triangles[t].b)] + mass[Index(triangles[t].c)];
    const double area = rest[t].area / strength[t];
    return area > 0 ? 2 * std::sqrt(3 * stiffening[t] * weight / (6 * area)) / strength[t] : 0;
  }

  SplitMix64 random{5};
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  std::vector<RestTriangle<double>> rest;  // area times strength
  std::vector<Triangle> chartTriangles;
  std::vector<Vec2> chart;
  std::vector<double> strength, start[3], mass, stiffening;
  StVenantKirchhoff<double> orthotropic{300, 60, 200, 100, 0.2, 0.3, 1000, 2000};
  StableNeoHookean<double> neoHookean = NeoHookeanMembrane(261, 0.24);
  std::vector<Vec3> gradient;
  RealVector hessian;
};

constexpr int kCounts[] = {1, 2, 3, 7, 8, 9, 16, 37};

}  // namespace

TEST_CASE("the membrane's kernels agree with the law, triangle by triangle, and with each other to the bit") {
  for (const int count : kCounts) {
    for (const MembraneLaw law : {MembraneLaw::StVenantKirchhoff, MembraneLaw::NeoHookean}) {
      for (const double damping : {0.0, 0.4}) {
        const int begin = count > 8 ? 8 : 0;
        Triangles reference(count);
        double firstEnergy = 0;
        for (const Kernels* kernels : RunnableKernels()) {
          CAPTURE(kernels->name);
          CAPTURE(count);
          Triangles s(count);
          const MembraneArgs arguments = s.Arguments(begin, count, law, damping);
          const double energy = kernels->membraneEnergy(arguments);
          kernels->membraneGradient(arguments);
          const std::vector<Vec3> gradientOnly = s.gradient;
          kernels->membraneTangent(arguments);
          CHECK(gradientOnly == s.gradient);

          double expectedEnergy = 0;
          for (std::size_t t = 0; t < s.rest.size(); ++t) {
            if (static_cast<int>(t) < begin) {
              CHECK(s.gradient[3 * t] == Vec3{7, 7, 7});
              CHECK(s.hessian[kHessianReals * t] == 7);
              continue;
            }
            const auto compare = [&](const auto& of, const auto&... damped) {
              const DeformationGradient<double> f = s.F(t);
              const MembraneStress<double> stress = Stress(of, f, damped...);
              expectedEnergy += s.rest[t].area * stress.energy;
              const TriangleGradient<double> g = CornerGradient(s.rest[t], stress);
              const TriangleHessian<double> h =
                  CornerHessian(s.rest[t], Tangent(of, f, s.Buckling(t) * arguments.compression, damped...));
              // Without a normal any will do, and the law's second derivative depends on it.
              const Vector3<double> cross = Cross(f.u, f.v);
              const bool sameTangent = law != MembraneLaw::NeoHookean || Dot(cross, cross) > 1e-4;
              double size = 1;
              for (const Matrix3<double>& block : h.next) {
                for (const double entry : block.m) size = std::max(size, std::abs(entry));
              }
              for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 off = s.gradient[3 * t + k] - ToVec3(g.corner[k]);
                CHECK(Dot(off, off) <= 1e-24 * (1 + Dot(g.corner[k], g.corner[k])));
                for (int c = 0; c < 9; ++c) {
                  const double entry = s.hessian[kHessianReals * t + 9 * k + Index(c)];
                  CHECK(std::isfinite(entry));
                  if (sameTangent) CHECK(std::abs(entry - h.next[k](c % 3, c / 3)) <= 3e-5 * size);
                }
              }
            };
            if (law == MembraneLaw::NeoHookean)
              compare(s.neoHookean);
            else
              compare(s.orthotropic, MembraneDamping<double>{damping, {s.start[0][t], s.start[1][t], s.start[2][t]}});
          }
          CHECK(energy == doctest::Approx(expectedEnergy).epsilon(1e-12));

          if (kernels == RunnableKernels().front()) {
            firstEnergy = energy, reference.gradient = s.gradient, reference.hessian = s.hessian;
          }
          CHECK(energy == firstEnergy);
          CHECK(s.gradient == reference.gradient);
          CHECK(s.hessian == reference.hessian);
        }
      }
    }
  }
}

TEST_CASE("strains at the start of a step are those of the triangles, and no others are written") {
  for (const int count : kCounts) {
    for (const Kernels* kernels : RunnableKernels()) {
      CAPTURE(kernels->name);
      Triangles s(count);
      const std::vector<double> before = s.start[1];
      kernels->membraneStrain(s.Arguments(0, count, MembraneLaw::StVenantKirchhoff, 1));
      for (std::size_t t = 0; t < s.start[0].size(); ++t) {
        if (t >= s.rest.size()) {
          CHECK(s.start[1][t] == before[t]);
          continue;
        }
        const MembraneStrain<double> strain = GreenStrain(s.F(t));
        CHECK(s.start[0][t] == doctest::Approx(strain.e11).epsilon(1e-12));
        CHECK(s.start[1][t] == doctest::Approx(strain.e22).epsilon(1e-12));
        CHECK(s.start[2][t] == doctest::Approx(strain.shear).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("the greatest stretch is that of the triangle that is longest in one direction, on all processors") {
  for (const int count : kCounts) {
    for (const Kernels* kernels : RunnableKernels()) {
      CAPTURE(kernels->name);
      Triangles s(count);
      MembraneStretch expected;
      for (int t = 0; t < count; ++t) {
        const DeformationGradient<double> f = s.F(Index(t));
        // Of all directions, and then nearer and nearer to the best of them.
        const auto along = [&](double angle) {
          const Vector3<double> d = f.u * std::cos(angle) + f.v * std::sin(angle);
          return Dot(d, d);
        };
        double best = 0;
        for (double width = 1.6, step = 0.1; step > 1e-9; width = 2 * step, step /= 10) {
          const double centre = best;
          for (double angle = centre - width; angle <= centre + width; angle += step) {
            if (along(angle) > along(best)) best = angle;
          }
        }
        if (along(best) > expected.square) expected = {along(best), t};
      }
      const MembraneStretch greatest =
          kernels->membraneStretch(s.Arguments(0, count, MembraneLaw::StVenantKirchhoff, 0));
      CHECK(greatest.triangle == expected.triangle);
      CHECK(greatest.square == doctest::Approx(expected.square).epsilon(1e-12));
    }
  }
}

TEST_CASE("the wind's kernel agrees with the load of each triangle") {
  const double h = 1.0 / 90;
  const Air<double> air{1.2, 1.1, 0.01, 0.3};
  for (const int count : kCounts) {
    std::vector<VertexLoad> first;
    for (const Kernels* kernels : RunnableKernels()) {
      CAPTURE(kernels->name);
      Triangles s(count);
      std::vector<Vec3> previous = s.x;
      for (Vec3& x : previous) x += Vec3{s.random.NextUnit(), s.random.NextUnit(), s.random.NextUnit()} * 0.1;
      std::vector<VertexLoad> loads(Index(count) + 1);
      kernels->windLoads({.begin = 0,
                          .end = count,
                          .triangles = s.triangles.data(),
                          .x = s.x.data(),
                          .previous = previous.data(),
                          .h = h,
                          .air = air,
                          .wind = {1, -2, 3},
                          .outFirst = 0,
                          .load = loads.data()});
      CHECK(loads.back().force == Vec3{});
      for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        const Triangle& tri = s.triangles[t];
        Vec3 velocity;
        for (const std::int32_t v : {tri.a, tri.b, tri.c}) velocity += (s.x[Index(v)] - previous[Index(v)]) / (3 * h);
        const auto at = [&](std::int32_t v) { return From<double>(s.x[Index(v)]); };
        const WindLoad<double> load =
            MakeWindLoad(air, {1, -2, 3}, at(tri.a), at(tri.b), at(tri.c), From<double>(velocity));
        const Vec3 off = loads[t].force - ToVec3(load.drag * load.wind + load.lift) / 3;
        CHECK(Dot(off, off) < 1e-20 * (1 + Dot(loads[t].force, loads[t].force)));
        for (std::size_t k = 0; k < 9; ++k) {
          CHECK(loads[t].stiffness.Full().m[k] == doctest::Approx(load.drag.m[k] / (3 * h)).epsilon(1e-10));
        }
      }
      if (first.empty()) first = loads;
      for (std::size_t t = 0; t < loads.size(); ++t) {
        CHECK(loads[t].force == first[t].force);
        for (std::size_t k = 0; k < 9; ++k) CHECK(loads[t].stiffness.Full().m[k] == first[t].stiffness.Full().m[k]);
      }
    }
  }
}

TEST_CASE("the force of plates is the product of their matrix, where they are") {
  const test::Sheet sheet = test::Disc(5);
  const ScalarMatrix matrix = test::ConstantPart(sheet, {});
  SplitMix64 random(11);
  std::vector<Vec3> x;
  std::vector<std::uint8_t> isPlate;
  for (int v = 0; v < sheet.vertices(); ++v) {
    x.push_back({random.NextUnit(), random.NextUnit(), random.NextUnit()});
    isPlate.push_back(v % 5 != 2);
  }
  std::vector<Vec3> first;
  double firstSum = 0;
  for (const Kernels* kernels : RunnableKernels()) {
    CAPTURE(kernels->name);
    std::vector<Vec3> force(x.size(), {7, 7, 7});
    const double sum = kernels->plateForces({.begin = 3,
                                             .end = sheet.vertices(),
                                             .rows = matrix.View(),
                                             .isPlate = isPlate.data(),
                                             .x = x.data(),
                                             .force = force.data()});
    double expectedSum = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (v < 3 || !isPlate[v]) {
        CHECK(force[v] == Vec3{7, 7, 7});
        continue;
      }
      Vec3 expected;
      matrix.ForRow(static_cast<std::int32_t>(v), [&](std::int32_t column, double value) {
        const Vec3 way = x[Index(column)] - x[v];
        expected += way * value;
        expectedSum += value * Dot(way, way);
      });
      CHECK(Length(force[v] - expected) <= 1e-12 * (1 + Length(expected)));
    }
    CHECK(sum == doctest::Approx(expectedSum));
    if (first.empty()) first = force, firstSum = sum;
    CHECK(force == first);
    CHECK(sum == firstSum);
  }
}

TEST_CASE("the matrix is the sum of the triangles' blocks") {
  const test::Sheet sheet = test::Disc(4);
  const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
  const auto blocksOf = test::TriangleBlocks(pattern, sheet.triangles);
  const std::size_t blocks = Index(pattern.stored()), parts = 3 * sheet.triangles.size();
  const Lists corners = ListBy(sheet.vertices(), parts, [&](std::size_t e) {
    const Triangle& t = sheet.triangles[e / 3];
    return e % 3 == 0 ? t.a : e % 3 == 1 ? t.b : t.c;
  });
  const Slots codes = FindBlockParts(pattern, sheet.triangles, corners);
  std::vector<std::uint32_t> wideCodes;
  codes.InArray([&](const auto* code) { wideCodes.assign(code, code + codes.size()); });
  SplitMix64 random(3);
  RealVector hessian(kHessianReals * sheet.triangles.size() + 1, 0);
  for (Real& entry : hessian) entry = static_cast<Real>(2 * random.NextUnit() - 1);
  std::vector<Real> diagonal;
  RowSharer<Real> constant(sheet.vertices());
  std::vector<double> expected(9 * blocks, 0);
  const auto addConstant = [&](std::int32_t row, std::int32_t column, Real value) {
    for (const std::size_t c : {0, 4, 8})
      expected[9 * Index(pattern.Find(row, column)) + c] += static_cast<double>(value);
  };
  for (std::int32_t row = 0; row < sheet.vertices(); ++row) {
    diagonal.push_back(static_cast<Real>(0.01 * row));
    addConstant(row, row, diagonal.back());
    std::vector<std::pair<std::int32_t, Real>> values;
    pattern.columns.ForRow(row, [&](std::int32_t column, std::int32_t) {
      if (column <= row) return;
      values.push_back({column, static_cast<Real>(0.02 * column)});
      addConstant(row, column, values.back().second);
    });
    values.push_back({0, 7});  // outside the pattern: does not count here
    constant.Append(values);
  }
  const SharedRows<Real> constants = constant.Take();
  for (std::size_t e = 0; e < parts; ++e) {
    const auto& of = blocksOf[e / 3];
    const std::size_t k = e % 3, l = (k + 1) % 3;
    for (std::size_t c = 0; c < 9; ++c) {
      const double entry = hessian[e / 3 * kHessianReals + 9 * k + c];
      const std::size_t mirrored = c % 3 * 3 + c / 3;
      // Stored is the one of the two that is right of the diagonal.
      const Triangle& t = sheet.triangles[e / 3];
      const std::int32_t corner[3] = {t.a, t.b, t.c};
      expected[9 * Index(of[3 * k + l]) + (corner[k] < corner[l] ? c : mirrored)] += entry;
      expected[9 * Index(of[4 * k]) + c] -= entry;
      expected[9 * Index(of[4 * l]) + mirrored] -= entry;
    }
  }
  RealVector first;
  for (const Kernels* kernels : RunnableKernels()) {
    CAPTURE(kernels->name);
    RealVector filled(9 * blocks + 1, 7);
    for (const int begin : {0, 20}) {
      kernels->assemble({.begin = begin,
                         .end = begin == 0 ? 20 : sheet.vertices(),
                         .columns = pattern.columns.View(),
                         .storedFirst = pattern.storedFirst.data(),
                         .diagonal = diagonal.data(),
                         .constant = constants.View(),
                         .cornerFirst = corners.first.data(),
                         .corner = corners.entry.data(),
                         .parts = begin == 0 ? codes.narrow() : nullptr,
                         .wideParts = begin == 0 ? nullptr : wideCodes.data(),
                         .cornersBegin = 0,
                         .corners = 3 * static_cast<std::int32_t>(sheet.triangles.size()),
                         .hessian = hessian.data(),
                         .blocks = filled.data()});
    }
    for (std::size_t k = 0; k < 9 * blocks; ++k) CHECK(std::abs(filled[k] - expected[k]) < 1e-5);
    CHECK(filled.back() == 7);
    if (first.empty()) first = filled;
    CHECK(filled == first);
  }
}

TEST_CASE("products with the matrix have the same bits on all processors, contacts or not") {
  const Executor executor(1);
  // In a disc hardly two rows are alike; in a grid most are like the one before.
  for (const auto& [sheet, contacts] :
       {std::pair(test::Disc(15), 0), std::pair(test::Disc(15), 50), std::pair(test::Square(15), 50)}) {
    const int rows = sheet.vertices();
    const RealVector x = test::RandomVector(rows, 1), b = test::RandomVector(rows, 2);
    std::vector<RealVector> first;
    double firstDot = 0;
    for (const Kernels* kernels : RunnableKernels()) {
      CAPTURE(kernels->name);
      SystemMatrix matrix(*kernels);
      matrix.SetUp(MakePattern(rows, sheet.triangles), test::ConstantPart(sheet, {}), sheet.pinned);
      matrix.Reset(executor);
      test::AddMembrane(sheet, {}, matrix);
      matrix.SetExtra(test::RemotePairs(sheet, contacts, 100), executor);
      matrix.Finish(executor);
      std::vector<RealVector> y(4, RealVector(VectorLength(rows), 0));
      std::vector<double> sums(Index(Chunks(rows)));
      matrix.Multiply(x.data(), y[0].data(), executor);
      const double dot = matrix.MultiplyDot(x.data(), y[1].data(), sums, executor);
      matrix.Residual(b.data(), x.data(), y[2].data(), executor);
      matrix.Smooth(Real{0.5}, b.data(), x.data(), y[3].data(), executor);
      if (first.empty()) first = y, firstDot = dot;
      CHECK(y[1] == y[0]);
      CHECK(y == first);
      CHECK(dot == firstDot);
    }
  }
}
