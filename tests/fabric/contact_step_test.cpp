#include "fabric/contact_step.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "fabric/newton.h"
#include "mesh/rest_mesh.h"
#include "tests/fabric/cotton_scene.h"

using namespace percale;
using namespace percale::fabric;

namespace {

/// Two sheets, one above the other, fall on a box, step by step as the engine does it; where they are then. `spoil`:
/// what lies in the memory that contact and solver share is overwritten wherever none of them is at work.
std::vector<Vec3> Fall(bool spoil) {
  Scene scene = test::CottonScene();
  scene.cloths[0].numWidthPoints = scene.cloths[0].numHeightPoints = 9;
  scene.cloths[0].pinned.clear();
  scene.cloths[0].orientation = Orientation::Horizontal;
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].origin.y += 0.02;
  std::vector<RestMesh> meshes;
  for (const ClothSettings& cloth : scene.cloths) meshes.push_back(MakeClothMesh(cloth));
  Vec3 middle;
  for (const Vec3& x : meshes[0].positions) middle += x * (1 / 81.0);
  ColliderSettings box;
  box.shape = ColliderShape::Box;
  box.position = middle - Vec3{0, 0.22, 0};
  scene.colliders = {box};

  const Executor executor(1);
  const FabricModel model = BuildModel(scene, meshes);
  NewtonSolver solver(model, executor);
  VertexScratch& scratch = solver.objective().scratch();
  ContactStep contact(scene, model, executor, scratch);
  solver.objective().SetContacts(&contact.contacts());
  const std::vector<std::uint8_t> free(model.start.size(), 1);
  const double h = 1.0 / 60;
  solver.SetUp(h, free);
  const auto forget = [&] {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::vector<Vec3>* vectors : {&scratch.first, &scratch.second}) {
      if (spoil) std::fill(vectors->begin(), vectors->end(), Vec3{nan, nan, nan});
    }
  };
  std::vector<Vec3> position = model.start, previous = position, ahead = position;
  std::size_t touched = 0;
  for (int step = 0; step < 12; ++step) {
    forget();
    contact.MoveColliders(scene, (step + 1) * h);
    contact.Begin(previous, position);
    forget();
    for (std::size_t v = 0; v < ahead.size(); ++v) ahead[v] = position[v] * 2 - previous[v];
    contact.FindPlanes(position, position, ahead, free, h);
    forget();
    touched = std::max(touched, contact.contacts().all().size());
    solver.objective().Begin(
        {.h = h, .start = position, .before = previous, .fall = Vec3{0, -9.8, 0} * (h * h), .loads = {}, .free = free});
    std::vector<Vec3> next = position;
    solver.Solve(next, solver.objective().Energy(next), {});
    forget();
    contact.Move(position, next);
    forget();
    contact.End(next);
    previous = position;
    position = next;
  }
  CHECK(scratch.first.size() == model.start.size() + 8);  // The box has a mesh.
  CHECK(touched > 100);
  return position;
}

}  // namespace

TEST_CASE("Nothing that contact and solver leave in the memory that they share matters to the other") {
  CHECK(Fall(true) == Fall(false));
}
