// How colliders of all shapes are drawn.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "collide/poses.h"
#include "mesh/rest_mesh.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::CheckReference;
using percale::test::Must;
using percale::test::TestCloth;

namespace {

constexpr const char* kNames[] = {"sphere", "plane", "box", "capsule", "cylinder", "cone", "torus", "mesh"};
constexpr ColliderShape kFormulas[] = {ColliderShape::Sphere,   ColliderShape::Box,  ColliderShape::Capsule,
                                       ColliderShape::Cylinder, ColliderShape::Cone, ColliderShape::Torus};

Vec3 At(const std::vector<float>& values, std::size_t index, std::size_t stride) {
  return {values[stride * index], values[stride * index + 1], values[stride * index + 2]};
}

ColliderSettings Make(ColliderShape shape) {
  ColliderSettings settings;
  settings.shape = shape;
  settings.size = {0.3, 0.2, 0.4};
  settings.radius = 0.15;
  settings.length = 0.3;
  return settings;
}

/// A prism of six sides around y, and a mesh collider made of it.
ColliderSettings MakePrism() {
  constexpr double kPi = 3.14159265358979323846;
  LoadedMesh loaded;
  RestMesh& mesh = loaded.mesh;
  for (const double y : {-0.15, 0.15}) {
    for (int k = 0; k < 6; ++k)
      mesh.positions.push_back({0.18 * std::sin(k * kPi / 3), y, 0.18 * std::cos(k * kPi / 3)});
  }
  for (std::int32_t k = 0; k < 6; ++k) {
    const std::int32_t next = (k + 1) % 6;
    mesh.triangles.insert(mesh.triangles.end(), {{k, next, next + 6}, {k, next + 6, k + 6}});
    if (k >= 2) mesh.triangles.insert(mesh.triangles.end(), {{0, k, k - 1}, {6, k + 5, k + 6}});
  }
  mesh.uv = ProjectedUv(mesh.positions);
  ColliderSettings settings = Make(ColliderShape::Mesh);
  settings.loaded = std::make_shared<const LoadedMesh>(std::move(loaded));
  return settings;
}

/// One of each shape on a floor, two rows of four.
struct Room {
  Scene scene;
  TestCloth cloth{test::Grid(20), [](Vec2 uv) {
                    return Vec3{uv.x * 0.5 + 0.25, 0.72 + 0.03 * std::sin(12 * uv.x), uv.y * 0.3 - 0.1};
                  }};

  Room() {
    scene.simulation.engine = Engine::Fabric;
    scene.cloths.resize(1);
    const Vec3 colors[] = {{1, 1, 1},     {0.9, 0.95, 1}, {1, 0.6, 0.5}, {0.6, 0.9, 0.6},
                           {0.6, 0.7, 1}, {1, 0.9, 0.5},  {0.9, 0.6, 1}, {0.5, 0.9, 0.9}};
    for (int k = 0; k < 8; ++k) {
      const auto shape = static_cast<ColliderShape>(k);
      ColliderSettings settings = shape == ColliderShape::Mesh ? MakePrism() : Make(shape);
      settings.color = colors[k];
      settings.position = {0.5 * (k % 4) - 0.25, 0.25, k < 4 ? -0.2 : 0.4};
      if (shape == ColliderShape::Plane) settings.position = {0.5, 0, 0.5};
      if (shape == ColliderShape::Capsule) settings.rotation = {0, 0, 60};
      if (shape == ColliderShape::Box) settings.rotation = {20, 30, 0};
      if (shape == ColliderShape::Cylinder) settings.rotation = {70, 0, 20};
      if (shape == ColliderShape::Torus) settings.rotation = {50, 0, 15};
      scene.colliders.push_back(settings);
    }
    scene.camera = {.automatic = false, .target = {0.5, 0.25, 0.2}, .distance = 2.1, .azimuth = 12, .elevation = 24};
  }
};

}  // namespace

