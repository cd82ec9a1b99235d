// What the shaders draw, against references and against values worked out by hand.

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::CheckReference;
using percale::test::Must;
using percale::test::TemporaryFolder;
using percale::test::TestCloth;

namespace {

constexpr int kWidth = 240, kHeight = 188;

Scene OneCloth() {
  Scene scene;
  scene.cloths.resize(1);
  return scene;
}

Image Paint(const Scene& scene, const std::vector<ClothShape>& cloths, const View& view, int samples = 1,
            const std::filesystem::path& root = ".") {
  Painter painter = Must(Painter::Open({.root = root, .width = kWidth, .height = kHeight, .samples = samples}));
  return Must(painter.Paint(scene, cloths, view));
}

struct Pixel {
  double x, y;
};

/// Where a point of the world is drawn, in pixels from the top left corner.
Pixel PixelOf(const View& view, const Vec3& point) {
  const Vec3 clip = TransformPoint(view.camera.ViewProjection(kWidth, kHeight), point);
  return {(clip.x + 1) / 2 * kWidth, (1 - clip.y) / 2 * kHeight};
}

void CheckColor(const Image& image, const Pixel& pixel, const std::array<int, 3>& expected, int tolerance = 1) {
  REQUIRE(pixel.x >= 0);
  REQUIRE(pixel.y >= 0);
  REQUIRE(pixel.x < image.width);
  REQUIRE(pixel.y < image.height);
  const std::uint8_t* found = image.At(int(pixel.x), int(pixel.y));
  INFO("pixel " << int(pixel.x) << ", " << int(pixel.y) << ": " << int(found[0]) << " " << int(found[1]) << " "
                << int(found[2]));
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(int(found[k]) - expected[k]) <= tolerance);
}

/// The scene of the references: a rippled sheet above a sphere and a plane, seen from the side.
struct ReferenceScene {
  Scene scene = OneCloth();
  TestCloth cloth{test::Grid(30), [](Vec2 uv) {
                    return Vec3{uv.x, 1.05 - 0.75 * uv.y + 0.05 * std::sin(7 * uv.x),
                                0.35 * uv.y + 0.06 * std::sin(9 * uv.x + 2 * uv.y)};
                  }};
  View view;

  ReferenceScene() {
    scene.spheres.push_back({.origin = {0.55, 0.2, 0.95}, .radius = 0.25});
    scene.planes.push_back({.point = {0, -0.1, 0}, .normal = {0, 1, 0}});
    scene.camera = {.automatic = false, .target = {0.5, 0.45, 0.5}, .distance = 2.2, .azimuth = 18, .elevation = 12};
    view = View::ForScene(scene);
  }
};

/// A lone sphere in front of the course's camera, and what a ray through a pixel hits of it.
struct LitSphere {
  Scene scene = OneCloth();
  View view;
  Vec3 center{0.5, 0.5, 0.5};
  double radius = 0.4;  // As drawn.

  LitSphere() {
    scene.spheres.push_back({.origin = center, .radius = radius / 0.92});
    view = View::ForScene(scene);
    view.cloths = false;
    view.sphereLatitudes = view.sphereLongitudes = 200;
  }
  std::optional<Vec3> Hit(int x, int y) const {
    const Vec3 eye = view.camera.position(), ray = view.camera.Ray(x, y, kWidth, kHeight);
    const double along = Dot(center - eye, ray);
    const double inside = radius * radius - Dot(center - eye, center - eye) + along * along;
    // The very edge is left out: there a pixel's hit is badly determined.
    if (inside < 0.05 * radius * radius) return std::nullopt;
    return eye + (along - std::sqrt(inside)) * ray;
  }
};

}  // namespace

TEST_CASE("every shader draws its reference picture") {
  ReferenceScene reference;
  const std::filesystem::path folder = "tests/render/reference";
  Painter painter = Must(Painter::Open({.root = ".", .width = kWidth, .height = kHeight, .samples = 4}));
  for (const std::string& name : painter.shaders().names()) {
    CAPTURE(name);
    reference.view.look.shader = name;
    const std::vector<ClothShape> cloths = {reference.cloth.Shape()};
    const Image image = Must(painter.Paint(reference.scene, cloths, reference.view));
    CheckReference(image, folder / (name + ".png"));
  }
}

