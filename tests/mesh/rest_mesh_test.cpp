#include "mesh/rest_mesh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/cloth_model.h"
#include "mesh/mesh_problems.h"
#include "mesh/topology.h"

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

double Area(const RestMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += MaterialArea(mesh.material, t);
  return area;
}

int EulerCharacteristic(const RestMesh& mesh) {
  const Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
  return int(mesh.positions.size()) - int(topology.edges.size()) + int(mesh.triangles.size());
}

Vec3 At(const RestMesh& mesh, std::int32_t v) {
  return mesh.positions[static_cast<std::size_t>(v)];
}

double Distance(const Vec2& a, const Vec2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Every side of every triangle is as long in the fabric as in space.
void CheckIsometric(const RestMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::int32_t v[3] = {mesh.triangles[t].a, mesh.triangles[t].b, mesh.triangles[t].c};
    for (std::size_t k = 0; k < 3; ++k) {
      const double inSpace = Length(At(mesh, v[k]) - At(mesh, v[(k + 1) % 3]));
      CHECK(Distance(mesh.material[3 * t + k], mesh.material[3 * t + (k + 1) % 3]) == doctest::Approx(inSpace));
    }
    CHECK(MaterialArea(mesh.material, t) > 0);
  }
}

/// Where the fabric's direction (x, y) points in space, in triangle t.
Vec3 InSpace(const RestMesh& mesh, std::size_t t, const Vec2& direction) {
  const Vec2* m = &mesh.material[3 * t];
  const double a = m[1].x - m[0].x, b = m[2].x - m[0].x, c = m[1].y - m[0].y, d = m[2].y - m[0].y, det = a * d - b * c;
  const Triangle& v = mesh.triangles[t];
  const Vec3 e1 = At(mesh, v.b) - At(mesh, v.a), e2 = At(mesh, v.c) - At(mesh, v.a);
  return ((d * direction.x - b * direction.y) / det) * e1 + ((a * direction.y - c * direction.x) / det) * e2;
}

/// A quarter of a cylinder around the y axis, with uv along it and up.
RestMesh Cylinder(std::vector<Vec2>& cornerUv) {
  RestMesh mesh;
  const int around = 8, up = 4;
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i <= around; ++i) {
      const double angle = std::numbers::pi / 2 * i / around;
      mesh.positions.push_back({std::cos(angle), 0.25 * j, std::sin(angle)});
      mesh.uv.push_back({double(i) / around, double(j) / up});
    }
  }
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * (around + 1) + i, b = a + 1, c = a + around + 1, d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : {t.a, t.b, t.c}) cornerUv.push_back(mesh.uv[static_cast<std::size_t>(v)]);
  }
  return mesh;
}

}  // namespace

TEST_CASE("A grid mesh is the classic grid, flat at rest, without problems") {
  for (const Orientation orientation : {Orientation::Horizontal, Orientation::Vertical}) {
    ClothSettings settings = Sheet(7, 5);
    settings.orientation = orientation;
    settings.origin = {1, 2, 3};
    const ClothModel model = MakeGrid(settings);
    const RestMesh mesh = MakeGridMesh(settings);
    CHECK(mesh.positions == model.start);
    CHECK(mesh.uv == model.uv);
    REQUIRE(mesh.triangles.size() == model.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      CHECK(mesh.triangles[t].a == model.triangles[t].a);
      CHECK(mesh.triangles[t].b == model.triangles[t].b);
      CHECK(mesh.triangles[t].c == model.triangles[t].c);
      CHECK(MaterialArea(mesh.material, t) == doctest::Approx(3.0 * 2.0 / 48));
    }
    CHECK(EulerCharacteristic(mesh) == 1);
    CHECK(DescribeMeshProblems(FindMeshProblems(mesh)).empty());
  }
  CheckIsometric(MakeGridMesh(Sheet(4, 3)));
}

TEST_CASE("A disc of r rings has 1 + 3 r (r + 1) vertices, one boundary and no problems") {
  for (const int rings : {1, 2, 3, 10}) {
    const RestMesh mesh = MakeDisc(0.5, rings);
    CHECK(int(mesh.positions.size()) == 1 + 3 * rings * (rings + 1));
    CHECK(int(mesh.triangles.size()) == 6 * rings * rings);
    CHECK(mesh.uv.size() == mesh.positions.size());
    CHECK(EulerCharacteristic(mesh) == 1);
    CHECK(DescribeMeshProblems(FindMeshProblems(mesh)).empty());
    CheckIsometric(mesh);
    const Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
    CHECK(int(topology.boundaryEdges.size()) == 6 * rings);
    for (const Triangle& t : mesh.triangles) {
      CHECK(Cross(At(mesh, t.b) - At(mesh, t.a), At(mesh, t.c) - At(mesh, t.a)).y > 0);
    }
  }
}

