// The engine as a whole, run through a World.

#include <doctest/doctest.h>

#include <cstdint>
#include <optional>

#include "percale/fabrics.h"
#include "percale/world.h"
#include "tests/sanitized.h"

using namespace percale;

TEST_CASE("the same bits for any number of threads, whatever the laws") {
  for (const BendingLaw bending : {BendingLaw::Quadratic, BendingLaw::Hinges}) {
    for (const MembraneLaw membrane : {MembraneLaw::StVenantKirchhoff, MembraneLaw::NeoHookean}) {
      const bool simple = bending == BendingLaw::Quadratic, linear = membrane == MembraneLaw::StVenantKirchhoff;
      if (test::kSanitized && simple != linear) continue;
      Scene scene;
      scene.simulation.engine = Engine::Fabric;
      scene.simulation.framesPerSecond = 60;
      scene.simulation.stepsPerFrame = 2;
      scene.wind.velocity = {1, 0.2, 2};
      for (const int points : {37, 31}) {  // triangles that end amid chunks and lanes
        ClothSettings& cloth = scene.cloths.emplace_back();
        SetFabric(cloth, Fabric::Cotton);
        cloth.numWidthPoints = points, cloth.numHeightPoints = 41;
        cloth.pinned = {{0, 0}, {points - 1, 0}};
        cloth.bendingLaw = bending;
        cloth.membraneLaw = membrane;
        cloth.pressure = 2;
      }
      std::optional<std::uint64_t> first;
      for (const int threads : {1, 2, 3, 8}) {
        if (test::kSanitized && threads != 1 && threads != 3) continue;
        World world(scene, {.threads = threads});
        for (int frame = 0; frame < test::Frames(6); ++frame) REQUIRE(!world.Step().divergence);
        if (!first) first = world.StateHash();
        CHECK(world.StateHash() == *first);
      }
    }
  }
}