TEST_CASE("pictures do not depend on what was drawn before") {
  ReferenceScene reference;
  Painter painter = Must(Painter::Open({.root = ".", .width = kWidth, .height = kHeight, .samples = 4}));
  const std::vector<ClothShape> cloths = {reference.cloth.Shape()};
  std::vector<Image> first;
  for (int round = 0; round < 2; ++round) {
    for (const std::string& name : painter.shaders().names()) {
      reference.view.look.shader = name;
      Image image = Must(painter.Paint(reference.scene, cloths, reference.view));
      if (round == 0) {
        first.push_back(std::move(image));
      } else {
        CHECK(image.rgba == first[std::size_t(&name - painter.shaders().names().data())].rgba);
      }
    }
  }
}

TEST_CASE("the background is 0.25 grey, the ambient part alone is one colour") {
  const TestCloth cloth(test::Grid(12), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Phong";
  view.look.color = {1, 0.5, 0};
  view.uniforms = {{"u_diffuse_on", {0}}, {"u_specular_on", {0}}, {"u_ambient", {0.8f}}};
  const Image image = Paint(scene, {cloth.Shape()}, view);
  CheckColor(image, {2, 2}, {64, 64, 64}, 0);
  int inside = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t* p = image.At(x, y);
      if (p[0] == 64 && p[1] == 64 && p[2] == 64) continue;
      ++inside;
      CHECK(int(p[0]) == 204);
      CHECK(int(p[1]) == 102);
      CHECK(int(p[2]) == 0);
    }
  }
  const Pixel low = PixelOf(view, {0, 0, 0}), high = PixelOf(view, {1, 1, 0});
  CHECK(inside == doctest::Approx((high.x - low.x) * (low.y - high.y)).epsilon(0.03));
}

TEST_CASE("a lit sphere is as bright everywhere as the formulas say, and brightest where they say") {
  LitSphere sphere;
  const Vec3 light{0.5, 2, 2}, eye = sphere.view.camera.position();
  for (const std::string shader : {"Diffuse", "Phong"}) {
    CAPTURE(shader);
    sphere.view.look.shader = shader;
    if (shader == "Phong")
      sphere.view.uniforms = {
          {"u_ambient_on", {0}}, {"u_diffuse_on", {0}}, {"u_specular", {0.5f}}, {"u_shininess", {16}}};
    const Image image = Paint(sphere.scene, {{}}, sphere.view);
    int checked = 0, brightest = -1, expectedX = 0, expectedY = 0;
    double expectedBrightest = -1;
    Pixel brightestSum{0, 0};
    int brightestCount = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::optional<Vec3> hit = sphere.Hit(x, y);
        if (!hit) continue;
        const Vec3 n = UnitOr(*hit - sphere.center, {}), toLight = light - *hit;
        const Vec3 l = UnitOr(toLight, {}), h = UnitOr(l + UnitOr(eye - *hit, {}), {});
        const double falloff = 3 / Dot(toLight, toLight);
        const double value = shader == "Diffuse" ? falloff * std::max(0.0, Dot(n, l))
                                                 : 0.5 * falloff * std::pow(std::max(0.0, Dot(n, h)), 16);
        const int found = image.At(x, y)[1];
        CHECK(std::abs(found - 255 * std::min(1.0, value)) <= 3);
        ++checked;
        if (value > expectedBrightest) expectedBrightest = value, expectedX = x, expectedY = y;
        if (found > brightest) brightest = found, brightestSum = {0, 0}, brightestCount = 0;
        if (found == brightest) brightestSum.x += x, brightestSum.y += y, ++brightestCount;
      }
    }
    CHECK(checked > 3000);
    CHECK(std::abs(brightestSum.x / brightestCount - expectedX) <= 2);
    CHECK(std::abs(brightestSum.y / brightestCount - expectedY) <= 2);
  }
}

