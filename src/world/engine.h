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
  std::shared_ptr<void> (*create)(const Scene&, std::span<const ClothModel>, const Executor&);
  void (*configure)(void*, const Scene&);
  void (*reset)(void*);

  // The stages of one step that ends at `time` [s].
  void (*moveColliders)(void*, double time);
  bool (*applyForces)(void*, double time, std::span<const Gust>);  ///< False: a coordinate went out of bounds.
  void (*pull)(void*, const Handle&);                              ///< Part of applyForces.
  void (*findContacts)(void*);
  void (*selfCollide)(void*);
  void (*collide)(void*);
  void (*collideBall)(void*, Ball&);  ///< Part of collide: cloth and ball push each other apart.
  void (*limitStrain)(void*);

  void (*place)(void*, const Handle&);  ///< Between two frames: see World::Place.

  // What a frame leaves behind.
  void (*readState)(const void*, int cloth, std::span<Vec3> positions, std::span<Vec3> previous);
  void (*readAnchors)(const void*, int cloth, std::vector<Vec3>& anchors);  ///< Of the pins, see WorldState.
  /// The state of one cloth at `time` [s], which may be that of another World with the same cloths.
  void (*writeState)(void*, int cloth, const WorldState::Cloth&, double time);
  Stretch (*greatestStretch)(const void*);
  double (*elasticEnergy)(const void*);    ///< [J]
  double (*mass)(const void*, int cloth);  ///< Of one point [kg].
  VertexRef (*findOutOfBounds)(const void*);
  EngineCounts (*takeCounts)(void*);  ///< Since the last call.
};

const EngineTable& FindEngine(Engine engine);

}  // namespace percale
