// The linear algebra of the implicit solver: each operator against its dense twin, and how fast the solver converges.

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/executor.h"
#include "fabric/conjugate_gradient.h"
#include "fabric/dense_factor.h"
#include "fabric/multigrid.h"
#include "fabric/prolongation.h"
#include "fabric/slots.h"
#include "fabric/system_matrix.h"
#include "math/splitmix64.h"
#include "tests/fabric/decompositions.h"
#include "tests/fabric/sheet.h"
#include "tests/sanitized.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

namespace {

using Dense = Eigen::MatrixXd;

const Executor& Serial() {
  static const Executor executor(1);
  return executor;
}

Eigen::VectorXd ToEigen(const RealVector& x, int rows) {
  Eigen::VectorXd y(3 * rows);
  for (int k = 0; k < 3 * rows; ++k) y[k] = static_cast<double>(x[k]);
  return y;
}

Dense ToEigen(const SystemMatrix& matrix) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> dense(3 * matrix.rows(), 3 * matrix.rows());
  matrix.ToDense(dense.data());
  return dense;
}

Dense ToEigen(const Prolongation& p) {
  Dense dense = Dense::Zero(3 * p.rows(), 3 * p.nodes);
  for (int row = 0; row < p.rows(); ++row) {
    for (int k = p.first[row]; k < p.first[row + 1]; ++k) {
      for (int r = 0; r < 3; ++r) dense(3 * row + r, 3 * p.column[k] + r) = static_cast<double>(p.weight[k]);
    }
  }
  return dense;
}

/// What the matrix of a sheet has to be, from its parts.
Dense Expected(const Sheet& sheet, const Cloth& cloth, std::span<const ExtraTerm> extra) {
  SystemMatrix membrane;
  const ScalarMatrix nothing = MakeScalarMatrix(sheet.vertices(), {});
  membrane.SetUp(MakePattern(sheet.vertices(), sheet.triangles), nothing);
  membrane.Reset(Serial());
  AddMembrane(sheet, cloth, membrane);
  const int n = 3 * sheet.vertices();
  Dense dense = Dense::Zero(n, n);
  membrane.ToDense(dense.data());
  const auto add = [&](int row, int column, const Real* block) {
    for (int k = 0; k < 9; ++k) dense(3 * row + k % 3, 3 * column + k / 3) += static_cast<double>(block[k]);
  };
  const ScalarMatrix constant = ConstantPart(sheet, cloth);
  for (int row = 0; row < constant.rows(); ++row) {
    constant.ForRow(row, [&](std::int32_t column, double value) {
      for (int r = 0; r < 3; ++r) dense(3 * row + r, 3 * column + r) += value;
    });
  }
  for (const ExtraTerm& e : extra) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        if (e.vertex[i] < 0 || e.vertex[j] < 0) continue;
        Real block[9];
        for (int k = 0; k < 9; ++k) block[k] = e.weight[i] * e.weight[j] * e.block[k];
        add(e.vertex[i], e.vertex[j], block);
      }
    }
  }
  for (int k = 0; k < n; ++k) {
    if (!sheet.pinned[k / 3]) continue;
    dense.row(k).setZero();
    dense.col(k).setZero();
    dense(k, k) = 1;
  }
  return dense;
}

/// A matrix with its multigrid, by material coordinates or by aggregates.
struct Solver : System {
  Multigrid multigrid;
  ConjugateGradient gradient;
  Sheet sheet;

  Solver(const Sheet& of, bool material, const Cloth& cloth = {}, std::span<const ExtraTerm> extra = {},
         const Executor& executor = Serial())
      : System(of, executor, cloth, extra), sheet(of) {
    multigrid.SetUp(matrix, MakeHierarchy(matrix.pattern(), material ? of.Mesh() : of.NoMaterial(), of.pinned));
    multigrid.Refill(matrix, executor);
    gradient.SetUp(matrix.rows());
  }

