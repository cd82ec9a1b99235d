#pragma once
/// \file
/// What World knows of an engine: a table of its functions. The stages bear the names of
/// percale::Stage; an engine that has nothing to do in one leaves it empty.

#include <memory>
#include <span>
#include <string_view>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "mesh/engine_types.h"
#include "percale/interaction.h"
#include "percale/scene.h"
#include "percale/world.h"

namespace percale {

struct EngineTable {
  std::string_view name;
  std::shared_ptr<void> (*create)(const Scene&, std::span<const ClothModel>, const Executor&) = nullptr;
  void (*configure)(void*, const Scene&) = nullptr;
  void (*reset)(void*) = nullptr;

  // The stages of one step that ends at `time` [s].
  void (*moveColliders)(void*, double time) = nullptr;
  /// False: a coordinate went out of bounds.
  bool (*applyForces)(void*, double time, std::span<const Gust>, std::span<const Handle>) = nullptr;
  /// More forces [N] on the vertices of a cloth in this step. After applyForces.
  void (*addForces)(void*, int cloth, std::span<const Vec3> forces) = nullptr;
  void (*solve)(void*) = [](void*) {};
  void (*findContacts)(void*) = [](void*) {};
  void (*selfCollide)(void*) = [](void*) {};
  void (*collide)(void*) = [](void*) {};
  void (*collideBall)(void*, Ball&) = nullptr;  ///< Part of collide: cloth and ball push each other apart.
  void (*limitStrain)(void*) = [](void*) {};

  void (*place)(void*, const Handle&) = nullptr;  ///< Between two frames: see World::Place.

  // What a frame leaves behind.
  void (*readState)(const void*, int cloth, std::span<Vec3> positions, std::span<Vec3> previous) = nullptr;
  void (*readAnchors)(const void*, int cloth, std::vector<Vec3>& anchors) = nullptr;  ///< Of the pins, see WorldState.
  void (*readFolds)(const void*, int cloth, std::vector<Fold>& folds) = [](const void*, int, std::vector<Fold>& folds) {
    folds.clear();
  };
  /// What touches, and where the vertices of colliders are: see WorldState.
  void (*readContact)(const void*, std::vector<Touch>& touches, std::vector<Vec3>& obstacles) =
      [](const void*, std::vector<Touch>& touches, std::vector<Vec3>& obstacles) {
        touches.clear();
        obstacles.clear();
      };
  /// The same, set; after the state of all cloths.
  void (*writeContact)(void*, std::span<const Touch> touches,
                       std::span<const Vec3> obstacles) = [](void*, std::span<const Touch>, std::span<const Vec3>) {};
  /// The state of one cloth at `time` [s], which may be that of another World with the same cloths.
  void (*writeState)(void*, int cloth, const WorldState::Cloth&, double time) = nullptr;
  Stretch (*greatestStretch)(void*) = nullptr;
  double (*elasticEnergy)(void*) = nullptr;                             ///< [J]
  std::span<const double> (*masses)(const void*, int cloth) = nullptr;  ///< Of its vertices [kg].
  /// Where a cloth's vertices started [m]. The span stays valid as long as the engine's state.
  std::span<const Vec3> (*start)(const void*, int cloth) = nullptr;
  /// Likewise the cloth's triangles, by numbers of vertices over all cloths; none where the engine has no use for them.
  std::span<const Triangle> (*triangles)(const void*, int cloth) = [](const void*, int) {
    return std::span<const Triangle>();
  };
  VertexRef (*findOutOfBounds)(const void*) = nullptr;
  EngineCounts (*takeCounts)(void*) = nullptr;  ///< Since the last call.
};

const EngineTable& FindEngine(Engine engine);

}  // namespace percale
