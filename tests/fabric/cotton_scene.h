#pragma once
/// \file
/// A scene of the fabric engine as files have it.

#include "percale/fabrics.h"
#include "percale/scene.h"

namespace percale::test {

/// One cloth of cotton, 60 frames of one step per second.
inline Scene CottonScene() {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  SetFabric(scene.cloths.emplace_back(), Fabric::Cotton);
  return scene;
}

}  // namespace percale::test
