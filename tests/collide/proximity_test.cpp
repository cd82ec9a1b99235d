#include "collide/proximity.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "collide/kernels.h"
#include "math/splitmix64.h"
#include "tests/collide/contact_meshes.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr PairKind kKinds[] = {PairKind::VertexTriangle, PairKind::EdgeEdge};

double Distance(PairKind kind, const Corners<double>& x) {
  const Vec3 a = ToVec3(x[0]), b = ToVec3(x[1]), c = ToVec3(x[2]), d = ToVec3(x[3]);
  return kind == PairKind::VertexTriangle ? PointTriangleDistance(a, b, c, d) : EdgeDistance(a, b, c, d);
}

/// Shapes that are hard: parallel edges, slivers, flat triangles, corners that lie together, far from the origin.
std::vector<Corners<double>> Shapes() {
  SplitMix64 random(7);
  std::vector<Corners<double>> shapes;
  for (int k = 0; k < 3000; ++k) {
    Corners<double> x;
    const Vec3 origin = k % 3 == 0 ? RandomVector(random, 100) : Vec3{};
    for (auto& corner : x) corner = From<double>(origin + RandomVector(random, 0.01));
    const double little = std::pow(10, -12 * random.NextUnit());
    switch (k % 6) {
      case 1:  // nearly parallel edges; a sliver
        x[3] = x[2] + (x[1] - x[0]) + From<double>(RandomVector(random, 0.01 * little));
        break;
      case 2:  // all nearly in a plane
        for (auto& corner : x) corner.z = origin.z + 0.01 * little * (2 * random.NextUnit() - 1);
        break;
      case 3:  // corners that lie together
        x[2] = x[3];
        break;
      case 4:  // nearly meeting
        x[0] = (x[1] + x[2] + x[3]) * (1.0 / 3) + From<double>(RandomVector(random, 0.01 * little));
        break;
      default:
        break;
    }
    shapes.push_back(x);
  }
  return shapes;
}

}  // namespace

TEST_CASE("the closest points of a pair are as far apart as nothing else is nearer") {
  for (const PairKind kind : kKinds) {
    for (const Corners<double>& x : Shapes()) {
      const Closest<double> closest = ClosestOf(kind, x);
      const double expected = Distance(kind, x), found = std::sqrt(closest.squared);
      const double rounding = 1e-15 * (std::sqrt(Dot(x[0], x[0])) + 1) * 100;
      CHECK(found <= expected + 1e-6 * expected + rounding);
      CHECK(found >= expected - 1e-6 * expected - rounding);
      double sum = 0;
      Vector3<double> way;
      for (std::size_t k = 0; k < 4; ++k) {
        sum += closest.weight[k];
        way += (x[k] - x[0]) * closest.weight[k];
        CHECK(std::abs(closest.weight[k]) <= 1 + 1e-9);
      }
      CHECK(std::abs(sum) < 1e-9);
      const Vector3<double> off = way - closest.way;
      CHECK(std::sqrt(Dot(off, off)) <= 1e-12);
    }
  }
}

TEST_CASE("many pairs at a time are as they are one by one, to the bit, with every instruction set") {
  std::vector<Vec3> x;
  std::vector<VertexQuad> pairs;
  for (const Corners<double>& shape : Shapes()) {
    const auto first = static_cast<std::int32_t>(x.size());
    for (const auto& corner : shape) x.push_back(ToVec3(corner));
    pairs.push_back({first, first + 1, first + 2, first + 3});
  }
  pairs.push_back({0, 1, 0, 1});  // no length, no area, no distance
  pairs.push_back({0, 0, 0, 0});
  const auto isSame = [](const PairState& a, const PairState& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  for (const PairKind kind : kKinds) {
    for (const collide::Kernels* kernels : collide::RunnableKernels()) {
      CAPTURE(kernels->name);
      std::vector<PairState> states(pairs.size() + 1);
      const int count = static_cast<int>(pairs.size());
      kernels->pairStates({kind == PairKind::EdgeEdge, count, pairs[0].data(), x.data(), states[0].weight.data()});
      int same = 0;
      for (std::size_t p = 0; p < pairs.size(); ++p) {
        Corners<double> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = From<double>(x[static_cast<std::size_t>(pairs[p][k])]);
        same += isSame(states[p], StateOf(kind, corners)) ? 1 : 0;
      }
      CHECK(same == count);
      CHECK(isSame(states.back(), {}));
    }
  }
}

TEST_CASE("a gap along a direction is never more than the distance, and along the closest points' way as much") {
  SplitMix64 random(11);
  for (const PairKind kind : kKinds) {
    for (const Corners<double>& x : Shapes()) {
      const double distance = Distance(kind, x);
      const Vec3 any = RandomVector(random, 1);
      CHECK(GapAlong(kind, x, From<double>(UnitOr(any, {1, 0, 0}))) <= distance + 1e-13);
      const PairState state = StateOf(kind, x);
      CHECK(state.gap <= distance + 1e-13);
      if (distance > 1e-6) CHECK(state.gap >= distance * (1 - 1e-6));
    }
  }
}

TEST_CASE("over the share that a pair may go it keeps its floor, and hardly less would do") {
  SplitMix64 random(5);
  int whole = 0, cut = 0, near = 0;
  for (const PairKind kind : kKinds) {
    for (const Corners<double>& x : Shapes()) {
      const PairState start = StateOf(kind, x);
      if (!(start.gap > 1e-7)) continue;
      Corners<double> way;
      const double speed = std::pow(10, -4 + 4 * random.NextUnit());
      const Vec3 common = RandomVector(random, 1);
      for (auto& w : way) w = From<double>(common + RandomVector(random, speed));
      const double floor = (0.1 + 0.8 * random.NextUnit()) * start.gap;
      const double share = ShareApart(kind, x, way, start, floor);
      REQUIRE(share >= 0);
      REQUIRE(share <= 1);
      (share == 1 ? whole : cut) += 1;
      for (int k = 0; k <= 200; ++k) {
        const double distance = Distance(kind, After(x, way, share * k / 200));
        REQUIRE(distance >= floor * (1 - 1e-9) - 1e-13);
      }
      // Where it stops it is nearly at its floor.
      if (share < 1) near += Distance(kind, After(x, way, share)) <= floor + 0.2 * (start.gap - floor) ? 1 : 0;
    }
  }
  CHECK(whole > 500);
  CHECK(cut > 500);
  CHECK(near > 0.9 * cut);
}

TEST_CASE("what stays apart needs no search") {
  // A triangle that turns below a vertex which slides along: parted by the plane between them at both ends.
  const Corners<double> x = {{{0, 0, 0.001}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
  const Corners<double> slide = {{{0.3, 0.2, 0}, {}, {}, {}}};
  const PairState state = StateOf(PairKind::VertexTriangle, x);
  CHECK(StaysApart(PairKind::VertexTriangle, x, slide, state, 0.0009));
  const Corners<double> through = {{{0, 0, -0.002}, {}, {}, {}}};
  CHECK(!StaysApart(PairKind::VertexTriangle, x, through, state, 0.0005));
}
