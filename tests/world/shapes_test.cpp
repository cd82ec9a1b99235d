// Cloths of any shape: discs and meshes beside grids, and parts of other material.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "fabric/fabric_model.h"
#include "mesh/cloth_model.h"
#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"
#include "percale/parameters.h"
#include "percale/world.h"

namespace percale {
namespace {

Scene Fabric(Shape shape) {
  Scene scene;
  ClothSettings cloth;
  Choose(*FindParameter("simulation", "engine"), scene, 0, std::string("fabric"));
  SetFabric(cloth, percale::Fabric::Cotton);
  cloth.shape = shape;
  cloth.numWidthPoints = 11, cloth.numHeightPoints = 9;
  cloth.rings = 6;
  scene.cloths = {cloth};
  return scene;
}

/// A cloth whose mesh is a disc of a radius, as if read from a file in which every second vertex belongs to nothing.
Scene MeshScene(double radius = 0.4) {
  Scene scene = Fabric(Shape::Mesh);
  LoadedMesh loaded{"disc.obj", {}, MakeDisc(radius, 6)};
  for (std::size_t v = 0; v < loaded.mesh.positions.size(); ++v)
    loaded.mesh.source.push_back(static_cast<std::int32_t>(2 * v));
  loaded.mesh.groups = {{"middle", {0, 1, 2, 3, 4, 5, 6}}, {"one", {9}}};
  scene.cloths[0].mesh = loaded.file;
  scene.cloths[0].loaded = std::make_shared<const LoadedMesh>(std::move(loaded));
  return scene;
}

std::string Errors(const Scene& scene) {
  return Format(CheckScene(scene));
}
bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

fabric::FabricModel Model(const Scene& scene) {
  std::vector<RestMesh> meshes;
  for (const ClothSettings& cloth : scene.cloths) meshes.push_back(MakeClothMesh(cloth));
  return fabric::BuildModel(scene, meshes);
}
double Mass(const fabric::FabricModel& model) {
  double mass = 0;
  for (const double m : model.mass) mass += m;
  return mass;
}

TEST_CASE("A world runs cloths of every shape, and shows them as they are") {
  Scene scene = Fabric(Shape::Disc);
  scene.cloths.push_back(MeshScene().cloths[0]);
  scene.cloths.push_back(Fabric(Shape::Grid).cloths[0]);
  scene.cloths[0].pinned = {{0, 0}, {7, 0}};
  scene.cloths[1].pinned = {{40, 0}};  // the twentieth vertex
  scene.cloths[1].pinnedGroup = "one";
  scene.cloths[2].pinned = {{0, 0}, {10, 0}};
  scene.pinMotions = {{1, {{18, 0}}, 0, 0.1, {0, 0.25, 0}}};
  REQUIRE_MESSAGE(CheckScene(scene).empty(), Errors(scene));
  World world(scene);
  for (int c = 0; c < 3; ++c) {
    const ClothView cloth = world.Cloth(c);
    const std::size_t count = cloth.positions().size();
    CHECK(count == static_cast<std::size_t>(VertexCount(scene.cloths[static_cast<std::size_t>(c)])));
    CHECK((cloth.rest().size() == count && cloth.uv().size() == count && cloth.velocities().size() == count));
    // Its lines are the edges of its triangles, each once: a disc has V - E + F = 1.
    CHECK(static_cast<int>(count) - static_cast<int>(cloth.springs().size()) +
              static_cast<int>(cloth.triangles().size()) ==
          1);
  }
  CHECK(world.Cloth(0).pinned()[1] == 7);
  REQUIRE(world.Cloth(1).pinned().size() == 2);
  CHECK((world.Cloth(1).pinned()[0] == 9 && world.Cloth(1).pinned()[1] == 20));
  const std::vector<Vec3> start(world.Cloth(1).rest().begin(), world.Cloth(1).rest().end());
  for (int frame = 0; frame < 30; ++frame) world.Step();
  CHECK_FALSE(world.report().divergence);
  const auto at = [&](std::size_t v) { return world.Cloth(1).positions()[v]; };
  CHECK(Length(at(9) - start[9] - Vec3{0, 0.25, 0}) < 1e-12);
  CHECK(at(20) == start[20]);
  CHECK(Length(at(100) - start[100]) > 0.01);

  WorldState state;
  world.Save(state);
  const std::uint64_t hash = world.StateHash();
  world.Step();
  world.Restore(state);
  CHECK(world.StateHash() == hash);
}

TEST_CASE("Each cloth shows where it started and its own triangles, whatever happens to it") {
  for (const Engine engine : {Engine::Springs, Engine::Fabric}) {
    CAPTURE(static_cast<int>(engine));
    Scene scene = Fabric(Shape::Grid);
    scene.simulation.engine = engine;
    scene.cloths.push_back(scene.cloths[0]);
    scene.cloths[1].numWidthPoints = 7;
    scene.cloths[1].origin.y += 1;
    if (engine == Engine::Fabric) scene.cloths.push_back(MeshScene().cloths[0]);
    World world(scene);
    const auto check = [&] {
      for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
        const RestMesh mesh = MakeClothMesh(scene.cloths[c]);
        const ClothView cloth = world.Cloth(static_cast<int>(c));
        CHECK(std::vector(cloth.rest().begin(), cloth.rest().end()) == mesh.positions);
        CHECK(std::vector(cloth.triangles().begin(), cloth.triangles().end()) == mesh.triangles);
      }
    };
    check();
    for (int frame = 0; frame < 3; ++frame) world.Step();
    check();
    scene.simulation.gravity.y = -5;
    CHECK(world.Apply(scene));
    world.Step();
    check();
    std::swap(scene.cloths[0], scene.cloths[1]);
    CHECK_FALSE(world.Apply(scene));
    check();
    CHECK(world.Cloth(0).positions()[3] == world.Cloth(0).rest()[3]);
    const World moved = std::move(world);
    CHECK(moved.Cloth(1).rest()[3] == MakeClothMesh(scene.cloths[1]).positions[3]);
  }
}

TEST_CASE("Lengths at rest are those of the flat fabric, wherever the cloth starts") {
  // A disc that starts half as large as it was cut.
  Scene scene = MeshScene();
  LoadedMesh shrunk = *scene.cloths[0].loaded;
  const RestMesh flat = shrunk.mesh;
  for (Vec3& p : shrunk.mesh.positions) p = 0.5 * p;
  scene.cloths[0].loaded = std::make_shared<const LoadedMesh>(shrunk);
  const World world(scene);
  const ClothView cloth = world.Cloth(0);
  REQUIRE(cloth.restLengths().size() == cloth.springs().size());
  for (std::size_t s = 0; s < cloth.springs().size(); ++s) {
    const auto [a, b] = cloth.springs()[s];
    const Vec3 way = flat.positions[static_cast<std::size_t>(a)] - flat.positions[static_cast<std::size_t>(b)];
    CHECK(cloth.restLengths()[s] == doctest::Approx(Length(way)));
  }
}

TEST_CASE("Points of a cloth have names, as files write them") {
  for (const Scene& scene : {Fabric(Shape::Grid), Fabric(Shape::Disc), MeshScene()}) {
    const ClothSettings& cloth = scene.cloths[0];
    for (std::int32_t v = 0; v < VertexCount(cloth); ++v) CHECK(VertexOf(cloth, PointOf(cloth, v)) == v);
    CHECK_FALSE(VertexOf(cloth, {-1, 0}));
    CHECK_FALSE(VertexOf(cloth, {1000, 0}));
    CHECK_FALSE(VertexOf(cloth, {0, 1000}));
  }
  CHECK_FALSE(VertexOf(MeshScene().cloths[0], {3, 0}));
  CHECK(PointOf(MeshScene().cloths[0], 3) == GridPoint{6, 0});
}

TEST_CASE("Cloths are placed by orientation, rotation and origin, which change no length") {
  for (Scene scene : {Fabric(Shape::Grid), Fabric(Shape::Disc), MeshScene()}) {
    ClothSettings& cloth = scene.cloths[0];
    const RestMesh before = MakeClothMesh(cloth);
    cloth.rotation = {30, -50, 120};
    cloth.origin = {1, 2, 3};
    const RestMesh after = MakeClothMesh(cloth);
    CHECK(after.material == before.material);
    Vec3 moved;
    for (const Triangle& t : before.triangles) {
      const auto side = [&](const RestMesh& mesh) {
        return Length(mesh.positions[static_cast<std::size_t>(t.b)] - mesh.positions[static_cast<std::size_t>(t.a)]);
      };
      REQUIRE(side(after) == doctest::Approx(side(before)).epsilon(1e-12));
    }
    const auto middle = [](const RestMesh& mesh) {
      Vec3 sum;
      for (const Vec3& p : mesh.positions) sum += p;
      return sum / static_cast<double>(mesh.positions.size());
    };
    CHECK(Length(middle(after) - middle(before) - Vec3{1, 2, 3}) < 1e-12);
    cloth.rotation = {0, 90, 0};
    cloth.origin = {};
    // About +y, x turns to -z.
    CHECK(MakeClothMesh(cloth).positions.back().x - middle(before).x ==
          doctest::Approx(before.positions.back().z - middle(before).z).epsilon(1e-12));
  }
  ClothSettings disc = Fabric(Shape::Disc).cloths[0];
  for (const Vec3& p : MakeClothMesh(disc).positions) CHECK(p.y == 1);
  disc.orientation = Orientation::Vertical;
  double top = 0;
  for (const Vec3& p : MakeClothMesh(disc).positions) {
    CHECK(std::abs(p.z) <= 1e-3);
    top = std::max(top, p.y);
  }
  CHECK(top > 1.4);
  CHECK(SizeOf(disc).extent == 1);
  CHECK(SizeOf(MeshScene().cloths[0]).area == doctest::Approx(SizeOf(disc).area * 0.64).epsilon(0.1));
}

TEST_CASE("Patches change the material where they lie, and several multiply") {
  for (const bool mesh : {false, true}) {
    Scene scene = mesh ? MeshScene() : Fabric(Shape::Grid);
    fabric::FabricModel plain = Model(scene);
    const double mass = Mass(plain);
    Patch patch;
    patch.stretch = 3, patch.bend = 100, patch.density = 2;
    scene.patches = {patch};
    fabric::FabricModel whole = Model(scene);
    CHECK(Mass(whole) == doctest::Approx(2 * mass));
    CHECK(whole.Buckling(20) == doctest::Approx(std::sqrt(100 * 2) / 3 * plain.Buckling(20)).epsilon(1e-9));
    if (mesh)
      patch.group = "middle";
    else
      patch.rectangle = {{7, 2}, {2, 6}};
    scene.patches = {patch};
    REQUIRE_MESSAGE(CheckScene(scene).empty(), Errors(scene));
    fabric::FabricModel model = Model(scene);
    double area = 0, inside = 0;
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      area += model.Rest(t).area;
      if (model.strength[t] == 3) inside += model.Rest(t).area;
    }
    const double share = inside / area;
    CHECK(Mass(model) == doctest::Approx((1 + share) * mass).epsilon(1e-9));
    CHECK(std::count(model.strength.begin(), model.strength.end(), 3) == (mesh ? 6 : 40));

    scene.patches = {patch, patch};
    model = Model(scene);
    CHECK(Mass(model) == doctest::Approx((1 + 3 * share) * mass).epsilon(1e-9));

    // Taken back, nothing is left of it.
    scene.patches.clear();
    fabric::TakeMaterials(scene, model);
    CHECK(model.mass == plain.mass);
    CHECK(model.strength == plain.strength);
    CHECK(model.stiffening == plain.stiffening);
    for (std::size_t t = 0; t < model.triangles.size(); ++t) CHECK(model.Buckling(t) == plain.Buckling(t));
  }
}

