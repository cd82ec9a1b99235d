#include "collide/intersections.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "collide/predicates.h"
#include "core/index.h"
#include "math/splitmix64.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

struct Mesh {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  int obstacles = -1;  // the first vertex of obstacles, or -1: none

  void Add(const Mesh& o) {
    const auto first = static_cast<std::int32_t>(x.size());
    x.insert(x.end(), o.x.begin(), o.x.end());
    for (const Triangle& t : o.triangles) triangles.push_back({first + t.a, first + t.b, first + t.c});
  }
  int vertices() const { return static_cast<int>(x.size()); }
};

/// columns x rows vertices at origin + i u + j v.
Mesh Sheet(int columns, int rows, const Vec3& origin, const Vec3& u, const Vec3& v) {
  Mesh mesh;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) mesh.x.push_back(origin + double(i) * u + double(j) * v);
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const std::int32_t a = j * columns + i, b = a + 1, c = a + columns, d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

/// Triangles at random within the unit cube; on a lattice of so many steps where `steps` > 0. Some share vertices.
Mesh Soup(SplitMix64& random, int count, double size, int steps) {
  Mesh mesh;
  for (int t = 0; t < count; ++t) {
    const Vec3 centre{random.NextUnit(), random.NextUnit(), random.NextUnit()};
    std::int32_t corner[3];
    for (std::int32_t& c : corner) {
      if (!mesh.x.empty() && random.Next() % 4 == 0) {
        c = static_cast<std::int32_t>(random.Next() % mesh.x.size());
        continue;
      }
      Vec3 x = centre + size * Vec3{random.NextUnit(), random.NextUnit(), random.NextUnit()};
      if (steps > 0) x = {std::round(x.x * steps), std::round(x.y * steps), std::round(x.z * steps)};
      c = mesh.vertices();
      mesh.x.push_back(x);
    }
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0])
      mesh.triangles.push_back({corner[0], corner[1], corner[2]});
  }
  return mesh;
}

IntersectionCount Judge(const Mesh& mesh, int most = 10, int threads = 1) {
  const Executor executor(threads);
  const int obstacles = mesh.obstacles < 0 ? mesh.vertices() : mesh.obstacles;
  return IntersectionJudge(mesh.vertices(), mesh.triangles, obstacles).Count(mesh.x, executor, most);
}

/// All edges against all triangles.
std::vector<Intersection> BruteForce(const Mesh& mesh) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (const auto& [a, b] : {std::pair{t.a, t.b}, {t.b, t.c}, {t.c, t.a}})
      edges.insert({std::min(a, b), std::max(a, b)});
  }
  std::vector<Intersection> all;
  for (const auto& [p, q] : edges) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      Triangle t = mesh.triangles[i];
      if (mesh.obstacles >= 0 && p >= mesh.obstacles && t.a >= mesh.obstacles) continue;
      const auto has = [&](std::int32_t v) { return v == t.a || v == t.b || v == t.c; };
      if (has(p) && has(q)) continue;
      const auto at = [&](std::int32_t v) { return mesh.x[Index(v)]; };
      bool meet = false;
      if (has(p) || has(q)) {
        const std::int32_t from = has(p) ? p : q;
        while (t.a != from) t = {t.b, t.c, t.a};
        meet = SegmentRunsOnTriangle(at(has(p) ? q : p), at(t.a), at(t.b), at(t.c));
      } else {
        meet = SegmentMeetsTriangle(at(p), at(q), at(t.a), at(t.b), at(t.c));
      }
      if (meet) all.push_back({{p, q}, static_cast<std::int32_t>(i)});
    }
  }
  return all;
}

void CheckAgainstBruteForce(const Mesh& mesh) {
  const std::vector<Intersection> expected = BruteForce(mesh);
  const IntersectionCount all = Judge(mesh, 1 << 30);
  CHECK(all.count == std::int64_t(expected.size()));
  CHECK(all.first == expected);
  const IntersectionCount few = Judge(mesh, 3);
  CHECK(few.count == all.count);
  CHECK(few.first ==
        std::vector<Intersection>(expected.begin(), expected.begin() + std::min<std::ptrdiff_t>(3, all.count)));
}

}  // namespace

