#pragma once
/// \file
/// The numbers of the linear solver, and how vectors of them lie in memory.

#include <cstddef>

#include "core/aligned.h"

namespace percale::fabric {

/// What matrices and vectors of the linear solver are made of. Its products wait for memory, and a float is half of a
/// double; its answer is a direction that a line search checks, wanted to a percent. What must be exact is not in
/// float: positions, the gradient, energies, and sums over many vertices are in double.
using Real = float;

/// A vector over `rows` vertices is an array x0 y0 z0 x1 y1 z1 ... of VectorLength(rows) Reals. What lies behind the
/// first 3 * rows is zero at first; kernels read one Real of it, so that they can take four at a time, and write none.
/// (With x y z 0 per vertex instead the product took 16.2 ns per vertex, not 16.8, and vectors a third more of memory.)
inline std::size_t VectorLength(int rows) {
  constexpr std::size_t kLine = 64 / sizeof(Real);
  return (3 * static_cast<std::size_t>(rows) + kLine) / kLine * kLine;
}

using RealVector = AlignedVector<Real>;

}  // namespace percale::fabric