TEST_CASE("A patch acts on a running cloth: what is heavier hangs lower") {
  Scene scene = Fabric(Shape::Grid);
  scene.cloths[0].pinned = {{0, 0}, {10, 0}, {0, 8}, {10, 8}};
  World plain(scene), heavy(scene);
  Patch patch;
  patch.rectangle = {{3, 3}, {7, 5}};
  patch.density = 30;
  scene.patches = {patch};
  CHECK(heavy.Apply(scene));
  for (int frame = 0; frame < 60; ++frame) plain.Step(), heavy.Step();
  const std::size_t middle = 4 * 11 + 5;
  CHECK(heavy.Cloth(0).positions()[middle].y < plain.Cloth(0).positions()[middle].y - 0.005);
}

TEST_CASE("A patch of weaker weave stretches more") {
  Scene scene = Fabric(Shape::Grid);
  scene.cloths[0].orientation = Orientation::Vertical;
  for (int i = 0; i < 11; ++i) scene.cloths[0].pinned.push_back({i, 8});
  Patch patch;
  patch.stretch = 0.05;
  World plain(scene);
  scene.patches = {patch};
  World weak(scene);
  for (int frame = 0; frame < 90; ++frame) plain.Step(), weak.Step();
  // rho g h^2 / 2 over the stiffness, twenty times as much.
  const double hangs = plain.Cloth(0).rest()[5].y - plain.Cloth(0).positions()[5].y;
  CHECK(weak.Cloth(0).rest()[5].y - weak.Cloth(0).positions()[5].y == doctest::Approx(20 * hangs).epsilon(0.2));
}

