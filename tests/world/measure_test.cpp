#include "world/measure.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "math/splitmix64.h"
#include "mesh/cloth_model.h"

using namespace percale;

namespace {

ClothSettings Sheet(int points) {
  ClothSettings settings;
  settings.numWidthPoints = settings.numHeightPoints = points;
  return settings;
}

/// The grid's points, put where a function of uv says.
std::vector<Vec3> Shaped(const ClothModel& model, const std::function<Vec3(Vec2)>& shape) {
  std::vector<Vec3> positions;
  for (const Vec2& uv : model.uv) positions.push_back(shape(uv));
  return positions;
}

bool IsInner(const ClothModel& model, std::size_t v) {
  const int i = static_cast<int>(v) % model.numWidth, j = static_cast<int>(v) / model.numWidth;
  return i > 0 && j > 0 && i + 1 < model.numWidth && j + 1 < model.numHeight;
}

/// The least and the greatest mean curvature of the inner points of a shape.
std::pair<double, double> Curvature(int points, const std::function<Vec3(Vec2)>& shape) {
  const ClothModel model = MakeGrid(Sheet(points));
  std::vector<double> curvatures(model.start.size());
  CurvatureMeter meter;
  meter.Measure(Shaped(model, shape), model.triangles, curvatures);
  std::pair<double, double> range{1e300, -1e300};
  for (std::size_t v = 0; v < curvatures.size(); ++v) {
    if (!IsInner(model, v)) continue;
    range = {std::min(range.first, curvatures[v]), std::max(range.second, curvatures[v])};
  }
  return range;
}

using Pairs = std::set<std::pair<std::pair<int, int>, std::pair<int, int>>>;

Pairs Found(const ContactFinder& finder) {
  Pairs pairs;
  for (const ContactPair& pair : finder.pairs()) {
    const auto added = pairs.insert({{pair.a.cloth, pair.a.vertex}, {pair.b.cloth, pair.b.vertex}});
    CHECK(added.second);  // each once
  }
  return pairs;
}

/// Every point with every other, in the words of the header.
Pairs BruteForce(const std::vector<ContactCloth>& cloths) {
  Pairs pairs;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    for (std::size_t d = c; d < cloths.size(); ++d) {
      for (std::size_t p = 0; p < cloths[c].positions.size(); ++p) {
        for (std::size_t q = c == d ? p + 1 : 0; q < cloths[d].positions.size(); ++q) {
          const double near = 1.05 * (cloths[c].thickness + cloths[d].thickness);
          if (Length(cloths[c].positions[p] - cloths[d].positions[q]) > near) continue;
          if (c == d && Length(cloths[c].rest[p] - cloths[c].rest[q]) < 2.5 * near) continue;
          pairs.insert({{int(c), int(p)}, {int(d), int(q)}});
        }
      }
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("the stretch of a sheet that is pulled evenly") {
  ClothSettings settings = Sheet(6);
  settings.enableShearing = false;
  const ClothModel model = MakeGrid(settings);
  const std::vector<Edge> springs = EnabledSprings(model, settings);
  const auto positions = Shaped(model, [](Vec2 uv) { return Vec3{1.2 * uv.x, 3, 0.9 * uv.y}; });
  std::vector<double> greatest(positions.size()), least(positions.size()), ratios;
  const std::vector<double> lengths = LengthsOf(springs, model.start);
  MeasureStretch(positions, springs, lengths, greatest, least);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    CHECK(greatest[v] == doctest::Approx(1.2));
    CHECK(least[v] == doctest::Approx(0.9));
  }
  AppendStretch(positions, springs, lengths, ratios);
  REQUIRE(ratios.size() == springs.size());
  // Half of the springs run each way.
  CHECK(Percentile(ratios, 0.5) == doctest::Approx(0.9));
  CHECK(Percentile(ratios, 0.51) == doctest::Approx(1.2));
}

TEST_CASE("a vertex tells of the springs that end there, and of no others") {
  // Three points in a row, the second spring twice as long as at rest; a fourth point without springs.
  const std::vector<double> lengths = {1, 1};
  const std::vector<Vec3> positions = {{0, 0, 0}, {0.5, 0, 0}, {2.5, 0, 0}, {0, 0, 0}};
  const std::vector<Edge> springs = {{0, 1}, {1, 2}};
  std::vector<double> greatest(4), least(4);
  MeasureStretch(positions, springs, lengths, greatest, least);
  CHECK(greatest == std::vector<double>{0.5, 2, 2, 1});
  CHECK(least == std::vector<double>{0.5, 0.5, 2, 1});
}

TEST_CASE("percentiles are values that occur, by nearest rank") {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  CHECK(Percentile(values, 0.5) == 50);
  CHECK(Percentile(values, 0.95) == 95);
  CHECK(Percentile(values, 0.99) == 99);
  CHECK(Percentile(values, 1) == 100);
  CHECK(Percentile(values, 0) == 1);
  std::vector<double> one = {7};
  CHECK(Percentile(one, 0.5) == 7);
}

TEST_CASE("speeds are lengths of velocities") {
  std::vector<double> speeds(2);
  MeasureSpeed(std::vector<Vec3>{{2, -3, 6}, {}}, speeds);
  CHECK(speeds == std::vector<double>{7, 0});
}

TEST_CASE("mean curvature: a plane has none, a cylinder 1 / 2R, a sphere 1 / R") {
  const auto flat = Curvature(20, [](Vec2 uv) { return Vec3{uv.x + 0.3 * uv.y, uv.y, 2 * uv.x}; });
  CHECK(flat.first == doctest::Approx(0).epsilon(1e-9));
  CHECK(flat.second == doctest::Approx(0).epsilon(1e-9));

  const double radius = 0.4;
  const auto cylinder = [&](double sign) {
    return Curvature(40, [=](Vec2 uv) {
      const double angle = 1.5 * uv.x;
      return Vec3{radius * std::sin(angle), sign * radius * std::cos(angle), uv.y};
    });
  };
  CHECK(cylinder(1).first == doctest::Approx(1 / (2 * radius)).epsilon(0.002));
  CHECK(cylinder(1).second == doctest::Approx(1 / (2 * radius)).epsilon(0.002));
  CHECK(cylinder(-1).first == doctest::Approx(-1 / (2 * radius)).epsilon(0.002));

  // A patch around the equator, seen from outside its triangles turn as the cylinder's do.
  const auto sphere = Curvature(40, [&](Vec2 uv) {
    const double angle = 1.2 * uv.x, height = 0.8 * (uv.y - 0.5);
    return Vec3{radius * std::cos(height) * std::sin(angle), radius * std::cos(height) * std::cos(angle),
                radius * std::sin(height)};
  });
  CHECK(sphere.first == doctest::Approx(1 / radius).epsilon(0.02));
  CHECK(sphere.second == doctest::Approx(1 / radius).epsilon(0.02));
}

TEST_CASE("at the middle of a saddle the curvatures cancel") {
  const ClothModel model = MakeGrid(Sheet(21));
  std::vector<double> curvatures(model.start.size());
  CurvatureMeter meter;
  meter.Measure(Shaped(model,
                       [](Vec2 uv) {
                         return Vec3{uv.x, 3 * (uv.x - 0.5) * (uv.y - 0.5), uv.y};
                       }),
                model.triangles, curvatures);
  CHECK(std::abs(curvatures[10 * 21 + 10]) < 1e-9);
  // Points that no triangle has, and triangles without area, have none either.
  std::vector<double> three(3);
  meter.Measure(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, std::vector<Triangle>{{0, 1, 2}}, three);
  CHECK(three == std::vector<double>{0, 0, 0});
}

TEST_CASE("a flat sheet touches nothing, a folded one itself") {
  const ClothModel model = MakeGrid(Sheet(41));  // spacing 25 mm
  const double thickness = 0.0095;
  ContactFinder finder;
  finder.Find(std::vector<ContactCloth>{{model.start, model.start, thickness}}, {});
  CHECK(finder.pairs().empty());

  // Folded in the middle: the layers lie 18 mm apart, point over point.
  const auto folded = Shaped(model, [](Vec2 uv) {
    return uv.x <= 0.5 ? Vec3{uv.x, 0, uv.y} : Vec3{1 - uv.x, 0.018, uv.y};
  });
  const std::vector<ContactCloth> cloths = {{folded, model.start, thickness}};
  finder.Find(cloths, {});
  CHECK(Found(finder) == BruteForce(cloths));
  const std::span<const Contact> contacts = finder.Of(0);
  REQUIRE(contacts.size() == folded.size());
  for (std::size_t v = 0; v < folded.size(); ++v) {
    const int i = static_cast<int>(v) % 41;
    CHECK((contacts[v] == Contact::Cloth) == (i != 20));  // on the crease there is one layer
  }
}

TEST_CASE("pairs of contact are those that comparing every point with every other finds") {
  SplitMix64 random(7);
  const auto scatter = [&](std::size_t count, double size) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
      points.push_back({size * (x - 0.5), size * (y - 0.5), size * (z - 0.5)});
    }
    return points;
  };
  const auto a = scatter(400, 0.3), b = scatter(300, 0.3), c = scatter(1, 0.1);
  const auto restA = scatter(400, 0.5), restB = scatter(300, 0.5);
  const std::vector<ContactCloth> cloths = {{a, restA, 0.01}, {b, restB, 0.004}, {c, c, 0.02}};
  ContactFinder finder;
  finder.Find(cloths, {});
  const Pairs expected = BruteForce(cloths);
  CHECK(expected.size() > 100);
  CHECK(Found(finder) == expected);
  for (int cloth = 0; cloth < 3; ++cloth) {
    for (std::size_t v = 0; v < cloths[std::size_t(cloth)].positions.size(); ++v) {
      const bool inPair = std::any_of(expected.begin(), expected.end(), [&](const auto& pair) {
        const std::pair<int, int> point{cloth, int(v)};
        return pair.first == point || pair.second == point;
      });
      CHECK((finder.Of(cloth)[v] == Contact::Cloth) == inPair);
      const auto partners = std::count_if(expected.begin(), expected.end(), [&](const auto& pair) {
        const std::pair<int, int> point{cloth, int(v)};
        return pair.first == point || pair.second == point;
      });
      CHECK(CountContacts({cloth, int(v)}, cloths, {}).cloth == partners);
    }
  }
  // Cloth without thickness touches no cloth.
  finder.Find(std::vector<ContactCloth>{{a, restA, 0}, {b, restB, 0}}, {});
  CHECK(finder.pairs().empty());
}

