#pragma once
/// \file
/// Contact in one step of the engine: which planes the potential has, and how far cloth may go afterwards.

#include <cstdint>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/safe_move.h"
#include "collide/solid_path.h"
#include "core/executor.h"
#include "fabric/contacts.h"
#include "fabric/fabric_model.h"
#include "percale/scene.h"

namespace percale::fabric {

class ContactStep {
 public:
  ContactStep(const Scene& scene, const FabricModel& model, const Executor& executor);

  /// Takes settings for the same cloths.
  void Configure(const Scene& scene);
  /// Forgets the past: positions are others than those that the last step left.
  void Clear();

  /// Puts colliders where they are at `time` [s], the end of the step.
  void MoveColliders(const Scene& scene, double time);
  /// Planes for a step from `start` that inertia would lead to `ahead`. `begin`: where the step began, which `start` is
  /// later than in a second round.
  void FindPlanes(std::span<const Vec3> begin, std::span<const Vec3> start, std::span<const Vec3> ahead,
                  std::span<const std::uint8_t> free, std::span<const double> mass, double h);
  /// From start towards end as far as all can go: writes where to `end`. Returns what it took.
  SafeMoveReport Move(std::span<const Vec3> start, std::span<Vec3> end);
  /// The step has ended at y.
  void End(std::span<const Vec3> y) { contacts_.End(y); }
  /// How many vertices are inside a solid: cloth that is squeezed yields to colliders, never to cloth.
  std::int64_t CountInside(std::span<const Vec3> y) const;

  Contacts& contacts() { return contacts_; }
  const ContactMesh& mesh() const { return mesh_; }

 private:
  ContactMesh mesh_;
  SafeMove safeMove_;
  Contacts contacts_;
  ContactDistances distances_;
  std::vector<ContactSurface> surfaces_;  // per body
  std::vector<SolidStep> solids_;
  std::vector<PlacedSolid> placed_;
  std::vector<Vec3> begin_, start_, way_;  // of the mesh
  std::vector<double> share_;
};

}  // namespace percale::fabric
