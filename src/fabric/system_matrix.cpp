#include "fabric/system_matrix.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/memory.h"
#include "fabric/real4.h"

namespace percale::fabric {
namespace {

/// Pivots of a diagonal block below this share of its trace are rounding of floats.
constexpr double kLeastPivot = 1e-7;

/// Inverts a symmetric block.
void Invert(const std::array<Real, 9>& block, Real* inverse) {
  const double a = block[0], b = block[4], c = block[8];
  const double d = .5 * (block[1] + block[3]), e = .5 * (block[2] + block[6]), f = .5 * (block[5] + block[7]);
  const double trace = a + b + c;
  const double minor = a * b - d * d;
  const double xx = b * c - f * f, xy = e * f - d * c, xz = d * f - b * e;
  const double determinant = a * xx + d * xy + e * xz;
  const double least = kLeastPivot * trace;
  if (a > least && minor > least * a && determinant > least * minor && std::isfinite(determinant)) {
    const double s = 1 / determinant;
    const double yz = d * e - a * f;
    const double symmetric[9] = {xx, xy, xz, xy, a * c - e * e, yz, xz, yz, minor};
    for (int k = 0; k < 9; ++k) inverse[k] = static_cast<Real>(s * symmetric[k]);
    return;
  }
  double scale = trace;
  if (!(scale > 0)) {
    for (const Real entry : block) scale = std::max(scale, std::abs(static_cast<double>(entry)));
  }
  for (int k = 0; k < 9; ++k) inverse[k] = 0;
  for (const int k : {0, 4, 8}) inverse[k] = static_cast<Real>(scale > 0 && std::isfinite(scale) ? 1 / scale : 1);
}

template <class Array>
void Grow(Array& array, std::size_t size) {
  if (array.size() < size) array.resize(std::max(size, array.size() + array.size() / 2));
}

}  // namespace

std::int32_t BlockPattern::Find(std::int32_t row, std::int32_t other) const {
  const std::int32_t low = std::min(row, other), kind = columns.kind[low];
  const auto end = columns.offset.begin() + columns.first[kind + 1];
  // On and right of the diagonal.
  const auto begin = end - (storedFirst[low + 1] - storedFirst[low]);
  const std::int32_t offset = std::max(row, other) - low;
  const auto found = std::lower_bound(begin, end, offset);
  return found != end && *found == offset ? storedFirst[low] + static_cast<std::int32_t>(found - begin) : -1;
}

PatternMaker::PatternMaker(int rows) : columns_(rows), mirrored_(rows, 0) {
  storedFirst_.reserve(static_cast<std::size_t>(rows) + 1);
  storedFirst_.push_back(0);
}

void PatternMaker::Append(std::span<const std::int32_t> columns) {
  const auto row = static_cast<std::int32_t>(storedFirst_.size()) - 1;
  row_.clear();
  std::int32_t stored = 0;
  for (const std::int32_t column : columns) {
    // Right of the diagonal the rows of a column come in order.
    row_.push_back({column, column < row ? ++mirrored_[column] : 0});
    stored += column < row ? 0 : 1;
  }
  columns_.Append(row_);
  storedFirst_.push_back(storedFirst_.back() + stored);
}

BlockPattern PatternMaker::Take() {
  return {columns_.Take(), std::move(storedFirst_)};
}

BlockPattern MakePattern(int vertices, std::span<const Triangle> triangles, std::span<const Edge> morePairs) {
  const auto forPairs = [&](auto&& couple) {
    for (const Triangle& t : triangles) couple(t.a, t.b), couple(t.b, t.c), couple(t.c, t.a);
    for (const Edge& pair : morePairs) couple(pair.a, pair.b);
  };
  // Rows with a column for each time that two are coupled; then each once.
  std::vector<std::int32_t> first(static_cast<std::size_t>(vertices) + 1, 1), column;
  first[0] = 0;
  forPairs([&](std::int32_t a, std::int32_t b) { ++first[a + 1], ++first[b + 1]; });
  for (int v = 0; v < vertices; ++v) first[v + 1] += first[v];
  column.resize(first.back());
  std::vector<std::int32_t> next(first.begin(), first.end() - 1);
  for (int v = 0; v < vertices; ++v) column[next[v]++] = v;
  forPairs([&](std::int32_t a, std::int32_t b) { column[next[a]++] = b, column[next[b]++] = a; });
  PatternMaker pattern(vertices);
  for (int v = 0; v < vertices; ++v) {
    const auto begin = column.begin() + first[v], end = column.begin() + first[v + 1];
    std::sort(begin, end);
    pattern.Append({begin, std::unique(begin, end)});
  }
  return pattern.Take();
}

void SumByColumn(std::vector<std::pair<std::int32_t, double>>& row) {
  std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  auto end = row.begin();
  for (auto from = row.begin(); from != row.end(); ++from) {
    if (end != row.begin() && std::prev(end)->first == from->first)
      std::prev(end)->second += from->second;
    else
      *end++ = *from;
  }
  row.erase(end, row.end());
}

ScalarMatrix MakeScalarMatrix(int rows, std::span<const ScalarEntry> entries) {
  std::vector<std::vector<std::pair<std::int32_t, double>>> byRow(rows);
  for (const ScalarEntry& entry : entries) byRow[entry.row].push_back({entry.column, entry.value});
  RowSharer<double> matrix(rows);
  for (auto& row : byRow) {
    SumByColumn(row);
    matrix.Append(row);
  }
  return matrix.Take();
}

void SystemMatrix::SetUp(BlockPattern pattern, const ScalarMatrix& constant, std::span<const std::uint8_t> pinned) {
  pattern_ = std::move(pattern);
  SetUp(constant, pinned);
}

void SystemMatrix::SetUp(const ScalarMatrix& constant, std::span<const std::uint8_t> pinned) {
  assert(constant.rows() == pattern_.rows());
  pinned_.assign(pinned.begin(), pinned.end());
  const int n = rows();
  cleared_.clear();
  diagonal_.assign(n, 0);
  constant_ = SharedRows<Real>();
  RowSharer<Real> shared(n);
  std::vector<std::pair<std::int32_t, Real>> values, outside;  // of a row
  for (int row = 0; row < n; ++row) {
    values.clear();
    outside.clear();
    pattern_.columns.ForRow(row, [&](std::int32_t column, std::int32_t) {
      if (column < row) return;
      if (Pinned(row) || Pinned(column)) cleared_.push_back(pattern_.Find(row, column));
      if (column > row) values.push_back({column, 0});
    });
    constant.ForRow(row, [&](std::int32_t column, double value) {
      if (Pinned(row) || Pinned(column)) return;
      const std::int32_t inside = pattern_.Find(row, column);
      if (inside < 0)
        outside.push_back({column, static_cast<Real>(value)});
      else if (column == row)
        diagonal_[row] = static_cast<Real>(value);
      else if (column > row)
        values[inside - pattern_.storedFirst[row] - 1].second = static_cast<Real>(value);
    });
    values.insert(values.end(), outside.begin(), outside.end());
    shared.Append(values);
  }
  constant_ = shared.Take();
  cleared_.shrink_to_fit();
  blocks_.assign(9 * static_cast<std::size_t>(pattern_.stored()) + 1, 0);
  inverse_.assign(9 * static_cast<std::size_t>(n) + 1, 0);
  extra_.any = false;
}

void SystemMatrix::Reset(const Executor& executor) {
  ForRange(executor, static_cast<std::size_t>(rows()), [&](int row) {
    const std::int32_t stored = pattern_.storedFirst[row + 1] - pattern_.storedFirst[row];
    const Real* const constant = constant_.value.data() + constant_.first[constant_.kind[row]];
    Real* block = DiagonalBlock(row);
    for (std::int32_t k = 0; k < stored; ++k, block += 9) {
      std::fill_n(block, 9, Real{0});
      block[0] = block[4] = block[8] = k == 0 ? diagonal_[row] : constant[k - 1];
    }
  });
}

void SystemMatrix::SetExtra(std::span<const ExtraTerm> terms, const Executor& executor) {
  const int n = rows();
  const auto counts = [&](const ExtraTerm& t, int k) {
    return t.vertex[k] >= 0 && t.weight[k] != 0 && !Pinned(t.vertex[k]);
  };
  extra_.any = !terms.empty();
  if (!extra_.any) return;
  // Which terms each row is in, and room for a block per other vertex of each.
  extraFirst_.assign(static_cast<std::size_t>(n) + 1, 0);
  extra_.begin.resize(n);
  extra_.end.assign(n, 0);
  for (const ExtraTerm& t : terms) {
    int vertices = 0;
    for (int k = 0; k < 4; ++k) vertices += counts(t, k) ? 1 : 0;
    for (int k = 0; k < 4; ++k) {
      if (!counts(t, k)) continue;
      ++extraFirst_[t.vertex[k] + 1];
      extra_.end[t.vertex[k]] += vertices;
    }
  }
  std::int32_t room = 0;
  for (int row = 0; row < n; ++row) {
    extraFirst_[row + 1] += extraFirst_[row];
    extra_.begin[row] = room;
    room += extra_.end[row];
    extra_.end[row] = extraFirst_[row];  // for now: where the next of its terms goes
  }
  Grow(extraOrder_, extraFirst_[n]);
  Grow(extra_.column, room);
  Grow(extra_.block, 9 * static_cast<std::size_t>(room) + 1);
  for (std::size_t t = 0; t < terms.size(); ++t) {
    for (int k = 0; k < 4; ++k) {
      if (counts(terms[t], k)) extraOrder_[extra_.end[terms[t].vertex[k]]++] = static_cast<std::int32_t>(4 * t + k);
    }
  }
  executor.ForChunks(Chunks(n), [&](int chunk) {
    for (int row = chunk * kRowsPerChunk; row < std::min(n, (chunk + 1) * kRowsPerChunk); ++row) {
      const std::int32_t begin = extra_.begin[row];
      std::int32_t end = begin;
      for (std::int32_t e = extraFirst_[row]; e < extraFirst_[row + 1]; ++e) {
        const ExtraTerm& term = terms[extraOrder_[e] / 4];
        const Real own = term.weight[extraOrder_[e] % 4];
        for (int k = 0; k < 4; ++k) {
          if (!counts(term, k)) continue;
          std::int32_t at = begin;
          while (at < end && extra_.column[at] != term.vertex[k]) ++at;
          Real* sum = &extra_.block[9 * static_cast<std::size_t>(at)];
          if (at == end) {
            extra_.column[end++] = term.vertex[k];
            std::fill_n(sum, 9, Real{0});
          }
          const Real weight = own * term.weight[k];
          for (int c = 0; c < 9; ++c) sum[c] += weight * term.block[c];
        }
      }
      extra_.end[row] = end;
    }
  });
}

void SystemMatrix::Finish(const Executor& executor) {
  for (const std::int32_t k : cleared_) std::fill_n(Block(k), 9, Real{0});
  executor.ForChunks(Chunks(rows()), [&](int chunk) {
    for (int row = chunk * kRowsPerChunk; row < std::min(rows(), (chunk + 1) * kRowsPerChunk); ++row) {
      if (Pinned(row)) {
        for (const int c : {0, 4, 8}) DiagonalBlock(row)[c] = 1;
      }
      Invert(WholeDiagonal(row), &inverse_[9 * static_cast<std::size_t>(row)]);
    }
  });
}

std::array<Real, 9> SystemMatrix::WholeDiagonal(int row) const {
  std::array<Real, 9> sum;
  std::copy_n(DiagonalBlock(row), 9, sum.begin());
  if (!extra_.any) return sum;
  for (std::int32_t k = extra_.begin[row]; k < extra_.end[row]; ++k) {
    if (extra_.column[k] != row) continue;
    for (int c = 0; c < 9; ++c) sum[c] += extra_.block[9 * static_cast<std::size_t>(k) + c];
  }
  return sum;
}

RowsArgs SystemMatrix::Rows(int chunk, const Real* x, Real* y) const {
  return {.begin = chunk * kRowsPerChunk,
          .end = std::min(rows(), (chunk + 1) * kRowsPerChunk),
          .columns = pattern_.columns.View(),
          .storedFirst = pattern_.storedFirst.data(),
          .blocks = blocks_.data(),
          .constant = constant_.View(),
          .extraBegin = extra_.begin.data(),
          .extraEnd = extra_.end.data(),
          .extraColumn = extra_.column.data(),
          .extraBlocks = extra_.any ? extra_.block.data() : nullptr,
          .inverse = inverse_.data(),
          .omega = 0,
          .right = nullptr,
          .x = x,
          .y = y};
}

void SystemMatrix::Multiply(const Real* x, Real* y, const Executor& executor) const {
  executor.ForChunks(Chunks(rows()), [&](int chunk) { kernels_->multiply(Rows(chunk, x, y)); });
}

double SystemMatrix::MultiplyDot(const Real* x, Real* y, std::span<double> chunkSums, const Executor& executor) const {
  executor.ForChunks(Chunks(rows()), [&](int chunk) { chunkSums[chunk] = kernels_->multiply(Rows(chunk, x, y)); });
  double sum = 0;
  for (const double part : chunkSums) sum += part;
  return sum;
}

void SystemMatrix::Residual(const Real* b, const Real* x, Real* y, const Executor& executor) const {
  executor.ForChunks(Chunks(rows()), [&](int chunk) {
    RowsArgs arguments = Rows(chunk, x, y);
    arguments.right = b;
    kernels_->residual(arguments);
  });
}

void SystemMatrix::Smooth(Real omega, const Real* b, const Real* x, Real* y, const Executor& executor) const {
  executor.ForChunks(Chunks(rows()), [&](int chunk) {
    RowsArgs arguments = Rows(chunk, x, y);
    arguments.omega = omega, arguments.right = b;
    kernels_->smooth(arguments);
  });
}

void SystemMatrix::SmoothFromZero(Real omega, const Real* b, Real* y, const Executor& executor) const {
  executor.ForChunks(Chunks(rows()), [&](int chunk) {
    Real* __restrict out = y;
    for (int row = chunk * kRowsPerChunk; row < std::min(rows(), (chunk + 1) * kRowsPerChunk); ++row) {
      const std::size_t at = 3 * static_cast<std::size_t>(row);
      Store3(Product(InverseDiagonal(row), b + at) * omega, out + at);
    }
  });
}

void SystemMatrix::ToDense(double* dense) const {
  const std::size_t n = 3 * static_cast<std::size_t>(rows());
  std::fill_n(dense, n * n, 0.0);
  const auto add = [&](int row, int column, const Real* block) {
    for (int k = 0; k < 9; ++k) dense[(3 * row + k % 3) * n + 3 * column + k / 3] += static_cast<double>(block[k]);
  };
  for (int row = 0; row < rows(); ++row) {
    const Real* block = DiagonalBlock(row);
    pattern_.columns.ForRow(row, [&](std::int32_t column, std::int32_t) {
      if (column < row) return;
      add(row, column, block);
      if (column > row) {
        std::array<Real, 9> transposed;
        for (int c = 0; c < 9; ++c) transposed[c] = block[c % 3 * 3 + c / 3];
        add(column, row, transposed.data());
      }
      block += 9;
    });
    ForRest(row, [&](std::int32_t column, Real value) {
      for (int r = 0; r < 3; ++r) dense[(3 * row + r) * n + 3 * column + r] += static_cast<double>(value);
    });
    for (std::int32_t k = extra_.any ? extra_.begin[row] : 0; extra_.any && k < extra_.end[row]; ++k) {
      add(row, extra_.column[k], &extra_.block[9 * static_cast<std::size_t>(k)]);
    }
  }
}

std::size_t SystemMatrix::MemoryBytes() const {
  return pattern_.MemoryBytes() + constant_.MemoryBytes() + BytesOf(diagonal_) + BytesOf(pinned_) + BytesOf(cleared_) +
         BytesOf(blocks_) + BytesOf(inverse_) + BytesOf(extra_.begin) + BytesOf(extra_.end) + BytesOf(extra_.column) +
         BytesOf(extra_.block) + BytesOf(extraFirst_) + BytesOf(extraOrder_);
}

}  // namespace percale::fabric