TEST_CASE("The area of a disc nears pi r^2 with the square of the rings") {
  const double radius = 0.7, exact = std::numbers::pi * radius * radius;
  for (const int rings : {4, 8, 16}) {
    const double error = exact - Area(MakeDisc(radius, rings)), half = exact - Area(MakeDisc(radius, 2 * rings));
    CHECK(error > 0);
    CHECK(error / half == doctest::Approx(4).epsilon(0.02));
  }
}

TEST_CASE("The triangles of a disc lie between the equilateral and half a square") {
  const RestMesh mesh = MakeDisc(1, 20);
  double least = 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec2* m = &mesh.material[3 * t];
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, Distance(m[k], m[(k + 1) % 3]));
    least = std::min(least, MaterialArea(mesh.material, t) / (longest * longest));
  }
  CHECK(least > 0.249);  // half a square has 0.25
}

TEST_CASE("A shape in space keeps its lengths in the fabric, its warp along the texture's first coordinate") {
  std::vector<Vec2> cornerUv;
  RestMesh mesh = Cylinder(cornerUv);
  SUBCASE("as it is") {}
  SUBCASE("sheared: the warp runs where the second coordinate stays") {
    for (Vec2& uv : cornerUv) uv.x += 0.5 * uv.y;
  }
  SUBCASE("mirrored: up becomes down, around stays") {
    for (Vec2& uv : cornerUv) uv.y = 1 - uv.y;
  }
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, cornerUv, std::nullopt);
  CheckIsometric(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 warp = InSpace(mesh, t, {1, 0});
    CHECK(warp.y == doctest::Approx(0));
    CHECK(Length(warp) == doctest::Approx(1));
    CHECK(warp.z > 0);  // the angle grows
    CHECK(std::abs(InSpace(mesh, t, {0, 1}).y) == doctest::Approx(1));
  }
}

TEST_CASE("Without texture coordinates the warp follows the stated direction, else the first edge") {
  std::vector<Vec2> cornerUv;
  RestMesh mesh = Cylinder(cornerUv);
  const auto check = [&](const std::optional<Vec3>& stated, const Vec3& along) {
    CheckIsometric(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& v = mesh.triangles[t];
      const Vec3 edge = UnitOr(At(mesh, v.b) - At(mesh, v.a), {});
      const Vec3 warp = InSpace(mesh, t, {1, 0});
      CHECK(Length(warp - (stated ? along : edge)) < 1e-9);
    }
  };
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, {}, Vec3{0, 3, 0});
  check(Vec3{0, 3, 0}, {0, 1, 0});
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, {}, std::nullopt);
  check(std::nullopt, {});
  // Texture coordinates that are missing, or one point, give way.
  const double nan = std::nan("");
  for (const Vec2 uv : {Vec2{nan, nan}, Vec2{0.5, 0.5}}) {
    const std::vector<Vec2> none(cornerUv.size(), uv);
    mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, none, Vec3{0, 1, 0});
    check(Vec3{0, 1, 0}, {0, 1, 0});
  }
}

TEST_CASE("A warp that stands on a triangle, and a triangle without area, have an answer") {
  const std::vector<Vec3> positions{{0, 0, 0}, {2, 0, 0}, {0, 0, -1}, {4, 0, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
  const auto material = MaterialFromShape(positions, triangles, {}, Vec3{0, 1, 0});
  CHECK(material[1] == Vec2{2, 0});
  CHECK(material[2] == Vec2{0, 1});
  for (std::size_t k = 3; k < 6; ++k) CHECK(material[k] == Vec2{0, 0});
}

TEST_CASE("Fabric from texture coordinates is as large as stated, and counter-clockwise") {
  const std::vector<Vec2> uv{{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {1, 0}};
  const auto material = MaterialFromUv(uv, 0.5);
  CHECK(MaterialArea(material, 0) == 0.125);
  CHECK(MaterialArea(material, 1) == 0.125);
  CHECK(material[1] == Vec2{0.5, 0});
  CHECK(material[5] == Vec2{0.5, 0});  // along the warp nothing is mirrored
}

TEST_CASE("Projected texture coordinates see a sheet from its flat side") {
  for (int flat = 0; flat < 3; ++flat) {
    std::vector<Vec3> positions;
    for (const auto& [u, v] : {Vec2{1, 1}, Vec2{3, 1}, Vec2{1, 2}}) {
      positions.push_back(flat == 0 ? Vec3{7, u, v} : flat == 1 ? Vec3{u, 7, v} : Vec3{u, v, 7});
    }
    CHECK(ProjectedUv(positions) == std::vector<Vec2>{{0, 0}, {1, 0}, {0, 0.5}});
  }
  CHECK(ProjectedUv({}).empty());
  CHECK(ProjectedUv(std::vector<Vec3>{{1, 2, 3}}) == std::vector<Vec2>{{0, 0}});
}