  RealVector Solve(const RealVector& b, SolveResult& result, const SolveSettings& settings,
                   const Executor& executor = Serial()) {
    RealVector x(VectorLength(matrix.rows()), 0), residual = b;
    result = gradient.Solve(matrix, multigrid, residual.data(), x.data(), settings, executor);
    return x;
  }
  int Iterations(const RealVector& b, double tolerance) {
    SolveResult result;
    Solve(b, result, {1000, tolerance});
    return result.end == SolveEnd::Converged ? result.iterations : 1000;
  }
};

double RelativeError(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

/// Loose squares of four vertices.
Sheet Confetti(int pieces) {
  Sheet sheet;
  for (int k = 0; k < pieces; ++k) {
    const int a = sheet.vertices();
    for (const Vec2& corner : {Vec2{0, 0}, Vec2{.01, 0}, Vec2{0, .01}, Vec2{.01, .01}}) {
      sheet.rest.push_back({corner.x + .02 * k, corner.y});
    }
    sheet.triangles.push_back({a, a + 1, a + 2});
    sheet.triangles.push_back({a + 1, a + 3, a + 2});
  }
  sheet.material = sheet.rest;
  sheet.materialTriangles = sheet.triangles;
  sheet.pinned.assign(sheet.rest.size(), 0);
  return sheet;
}

}  // namespace

TEST_CASE("blocks are where the corners of triangles say") {
  const Sheet sheet = Square(5);
  const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles, std::vector<Edge>{{0, 24}});
  CHECK(pattern.rows() == 25);
  // By their lower row, then by the other.
  std::set<std::pair<std::int32_t, std::int32_t>> pairs{{0, 24}};
  for (std::int32_t v = 0; v < 25; ++v) pairs.insert({v, v});
  for (const Triangle& t : sheet.triangles) {
    for (const auto& [a, b] : {std::pair(t.a, t.b), {t.b, t.c}, {t.c, t.a}}) pairs.insert(std::minmax(a, b));
  }
  CHECK(pattern.stored() == static_cast<int>(pairs.size()));
  std::int32_t index = 0;
  for (const auto& [a, b] : pairs) {
    CHECK(pattern.Find(a, b) == index);
    CHECK(pattern.Find(b, a) == index++);
  }
  CHECK(pattern.Find(0, 23) == -1);
  CHECK(pattern.Find(23, 0) == -1);
  // A row says where the stored blocks are that have its others transposed.
  for (std::int32_t row = 0; row < 25; ++row) {
    std::int32_t before = -1;
    pattern.columns.ForRow(row, [&](std::int32_t column, std::int32_t mirrored) {
      CHECK(column > std::exchange(before, column));
      if (column < row) CHECK(pattern.storedFirst[column] + mirrored == pattern.Find(row, column));
      if (column >= row) CHECK(mirrored == 0);
    });
  }
}

TEST_CASE("what tells of a regular grid is kept once for rows that are alike") {
  const auto kinds = [](int side) {
    const Sheet sheet = Square(side);
    const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
    return pattern.columns.first.size() - 1;
  };
  CHECK(kinds(40) == kinds(12));
  CHECK(kinds(12) < 20);
}

TEST_CASE("a restriction is the transpose of its prolongation, and lists are what was added") {
  const Sheet sheet = Disc(12);
  const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
  for (const Prolongation& p : MakeHierarchy(pattern, sheet.Mesh())) {
    std::vector<std::vector<std::pair<std::int32_t, Real>>> expected(p.nodes);
    for (std::int32_t row = 0; row < p.rows(); ++row) {
      for (std::int32_t e = p.first[row]; e < p.first[row + 1]; ++e)
        expected[p.column[e]].push_back({row, p.weight[e]});
    }
    const Restriction restriction = MakeRestriction(p);
    for (std::int32_t node = 0; node < p.nodes; ++node) {
      std::vector<std::pair<std::int32_t, Real>> row;
      restriction.ForRow(p, node, [&](std::int32_t r, Real weight) { row.push_back({r, weight}); });
      CHECK(row == expected[node]);
    }
  }
  for (const std::uint32_t most : {200u, 100000u}) {  // in one byte each, and in four
    SplitMix64 random(5);
    SlotLists lists;
    std::vector<std::vector<std::uint32_t>> added;
    for (int i = 0; i < 400; ++i) {
      const bool again = i > 0 && random.NextUnit() < 0.5;
      std::vector<std::uint32_t> list(static_cast<std::size_t>(4 * random.NextUnit()));
      for (std::uint32_t& slot : list) slot = static_cast<std::uint32_t>(most * random.NextUnit());
      added.push_back(again ? added[static_cast<std::size_t>(i * random.NextUnit())] : list);
      lists.Add(added.back());
    }
    lists.Finish();
    lists.InArray([&](const auto* slots) {
      for (std::size_t i = 0; i < added.size(); ++i) {
        const auto* const first = slots + lists.First(static_cast<std::int32_t>(i));
        CHECK(std::equal(added[i].begin(), added[i].end(), first));
      }
    });
  }
}

