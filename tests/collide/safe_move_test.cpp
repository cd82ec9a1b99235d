#include "collide/safe_move.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "collide/intersections.h"
#include "core/executor.h"
#include "math/splitmix64.h"
#include "tests/collide/contact_meshes.h"
#include "tests/sanitized.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr double kSpacing = 0.01;  // m
constexpr double kHalf = 0.15 * kSpacing;

std::int64_t Intersections(const MovingMesh& m, std::span<const Vec3> x) {
  const Executor executor(1);
  IntersectionJudge judge(m.mesh.vertices(), m.mesh.triangles);
  return judge.Count(x, executor).count;
}

struct Moved {
  std::vector<Vec3> end;
  std::vector<double> share;
  SafeMoveReport report;
};

Moved Move(const MovingMesh& m, int threads = 1) {
  const Executor executor(threads);
  const ContactMesh mesh = Clustered(m.mesh);
  SafeMove safe(mesh, executor);
  Moved moved;
  moved.share.resize(m.start.size());
  moved.report = safe.Move(m.start, m.way, {m.reach, m.clothPairs}, moved.share);
  for (std::size_t v = 0; v < m.start.size(); ++v) moved.end.push_back(m.start[v] + m.way[v] * moved.share[v]);
  return moved;
}

/// As files hold positions.
std::vector<Vec3> AsFloats(std::span<const Vec3> x) {
  std::vector<Vec3> rounded;
  for (const Vec3& v : x)
    rounded.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  return rounded;
}

/// Moves again and again by random ways that are given anew each time, and judges each state, also halfway there and
/// in floats.
void Shake(MovingMesh& m, int times, const std::function<Vec3(SplitMix64&, const Vec3&)>& wayOf) {
  SplitMix64 random(3);
  REQUIRE(Intersections(m, m.start) == 0);
  for (int k = 0; k < times; ++k) {
    for (std::size_t v = 0; v < m.start.size(); ++v) m.way[v] = wayOf(random, m.start[v]);
    const Moved moved = Move(m);
    for (const double share : moved.share) {
      REQUIRE(share >= 0);
      REQUIRE(share <= 1);
    }
    std::vector<Vec3> half = m.start;
    for (std::size_t v = 0; v < half.size(); ++v) half[v] += (moved.end[v] - m.start[v]) * 0.5;
    REQUIRE(Intersections(m, half) == 0);
    REQUIRE(Intersections(m, moved.end) == 0);
    REQUIRE(Intersections(m, AsFloats(moved.end)) == 0);
    m.start = moved.end;
  }
}

MovingMesh Stack(int n, int sheets, double apart) {
  MovingMesh m;
  for (int s = 0; s < sheets; ++s) AddSheet(m, n, kSpacing, kHalf);
  for (std::size_t v = 0; v < m.start.size(); ++v) m.start[v].z = apart * m.mesh.body[v];
  return m;
}

}  // namespace

TEST_CASE("random ways of any length take nothing through anything") {
  for (const double size : {0.1 * kSpacing, kSpacing, 10 * kSpacing, 0.8}) {  // the last: 50 m/s for 1/60 s
    CAPTURE(size);
    MovingMesh m = Stack(Fewer(12, 6), 2, 0.3 * kSpacing);
    Shake(m, Fewer(8, 3), [&](SplitMix64& random, const Vec3&) { return RandomVector(random, size); });
  }
}

TEST_CASE("sheets in one plane and edges that are parallel stay apart") {
  // Two sheets side by side in a plane, a hair's breadth between them, that shove each other along it.
  MovingMesh m;
  AddSheet(m, 10, kSpacing, kHalf);
  AddSheet(m, 10, kSpacing, kHalf);
  for (std::size_t v = 100; v < 200; ++v) m.start[v].x += 9 * kSpacing + 1e-5;
  Shake(m, 15, [&](SplitMix64& random, const Vec3& x) {
    const double shove = x.x < 9 * kSpacing ? 1 : -1;
    return Vec3{shove * kSpacing * random.NextUnit(), 0.1 * kSpacing * random.NextUnit(), 0};
  });
}

