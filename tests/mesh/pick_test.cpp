#include "mesh/pick.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "math/splitmix64.h"
#include "mesh/cloth_model.h"

using namespace percale;

namespace {

/// Solves origin + t d = a + u (b - a) + v (c - a) by Cramer's rule: another way than the one under test.
bool Meets(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c, double& distance) {
  const Vec3 u = b - a, v = c - a, s = ray.origin - a;
  const double determinant = Dot(Cross(u, v), ray.direction);
  if (determinant == 0) return false;
  const double atU = -Dot(Cross(v, s), ray.direction) / determinant;
  const double atV = -Dot(Cross(s, u), ray.direction) / determinant;
  distance = -Dot(Cross(u, v), s) / determinant * Length(ray.direction);
  return distance >= 0 && atU >= 0 && atV >= 0 && atU + atV <= 1;
}

Vec3 RandomPoint(SplitMix64& random) {
  const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
  return {2 * x - 1, 2 * y - 1, 2 * z - 1};
}

}  // namespace

TEST_CASE("the nearest of all triangles, as a search through them all by another way finds it") {
  SplitMix64 random(1);
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  for (std::int32_t i = 0; i < 300; ++i) {
    const Vec3 centre = RandomPoint(random);
    for (int k = 0; k < 3; ++k) positions.push_back(centre + 0.3 * RandomPoint(random));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Ray ray{2 * RandomPoint(random), RandomPoint(random)};
    double nearest = std::numeric_limits<double>::infinity(), distance = 0;
    std::int32_t expected = -1;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!Meets(ray, positions[3 * t], positions[3 * t + 1], positions[3 * t + 2], distance)) continue;
      if (distance >= nearest) continue;
      nearest = distance;
      expected = static_cast<std::int32_t>(t);
    }
    const std::optional<Hit> hit = PickCloth(ray, positions, triangles);
    REQUIRE(hit.has_value() == (expected >= 0));
    if (!hit) continue;
    ++hits;
    CHECK(hit->triangle == expected);
    CHECK(hit->distance == doctest::Approx(nearest));
    Vec3 blended;
    double sum = 0, toVertex = std::numeric_limits<double>::infinity();
    std::int32_t vertex = -1;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = 3 * expected + k;
      const double weight = hit->weights[static_cast<std::size_t>(k)];
      CHECK(weight >= 0);
      sum += weight;
      blended += weight * positions[static_cast<std::size_t>(v)];
      const double way = Length(positions[static_cast<std::size_t>(v)] - hit->point);
      if (way < toVertex) vertex = v;
      toVertex = std::min(toVertex, way);
    }
    CHECK(sum == doctest::Approx(1));
    CHECK(Length(blended - hit->point) < 1e-12);
    CHECK(Length(ray.origin + nearest * UnitOr(ray.direction, {}) - hit->point) < 1e-12);
    CHECK(hit->vertex == vertex);
  }
  CHECK(hits > 50);
}

TEST_CASE("no ray slips between the triangles of a sheet") {
  // Tilted and bent, so that nothing is exact; the rays go through its edges and vertices.
  ClothSettings settings;
  settings.numWidthPoints = 12;
  settings.numHeightPoints = 9;
  ClothModel sheet = MakeGrid(settings);
  for (Vec3& p : sheet.start) p.y += 0.3 * p.x + 0.1 * std::sin(5 * p.z);
  const Vec3 eye{0.37, 3.1, 0.43};
  for (const Triangle& t : sheet.triangles) {
    const Vec3 &a = sheet.start[static_cast<std::size_t>(t.a)], &b = sheet.start[static_cast<std::size_t>(t.b)];
    // The outer edges of the sheet may be missed by a rounding error.
    const Vec3 middle = 0.5 * (a + b);
    if (middle.x < 1e-6 || middle.x > 1 - 1e-6 || middle.z < 1e-6 || middle.z > 1 - 1e-6) continue;
    for (const double share : {0.0, 0.25, 1.0 / 3, 0.5, 0.9}) {
      const Vec3 target = a + share * (b - a);
      if (target.x < 1e-6 || target.x > 1 - 1e-6 || target.z < 1e-6 || target.z > 1 - 1e-6) continue;
      const auto hit = PickCloth({eye, target - eye}, sheet.start, sheet.triangles);
      REQUIRE(hit);
      CHECK(Length(hit->point - target) < 1e-9);
    }
  }
}

TEST_CASE("a ray that points away, runs alongside, or meets what is no triangle meets nothing") {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> one = {{0, 1, 2}};
  CHECK(PickCloth({{0.2, 0.2, 1}, {0, 0, -5}}, corners, one)->distance == doctest::Approx(1));
  CHECK(PickCloth({{0.2, 0.2, -1}, {0, 0, 0.1}}, corners, one)->distance == doctest::Approx(1));  // from behind
  CHECK_FALSE(PickCloth({{0.2, 0.2, 1}, {0, 0, 1}}, corners, one));
  CHECK_FALSE(PickCloth({{0.7, 0.7, 1}, {0, 0, -1}}, corners, one));
  CHECK_FALSE(PickCloth({{-1, 0.2, 0}, {1, 0, 0}}, corners, one));
  CHECK_FALSE(PickCloth({{0.2, 0, 1}, {0, 0, -1}}, corners, std::vector<Triangle>{{0, 1, 1}}));
  CHECK_FALSE(PickCloth({{0.2, 0.2, 1}, {0, 0, -1}}, corners, {}));
  std::vector<Vec3> lost = corners;
  lost[1].x = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(PickCloth({{0.2, 0.2, 1}, {0, 0, -1}}, lost, one));
}

TEST_CASE("of two triangles at the same distance the first") {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> twice = {{0, 1, 2}, {2, 1, 0}};
  CHECK(PickCloth({{0.2, 0.2, 1}, {0, 0, -1}}, corners, twice)->triangle == 0);
}
