#include "collide/pair_finder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/executor.h"
#include "math/splitmix64.h"
#include "tests/collide/contact_meshes.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr double kSpacing = 0.01;           // m
constexpr double kReach = 0.15 * kSpacing;  // of a body

/// What is wrong with what is found, or nothing: all pairs within reach are, and none that is `slack` [m] farther.
std::string Fault(const MovingMesh& m, double slack = 1e-6) {
  const Executor executor(1);
  PairFinder finder(m.mesh, executor);
  finder.Find(m.Motion(), m.reach, m.clothPairs);
  const PairSet vertexTriangle = Sorted(finder.vertexTriangle()), edgeEdge = SortedEdges(finder.edgeEdge());
  for (const PairSet* set : {&vertexTriangle, &edgeEdge}) {
    if (std::adjacent_find(set->begin(), set->end()) != set->end()) return "a pair that is listed twice";
  }
  const auto includes = [](const PairSet& all, const PairSet& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
  };
  const AllPairs least = FindAll(m);
  if (!includes(vertexTriangle, least.vertexTriangle)) return "a vertex and a triangle that are missing";
  if (!includes(edgeEdge, least.edgeEdge)) return "two edges that are missing";
  const AllPairs most = FindAll(m, slack);
  if (!includes(most.vertexTriangle, vertexTriangle)) return "a vertex and a triangle that are too far apart";
  if (!includes(most.edgeEdge, edgeEdge)) return "two edges that are too far apart";
  return "";
}

std::size_t CountPairs(const MovingMesh& m) {
  const Executor executor(1);
  PairFinder finder(m.mesh, executor);
  finder.Find(m.Motion(), m.reach, m.clothPairs);
  return finder.vertexTriangle().size() + finder.edgeEdge().size();
}

bool Same(std::span<const VertexQuad> a, std::span<const VertexQuad> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// A sheet in one of the shapes that cloth takes.
MovingMesh Sheet(int n, int shape) {
  MovingMesh m;
  AddSheet(m, n, kSpacing, kReach);
  const double width = (n - 1) * kSpacing;
  SplitMix64 random(17);
  if (shape == 1) SetShape(m, [&](const Vec3& p) { return Drape(p, width); });
  if (shape == 2) SetShape(m, [&](const Vec3& p) { return Layers(p, width, 4, 0.2 * kSpacing); });
  if (shape == 3) SetShape(m, [&](const Vec3& p) { return Layers(p, width, 16, 0.2 * kSpacing); });
  if (shape == 4) SetShape(m, [&](const Vec3& p) { return p * 0.3 + RandomVector(random, 1.5 * kSpacing); });
  return m;
}
constexpr int kShapes = 5;

void Move(MovingMesh& m, double size, std::uint64_t seed, const Vec3& common = {}) {
  SplitMix64 random(seed);
  for (Vec3& way : m.way) way = RandomVector(random, size) + common;
}

}  // namespace

TEST_CASE("pairs are those that come within reach, in sheets of all shapes, at rest and in motion") {
  for (int shape = 0; shape < kShapes; ++shape) {
    for (const int n : {2, 3, 5, 12, 25}) {
      for (const double motion : {0.0, 0.05 * kSpacing, kSpacing}) {
        CAPTURE(shape);
        CAPTURE(n);
        CAPTURE(motion);
        MovingMesh m = Sheet(n, shape);
        Move(m, motion, 3);
        CHECK(Fault(m) == "");
      }
    }
  }
}

TEST_CASE("the same with 10,000 vertices") {
  for (int shape = 0; shape < kShapes; ++shape) {
    CAPTURE(shape);
    MovingMesh m = Sheet(100, shape);
    Move(m, 0.02 * kSpacing, 4);
    CHECK(Fault(m) == "");
  }
}