TEST_CASE("slivers stay apart") {
  MovingMesh m;
  m.AddBody(kHalf);
  AddSheet(m, 8, kSpacing, kHalf);
  for (std::size_t v = 0; v < m.start.size(); ++v) m.mesh.place[v].x = m.start[v].x = 0.001 * m.start[v].x;
  AddSheet(m, 8, kSpacing, kHalf);
  for (std::size_t v = 64; v < 128; ++v) m.start[v].z = 1e-4;
  Shake(m, 10, [&](SplitMix64& random, const Vec3&) { return RandomVector(random, kSpacing); });
}

TEST_CASE("far from the origin it is the same") {
  MovingMesh m = Stack(10, 2, 0.3 * kSpacing);
  for (Vec3& x : m.start) x += Vec3{100, -70, 90};
  Shake(m, 8, [&](SplitMix64& random, const Vec3&) { return RandomVector(random, 2 * kSpacing); });
}

TEST_CASE("a ball's worth of vertices shot through a sheet stops before it") {
  MovingMesh m = Stack(14, 2, 0.5);
  for (std::size_t v = 196; v < m.way.size(); ++v) m.way[v] = {0, 0, -0.8};
  const Moved moved = Move(m);
  CHECK(Intersections(m, moved.end) == 0);
  for (std::size_t v = 196; v < m.way.size(); ++v) CHECK(moved.end[v].z > 0);
}

TEST_CASE("what moves as one is kept apart where the first of it is stopped") {
  // Two sheets, one above the other and too far apart to be in contact, fly down. A patch holds a corner of the lower.
  MovingMesh m;
  AddSheet(m, 10, kSpacing, kHalf);
  AddSheet(m, 10, kSpacing, kHalf);
  AddSheet(m, 2, 0.2 * kSpacing, kHalf);
  for (std::size_t v = 0; v < 200; ++v) {
    const double shift = m.mesh.body[v] * kSpacing;
    m.start[v] += Vec3{0.5 * shift, 0.5 * shift, 0.1 + 0.8 * shift};
    m.way[v] = {0, 0, -0.8};
  }
  for (std::size_t v = 200; v < 204; ++v) m.start[v] -= Vec3{0.1 * kSpacing, 0.1 * kSpacing, 0};
  const Moved moved = Move(m);
  CHECK(moved.share[0] < 0.2);
  CHECK(moved.share[100] < 1);
  CHECK(moved.share[99] == 1);
  CHECK(Intersections(m, moved.end) == 0);
}

TEST_CASE("cloth that nothing is in the way of goes all its way, however fast") {
  MovingMesh m = Stack(12, 1, 0);
  SetShape(m, [](const Vec3& p) { return Drape(p, 11 * kSpacing); });
  for (Vec3& way : m.way) way = {3, -50, 7};
  const Moved moved = Move(m);
  CHECK(moved.report.cut == 0);
  CHECK(moved.report.lost == 0);
  CHECK(moved.report.detections == 1);
}

TEST_CASE("a vertex without a way stays, and the rest may come as near as the floor") {
  MovingMesh m = Stack(8, 2, 2 * kSpacing);
  for (std::size_t v = 64; v < m.way.size(); ++v) m.way[v] = {0, 0, -4 * kSpacing};
  const Moved moved = Move(m);
  for (std::size_t v = 0; v < 64; ++v) CHECK(moved.end[v] == m.start[v]);
  const double floor = FloorOf(2 * kSpacing, 2 * kHalf);
  double nearest = 1;
  for (std::size_t v = 64; v < m.way.size(); ++v) {
    CHECK(moved.end[v].z >= floor * (1 - 1e-9));
    nearest = std::min(nearest, moved.end[v].z);
  }
  CHECK(nearest <= floor + 0.1 * 2 * kSpacing);
}

