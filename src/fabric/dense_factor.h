#pragma once
/// \file
/// The direct solve of multigrid's coarsest level.

#include <vector>

namespace percale::fabric {

/// A dense symmetric matrix of a few hundred rows as L D L'.
class DenseFactor {
 public:
  /// Makes room for `size` rows. Nothing else allocates.
  void SetUp(int size);
  int size() const { return size_; }
  /// Where the matrix goes before Factor: size() * size() numbers.
  double* matrix() { return matrix_.data(); }
  /// Factors it. Where it is not positive definite, with the least of a few multiples of the identity added that make
  /// it so; returns what was added, 0 if nothing.
  double Factor();
  /// Replaces b by the solution, size() numbers.
  void Solve(double* b) const;

 private:
  bool TryFactor(double shift);

  int size_ = 0;
  std::vector<double> matrix_, factor_;  // the factor column by column: L below the diagonal, 1 / D on it
};

}  // namespace percale::fabric
