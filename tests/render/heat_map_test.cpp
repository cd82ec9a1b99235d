// Heat maps with their legends, and overlays: colours worked out by hand.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>

#include "render/heat_scale.h"
#include "render/legend.h"
#include "render/overlays.h"
#include "render/ticks.h"
#include "tests/render/render_fixture.h"
#include "world/measure.h"

using namespace percale;
using percale::test::Must;
using percale::test::TestCloth;

namespace {

constexpr int kWidth = 320, kHeight = 250;

/// A sheet in front of the course's camera, and the rest shape that it had.
struct Sheet {
  Scene scene;
  TestCloth cloth;
  std::vector<Vec3> rest = MakeGrid(test::Grid(11)).start;
  std::vector<Vec3> velocities;
  std::vector<std::int32_t> pinned;
  View view;

  explicit Sheet(const std::function<Vec3(Vec2)>& shape = test::Upright) : cloth(test::Grid(11), shape) {
    scene.cloths = {test::Grid(11)};
    velocities.resize(rest.size());
    view = View::ForScene(scene);
    view.camera = OrbitCamera::ForScene([] {
      Scene seen;
      seen.cloths.resize(1);
      seen.camera = {.automatic = false, .target = {0.5, 0.5, 0}, .distance = 2};
      return seen;
    }());
  }
  Image Paint() const {
    Painter painter = Must(Painter::Open({.root = ".", .width = kWidth, .height = kHeight, .samples = 1}));
    return Paint(painter, view);
  }
  Image Paint(Painter& painter, const View& seen) const {
    ClothShape shape = cloth.Shape();
    shape.rest = rest;
    const std::vector<double> lengths = LengthsOf(shape.springs, rest);
    shape.restLengths = lengths;
    shape.velocities = velocities;
    shape.pinned = pinned;
    return Must(painter.Paint(scene, std::vector<ClothShape>{shape}, seen));
  }
  /// The pixel at a point of the world.
  const std::uint8_t* At(const Image& image, const Vec3& point) const {
    const Vec3 clip = TransformPoint(view.camera.ViewProjection(kWidth, kHeight), point);
    return image.At(int((clip.x + 1) / 2 * kWidth), int((1 - clip.y) / 2 * kHeight));
  }
  /// How much of its colour a heat map shows there: all where the surface faces the eye.
  double Shade(const Vec3& point) const { return 0.6 + 0.4 * std::abs(UnitOr(view.camera.position() - point, {}).z); }
};

void CheckColor(const std::uint8_t* found, const Rgb& expected, double shade = 1, int tolerance = 2) {
  INFO(int(found[0]) << " " << int(found[1]) << " " << int(found[2]));
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::abs(int(found[k]) - 255 * shade * static_cast<double>(expected[k])) <= tolerance);
}

/// Points of the sheet away from its edges, and below the legend.
const Vec3 kPoints[] = {{0.5, 0.5, 0}, {0.15, 0.35, 0}, {0.85, 0.15, 0}, {0.33, 0.62, 0}};

bool Same(const Image& a, const Image& b) {
  return a.rgba == b.rgba;
}

}  // namespace

TEST_CASE("a sheet that is stretched evenly has one colour, whatever its shader") {
  for (const char* shader : {"Wireframe", "Phong"}) {
    Sheet sheet;
    for (Vec3& p : sheet.rest) p = (1 / 1.05) * p;
    sheet.view.look.shader = shader;
    sheet.view.heatMap = {Quantity::Stretch, ValueRange{1, 1.2}};
    const Image image = sheet.Paint();
    for (const Vec3& p : kPoints) CheckColor(sheet.At(image, p), HeatColor(0.25), sheet.Shade(p));
    // Beyond the range the colour is that of its end.
    sheet.view.heatMap.range = {1, 1.01};
    const Image beyond = sheet.Paint();
    for (const Vec3& p : kPoints) CheckColor(sheet.At(beyond, p), HeatColor(1), sheet.Shade(p));
    // Nothing is compressed.
    sheet.view.heatMap = {Quantity::Compression, {}};
    const Image compression = sheet.Paint();
    for (const Vec3& p : kPoints) CheckColor(sheet.At(compression, p), HeatColor(1), sheet.Shade(p));
  }
}

