#include "percale/intersections.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "percale/world.h"

using namespace percale;

namespace {

ClothSettings Sheet(const Vec3& origin, int points = 12) {
  ClothSettings cloth;
  cloth.numWidthPoints = cloth.numHeightPoints = points;
  cloth.origin = origin;
  return cloth;
}

/// Sheets that lie at these heights, and one that stands across them at z = 0.437 where it says so.
Scene Sheets(std::initializer_list<double> heights, bool standing) {
  Scene scene;
  for (const double height : heights) scene.cloths.push_back(Sheet({0, height, 0}));
  if (standing) {
    scene.cloths.push_back(Sheet({0.013, 0.473, 0.437}));
    scene.cloths.back().orientation = Orientation::Vertical;
  }
  return scene;
}

}  // namespace

TEST_CASE("cloths that lie apart do not intersect, one that stands in them does") {
  const World apart(Sheets({0, 0.1, 0.2}, false));
  CHECK(ClothJudge(apart).Count(apart).count == 0);

  const World world(Sheets({0, 0.1}, true));
  const ClothIntersections found = ClothJudge(world).Count(world, 1000000);
  CHECK(found.count == std::int64_t(found.first.size()));
  CHECK(found.count > 24);
  bool seen[3] = {false, false, false};
  for (const ClothIntersection& each : found.first) {
    CHECK((each.edgeCloth == 2) != (each.triangleCloth == 2));
    seen[each.edgeCloth == 2 ? each.triangleCloth : each.edgeCloth] = true;
    // The place is on the edge, in the triangle's plane.
    const auto x = world.Cloth(each.edgeCloth).positions();
    const Vec3 p = x[std::size_t(each.edge.a)], q = x[std::size_t(each.edge.b)];
    CHECK(each.edge.a < each.edge.b);
    CHECK(Length(each.place - p) + Length(q - each.place) == doctest::Approx(Length(q - p)));
    const ClothView other = world.Cloth(each.triangleCloth);
    const Triangle t = other.triangles()[std::size_t(each.triangle)];
    const Vec3 a = other.positions()[std::size_t(t.a)], b = other.positions()[std::size_t(t.b)],
               c = other.positions()[std::size_t(t.c)];
    CHECK(std::abs(Dot(UnitOr(Cross(b - a, c - a), {}), each.place - a)) < 1e-12);
  }
  CHECK(seen[0]);
  CHECK(seen[1]);
}

TEST_CASE("the first few are the first of all, for any number of threads") {
  const World world(Sheets({0, 0.1, 0.2}, true));
  const ClothIntersections all = ClothJudge(world, 1).Count(world, 1000000);
  for (const int threads : {1, 2, 3, 8}) {
    const ClothIntersections few = ClothJudge(world, threads).Count(world, 7);
    CHECK(few.count == all.count);
    CHECK(few.first == std::vector<ClothIntersection>(all.first.begin(), all.first.begin() + 7));
  }
}

TEST_CASE("positions may come from elsewhere, and a judge judges many of them") {
  const World world(Sheets({0, 0.1}, false));
  std::vector<ClothTopology> cloths;
  std::vector<Vec3> positions;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const auto x = world.Cloth(c).positions();
    cloths.push_back({int(x.size()), world.Cloth(c).triangles()});
    positions.insert(positions.end(), x.begin(), x.end());
  }
  ClothJudge judge(cloths);
  CHECK(judge.Count(positions).count == 0);
  const std::size_t upper = world.Cloth(0).positions().size();
  for (std::size_t v = upper; v < positions.size(); ++v) positions[v].y = 1.01 + 0.1 * (positions[v].x - 0.5);
  CHECK(judge.Count(positions).count > 0);
  // Laid onto the other exactly: all of it touches.
  for (std::size_t v = upper; v < positions.size(); ++v) positions[v].y = 1;
  const ClothIntersections touching = judge.Count(positions);
  CHECK(touching.count > 1000);
  for (const ClothIntersection& each : touching.first) CHECK(each.place.y == 1);
  for (std::size_t v = upper; v < positions.size(); ++v) positions[v].y = std::nextafter(1.0, 2.0);
  CHECK(judge.Count(positions).count == 0);
}

TEST_CASE("no cloths, no intersections") {
  ClothJudge judge(std::span<const ClothTopology>{});
  CHECK(judge.Count(std::span<const Vec3>{}).count == 0);
}
