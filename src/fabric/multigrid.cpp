#include "fabric/multigrid.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/memory.h"
#include "fabric/real4.h"
#include "fabric/slots.h"
#include "fabric/window.h"

namespace percale::fabric {
namespace {

constexpr Real kOmega = Real{.5};    // damping of Jacobi's steps
constexpr int kProductChunk = 256;   // rows of H P that one chunk computes
constexpr int kNodeChunk = 32;       // rows of P' (H P)
constexpr int kNodeSlab = 1024;      // nodes whose rows of H P are computed at once
constexpr int kRestrictChunk = 128;  // nodes that one chunk restricts to
constexpr int kExtraParts = 16;      // each marks all nodes of a level, so there is a fixed number of them
constexpr int kMostDirect = 200;     // nodes up to which the coarsest level is factored: 6 ms
constexpr int kCoarsestSweeps = 4;   // of Jacobi where it is larger

}  // namespace

/// A coarse level and the way to it.
struct Multigrid::Level {
  Prolongation p;
  Restriction restriction;

  // The blocks of T = H P lie in compressed rows, those of each chunk of kProductChunk rows from a place on that other
  // chunks have before and after it.
  std::vector<std::int32_t> productFirst;
  std::size_t chunkBlocks = 0;  // in the longest chunk
  Window window;                // of chunks of T, for kNodeSlab nodes each
  // Per row, in the order of the loops: for each block of H and each weight of its column where in its row of T it
  // goes.
  SlotLists productSlots;
  // Per node, likewise: for each weight of P' how many blocks at the start of that row of T are left of the diagonal of
  // A, and then for each other block where in its row of A it goes.
  SlotLists slots;

  SystemMatrix matrix;
  RealVector right, solution, scratch;  // vectors over its nodes

  /// By how much the blocks of a row of T lie apart from where compressed rows have them.
  std::int64_t ProductShift(int productRow) const {
    const int chunk = productRow / kProductChunk;
    return static_cast<std::int64_t>(chunk % window.slots) * static_cast<std::int64_t>(chunkBlocks) -
           productFirst[static_cast<std::size_t>(chunk) * kProductChunk];
  }
};

/// Sums blocks into rows (Gustavson 1978, "Two fast algorithms for sparse matrices: multiplication and permuted
/// transposition").
struct Multigrid::ExtraPart {
  std::vector<std::int32_t> place;  // per node: where in the row at hand its block is, -1 if there is none
  std::vector<std::int32_t> column;
  RealVector block;

