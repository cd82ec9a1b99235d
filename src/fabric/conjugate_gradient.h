#pragma once
/// \file
/// Conjugate gradients with multigrid as the preconditioner: the direction of a Newton step.

#include <cstddef>
#include <vector>

#include "core/executor.h"
#include "fabric/multigrid.h"
#include "fabric/real.h"
#include "fabric/system_matrix.h"

namespace percale::fabric {

struct SolveSettings {
  int maxIterations = 8;    ///< >= 1.
  double tolerance = 0.01;  ///< Done when r'z is at most that share of what it was at the start, > 0.
  /// Done as well when an iteration gains at most that share of what all have gained in ½ x'Hx - b'x; 0: never. To know
  /// costs nothing, while r'z takes a cycle (Nash, Sofer 1990, "Assessing a search direction within a
  /// truncated-Newton method").
  double leastGain = 0;
};

enum class SolveEnd {
  Converged,
  OutOfIterations,    ///< What was reached is a direction of descent all the same.
  NegativeCurvature,  ///< The matrix is not positive definite; what was reached before that showed is one too.
  NotPreconditioned,  ///< The preconditioner is not positive definite. In the first iteration the answer is D^-1 b.
};

struct SolveResult {
  int iterations = 0;  ///< Products with the matrix.
  /// r'z over what it was at the start; where the end was not Converged, before the last iteration: to know it after
  /// that would cost another cycle.
  double ratio = 0;
  SolveEnd end = SolveEnd::Converged;
};

class ConjugateGradient {
 public:
  /// For matrices of that many rows. Nothing else allocates.
  void SetUp(int rows);

  /// Solves H x = b from x = 0. `b` becomes the residual. `matrix` must be finished and `multigrid` filled from it, or
  /// from one like it. Where p'Hp <= 0 it stops, and takes p if that is in the first iteration (Nocedal, Wright 2006,
  /// "Numerical Optimization", algorithm 7.1). b and x are of VectorLength(rows) Reals, b zero at pinned vertices.
  SolveResult Solve(const SystemMatrix& matrix, Multigrid& multigrid, Real* b, Real* x, const SolveSettings& settings,
                    const Executor& executor);

  std::size_t MemoryBytes() const;

 private:
  RealVector preconditioned_, direction_, product_;
  std::vector<double> chunkSums_;
};

}  // namespace percale::fabric