TEST_CASE("Another mesh in the same file is another cloth") {
  const Scene scene = MeshScene();
  CHECK_FALSE(EffectOf(scene, MeshScene()));  // read again
  CHECK(EffectOf(scene, MeshScene(0.3)) == Effect::Rebuild);
  World world(scene);
  CHECK(world.Apply(MeshScene()));
  CHECK_FALSE(world.Apply(MeshScene(0.3)));
}

TEST_CASE("What a shape does not have is refused, with what it has") {
  const auto error = [](Scene scene, void (*change)(Scene&)) {
    change(scene);
    const Diagnostics found = CheckScene(scene);
    CHECK(HasErrors(found));
    return Format(found);
  };
  const auto check = [&](const Scene& scene, void (*change)(Scene&), const char* expected) {
    const std::string text = error(scene, change);
    CHECK_MESSAGE(Contains(text, expected), std::string(expected) << " in\n" << text);
  };
  const Scene grid = Fabric(Shape::Grid), disc = Fabric(Shape::Disc), mesh = MeshScene();
  for (const Scene& scene : {grid, disc, mesh}) CHECK_MESSAGE(CheckScene(scene).empty(), Errors(scene));
  check(
      disc, [](Scene& s) { s.simulation.engine = Engine::Springs; },
      "/cloth/0/shape: expected \"grid\", the one shape of the engine springs, got \"disc\"");
  check(
      disc,
      [](Scene& s) {
        s.cloths[0].pinned = {{127, 0}};
      },
      "/cloth/0/pinned/0: expected a vertex of the disc, from 0 to 126, got 127");
  check(
      disc,
      [](Scene& s) {
        s.cloths[0].pinned = {{1, 1}};
      },
      "got [1, 1]");
  check(
      disc, [](Scene& s) { s.cloths[0].pinnedGroup = "hem"; }, "/cloth/0/pinned_group: expected none");
  check(
      disc, [](Scene& s) { s.cloths[0].rings = 6000; }, "/cloth/0/rings: expected at most");
  check(
      mesh,
      [](Scene& s) {
        s.cloths[0].pinned = {{3, 0}};
      },
      "/cloth/0/pinned/0: expected a vertex of the mesh, from 0 to 252, that belongs to a triangle");
  check(
      mesh, [](Scene& s) { s.cloths[0].pinnedGroup = "midle"; }, "did you mean `middle`?");
  check(
      mesh, [](Scene& s) { s.cloths[0].mesh.clear(); }, "/cloth/0/mesh: expected the file of a mesh");
  check(
      mesh, [](Scene& s) { s.cloths[0].meshScale = 2; }, "/cloth/0/mesh: \"disc.obj\" is not loaded");
  check(
      mesh, [](Scene& s) { s.cloths[0].loaded.reset(); }, "/cloth/0/mesh: \"disc.obj\" is not loaded");
  check(
      mesh,
      [](Scene& s) {
        s.pinMotions = {{0, {{2, 0}}, 0, 1, {}}};
      },
      "/pin_motion/0/points: there is no pin");
  check(
      mesh,
      [](Scene& s) {
        s.cloths[0].pinnedGroup = "one";
        s.pinMotions = {{0, {{2, 0}}, 0, 1, {}}};
      },
      "/pin_motion/0/points/0: expected a pinned point of the cloth, got 2");
  check(
      mesh,
      [](Scene& s) {
        s.patches = {{0, "sleeve", {}}};
      },
      "/patch/0/group: expected a group of the mesh, got \"sleeve\"; it has \"middle\", \"one\"");
  check(
      mesh,
      [](Scene& s) {
        s.patches = {{0, "", {{0, 0}, {2, 0}}}};
      },
      "/patch/0/rectangle: expected none");
  check(
      mesh,
      [](Scene& s) {
        s.patches = {{1, "one", {}}};
      },
      "/patch/0/cloth: expected the index of a cloth");
  check(
      grid,
      [](Scene& s) {
        s.patches = {{0, "one", {}}};
      },
      "/patch/0/group: expected none");
  check(
      grid,
      [](Scene& s) {
        s.patches = {{0, "", {{0, 0}}}};
      },
      "/patch/0/rectangle: expected two opposite corners");
  check(
      grid,
      [](Scene& s) {
        s.patches = {{0, "", {{0, 0}, {0, 9}}}};
      },
      "/patch/0/rectangle/1: expected a point of the grid, from [0, 0] to [10, 8], got [0, 9]");
}