TEST_CASE("the product is that of the dense matrix, and symmetric") {
  for (const bool contacts : {false, true}) {
    const Sheet sheet = Square(9);
    const Cloth cloth{.bending = 1e-2};
    std::vector<ExtraTerm> extra;
    if (contacts) extra = RemotePairs(sheet, 60, 1000);  // some of the same pair, some at pins
    const System system(sheet, Serial(), cloth, extra);
    const int n = sheet.vertices();
    const Dense dense = Expected(sheet, cloth, extra);
    CHECK((ToEigen(system.matrix) - dense).norm() < 1e-6 * dense.norm());

    const RealVector x = RandomVector(n, 1), y = RandomVector(n, 2);
    RealVector hx(VectorLength(n), 0), hy = hx, other = hx;
    std::vector<double> scratch(Chunks(n));
    const double xhx = system.matrix.MultiplyDot(x.data(), hx.data(), scratch, Serial());
    system.matrix.Multiply(y.data(), hy.data(), Serial());
    const Eigen::VectorXd ex = ToEigen(x, n), ey = ToEigen(y, n);
    CHECK(RelativeError(ToEigen(hx, n), dense * ex) < 1e-6);
    CHECK(xhx == doctest::Approx(ex.dot(dense * ex)).epsilon(1e-6));
    CHECK(ex.dot(ToEigen(hy, n)) == doctest::Approx(ey.dot(ToEigen(hx, n))).epsilon(1e-6));
    system.matrix.Residual(y.data(), x.data(), other.data(), Serial());
    CHECK(RelativeError(ToEigen(other, n), ey - dense * ex) < 1e-6);

    Dense inverse = Dense::Zero(3 * n, 3 * n);
    for (int v = 0; v < n; ++v) inverse.block<3, 3>(3 * v, 3 * v) = InverseOf(dense.block<3, 3>(3 * v, 3 * v));
    system.matrix.Smooth(Real{.5}, y.data(), x.data(), other.data(), Serial());
    CHECK(RelativeError(ToEigen(other, n), ex + .5 * inverse * (ey - dense * ex)) < 1e-3);
    system.matrix.SmoothFromZero(Real{.5}, y.data(), other.data(), Serial());
    CHECK(RelativeError(ToEigen(other, n), .5 * inverse * ey) < 1e-3);
  }
}

TEST_CASE("extra blocks can change from one filling to the next") {
  const Sheet sheet = Square(9);
  System system(sheet, Serial());
  for (const int pairs : {10, 200, 0, 30}) {
    const std::vector<ExtraTerm> extra = RemotePairs(sheet, pairs, 1000);
    system.Fill(sheet, Serial(), {}, extra);
    const Dense dense = Expected(sheet, {}, extra);
    CHECK((ToEigen(system.matrix) - dense).norm() < 1e-6 * dense.norm());
  }
}

TEST_CASE("shared rows are those that were given, each kind once") {
  SplitMix64 random(5);
  const int rows = 3000;  // more kinds than the first hash table has room for
  std::vector<std::vector<std::pair<std::int32_t, double>>> given;
  RowSharer<double> sharer(rows);
  std::set<std::vector<std::pair<std::int32_t, double>>> kinds;  // beside the diagonal
  for (int row = 0; row < rows; ++row) {
    auto& entries = given.emplace_back();
    auto beside = entries;
    for (int column = row; column < row + 4; ++column) {
      if (random.NextUnit() < 0.3) continue;
      entries.push_back({column, std::floor(4 * random.NextUnit())});
      beside.push_back({column - row, entries.back().second});
    }
    kinds.insert(beside);
    sharer.Append(entries);
  }
  const ScalarMatrix matrix = sharer.Take();
  CHECK(matrix.rows() == rows);
  CHECK(matrix.first.size() == kinds.size() + 1);
  for (int row = 0; row < rows; ++row) {
    std::vector<std::pair<std::int32_t, double>> read;
    matrix.ForRow(row, [&](std::int32_t column, double value) { read.push_back({column, value}); });
    CHECK(read == given[static_cast<std::size_t>(row)]);
  }
}

