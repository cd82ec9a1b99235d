#include "collide/pair_finder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "core/executor.h"
#include "math/splitmix64.h"
#include "tests/collide/contact_meshes.h"
#include "tests/sanitized.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr double kSpacing = 0.01;           // m
constexpr double kReach = 0.15 * kSpacing;  // of a body

/// Whether pairs have the mesh's triangles and edges, their vertices in the same order.
bool AreOfMesh(const ContactMesh& mesh, const PairFinder& finder) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const auto& [a, b, c] : mesh.triangles) triangles.push_back({a, b, c});
  for (const auto& [a, b] : mesh.edges) edges.push_back({a, b});
  std::sort(triangles.begin(), triangles.end());
  std::sort(edges.begin(), edges.end());
  const auto has = [](const auto& all, const auto& one) { return std::binary_search(all.begin(), all.end(), one); };
  return std::all_of(finder.vertexTriangle().begin(), finder.vertexTriangle().end(),
                     [&](const VertexQuad& q) {
                       return has(triangles, std::array{q[1], q[2], q[3]});
                     }) &&
         std::all_of(finder.edgeEdge().begin(), finder.edgeEdge().end(), [&](const VertexQuad& q) {
           return has(edges, std::array{q[0], q[1]}) && has(edges, std::array{q[2], q[3]});
         });
}

/// What is wrong with what is found, or nothing. All that come within reach are, and none whose boxes are `slack` [m]
/// farther apart at all times. `hidden`: counts pairs whose boxes come within reach, but that do not.
std::string Fault(const MovingMesh& m, double slack = 1e-6, std::size_t* hidden = nullptr) {
  const Executor executor(1);
  const ContactMesh mesh = Clustered(m.mesh);
  PairFinder finder(mesh, executor);
  finder.Find(m.Motion(), m.reach, m.clothPairs);
  if (!AreOfMesh(m.mesh, finder)) return "what the mesh does not have";
  const PairSet vertexTriangle = Sorted(finder.vertexTriangle()), edgeEdge = SortedEdges(finder.edgeEdge());
  for (const PairSet* set : {&vertexTriangle, &edgeEdge}) {
    if (std::adjacent_find(set->begin(), set->end()) != set->end()) return "a pair that is listed twice";
  }
  const AllPairs far = FindAll(m, slack);
  const auto includes = [](const PairSet& all, const PairSet& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
  };
  if (!includes(far.vertexTriangle, vertexTriangle)) return "a vertex and a triangle that are too far apart";
  if (!includes(far.edgeEdge, edgeEdge)) return "two edges that are too far apart";

  const AllPairs near = FindAll(m);
  const auto missing = [](const PairSet& all, const PairSet& some) {
    PairSet left;
    std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(left));
    return left;
  };
  const PairSet missingTriangles = missing(near.vertexTriangle, vertexTriangle);
  const PairSet missingEdges = missing(near.edgeEdge, edgeEdge);
  if (hidden) *hidden += missingTriangles.size() + missingEdges.size();
  SplitMix64 random(99);
  for (const double time : {0.0, 1.0, 0.5, 0.25, 0.75, 1.0, 0.9}) {
    const std::vector<Vec3> x = PositionsAt(m, time, random);
    const auto at = [&](std::int32_t v) { return x[Index(v)]; };
    const auto reach = [&](std::int32_t v) { return m.reach[Index(m.mesh.body[Index(v)])]; };
    for (const auto& [v, a, b, c] : missingTriangles) {
      if (PointTriangleDistance(at(v), at(a), at(b), at(c)) <= reach(v) + reach(a)) {
        return "a vertex and a triangle that are missing";
      }
    }
    for (const auto& [a, b, c, d] : missingEdges) {
      if (EdgeDistance(at(a), at(b), at(c), at(d)) <= reach(a) + reach(c)) return "two edges that are missing";
    }
  }
  return "";
}

