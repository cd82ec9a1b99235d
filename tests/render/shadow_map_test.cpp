// Shadow maps as a shader of one's own sees them: by the documented names alone.

#include <cmath>

#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;

namespace {

constexpr int kSize = 200;
const Vec3 kLight{0.5, 2, 2};

const char* kFragment = R"(#version 330
uniform sampler2DShadow u_shadow_map;
uniform mat4 u_light_view_projection;
in vec4 v_position;
out vec4 out_color;
void main() {
  vec4 clip = u_light_view_projection * v_position;
  vec3 map = 0.5 * clip.xyz / clip.w + 0.5;
  out_color = vec4(texture(u_shadow_map, vec3(map.xy, min(map.z, 1.0) - 0.001)), 0.0, 0.0, 1.0);
}
)";

/// A ball over a floor, drawn by a shader that shows what the light reaches as red.
struct ShadowScene {
  test::TemporaryFolder root;
  Scene scene;
  View view;
  Vec3 center{0.45, 0.4, 0.5};
  double radius = 0.2;  // As drawn.

  ShadowScene() {
    std::filesystem::create_directories(root / "shaders");
    std::filesystem::copy("shaders/Default.vert", root / "shaders/Default.vert");
    test::WriteText(root / "shaders/Lit.frag", kFragment);
    scene.cloths.resize(1);
    scene.spheres.push_back({.origin = center, .radius = radius / 0.92});
    scene.planes.push_back({.point = {0.5, 0, 0}, .normal = {0, 1, 0}});
    scene.camera = {.automatic = false, .target = {0.5, 0.1, 0}, .distance = 2.5, .azimuth = 30, .elevation = 50};
    view = View::ForScene(scene);
    view.look.shader = "Lit";
    view.sphereLatitudes = view.sphereLongitudes = 200;
  }
  Painter Open() const {
    return Must(Painter::Open({.root = root.path(), .width = kSize, .height = kSize, .samples = 1}));
  }
};

/// How near the line between two points comes to a third.
double Clearance(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 along = UnitOr(to - from, {});
  const double at = std::clamp(Dot(point - from, along), 0.0, Length(to - from));
  return Length(from + at * along - point);
}

}  // namespace

TEST_CASE("a shadow's boundary lies where the light's rays touch the ball") {
  ShadowScene shadow;
  Painter painter = shadow.Open();
  const std::vector<ClothShape> none(1);
  const Image image = Must(painter.Paint(shadow.scene, none, shadow.view));
  const Vec3 eye = shadow.view.camera.position();
  int lit = 0, dark = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Vec3 ray = shadow.view.camera.Ray(x, y, kSize, kSize);
      if (ray.y > -0.05) continue;
      const Vec3 floor = eye - eye.y / ray.y * ray;
      if (std::abs(floor.x - 0.5) > 1.95 || std::abs(floor.z) > 1.95) continue;
      if (Clearance(eye, floor, shadow.center) < shadow.radius + 0.02) continue;  // The ball itself is seen.
      const double clearance = Clearance(floor, kLight, shadow.center);
      if (std::abs(clearance - shadow.radius) < 0.006) continue;  // Some texels of the map, and the pixel's own size.
      CAPTURE(x);
      CAPTURE(y);
      CHECK(int(image.At(x, y)[0]) == (clearance < shadow.radius ? 0 : 255));
      ++(clearance < shadow.radius ? dark : lit);
    }
  }
  CHECK(dark > 500);
  CHECK(lit > 10000);
}

TEST_CASE("cloth casts its shadow, and lies in the light itself") {
  ShadowScene shadow;
  shadow.scene.spheres.clear();
  const test::TestCloth sheet(test::Grid(20), [](Vec2 uv) { return Vec3{uv.x, 0.5, uv.y}; });
  const std::vector<ClothShape> cloths = {sheet.Shape()};
  Painter painter = shadow.Open();
  const Image image = Must(painter.Paint(shadow.scene, cloths, shadow.view));
  const auto red = [&](const Vec3& point) {
    const Vec3 clip = TransformPoint(shadow.view.camera.ViewProjection(kSize, kSize), point);
    return int(image.At(int((clip.x + 1) / 2 * kSize), int((1 - clip.y) / 2 * kSize))[0]);
  };
  for (double x = 0.05; x < 1; x += 0.1) {
    for (double z = 0.05; z < 1; z += 0.1) CHECK(red({x, 0.5, z}) == 255);
  }
  // The sheet's far edge, z = 0, throws its shadow on the floor at z = -2/3.
  CHECK(red({0.5, 0, -0.6}) == 0);
  CHECK(red({0.5, 0, -0.74}) == 255);
}

TEST_CASE("where there can be no shadow map everything is lit, and one warning says so") {
  ShadowScene shadow;
  Painter painter = shadow.Open();
  const std::vector<ClothShape> none(1);
  const auto hasShadow = [](const Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      if (image.rgba[i] == 0) return true;
    }
    return false;
  };
  CHECK(hasShadow(Must(painter.Paint(shadow.scene, none, shadow.view))));
  shadow.view.shadowMapSize = 1 << 24;  // No card has that.
  const Result<Image> lit = painter.Paint(shadow.scene, none, shadow.view);
  REQUIRE(lit.ok());
  CHECK_FALSE(hasShadow(*lit));
  REQUIRE(lit.diagnostics().size() == 1);
  CHECK(lit.diagnostics()[0].severity == Severity::Warning);
  CHECK(test::Contains(lit.diagnostics(), "shadows are not drawn"));
  CHECK(painter.Paint(shadow.scene, none, shadow.view).diagnostics().empty());

  shadow.view.shadowMapSize = 0;  // Switched off: nothing to warn of.
  const Result<Image> off = painter.Paint(shadow.scene, none, shadow.view);
  REQUIRE(off.ok());
  CHECK_FALSE(hasShadow(*off));
  CHECK(off.diagnostics().empty());
  shadow.view.shadowMapSize = 512;
  CHECK(hasShadow(Must(painter.Paint(shadow.scene, none, shadow.view))));
}

TEST_CASE("the light's view is finite, whatever is drawn and wherever the light is") {
  Scene scene;
  scene.cloths.resize(1);
  View view = View::ForScene(scene);
  view.look.shader = "Lit";
  SceneView sceneView;
  for (const double size : {0.0, 1e-3, 1.0, 100.0}) {
    const test::TestCloth cloth(test::Grid(3), [&](Vec2 uv) {
      return kLight + Vec3{size * (uv.x - 0.5), 0, size * (uv.y - 0.5)};
    });
    const ClothShape shapes[] = {cloth.Shape()};
    for (const double element : sceneView.Update(scene, shapes, view, 64, 64).lightViewProjection.m)
      CHECK(std::isfinite(element));
  }
  for (const double element : sceneView.Update(scene, {}, view, 64, 64).lightViewProjection.m)
    CHECK(std::isfinite(element));
}