TEST_CASE("complete Phong is the sum of its parts") {
  LitSphere sphere;
  sphere.view.look.shader = "Phong";
  sphere.view.look.color = {0.6, 0.6, 0.6};  // So that nothing saturates.
  const Image complete = Paint(sphere.scene, {{}}, sphere.view);
  std::vector<Image> parts;
  for (int part = 0; part < 3; ++part) {
    sphere.view.uniforms = {{"u_ambient_on", {float(part == 0)}},
                            {"u_diffuse_on", {float(part == 1)}},
                            {"u_specular_on", {float(part == 2)}}};
    parts.push_back(Paint(sphere.scene, {{}}, sphere.view));
  }
  for (int y = 0; y < kHeight; y += 3) {
    for (int x = 0; x < kWidth; x += 3) {
      if (!sphere.Hit(x, y)) continue;
      const int sum = parts[0].At(x, y)[0] + parts[1].At(x, y)[0] + parts[2].At(x, y)[0];
      CHECK(std::abs(complete.At(x, y)[0] - std::min(255, sum)) <= 2);
    }
  }
}

TEST_CASE("normals as colours: plane, sphere and both sides of a sheet") {
  ReferenceScene reference;
  reference.view.look.shader = "Normal";
  reference.view.cloths = false;
  const Image image = Paint(reference.scene, {reference.cloth.Shape()}, reference.view);
  CheckColor(image, PixelOf(reference.view, {-0.2, -0.1, 0.2}), {128, 255, 128});

  LitSphere sphere;
  sphere.view.look.shader = "Normal";
  const Image ball = Paint(sphere.scene, {{}}, sphere.view);
  for (int y = 0; y < kHeight; y += 5) {
    for (int x = 0; x < kWidth; x += 5) {
      const std::optional<Vec3> hit = sphere.Hit(x, y);
      if (!hit) continue;
      const Vec3 n = UnitOr(*hit - sphere.center, {});
      CheckColor(ball, {double(x), double(y)}, {int(127.5 * (n.x + 1)), int(127.5 * (n.y + 1)), int(127.5 * (n.z + 1))},
                 2);
    }
  }

  // From behind the front's normals still count: they point away, as in the course.
  Scene scene = OneCloth();
  const TestCloth cloth(test::Grid(4), test::Upright);
  View view = View::ForScene(scene);
  view.look.shader = "Normal";
  CheckColor(Paint(scene, {cloth.Shape()}, view), PixelOf(view, {0.5, 0.5, 0}), {128, 128, 255});
  view.camera.Orbit(kWidth, 0, kWidth, kHeight);
  CheckColor(Paint(scene, {cloth.Shape()}, view), PixelOf(view, {0.5, 0.5, 0}), {128, 128, 255});
}

TEST_CASE("a mirror shows the face of the cube map that the reflected ray meets") {
  const TemporaryFolder root;
  std::filesystem::copy("shaders", root / "shaders");
  std::filesystem::create_directories(root / "textures/cube");
  const char* names[] = {"posx", "negx", "posy", "negy", "posz", "negz"};
  const std::array<int, 3> colors[] = {{255, 0, 0},   {0, 255, 0},   {0, 0, 255},
                                       {255, 255, 0}, {255, 0, 255}, {0, 255, 255}};
  for (std::size_t i = 0; i < 6; ++i) {
    Image face = MakeImage(8, 8);
    for (std::size_t p = 0; p < face.rgba.size(); p += 4) {
      for (std::size_t k = 0; k < 3; ++k) face.rgba[p + k] = std::uint8_t(colors[i][k]);
    }
    Must(WritePng(root / ("textures/cube/" + std::string(names[i]) + ".png"), face));
  }
  LitSphere sphere;
  sphere.view.look.shader = "Mirror";
  const Image image = Paint(sphere.scene, {{}}, sphere.view, 1, root.path());
  int seen[6] = {};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::optional<Vec3> hit = sphere.Hit(x, y);
      if (!hit) continue;
      const Vec3 n = UnitOr(*hit - sphere.center, {}), ray = sphere.view.camera.Ray(x, y, kWidth, kHeight);
      const Vec3 r = ray - 2 * Dot(ray, n) * n;
      const double c[3] = {std::abs(r.x), std::abs(r.y), std::abs(r.z)};
      const int axis = int(std::max_element(c, c + 3) - c);
      // Near the edges of the cube two faces mix.
      if (c[(axis + 1) % 3] > 0.6 * c[axis] || c[(axis + 2) % 3] > 0.6 * c[axis]) continue;
      const int face = 2 * axis + ((axis == 0 ? r.x : axis == 1 ? r.y : r.z) < 0);
      CheckColor(image, {double(x), double(y)}, colors[face], 2);
      ++seen[face];
    }
  }
  for (const int face : {0, 1, 2, 3, 4}) CHECK(seen[face] > 20);
}

