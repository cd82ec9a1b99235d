#include "fabric/triangle_window.h"

#include <cstddef>
#include <vector>

namespace percale::fabric {

TriangleWindow::TriangleWindow(const FabricModel& model)
    : vertices_(model.vertexCount), triangles_(static_cast<int>(model.triangles.size())) {
  const std::int32_t makers = Chunks(triangles_);
  const auto slabs = static_cast<std::size_t>(Chunks(vertices_, kRowsPerSlab));
  std::vector<std::int32_t> first(slabs, makers), last(slabs, -1);
  for (int v = 0; v < vertices_; ++v) {
    const auto at = static_cast<std::size_t>(v);
    const std::int32_t begin = model.corners.first[at], end = model.corners.first[at + 1];
    if (begin == end) continue;
    std::int32_t &least = first[at / kRowsPerSlab], &most = last[at / kRowsPerSlab];
    const auto chunkOf = [&](std::int32_t e) {
      return model.corners.entry[static_cast<std::size_t>(e)] / 3 / kRowsPerChunk;
    };
    least = std::min(least, chunkOf(begin));
    most = std::max(most, chunkOf(end - 1));
  }
  window_ = MakeWindow(makers, first, last);
  live_ = window_.slots * kRowsPerChunk;
}

}  // namespace percale::fabric
