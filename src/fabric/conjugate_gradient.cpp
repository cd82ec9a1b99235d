#include "fabric/conjugate_gradient.h"

#include <algorithm>

namespace percale::fabric {
namespace {

/// Calls body(begin, end) for the numbers of each chunk of rows.
template <class Body>
void ForNumbers(int rows, const Executor& executor, Body&& body) {
  executor.ForChunks(Chunks(rows), [&](int chunk) {
    body(3 * static_cast<std::size_t>(chunk * kRowsPerChunk),
         3 * static_cast<std::size_t>(std::min(rows, (chunk + 1) * kRowsPerChunk)));
  });
}

double Dot(const Real* __restrict a, const Real* __restrict b, int rows, std::vector<double>& chunkSums,
           const Executor& executor) {
  executor.ForChunks(Chunks(rows), [&](int chunk) {
    const std::size_t begin = 3 * static_cast<std::size_t>(chunk * kRowsPerChunk);
    const std::size_t end = 3 * static_cast<std::size_t>(std::min(rows, (chunk + 1) * kRowsPerChunk));
    double sums[4] = {};  // in four parts, so that they need not wait for each other
    std::size_t k = begin;
    for (; k + 4 <= end; k += 4) {
      for (int s = 0; s < 4; ++s) sums[s] += static_cast<double>(a[k + s]) * static_cast<double>(b[k + s]);
    }
    for (; k < end; ++k) sums[0] += static_cast<double>(a[k]) * static_cast<double>(b[k]);
    chunkSums[chunk] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  });
  double sum = 0;
  for (const double part : chunkSums) sum += part;
  return sum;
}

}  // namespace

void ConjugateGradient::SetUp(int rows) {
  for (RealVector* vector : {&preconditioned_, &direction_, &product_}) {
    vector->assign(VectorLength(rows), 0);
  }
  chunkSums_.assign(Chunks(rows), 0);
}

SolveResult ConjugateGradient::Solve(const SystemMatrix& matrix, Multigrid& multigrid, Real* b, Real* x,
                                     const SolveSettings& settings, const Executor& executor) {
  const int rows = matrix.rows();
  Real* __restrict r = b;
  Real* __restrict z = preconditioned_.data();
  Real* __restrict p = direction_.data();
  const Real* __restrict hp = product_.data();
  Real* __restrict answer = x;

  ForNumbers(rows, executor,
             [&](std::size_t begin, std::size_t end) { std::fill(answer + begin, answer + end, Real{0}); });
  multigrid.Apply(matrix, r, z, product_.data(), executor);
  double rz = Dot(r, z, rows, chunkSums_, executor);
  const double start = rz;
  SolveResult result;
  if (!(start > 0)) {
    if (Dot(r, r, rows, chunkSums_, executor) == 0) return result;
    matrix.SmoothFromZero(1, r, x, executor);
    result.ratio = 1;
    result.end = SolveEnd::NotPreconditioned;
    return result;
  }
  std::copy(preconditioned_.begin(), preconditioned_.end(), direction_.begin());
  result.ratio = 1;
  result.end = SolveEnd::OutOfIterations;
  double gain = 0;  // twice that
  for (;;) {
    const double curvature = matrix.MultiplyDot(p, product_.data(), chunkSums_, executor);
    ++result.iterations;
    if (!(curvature > 0)) {
      if (result.iterations == 1)
        std::copy(direction_.begin(), direction_.begin() + 3 * static_cast<std::ptrdiff_t>(rows), x);
      result.end = SolveEnd::NegativeCurvature;
      break;
    }
    const Real alpha = static_cast<Real>(rz / curvature);
    ForNumbers(rows, executor, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        answer[k] += alpha * p[k];
        r[k] -= alpha * hp[k];
      }
    });
    if (result.iterations == settings.maxIterations) break;
    gain += rz * rz / curvature;
    if (rz * rz / curvature <= settings.leastGain * gain) {
      result.end = SolveEnd::Converged;
      break;
    }
    multigrid.Apply(matrix, r, z, product_.data(), executor);
    const double before = rz;
    rz = Dot(r, z, rows, chunkSums_, executor);
    result.ratio = rz / start;
    if (rz >= 0 && result.ratio <= settings.tolerance) {
      result.end = SolveEnd::Converged;
      break;
    }
    if (!(rz > 0)) {
      result.end = SolveEnd::NotPreconditioned;
      break;
    }
    const Real beta = static_cast<Real>(rz / before);
    ForNumbers(rows, executor, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) p[k] = z[k] + beta * p[k];
    });
  }
  return result;
}

std::size_t ConjugateGradient::MemoryBytes() const {
  return 3 * product_.capacity() * sizeof(Real) + chunkSums_.capacity() * sizeof(double);
}

}  // namespace percale::fabric
