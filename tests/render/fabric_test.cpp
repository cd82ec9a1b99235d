// The house look: what its pictures show, against geometry and against bounds that any light keeps.

#include <algorithm>
#include <cmath>

#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;
using percale::test::TestCloth;

namespace {

constexpr int kWidth = 240, kHeight = 188;

Scene OneCloth() {
  Scene scene;
  scene.cloths.resize(1);
  scene.look.shader = "Fabric";
  return scene;
}

Image Paint(const Scene& scene, const std::vector<ClothShape>& cloths, const View& view,
            const std::filesystem::path& root = ".") {
  Painter painter = Must(Painter::Open({.root = root, .width = kWidth, .height = kHeight, .samples = 1}));
  return Must(painter.Paint(scene, cloths, view));
}

/// The pixel where a point of the world is drawn.
const std::uint8_t* At(const Image& image, const View& view, const Vec3& point) {
  const Vec3 clip = TransformPoint(view.camera.ViewProjection(kWidth, kHeight), point);
  const int x = int((clip.x + 1) / 2 * kWidth), y = int((1 - clip.y) / 2 * kHeight);
  REQUIRE(x >= 0);
  REQUIRE(y >= 0);
  REQUIRE(x < kWidth);
  REQUIRE(y < kHeight);
  return image.At(x, y);
}

int Brightness(const std::uint8_t* pixel) {
  return pixel[0] + pixel[1] + pixel[2];
}

/// A copy of the project's shaders, to add to, with surroundings of one shade all over.
struct Studio {
  test::TemporaryFolder root;

  explicit Studio(std::uint8_t shade) {
    std::filesystem::copy("shaders", root / "shaders");
    std::filesystem::create_directories(root / "textures/cube");
    Image face = MakeImage(4, 4);
    std::fill(face.rgba.begin(), face.rgba.end(), shade);
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
      Must(WritePng(root / ("textures/cube/" + std::string(name) + ".png"), face));
  }
};

/// A ball that floats over a level floor.
struct BallOverFloor {
  Scene scene = OneCloth();
  View view;
  Vec3 center{0.5, 0.3, 0.3};
  double radius = 0.2;  // As drawn.

  BallOverFloor() {
    scene.spheres.push_back({.origin = center, .radius = radius / 0.92});
    scene.planes.push_back({.point = {0.5, 0, 0.3}, .normal = {0, 1, 0}});
    scene.camera = {.automatic = false, .target = {0.5, 0.1, 0}, .distance = 2.4, .azimuth = 75, .elevation = 40};
    view = View::ForScene(scene);
  }
};

}  // namespace

TEST_CASE("each side of a cloth has its own colour") {
  const TestCloth cloth(test::Grid(8), test::Upright);
  Scene scene = OneCloth();
  scene.cloths[0].color = {1, 0.1, 0.1};
  scene.cloths[0].backColor = {0.1, 0.1, 1};
  View view = View::ForScene(scene);
  view.uniforms = {{"u_back", {1, 1, 1}}};
  const Vec3 middle{0.5, 0.5, 0};
  const auto isRed = [&] {
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const std::uint8_t* pixel = At(image, view, middle);
    CHECK(std::max(pixel[0], pixel[2]) > 2 * std::min(pixel[0], pixel[2]));
    return pixel[0] > pixel[2];
  };
  CHECK(isRed());
  view.uniforms["u_front"] = {0, 1, 1};
  CHECK_FALSE(isRed());
  view.uniforms["u_front"] = {1, 1, 1};
  view.camera.Orbit(kWidth, 0, kWidth, kHeight);  // To the other side.
  CHECK_FALSE(isRed());
}

TEST_CASE("the floor is darker under a ball than beside it, up to where the light's rays touch the ball") {
  BallOverFloor ball;
  ball.view.uniforms = {{"u_softness", {0}}};
  const Vec3 light{0.5, 2, 2};
  const Image image = Paint(ball.scene, {{}}, ball.view);
  // Along the shadow's axis on the floor, away from the light: the ball's far side, seen from the light.
  const double distance = Length(light - ball.center), angle = std::asin(ball.radius / distance);
  const double fall = std::atan2(light.y - ball.center.y, light.z - ball.center.z);
  const double end = light.z - light.y / std::tan(fall - angle);
  const Vec3 beside{0.5, 0, 0.9}, inside{0.5, 0, end + 0.03}, outside{0.5, 0, end - 0.03};
  const int lit = Brightness(At(image, ball.view, beside));
  CHECK(Brightness(At(image, ball.view, inside)) < 0.8 * lit);
  CHECK(Brightness(At(image, ball.view, outside)) > 0.97 * lit);
}