  void Add(std::int32_t node, Real weight, const Real* from) {
    if (place[node] < 0) {
      place[node] = static_cast<std::int32_t>(column.size());
      column.push_back(node);
      block.resize(block.size() + 9, 0);
    }
    AddScaled(&block[9 * static_cast<std::size_t>(place[node])], weight, from);
  }
};

Multigrid::Multigrid() = default;
Multigrid::~Multigrid() = default;

const SystemMatrix& Multigrid::matrix(int level) const {
  return levels_[level]->matrix;
}

const Prolongation& Multigrid::prolongation(int level) const {
  return levels_[level]->p;
}

namespace {

/// P' S P of what S has outside the pattern of the finer level, node by node.
ScalarMatrix CoarseScalars(const SystemMatrix& fine, const Prolongation& p, const Restriction& restriction) {
  RowSharer<double> coarse(p.nodes);
  std::vector<std::pair<std::int32_t, double>> entries;  // of a row
  std::vector<double> sum(p.nodes, 0);
  std::vector<std::int32_t> seenBy(p.nodes, -1), columns;
  for (int node = 0; node < p.nodes; ++node) {
    columns.clear();
    restriction.ForRow(p, node, [&](std::int32_t row, Real weight) {
      fine.ForRest(row, [&](std::int32_t other, Real entry) {
        const double value = static_cast<double>(weight) * static_cast<double>(entry);
        for (std::int32_t f = p.first[other]; f < p.first[other + 1]; ++f) {
          const std::int32_t column = p.column[f];
          if (std::exchange(seenBy[column], node) != node) columns.push_back(column), sum[column] = 0;
          sum[column] += value * static_cast<double>(p.weight[f]);
        }
      });
    });
    std::sort(columns.begin(), columns.end());
    entries.clear();
    for (const std::int32_t column : columns) entries.push_back({column, sum[column]});
    coarse.Append(entries);
  }
  return coarse.Take();
}

}  // namespace

void Multigrid::SetUp(const SystemMatrix& fine, std::vector<Prolongation> hierarchy) {
  levels_.clear();
  parts_.clear();
  parts_.resize(kExtraParts);
  const SystemMatrix* above = &fine;
  std::size_t greatestProduct = 0;
  for (Prolongation& p : hierarchy) {
    levels_.push_back(std::make_unique<Level>());
    Level& level = *levels_.back();
    level.p = std::move(p);
    const Prolongation& P = level.p;
    const BlockPattern& pattern = above->pattern();
    assert(P.rows() == pattern.rows());
    level.restriction = MakeRestriction(P);
    level.matrix.SetUp(CoarsePattern(pattern, P, level.restriction), CoarseScalars(*above, P, level.restriction));
    const BlockPattern& coarse = level.matrix.pattern();

    // Rows of T: the nodes of all columns, ascending. Only those of rows that P' reads.
    std::vector<std::int32_t> nodes, productColumn;
    std::vector<std::uint32_t> slots;
    level.productFirst.reserve(static_cast<std::size_t>(P.rows()) + 1);
    level.productFirst.assign(1, 0);
    for (int row = 0; row < P.rows(); ++row) {
      nodes.clear();
      slots.clear();
      const bool read = P.first[row] < P.first[row + 1];
      const auto forColumns = [&](auto&& visit) {
        if (read) pattern.columns.ForRow(row, visit);
      };
      forColumns([&](std::int32_t other, std::int32_t) {
        nodes.insert(nodes.end(), P.column.begin() + P.first[other], P.column.begin() + P.first[other + 1]);
      });
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      forColumns([&](std::int32_t other, std::int32_t) {
        for (std::int32_t e = P.first[other]; e < P.first[other + 1]; ++e) {
          const auto found = std::lower_bound(nodes.begin(), nodes.end(), P.column[e]);
          slots.push_back(static_cast<std::uint32_t>(found - nodes.begin()));
        }
      });
      level.productSlots.Add(slots);
      productColumn.insert(productColumn.end(), nodes.begin(), nodes.end());
      level.productFirst.push_back(static_cast<std::int32_t>(productColumn.size()));
    }
    for (int row = 0; row < P.rows(); row += kProductChunk) {
      const int end = std::min(P.rows(), row + kProductChunk);
      level.chunkBlocks =
          std::max(level.chunkBlocks, static_cast<std::size_t>(level.productFirst[end] - level.productFirst[row]));
    }
    std::vector<std::int32_t> firstChunk(Chunks(P.nodes, kNodeSlab), Chunks(P.rows(), kProductChunk));
    std::vector<std::int32_t> lastChunk(firstChunk.size(), -1);
    for (int node = 0; node < P.nodes; ++node) {
      level.restriction.ForRow(P, node, [&](std::int32_t row, Real) {
        std::int32_t &least = firstChunk[node / kNodeSlab], &most = lastChunk[node / kNodeSlab];
        least = std::min(least, row / kProductChunk);
        most = std::max(most, row / kProductChunk);
      });
    }
    level.window = MakeWindow(Chunks(P.rows(), kProductChunk), firstChunk, lastChunk);
    greatestProduct = std::max(greatestProduct, level.chunkBlocks * static_cast<std::size_t>(level.window.slots));

    for (int node = 0; node < P.nodes; ++node) {
      slots.clear();
      level.restriction.ForRow(P, node, [&](std::int32_t row, Real) {
        const auto begin = productColumn.begin() + level.productFirst[row];
        const auto end = productColumn.begin() + level.productFirst[row + 1];
        const auto diagonal = std::lower_bound(begin, end, node);
        slots.push_back(static_cast<std::uint32_t>(diagonal - begin));
        for (auto at = diagonal; at != end; ++at) {
          slots.push_back(static_cast<std::uint32_t>(coarse.Find(node, *at) - coarse.storedFirst[node]));
        }
      });
      level.slots.Add(slots);
    }
    level.productSlots.Finish();
    level.slots.Finish();

    level.right.assign(VectorLength(P.nodes), 0);
    level.solution.assign(VectorLength(P.nodes), 0);
    level.scratch.assign(VectorLength(P.nodes), 0);
    above = &level.matrix;
  }
  product_.assign(9 * greatestProduct + 1, 0);
  if (!levels_.empty()) {
    for (ExtraPart& part : parts_) part.place.assign(levels_.front()->p.nodes, -1);
  }
  direct_ = above->rows() <= kMostDirect;
  dense_.SetUp(direct_ ? 3 * above->rows() : 0);
  denseVector_.assign(dense_.size(), 0);
}

void Multigrid::Refill(const SystemMatrix& fine, const Executor& executor) {
  const SystemMatrix* above = &fine;
  for (const auto& level : levels_) {
    RefillBlocks(*above, *level, executor);
    above = &level->matrix;
  }
  RefillExtra(fine, executor);
}

void Multigrid::RefillExtra(const SystemMatrix& fine, const Executor& executor) {
  const SystemMatrix* above = &fine;
  for (const auto& level : levels_) {
    RefillExtra(*above, *level, executor);
    level->matrix.Finish(executor);
    above = &level->matrix;
  }
  if (!direct_) return;
  above->ToDense(dense_.matrix());
  shift_ = dense_.Factor();
}

void Multigrid::RefillBlocks(const SystemMatrix& fine, Level& level, const Executor& executor) {
  const Prolongation& p = level.p;
  const BlockPattern& pattern = fine.pattern();
  const auto multiply = [&](int chunk, const auto* slots) {  // T = H P, by rows
    const int begin = chunk * kProductChunk, end = std::min(p.rows(), begin + kProductChunk);
    const std::int64_t shift = level.ProductShift(begin);
    for (int row = begin; row < end; ++row) {
      const auto* __restrict slot = slots + level.productSlots.First(row);
      const std::int32_t productBegin = level.productFirst[row], productEnd = level.productFirst[row + 1];
      if (productBegin == productEnd) continue;
      Real* __restrict to = product_.data() + 9 * (shift + productBegin);
      std::fill_n(to, 9 * static_cast<std::size_t>(productEnd - productBegin), Real{0});
      const Real* stored = fine.DiagonalBlock(row);
      pattern.columns.ForRow(row, [&](std::int32_t other, std::int32_t mirrored) {
        const Real* block = stored;
        Real transposed[9];
        if (other < row) {
          const Real* from = fine.DiagonalBlock(other) + 9 * static_cast<std::size_t>(mirrored);
          for (int c = 0; c < 9; ++c) transposed[c] = from[c % 3 * 3 + c / 3];
          block = transposed;
        } else {
          stored += 9;
        }
        for (std::int32_t e = p.first[other]; e < p.first[other + 1]; ++e) {
          AddScaled(to + 9 * static_cast<std::size_t>(*slot++), p.weight[e], block);
        }
      });
    }
  };
  // A = P' T on and right of the diagonal, on top of the constant part.
  level.matrix.Reset(executor);
  const auto sum = [&](int begin, int end, const auto* slots) {
    for (int node = begin; node < end; ++node) {
      const auto* __restrict slot = slots + level.slots.First(node);
      Real* __restrict to = level.matrix.DiagonalBlock(node);
      level.restriction.ForRow(p, node, [&](std::int32_t row, Real weight) {
        const std::int64_t shift = level.ProductShift(row);
        const Real* __restrict from = product_.data() + 9 * (shift + level.productFirst[row] + *slot++);
        const Real* const last = product_.data() + 9 * (shift + level.productFirst[row + 1]);
        for (; from < last; from += 9) AddScaled(to + 9 * static_cast<std::size_t>(*slot++), weight, from);
      });
    }
  };
  int made = 0;
  for (int slab = 0; slab < static_cast<int>(level.window.end.size()); ++slab) {
    const int first = std::exchange(made, level.window.end[slab]);
    executor.ForChunks(made - first, [&](int chunk) {
      level.productSlots.InArray([&](const auto* slots) { multiply(first + chunk, slots); });
    });
    const int begin = slab * kNodeSlab, count = std::min(kNodeSlab, p.nodes - begin);
    executor.ForChunks(Chunks(count, kNodeChunk), [&](int chunk) {
      const int from = begin + chunk * kNodeChunk;
      const int to = std::min(from + kNodeChunk, begin + count);
      level.slots.InArray([&](const auto* slots) { sum(from, to, slots); });
    });
  }
}

/// Fills `to` with `rows` rows: visit(row, part) adds the blocks of one to `part`. Each part sums its share of the rows
/// in memory of its own; then all are laid end to end.
template <class Visit>
void Multigrid::SumRows(int rows, ExtraRows& to, const Executor& executor, Visit&& visit) {
  if (to.begin.size() < static_cast<std::size_t>(rows)) {
    to.begin.resize(rows);
    to.end.resize(rows);
  }
  const auto firstRow = [&](int part) {
    return static_cast<int>(static_cast<std::int64_t>(rows) * part / kExtraParts);
  };
  executor.ForChunks(kExtraParts, [&](int index) {
    ExtraPart& part = parts_[index];
    part.column.clear();
    part.block.clear();
    for (int row = firstRow(index); row < firstRow(index + 1); ++row) {
      const std::size_t begin = part.column.size();
      visit(row, part);
      for (std::size_t k = begin; k < part.column.size(); ++k) part.place[part.column[k]] = -1;
      to.begin[row] = static_cast<std::int32_t>(begin);
      to.end[row] = static_cast<std::int32_t>(part.column.size());
    }
  });
  std::size_t total = 0;
  for (const ExtraPart& part : parts_) total += part.column.size();
  if (to.column.size() < total) {
    to.column.resize(total + total / 2);
    to.block.resize(9 * to.column.size() + 1);
  }
  executor.ForChunks(kExtraParts, [&](int index) {
    const ExtraPart& part = parts_[index];
    std::int32_t offset = 0;
    for (int earlier = 0; earlier < index; ++earlier)
      offset += static_cast<std::int32_t>(parts_[earlier].column.size());
    std::copy(part.column.begin(), part.column.end(), to.column.begin() + offset);
    std::copy(part.block.begin(), part.block.end(), to.block.begin() + 9 * static_cast<std::ptrdiff_t>(offset));
    for (int row = firstRow(index); row < firstRow(index + 1); ++row) {
      to.begin[row] += offset;
      to.end[row] += offset;
    }
  });
  to.any = true;
}

void Multigrid::RefillExtra(const SystemMatrix& fine, Level& level, const Executor& executor) {
  const Prolongation& p = level.p;
  const ExtraRows& from = fine.extra();
  level.matrix.extra().any = false;
  if (!from.any) return;
  SumRows(p.rows(), extraProduct_, executor, [&](int row, ExtraPart& part) {  // E P
    if (p.first[row] == p.first[row + 1]) return;
    for (std::int32_t k = from.begin[row]; k < from.end[row]; ++k) {
      for (std::int32_t e = p.first[from.column[k]]; e < p.first[from.column[k] + 1]; ++e) {
        part.Add(p.column[e], p.weight[e], &from.block[9 * static_cast<std::size_t>(k)]);
      }
    }
  });
  SumRows(p.nodes, level.matrix.extra(), executor, [&](int node, ExtraPart& part) {  // P' (E P)
    level.restriction.ForRow(p, node, [&](std::int32_t row, Real weight) {
      for (std::int32_t k = extraProduct_.begin[row]; k < extraProduct_.end[row]; ++k) {
        part.Add(extraProduct_.column[k], weight, &extraProduct_.block[9 * static_cast<std::size_t>(k)]);
      }
    });
  });
}

void Multigrid::SolveCoarsest(const SystemMatrix& matrix, const Real* r, Real* z, Real* scratch,
                              const Executor& executor) {
  if (direct_) {
    for (int k = 0; k < dense_.size(); ++k) denseVector_[k] = r[k];
    dense_.Solve(denseVector_.data());
    for (int k = 0; k < dense_.size(); ++k) z[k] = static_cast<Real>(denseVector_[k]);
    return;
  }
  static_assert(kCoarsestSweeps % 2 == 0, "so that the last sweep writes to z");
  matrix.SmoothFromZero(kOmega, r, z, executor);
  for (int sweep = 0; sweep < kCoarsestSweeps; sweep += 2) {
    matrix.Smooth(kOmega, r, z, scratch, executor);
    matrix.Smooth(kOmega, r, scratch, z, executor);
  }
}

void Multigrid::Apply(const SystemMatrix& fine, const Real* r, Real* z, Real* scratch, const Executor& executor) {
  const auto matrixOf = [&](int k) -> const SystemMatrix& { return k == 0 ? fine : levels_[k - 1]->matrix; };
  const auto rightOf = [&](int k) { return k == 0 ? r : levels_[k - 1]->right.data(); };
  const auto solutionOf = [&](int k) { return k == 0 ? z : levels_[k - 1]->solution.data(); };
  const auto scratchOf = [&](int k) { return k == 0 ? scratch : levels_[k - 1]->scratch.data(); };
  for (int k = 0; k < levels(); ++k) {
    matrixOf(k).SmoothFromZero(kOmega, rightOf(k), solutionOf(k), executor);
    matrixOf(k).Residual(rightOf(k), solutionOf(k), scratchOf(k), executor);
    const Level& level = *levels_[k];
    const Real* __restrict from = scratchOf(k);
    Real* __restrict to = levels_[k]->right.data();
    executor.ForChunks(Chunks(level.p.nodes, kRestrictChunk), [&](int chunk) {
      for (int node = chunk * kRestrictChunk; node < std::min(level.p.nodes, (chunk + 1) * kRestrictChunk); ++node) {
        Real4 sum = Real4::Zero();
        level.restriction.ForRow(level.p, node, [&](std::int32_t row, Real weight) {
          sum += Real4::Load(from + 3 * static_cast<std::size_t>(row)) * weight;
        });
        Store3(sum, to + 3 * static_cast<std::size_t>(node));
      }
    });
  }
  SolveCoarsest(matrixOf(levels()), rightOf(levels()), solutionOf(levels()), scratchOf(levels()), executor);
  for (int k = levels() - 1; k >= 0; --k) {
    const Prolongation& p = levels_[k]->p;
    const Real* __restrict from = levels_[k]->solution.data();
    const Real* __restrict before = solutionOf(k);
    Real* __restrict to = scratchOf(k);
    executor.ForChunks(Chunks(p.rows()), [&](int chunk) {
      for (int row = chunk * kRowsPerChunk; row < std::min(p.rows(), (chunk + 1) * kRowsPerChunk); ++row) {
        Real4 sum = Real4::Zero();
        for (std::int32_t e = p.first[row]; e < p.first[row + 1]; ++e) {
          sum += Real4::Load(from + 3 * static_cast<std::size_t>(p.column[e])) * p.weight[e];
        }
        const std::size_t at = 3 * static_cast<std::size_t>(row);
        for (int c = 0; c < 3; ++c) to[at + c] = before[at + c] + sum[c];
      }
    });
    matrixOf(k).Smooth(kOmega, rightOf(k), to, solutionOf(k), executor);
  }
}

std::size_t Multigrid::MemoryBytes() const {
  std::size_t bytes = BytesOf(product_) + BytesOf(denseVector_);
  bytes += 2 * sizeof(double) * static_cast<std::size_t>(dense_.size()) * dense_.size();
  bytes += BytesOf(extraProduct_.begin) + BytesOf(extraProduct_.end) + BytesOf(extraProduct_.column) +
           BytesOf(extraProduct_.block);
  for (const ExtraPart& part : parts_) bytes += BytesOf(part.place) + BytesOf(part.column) + BytesOf(part.block);
  for (const auto& owned : levels_) {
    const Level& level = *owned;
    bytes += BytesOf(level.p.first) + BytesOf(level.p.column) + BytesOf(level.p.weight) +
             level.restriction.MemoryBytes() + BytesOf(level.productFirst) + level.productSlots.Bytes() +
             level.slots.Bytes() + BytesOf(level.right) + BytesOf(level.solution) + BytesOf(level.scratch) +
             level.matrix.MemoryBytes();
  }
  return bytes;
}

}  // namespace percale::fabric
