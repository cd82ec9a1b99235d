#pragma once
/// \file
/// The classic engine: masses on a grid, springs, position Verlet, collisions point by point, and
/// Provot's limit on stretch (Provot 1995, "Deformation constraints in a mass-spring model to
/// describe rigid cloth behavior"). One instance holds all cloths of a scene.
///
/// The rules visit points and springs in creation order, and a later visit sees what an earlier one
/// moved. The stages keep that result to the bit without walking in that order:
///  - forces read positions only, so they are summed as the springs come by;
///  - boxes of the spatial map share no points, so they are independent;
///  - colliders act on each point alone;
///  - the strain limit walks in order, but only over springs near their limit or near a point that
///    moved far.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collide/box_map.h"
#include "core/aligned.h"
#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "mesh/engine_types.h"
#include "mesh/pins.h"
#include "percale/interaction.h"
#include "percale/scene.h"
#include "springs/kernels.h"

namespace percale::springs {

/// One cloth's part of the arrays.
struct Sheet {
  int numWidth = 0, numHeight = 0;
  int firstPoint = 0;
  AlignedVector<double> rest;  ///< Per kind and point that creates the spring [m]; kNoSpringRest where there is none.
  std::vector<float> nearSquared;   ///< Per kind and column, and infinity for kGridPad more: the least square of
                                    ///< lengths, measured in float, from which on such springs are near the strain
                                    ///< limit [m^2]; or infinity.
  float farthest = 0;               ///< Points up to so far from the first along each axis are measured in float [m].
  std::vector<std::uint8_t> kinds;  ///< Per point: a bit for each kind of spring that it creates; then zeros.
  std::vector<std::uint8_t> nearKinds;  ///< Per point: those that are near the strain limit; then zeros.
  std::vector<float> moved;             ///< Per point: how far the strain limit moved it [m].
  float moveBudget = 0;                 ///< How far a point may move before it concerns springs that were not near.
  double stiffness[kSpringKinds] = {};  ///< [N/m]; 0 for kinds that are not enabled.
  double mass = 0;                      ///< Of a point [kg].
  std::vector<double> masses;           ///< The same, for each.
  double keep = 1;                      ///< Share of the velocity kept in a step.
  int rowsPerChunk = 1;
  int firstChunk = 0;
  int PointCount() const { return numWidth * numHeight; }
  std::int64_t RestStride() const { return kGridPad + RoundUpToPad(PointCount()) + kGridPad; }  ///< From kind to kind.
  std::int64_t NearStride() const { return numWidth + kGridPad; }                               ///< Likewise.
  const double* Rest(int kind) const { return rest.data() + kind * RestStride() + kGridPad; }   ///< Of the first point.
  double* Rest(int kind) { return rest.data() + kind * RestStride() + kGridPad; }
};

class SpringsEngine {
 public:
  /// `models` are those of scene.cloths. `executor` must outlive the engine.
  SpringsEngine(const Scene& scene, std::span<const ClothModel> models, const Executor& executor,
                const Kernels& kernels);

  /// Takes the settings that may change while it runs. The grids must be the same.
  void Configure(const Scene& scene);
  /// Back to the start.
  void Reset();

  // One step, in this order.
  /// Puts pins where the scene's motions have them at `time` [s], the end of the step.
  void MoveColliders(double time);
  /// Forces and integration. Returns false when a coordinate went out of bounds.
  bool ApplyForces(double time, std::span<const Gust> gusts = {});
  /// Draws a vertex and the cloth around it to the handle's target; a pin is carried there alone.
  void Pull(const Handle& handle);
  /// Forces on the vertices of a cloth [N], in this step. After ApplyForces.
  void AddForces(int cloth, std::span<const Vec3> forces);
  void FindContacts();
  void SelfCollide();
  void Collide();
  /// Pushes cloth and ball apart, each by the other's share of their masses, and changes the ball's
  /// velocity by the way it was pushed, as Verlet's rule does with the points'. Momentum is kept, apart
  /// from pinned points, which a ball does not feel.
  void CollideBall(Ball& ball);
  void LimitStrain();

