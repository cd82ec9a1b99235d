#pragma once
/// \file
/// The continuum engine: cloth as a sheet of measured stiffness on any triangle mesh, one step of backward Euler at a
/// time, each the minimum of an incremental potential.

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/executor.h"
#include "fabric/contact_step.h"
#include "fabric/energy/air.h"
#include "fabric/fabric_model.h"
#include "fabric/newton.h"
#include "fabric/triangle_window.h"
#include "mesh/engine_types.h"
#include "mesh/pins.h"
#include "percale/interaction.h"
#include "percale/mesh.h"
#include "percale/scene.h"

namespace percale::fabric {

class FabricEngine {
 public:
  /// `model`: of the scene, by BuildModel. The executor must outlive the engine.
  FabricEngine(const Scene& scene, FabricModel model, const Executor& executor);

  /// Takes settings for the same cloths; the state stays.
  void Configure(const Scene& scene);
  /// Back to the start.
  void Reset();

  // One step, in this order.
  /// Puts pins where the scene's motions have them at `time` [s], the end of the step.
  void MoveColliders(double time);
  /// Where inertia alone would lead, and what air and handles do. Returns false when a coordinate is out of bounds.
  bool ApplyForces(double time, std::span<const Gust> gusts, std::span<const Handle> handles);
  /// More forces on the vertices of a cloth [N], in this step. After ApplyForces.
  void AddForces(int cloth, std::span<const Vec3> forces);
  /// Where all forces balance.
  void Solve();
  /// Goes there, as far as nothing passes through anything. Where too much is stopped on its way the step is done over
  /// in parts.
  void Move();
  /// Pushes cloth and ball apart by their masses, momentum kept.
  void CollideBall(Ball& ball);

  /// Between two frames: puts a vertex at the handle's target, and the cloth around it along.
  void Place(const Handle& handle);

  /// What was done since the last call.
  EngineCounts TakeCounts();

  /// Copies a cloth's positions and those of one step ago [m]. Spans of the cloth's vertex count.
  void ReadState(int cloth, std::span<Vec3> positions, std::span<Vec3> previous) const;
  /// The folds of a cloth that may set, by hinge; none where none may.
  void ReadFolds(int cloth, std::vector<Fold>& folds) const;
  /// What touches, and where the vertices of colliders were and are.
  void ReadContact(std::vector<Touch>& touches, std::vector<Vec3>& obstacles) const {
    contact_->ReadState(touches, obstacles);
  }
  /// Where the pins of a cloth are held apart from their motions [m], by vertex.
  void ReadAnchors(int cloth, std::vector<Vec3>& anchors) const;
  /// Puts a cloth into the state that it has at `time` [s].
  void WriteState(int cloth, std::span<const Vec3> positions, std::span<const Vec3> previous,
                  std::span<const Vec3> anchors, double time);
  /// The same, set; none, or another number of them: all as they were made.
  void WriteFolds(int cloth, std::span<const Fold> folds);
  /// The same, set; after the state of all cloths.
  void WriteContact(std::span<const Touch> touches, std::span<const Vec3> obstacles) {
    contact_->WriteState(touches, obstacles);
  }
  /// The greatest stretch of a triangle: the larger singular value of its deformation gradient.
  Stretch GreatestStretch();
  double ElasticEnergy();                           ///< [J]
  std::span<const double> Masses(int cloth) const;  ///< Of its vertices [kg].
  /// Where its vertices started [m]; stays valid as long as the engine.
  std::span<const Vec3> Start(int cloth) const;
  /// Likewise its triangles, which name vertices by numbers over all cloths.
  std::span<const Triangle> Triangles(int cloth) const;
  /// The first vertex that is out of bounds, or that inertia leads there.
  VertexRef FindOutOfBounds() const;

 private:
  void SetUp();
  Vec3 Fall() const { return scene_.simulation.gravity * (h_ * h_); }
  Vec3 Predicted(std::size_t vertex) const;
  void BeginLoads();
  void ExchangeCloths(std::vector<Vec3>& other, double least);
  void Minimise(int iterations, double energy);
  bool TryMove(int depth);
  bool Rewind();
  bool StretchesSuddenly();
  void SplitStep(double from, double to, int depth);
  void UpdatePins();
  void StartFolds();
  void YieldFolds();
  void HoldPins();
  void Hold();
  void Blow(double time);
  std::span<VertexLoad> Loads();
  VertexRef RefOf(int vertex) const;

  const Executor& executor_;
  Scene scene_;
  FabricModel model_;
  NewtonSolver solver_;
  TriangleWindow window_;
  std::unique_ptr<ContactStep> contact_;
  double h_ = 0;     // of a step [s]
  double time_ = 0;  // of the last step [s]
  Pins pins_;
  std::vector<std::uint8_t> free_;  // per vertex
  std::vector<Vec3> position_, previous_;
  std::vector<Vec3> next_;
  bool inBounds_ = true;               // where ApplyForces led
  std::vector<Vec3> begin_, before_;   // Where the step, or the part of it, begins, and where all was one before.
  std::vector<Vec3> pinFrom_, pinTo_;  // per pin: where it is as the whole step begins, and as the part ends
  // What acts in the step:
  std::vector<Gust> gusts_;
  std::vector<Handle> handles_;
  std::vector<Vec3> given_;            // More forces [N]; none, or one per vertex.
  std::vector<VertexLoad> loads_;      // none in a step in which nothing loads
  std::vector<VertexLoad> windLoads_;  // of each corner of the triangles in the window; none without wind
  std::vector<std::int32_t> touched_;  // of CollideBall
  std::vector<Fold> folds_;            // per hinge; none where none may set
  EngineCounts counts_;
};

}  // namespace percale::fabric