TEST_CASE("the flag's bands change where the world says") {
  const TestCloth cloth(test::Grid(12), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Flag";
  view.uniforms = {{"u_lit", {0}}, {"u_band_1", {1, 0, 0}}, {"u_band_2", {0, 1, 0}}, {"u_band_3", {0, 0, 1}}};
  const std::array<int, 3> red{255, 0, 0}, green{0, 255, 0}, blue{0, 0, 255};

  SUBCASE("two, horizontal") {
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const Pixel middle = PixelOf(view, {0.3, 0.5, 0});
    CheckColor(image, {middle.x, middle.y - 1}, red, 2);
    CheckColor(image, {middle.x, middle.y + 1}, green, 2);
  }
  SUBCASE("three, horizontal") {
    view.uniforms["u_bands"] = {3};
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const Pixel upper = PixelOf(view, {0.7, 2.0 / 3, 0}), lower = PixelOf(view, {0.7, 1.0 / 3, 0});
    CheckColor(image, {upper.x, upper.y - 1}, red, 2);
    CheckColor(image, {upper.x, upper.y + 1}, green, 2);
    CheckColor(image, {lower.x, lower.y - 1}, green, 2);
    CheckColor(image, {lower.x, lower.y + 1}, blue, 2);
  }
  SUBCASE("three, vertical") {
    view.uniforms["u_bands"] = {3};
    view.uniforms["u_axis"] = {1};
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const Pixel left = PixelOf(view, {1.0 / 3, 0.4, 0}), right = PixelOf(view, {2.0 / 3, 0.4, 0});
    CheckColor(image, {left.x - 1, left.y}, red, 2);
    CheckColor(image, {left.x + 1, left.y}, green, 2);
    CheckColor(image, {right.x - 1, right.y}, green, 2);
    CheckColor(image, {right.x + 1, right.y}, blue, 2);
  }
  SUBCASE("the bands stay while the cloth moves") {
    const TestCloth lower(test::Grid(12), [](Vec2 uv) { return test::Upright(uv) - Vec3{0, 0.3, 0}; });
    const Image image = Paint(scene, {lower.Shape()}, view);
    const Pixel middle = PixelOf(view, {0.3, 0.5, 0});
    CheckColor(image, {middle.x, middle.y - 1}, red, 2);
    CheckColor(image, {middle.x, middle.y + 1}, green, 2);
  }
  SUBCASE("by default those of Ukraine, and light makes the tones uneven") {
    view.uniforms = {{"u_lit", {0}}};
    const Image plain = Paint(scene, {cloth.Shape()}, view);
    CheckColor(plain, PixelOf(view, {0.5, 0.9, 0}), {0, 87, 183});
    CheckColor(plain, PixelOf(view, {0.5, 0.1, 0}), {255, 215, 0});
    view.uniforms = {};
    const Image lit = Paint(scene, {cloth.Shape()}, view);
    const Pixel a = PixelOf(view, {0.5, 0.45, 0}), b = PixelOf(view, {0.05, 0.05, 0});
    CHECK(lit.At(int(a.x), int(a.y))[0] > lit.At(int(b.x), int(b.y))[0] + 5);
  }
}

TEST_CASE("a texture lies upright on the hanging cloth, and repeats") {
  const TemporaryFolder folder;
  Image picture = MakeImage(2, 2);
  const std::array<int, 3> colors[4] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 0}};
  for (int i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) picture.At(i % 2, i / 2)[k] = std::uint8_t(colors[i][k]);
  }
  // Enlarged, so that no mixing reaches the points that are looked at.
  Image large = MakeImage(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) std::copy(picture.At(x / 32, y / 32), picture.At(x / 32, y / 32) + 4, large.At(x, y));
  }
  Must(WritePng(folder / "mine.png", large));
  const TestCloth cloth(test::Grid(12), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Texture";
  view.textures[1] = folder / "mine.png";
  view.uniforms = {{"u_texture_number", {1}}};
  const Image once = Paint(scene, {cloth.Shape()}, view);
  for (int i = 0; i < 4; ++i)
    CheckColor(once, PixelOf(view, {0.25 + 0.5 * (i % 2), 0.75 - 0.5 * (i / 2), 0}), colors[i], 2);
  view.uniforms["u_repeat"] = {2};
  const Image twice = Paint(scene, {cloth.Shape()}, view);
  for (int i = 0; i < 4; ++i)
    CheckColor(twice, PixelOf(view, {0.625 + 0.25 * (i % 2), 0.375 - 0.25 * (i / 2), 0}), colors[i], 2);
}