TEST_CASE("vertices that may be cut end anywhere on their way") {
  for (int shape = 0; shape < kShapes; ++shape) {
    CAPTURE(shape);
    MovingMesh m = Sheet(16, shape);
    Move(m, kSpacing, 5, {0, 0, 3 * kSpacing});
    SplitMix64 random(6);
    for (std::size_t v = 0; v < m.start.size(); ++v) m.cut.push_back(random.NextUnit() < 0.3 ? 1 : 0);
    CHECK(Fault(m) == "");
  }
}

TEST_CASE("a motion that all share adds no pairs and loses none") {
  for (int shape = 0; shape < kShapes; ++shape) {
    CAPTURE(shape);
    MovingMesh m = Sheet(30, shape);
    Move(m, 0.02 * kSpacing, 7);
    const std::size_t still = CountPairs(m);
    Move(m, 0.02 * kSpacing, 7, {3, -10, 0.5});
    CHECK(CountPairs(m) == still);
  }
}

namespace {

/// Two cloths, one with a hole and one that is a strip, and obstacles: a sheet, a lone edge, a lone point, and a body
/// of points and edges.
MovingMesh Bodies() {
  MovingMesh m;
  AddSheet(m, 14, kSpacing, 0.1 * kSpacing, false, [](int i, int j) { return std::hypot(i - 6, j - 6) < 3.5; });
  AddSheet(m, 9, kSpacing, 0.25 * kSpacing, false, [](int, int j) { return j > 1; });
  AddSheet(m, 5, 3 * kSpacing, 0, true);
  m.AddBody(0.3 * kSpacing, true);
  m.AddEdge(m.AddVertex({0.01, 0.02, 0.002}), m.AddVertex({0.12, 0.09, -0.002}));
  m.AddBody(0.5 * kSpacing, true);
  m.AddVertex({0.03, 0.03, 0.001});
  m.AddBody(0.2 * kSpacing, true);
  SplitMix64 random(8);
  for (int i = 0; i < 60; ++i) {
    const std::int32_t a = m.AddVertex(RandomVector(random, 0.1));
    if (i % 3 != 0) m.AddEdge(a, m.AddVertex(m.start.back() + RandomVector(random, 0.02)));
  }
  for (std::size_t v = 0; v < m.start.size(); ++v)
    m.start[v].z += 0.004 * m.mesh.body[v] * std::sin(100 * m.start[v].x);
  Move(m, 0.2 * kSpacing, 9);
  return m;
}

}  // namespace

TEST_CASE("several bodies with holes, and obstacles of triangles, edges and points") {
  MovingMesh m = Bodies();
  CHECK(Fault(m) == "");
  CHECK(CountPairs(m) > 0);
  m.clothPairs = false;
  CHECK(Fault(m) == "");
  CHECK(CountPairs(m) > 0);
  for (std::int32_t v = 0; v < m.mesh.clothVertices; ++v) m.start[Index(v)].y += 5;  // obstacles alone are near
  CHECK(CountPairs(m) == 0);
}

TEST_CASE("far from the origin") {
  for (const double away : {100.0, 1e4, 1e6}) {
    CAPTURE(away);
    for (int shape = 0; shape < kShapes; ++shape) {
      CAPTURE(shape);
      MovingMesh m = Sheet(12, shape);
      Move(m, 0.1 * kSpacing, 10);
      for (Vec3& p : m.start) p += {away, -away, away / 3};
      CHECK(Fault(m, 1e-6) == "");
    }
  }
}

