#pragma once
/// \file
/// The incremental potential of one step of backward Euler: its minimum is where the cloth is at the end of the step
/// (Martin et al. 2011, "Example-based elastic materials", section 4; Kane et al. 2000).
///
///     E(y) = |y - x~|²_M / 2h² + membrane + bending + pressure + loads,   x~ = x + h v + h² g

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/executor.h"
#include "fabric/block_parts.h"
#include "fabric/contacts.h"
#include "fabric/energy/point_energy.h"
#include "fabric/fabric_model.h"
#include "fabric/kernels.h"
#include "fabric/system_matrix.h"
#include "fabric/triangle_window.h"
#include "fabric/vertex_scratch.h"
#include "percale/vec3.h"

namespace percale::fabric {

/// The settings of one step.
struct StepSettings {
  double h = 0;                        ///< Length [s].
  std::span<const Vec3> start;         ///< x, where the step begins [m].
  std::span<const Vec3> before;        ///< x - h v, where all was a step before [m].
  Vec3 fall;                           ///< h² g [m].
  std::span<const VertexLoad> loads;   ///< Per vertex; or nothing: none.
  std::span<const std::uint8_t> free;  ///< Per vertex: 0 for pins, whose gradient is zero.

  /// x~, where inertia and gravity alone would lead [m].
  Vec3 Predicted(std::size_t v) const { return start[v] + (start[v] - before[v]) + fall; }
};

class Objective {
 public:
  /// Both must outlive it. `pattern`: of the matrix to be filled, MakePattern of the model's triangles.
  Objective(const FabricModel& model, const BlockPattern& pattern, const Executor& executor,
            const Kernels& kernels = BestKernels());

  /// Follows changes of the model's materials. Allocates, as the other functions do not.
  void TakeMaterials();

  /// Rest angles other than the model's, per hinge; none: the model's. The span must stay.
  void SetFolds(std::span<const Fold> folds) { folds_ = folds; }

  /// Contacts from now on, or none.
  void SetContacts(Contacts* contacts) { contacts_ = contacts; }

  /// Takes over the settings of a step; their spans must stay.
  void Begin(const StepSettings& step);

  /// E(y) [J].
  double Energy(std::span<const Vec3> y);
  /// Its derivative [N]; zero at pins.
  void Gradient(std::span<const Vec3> y, std::span<Vec3> gradient);
  /// The same where Energy was asked for last, and the blocks of a second derivative with eigenvalues bounded from
  /// below as solver.md says. Decides anew which contacts are active and how friction acts: returns by how much E(y)
  /// changes with that [J].
  double GradientAndTangent(std::span<const Vec3> y, std::span<Vec3> gradient, SystemMatrix& matrix);

  /// Lent to whoever keeps the rules that it states.
  VertexScratch& scratch() { return scratch_; }

  /// Of membrane and bending alone [J].
  double ElasticEnergy(std::span<const Vec3> y);

  /// Of all triangles at y.
  MembraneStretch GreatestStretch(std::span<const Vec3> y);

 private:
  /// Triangles of one cloth that one chunk of a loop covers.
  struct Batch {
    std::int32_t cloth, begin, end;
  };

  double MembraneEnergy(std::span<const Vec3> y);
  double BendingEnergy(std::span<const Vec3> y);
  BendingMoments<double> Bend(int triangle) const;
  PointEnergy<double> Pull(const FabricTether& tether, std::span<const Vec3> y) const;
  double PlateEnergy(std::span<const Vec3> y);
  MembraneArgs Arguments(std::span<const Vec3> y, const Batch& batch);
  void EvaluateTriangles(std::span<const Vec3> y, bool withTangent, int begin, int end);
  void AddPressure(std::span<const Vec3> y, const MembraneArgs& to, double pressure);
  void EvaluateHinges(std::span<const Vec3> y, bool withGradient);
  void SumMoments(std::span<const Vec3> y);
  void AddTethers(std::span<const Vec3> y, std::span<Vec3> gradient) const;
  void Gather(std::span<const Vec3> y, std::span<Vec3> gradient, int begin, int end, const LiveTriangles& live);
  template <class Body>
  double Sum(int count, Body&& body);

  const FabricModel& model_;
  const BlockPattern& pattern_;
  const Executor& executor_;
  const Kernels& kernels_;
  StepSettings step_;
  std::span<const Fold> folds_;
  Contacts* contacts_ = nullptr;
  Slots parts_;
  std::vector<Batch> batches_;
  // Per triangle, as MembraneArgs has it:
  std::vector<double> startStrain_[3];
  // The same of those that are needed at once:
  TriangleWindow window_;
  std::vector<Vec3> triangleGradient_;
  RealVector triangleHessian_;
  // Per hinge, where any cloth bends by them:
  std::vector<double> startAngle_, angle_, moment_;
  std::vector<Hinge<double>> hinge_;
  VertexScratch scratch_;  // first: per vertex of a plate, the force where PlateEnergy was called last [N]
  std::vector<double> chunkSums_;
  std::vector<MembraneStretch> batchStretch_;
};

}  // namespace percale::fabric