TEST_CASE("a height map tilts normals in Bump, and moves the surface in Displacement") {
  // A ramp along u that rises by 4/255 from texel to texel.
  const TemporaryFolder folder;
  Image ramp = MakeImage(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) ramp.At(x, y)[0] = std::uint8_t(4 * x);
  }
  Must(WritePng(folder / "ramp.png", ramp));
  LitSphere sphere;  // For its outline.
  sphere.view.textures[2] = folder / "ramp.png";
  sphere.view.look.heightScaling = 0.1;
  const auto isBackground = [](const std::uint8_t* p) { return p[0] == 64 && p[1] == 64 && p[2] == 64; };
  const auto outline = [&](const std::string& shader) {
    sphere.view.look.shader = shader;
    const Image image = Paint(sphere.scene, {{}}, sphere.view);
    const int y = int(PixelOf(sphere.view, sphere.center).y);
    int left = 0, right = kWidth - 1;
    while (left < kWidth && isBackground(image.At(left, y))) ++left;
    while (right > 0 && isBackground(image.At(right, y))) --right;
    return std::pair{left, right};
  };
  const auto smooth = outline("Diffuse"), bump = outline("Bump"), moved = outline("Displacement");
  CHECK(bump == smooth);
  // u grows from 0 behind over the left (1/4) and the front to the right (3/4).
  const double metre = PixelOf(sphere.view, {1.5, 0.5, 0.5}).x - PixelOf(sphere.view, {0.5, 0.5, 0.5}).x;
  CHECK(std::abs(smooth.first - moved.first - 0.025 * metre) <= 2);
  CHECK(std::abs(moved.second - smooth.second - 0.075 * metre) <= 2);

  // On a flat sheet, left of the light, brightness follows from the tilt by the formulas.
  const TestCloth cloth(test::Grid(4), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.textures = sphere.view.textures;
  view.look.shader = "Bump";
  view.look.heightScaling = 1;
  const Vec3 point{0.2, 0.5, 0};
  const auto brightness = [&](double normalScaling) {
    view.look.normalScaling = normalScaling;
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const Pixel at = PixelOf(view, point);
    return int(image.At(int(at.x), int(at.y))[0]);
  };
  const Vec3 toLight = Vec3{0.5, 2, 2} - point, l = UnitOr(toLight, {});
  const Vec3 h = UnitOr(l + UnitOr(view.camera.position() - point, {}), {});
  for (const double scaling : {0.0, 20.0, 60.0}) {
    const double slope = 4.0 / 255 * scaling;  // One texel's step, which is what the course's shader takes.
    const Vec3 n = UnitOr(Vec3{-slope, 0, 1}, {});
    const double falloff = 3 / Dot(toLight, toLight);
    const double expected =
        0.1 + falloff * std::max(0.0, Dot(n, l)) + 0.5 * falloff * std::pow(std::max(0.0, Dot(n, h)), 64);
    CAPTURE(scaling);
    CHECK(std::abs(brightness(scaling) - 255 * expected) <= 3);
  }
}

TEST_CASE("displacement gains from the sphere's resolution, bumps do not") {
  // Against a picture that is as fine as can be seen, at -a 16 -o 16 and -a 128 -o 128 as in the write-up.
  LitSphere sphere;
  const auto paint = [&](const char* shader, int resolution) {
    sphere.view.look.shader = shader;
    sphere.view.sphereLatitudes = sphere.view.sphereLongitudes = resolution;
    return Paint(sphere.scene, {{}}, sphere.view);
  };
  // Mean difference per pixel of the sphere, away from its outline, which has corners where it is coarse.
  const auto error = [&](const char* shader, int resolution) {
    const Image coarse = paint(shader, resolution), fine = paint(shader, 512);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::optional<Vec3> hit = sphere.Hit(x, y);
        if (!hit || Dot(UnitOr(*hit - sphere.center, {}), {0, 0, 1}) < 0.5) continue;
        sum += std::abs(int(coarse.At(x, y)[0]) - int(fine.At(x, y)[0]));
        ++count;
      }
    }
    REQUIRE(count > 1000);
    return sum / count;
  };
  const double bump16 = error("Bump", 16), bump128 = error("Bump", 128);
  const double moved16 = error("Displacement", 16), moved128 = error("Displacement", 128);
  INFO("Bump " << bump16 << ", " << bump128 << "; Displacement " << moved16 << ", " << moved128);
  CHECK(bump16 < 2);  // Of 255: no one sees it.
  CHECK(moved16 - moved128 > 2 * (bump16 - bump128));
  CHECK(moved128 < moved16 / 3);
}