TEST_CASE("speeds, curvature and contacts show in their colours") {
  Sheet sheet;
  sheet.velocities.assign(sheet.rest.size(), Vec3{0, -3, 4});
  sheet.view.heatMap = {Quantity::Speed, {}};  // up to 5 m/s by itself
  const Image speed = sheet.Paint();
  for (const Vec3& p : kPoints) CheckColor(sheet.At(speed, p), HeatColor(1), sheet.Shade(p));
  sheet.view.heatMap.range = {0, 10};
  const Image half = sheet.Paint();
  for (const Vec3& p : kPoints) CheckColor(sheet.At(half, p), HeatColor(0.5), sheet.Shade(p));

  sheet.view.heatMap = {Quantity::Curvature, {}};
  const Image flat = sheet.Paint();
  for (const Vec3& p : kPoints) CheckColor(sheet.At(flat, p), HeatColor(0), sheet.Shade(p));

  sheet.view.heatMap = {Quantity::Contact, {}};
  const Image apart = sheet.Paint();
  for (const Vec3& p : kPoints) CheckColor(sheet.At(apart, p), kContactColors[0], sheet.Shade(p));
  sheet.scene.planes.push_back({.point = {0, 0, 0.001}, .normal = {0, 0, 1}});
  sheet.view.colliders = false;
  const Image touching = sheet.Paint();
  for (const Vec3& p : kPoints) CheckColor(sheet.At(touching, p), kContactColors[2], sheet.Shade(p));
}

TEST_CASE("the legend's bar runs from the first colour to the last") {
  Sheet sheet;
  sheet.view.heatMap = {Quantity::Stretch, ValueRange{1, 1.2}};
  const Image image = sheet.Paint();
  const LegendBar bar = PlaceLegend(kWidth, kHeight);
  const int middle = bar.y + bar.height / 2;
  CheckColor(image.At(bar.x, middle), HeatColor(0), 1, 1);
  CheckColor(image.At(bar.x + bar.width - 1, middle), HeatColor(1), 1, 1);
  CheckColor(image.At(bar.x + bar.width / 2, middle), HeatColor(0.5), 1, 3);
  // Numbers stand below, a title above.
  const auto bright = [&](int top, int rows) {
    int count = 0;
    for (int y = top; y < top + rows; ++y) {
      for (int x = 0; x < bar.x + bar.width; ++x) count += image.At(x, y)[0] > 230 && image.At(x, y)[2] > 230;
    }
    return count;
  };
  CHECK(bright(bar.y + bar.height + 1, 10) > 60);
  CHECK(bright(bar.y - 11, 9) > 60);

  sheet.view.heatMap = {Quantity::Contact, {}};
  const Image contact = sheet.Paint();
  for (int k = 0; k < 3; ++k)
    CheckColor(contact.At(bar.x + (2 * k + 1) * bar.width / 6, middle), kContactColors[k], 1, 1);

  // Too small a picture has none, and is no error.
  Image small = MakeImage(30, 20);
  DrawLegend(small, {Quantity::Speed, {0, 1}});
  CHECK(Same(small, MakeImage(30, 20)));
}

TEST_CASE("heat maps and overlays leave no trace in the pictures after them") {
  Sheet sheet;
  sheet.pinned = {0, 10};
  sheet.view.look.shader = "Phong";
  const Image before = sheet.Paint();
  Painter painter = Must(Painter::Open({.root = ".", .width = kWidth, .height = kHeight, .samples = 1}));
  View other = sheet.view;
  other.heatMap = {Quantity::Stretch, {}};
  other.overlays = {true, true, true, true, true};
  other.wireframe = true;
  CHECK_FALSE(Same(sheet.Paint(painter, other), before));
  CHECK(Same(sheet.Paint(painter, sheet.view), before));
}

TEST_CASE("pins are dots, as wide as stated, where they are") {
  Sheet sheet;
  sheet.pinned = {60};  // the middle
  sheet.view.look.shader = "Phong";
  sheet.view.overlays.pins = true;
  const Image image = sheet.Paint();
  const Vec3& pin = sheet.cloth.model.start[60];
  CheckColor(sheet.At(image, pin), {0.902f, 0.624f, 0}, 1, 1);
  int dots = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) dots += image.At(x, y)[0] == 230 && image.At(x, y)[1] == 159;
  }
  CHECK(dots == doctest::Approx(3.14159 * 4.5 * 4.5).epsilon(0.15));
}

