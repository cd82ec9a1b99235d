#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "math/splitmix64.h"
#include "mesh/cloth_model.h"

using namespace percale;

namespace {

ClothSettings Sheet(int numWidth, int numHeight) {
  ClothSettings cloth;
  cloth.width = 3;
  cloth.height = 2;
  cloth.numWidthPoints = numWidth;
  cloth.numHeightPoints = numHeight;
  return cloth;
}

}  // namespace

TEST_CASE("a horizontal sheet lies at y = 1 over x and z, point (i, j) at index j * width + i") {
  const ClothModel model = MakeGrid(Sheet(4, 3));
  REQUIRE(model.PointCount() == 12);
  REQUIRE(model.start.size() == 12);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      const std::size_t p = static_cast<std::size_t>(j * 4 + i);
      CHECK(model.start[p] == Vec3{1.0 * i, 1, 1.0 * j});
      CHECK(model.uv[p] == Vec2{i / 3.0, j / 2.0});
    }
  }
}

TEST_CASE("a vertical sheet stands in x and y, its z drawn from the seed's numbers in index order") {
  ClothSettings cloth = Sheet(20, 30);
  cloth.orientation = Orientation::Vertical;
  cloth.seed = 42;
  const ClothModel model = MakeGrid(cloth);
  SplitMix64 random(42);
  double lowest = 1, highest = -1;
  for (std::size_t p = 0; p < model.start.size(); ++p) {
    const double u = static_cast<double>(random.Next() >> 11) * std::ldexp(1.0, -53);
    CHECK(model.start[p].z == (2 * u - 1) / 1000);
    CHECK(model.start[p].x == doctest::Approx(3.0 * static_cast<double>(p % 20) / 19));
    CHECK(model.start[p].y == doctest::Approx(2.0 * static_cast<double>(p / 20) / 29));
    lowest = std::min(lowest, model.start[p].z);
    highest = std::max(highest, model.start[p].z);
  }
  CHECK(lowest < -0.0009);
  CHECK(highest > 0.0009);
  CHECK(MakeGrid(cloth).start == model.start);
  cloth.seed = 43;
  CHECK(MakeGrid(cloth).start != model.start);
}

TEST_CASE("the origin moves the whole sheet") {
  for (const Orientation orientation : {Orientation::Horizontal, Orientation::Vertical}) {
    ClothSettings cloth = Sheet(4, 3);
    cloth.orientation = orientation;
    const ClothModel here = MakeGrid(cloth);
    cloth.origin = {1, -2, 0.5};
    const ClothModel there = MakeGrid(cloth);
    for (std::size_t p = 0; p < here.start.size(); ++p) CHECK(there.start[p] == here.start[p] + cloth.origin);
  }
}

TEST_CASE("each quad is cut into the triangles A C B and B C D") {
  const ClothModel model = MakeGrid(Sheet(3, 3));
  REQUIRE(model.triangles.size() == 8);
  const int expected[8][3] = {{0, 3, 1}, {1, 3, 4}, {1, 4, 2}, {2, 4, 5}, {3, 6, 4}, {4, 6, 7}, {4, 7, 5}, {5, 7, 8}};
  for (std::size_t t = 0; t < 8; ++t) {
    CHECK(model.triangles[t].a == expected[t][0]);
    CHECK(model.triangles[t].b == expected[t][1]);
    CHECK(model.triangles[t].c == expected[t][2]);
  }
}

TEST_CASE("the triangles cover the sheet once, all seen from the same side") {
  const ClothModel model = MakeGrid(Sheet(7, 5));
  double area = 0;
  for (const Triangle& t : model.triangles) {
    const Vec3& a = model.start[static_cast<std::size_t>(t.a)];
    const Vec3 normal =
        Cross(model.start[static_cast<std::size_t>(t.b)] - a, model.start[static_cast<std::size_t>(t.c)] - a);
    CHECK(normal.y > 0);
    area += 0.5 * Length(normal);
  }
  CHECK(area == doctest::Approx(6));
}

TEST_CASE("pins are indices, ascending, each once") {
  ClothSettings cloth = Sheet(4, 3);
  cloth.pinned = {{3, 2}, {0, 0}, {1, 1}, {0, 0}};
  CHECK(PinnedVertices(cloth) == std::vector<std::int32_t>{0, 5, 11});
}

TEST_CASE("springs are created point by point: left, up, upper left, upper right, two left, two up") {
  const ClothSettings cloth = Sheet(3, 3);
  const std::vector<Edge> springs = EnabledSprings(MakeGrid(cloth), cloth);
  const std::vector<std::pair<int, int>> expected = {
      {1, 0},                                  // (1, 0)
      {2, 1}, {2, 0},                          // (2, 0)
      {3, 0}, {3, 1},                          // (0, 1)
      {4, 3}, {4, 1}, {4, 0}, {4, 2},          // (1, 1)
      {5, 4}, {5, 2}, {5, 1}, {5, 3},          // (2, 1)
      {6, 3}, {6, 4}, {6, 0},                  // (0, 2)
      {7, 6}, {7, 4}, {7, 3}, {7, 5}, {7, 1},  // (1, 2)
      {8, 7}, {8, 5}, {8, 4}, {8, 6}, {8, 2},  // (2, 2)
  };
  REQUIRE(springs.size() == expected.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    CAPTURE(s);
    CHECK(springs[s].a == expected[s].first);
    CHECK(springs[s].b == expected[s].second);
  }
}

TEST_CASE("the number of springs of each kind, for every choice of kinds") {
  for (const auto& [nw, nh] : std::vector<std::pair<int, int>>{{2, 2}, {2, 9}, {9, 2}, {3, 4}, {50, 50}}) {
    for (int kinds = 0; kinds < 8; ++kinds) {
      ClothSettings cloth = Sheet(nw, nh);
      cloth.enableStructural = kinds & 1;
      cloth.enableShearing = kinds & 2;
      cloth.enableBending = kinds & 4;
      int expected = 0;
      if (kinds & 1) expected += (nw - 1) * nh + nw * (nh - 1);
      if (kinds & 2) expected += 2 * (nw - 1) * (nh - 1);
      if (kinds & 4) expected += (nw - 2) * nh + nw * (nh - 2);
      const ClothModel model = MakeGrid(cloth);
      const std::vector<Edge> springs = EnabledSprings(model, cloth);
      CHECK(static_cast<int>(springs.size()) == expected);
      std::map<std::pair<int, int>, int> seen;
      for (const Edge& e : springs) {
        CHECK(e.a > e.b);  // each to a point that came before
        CHECK(e.b >= 0);
        ++seen[{e.a, e.b}];
      }
      CHECK(seen.size() == springs.size());
    }
  }
}
