#pragma once
/// \file
/// The matrix of one Newton step, a symmetric sparse one over vertices:
///
///   H = B + S (x) I3 + E
///
/// B has blocks of 3 x 3 between neighbours in the mesh and is filled anew in every Newton step. S has scalars, which
/// stay: bending that is quadratic in the positions (Bergou et al. 2006, "A quadratic bending model for inextensible
/// surfaces") and masses over h^2. E has blocks between vertices wherever they are, in places that change: contacts.
/// Rows and columns of pinned vertices are those of the identity. Of B, which takes most of the memory and of the time
/// to read it, only the blocks on and right of the diagonal are stored; a block left of it is the transpose of one of
/// them, in a row not far above where neighbours are near each other in memory.
///
/// A coarse level of multigrid is such a matrix too, over nodes instead of vertices.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/executor.h"
#include "fabric/kernels.h"
#include "fabric/real.h"
#include "fabric/shared_rows.h"
#include "percale/mesh.h"

namespace percale::fabric {

/// Which pairs of rows have a block. Symmetric; those on and right of the diagonal are stored, row after row.
struct BlockPattern {
  /// Per row its columns, ascending and with its own among them. The value of one left of the diagonal: how far behind
  /// the first stored block of its row the one is that has this block transposed; of others 0.
  SharedRows<std::int32_t> columns;
  std::vector<std::int32_t> storedFirst;  ///< Per row: its first stored block, the diagonal's; one more at the end.

  int rows() const { return columns.rows(); }
  int stored() const { return storedFirst.back(); }
  /// The stored block of two rows, either way round; -1 where there is none.
  std::int32_t Find(std::int32_t row, std::int32_t other) const;
  std::size_t MemoryBytes() const { return columns.MemoryBytes() + storedFirst.capacity() * sizeof(std::int32_t); }
};

/// Makes a BlockPattern row by row.
class PatternMaker {
 public:
  explicit PatternMaker(int rows);
  /// Adds a row, its columns ascending and with its own among them.
  void Append(std::span<const std::int32_t> columns);
  BlockPattern Take();

 private:
  RowSharer<std::int32_t> columns_;
  std::vector<std::int32_t> storedFirst_;
  std::vector<std::int32_t>
      mirrored_;  // per row: of its stored blocks right of the diagonal those with a transpose yet
  std::vector<std::pair<std::int32_t, std::int32_t>> row_;  // (column, value)
};

/// Couples the corners of each triangle, and the ends of each of `morePairs`, over `vertices` of them.
BlockPattern MakePattern(int vertices, std::span<const Triangle> triangles, std::span<const Edge> morePairs = {});

using ScalarMatrix = SharedRows<double>;
/// Sorts a row of (column, value) by column; entries of one column add up in the order in which they are given.
void SumByColumn(std::vector<std::pair<std::int32_t, double>>& row);
struct ScalarEntry {
  std::int32_t row = 0, column = 0;
  double value = 0;
};
/// Entries at the same place add up, in the order in which they are given.
ScalarMatrix MakeScalarMatrix(int rows, std::span<const ScalarEntry> entries);

/// A part of E: weight[i] weight[j] block between vertices i and j of up to four.
struct ExtraTerm {
  std::array<std::int32_t, 4> vertex{-1, -1, -1, -1};  ///< Different ones; -1: none.
  std::array<Real, 4> weight{};
  std::array<Real, 9> block{};  ///< Symmetric.
};

/// E in compressed rows with gaps between them. Its arrays grow and never shrink.
struct ExtraRows {
  std::vector<std::int32_t> begin, end;  ///< Per row: its blocks are begin <= k < end.
  std::vector<std::int32_t> column;      ///< Per block.
  RealVector block;                      ///< Nine per block, column by column, and one more at the end.
  bool any = false;                      ///< Whether there are blocks; if not, begin and end do not count.
};

class SystemMatrix {
 public:
  explicit SystemMatrix(const Kernels& kernels = BestKernels()) : kernels_(&kernels) {}
  /// Has that pattern, and is to be set up.
  explicit SystemMatrix(BlockPattern pattern) : kernels_(&BestKernels()), pattern_(std::move(pattern)) {}

  /// `constant`: S, as large as `pattern`. `pinned`: per row, 1 where a vertex does not move; or nothing.
  /// Afterwards nothing allocates but SetExtra.
  void SetUp(BlockPattern pattern, const ScalarMatrix& constant, std::span<const std::uint8_t> pinned = {});
  /// The same with the pattern that it has.
  void SetUp(const ScalarMatrix& constant, std::span<const std::uint8_t> pinned);

