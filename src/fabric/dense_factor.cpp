#include "fabric/dense_factor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace percale::fabric {
namespace {

constexpr double kLeastPivot = 1e-9;  // share of the greatest entry on the diagonal, well above rounding
constexpr double kFirstShift = 1e-6;  // share as well: of the rounding of entries that were sums of floats
constexpr double kShiftGrowth = 10;

}  // namespace

void DenseFactor::SetUp(int size) {
  size_ = size;
  matrix_.assign(static_cast<std::size_t>(size) * size, 0);
  factor_.assign(matrix_.size(), 0);
}

double DenseFactor::Factor() {
  if (TryFactor(0)) return 0;
  const std::size_t n = size_;
  double greatest = 0;
  for (const double entry : matrix_) greatest = std::max(greatest, std::abs(entry));
  if (!(greatest > 0) || !std::isfinite(greatest)) greatest = 1;
  // From n times the greatest entry on the diagonal outweighs its row, whatever is there, if it is a number.
  double shift = kFirstShift * greatest;
  for (; shift < 2.0 * static_cast<double>(n) * greatest; shift *= kShiftGrowth) {
    if (TryFactor(shift)) return shift;
  }
  if (!TryFactor(shift)) {
    std::fill(factor_.begin(), factor_.end(), 0.0);
    for (std::size_t k = 0; k < n; ++k) factor_[k * n + k] = 1 / greatest;
  }
  return shift;
}

bool DenseFactor::TryFactor(double shift) {
  const std::size_t n = size_;
  double greatest = 0;
  for (std::size_t k = 0; k < n; ++k) {
    greatest = std::max(greatest, matrix_[k * n + k]);
    for (std::size_t j = k; j < n; ++j) factor_[k * n + j] = matrix_[k * n + j];
    factor_[k * n + k] += shift;
  }
  for (std::size_t k = 0; k < n; ++k) {
    double* __restrict column = &factor_[k * n];
    const double pivot = column[k];
    if (!(pivot > kLeastPivot * greatest) || !std::isfinite(pivot)) return false;
    column[k] = 1 / pivot;
    for (std::size_t j = k + 1; j < n; ++j) {
      const double share = column[j] * column[k];
      double* __restrict other = &factor_[j * n];
      if (share != 0) {
        for (std::size_t i = j; i < n; ++i) other[i] -= share * column[i];
      }
    }
    for (std::size_t j = k + 1; j < n; ++j) column[j] *= column[k];
  }
  return true;
}

void DenseFactor::Solve(double* b) const {
  const std::size_t n = size_;
  for (std::size_t k = 0; k < n; ++k) {
    const double* __restrict column = &factor_[k * n];
    double* __restrict rest = b;
    const double x = b[k];
    for (std::size_t j = k + 1; j < n; ++j) rest[j] -= column[j] * x;
  }
  for (std::size_t k = n; k-- > 0;) {
    const double* __restrict column = &factor_[k * n];
    double sums[4] = {};  // in four parts, so that they need not wait for each other
    std::size_t j = k + 1;
    for (; j + 4 <= n; j += 4) {
      for (int s = 0; s < 4; ++s) sums[s] += column[j + s] * b[j + s];
    }
    for (; j < n; ++j) sums[0] += column[j] * b[j];
    b[k] = b[k] * column[k] - ((sums[0] + sums[1]) + (sums[2] + sums[3]));
  }
}

}  // namespace percale::fabric