TEST_CASE("one vertex that is gone far hides no pairs of the others") {
  for (const double away : {1e3, 1e9, 1e30, 1e200, double{INFINITY}, double{NAN}}) {
    CAPTURE(away);
    MovingMesh m = Sheet(12, 2);
    const std::size_t gone = 40;
    m.start[gone].x += away;
    const Executor executor(1);
    PairFinder finder(m.mesh, executor);
    finder.Find(m.Motion(), m.reach, m.clothPairs);
    const PairSet vertexTriangle = Sorted(finder.vertexTriangle()), edgeEdge = SortedEdges(finder.edgeEdge());
    m.start[gone].x = 1e5;
    const AllPairs all = FindAll(m);
    const auto found = [&](const PairSet& set, const VertexQuad& q) {
      const bool isGone = std::find(q.begin(), q.end(), static_cast<std::int32_t>(gone)) != q.end();
      return isGone || std::binary_search(set.begin(), set.end(), q);
    };
    for (const VertexQuad& q : all.vertexTriangle) REQUIRE(found(vertexTriangle, q));
    for (const VertexQuad& q : all.edgeEdge) REQUIRE(found(edgeEdge, q));
  }
}

TEST_CASE("nothing is near what is not a number") {
  for (const double value : {double{NAN}, double{INFINITY}, -double{INFINITY}, 1e308}) {
    CAPTURE(value);
    for (const bool inWay : {false, true}) {
      MovingMesh m = Sheet(100, 0);
      for (Vec3& p : inWay ? m.way : m.start) p = {value, value, value};
      CHECK(CountPairs(m) == 0);
    }
  }
}

TEST_CASE("empty and degenerate meshes") {
  MovingMesh empty;
  CHECK(CountPairs(empty) == 0);
  MovingMesh triangle;
  triangle.AddBody(1);
  const std::int32_t a = triangle.AddVertex({0, 0, 0}), b = triangle.AddVertex({1, 0, 0});
  triangle.AddTriangle(a, b, triangle.AddVertex({0, 1, 0}));
  CHECK(CountPairs(triangle) == 0);
  // All vertices in one place, and then in one line: triangles without area, edges without length.
  for (const double length : {0.0, 1.0}) {
    MovingMesh m = Sheet(7, 0);
    SetShape(m, [&](const Vec3& p) { return Vec3{5, length * std::round(p.y), 5}; });
    m.reach[0] = 0;
    CHECK(Fault(m) == "");
    CHECK(CountPairs(m) > 1000);
  }
}

namespace {

/// Of points of a vertex and a triangle, or of two edges: at least the distance of the two.
double SampledDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const auto points = [](const std::vector<Vec3>& corners) {
    constexpr int kSteps = 8;
    std::vector<Vec3> all;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= (corners.size() > 2 ? kSteps - i : 0); ++j) {
        const double s = i / double{kSteps}, t = j / double{kSteps};
        Vec3 p = corners[0];
        if (corners.size() > 1) p += (corners[1] - corners[0]) * s;
        if (corners.size() > 2) p += (corners[2] - corners[0]) * t;
        all.push_back(p);
      }
    }
    return all;
  };
  double least = INFINITY;
  for (const Vec3& p : points(a)) {
    for (const Vec3& q : points(b)) least = std::min(least, Length(p - q));
  }
  return least;
}

}  // namespace

