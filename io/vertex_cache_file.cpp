// LoadVertexCache: the samples of a file for the vertices of a mesh. Nothing in a file is believed before it is
// checked.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/memory.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/mesh_source.h"
#include "io/point_cache.h"
#include "percale/mesh_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};

/// The number of the vertex in the mesh's file.
std::size_t SourceOf(const RestMesh& mesh, std::size_t vertex) {
  return mesh.source.empty() ? vertex : static_cast<std::size_t>(mesh.source[vertex]);
}

/// `numbers`: of a sample.
float GreatestMove(const VertexCache& cache, std::size_t numbers) {
  float most = 0;
  for (std::size_t k = numbers; k < cache.positions.size(); k += 3) {
    const auto way = [&](std::size_t axis) { return cache.positions[k + axis] - cache.positions[k + axis - numbers]; };
    most = std::max(most, std::hypot(way(0), way(1), way(2)));
  }
  return most;
}

}  // namespace

Result<VertexCache> LoadVertexCache(const fs::path& file, const RestMesh& mesh, double scale) {
  const std::string name = PathText(file);
  if (const std::string extension = LowerExtension(file); extension != ".pc2") {
    return MakeError(name, "expected a vertex cache that ends in .pc2, got " +
                               (extension.empty() ? "no extension" : Quote(extension, 20)) +
                               "; export the animation as PointCache2");
  }
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (!fs::exists(status)) return MakeError(name, "there is no such file; check the name and the folder");
  if (!fs::is_regular_file(status)) {
    return MakeError(
        name, fs::is_directory(status) ? "expected a file, got a folder" : "expected a file, got a device or pipe");
  }
  const std::uint64_t size = fs::file_size(file, code);
  errno = 0;
  const std::unique_ptr<std::FILE, CloseFile> stream(OpenFile(file, "rb"));
  if (!stream || code) return MakeError(name, "cannot be read: " + std::generic_category().message(errno));
  std::array<unsigned char, kPointCacheHeadBytes> bytes{};
  if (size < bytes.size() || std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
    return MakeError(name, "ends after " + std::to_string(size) +
                               " bytes, expected a PointCache2 header of 32 bytes; it was cut short");
  }
  const auto head = ParsePointCacheHead(bytes, size, name);
  if (!head) return head.diagnostics();
  if (head->frames == 0)
    return MakeError(name, "expected at least one sample, got none; export the animation's frames");
  const std::size_t expected =
      mesh.sourceCount > 0 ? static_cast<std::size_t>(mesh.sourceCount) : mesh.positions.size();
  const auto points = static_cast<std::size_t>(head->points);
  if (points != expected) {
    return MakeError(name, "expected as many points per sample as the mesh " + Quote(mesh.name, 40) +
                               " has vertices in its file, " + std::to_string(expected) + ", got " +
                               std::to_string(points) +
                               "; export both from the same object, without what changes its vertices on the way");
  }
  const std::uint64_t memory = AvailableMemory();
  if (memory > 0 && size > memory) {
    return MakeError(name, "expected a cache that fits this machine's memory of " + std::to_string(memory >> 20) +
                               " MB, got one of " + std::to_string(size >> 20) + " MB; export fewer samples");
  }
  VertexCache cache;
  cache.spacing = head->frameSeconds;
  cache.samples = head->frames;
  cache.positions.reserve(3 * mesh.positions.size() * static_cast<std::size_t>(head->frames));
  std::vector<unsigned char> sample(points * kPointCachePointBytes);
  for (std::int32_t s = 0; s < head->frames; ++s) {
    if (std::fread(sample.data(), 1, sample.size(), stream.get()) != sample.size()) {
      return MakeError(name,
                       "reading stopped within sample " + std::to_string(s) + "; the file changes or its disk fails");
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const std::size_t source = SourceOf(mesh, v);
      const Vec3 x = PointCachePoint(&sample[source * kPointCachePointBytes]);
      for (const double value : {x.x, x.y, x.z}) {
        if (const auto problem = CoordinateProblem(value, scale)) {
          return MakeError(name, "sample " + std::to_string(s) + ", vertex " + std::to_string(source) +
                                     " (counted from 0): " + *problem);
        }
        cache.positions.push_back(static_cast<float>(value));
      }
    }
  }
  cache.greatestMove = GreatestMove(cache, 3 * mesh.positions.size());
  return cache;
}

}  // namespace percale