TEST_CASE("where a diagonal block is not positive definite, its trace is inverted") {
  const Sheet sheet = Square(9);
  const auto inverseOf = [&](std::array<Real, 3> diagonal) {
    SystemMatrix matrix;
    const ScalarMatrix nothing = MakeScalarMatrix(sheet.vertices(), {});
    matrix.SetUp(MakePattern(sheet.vertices(), sheet.triangles), nothing);
    matrix.Reset(Serial());
    Real* block = matrix.DiagonalBlock(40);
    for (int k = 0; k < 3; ++k) block[4 * k] = diagonal[k];
    matrix.Finish(Serial());
    const Real* inverse = matrix.InverseDiagonal(40);
    return std::array<Real, 3>{inverse[0], inverse[4], inverse[8]};
  };
  CHECK(inverseOf({4, 2, 1}) == std::array<Real, 3>{Real{.25}, Real{.5}, 1});
  CHECK(inverseOf({4, 0, 0}) == std::array<Real, 3>{Real{.25}, Real{.25}, Real{.25}});
  CHECK(inverseOf({4, -2, 2}) == std::array<Real, 3>{Real{.25}, Real{.25}, Real{.25}});
  CHECK(inverseOf({-4, -2, 2}) == std::array<Real, 3>{Real{.25}, Real{.25}, Real{.25}});
  CHECK(inverseOf({0, 0, 0}) == std::array<Real, 3>{1, 1, 1});
}

TEST_CASE("every level moves as a whole what moves, and leaves pins alone") {
  for (const Sheet& sheet : {Square(64), TwoPanels(64), Disc(30)}) {
    for (const bool material : {false, true}) {
      CAPTURE(sheet.vertices());
      CAPTURE(material);
      const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
      const std::vector<Prolongation> levels =
          MakeHierarchy(pattern, material ? sheet.Mesh() : sheet.NoMaterial(), sheet.pinned);
      REQUIRE(levels.size() >= 2);
      CHECK(levels.back().nodes <= kFewNodes);
      int rows = sheet.vertices();
      for (std::size_t level = 0; level < levels.size(); ++level) {
        const Prolongation& p = levels[level];
        REQUIRE(p.rows() == rows);
        std::vector<double> support(p.nodes);
        double worst = 0;
        for (int row = 0; row < rows; ++row) {
          double sum = 0;
          for (int k = p.first[row]; k < p.first[row + 1]; ++k) {
            CHECK_FALSE(p.weight[k] <= 0);
            sum += static_cast<double>(p.weight[k]);
            support[p.column[k]] += static_cast<double>(p.weight[k]);
          }
          const bool pinned = level == 0 && sheet.pinned[row];
          worst = std::max(worst, std::abs(sum - (pinned ? 0 : 1)));
        }
        CHECK(worst < 3e-7);
        CHECK(*std::min_element(support.begin(), support.end()) > 0);
        rows = p.nodes;
      }
    }
  }
}

TEST_CASE("a node stands for about 4 x 4 vertices, whatever the numbering and the shape") {
  for (const Sheet& sheet : {Square(100), Square(128), TwoPanels(100), Disc(57)}) {
    const auto levels = MaterialHierarchy(sheet.vertices(), sheet.Mesh(), sheet.pinned);
    REQUIRE(!levels.empty());
    const double perNode = static_cast<double>(sheet.vertices()) / levels[0].nodes;
    CHECK(perNode > 11);
    CHECK(perNode < 17);
    const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
    const double perAggregate = static_cast<double>(sheet.vertices()) / AggregateHierarchy(pattern)[0].nodes;
    CHECK(perAggregate > 7);
    CHECK(perAggregate < 11);
  }
}