TEST_CASE("what is listed is all that was found and is soon in contact") {
  const int n = Fewer(24, 14);
  MovingMesh m;
  AddSheet(m, n, kSpacing, kHalf);
  const double width = (n - 1) * kSpacing;
  SetShape(m, [&](const Vec3& p) { return Layers(p, width, 4, 1.5 * kHalf); });
  SplitMix64 random(9);
  for (std::size_t v = 0; v < m.way.size(); ++v) {
    m.start[v] += RandomVector(random, 0.2 * kHalf);
    m.way[v] = Vec3{0.3, 0, 0.1} + RandomVector(random, 0.2 * kHalf);  // a flight of little change
  }
  const Executor executor(2);
  const ContactMesh mesh = Clustered(m.mesh);
  SafeMove safe(mesh, executor);
  const ContactDistances distances{{kHalf}, true};
  safe.List(m.start, m.way, distances);
  const PairSet listed[2] = {Sorted(safe.vertexTriangle().vertex), SortedEdges(safe.edgeEdge().vertex)};
  PairFinder finder(mesh, executor);
  finder.Find(m.Motion(), m.reach, true);
  const PairSet found[2] = {Sorted(finder.vertexTriangle()), SortedEdges(finder.edgeEdge())};
  std::size_t missed = 0, contacts = 0;
  for (const PairKind kind : {PairKind::VertexTriangle, PairKind::EdgeEdge}) {
    const std::size_t number = kind == PairKind::EdgeEdge ? 1 : 0;
    CHECK(listed[number].size() < 0.8 * static_cast<double>(found[number].size()));
    for (const VertexQuad& q : found[number]) {
      double gap = 1;  // the least of some on these ways, gone twice
      for (const double time : {0.0, 0.5, 1.0, 1.5, 2.0}) {
        Corners<double> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = From<double>(m.start[Index(q[k])] + m.way[Index(q[k])] * time);
        gap = std::min(gap, StateOf(kind, x).gap);
      }
      const double distance = safe.DistanceOf(kind, q, distances);
      contacts += gap < distance ? 1 : 0;
      if (gap < kSoon * distance) missed += std::binary_search(listed[number].begin(), listed[number].end(), q) ? 0 : 1;
    }
  }
  CHECK(missed == 0);
  CHECK(contacts > 100);
}

TEST_CASE("whether anything is near is whether anything without a common vertex is within reach") {
  const Executor executor(2);
  const ContactMesh mesh = Clustered(Stack(8, 2, 0).mesh);
  SafeMove safe(mesh, executor);
  for (const double apart : {1.01, 0.99, 0.0}) {
    CAPTURE(apart);
    MovingMesh m = Stack(8, 2, apart * 2 * kHalf);
    CHECK(safe.AnyNear(m.start, m.way, {m.reach, true}) == (apart < 1));
    CHECK(!safe.AnyNear(m.start, m.way, {m.reach, false}));
    for (std::size_t v = 64; v < 128; ++v) m.way[v].z = -0.1 * kHalf;
    CHECK(safe.AnyNear(m.start, m.way, {m.reach, true}));
  }
}

TEST_CASE("the floor lets a pair come back as often as it likes") {
  const double distance = 0.003;
  double gap = distance;
  for (int k = 0; k < 1000; ++k) {
    const double floor = FloorOf(gap, distance);
    REQUIRE(floor > 0);
    REQUIRE(floor < gap);
    gap = floor;
  }
  CHECK(gap > 0.01 * distance);
  CHECK(FloorOf(1, distance) == doctest::Approx(0.25 * distance));  // fast cloth stops near what it meets
}

TEST_CASE("the same bits for any number of threads") {
  MovingMesh m = Stack(Fewer(20, 12), 4, 0.3 * kSpacing);
  SplitMix64 random(21);
  for (Vec3& way : m.way) way = RandomVector(random, 2 * kSpacing);
  const Moved one = Move(m, 1);
  CHECK(one.report.cut > 100);
  for (const int threads : {2, 3, 8}) {
    const Moved more = Move(m, threads);
    CHECK(more.end == one.end);
    CHECK(more.share == one.share);
  }
}

TEST_CASE("pairs that are near in the flat cloth are in contact only where they come nearer still") {
  const ContactMesh one = Clustered(Stack(6, 1, 0).mesh);
  const Executor executor(1);
  const SafeMove safe(one, executor);
  // Opposite corners of two triangles with a common side.
  const ContactDistances distances{{10 * kSpacing}, true};
  const double found = safe.DistanceOf(PairKind::VertexTriangle, {0, 1, 7, 2}, distances);
  CHECK(found < kSpacing);
  CHECK(found > 0);
  // Those of different cloths keep their distance.
  const ContactMesh two = Clustered(Stack(6, 2, kSpacing).mesh);
  const SafeMove other(two, executor);
  CHECK(other.DistanceOf(PairKind::VertexTriangle, {0, 36, 37, 42}, {{kHalf, kHalf}, true}) == 2 * kHalf);
}
