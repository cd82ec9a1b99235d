// Forces of contact: what cloth rests on carries it, and no friction is more than Coulomb allows.

#include "percale/contacts.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "percale/rest_mesh.h"
#include "tests/fabric/cotton_scene.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr double kGravity = 9.81;  // m/s²
constexpr double kFriction = 0.4;

/// So many sheets over each other on the plane y = 0, without air, in a world that is tilted: its slope falls along x.
Scene Slope(double tangent, int sheets = 1) {
  Scene scene = CottonScene();
  const double length = std::hypot(1, tangent);
  scene.simulation.gravity = Vec3{tangent, -1, 0} * (kGravity / length);
  scene.simulation.selfCollision = true;
  scene.wind.airDensity = 0;
  ClothSettings& sheet = scene.cloths[0];
  sheet.width = sheet.height = 0.2;
  sheet.numWidthPoints = sheet.numHeightPoints = 7;
  sheet.contactDistance = 0.01;
  sheet.friction = 0.8;
  scene.planes.push_back({.point = {}, .normal = {0, 1, 0}, .friction = kFriction});
  // A sheet lies at y = 1 where its origin is 0.
  scene.cloths.assign(static_cast<std::size_t>(sheets), sheet);
  for (int c = 0; c < sheets; ++c) scene.cloths[static_cast<std::size_t>(c)].origin = {0, 0.0097 * (c + 1) - 1, 0};
  return scene;
}

Vec3 Weight(const World& world, int cloth) {
  const ClothSettings& sheet = world.scene().cloths[static_cast<std::size_t>(cloth)];
  return world.scene().simulation.gravity * (sheet.density * sheet.width * sheet.height);
}

void CheckCoulomb(std::span<const ContactForce> contacts) {
  for (const ContactForce& contact : contacts) {
    CHECK(contact.force > 0);
    CHECK(Length(contact.normal) == doctest::Approx(1));
    CHECK(Length(contact.friction) <= contact.coefficient * contact.force * (1 + 1e-6));
  }
}

/// Of all on one cloth, whichever side of the contact it is.
Vec3 ForceOn(int cloth, std::span<const ContactForce> contacts) {
  Vec3 sum;
  for (const ContactForce& contact : contacts) {
    if (contact.cloth == cloth) sum += contact.Total();
    if (contact.otherCloth == cloth) sum -= contact.Total();
  }
  return sum;
}

}  // namespace

TEST_CASE("what cloth rests on carries its weight, and holds it on a slope") {
  World world(Slope(0.25));
  Run(world, 120);
  const std::vector<ContactForce> contacts = ReadContacts(world);
  REQUIRE(contacts.size() == 49);
  CheckCoulomb(contacts);
  for (const ContactForce& contact : contacts) {
    CHECK(contact.normal == Vec3{0, 1, 0});
    CHECK(contact.coefficient == kFriction);
    CHECK(contact.otherCloth == -1);
    CHECK_FALSE(contact.slides);
    CHECK(contact.point.y == doctest::Approx(0.5 * world.Cloth(0).positions()[std::size_t(contact.vertex)].y));
  }
  CHECK(Length(ForceOn(0, contacts) + Weight(world, 0)) < 0.02 * Length(Weight(world, 0)));
}

TEST_CASE("where cloth slides, friction is all that there can be, and brakes") {
  World world(Slope(0.8));
  Run(world, 60);
  const std::vector<ContactForce> contacts = ReadContacts(world);
  REQUIRE(!contacts.empty());
  CheckCoulomb(contacts);
  double normal = 0, brake = 0;
  for (const ContactForce& contact : contacts) {
    CHECK(contact.slides);
    normal += contact.force;
    brake -= contact.friction.x;
  }
  CHECK(brake == doctest::Approx(kFriction * normal).epsilon(0.001));
  CHECK(normal == doctest::Approx(-Weight(world, 0).y).epsilon(0.05));
}

TEST_CASE("each of two sheets is carried by what is below it") {
  World world(Slope(0.1, 2));
  Run(world, 180);
  const std::vector<ContactForce> contacts = ReadContacts(world);
  CheckCoulomb(contacts);
  for (const ContactForce& contact : contacts) {
    if (contact.otherCloth < 0) continue;
    CHECK(contact.cloth != contact.otherCloth);
    CHECK(contact.coefficient == doctest::Approx(0.8));
    CHECK(contact.normal.y * (contact.cloth == 1 ? 1 : -1) > 0.9);
  }
  CHECK(Length(ForceOn(1, contacts) + Weight(world, 1)) < 0.05 * Length(Weight(world, 1)));
  CHECK(Length(ForceOn(0, contacts) + Weight(world, 0)) < 0.05 * Length(Weight(world, 1)));
}

TEST_CASE("a mesh carries cloth as a plane does, and a saved state tells the same") {
  Scene scene = Slope(0.25);
  scene.planes.clear();
  ColliderSettings table;
  table.shape = ColliderShape::Mesh;
  table.friction = 0.7;
  table.position = {0.1, 0, 0.1};
  LoadedMesh mesh;
  mesh.mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  mesh.mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  mesh.openEdges = 4;
  table.loaded = std::make_shared<const LoadedMesh>(std::move(mesh));
  table.twoSided = true;
  scene.colliders.push_back(table);
  World world(scene);
  Run(world, 120);
  const std::vector<ContactForce> contacts = ReadContacts(world);
  CheckCoulomb(contacts);
  for (const ContactForce& contact : contacts) {
    CHECK(contact.coefficient == 0.7);
    CHECK(contact.otherCloth == -1);
    CHECK(contact.normal.y > 0.99);
  }
  CHECK(Length(ForceOn(0, contacts) + Weight(world, 0)) < 0.03 * Length(Weight(world, 0)));

  WorldState state;
  world.Save(state);
  CHECK(ReadContacts(state).size() == contacts.size());
  world.Step();
  world.Restore(state);
  const std::vector<ContactForce> again = ReadContacts(world);
  REQUIRE(again.size() == contacts.size());
  for (std::size_t c = 0; c < again.size(); ++c) {
    CHECK(again[c].point == contacts[c].point);
    CHECK(again[c].Total() == contacts[c].Total());
  }
}

TEST_CASE("what touches nothing has no forces of contact, nor have springs") {
  CHECK(ReadContacts(World(Slope(0))).empty());  // before the first step
  Scene scene = Slope(0);
  scene.planes.clear();
  World falling(scene);
  Run(falling, 5);
  CHECK(ReadContacts(falling).empty());
  World springs(CourseScene("sphere", 12));
  Run(springs, 120);
  CHECK(ReadContacts(springs).empty());
}