TEST_CASE("unusable coordinates are not used") {
  Sheet sheet = Square(20);
  const BlockPattern pattern = MakePattern(sheet.vertices(), sheet.triangles);
  SUBCASE("none") {
    sheet.material.clear();
  }
  SUBCASE("all the same") {
    std::fill(sheet.material.begin(), sheet.material.end(), Vec2{1, 2});
  }
  SUBCASE("on a line") {
    for (Vec2& m : sheet.material) m.y = 3 * m.x;
  }
  SUBCASE("not a number") {
    sheet.material[7].x = std::nan("");
  }
  CHECK(MaterialHierarchy(sheet.vertices(), sheet.Mesh(), sheet.pinned).empty());
  CHECK(MakeHierarchy(pattern, sheet.Mesh(), sheet.pinned).size() == AggregateHierarchy(pattern, sheet.pinned).size());
}

TEST_CASE("coarse matrices are P'HP") {
  for (const bool material : {true, false}) {
    for (const int pairs : {0, 40}) {
      const Sheet sheet = TwoPanels(20);
      const Solver solver(sheet, material, {.bending = 1e-2}, RemotePairs(sheet, pairs, 1000));
      REQUIRE(solver.multigrid.levels() >= 1);
      Dense above = ToEigen(solver.matrix);
      for (int level = 0; level < solver.multigrid.levels(); ++level) {
        const Dense p = ToEigen(solver.multigrid.prolongation(level));
        const Dense coarse = ToEigen(solver.multigrid.matrix(level));
        CHECK((coarse - p.transpose() * above * p).norm() < 1e-6 * coarse.norm());
        CHECK((coarse - coarse.transpose()).norm() < 1e-6 * coarse.norm());
        above = coarse;
      }
    }
  }
}

TEST_CASE("contacts alone can be filled anew") {
  const Sheet sheet = Square(40);
  Solver solver(sheet, true, {}, RemotePairs(sheet, 100, 1000));
  const RealVector b = RandomVector(sheet.vertices(), 3, sheet.pinned);
  RealVector whole(VectorLength(sheet.vertices()), 0), part = whole, scratch = whole;
  for (const int pairs : {300, 0, 20}) {
    solver.Fill(sheet, Serial(), {}, RemotePairs(sheet, pairs, 500));
    solver.multigrid.RefillExtra(solver.matrix, Serial());
    solver.multigrid.Apply(solver.matrix, b.data(), part.data(), scratch.data(), Serial());
    solver.multigrid.Refill(solver.matrix, Serial());
    solver.multigrid.Apply(solver.matrix, b.data(), whole.data(), scratch.data(), Serial());
    CHECK(part == whole);
  }
}

TEST_CASE("a cycle is a symmetric and positive definite operator, and close to the inverse") {
  const Sheet sheet = Square(12);
  const int n = sheet.vertices();
  for (const bool material : {true, false}) {
    for (const int pairs : {0, 30}) {
      Solver solver(sheet, material, {}, RemotePairs(sheet, pairs, 261));
      REQUIRE(solver.multigrid.levels() >= 1);
      Dense cycle(3 * n, 3 * n);
      RealVector unit(VectorLength(n), 0), z = unit, scratch = unit;
      for (int k = 0; k < 3 * n; ++k) {
        unit[k] = 1;
        solver.multigrid.Apply(solver.matrix, unit.data(), z.data(), scratch.data(), Serial());
        unit[k] = 0;
        cycle.col(k) = ToEigen(z, n);
      }
      CHECK((cycle - cycle.transpose()).norm() < 1e-3 * cycle.norm());
      const Dense symmetric = .5 * (cycle + cycle.transpose());
      CHECK(SpectrumOf(symmetric).values[0] > 0);
      // Of V H: between 0 and 1 but for rounding, as Jacobi's steps are damped enough.
      const Eigen::VectorXd both = EigenvaluesOf(ToEigen(solver.matrix), InverseOf(symmetric));
      CHECK(both.minCoeff() > (pairs > 0 ? .003 : .03));
      CHECK(both.maxCoeff() < 1.01);
    }
  }
}