TEST_CASE("normals, contacts and boxes are the lines that they should be") {
  DrawMesh mesh;
  mesh.positions = {0, 0, 0, 1, 2, 3};
  mesh.normals = {0, 1, 0, 0, 0, 0, 1, 0};
  Marks marks;
  AddNormals(mesh, 0.5, marks);
  REQUIRE(marks.lines.size() == 4);
  CHECK(marks.lines[1].position == std::array<float, 3>{0, 0.5f, 0});
  CHECK(marks.lines[3].position == std::array<float, 3>{1, 2, 3.5f});

  const std::vector<Vec3> a = {{0, 0, 0}}, b = {{0, 0, 0.01}};
  const std::vector<ContactCloth> cloths = {{a, a, 0.01}, {b, b, 0.01}};
  ContactFinder contacts;
  Scene ball;
  ball.spheres = {{{0, 1, 0}, 1, 0}};
  contacts.Find(cloths, SolidsAt(ball, 0, {}));
  ClothShape shapes[2];
  shapes[0].positions = a;
  shapes[1].positions = b;
  marks = {};
  AddContacts(shapes, contacts, marks);
  REQUIRE(marks.lines.size() == 2);
  CHECK(marks.lines[1].position == std::array<float, 3>{0, 0, 0.01f});
  CHECK(marks.points.size() == 2);  // both touch the sphere

  const std::vector<Vec3> points = {{0.1, 0.1, 0.1}, {0.2, 0.1, 0.1}};
  const std::vector<std::span<const Vec3>> positions = {points};
  BoxFinder boxes;
  boxes.Find(std::vector<ClothSettings>{test::Grid(4)}, positions);
  marks = {};
  AddBoxes(boxes, marks);
  REQUIRE(marks.lines.size() == 24);
  std::set<std::array<float, 3>> corners;
  for (std::size_t i = 0; i < 24; i += 2) {
    const auto &from = marks.lines[i].position, &to = marks.lines[i + 1].position;
    corners.insert({from, to});
    CHECK((from[0] != to[0]) + (from[1] != to[1]) + (from[2] != to[2]) == 1);
  }
  CHECK(corners.size() == 8);
}

TEST_CASE("a rope is straight where it is taut, and else about as long as it is") {
  Scene scene;
  scene.cloths = {test::Grid(4)};
  scene.tethers.push_back({.cloth = 0, .points = {{1, 2}}, .anchor = {3, 4, 0}, .length = 5});
  std::vector<Vec3> positions(16, Vec3{100, 0, 0});
  ClothShape shape;
  shape.positions = positions;
  const auto length = [&](Vec3 from) {
    positions[9] = from;
    Marks marks;
    AddTethers(scene, std::span(&shape, 1), marks);
    REQUIRE(!marks.lines.empty());
    const auto at = [&](const Mark& mark) { return Vec3{mark.position[0], mark.position[1], mark.position[2]}; };
    CHECK(Length(at(marks.lines.front()) - from) < 1e-6);
    CHECK(Length(at(marks.lines.back()) - scene.tethers[0].anchor) < 1e-6);
    double sum = 0;
    for (std::size_t k = 0; k < marks.lines.size(); k += 2) sum += Length(at(marks.lines[k + 1]) - at(marks.lines[k]));
    return sum;
  };
  CHECK(length({-3, -4, 0}) == doctest::Approx(10));  // drawn out
  CHECK(length({0, 0, 0}) == doctest::Approx(5));
  for (const double share : {0.02, 0.2, 0.5, 0.9}) {
    CHECK(length({3 - 5 * share, 4, 0}) == doctest::Approx(5).epsilon(0.12));
  }
}

TEST_CASE("viridis begins dark violet, ends yellow, and grows lighter all the way") {
  // The ends and the middle of the original.
  const Rgb ends[] = {{0.267f, 0.005f, 0.329f}, {0.128f, 0.567f, 0.551f}, {0.993f, 0.906f, 0.144f}};
  for (int i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(HeatColor(0.5 * i)[k] - ends[i][k]) < 2.7f / 255);
  }
  float last = 0;
  for (int i = 0; i <= 50; ++i) {
    const Rgb c = HeatColor(i / 50.0);
    const float lightness = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
    CHECK(lightness > last);
    last = lightness;
  }
  CHECK(HeatColor(-1) == HeatColor(0));
  CHECK(HeatColor(7) == HeatColor(1));
}

TEST_CASE("an automatic range is round, holds every value, and does not flicker") {
  SteadySpan span(1e-3);
  CHECK(span.Update(0) == doctest::Approx(1e-3));
  CHECK(span.Update(0.07) == doctest::Approx(0.1));
  // Around a value at which it would change, it stays.
  span.Update(0.11);
  std::set<double> seen;
  for (int i = 0; i < 100; ++i) seen.insert(span.Update(0.1 + 0.012 * std::sin(i)));
  CHECK(seen.size() == 1);
  CHECK(span.Update(0.011) == doctest::Approx(0.02));
  CHECK(span.Update(1e-9) == doctest::Approx(1e-3));
  for (int i = 1; i < 1000; ++i) CHECK(span.Update(i * 0.0137) >= i * 0.0137);
}