  /// Between two frames: puts a vertex at the handle's target, and the cloth around it along.
  void Place(const Handle& handle);

  /// What was done since the last call.
  EngineCounts TakeCounts() { return std::exchange(counts_, {}); }

  /// Copies a cloth's positions and those of one step ago [m]. Spans of the cloth's point count.
  void ReadState(int cloth, std::span<Vec3> positions, std::span<Vec3> previous) const;
  /// Where the pins of a cloth are held apart from their motions [m], by vertex.
  void ReadAnchors(int cloth, std::vector<Vec3>& anchors) const;
  /// Puts a cloth into the state that it has at `time` [s].
  void WriteState(int cloth, std::span<const Vec3> positions, std::span<const Vec3> previous,
                  std::span<const Vec3> anchors, double time);
  /// The longest of all springs, whatever kinds are enabled.
  Stretch GreatestStretch() const;
  /// Of all springs of the enabled kinds: half of stiffness times the square of what they are longer or
  /// shorter than at rest [J].
  double ElasticEnergy() const;
  std::span<const double> Masses(int cloth) const { return sheets_[static_cast<std::size_t>(cloth)].masses; }
  /// Where its points started [m]; stays valid as long as the engine.
  std::span<const Vec3> Start(int cloth) const;
  /// The first point with a coordinate out of bounds.
  VertexRef FindOutOfBounds() const;

 private:
  void AddSheet(const ClothModel& model);
  void UpdatePins();
  void Shift(int point, const Vec3& way, bool keepVelocity);
  void MovePatch(const Handle& handle, const Vec3& way, bool keepVelocity);
  void ForgetBoxes();
  void ComputeWind(double time, std::span<const Gust> gusts);
  void HoldPins(int begin, int end);
  std::int64_t HashKeys(int begin, int end);
  template <class Body>
  void ForRowChunks(Body&& body);
  template <class Body>
  void ForPointChunks(Body&& body);
  int PointChunks() const;
  std::int64_t SumChunkCounts(int chunks) const;

  const Executor& executor_;
  const Kernels& kernels_;
  Scene scene_;
  double dt_ = 0;
  double time_ = 0;  // of the last step [s]
  int pointCount_ = 0;
  int pointsPerChunk_ = 1;
  int chunkCount_ = 0;
  std::vector<Sheet> sheets_;
  std::vector<Vec3> start_;
  // One array per axis, with padding around, the axes one behind the other: positions, and positions one step ago.
  // They change places in every step.
  AlignedVector<double> positionStore_, previousStore_;
  std::int64_t axisStride_ = 0;
  double* positions_[3] = {};
  double* previous_[3] = {};
  AlignedVector<double> windForce_[3];
  Pins pins_;
  std::vector<int> firstPoint_;      // of each sheet
  std::vector<std::uint8_t> fixed_;  // per point
  std::vector<double> thickness_;    // per point [m]
  std::vector<std::uint64_t> boxKeys_;
  std::vector<std::uint64_t> boxPlaces_;  // where points are in their boxes, for HashFunction::Exact
  std::vector<std::int32_t> boxChanges_;  // points whose box changed: per chunk of points, from its first on
  std::vector<std::uint8_t> boxesWrap_;   // per chunk of points: whether box indices did not fit since the start
  bool mapBuilt_ = false;
  Vec3 boxSize_;
  double bound_ = 0;
  double greatestApart_ = 0;  // greatest sum of two thicknesses [m]
  bool sameThickness_ = true;
  std::vector<std::int32_t> touched_;  // of CollideBall
  BoxMap map_;
  int scratchPerChunk_ = 0;
  AlignedVector<double> integrateScratch_;  // per chunk of rows
  int markScratchPerChunk_ = 0;
  AlignedVector<float> markScratch_;       // likewise
  std::vector<std::int64_t> chunkCounts_;  // per chunk of any loop
  struct BucketChunk {
    std::int32_t bucketEnd, pointsBefore;
  };
  std::vector<BucketChunk> bucketChunks_;  // of SelfCollide
  std::vector<double> bucketScratch_;      // per point, padded
  EngineCounts counts_;
};

}  // namespace percale::springs