TEST_CASE("the solution is that of a direct solver") {
  for (const bool material : {true, false}) {
    for (const Sheet& sheet : {Square(5), Square(20), Disc(10), Confetti(20), Confetti(300)}) {
      if (sheet.vertices() > 1000 && material) continue;  // the dense twin takes seconds
      CAPTURE(sheet.vertices());
      CAPTURE(material);
      const int pairs = sheet.vertices() > 1000 ? 0 : 20;
      Solver solver(sheet, material, {}, RemotePairs(sheet, pairs, 100));
      const int n = sheet.vertices();
      const RealVector b = RandomVector(n, 4, sheet.pinned);
      SolveResult result;
      const RealVector x = solver.Solve(b, result, {300, 1e-11});
      CHECK(result.end == SolveEnd::Converged);
      CHECK(result.ratio <= 1e-11);
      if (sheet.vertices() <= kFewNodes) CHECK(result.iterations <= 3);
      if (sheet.vertices() > 1000) {  // loose pieces: only the residual is checked
        RealVector left(VectorLength(n), 0);
        solver.matrix.Residual(b.data(), x.data(), left.data(), Serial());
        CHECK(ToEigen(left, n).norm() < 1e-3 * ToEigen(b, n).norm());
        continue;
      }
      const Eigen::VectorXd exact = SolutionOf(ToEigen(solver.matrix), ToEigen(b, n));
      CHECK(RelativeError(ToEigen(x, n), exact) < 2e-3);
    }
  }
}

TEST_CASE("iterations depend little on the size of the mesh, on its shape and on how its levels are made" *
          doctest::skip(test::kSanitized)) {
  struct Case {
    const char* name;
    Sheet sheet;
    bool material;
    int most;  // iterations to 1e-4, measured and a third more
  };
  const Case cases[] = {
      {"64 x 64", Square(64), true, 6},
      {"256 x 256", Square(256), true, 6},
      {"64 x 64", Square(64), false, 8},
      {"256 x 256", Square(256), false, 10},
      {"disc", Disc(57), true, 7},
      {"disc", Disc(57), false, 8},
      {"two panels", TwoPanels(100), true, 7},
      {"two panels", TwoPanels(100), false, 8},
  };
  for (const Case& c : cases) {
    CAPTURE(c.name);
    CAPTURE(c.material);
    Solver solver(c.sheet, c.material);
    CHECK(solver.Iterations(Weight(c.sheet), 1e-4) <= c.most);
    CHECK(solver.Iterations(RandomVector(c.sheet.vertices(), 5, c.sheet.pinned), 1e-4) <= 25);
  }
}

TEST_CASE("contacts between remote vertices have to be in the coarse levels") {
  const Sheet sheet = Square(128);
  const std::vector<ExtraTerm> extra = RemotePairs(sheet, 2048, 1000);
  for (const bool material : {true, false}) {
    Solver solver(sheet, material, {}, extra);
    const RealVector b = Weight(sheet);
    const int coupled = solver.Iterations(b, 1e-4);
    solver.matrix.extra().any = false;
    solver.multigrid.RefillExtra(solver.matrix, Serial());
    solver.matrix.extra().any = true;
    const int leftOut = solver.Iterations(b, 1e-4);
    CHECK(coupled <= 16);
    CHECK(leftOut > 2 * coupled);
  }
}

TEST_CASE("the same bits for any number of threads") {
  const Sheet sheet = TwoPanels(70);
  const std::vector<ExtraTerm> extra = RemotePairs(sheet, 500, 1000);
  for (const bool material : {true, false}) {
    RealVector first;
    for (const int threads : {1, 2, 3, 8}) {
      const Executor executor(threads);
      Solver solver(sheet, material, {}, extra, executor);
      SolveResult result;
      const RealVector x = solver.Solve(RandomVector(sheet.vertices(), 6, sheet.pinned), result, {12, 1e-9}, executor);
      if (first.empty()) first = x;
      CHECK(x == first);
    }
  }
}

