#include "apps/viewer/hand_tools.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/rest_mesh.h"

using namespace percale;
using namespace percale::viewer;

namespace {

Scene Square(double width, int points) {
  Scene scene;
  scene.cloths.resize(1);
  scene.cloths[0].width = scene.cloths[0].height = width;
  scene.cloths[0].numWidthPoints = scene.cloths[0].numHeightPoints = points;
  return scene;
}

}  // namespace

TEST_CASE("a hand leads cloth, and does not tear at it from afar") {
  const Handle grip = GripOf(Square(1, 50), 0, 1, {});
  const Vec3 at{1, 2, 3}, near = at + Vec3{0, 0.01, 0}, far = at + Vec3{0, 30, 40};
  CHECK(LeadOf(grip, at, at) == at);
  CHECK(LeadOf(grip, at, near) == near);
  const Vec3 lead = LeadOf(grip, at, far) - at;
  CHECK(Length(lead) > grip.radius);
  CHECK(Length(lead) < 2 * grip.radius);
  CHECK(Dot(lead, far - at) == doctest::Approx(Length(lead) * 50));
}

TEST_CASE("a pin that is carried does not tear at its cloth") {
  // The pin, a neighbour to the right of it, and one below.
  const std::vector<Edge> springs{{0, 1}, {0, 2}, {1, 2}};
  const std::vector<double> restLengths{1, 1, std::sqrt(2.0)};
  const std::vector<Vec3> slack{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}, taut{{0, 0, 0}, {1.6, 0, 0}, {0, -1, 0}};
  const std::vector<Vec3> tautBoth{{0, 0, 0}, {1.6, 0, 0}, {0, -1.6, 0}};
  const auto carried = [&](const std::vector<Vec3>& positions, const Vec3& way) {
    return CarriedWay(0, way, positions, springs, restLengths);
  };
  CHECK(carried(slack, {-1, 2, 3}) == Vec3{-1, 2, 3});
  // Not away from what is taut, but across, and back.
  CHECK(carried(taut, {-1, 2, 3}) == Vec3{0, 2, 3});
  CHECK(carried(taut, {1, 2, 3}) == Vec3{1, 2, 3});
  CHECK(Length(carried(tautBoth, {-1, 1, 0})) < 1e-15);
  CHECK(carried(tautBoth, {1, -1, 0}) == Vec3{1, -1, 0});
  // What is taut elsewhere does not matter; and neighbours in the same place tell no direction.
  CHECK(CarriedWay(2, {0, -1, 0}, taut, springs, restLengths) == Vec3{0, -1, 0});
  CHECK(carried({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {1, 2, 3}) == Vec3{1, 2, 3});
}

TEST_CASE("the hand's tools will do for cloths of any size, and for none") {
  for (const double width : {1e-3, 1.0, 1e3}) {
    for (const int points : {2, 50, 1000}) {
      const Scene scene = Square(width, points);
      CAPTURE(width);
      CAPTURE(points);
      const Handle handle = GripOf(scene, 0, 1, {1, 2, 3});
      CHECK_FALSE(Check(handle));
      CHECK(handle.target == Vec3{1, 2, 3});
      CHECK(handle.radius > width / (points - 1));  // More than one point.
      CHECK_FALSE(Check(BallFrom(scene, {0, 0, 0}, {0, 0, -1})));
      CHECK_FALSE(Check(GustTowards(scene, {0, 0, -1})));
    }
  }
  const Scene none;
  CHECK_FALSE(Check(GustTowards(none, {0, 0, 0})));
}

TEST_CASE("the hand grips a disc and a mesh as it does a grid") {
  Scene scene = Square(1, 50);
  ClothSettings& cloth = scene.cloths[0];
  cloth.shape = Shape::Disc;
  cloth.radius = 0.5;
  cloth.rings = 4;
  const Handle handle = GripOf(scene, 0, 7, {1, 2, 3});
  CHECK_FALSE(Check(handle));
  CHECK(handle.radius > cloth.radius / cloth.rings);
  CHECK_FALSE(Check(BallFrom(scene, {0, 0, 0}, {0, 0, -1})));
  RestMesh disc = MakeDisc(0.5, 4);
  cloth.loaded = std::make_shared<const LoadedMesh>(LoadedMesh{"disc.obj", {}, std::move(disc)});
  cloth.shape = Shape::Mesh;
  CHECK(GripOf(scene, 0, 7, {}).radius == doctest::Approx(handle.radius).epsilon(0.05));
  CHECK(BallFrom(scene, {0, 0, 0}, {0, 0, -1}).mass == doctest::Approx(0.1 * cloth.density * 0.75).epsilon(0.1));
}

TEST_CASE("a ball grows with the cloth and weighs with it, and flies where it is thrown") {
  const Ball small = BallFrom(Square(1, 50), {0, 0, 5}, {0, 0, -2}),
             large = BallFrom(Square(3, 50), {0, 0, 5}, {1, 0, 0});
  CHECK(large.radius == doctest::Approx(3 * small.radius));
  CHECK(large.mass == doctest::Approx(9 * small.mass));
  CHECK(small.velocity.z < 0);
  CHECK(small.position.z + small.radius < 5);
  CHECK(large.velocity.x > 0);
  CHECK(large.velocity.z == 0);
}
