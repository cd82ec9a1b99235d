#pragma once
/// \file
/// Multigrid for the matrix of a Newton step: coarse matrices by Galerkin's products P' H P, block Jacobi as the
/// smoother, one V(1,1) cycle as a symmetric preconditioner of conjugate gradients (Tatebe 1993, "The multigrid
/// preconditioned conjugate gradient method").

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/executor.h"
#include "fabric/dense_factor.h"
#include "fabric/prolongation.h"
#include "fabric/real.h"
#include "fabric/system_matrix.h"

namespace percale::fabric {

class Multigrid {
 public:
  Multigrid();
  ~Multigrid();
  Multigrid(const Multigrid&) = delete;
  Multigrid& operator=(const Multigrid&) = delete;

  /// `fine` must have been set up; its blocks do not matter yet, what it says of pins must be what `hierarchy` was made
  /// with. Afterwards nothing allocates but the part of RefillExtra for more contacts than ever before.
  void SetUp(const SystemMatrix& fine, std::vector<Prolongation> hierarchy);

  /// The coarse images of all of `fine`, which must be finished.
  void Refill(const SystemMatrix& fine, const Executor& executor);
  /// Of its extra blocks only; those of the rest stay as they are. What is left out lags, which costs iterations but no
  /// accuracy.
  void RefillExtra(const SystemMatrix& fine, const Executor& executor);

  /// z = V r: an approximate inverse of `fine` times r, all three vectors of VectorLength(fine.rows()) Reals, and
  /// `scratch` any of those that ends in zeros. A symmetric operator,
  /// positive definite if `fine` is and no eigenvalue of D^-1 fine exceeds four: that holds for sums of terms over four
  /// vertices each, and for triangles.
  void Apply(const SystemMatrix& fine, const Real* r, Real* z, Real* scratch, const Executor& executor);

  /// Coarse levels; their matrices and what leads to them, from the finest on.
  int levels() const { return static_cast<int>(levels_.size()); }
  const SystemMatrix& matrix(int level) const;
  const Prolongation& prolongation(int level) const;
  /// Whether the coarsest level is solved for directly, and what had to be added to its diagonal for that.
  bool direct() const { return direct_; }
  double shift() const { return shift_; }
  /// Of all arrays, those of `fine` not included.
  std::size_t MemoryBytes() const;

 private:
  struct Level;
  struct ExtraPart;

  void RefillBlocks(const SystemMatrix& fine, Level& level, const Executor& executor);
  void RefillExtra(const SystemMatrix& fine, Level& level, const Executor& executor);
  template <class Visit>
  void SumRows(int rows, ExtraRows& to, const Executor& executor, Visit&& visit);
  void SolveCoarsest(const SystemMatrix& matrix, const Real* r, Real* z, Real* scratch, const Executor& executor);

  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<ExtraPart> parts_;  // each of a share of the rows, while extra blocks are summed
  RealVector product_;            // as much of H P of the level at hand as is needed at once
  ExtraRows extraProduct_;        // E P of the level at hand
  DenseFactor dense_;
  std::vector<double> denseVector_;
  bool direct_ = false;
  double shift_ = 0;
};

}  // namespace percale::fabric
