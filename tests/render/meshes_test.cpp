#include <cmath>
#include <numbers>

#include "tests/render/render_fixture.h"

using namespace percale;
using doctest::Approx;

namespace {

Vec3 At(const std::vector<float>& values, std::size_t vertex, std::size_t stride) {
  return {values[vertex * stride], values[vertex * stride + 1], values[vertex * stride + 2]};
}

}  // namespace

TEST_CASE("vertex normals weigh triangles by area") {
  // A corner of two triangles: one in the plane z = 0 of area 2, one in the plane y = 0 of area 1/2.
  const std::vector<float> positions = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 1, 0, 0};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 4}};
  std::vector<float> normals(20, 7);
  ComputeNormals(positions, triangles, normals);
  const Vec3 expected = UnitOr(Vec3{0, 1, 4}, {});
  CHECK(Length(At(normals, 0, 4) - expected) < 1e-6);
  CHECK(Length(At(normals, 1, 4) - Vec3{0, 0, 1}) < 1e-6);
  CHECK(Length(At(normals, 3, 4) - Vec3{0, 1, 0}) < 1e-6);
  for (std::size_t i = 3; i < 20; i += 4) CHECK(normals[i] == 0);
}

TEST_CASE("a vertex without area gets a normal all the same") {
  const std::vector<float> positions = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  std::vector<float> normals(12);
  ComputeNormals(positions, std::vector<Triangle>{{0, 1, 2}}, normals);
  CHECK(Length(At(normals, 1, 4) - Vec3{0, 0, 1}) == 0);
}

TEST_CASE("tangents run along growing u, at right angles to the normals") {
  // A cylinder about y: u goes round.
  const test::TestCloth cloth(test::Grid(40), [](Vec2 uv) {
    return Vec3{std::sin(3 * uv.x), uv.y, std::cos(3 * uv.x)};
  });
  std::vector<float> positions;
  for (const Vec3& x : cloth.model.start) positions.insert(positions.end(), {float(x.x), float(x.y), float(x.z)});
  std::vector<float> normals(cloth.model.start.size() * 4), tangents(normals.size());
  ComputeNormals(positions, cloth.model.triangles, normals);
  ComputeTangents(positions, cloth.model.uv, normals, cloth.model.triangles, tangents);
  for (std::size_t i = 0; i < cloth.model.start.size(); ++i) {
    const double u = cloth.model.uv[i].x;
    const Vec3 tangent = At(tangents, i, 4);
    CHECK(Length(tangent - Vec3{std::cos(3 * u), 0, -std::sin(3 * u)}) < 0.05);
    CHECK(std::abs(Dot(tangent, At(normals, i, 4))) < 1e-5);
  }
}

TEST_CASE("the sphere's mesh is a sphere with outward triangles, its seam behind") {
  const DrawMesh mesh = MakeSphereMesh(16, 24);
  CHECK(mesh.VertexCount() == 17 * 25);
  CHECK(mesh.triangles.size() == std::size_t(3 * 2 * 15 * 24));
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    CHECK(Length(At(mesh.positions, i, 3)) == Approx(1).epsilon(1e-6));
    CHECK(Length(At(mesh.positions, i, 3) - At(mesh.normals, i, 4)) < 1e-6);
    const float u = mesh.uv[2 * i];
    if (u == 0 || u == 1) CHECK(mesh.positions[3 * i + 2] <= 1e-6f);
    if (u == 0.5f) CHECK(mesh.positions[3 * i + 2] >= -1e-6f);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vec3 a = At(mesh.positions, mesh.triangles[t], 3), b = At(mesh.positions, mesh.triangles[t + 1], 3);
    const Vec3 c = At(mesh.positions, mesh.triangles[t + 2], 3);
    CHECK(Dot(Cross(b - a, c - a), a + b + c) > 0);
  }
}

TEST_CASE("a plane is drawn as a square of 4 m that faces along its normal") {
  for (const Vec3& normal : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -2}, Vec3{1, 1, 1}, Vec3{-0.3, 5, 0.1}}) {
    const Vec3 point{1, 2, 3}, n = UnitOr(normal, {});
    const DrawMesh mesh = MakePlaneMesh(point, normal);
    REQUIRE(mesh.VertexCount() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(Dot(At(mesh.positions, i, 3) - point, n)) < 1e-6);
      CHECK(Length(At(mesh.positions, i, 3) - point) == Approx(std::sqrt(8)).epsilon(1e-6));
    }
    CHECK(Length(At(mesh.positions, 0, 3) - At(mesh.positions, 1, 3)) == Approx(4).epsilon(1e-6));
    const Vec3 a = At(mesh.positions, mesh.triangles[0], 3), b = At(mesh.positions, mesh.triangles[1], 3);
    CHECK(Dot(Cross(b - a, At(mesh.positions, mesh.triangles[2], 3) - a), n) == Approx(16).epsilon(1e-5));
  }
}

TEST_CASE("a draw list keeps its meshes, and marks what has changed") {
  Scene scene;
  scene.cloths.resize(1);
  scene.spheres.resize(2);
  scene.planes.resize(1);
  test::TestCloth cloth(test::Grid(5), test::Upright);
  View view = View::ForScene(scene);
  view.look.shader = "Normal";
  SceneView sceneView;
  const ClothShape shapes[] = {cloth.Shape()};
  const DrawList& list = sceneView.Update(scene, shapes, view, 640, 400);
  REQUIRE(list.items.size() == 5);  // The last is the background.
  const auto mesh = list.items[0].mesh, sphere = list.items[1].mesh;
  const auto meshVersion = mesh->meshVersion, shapeVersion = mesh->shapeVersion;
  CHECK(list.items[1].mesh == list.items[2].mesh);

  sceneView.Update(scene, shapes, view, 640, 400);
  CHECK(list.items[0].mesh == mesh);
  CHECK(list.items[1].mesh == sphere);
  CHECK(mesh->meshVersion == meshVersion);
  CHECK(mesh->shapeVersion != shapeVersion);

  cloth.springs.pop_back();
  const ClothShape fewer[] = {cloth.Shape()};
  sceneView.Update(scene, fewer, view, 640, 400);
  CHECK(mesh->meshVersion != meshVersion);

  view.wireframe = true;
  sceneView.Update(scene, fewer, view, 640, 400);
  CHECK(list.items[3].pushBack);  // The plane: the springs of a sheet that lies on it stay in front.
  view.colliders = false;
  sceneView.Update(scene, fewer, view, 640, 400);
  REQUIRE(list.items.size() == 3);
  CHECK(list.items[0].pushBack);
  CHECK(list.items[1].primitive == DrawItem::Primitive::Lines);
  view.look.shader = "Wireframe";
  sceneView.Update(scene, fewer, view, 640, 400);
  CHECK(list.items.size() == 2);
}