TEST_CASE("what is drawn of a solid lies on its surface, faces outwards, and has its normals") {
  for (const ColliderShape shape : kFormulas) {
    CAPTURE(std::string(kNames[static_cast<int>(shape)]));
    const ColliderSettings settings = Make(shape);
    const Solid solid = MakeSolid(settings);
    const DrawMesh mesh = MakeColliderMesh(settings, 40, 40);
    REQUIRE(mesh.VertexCount() > 100);
    REQUIRE(mesh.normals.size() == 4 * mesh.VertexCount());
    REQUIRE(mesh.tangents.size() == mesh.normals.size());
    REQUIRE(mesh.uv.size() == 2 * mesh.VertexCount());
    double off = 0, tilted = 0, slanted = 0;
    for (std::size_t v = 0; v < mesh.VertexCount(); ++v) {
      const Vec3 p = At(mesh.positions, v, 3), n = At(mesh.normals, v, 4), t = At(mesh.tangents, v, 4);
      off = std::max(off, std::abs(DistanceTo(solid, p).distance));
      // Along an outward normal the distance grows as the way, on edges too.
      tilted = std::max(tilted, std::abs(DistanceTo(solid, p + n * 0.05).distance - 0.05));
      slanted = std::max({slanted, std::abs(Dot(n, t)), std::abs(Length(t) - 1), std::abs(Length(n) - 1)});
      CHECK((mesh.uv[2 * v] >= 0 && mesh.uv[2 * v] <= 1 && mesh.uv[2 * v + 1] >= 0 && mesh.uv[2 * v + 1] <= 1));
    }
    CHECK(off < 1e-6);
    CHECK(tilted < 1e-6);
    CHECK(slanted < 1e-6);
    double volume = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const Vec3 a = At(mesh.positions, mesh.triangles[t], 3), b = At(mesh.positions, mesh.triangles[t + 1], 3),
                 c = At(mesh.positions, mesh.triangles[t + 2], 3);
      CHECK(Dot(Cross(b - a, c - a), At(mesh.normals, mesh.triangles[t], 4)) > 0);
      volume += Dot(a, Cross(b, c)) / 6;
    }
    // No hole: the volume, a little less than it is since flat triangles cut corners.
    const double pi = 3.14159265358979323846, r = settings.radius, l = settings.length, tube = settings.tubeRadius;
    const double ball = 4 * pi / 3 * r * r * r, disc = pi * r * r;
    const double exact = shape == ColliderShape::Sphere     ? ball
                         : shape == ColliderShape::Box      ? 0.3 * 0.2 * 0.4
                         : shape == ColliderShape::Capsule  ? ball + disc * l
                         : shape == ColliderShape::Cylinder ? disc * l
                         : shape == ColliderShape::Cone     ? disc * l / 3
                                                            : 2 * pi * r * pi * tube * tube;
    CHECK(volume < exact * (1 + 1e-6));
    CHECK(volume > exact * 0.98);
  }
}

TEST_CASE("a mesh is drawn smooth where it is nearly flat, and with edges where it is sharp") {
  const DrawMesh prism = MakeColliderMesh(MakePrism(), 40, 40);
  REQUIRE(prism.triangles.size() == 3 * 20);
  for (std::size_t t = 0; t < prism.triangles.size(); t += 3) {
    const Vec3 a = At(prism.positions, prism.triangles[t], 3), b = At(prism.positions, prism.triangles[t + 1], 3),
               c = At(prism.positions, prism.triangles[t + 2], 3);
    const Vec3 face = UnitOr(Cross(b - a, c - a), {});
    for (std::size_t k = 0; k < 3; ++k) CHECK(Length(At(prism.normals, prism.triangles[t + k], 4) - face) < 1e-6);
  }
  // An octagon's sides turn by 45 degrees, those of a polygon of twenty by 18.
  LoadedMesh round;
  for (int k = 0; k <= 20; ++k) {
    const double angle = 0.1 * 3.14159265358979323846 * k;
    for (const double y : {0.0, 1.0}) round.mesh.positions.push_back({std::sin(angle), y, std::cos(angle)});
  }
  for (std::int32_t k = 0; k < 20; ++k) {
    round.mesh.triangles.insert(round.mesh.triangles.end(),
                                {{2 * k, 2 * k + 2, 2 * k + 3}, {2 * k, 2 * k + 3, 2 * k + 1}});
  }
  round.mesh.uv = ProjectedUv(round.mesh.positions);
  ColliderSettings settings = Make(ColliderShape::Mesh);
  settings.loaded = std::make_shared<const LoadedMesh>(round);
  const DrawMesh smooth = MakeColliderMesh(settings, 40, 40);
  for (std::size_t v = 0; v < smooth.VertexCount(); ++v) {
    const Vec3 p = At(smooth.positions, v, 3);
    if (std::abs(p.x) < 1e-6 && p.z > 0) continue;  // the seam
    CHECK(Dot(At(smooth.normals, v, 4), UnitOr({p.x, 0, p.z}, {})) > 0.995);
  }
  settings.loaded.reset();
  CHECK(MakeColliderMesh(settings, 40, 40).VertexCount() == 0);
}

