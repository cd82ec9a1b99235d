#pragma once
/// \file
/// The solver that keeps up with real time: Newton's method on the incremental potential, its linear systems by
/// conjugate gradients with multigrid, each step checked against the energy. docs/solver.md says why this one.

#include <array>
#include <span>
#include <vector>

#include "core/executor.h"
#include "fabric/conjugate_gradient.h"
#include "fabric/multigrid.h"
#include "fabric/objective.h"

namespace percale::fabric {

struct NewtonSettings {
  int maxIterations = 4;  ///< >= 1.
  /// In each of those, >= 1; and those that are left of all, where the correction before gained what was foretold.
  int maxLinearIterations = 8;
  double tolerance = 1e-3;  ///< Done when a correction is that share of the first one, > 0.
};

struct NewtonResult {
  int iterations = 0;        ///< Corrections made.
  int linearIterations = 0;  ///< In all of them.
  double residual = 0;       ///< The last correction over the first, by root mean square; 0 where nothing moved.
  bool converged = false;    ///< That is at most the tolerance.
};

class NewtonSolver {
 public:
  /// The model must outlive it.
  NewtonSolver(const FabricModel& model, const Executor& executor);

  /// What stays from step to step: the length of a step h [s], which vertices are free, bending and masses of the
  /// model. Allocates; Solve does not.
  void SetUp(double h, std::span<const std::uint8_t> free);

  Objective& objective() { return objective_; }

  /// Steps are `h` [s] long from now on.
  void SetStep(double h);
  /// Goes from y down in energy, at most to the minimum. The objective must have begun the step; `energy` is what it
  /// gave for y, when it was asked last.
  NewtonResult Solve(std::span<Vec3> y, double energy, const NewtonSettings& settings);

 private:
  std::array<double, 2> MeasureDirection();
  double SearchLine(std::span<const Vec3> y, double energy, double slope);

  const FabricModel& model_;
  const Executor& executor_;
  SystemMatrix matrix_;
  Objective objective_;
  Multigrid multigrid_;
  ConjugateGradient conjugateGradient_;
  std::span<Vec3> gradient_, trial_;  // in the objective's scratch, within Solve
  RealVector right_, direction_;
  double trialEnergy_ = 0;
  std::vector<std::array<double, 2>> chunkSums_;
};

}  // namespace percale::fabric