TEST_CASE("A scene of fabric may have colliders of any shape") {
  Scene scene = Fabric(Shape::Disc);
  scene.spheres.resize(1);
  scene.planes.resize(2);
  scene.colliders.resize(7);
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) scene.colliders[c].shape = static_cast<ColliderShape>(c);
  scene.colliderMotions.resize(2);
  scene.colliderMotions[1].collider = 6;
  CHECK(CheckScene(scene).empty());
  // As many as there were, and what they are, is built in; where they are is not.
  Scene moved = scene;
  moved.colliders[3].position.x = 5;
  moved.colliders[2].size.y = 1;
  moved.colliderMotions[0].angle = 5000;
  CHECK(EffectOf(scene, moved) == Effect::Live);
  moved.colliders[2].shape = ColliderShape::Cone;
  CHECK(EffectOf(scene, moved) == Effect::Rebuild);
  moved = scene;
  moved.colliders[0].color = {1, 0, 0};
  CHECK(EffectOf(scene, moved) == Effect::View);
}

TEST_CASE("Who states a centre does not want the collider's own, unless they say so") {
  Scene scene = Fabric(Shape::Disc);
  scene.colliders.resize(1);
  scene.colliderMotions.resize(1);
  REQUIRE(ApplyAssignment(scene, "collider_motion.centre=[0,1,0]").ok());
  CHECK_FALSE(scene.colliderMotions[0].ownCentre);
  REQUIRE(ApplyAssignment(scene, "collider_motion.own_centre=true").ok());
  CHECK(scene.colliderMotions[0].ownCentre);
  CHECK(scene.colliderMotions[0].centre == Vec3{0, 1, 0});
}

}  // namespace
}  // namespace percale
