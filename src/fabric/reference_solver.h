#pragma once
/// \file
/// The judge of the fast solver: the same incremental potential in plain loops and doubles, its minimum by Newton's
/// method with a sparse direct solve, to a tolerance. Slow, and sharing with the fast solver nothing but the energies
/// of single elements.

#include <memory>
#include <span>
#include <vector>

#include "fabric/energy/air.h"
#include "fabric/fabric_model.h"
#include "fabric/objective.h"

namespace percale::fabric {

struct ReferenceSettings {
  int maxIterations = 120;   ///< >= 1.
  double tolerance = 1e-10;  ///< Done when no vertex would move farther than that [m], > 0.
};

struct ReferenceResult {
  int iterations = 0;
  double residual = 0;     ///< The longest way of a vertex in the last correction [m].
  bool converged = false;  ///< That is at most the tolerance.
};

class ReferenceSolver {
 public:
  /// The model must outlive it.
  explicit ReferenceSolver(const FabricModel& model);
  ~ReferenceSolver();

  /// Takes over the settings of a step; their spans must stay.
  void Begin(const StepSettings& step);
  /// E(y) [J], its derivative [N], zero at pins.
  double Energy(std::span<const Vec3> y) const;
  void Gradient(std::span<const Vec3> y, std::span<Vec3> gradient) const;
  /// Goes from y to the minimum that lies downhill.
  ReferenceResult Solve(std::span<Vec3> y, const ReferenceSettings& settings = {});
  /// The smallest eigenvalue of the second derivative is above zero: y is stable. Leaves inertia out where the step
  /// says so, h = 0.
  bool IsStable(std::span<const Vec3> y);

 private:
  struct Matrix;
  template <class Add>
  void Evaluate(std::span<const Vec3> y, double* energy, std::span<Vec3> gradient, double floorShare,
                Add* addBlock) const;
  bool Factor(std::span<const Vec3> y, double floorShare);

  const FabricModel& model_;
  StepSettings step_;
  std::vector<MembraneStrain<double>> startStrain_;  // per triangle
  std::vector<double> startAngle_;                   // per hinge
  std::unique_ptr<Matrix> matrix_;
};

}  // namespace percale::fabric