std::size_t CountPairs(const MovingMesh& m) {
  const Executor executor(1);
  const ContactMesh mesh = Clustered(m.mesh);
  PairFinder finder(mesh, executor);
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
  if (shape == 4) SetShape(m, [&](const Vec3& p) { return p * 0.5 + RandomVector(random, kSpacing); });
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
    MovingMesh m = Sheet(Fewer(100, 35), shape);
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

TEST_CASE("what is just within reach is found, however coordinates round") {
  SplitMix64 random(13);
  for (int round = 0; round < 50; ++round) {
    CAPTURE(round);
    MovingMesh m;
    AddSheet(m, 20, kSpacing, 0);  // most vertices, for what floats are relative to
    for (int body = 1; body < 3; ++body) AddSheet(m, 6, kSpacing, kSpacing * random.NextUnit());
    const Vec3 away = RandomVector(random, round < 25 ? 1 : 100), apart = RandomVector(random, 0.2);
    for (std::size_t v = 0; v < m.start.size(); ++v) {
      m.start[v] += away;
      if (m.mesh.body[v] > 0) m.start[v] += apart + Vec3{0, 0, 2};
      if (m.mesh.body[v] > 1) m.start[v].z += (m.reach[1] + m.reach[2]) * (1 - 1e-9);
    }
    CHECK(Fault(m) == "");
  }
}

TEST_CASE("one vertex that is gone far hides no pairs of the others") {
  for (const double away : {1e3, 1e9, 1e30, 1e200, double{INFINITY}, double{NAN}}) {
    CAPTURE(away);
    MovingMesh m = Sheet(12, 2);
    const Executor executor(1);
    const ContactMesh mesh = Clustered(m.mesh);
    PairFinder finder(mesh, executor);
    const std::int32_t gone = 40;
    const auto without = [&](PairSet set) {
      const auto isGone = [&](const VertexQuad& q) { return std::find(q.begin(), q.end(), gone) != q.end(); };
      set.erase(std::remove_if(set.begin(), set.end(), isGone), set.end());
      return set;
    };
    finder.Find(m.Motion(), m.reach, true);
    const PairSet vertexTriangle = without(Sorted(finder.vertexTriangle()));
    const PairSet edgeEdge = without(SortedEdges(finder.edgeEdge()));
    CHECK(edgeEdge.size() > 100);
    m.start[gone].x += away;
    finder.Find(m.Motion(), m.reach, true);
    const PairSet moreTriangles = Sorted(finder.vertexTriangle()), moreEdges = SortedEdges(finder.edgeEdge());
    CHECK(std::includes(moreTriangles.begin(), moreTriangles.end(), vertexTriangle.begin(), vertexTriangle.end()));
    CHECK(std::includes(moreEdges.begin(), moreEdges.end(), edgeEdge.begin(), edgeEdge.end()));
  }
}

TEST_CASE("nothing is near what is not a number") {
  for (const double value : {double{NAN}, double{INFINITY}, -double{INFINITY}, 1e308}) {
    CAPTURE(value);
    for (const bool inWay : {false, true}) {
      MovingMesh m = Sheet(Fewer(100, 40), 0);
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
    const ContactMesh mesh = Clustered(m.mesh);
    PairFinder finder(mesh, executor);
    finder.Find(m.Motion(), m.reach, true);
    const PairSet vertexTriangle = Sorted(finder.vertexTriangle()), edgeEdge = SortedEdges(finder.edgeEdge());
    const auto body = [&](std::int32_t v) { return m.mesh.body[Index(v)]; };
    const auto check = [&](const PairSet& set, const PairSet& pair, const VertexQuad& q, int others, double distance) {
      const double reach = m.reach[Index(body(q[0]))] + m.reach[Index(body(q[Index(others)]))];
      const bool inCommon = std::find(q.begin() + others, q.end(), q[0]) != q.end() ||
                            (others == 2 && std::find(q.begin() + others, q.end(), q[1]) != q.end());
      if (distance > reach || inCommon || (body(q[0]) == 2 && body(q[3]) == 2)) return;
      ++close;
      REQUIRE(std::binary_search(set.begin(), set.end(), pair[0]));
    };
    for (int sample = 0; sample < 4; ++sample) {
      const std::vector<Vec3> x = PositionsAt(m, random.NextUnit(), random);
      const auto at = [&](std::int32_t v) { return x[Index(v)]; };
      for (std::int32_t v = 0; v < m.mesh.vertices(); ++v) {
        for (const auto& [a, b, c] : m.mesh.triangles) {
          const VertexQuad q = {v, a, b, c};
          check(vertexTriangle, Sorted(std::span(&q, 1)), q, 1, PointTriangleDistance(at(v), at(a), at(b), at(c)));
        }
      }
      for (const auto& [a, b] : m.mesh.edges) {
        for (const auto& [c, d] : m.mesh.edges) {
          const VertexQuad q = {a, b, c, d};
          if (a < c) check(edgeEdge, SortedEdges(std::span(&q, 1)), q, 2, EdgeDistance(at(a), at(b), at(c), at(d)));
        }
      }
    }
  }
  CHECK(close > 1000);
}

TEST_CASE("a flat sheet has hardly any pairs, however it lies, moves and turns a little") {
  for (const int n : {40, 100}) {
    MovingMesh m = Sheet(n, 0);
    CHECK(CountPairs(m) <= Index(n * n) / 20);
    const double turn = 0.7;
    SetShape(m, [&](const Vec3& p) {
      return Vec3{p.x * std::cos(turn) + 3, p.y * std::cos(turn) - p.x * std::sin(turn) * std::sin(turn),
                  p.x * std::sin(turn) * std::cos(turn) + p.y * std::sin(turn)};
    });
    for (std::size_t v = 0; v < m.way.size(); ++v) m.way[v] = Vec3{0, 0, -10} + Cross({0.1, 0.2, 0}, m.start[v]);
    CHECK(CountPairs(m) <= Index(n * n) / 20);
  }
}

TEST_CASE("flat parts hide no pair that comes within reach, up to where their vertices are within reach") {
  SplitMix64 random(12);
  std::size_t hidden = 0;
  for (int round = 0; round < Fewer(120); ++round) {
    CAPTURE(round);
    MovingMesh m;
    const int n = 17;
    // Altitudes are 0.7 of the spacing: reaches go beyond that.
    AddSheet(m, n, kSpacing, 0.45 * kSpacing * random.NextUnit(), false,
             [&](int i, int j) { return round % 3 == 0 && std::hypot(i - 5, j - 9) < 2; });
    const double radius = kSpacing * std::exp(4 * random.NextUnit()), squeeze = 0.3 + random.NextUnit();
    const double noise = kSpacing * std::pow(random.NextUnit(), 3), shear = random.NextUnit();
    const bool isSparse = round % 5 < 2;  // noise: of few vertices
    SetShape(m, [&](const Vec3& p) {
      const Vec3 q = {p.x * squeeze + shear * p.y, p.y, 0};
      const Vec3 onCylinder = {radius * std::sin(q.x / radius), q.y, radius * std::cos(q.x / radius)};
      return onCylinder + RandomVector(random, !isSparse ? noise : random.NextUnit() < 0.03 ? kSpacing : 0);
    });
    Move(m, kSpacing * std::pow(random.NextUnit(), 3), static_cast<std::uint64_t>(round),
         RandomVector(random, 3 * kSpacing));
    if (round % 2 == 0) {
      const double share = round % 4 == 0 ? 0.02 : 1;
      for (std::size_t v = 0; v < m.start.size(); ++v) m.cut.push_back(random.NextUnit() < share ? 1 : 0);
    }
    REQUIRE(Fault(m, 1e-6, &hidden) == "");
  }
  CHECK(hidden > std::size_t(Fewer(2000, 10)));
}

TEST_CASE("the sides of a slit that closes are found") {
  MovingMesh m;
  AddSheet(m, 41, kSpacing, kReach, false, [](int i, int j) { return i == 20 && j >= 10 && j < 30; });
  const std::vector<Vec3> open = m.start;
  SetShape(m, [&](const Vec3& p) {
    const double along = (p.y / kSpacing - 10) / 20;
    const bool moves = p.x > 20.5 * kSpacing && along > 0 && along < 1;
    return p - Vec3{moves ? 0.95 * kSpacing * std::sin(along * std::numbers::pi) : 0, 0, 0};
  });
  CHECK(Fault(m) == "");
  const std::size_t closed = CountPairs(m);
  m.start = open;
  CHECK(closed > CountPairs(m) + 20);
}

TEST_CASE("places that overlap, turn over, lie in any plane or in none hide no pair") {
  for (int kind = 0; kind < 6; ++kind) {
    CAPTURE(kind);
    MovingMesh m = Sheet(20, 0);
    const double width = 19 * kSpacing;
    SetShape(m, [&](const Vec3& p) { return Layers(p, width, 3, 0.1 * kSpacing); });
    for (Vec3& p : m.mesh.place) {
      if (kind == 0) p = {p.z, p.y, p.x};
      if (kind == 1) p = {p.y, 0, p.x};
      if (kind == 2) p = Layers(p, width, 3, 0);  // back and front in the same places
      if (kind == 3) p = Layers(p, width, 3, 0.1 * kSpacing);
      if (kind == 4) p = {0.02 * std::cos(p.x / 0.02), 0.02 * std::sin(p.x / 0.02), p.y};
      if (kind == 5) p = {(p.x + 0.01) * std::cos(50 * p.y), (p.x + 0.01) * std::sin(50 * p.y), 0};  // round and round
    }
    CHECK(Fault(m) == "");
    CHECK(CountPairs(m) > 1000);
  }
}

TEST_CASE("the order is the same for any number of threads, and for a finder that was used before") {
  MovingMesh bodies = Bodies(), drape = Sheet(Fewer(60, 40), 1), crumpled = Sheet(Fewer(40, 20), 4);
  for (const MovingMesh* m : {&bodies, &drape, &crumpled}) {
    const Executor one(1);
    const ContactMesh mesh = Clustered(m->mesh);
    PairFinder first(mesh, one);
    first.Find(m->Motion(), m->reach, m->clothPairs);
    CHECK(!first.vertexTriangle().empty());
    CHECK(!first.edgeEdge().empty());
    for (const int threads : {1, 2, 3, 8}) {
      CAPTURE(threads);
      const Executor executor(threads);
      PairFinder finder(mesh, executor);
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
    const ContactMesh mesh = Clustered(m->mesh);
    PairFinder plain(mesh, executor, *collide::RunnableKernels().front());
    plain.Find(m->Motion(), m->reach, m->clothPairs);
    CHECK(!plain.edgeEdge().empty());
    for (const collide::Kernels* kernels : collide::RunnableKernels()) {
      CAPTURE(kernels->name);
      PairFinder finder(mesh, executor, *kernels);
      finder.Find(m->Motion(), m->reach, m->clothPairs);
      CHECK(Same(finder.vertexTriangle(), plain.vertexTriangle()));
      CHECK(Same(finder.edgeEdge(), plain.edgeEdge()));
    }
  }
}