TEST_CASE("boxes that points share") {
  // 4 x 4 points 1 m wide: a box spans 0.75 m along x and y, and so along z.
  const std::vector<ClothSettings> settings = {Sheet(4)};
  const std::vector<Vec3> points = {{0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, {0.8, 0.1, 0.1},
                                    {-0.1, 0.1, -1}, {-0.7, 0.1, -1}, {-0.2, 0.1, -1}};
  const std::vector<std::span<const Vec3>> positions = {std::span(points).first(2), std::span(points).subspan(2)};
  BoxFinder finder;
  finder.Find(settings, positions);
  CHECK(finder.size() == Vec3{0.75, 0.75, 0.75});
  REQUIRE(finder.boxes().size() == 2);
  CHECK(finder.boxes()[0].corner == Vec3{-0.75, 0, -1.5});
  CHECK(finder.boxes()[0].points == 3);
  CHECK(finder.boxes()[1].corner == Vec3{0, 0, 0});
  CHECK(finder.boxes()[1].points == 2);
}

TEST_CASE("contact with colliders, within the stated distance of the surface") {
  const std::vector<Vec3> points = {{0, 0.5, 0}, {0, 0.5019, 0}, {0, 0.4981, 0}, {0, 0.503, 0},
                                    {2, 0, 0},   {2, 0.0019, 0}, {2, -0.0021, 0}};
  ContactFinder finder;
  const std::vector<ContactCloth> cloths = {{points, points, 0}};
  Scene scene;
  scene.spheres = {{{0, 0, 0}, 0.5, 0.3}};
  scene.planes = {{{7, 0, 7}, {0, 3, 0}, 0.5}};
  finder.Find(cloths, SolidsAt(scene, 0, {}));
  const std::span<const Contact> found = finder.Of(0);
  const std::vector<Contact> contacts(found.begin(), found.end());
  scene.spheres = {{{0, 0.001, 0}, 0.5, 0.3}};
  scene.planes = {{{0, 0.5, 0}, {0, 3, 0}, 0.5}};
  CHECK(CountContacts({0, 0}, cloths, SolidsAt(scene, 0, {})).colliders == 2);
  CHECK(CountContacts({0, 4}, cloths, SolidsAt(scene, 0, {})).colliders == 0);
  CHECK(CountContacts({0, 0}, cloths, SolidsAt(scene, 0, {})).cloth == 0);
  CHECK(CountContacts({0, 4}, cloths, SolidsAt(scene, 0, std::vector<Ball>{{{2, 0.3, 0}, {}, 0.3, 1}})).colliders == 1);
  using enum Contact;
  CHECK(contacts == std::vector<Contact>{Collider, Collider, Collider, None, Collider, Collider, None});

  // A box whose top comes up to the first point's height, and keeps cloth 0.1 m farther off.
  scene = {};
  scene.simulation.engine = Engine::Fabric;
  scene.colliders.resize(1);
  scene.colliders[0].shape = ColliderShape::Box;
  scene.colliders[0].thickness = 0.1;
  scene.colliderMotions.resize(1);
  scene.colliderMotions[0].displacement = {0, 0.2, 0};
  CHECK(CountContacts({0, 0}, cloths, SolidsAt(scene, 0, {})).colliders == 0);
  CHECK(CountContacts({0, 0}, cloths, SolidsAt(scene, 1, {})).colliders == 1);
  scene.simulation.engine = Engine::Springs;
  CHECK(CountContacts({0, 0}, cloths, SolidsAt(scene, 1, {})).colliders == 0);
}