TEST_CASE("negative curvature ends the solve with a direction of descent") {
  const Sheet sheet = Square(20);
  const int n = sheet.vertices();
  for (const Real push : {Real{100}, Real{3000}, Real{1e6}}) {
    CAPTURE(push);
    // Springs of negative stiffness on every vertex of a patch.
    std::vector<ExtraTerm> extra;
    for (int v = 150; v < 250; ++v)
      extra.push_back({{v, -1, -1, -1}, {1, 0, 0, 0}, {-push, 0, 0, 0, -push, 0, 0, 0, -push}});
    Solver solver(sheet, true, {}, extra);
    const RealVector b = RandomVector(n, 8, sheet.pinned);
    SolveResult result;
    const RealVector x = solver.Solve(b, result, {100, 1e-6});
    CHECK((result.end == SolveEnd::NegativeCurvature || result.end == SolveEnd::NotPreconditioned));
    const double descent = ToEigen(x, n).dot(ToEigen(b, n));
    CHECK(descent > 0);
    CHECK(std::isfinite(descent));
  }
}

TEST_CASE("nothing to solve is solved, and few iterations are no more than asked for") {
  const Sheet sheet = Square(30);
  Solver solver(sheet, true);
  SolveResult result;
  const RealVector none = solver.Solve(RealVector(VectorLength(sheet.vertices()), 0), result, {});
  CHECK(result.iterations == 0);
  CHECK(result.end == SolveEnd::Converged);
  CHECK(std::all_of(none.begin(), none.end(), [](Real x) { return x == 0; }));
  const RealVector b = RandomVector(sheet.vertices(), 9, sheet.pinned);
  const RealVector x = solver.Solve(b, result, {3, 1e-12});
  CHECK(result.iterations == 3);
  CHECK(result.end == SolveEnd::OutOfIterations);
  for (int k = 0; k < 3 * sheet.vertices(); ++k) CHECK_FALSE((sheet.pinned[k / 3] && x[k] != 0));
}

TEST_CASE("a solve that ends when an iteration gains little has gained most of what there is") {
  for (const bool material : {true, false}) {
    const Sheet sheet = Square(64);
    const int n = sheet.vertices();
    Solver solver(sheet, material);
    for (const RealVector& b : {Weight(sheet), RandomVector(n, 12, sheet.pinned)}) {
      SolveResult result, early;
      const RealVector x = solver.Solve(b, result, {100, 1e-8});
      const RealVector little = solver.Solve(b, early, {100, 1e-8, 0.04});
      CHECK(early.end == SolveEnd::Converged);
      CHECK(early.iterations < result.iterations);
      // ½ x'Hx - b'x is -½ b'x for all that conjugate gradients pass.
      CHECK(ToEigen(little, n).dot(ToEigen(b, n)) > 0.95 * ToEigen(x, n).dot(ToEigen(b, n)));
    }
  }
}

TEST_CASE("the direct solve of the coarsest level") {
  for (const int n : {1, 3, 50, 147}) {
    Dense a = Dense::Random(n, n);
    a = a * a.transpose() + .1 * Dense::Identity(n, n);
    DenseFactor factor;
    factor.SetUp(n);
    std::copy(a.data(), a.data() + n * n, factor.matrix());
    CHECK(factor.Factor() == 0);
    Eigen::VectorXd b = Eigen::VectorXd::Random(n), x = b;
    factor.Solve(x.data());
    CHECK((a * x - b).norm() < 1e-9 * b.norm());

    // With the sign of a direction turned around: what was added makes it positive definite, and no more than that.
    const Spectrum spectrum = SpectrumOf(a);
    a -= 1.5 * spectrum.values[0] * spectrum.vectors.col(0) * spectrum.vectors.col(0).transpose();
    std::copy(a.data(), a.data() + n * n, factor.matrix());
    const double shift = factor.Factor();
    CHECK(shift > 0);
    CHECK(shift <= 10 * std::max(.5 * spectrum.values[0], 1e-6 * a.cwiseAbs().maxCoeff()));
    x = b;
    factor.Solve(x.data());
    CHECK(x.dot(b) > 0);
    CHECK(((a + shift * Dense::Identity(n, n)) * x - b).norm() < 1e-6 * b.norm());
  }
}