TEST_CASE("nothing intersects nothing") {
  CHECK(Judge({}).count == 0);
  Mesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK(Judge(mesh).count == 0);
  mesh.triangles = {{0, 1, 2}};
  CHECK(Judge(mesh).count == 0);
  mesh.triangles = {{0, 1, 2}, {2, 0, 1}, {0, 2, 1}};  // one triangle thrice
  CHECK(Judge(mesh).count == 0);
}

TEST_CASE("blades through a quad count one for each of their edges that pass it") {
  for (const int blades : {1, 2, 7, 100}) {
    for (const double depth : {1.0, 0.0, -1e-12}) {
      Mesh mesh = Sheet(2, 2, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
      for (int k = 0; k < blades; ++k) {
        const double x = 0.5 + 0.4 * (k + 0.5) / blades;  // beyond the diagonal from (1, 0) to (0, 1)
        Mesh blade;
        blade.x = {{x, 0.8, -depth}, {x, 0.75, 1}, {x, 0.85, 1}};
        blade.triangles = {{0, 1, 2}};
        mesh.Add(blade);
      }
      CAPTURE(blades);
      CAPTURE(depth);
      // A tip that touches belongs to two edges. Above, nothing is hit.
      CHECK(Judge(mesh).count == (depth >= 0 ? 2 * blades : 0));
      for (const Intersection& hit : Judge(mesh).first) CHECK(hit.triangle == 1);
    }
  }
}

TEST_CASE("what is found is named, and the first of it in order") {
  Mesh mesh = Sheet(2, 2, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.Add(Sheet(2, 2, {0.25, 0.125, -0.5}, {0.5, 0, 0}, {0, 0, 1}));  // upright across the diagonal
  const IntersectionCount all = Judge(mesh);
  // The upright quad's left edge and its diagonal pass the lower triangle, its right edge touches neither alone.
  CheckAgainstBruteForce(mesh);
  REQUIRE(!all.first.empty());
  CHECK(all.first.front().edge[0] < all.first.front().edge[1]);
  CHECK(std::is_sorted(all.first.begin(), all.first.end(), [](const Intersection& a, const Intersection& b) {
    return std::tie(a.edge[0], a.edge[1], a.triangle) < std::tie(b.edge[0], b.edge[1], b.triangle);
  }));
}

TEST_CASE("flat sheets have none, wherever they lie and however they are stretched") {
  const double s = std::sqrt(0.5);
  CHECK(Judge(Sheet(100, 100, {0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0})).count == 0);
  CHECK(Judge(Sheet(100, 100, {0, 7, 0}, {0.01, 0, 0}, {0, 0, 0.01})).count == 0);
  CHECK(Judge(Sheet(100, 100, {1, 2, 3}, {0.01 * s, 0.01 * s, 0}, {-0.003, 0.003, 0.009})).count == 0);
  CHECK(Judge(Sheet(2, 5000, {0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0})).count == 0);
  CHECK(Judge(Sheet(2, 5000, {0, 0, 0}, {1, 0, 0}, {0, 0.0001, 0})).count == 0);
  // Were each edge asked about each triangle, this would take an hour.
  const int side = test::Fewer(400, 100);
  CHECK(Judge(Sheet(side, side, {0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0})).count == 0);
}

TEST_CASE("long thin triangles across all axes: all pairs, and not each with each") {
  const Vec3 along{0.267, 0.535, 0.802}, across{-0.87, 0.2, 0.45};
  CHECK(Judge(Sheet(2, 5000, {5, 5, 5}, along, 0.0002 * across)).count == 0);
  // Nearly parallel ones, some through others; far from the origin, where bounds are rounded.
  SplitMix64 random(10);
  for (int round = 0; round < 10; ++round) {
    Mesh mesh;
    const double far = round % 2 == 0 ? 0 : 1e5;
    for (int k = 0; k < 150; ++k) {
      const auto near = [&](double size) {
        return size * Vec3{random.NextUnit() - 0.5, random.NextUnit() - 0.5, random.NextUnit() - 0.5};
      };
      const Vec3 middle = Vec3{far, -far, far} + near(0.2);
      const std::int32_t first = mesh.vertices();
      mesh.x.insert(mesh.x.end(), {middle - along, middle + along, middle + near(0.02)});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    CheckAgainstBruteForce(mesh);
    CHECK(Judge(mesh).count > 0);
  }
}

TEST_CASE("triangles that touch others halfway along their long sides, where bounds in another frame are rounded") {
  const Vec3 along{1, 2, 3}, across{-0.0078125, 0.00390625, 0}, up{-0.00390625, -0.0078125, 0.0078125};
  SplitMix64 random(16);
  Mesh mesh;
  for (int k = 0; k < 300; ++k) {
    const auto coordinate = [&] { return double(random.Next() % 4096) / 4; };
    const double x = coordinate(), y = coordinate();
    const Vec3 p{x, y, coordinate()}, middle = p + 0.5 * along;  // exact
    const Vec3 side = k % 2 == 0 ? across : up;
    const std::int32_t first = mesh.vertices();
    mesh.x.insert(mesh.x.end(), {p, p + along, p + side, middle, middle - side, middle - 2.0 * side + 0.25 * along});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 3, first + 4, first + 5});
  }
  CHECK(Judge(mesh).count >= 600);
  CheckAgainstBruteForce(mesh);
}

TEST_CASE("two sheets that cross, that touch, and that do not") {
  for (const int n : {2, 5, 20}) {
    const double h = 1.0 / (n - 1);
    Mesh mesh = Sheet(n, n, {0, 0, 0}, {h, 0, 0}, {0, h, 0});
    Mesh crossing = mesh, touching = mesh, above = mesh, lying = mesh;
    crossing.Add(Sheet(n, n, {0.013, 0.507, -0.5}, {h, 0.01 * h, 0}, {0, 0.02 * h, h}));
    touching.Add(Sheet(n, n, {0.013, 0.507, 0}, {h, 0.01 * h, 0}, {0, 0.02 * h, h}));
    above.Add(Sheet(n, n, {0.013, 0.507, 1e-300}, {h, 0.01 * h, 0}, {0, 0.02 * h, h}));
    lying.Add(Sheet(n, n, {0.25, 0.25, 0}, {h, 0, 0}, {0, h, 0}));
    CHECK(Judge(crossing).count > n);
    CHECK(Judge(touching).count > n);
    CHECK(Judge(lying).count > n);
    for (const Mesh& each : {crossing, touching, lying}) CheckAgainstBruteForce(each);
    // Below the smallest length that counts, a gap is none; above it, it is one.
    CHECK(Judge(above).count == Judge(touching).count);
    for (std::size_t v = mesh.x.size(); v < above.x.size(); ++v) above.x[v].z = std::max(above.x[v].z, 1e-89);
    CHECK(Judge(above).count == 0);
  }
}

TEST_CASE("a sheet that passes through itself") {
  // Rolled up to one and a quarter turns on a cylinder whose radius shrinks and grows: the layers cross.
  Mesh mesh = Sheet(80, 10, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (Vec3& x : mesh.x) {
    const double angle = 0.1 * x.x, radius = 1 + 0.01 * std::sin(9 * angle);
    x = {radius * std::cos(angle), 0.1 * x.y, radius * std::sin(angle)};
  }
  CHECK(Judge(mesh).count > 10);
  CheckAgainstBruteForce(mesh);
  // The same as a spiral: they do not.
  Mesh spiral = Sheet(80, 10, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (Vec3& x : spiral.x) {
    const double angle = 0.1 * x.x, radius = 1 + 0.02 * angle;
    x = {radius * std::cos(angle), 0.1 * x.y, radius * std::sin(angle)};
  }
  CHECK(Judge(spiral).count == 0);
}

TEST_CASE("a fold counts when it lies exactly flat, and not a hair before") {
  // Two triangles on the edge 0-1, the tips on the same side.
  Mesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.6, 0.7, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  CHECK(Judge(mesh).count > 0);
  CheckAgainstBruteForce(mesh);
  mesh.x[3].z = 1e-80;
  CHECK(Judge(mesh).count == 0);
  mesh.x[3] = {0.6, -0.7, 0};
  CHECK(Judge(mesh).count == 0);
  // A whole sheet folded over: each half lies in the other.
  Mesh sheet = Sheet(9, 9, {-4, 0, 0}, {1, 0, 0}, {0, 1, 0});
  CHECK(Judge(sheet).count == 0);
  for (Vec3& x : sheet.x) x.x = std::abs(x.x);
  CHECK(Judge(sheet).count > 64);
  CheckAgainstBruteForce(sheet);
}

TEST_CASE("vertices that have fallen together, and triangles that have collapsed, are counted as what they are") {
  Mesh mesh = Sheet(4, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.x[5] = mesh.x[6];
  CheckAgainstBruteForce(mesh);
  CHECK(Judge(mesh).count > 0);
  for (Vec3& x : mesh.x) x = {1, 1, 1};
  CheckAgainstBruteForce(mesh);
  for (std::size_t i = 0; i < mesh.x.size(); ++i) mesh.x[i] = {double(i), 0.5 * double(i), 0};
  CheckAgainstBruteForce(mesh);
}

TEST_CASE("random triangles: all pairs that brute force finds, and no other") {
  SplitMix64 random(11);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const int count = static_cast<int>(random.Next() % 120);
    const double size = round % 3 == 0 ? 1 : 0.2;
    const int steps = round % 2 == 0 ? 0 : 4 + round % 5;  // on a lattice most pairs touch in some special way
    CheckAgainstBruteForce(Soup(random, count, size, steps));
  }
}

TEST_CASE("obstacles may intersect one another, and cloth not them") {
  SplitMix64 random(12);
  for (int round = 0; round < 20; ++round) {
    Mesh mesh = Soup(random, 60, 0.4, 0);
    mesh.obstacles = mesh.vertices();
    mesh.Add(Soup(random, 60, 0.4, 0));
    CheckAgainstBruteForce(mesh);
    Mesh all = mesh;
    all.obstacles = -1;
    CHECK(Judge(all).count > Judge(mesh).count);
    mesh.obstacles = 0;
    CHECK(Judge(mesh).count == 0);
  }
}

TEST_CASE("the count does not depend on the order of vertices, triangles and corners") {
  SplitMix64 random(13);
  for (int round = 0; round < 10; ++round) {
    const Mesh mesh = Soup(random, 100, 0.5, round % 2 == 0 ? 0 : 6);
    const auto shuffled = [&](std::size_t count) {
      std::vector<std::size_t> order(count);
      std::iota(order.begin(), order.end(), std::size_t{0});
      for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.Next() % i]);
      return order;
    };
    const std::vector<std::size_t> vertexAt = shuffled(mesh.x.size()), triangleAt = shuffled(mesh.triangles.size());
    Mesh other = mesh;
    for (std::size_t v = 0; v < mesh.x.size(); ++v) other.x[vertexAt[v]] = mesh.x[v];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto place = [&](std::int32_t v) { return static_cast<std::int32_t>(vertexAt[Index(v)]); };
      const Triangle from = mesh.triangles[t];
      Triangle& to = other.triangles[triangleAt[t]] = {place(from.a), place(from.b), place(from.c)};
      for (std::uint64_t turns = random.Next() % 3; turns > 0; --turns) to = {to.b, to.c, to.a};
      if (random.Next() % 2 == 0) std::swap(to.a, to.b);
    }
    CHECK(Judge(other).count == Judge(mesh).count);
  }
}

TEST_CASE("any number of threads, and a judge that is used again, give the same answer") {
  SplitMix64 random(14);
  Mesh mesh = Soup(random, 1200, 0.1, 0);
  const IntersectionCount one = Judge(mesh, 25, 1);
  CHECK(one.count > 100);
  for (const int threads : {2, 3, 8}) {
    const Executor executor(threads);
    IntersectionJudge judge(mesh.vertices(), mesh.triangles);
    for (int again = 0; again < 2; ++again) {
      const IntersectionCount count = judge.Count(mesh.x, executor, 25);
      CHECK(count.count == one.count);
      CHECK(count.first == one.first);
      std::vector<Vec3> moved = mesh.x;
      for (Vec3& x : moved) x = {x.y, x.z, 2 * x.x};
      judge.Count(moved, executor, 3);
    }
  }
}
