#pragma once
/// \file
/// Contact in the steps of the engine: which planes the potential of a step has, and how far all may go at its end.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/obstacles.h"
#include "collide/safe_move.h"
#include "collide/solid_path.h"
#include "collide/untangle.h"
#include "core/executor.h"
#include "fabric/contacts.h"
#include "fabric/fabric_model.h"
#include "fabric/vertex_scratch.h"
#include "percale/scene.h"

namespace percale::fabric {

class ContactStep {
 public:
  /// All but the scene must outlive it. `scratch` is fitted to all vertices, and must stay so.
  ContactStep(const Scene& scene, const FabricModel& model, const Executor& executor, VertexScratch& scratch);

  /// Whether Configure can take this scene, as its colliders have the same vertices.
  bool Fits(const Scene& scene) const { return obstacles_.Fit(scene); }
  /// Takes settings for the same cloths.
  void Configure(const Scene& scene);
  /// Forgets the past. Colliders are where they are at `time` [s].
  void Restart(const Scene& scene, double time);

  // A step, in this order.
  /// Leads colliders to where they are at `time` [s], the end of the step. Those that jump are there at once; returns
  /// how many.
  int MoveColliders(const Scene& scene, double time);
  /// Learns what is near: cloth came from `previous` to `start` in the last step.
  void Begin(std::span<const Vec3> previous, std::span<const Vec3> start);
  /// `firm`: they do not give way to the tension in cloth. Planes for cloth that is at `now` and that inertia would
  /// lead to `ahead`. `begin`: where the step began, which is before that in a second round.
  void FindPlanes(std::span<const Vec3> begin, std::span<const Vec3> now, std::span<const Vec3> ahead,
                  std::span<const std::uint8_t> free, double h, bool firm = false);
  /// From now on towards `end` as far as all can go: writes where to. Returns what it took. `mayGiveUp`: see SafeMove;
  /// then there is nothing to do but to Rewind.
  SafeMoveReport Move(std::span<const Vec3> now, std::span<Vec3> end, bool mayGiveUp = false);
  /// The step is to be begun again: colliders are where they were, and what touched is remembered.
  void Rewind();
  /// The step has ended at y.
  void End(std::span<const Vec3> y);

  /// Between two steps: from now towards `end` as far as all can go, colliders at rest.
  void MoveAside(std::span<const Vec3> now, std::span<Vec3> end);
  /// Pairs of an edge and a triangle that pass through each other, as was last looked: at a start, after a jump, and at
  /// the end of each step that began with some; of cloth that is apart none can become any.
  std::int64_t tangled() const { return untangler_ ? static_cast<std::int64_t>(untangler_->met().size()) : 0; }

  /// How many vertices of cloth are inside of solids, and how many of obstacles wait for cloth to make way: what is
  /// squeezed gives way to colliders, and they to it, but never cloth to cloth.
  std::int64_t CountSqueezed(std::span<const Vec3> y) const;

  /// What touches, and where the vertices of obstacles were a step ago, then where they are.
  void ReadState(std::vector<Touch>& touches, std::vector<Vec3>& obstacles) const;
  /// The same, set, after a Restart; obstacles of another number are left where they are.
  void WriteState(std::span<const Touch> touches, std::span<const Vec3> obstacles);

  /// Of what may touch, and the lists of what is near and of contacts.
  std::size_t MemoryBytes() const { return mesh_.MemoryBytes() + safeMove_.MemoryBytes() + contacts_.MemoryBytes(); }

  /// The greatest distance of contact of cloth [m].
  double distance() const { return distance_; }

  Contacts& contacts() { return contacts_; }
  const Contacts& contacts() const { return contacts_; }

 private:
  void Judge(std::span<const Vec3> cloth);
  void Disentangle();
  void FindRoundSurfaces();
  void JudgeLoneEdges(std::vector<Intersection>& met);
  bool NothingIsNear();

  const FabricModel& model_;
  const Executor& executor_;
  Obstacles obstacles_;
  std::vector<double> meanEdges_;  // per cloth, as MakeContactMesh has it
  ContactMesh mesh_;
  SafeMove safeMove_;
  Contacts contacts_;
  ContactDistances distances_;
  std::vector<ContactSurface> surfaces_;  // per body
  std::vector<SolidStep> solids_;
  std::vector<PlacedSolid> placed_;
  // Vertices of obstacles: a step ago, now, and where they are led.
  std::vector<Vec3> obstacleBefore_, obstacle_, obstacleTarget_;
  // Of the mesh, cloth and obstacles:
  std::vector<Vec3>&start_, &way_;  // in scratch
  std::vector<double> share_;
  // While something is tangled, or that is not known:
  std::optional<IntersectionJudge> judge_;
  std::optional<Untangler> untangler_;
  std::vector<Tangle> tangles_;
  bool judged_ = false;                 // Whether that is known.
  std::vector<SolidMeeting> meetings_;  // per vertex of cloth, of one solid; none without solids
  // Where Rewind leads back to.
  struct {
    std::vector<SolidStep> solids;
    std::vector<Vec3> obstacleBefore, obstacle;
    double time = 0;
  } rewound_;
  double time_ = 0;  // where colliders are led to [s]
  double distance_ = 0;
  bool listed_ = false;  // What is near is known.
  int moves_ = 0;        // Of this step.
};

}  // namespace percale::fabric
