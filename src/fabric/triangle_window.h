#pragma once
/// \file
/// What is evaluated per triangle and summed per vertex, with room for as many triangles as are needed at once.

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/executor.h"
#include "fabric/fabric_model.h"
#include "fabric/system_matrix.h"
#include "fabric/window.h"

namespace percale::fabric {

/// Where what is evaluated of a triangle lies, while some vertices are summed.
struct LiveTriangles {
  std::int32_t begin = 0;  ///< Triangles before `begin` lie where those are that come `count` behind them.
  std::int32_t count = 0;

  /// Of a corner, 3 * triangle + 0, 1, 2: three times the place of its triangle and the same number.
  std::int32_t Place(std::int32_t corner) const {
    const std::int32_t place = corner - 3 * begin;
    return place < 0 ? place + 3 * count : place;
  }
};

class TriangleWindow {
 public:
  explicit TriangleWindow(const FabricModel& model);

  /// For how many triangles there has to be room.
  int live() const { return live_; }
  /// Where what is evaluated of a triangle goes.
  std::int32_t Place(std::int32_t triangle) const { return triangle % live_; }

  /// Calls evaluate(begin, end) for all triangles, some at a time, and rows(begin, end, LiveTriangles) for vertices
  /// whose triangles are evaluated. Each side by side, and always for the same ones.
  template <class Evaluate, class Rows>
  void ForRows(const Executor& executor, Evaluate&& evaluate, Rows&& rows) const {
    int made = 0;
    for (int slab = 0; slab < static_cast<int>(window_.end.size()); ++slab) {
      const int first = std::exchange(made, window_.end[static_cast<std::size_t>(slab)]);
      executor.ForChunks(made - first, [&](int block) {
        const int from = (first + block) * kRowsPerChunk;
        evaluate(from, std::min(from + kRowsPerChunk, triangles_));
      });
      const LiveTriangles live{std::max(0, made * kRowsPerChunk - 1) / live_ * live_, live_};
      const int begin = slab * kRowsPerSlab, count = std::min(kRowsPerSlab, vertices_ - begin);
      executor.ForChunks(Chunks(count), [&](int chunk) {
        const int from = begin + chunk * kRowsPerChunk;
        rows(from, std::min(from + kRowsPerChunk, begin + count), live);
      });
    }
  }

 private:
  /// Rows whose triangles are evaluated at once: what these come to takes 6 MB, and each thread of some has a few
  /// chunks.
  static constexpr int kRowsPerSlab = 32 * kRowsPerChunk;

  int vertices_, triangles_;
  Window window_;  // of kRowsPerChunk triangles each, for kRowsPerSlab rows each
  int live_ = 1;
};

}  // namespace percale::fabric
