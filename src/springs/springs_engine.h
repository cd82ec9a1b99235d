#pragma once
/// \file
/// The classic engine: masses on a grid, springs, position Verlet, collisions point by point, and
/// Provot's limit on stretch (Provot 1995, "Deformation constraints in a mass-spring model to
/// describe rigid cloth behavior"). One instance holds all cloths of a scene.
///
/// The rules visit points and springs in creation order, and a later visit sees what an earlier one
/// moved. The stages keep that result to the bit without walking in that order:
///  - forces read positions only, so points gather them row by row;
///  - boxes of the spatial map share no points, so they are independent;
///  - colliders act on each point alone;
///  - the strain limit walks in order, but only over springs that are too long or were touched.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collide/box_map.h"
#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "mesh/engine_types.h"
#include "percale/scene.h"
#include "springs/kernels.h"

namespace percale::springs {

/// A spring that touches the ends of a spring and comes after it: the point that creates it,
/// relative to the creator of the first, and the bit of its kind.
struct LaterSpring {
  int creator;
  std::uint8_t kindBit;
};

/// One cloth's part of the arrays.
struct Sheet {
  int numWidth = 0, numHeight = 0;
  int firstPoint = 0;
  std::vector<double>
      rest[kSpringKinds];           ///< Per point that creates the spring [m]; kNoSpringRest where there is none.
  std::vector<std::uint8_t> kinds;  ///< Per point: a bit for each kind of spring that it creates; then zeros.
  int step[kSpringKinds] = {};      ///< From the index of the creator to that of the other end.
  std::vector<LaterSpring> laterSprings[kSpringKinds];  ///< Of a spring of each kind.
  double stiffness[kSpringKinds] = {};                  ///< [N/m]; 0 for kinds that are not enabled.
  double mass = 0;                                      ///< Of a point [kg].
  double keep = 1;                                      ///< Share of the velocity kept in a step.
  int rowsPerChunk = 1;
  int firstChunk = 0;
  int PointCount() const { return numWidth * numHeight; }
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
  bool ApplyForces(double time);
  void FindContacts();
  void SelfCollide();
  void Collide();
  void LimitStrain();

  /// What was done since the last call.
  EngineCounts TakeCounts() { return std::exchange(counts_, {}); }

  /// Copies a cloth's positions and those of one step ago [m]. Spans of the cloth's point count.
  void ReadState(int cloth, std::span<Vec3> positions, std::span<Vec3> previous) const;
  /// The longest of all springs, whatever kinds are enabled.
  Stretch GreatestStretch() const;
  double Mass(int cloth) const { return sheets_[static_cast<std::size_t>(cloth)].mass; }
  /// The first point with a coordinate out of bounds.
  VertexRef FindOutOfBounds() const;

 private:
  struct PinnedPoint {
    int point;
    Vec3 start;                    // where it is without motions
    Vec3 target;                   // where it is now
    Vec3 previousTarget;           // where it was one step ago
    int firstMotion, motionCount;  // in pinMotionOf_
  };

  void AddSheet(const ClothModel& model);
  void ComputeWind(double time);
  void HoldPins(int begin, int end);
  void LimitSheet(const Sheet& sheet);
  template <class Body>
  void ForRowChunks(Body&& body);
  template <class Body>
  void ForPointChunks(Body&& body);
  std::int64_t SumChunkCounts(int chunks) const;

  const Executor& executor_;
  const Kernels& kernels_;
  Scene scene_;
  double dt_ = 0;
  int pointCount_ = 0;
  int chunkCount_ = 0;
  std::vector<Sheet> sheets_;
  std::vector<Vec3> start_;
  // One array per axis, with padding around: positions, and positions one step ago. They change
  // places in every step.
  std::vector<double> positionStore_[3], previousStore_[3];
  double* positions_[3] = {};
  double* previous_[3] = {};
  std::vector<double> windForce_[3];
  std::vector<PinnedPoint> pins_;        // by point, ascending
  std::vector<int> pinMotionOf_;         // indices into scene_.pinMotions
  std::vector<std::uint8_t> fixed_;      // per point
  std::vector<double> thickness_;        // per point [m]
  std::vector<std::uint8_t> longKinds_;  // per point: springs that the strain limit has to visit
  std::vector<std::uint64_t> boxKeys_;
  double boxSize_[3] = {};
  double bound_ = 0;
  double greatestApart_ = 0;
  BoxMap map_;
  int scratchPerChunk_ = 0;
  std::vector<double> integrateScratch_;       // per chunk of rows
  std::vector<std::int64_t> chunkCounts_;      // per chunk of any loop
  std::vector<std::int32_t> bucketChunkEnds_;  // last bucket of each chunk of SelfCollide
  std::vector<double> bucketScratch_;          // per point, padded
  EngineCounts counts_;
};

}  // namespace percale::springs
