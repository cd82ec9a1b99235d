#include <cmath>
#include <numbers>

#include "render/camera.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using doctest::Approx;

namespace {

void CheckNear(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  INFO(a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z);
  CHECK(Length(a - b) <= tolerance);
}

Scene OneCloth() {
  Scene scene;
  scene.cloths.resize(1);
  return scene;
}

}  // namespace

TEST_CASE("the course's camera: target, distance and direction follow from the cloth") {
  const OrbitCamera camera = OrbitCamera::ForScene(OneCloth());
  CheckNear(camera.target(), {0.5, 0.5, 0.5});
  CHECK(camera.distance() == Approx(1.8));
  CheckNear(camera.position(), {0.5, 0.5, 2.3});

  Scene wide = OneCloth();
  wide.cloths[0].width = 3;
  wide.cloths[0].origin = {1, 2, -1};
  const OrbitCamera other = OrbitCamera::ForScene(wide);
  CheckNear(other.target(), {2.5, 1.5, -0.5}, 1e-9);
  CHECK(other.distance() == Approx(5.4));
}

TEST_CASE("several cloths are seen together") {
  Scene scene = OneCloth();
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].origin = {3, 0, 0};
  const OrbitCamera camera = OrbitCamera::ForScene(scene);
  CheckNear(camera.target(), {2, 0.5, 0.5}, 1e-9);
  CHECK(camera.distance() == Approx(1.8 * 4));
}

TEST_CASE("the field of view is 35 degrees high and 50 wide, or more") {
  const double degree = std::numbers::pi / 180;
  CHECK(OrbitCamera::VerticalAngle(2000, 1000) == Approx(35 * degree));
  // 1024 x 800 is narrower than 50 : 35, so the width decides.
  CHECK(std::tan(OrbitCamera::VerticalAngle(1024, 800) / 2) * 1024 / 800 == Approx(std::tan(25 * degree)));
}

TEST_CASE("the projection puts the target in the middle and near points nearer") {
  const OrbitCamera camera = OrbitCamera::ForScene(OneCloth());
  const Mat4 clip = camera.ViewProjection(1024, 800);
  const Vec3 middle = TransformPoint(clip, camera.target());
  CHECK(middle.x == Approx(0));
  CHECK(middle.y == Approx(0));
  CHECK(TransformPoint(clip, camera.target() + Vec3{0, 0, 0.5}).z < middle.z);
  // Top of the picture: half the vertical angle above the target.
  const double half = camera.distance() * std::tan(OrbitCamera::VerticalAngle(1024, 800) / 2);
  CHECK(TransformPoint(clip, camera.target() + Vec3{0, half, 0}).y == Approx(1));
  CHECK(TransformPoint(clip, camera.position() - Vec3{0, 0, 0.01}).z == Approx(-1));
}

TEST_CASE("a ray through a pixel meets the points that are drawn there") {
  Scene scene = OneCloth();
  scene.camera = {.automatic = false, .target = {0.2, 0.3, -0.4}, .distance = 2.5, .azimuth = 35, .elevation = 20};
  const OrbitCamera camera = OrbitCamera::ForScene(scene);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, std::pair{317.0, 40.0}, std::pair{500.0, 399.0}}) {
    const Vec3 drawn =
        TransformPoint(camera.ViewProjection(640, 400), camera.position() + 3.0 * camera.Ray(x, y, 640, 400));
    CHECK((drawn.x + 1) / 2 * 640 == Approx(x + 0.5));
    CHECK((1 - drawn.y) / 2 * 400 == Approx(y + 0.5));
  }
}

TEST_CASE("mouse steps are the course's") {
  OrbitCamera camera = OrbitCamera::ForScene(OneCloth());
  camera.Orbit(-256, 200, 1024, 800);
  CHECK(camera.azimuth() == Approx(45));
  CHECK(camera.elevation() == Approx(45));
  camera.Orbit(0, 1e6, 1024, 800);
  CHECK(camera.elevation() == Approx(89));

  camera = OrbitCamera::ForScene(OneCloth());
  camera.Dolly(1);
  CHECK(camera.distance() == Approx(1.71));
  camera.Dolly(1000);
  CHECK(camera.distance() == Approx(0.09));
  camera.Dolly(-1e6);
  CHECK(camera.distance() == Approx(18));

  camera = OrbitCamera::ForScene(OneCloth());
  const Vec3 before = camera.target();
  camera.Pan(100, 0, 1024, 800);
  // The picture follows the mouse: the camera goes left.
  const double metresPerPixel = 0.9 * 2 * std::tan(OrbitCamera::VerticalAngle(1024, 800) / 2) / 800;
  CheckNear(camera.target() - before, {-100 * metresPerPixel, 0, 0});
  camera.Pan(-100, 50, 1024, 800);
  CheckNear(camera.target() - before, {0, 50 * metresPerPixel, 0});
}

TEST_CASE("a view survives the way through a scene's settings") {
  Scene scene = OneCloth();
  OrbitCamera camera = OrbitCamera::ForScene(scene);
  camera.Orbit(123, -45, 1024, 800);
  camera.Pan(10, 20, 1024, 800);
  camera.Dolly(2.5);
  scene.camera = camera.Settings();
  const OrbitCamera back = OrbitCamera::ForScene(scene);
  CheckNear(back.position(), camera.position());
  CheckNear(back.target(), camera.target());
}
