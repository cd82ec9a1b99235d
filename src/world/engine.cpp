#include "world/engine.h"

#include "springs/springs_engine.h"

namespace percale {
namespace {

using springs::SpringsEngine;

SpringsEngine& Self(void* engine) {
  return *static_cast<SpringsEngine*>(engine);
}
const SpringsEngine& Self(const void* engine) {
  return *static_cast<const SpringsEngine*>(engine);
}

constexpr EngineTable kSprings = {
    .name = "springs",
    .create = [](const Scene& scene, std::span<const ClothModel> models,
                 const Executor& executor) -> std::shared_ptr<void> {
      return std::make_shared<SpringsEngine>(scene, models, executor, springs::BestKernels());
    },
    .configure = [](void* e, const Scene& scene) { Self(e).Configure(scene); },
    .reset = [](void* e) { Self(e).Reset(); },
    .moveColliders = [](void* e, double time) { Self(e).MoveColliders(time); },
    .applyForces = [](void* e, double time, std::span<const Gust> gusts) { return Self(e).ApplyForces(time, gusts); },
    .pull = [](void* e, const Handle& handle) { Self(e).Pull(handle); },
    .findContacts = [](void* e) { Self(e).FindContacts(); },
    .selfCollide = [](void* e) { Self(e).SelfCollide(); },
    .collide = [](void* e) { Self(e).Collide(); },
    .collideBall = [](void* e, Ball& ball) { Self(e).CollideBall(ball); },
    .limitStrain = [](void* e) { Self(e).LimitStrain(); },
    .place = [](void* e, const Handle& handle) { Self(e).Place(handle); },
    .readState = [](const void* e, int cloth, std::span<Vec3> positions,
                    std::span<Vec3> previous) { Self(e).ReadState(cloth, positions, previous); },
    .readAnchors = [](const void* e, int cloth, std::vector<Vec3>& anchors) { Self(e).ReadAnchors(cloth, anchors); },
    .writeState = [](void* e, int cloth, const WorldState::Cloth& state,
                     double time) { Self(e).WriteState(cloth, state.positions, state.previous, state.anchors, time); },
    .greatestStretch = [](const void* e) { return Self(e).GreatestStretch(); },
    .elasticEnergy = [](const void* e) { return Self(e).ElasticEnergy(); },
    .mass = [](const void* e, int cloth) { return Self(e).Mass(cloth); },
    .findOutOfBounds = [](const void* e) { return Self(e).FindOutOfBounds(); },
    .takeCounts = [](void* e) { return Self(e).TakeCounts(); },
};

}  // namespace

const EngineTable& FindEngine(Engine engine) {
  switch (engine) {
    case Engine::Springs:
      break;
  }
  return kSprings;
}

}  // namespace percale