TEST_CASE("contacts of one patch of cloth are one arrow, and no force is lost") {
  // On a sheet of four points, 0.1 m apart: two contacts near each other, one on the other side of the cloth, one far
  // off; and one with the second sheet, which both sheets have.
  const std::vector<Vec3> rest = {{0.01, 0, 0}, {0.02, 0, 0}, {0.31, 0, 0}, {0.41, 0, 0}};
  ClothShape shapes[2];
  shapes[0].rest = shapes[1].rest = rest;
  const auto contact = [](int vertex, const Vec3& normal, double force) {
    ContactForce one;
    one.vertex = vertex;
    one.normal = normal;
    one.point = {0.1 * vertex, 0, 0};
    one.force = force;
    one.coefficient = 0.5;
    one.friction = {0, 0, 0.5 * force};
    one.slides = true;
    return one;
  };
  std::vector<ContactForce> contacts = {contact(0, {0, 1, 0}, 1), contact(1, {0, 1, 0}, 2), contact(1, {0, -1, 0}, 3),
                                        contact(2, {0, 1, 0}, 4)};
  contacts[1].slides = false;
  contacts.push_back(contact(3, {0, 1, 0}, 5));
  contacts.back().otherCloth = 1;
  const std::vector<ContactForce> merged = MergeContacts(shapes, contacts, 0.1);
  REQUIRE(merged.size() == 5);
  CHECK(merged[0].Total() == Vec3{0, 3, 1.5});
  CHECK(merged[0].point == Vec3{0.1, 0, 0});  // of the contact next to the middle of the patch
  CHECK_FALSE(merged[0].slides);
  CHECK(merged[1].Total() == Vec3{0, -3, 1.5});
  CHECK(merged[1].slides);
  CHECK(merged[2].Total() == Vec3{0, 4, 2});
  CHECK(merged[3].Total() == Vec3{0, 5, 2.5});
  CHECK(merged[4].cloth == 1);
  CHECK(merged[4].Total() == Vec3{0, -5, -2.5});
  CHECK(MergeContacts(shapes, contacts, 10).size() == 4);

  Marks marks;
  AddForces(std::span(merged).first(1), {.force = 6, .length = 0.2, .width = 0.001, .eye = {0, 0, 9}}, marks);
  REQUIRE(marks.points.size() == 1);
  CHECK(marks.points[0].color == std::array<std::uint8_t, 4>{0, 158, 115, 255});
  float top = 0;
  for (const Mark& mark : marks.triangles) top = std::max(top, mark.position[1]);
  CHECK(top == doctest::Approx(0.1));
}

TEST_CASE("the force of what slides ends on the rim of its cone") {
  ContactForce contact;
  contact.normal = {0, 1, 0};
  contact.force = 4;
  contact.coefficient = 0.5;
  contact.friction = {2, 0, 0};
  contact.slides = true;
  Marks marks;
  AddCones(std::span(&contact, 1), {.force = 16, .length = 0.2, .width = 0.001, .eye = {0, 0, 9}}, marks);
  // Half as high as one of four times the force, and half as wide as high.
  for (const Mark& mark : marks.lines) {
    CHECK(mark.position[1] == doctest::Approx(0.1));
    CHECK(std::hypot(mark.position[0], mark.position[2]) == doctest::Approx(0.05));
  }
  bool ends = false;
  for (const Mark& mark : marks.triangles) {
    ends |= std::abs(mark.position[0] - 0.05f) < 1e-6f && std::abs(mark.position[1] - 0.1f) < 1e-6f;
    CHECK(mark.position[1] < 0.101f);
  }
  CHECK(ends);
  CHECK(marks.glass.size() == 3 * 24);
}

TEST_CASE("ticks are round numbers, and texts as short as they can be") {
  CHECK(RoundUp(1) == doctest::Approx(1));
  CHECK(RoundUp(1.01) == doctest::Approx(2));
  CHECK(RoundUp(0.03) == doctest::Approx(0.05));
  CHECK(RoundUp(7e5) == doctest::Approx(1e6));
  const std::vector<double> ticks = Ticks(1, 1.2, 4);
  REQUIRE(ticks.size() == 5);
  CHECK(ticks.front() == doctest::Approx(1));
  CHECK(ticks[1] == doctest::Approx(1.05));
  CHECK(ticks.back() == doctest::Approx(1.2));
  CHECK(Ticks(-0.3, 0.31, 4).size() == 3);  // -0.2, 0, 0.2
  CHECK(Ticks(0, 5, 5).size() == 6);
  CHECK(TickText(1.05, 0.05) == "1.05");
  CHECK(TickText(1200, 200) == "1200");
  CHECK(TickText(0, 1e-7) == "0");
  CHECK(TickText(3e-7, 1e-7) == "3e-07");
  CHECK(TickText(2e7, 1e7) == "2e+07");
}

TEST_CASE("a range as narrow as numbers can tell apart has few ticks, and they end") {
  for (const double low : {1.0, -3e5, 1e300}) {
    const double high = std::nextafter(low, INFINITY);
    const std::vector<double> ticks = Ticks(low, high, 5);
    CHECK(ticks.size() <= 6);
    CHECK(std::adjacent_find(ticks.begin(), ticks.end(), std::greater_equal<>()) == ticks.end());
  }
  CHECK(Ticks(-1.7e308, 1.7e308, 5).empty());
}