TEST_CASE("a softer shadow has the same place and wider edges") {
  BallOverFloor ball;
  // How many pixels of a row through the shadow are neither in it nor out of it.
  const auto edgePixels = [&](float softness) {
    ball.view.uniforms = {{"u_softness", {softness}}};
    const Image image = Paint(ball.scene, {{}}, ball.view);
    const Vec3 clip = TransformPoint(ball.view.camera.ViewProjection(kWidth, kHeight), {0.5, 0, 0});
    const int y = int((1 - clip.y) / 2 * kHeight);
    int low = 1000, high = 0, count = 0;
    for (int x = 0; x < kWidth; ++x) {
      low = std::min(low, Brightness(image.At(x, y)));
      high = std::max(high, Brightness(image.At(x, y)));
    }
    for (int x = 0; x < kWidth; ++x) {
      const int b = Brightness(image.At(x, y));
      count += b > low + (high - low) / 6 && b < high - (high - low) / 6;
    }
    return count;
  };
  CHECK(edgePixels(0.05f) > edgePixels(0) + 4);
}

TEST_CASE("a level floor that nothing stands on cannot be told from the background") {
  Scene scene = OneCloth();
  scene.camera = {.automatic = false, .target = {0.5, 0, 0.3}, .distance = 2, .azimuth = 10, .elevation = 20};
  const View view = View::ForScene(scene);
  const Image empty = Paint(scene, {{}}, view);
  scene.planes.push_back({.point = {0.5, 0, 0.3}, .normal = {0, 1, 0}});
  const Image floor = Paint(scene, {{}}, view);
  int greatest = 0;
  for (std::size_t i = 0; i < floor.rgba.size(); ++i)
    greatest = std::max(greatest, std::abs(int(floor.rgba[i]) - int(empty.rgba[i])));
  CHECK(greatest <= 2);
}

TEST_CASE("the background is calm: neighbouring pixels differ by nothing that one sees") {
  Scene scene = OneCloth();
  const View view = View::ForScene(scene);
  const Image image = Paint(scene, {{}}, view);
  for (int y = 1; y < kHeight; ++y) {
    for (int x = 1; x < kWidth; ++x) {
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(std::abs(int(image.At(x, y)[k]) - int(image.At(x - 1, y)[k])) <= 2);
        CHECK(std::abs(int(image.At(x, y)[k]) - int(image.At(x, y - 1)[k])) <= 3);
      }
    }
  }
}

TEST_CASE("in white surroundings and no other light, white cloth gives back no more light than it gets") {
  const Studio studio(255);
  const TestCloth cloth(test::Grid(30), [](Vec2 uv) {
    return Vec3{uv.x, 1 - uv.y, 0.1 * std::sin(12 * uv.x) + 0.1 * std::cos(9 * uv.y)};
  });
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.uniforms = {{"u_key", {0}}, {"u_fill", {1}}, {"u_sheen", {1}}, {"u_threads", {0}}, {"u_back", {1, 1, 1}}};
  // The brightest wall is 1.04 in blue: of that, tone mapping and sRGB make 238.
  const Image image = Paint(scene, {cloth.Shape()}, view, studio.root.path());
  for (double x = 0.05; x < 1; x += 0.05) {
    for (double y = 0.05; y < 1; y += 0.05) {
      const std::uint8_t* pixel = At(image, view, {x, y, 0});
      for (int k = 0; k < 3; ++k) CHECK(int(pixel[k]) <= 239);
    }
  }
}

TEST_CASE("no pixel of any part is negative, infinite or not a number") {
  const Studio studio(180);
  for (const char* part : {"", ".sphere", ".plane", ".background"}) {
    std::filesystem::copy(studio.root / "shaders/Fabric.plane.vert", studio.root / "shaders/Check.plane.vert",
                          std::filesystem::copy_options::overwrite_existing);
    test::WriteText(
        studio.root / ("shaders/Check" + std::string(part) + ".frag"),
        "#version 330\n#define main shade\n#include \"Fabric" + std::string(part) +
            ".frag\"\n#undef main\n"
            "void main() {\n  shade();\n"
            "  bool good = all(greaterThanEqual(out_color, vec4(0))) && all(lessThan(out_color, vec4(1.01)));\n"
            "  out_color = good ? vec4(0, 1, 0, 1) : vec4(1, 0, 0, 1);\n}\n");
  }
  // With folds, creases without area, normals without direction, and cloth on edge to the eye.
  const TestCloth folded(test::Grid(40), [](Vec2 uv) {
    return Vec3{uv.x, std::max(0.2, 1 - uv.y), 0.2 * std::floor(6 * uv.x) * uv.y};
  });
  const TestCloth point(test::Grid(3), [](Vec2) { return Vec3{0.2, 0.5, 0.2}; });
  BallOverFloor ball;
  ball.scene.cloths.resize(2);
  for (const double elevation : {-60.0, 0.0, 5.0, 60.0}) {
    ball.scene.camera.elevation = elevation;
    ball.view = View::ForScene(ball.scene);
    ball.view.look.shader = "Check";
    const Image image = Paint(ball.scene, {folded.Shape(), point.Shape()}, ball.view, studio.root.path());
    int bad = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) bad += image.rgba[i] != 0 || image.rgba[i + 1] != 255;
    CHECK(bad == 0);
  }
}
