// A warmed-up solve does not allocate, refilling included, and neither does a step.

#include <doctest/doctest.h>

#include <algorithm>

#include "core/executor.h"
#include "fabric/conjugate_gradient.h"
#include "fabric/multigrid.h"
#include "fabric/prolongation.h"
#include "percale/fabrics.h"
#include "percale/world.h"
#include "tests/count_allocations.h"
#include "tests/fabric/sheet.h"

using namespace percale;
using namespace percale::fabric;
using namespace percale::test;

TEST_CASE("a solve does not allocate, not even the first; contacts do when there are more than ever before") {
  const Executor executor(1);
  const Sheet sheet = Square(50);
  const std::vector<ExtraTerm> many = RemotePairs(sheet, 400, 1000), few = RemotePairs(sheet, 300, 500);
  SystemMatrix matrix;
  Multigrid multigrid;
  ConjugateGradient gradient;
  matrix.SetUp(MakePattern(sheet.vertices(), sheet.triangles), ConstantPart(sheet, {}), sheet.pinned);
  multigrid.SetUp(matrix, MakeHierarchy(matrix.pattern(), sheet.Mesh(), sheet.pinned));
  gradient.SetUp(matrix.rows());
  const RealVector weight = Weight(sheet);
  RealVector b = weight, x(VectorLength(matrix.rows()), 0);
  const auto solve = [&](std::span<const ExtraTerm> contacts) {
    matrix.Reset(executor);
    matrix.SetExtra(contacts, executor);
    matrix.Finish(executor);
    multigrid.Refill(matrix, executor);
    std::copy(weight.begin(), weight.end(), b.begin());
    gradient.Solve(matrix, multigrid, b.data(), x.data(), {}, executor);
  };
  CHECK(CountAllocations([&] { solve({}); }) == 0);
  CHECK(CountAllocations([&] { solve(many); }) > 0);
  CHECK(CountAllocations([&] {
          solve(few);
          solve({});
          solve(many);
        }) == 0);
}

TEST_CASE("a warmed-up step on one thread does not allocate, whatever the laws") {
  for (const BendingLaw bending : {BendingLaw::Quadratic, BendingLaw::Hinges}) {
    for (const MembraneLaw membrane : {MembraneLaw::StVenantKirchhoff, MembraneLaw::NeoHookean}) {
      Scene scene;
      scene.simulation.engine = Engine::Fabric;
      ClothSettings& cloth = scene.cloths.emplace_back();
      SetFabric(cloth, Fabric::Cotton);
      cloth.numWidthPoints = cloth.numHeightPoints = 20;
      cloth.pinned = {{0, 0}};
      cloth.bendingLaw = bending;
      cloth.membraneLaw = membrane;
      cloth.pressure = 1;
      World world(scene, {.threads = 1});
      // Lists grow with what touches: so the second time, after the look at how cloth starts.
      WorldState start;
      world.Save(start);
      for (int frame = 0; frame < 30; ++frame) world.Step();
      world.Restore(start);
      world.Step();
      CHECK(CountAllocations([&] {
              for (int frame = 1; frame < 30; ++frame) world.Step();
            }) == 0);
      CHECK(!world.report().divergence);
    }
  }
}