TEST_CASE("bumps rise towards the same side in both directions of the texture") {
  // A slope along v alone must tilt the normal against growing v: down the hanging sheet, so that a
  // surface rising downwards faces up, to the light, and gets brighter.
  const TemporaryFolder folder;
  Image ramp = MakeImage(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) ramp.At(x, y)[0] = std::uint8_t(4 * y);
  }
  Must(WritePng(folder / "ramp.png", ramp));
  const TestCloth cloth(test::Grid(4), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Bump";
  view.textures[2] = folder / "ramp.png";
  const auto brightness = [&](double normalScaling) {
    view.look.normalScaling = normalScaling;
    const Image image = Paint(scene, {cloth.Shape()}, view);
    const Pixel at = PixelOf(view, {0.2, 0.5, 0});
    return int(image.At(int(at.x), int(at.y))[0]);
  };
  CHECK(brightness(200) > brightness(0) + 10);
}

TEST_CASE("Wireframe draws the springs of the enabled kinds and no others") {
  ClothSettings settings = test::Grid(5);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Wireframe";
  const Vec3 horizontal{0.375, 0.5, 0}, vertical{0.5, 0.375, 0}, diagonal{0.40, 0.60, 0};
  const auto isDrawn = [&](const Image& image, const Vec3& point) {
    const Pixel at = PixelOf(view, point);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (image.At(int(at.x) + dx, int(at.y) + dy)[0] > 200) return true;
      }
    }
    return false;
  };
  const auto paint = [&](bool structural, bool shearing, bool bending) {
    settings.enableStructural = structural;
    settings.enableShearing = shearing;
    settings.enableBending = bending;
    const TestCloth cloth(settings, test::Upright);
    return Paint(scene, {cloth.Shape()}, view);
  };
  const Image shearing = paint(false, true, false);
  CHECK_FALSE(isDrawn(shearing, horizontal));
  CHECK_FALSE(isDrawn(shearing, vertical));
  CHECK(isDrawn(shearing, diagonal));
  const Image structural = paint(true, false, false);
  CHECK(isDrawn(structural, horizontal));
  CHECK(isDrawn(structural, vertical));
  CHECK_FALSE(isDrawn(structural, diagonal));
  const Image none = paint(false, false, false);
  for (const Vec3& point : {horizontal, vertical, diagonal}) CHECK_FALSE(isDrawn(none, point));
  const Image all = paint(true, true, true);
  for (const Vec3& point : {horizontal, vertical, diagonal}) CHECK(isDrawn(all, point));
}

TEST_CASE("multisampling smooths edges, and only those") {
  const TestCloth cloth(test::Grid(4), [](Vec2 uv) { return test::Upright(uv) + Vec3{0.2 * uv.y, 0.1 * uv.x, 0}; });
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "Phong";
  view.uniforms = {{"u_diffuse_on", {0}}, {"u_specular_on", {0}}, {"u_ambient", {1}}};
  const auto mixedPixels = [&](int samples) {
    const Image image = Paint(scene, {cloth.Shape()}, view, samples);
    int mixed = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) mixed += image.rgba[i] != 64 && image.rgba[i] != 255;
    return mixed;
  };
  CHECK(mixedPixels(1) == 0);
  const int mixed = mixedPixels(4);
  CHECK(mixed > 100);
  CHECK(mixed < 2000);
}