TEST_CASE("colliders are drawn where they are at the time of the picture") {
  Room room;
  ColliderMotion motion;
  motion.collider = 6;
  motion.displacement = {0, 1, 0};
  motion.angle = 400;
  motion.axis = {1, 1, 0};
  room.scene.colliderMotions = {motion};
  View view = View::ForScene(room.scene);
  view.look.shader = "Normal";
  SceneView sceneView;
  const ClothShape cloths[] = {room.cloth.Shape()};
  std::vector<std::shared_ptr<const DrawMesh>> meshes;
  for (const double time : {0.0, 0.6, 1.0}) {
    const DrawList& list = sceneView.Update(room.scene, cloths, view, 64, 64, {}, time);
    REQUIRE(list.items.size() == 10);  // the cloth, the colliders, the background
    for (int c = 0; c < 8; ++c) {
      const DrawItem& item = list.items[static_cast<std::size_t>(c) + 1];
      const Pose pose = PoseOf(room.scene, c, time);
      for (const Vec3& p : {Vec3{}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        CHECK(Length(TransformPoint(item.model, p) - ToWorld(pose, p)) < 1e-14);
      CHECK(item.castsShadow == (c != 1));
      if (time == 0) meshes.push_back(item.mesh);
      CHECK(item.mesh == meshes[static_cast<std::size_t>(c)]);  // made once
    }
    // All of it stands in the shadow map.
    for (std::size_t v = 0; v < meshes[6]->VertexCount(); v += 7) {
      const Vec3 world = TransformPoint(list.items[7].model, At(meshes[6]->positions, v, 3));
      const Vec3 clip = TransformPoint(list.lightViewProjection, world);
      CHECK(std::max({std::abs(clip.x), std::abs(clip.y), std::abs(clip.z)}) <= 1 + 1e-9);
    }
  }
  room.scene.colliders[6].tubeRadius = 0.02;
  const DrawList& other = sceneView.Update(room.scene, cloths, view, 64, 64, {}, 0);
  CHECK(other.items[7].mesh != meshes[6]);
  CHECK(other.items[6].mesh == meshes[5]);
  view.colliders = false;
  CHECK(sceneView.Update(room.scene, cloths, view, 64, 64, {}, 0).items.size() == 2);
}

TEST_CASE("a mesh that moves by a cache is drawn where its vertices are at the time of the picture") {
  Room room;
  const auto mesh = std::find_if(room.scene.colliders.begin(), room.scene.colliders.end(),
                                 [](const ColliderSettings& c) { return c.shape == ColliderShape::Mesh; });
  REQUIRE(mesh != room.scene.colliders.end());
  const std::vector<Vec3>& rest = mesh->loaded->mesh.positions;
  VertexCache cache{"a.pc2", 1, 2, 0, {}};
  for (const double y : {0.0, 2.0}) {
    for (const Vec3& p : rest) {
      for (const double x : {p.x, p.y + y, p.z}) cache.positions.push_back(static_cast<float>(x));
    }
  }
  mesh->cache = "a.pc2";
  mesh->cacheRate = 1;
  mesh->loadedCache = std::make_shared<const VertexCache>(cache);
  const View view = View::ForScene(room.scene);
  SceneView sceneView;
  const ClothShape cloths[] = {room.cloth.Shape()};
  const std::size_t at = static_cast<std::size_t>(mesh - room.scene.colliders.begin()) + 1;
  double first = 0;
  std::uint64_t version = 0;
  std::shared_ptr<const DrawMesh> drawn;
  for (const double time : {0.0, 0.25, 1.0}) {
    const DrawItem& item = sceneView.Update(room.scene, cloths, view, 64, 64, {}, time).items[at];
    REQUIRE(item.mesh->VertexCount() > 0);
    const double y = At(item.mesh->positions, 0, 3).y;
    if (time == 0) {
      first = y, drawn = item.mesh;
    } else {
      CHECK(item.mesh->shapeVersion > version);
    }
    version = item.mesh->shapeVersion;
    CHECK(y - first == doctest::Approx(2 * time));
    CHECK(item.mesh == drawn);
  }
}

TEST_CASE("all shapes in a picture, at rest and turned") {
  Room room;
  View view = View::ForScene(room.scene);
  Painter painter = Must(Painter::Open({.root = ".", .width = 320, .height = 200, .samples = 4}));
  const std::vector<ClothShape> cloths = {room.cloth.Shape()};
  view.look.shader = "Fabric";
  CheckReference(Must(painter.Paint(room.scene, cloths, view)), "tests/render/reference/colliders.png");
  for (int c = 0; c < 8; ++c) {
    ColliderMotion motion;
    motion.collider = c;
    motion.axis = {1, 0, 1};
    motion.angle = c == 1 ? 0 : 90;
    motion.steady = true;
    room.scene.colliderMotions.push_back(motion);
  }
  view.look.shader = "Phong";
  CheckReference(Must(painter.Paint(room.scene, cloths, view, 0.5)), "tests/render/reference/colliders_turned.png");
}