  int rows() const { return pattern_.rows(); }
  const BlockPattern& pattern() const { return pattern_; }
  /// Calls visit(column, value) for what S has in a row outside the pattern, rows and columns of pinned vertices left
  /// out.
  template <class Visit>
  void ForRest(std::int32_t row, Visit&& visit) const {
    const auto r = static_cast<std::size_t>(row), kind = static_cast<std::size_t>(constant_.kind[r]);
    const std::int32_t inside = pattern_.storedFirst[r + 1] - pattern_.storedFirst[r] - 1;
    for (std::int32_t e = constant_.first[kind] + inside; e < constant_.first[kind + 1]; ++e)
      visit(row + constant_.offset[static_cast<std::size_t>(e)], constant_.value[static_cast<std::size_t>(e)]);
  }
  bool Pinned(int row) const { return !pinned_.empty() && pinned_[row]; }

  // In this order for each Newton step:

  /// Starts to fill the blocks: sets them to what S has within the pattern.
  void Reset(const Executor& executor);
  /// The nine Reals of a stored block, column by column: what links force component r of its row with displacement
  /// component c of its column is at 3 c + r. To be added to.
  Real* Block(std::int32_t index) { return &blocks_[9 * static_cast<std::size_t>(index)]; }
  const Real* Block(std::int32_t index) const { return &blocks_[9 * static_cast<std::size_t>(index)]; }
  Real* DiagonalBlock(int row) { return Block(pattern_.storedFirst[static_cast<std::size_t>(row)]); }
  const Real* DiagonalBlock(int row) const { return Block(pattern_.storedFirst[static_cast<std::size_t>(row)]); }
  /// What S has at stored blocks: who writes all blocks himself adds it to their diagonals, and needs no Reset. Per row
  /// on the diagonal, and then right of it, in the order of the blocks; behind those comes what ForRest visits.
  std::span<const Real> diagonal() const { return diagonal_; }
  const SharedRows<Real>& constant() const { return constant_; }
  /// Sets what S has on the diagonal of a row.
  void SetDiagonal(int row, Real value) { diagonal_[static_cast<std::size_t>(row)] = value; }
  /// Sets E. Allocates only when there is more of it than ever before. Leaving it out keeps E.
  void SetExtra(std::span<const ExtraTerm> terms, const Executor& executor);
  /// Ends the filling: clears what belongs to pinned vertices and inverts the diagonal.
  void Finish(const Executor& executor);

  // All vectors are of VectorLength(rows()) Reals, and none may be another.

  /// y = H x
  void Multiply(const Real* x, Real* y, const Executor& executor) const;
  /// y = H x; returns x'y. `chunkSums`: Chunks(rows()) numbers of scratch.
  double MultiplyDot(const Real* x, Real* y, std::span<double> chunkSums, const Executor& executor) const;
  /// y = b - H x
  void Residual(const Real* b, const Real* x, Real* y, const Executor& executor) const;
  /// y = x + omega D^-1 (b - H x), D being the diagonal blocks: a step of Jacobi's.
  void Smooth(Real omega, const Real* b, const Real* x, Real* y, const Executor& executor) const;
  /// y = omega D^-1 b, the same step from x = 0.
  void SmoothFromZero(Real omega, const Real* b, Real* y, const Executor& executor) const;

  /// The block of E and B and S on the diagonal, and its inverse, symmetric; both of nine Reals. Where the block is not
  /// positive definite the inverse is of its trace instead.
  std::array<Real, 9> WholeDiagonal(int row) const;
  const Real* InverseDiagonal(int row) const { return &inverse_[9 * static_cast<std::size_t>(row)]; }

  const ExtraRows& extra() const { return extra_; }
  ExtraRows& extra() { return extra_; }
  /// Writes the matrix to `dense`, (3 rows)^2 numbers.
  void ToDense(double* dense) const;
  /// Of all arrays.
  std::size_t MemoryBytes() const;

 private:
  RowsArgs Rows(int chunk, const Real* x, Real* y) const;

  const Kernels* kernels_;
  BlockPattern pattern_;
  std::vector<std::uint8_t> pinned_;
  std::vector<std::int32_t> cleared_;  // stored blocks in rows and columns of pinned vertices
  std::vector<Real> diagonal_;
  SharedRows<Real> constant_;
  RealVector blocks_, inverse_;  // nine per stored block or row, and one more at the end
  ExtraRows extra_;
  std::vector<std::int32_t> extraFirst_, extraOrder_;  // per row the terms that it is in, as 4 term + place
};

/// The rows that one chunk of a loop covers. Small enough that two threads share 2,000 vertices well, large enough that
/// to hand out a chunk (about a microsecond) costs little. Sums depend on it, so it is the same everywhere.
inline constexpr int kRowsPerChunk = 512;
inline int Chunks(int rows, int perChunk = kRowsPerChunk) {
  return (rows + perChunk - 1) / perChunk;
}
/// Calls body(i) for each of so many items that are independent of each other.
template <class Body>
void ForRange(const Executor& executor, std::size_t items, Body&& body) {
  const int count = static_cast<int>(items);
  executor.ForChunks(Chunks(count), [&](int chunk) {
    const int begin = chunk * kRowsPerChunk, end = begin + kRowsPerChunk < count ? begin + kRowsPerChunk : count;
    for (int i = begin; i < end; ++i) body(i);
  });
}

}  // namespace percale::fabric