TEST_CASE("missing textures show as a checker, with one warning each") {
  const TemporaryFolder root;
  std::filesystem::copy("shaders", root / "shaders");
  const TestCloth cloth(test::Grid(4), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  Painter painter = Must(Painter::Open({.root = root.path(), .width = kWidth, .height = kHeight, .samples = 1}));
  for (const char* shader : {"Texture", "Mirror"}) {
    view.look.shader = shader;
    const std::vector<ClothShape> cloths = {cloth.Shape()};
    const Result<Image> first = painter.Paint(scene, cloths, view);
    REQUIRE(first.ok());
    CHECK(test::Contains(first.diagnostics(), "checker"));
    CHECK_FALSE(HasErrors(first.diagnostics()));
    const Result<Image> second = painter.Paint(scene, cloths, view);
    REQUIRE(second.ok());
    CHECK(second.diagnostics().empty());
  }
}

TEST_CASE("a texture that is read again shows, and one that cannot be read leaves the old one") {
  const TemporaryFolder root;
  std::filesystem::copy("shaders", root / "shaders");
  std::filesystem::create_directories(root / "textures/cube");
  const auto write = [&](const std::string& name, int size, int red) {
    Image image = MakeImage(size, size);
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) image.rgba[p] = std::uint8_t(red);
    Must(WritePng(root / ("textures/" + name + ".png"), image));
  };
  const TestCloth cloth(test::Grid(4), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  Painter painter = Must(Painter::Open({.root = root.path(), .width = kWidth, .height = kHeight, .samples = 1}));
  const auto red = [&] {
    const std::vector<ClothShape> cloths = {cloth.Shape()};
    const Image image = Must(painter.Paint(scene, cloths, view));
    return int(image.At(kWidth / 2, kHeight / 2)[0]);
  };

  view.look.shader = "Texture";
  write("texture_1", 4, 50);
  CHECK(red() == 50);
  const std::filesystem::path file = root / "textures/texture_1.png";
  write("texture_1", 16, 200);
  CHECK(red() == 50);
  const std::vector<std::filesystem::path> files = painter.device().TextureFiles();
  CHECK(std::count(files.begin(), files.end(), file) == 1);
  CHECK(painter.device().ReloadTextures({file}) == std::vector{file});
  CHECK(red() == 200);
  test::WriteText(file, "no picture");
  painter.device().ReloadTextures({file});
  CHECK(test::Contains(painter.device().TakeWarnings(), "the picture before it stays"));
  CHECK(red() == 200);
  CHECK(painter.device().ReloadTextures({root / "textures/texture_9.png"}).empty());

  // One face that changes brings all six.
  view.look.shader = "Mirror";
  const char* names[] = {"posx", "negx", "posy", "negy", "posz", "negz"};
  for (const char* name : names) write("cube/" + std::string(name), 8, 60);
  CHECK(red() == 60);
  for (const char* name : names) write("cube/" + std::string(name), 4, 90);
  CHECK(painter.device().ReloadTextures({root / "textures/cube/posz.png"}).size() == 6);
  CHECK(red() == 90);
  std::filesystem::remove(root / "textures/cube/negy.png");
  painter.device().ReloadTextures({root / "textures/cube/posz.png"});
  CHECK(test::Contains(painter.device().TakeWarnings(), "negy.png"));
  CHECK(red() == 90);
}

TEST_CASE("an unknown shader, a folder without shaders and a size out of range are errors") {
  const TestCloth cloth(test::Grid(4), test::Upright);
  Scene scene = OneCloth();
  View view = View::ForScene(scene);
  view.look.shader = "phongg";
  Painter painter = Must(Painter::Open({.root = ".", .width = 32, .height = 32, .samples = 1}));
  const std::vector<ClothShape> cloths = {cloth.Shape()};
  const Result<Image> unknown = painter.Paint(scene, cloths, view);
  CHECK_FALSE(unknown.ok());
  CHECK(test::Contains(unknown.diagnostics(), "did you mean `Phong`"));

  const TemporaryFolder empty;
  bool noGraphics = true;
  const Result<Painter> lost = Painter::Open({.root = empty.path()}, &noGraphics);
  CHECK_FALSE(lost.ok());
  CHECK_FALSE(noGraphics);
  CHECK(test::Contains(lost.diagnostics(), "shaders"));
  CHECK_FALSE(Painter::Open({.root = ".", .width = 100000, .height = 10}).ok());
  CHECK_FALSE(Painter::Open({.root = ".", .width = 0, .height = 10}).ok());
}
