#include "world/engine.h"

#include "fabric/fabric_engine.h"
#include "mesh/rest_mesh.h"
#include "springs/springs_engine.h"

namespace percale {
namespace {

using fabric::FabricEngine;
using springs::SpringsEngine;

// What both engines do alike.
template <class E>
E& Self(void* engine) {
  return *static_cast<E*>(engine);
}
template <class E>
const E& Self(const void* engine) {
  return *static_cast<const E*>(engine);
}
template <class E>
constexpr EngineTable CommonTable() {
  EngineTable table;
  table.configure = [](void* e, const Scene& scene) { Self<E>(e).Configure(scene); };
  table.reset = [](void* e) { Self<E>(e).Reset(); };
  table.moveColliders = [](void* e, double time) { Self<E>(e).MoveColliders(time); };
  table.addForces = [](void* e, int cloth, std::span<const Vec3> forces) { Self<E>(e).AddForces(cloth, forces); };
  table.collideBall = [](void* e, Ball& ball) { Self<E>(e).CollideBall(ball); };
  table.place = [](void* e, const Handle& handle) { Self<E>(e).Place(handle); };
  table.readState = [](const void* e, int cloth, std::span<Vec3> positions, std::span<Vec3> previous) {
    Self<E>(e).ReadState(cloth, positions, previous);
  };
  table.readAnchors = [](const void* e, int cloth, std::vector<Vec3>& anchors) {
    Self<E>(e).ReadAnchors(cloth, anchors);
  };
  table.writeState = [](void* e, int cloth, const WorldState::Cloth& state, double time) {
    Self<E>(e).WriteState(cloth, state.positions, state.previous, state.anchors, time);
  };
  table.greatestStretch = [](void* e) { return Self<E>(e).GreatestStretch(); };
  table.elasticEnergy = [](void* e) { return Self<E>(e).ElasticEnergy(); };
  table.masses = [](const void* e, int cloth) { return Self<E>(e).Masses(cloth); };
  table.start = [](const void* e, int cloth) { return Self<E>(e).Start(cloth); };
  table.findOutOfBounds = [](const void* e) { return Self<E>(e).FindOutOfBounds(); };
  table.takeCounts = [](void* e) { return Self<E>(e).TakeCounts(); };
  return table;
}

constexpr EngineTable SpringsTable() {
  EngineTable table = CommonTable<SpringsEngine>();
  table.name = "springs";
  table.create = [](const Scene& scene, std::span<const ClothModel> models,
                    const Executor& executor) -> std::shared_ptr<void> {
    return std::make_shared<SpringsEngine>(scene, models, executor, springs::BestKernels());
  };
  table.applyForces = [](void* e, double time, std::span<const Gust> gusts, std::span<const Handle> handles) {
    const bool inBounds = Self<SpringsEngine>(e).ApplyForces(time, gusts);
    for (const Handle& handle : handles) Self<SpringsEngine>(e).Pull(handle);
    return inBounds;
  };
  table.findContacts = [](void* e) { Self<SpringsEngine>(e).FindContacts(); };
  table.selfCollide = [](void* e) { Self<SpringsEngine>(e).SelfCollide(); };
  table.collide = [](void* e) { Self<SpringsEngine>(e).Collide(); };
  table.limitStrain = [](void* e) { Self<SpringsEngine>(e).LimitStrain(); };
  return table;
}

/// In a function of its own, so that the meshes are gone when the solver is built.
fabric::FabricModel BuildFabric(const Scene& scene) {
  std::vector<RestMesh> meshes;
  for (const ClothSettings& cloth : scene.cloths) meshes.push_back(MakeClothMesh(cloth));
  return fabric::BuildModel(scene, meshes);
}

constexpr EngineTable FabricTable() {
  EngineTable table = CommonTable<FabricEngine>();
  table.name = "fabric";
  table.create = [](const Scene& scene, std::span<const ClothModel>,
                    const Executor& executor) -> std::shared_ptr<void> {
    return std::make_shared<FabricEngine>(scene, BuildFabric(scene), executor);
  };
  table.applyForces = [](void* e, double time, std::span<const Gust> gusts, std::span<const Handle> handles) {
    return Self<FabricEngine>(e).ApplyForces(time, gusts, handles);
  };
  table.solve = [](void* e) { Self<FabricEngine>(e).Solve(); };
  table.selfCollide = [](void* e) { Self<FabricEngine>(e).Move(); };
  table.triangles = [](const void* e, int cloth) { return Self<FabricEngine>(e).Triangles(cloth); };
  table.readFolds = [](const void* e, int cloth, std::vector<Fold>& folds) {
    Self<FabricEngine>(e).ReadFolds(cloth, folds);
  };
  table.readContact = [](const void* e, std::vector<Touch>& touches, std::vector<Vec3>& obstacles) {
    Self<FabricEngine>(e).ReadContact(touches, obstacles);
  };
  table.writeContact = [](void* e, std::span<const Touch> touches, std::span<const Vec3> obstacles) {
    Self<FabricEngine>(e).WriteContact(touches, obstacles);
  };
  table.writeState = [](void* e, int cloth, const WorldState::Cloth& state, double time) {
    Self<FabricEngine>(e).WriteState(cloth, state.positions, state.previous, state.anchors, time);
    Self<FabricEngine>(e).WriteFolds(cloth, state.folds);
  };
  return table;
}

constexpr EngineTable kSpringsTable = SpringsTable(), kFabricTable = FabricTable();

}  // namespace

const EngineTable& FindEngine(Engine engine) {
  return engine == Engine::Fabric ? kFabricTable : kSpringsTable;
}

}  // namespace percale