TEST_CASE("whatever comes within reach at any time, in any way that cuts allow, is listed") {
  SplitMix64 random(11);
  int close = 0;
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    MovingMesh m;
    for (int body = 0; body < 3; ++body) AddSheet(m, 3, kSpacing, 0.1 * kSpacing * body, body == 2);
    for (Vec3& p : m.start) p = p + RandomVector(random, kSpacing);
    Move(m, 2 * kSpacing, static_cast<std::uint64_t>(round), RandomVector(random, 10 * kSpacing));
    for (std::size_t v = 0; v < m.start.size(); ++v) m.cut.push_back(random.NextUnit() < 0.2 ? 1 : 0);
    const Executor executor(1);
    PairFinder finder(m.mesh, executor);
    finder.Find(m.Motion(), m.reach, true);
    const PairSet vertexTriangle = Sorted(finder.vertexTriangle()), edgeEdge = SortedEdges(finder.edgeEdge());
    for (int sample = 0; sample < 4; ++sample) {
      const double time = random.NextUnit();
      std::vector<Vec3> x(m.start.size());
      for (std::size_t v = 0; v < x.size(); ++v) {
        x[v] = m.start[v] + m.way[v] * (time * (m.cut[v] != 0 ? random.NextUnit() : 1));
      }
      const auto check = [&](const PairSet& set, const PairSet& key, const std::vector<std::int32_t>& a,
                             const std::vector<std::int32_t>& b) {
        const all_pairs::Item one = all_pairs::MakeItem(m, a, 0), other = all_pairs::MakeItem(m, b, 0);
        if (!all_pairs::Counts(m, one, other)) return;
        std::vector<Vec3> p, q;
        for (const std::int32_t v : a) p.push_back(x[Index(v)]);
        for (const std::int32_t v : b) q.push_back(x[Index(v)]);
        if (SampledDistance(p, q) > m.reach[Index(m.mesh.body[Index(a[0])])] + m.reach[Index(m.mesh.body[Index(b[0])])])
          return;
        ++close;
        REQUIRE(std::binary_search(set.begin(), set.end(), key[0]));
      };
      for (std::int32_t v = 0; v < m.mesh.vertices(); ++v) {
        for (const Triangle& t : m.mesh.triangles) {
          const VertexQuad q = {v, t.a, t.b, t.c};
          check(vertexTriangle, Sorted(std::span(&q, 1)), {v}, {t.a, t.b, t.c});
        }
      }
      for (const Edge& e : m.mesh.edges) {
        for (const Edge& f : m.mesh.edges) {
          const VertexQuad q = {e.a, e.b, f.a, f.b};
          if (e.a < f.a) check(edgeEdge, SortedEdges(std::span(&q, 1)), {e.a, e.b}, {f.a, f.b});
        }
      }
    }
  }
  CHECK(close > 1000);
}

TEST_CASE("the order is the same for any number of threads, and for a finder that was used before") {
  MovingMesh bodies = Bodies(), drape = Sheet(60, 1), crumpled = Sheet(40, 4);
  for (const MovingMesh* m : {&bodies, &drape, &crumpled}) {
    const Executor one(1);
    PairFinder first(m->mesh, one);
    first.Find(m->Motion(), m->reach, m->clothPairs);
    CHECK(!first.vertexTriangle().empty());
    CHECK(!first.edgeEdge().empty());
    for (const int threads : {1, 2, 3, 8}) {
      CAPTURE(threads);
      const Executor executor(threads);
      PairFinder finder(m->mesh, executor);
      MovingMesh other = *m;
      for (Vec3& p : other.start) p = p * 0.7;
      for (int repeat = 0; repeat < 3; ++repeat) {
        finder.Find(m->Motion(), m->reach, m->clothPairs);
        CHECK(Same(finder.vertexTriangle(), first.vertexTriangle()));
        CHECK(Same(finder.edgeEdge(), first.edgeEdge()));
        finder.Find(other.Motion(), m->reach, m->clothPairs);
      }
    }
  }
}

TEST_CASE("kernels of every instruction set find the same in the same order") {
  MovingMesh bodies = Bodies(), drape = Sheet(60, 1), crumpled = Sheet(40, 4);
  for (const MovingMesh* m : {&bodies, &drape, &crumpled}) {
    const Executor executor(1);
    PairFinder plain(m->mesh, executor, *collide::RunnableKernels().front());
    plain.Find(m->Motion(), m->reach, m->clothPairs);
    CHECK(!plain.edgeEdge().empty());
    for (const collide::Kernels* kernels : collide::RunnableKernels()) {
      CAPTURE(kernels->name);
      PairFinder finder(m->mesh, executor, *kernels);
      finder.Find(m->Motion(), m->reach, m->clothPairs);
      CHECK(Same(finder.vertexTriangle(), plain.vertexTriangle()));
      CHECK(Same(finder.edgeEdge(), plain.edgeEdge()));
    }
  }
}
