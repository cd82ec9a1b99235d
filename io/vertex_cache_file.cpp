// LoadVertexCache: the samples of a file for the vertices of a mesh. Nothing in a file is believed before it is
// checked.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "core/memory.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/mdd_cache.h"
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

using Stream = std::unique_ptr<std::FILE, CloseFile>;

/// What stands before the samples of a file, and how to read these.
struct SampleSource {
  std::int32_t points = 0, frames = 0;
  double spacing = 0;
  bool inSeconds = false;
  Vec3 (*pointOf)(const unsigned char* bytes) = nullptr;  ///< Of kPointBytes bytes.
};

constexpr std::size_t kPointBytes = kPointCachePointBytes;
static_assert(kPointBytes == kMddPointBytes);

/// Reads that many bytes from the start of a file.
template <std::size_t count>
Result<std::array<unsigned char, count>> ReadHead(std::FILE* stream, std::uint64_t size, const std::string& name,
                                                  const char* format) {
  std::array<unsigned char, count> bytes{};
  if (size >= count && std::fread(bytes.data(), 1, count, stream) == count) return bytes;
  return MakeError(name, "ends after " + std::to_string(size) + " bytes, expected " + format + " header of " +
                             std::to_string(count) + " bytes; it was cut short");
}

Result<SampleSource> ReadPointCacheHead(std::FILE* stream, std::uint64_t size, const std::string& name) {
  const auto bytes = ReadHead<kPointCacheHeadBytes>(stream, size, name, "a PointCache2");
  if (!bytes) return bytes.diagnostics();
  const auto head = ParsePointCacheHead(*bytes, size, name);
  if (!head) return head.diagnostics();
  return SampleSource{head->points, head->frames, head->frameSeconds, false, PointCachePoint};
}

/// All but the times.
Result<SampleSource> ReadMddHead(std::FILE* stream, std::uint64_t size, const std::string& name) {
  const auto bytes = ReadHead<kMddHeadBytes>(stream, size, name, "an MDD");
  if (!bytes) return bytes.diagnostics();
  const auto head = ParseMddHead(*bytes, size, name);
  if (!head) return head.diagnostics();
  return SampleSource{head->points, head->frames, 0, true, MddPoint};
}

Diagnostic StoppedWithin(const std::string& name, const std::string& what) {
  return MakeError(name, "reading stopped within " + what + "; the file changes or its disk fails");
}

Status ReadMddTimes(std::FILE* stream, const std::string& name, SampleSource& source) {
  std::vector<unsigned char> bytes(kMddTimeBytes * static_cast<std::size_t>(source.frames));
  if (std::fread(bytes.data(), 1, bytes.size(), stream) != bytes.size()) return StoppedWithin(name, "its times");
  const auto spacing = ParseMddSpacing(bytes, name);
  if (!spacing) return spacing.diagnostics();
  source.spacing = *spacing;
  return Ok();
}

/// Whether the head of a file fits the mesh and this machine.
Status CheckHead(const SampleSource& source, std::uint64_t size, const RestMesh& mesh, const std::string& name) {
  if (source.frames == 0)
    return MakeError(name, "expected at least one sample, got none; export the animation's frames");
  const std::size_t expected =
      mesh.sourceCount > 0 ? static_cast<std::size_t>(mesh.sourceCount) : mesh.positions.size();
  if (static_cast<std::size_t>(source.points) != expected) {
    return MakeError(name, "expected as many points per sample as the mesh " + Quote(mesh.name, 40) +
                               " has vertices in its file, " + std::to_string(expected) + ", got " +
                               std::to_string(source.points) +
                               "; export both from the same object, without what changes its vertices on the way");
  }
  const std::uint64_t memory = AvailableMemory();
  if (memory > 0 && size > memory) {
    return MakeError(name, "expected a cache that fits this machine's memory of " + std::to_string(memory >> 20) +
                               " MB, got one of " + std::to_string(size >> 20) + " MB; export fewer samples");
  }
  return Ok();
}

Result<VertexCache> ReadSamples(std::FILE* stream, const SampleSource& source, const RestMesh& mesh, double scale,
                                const std::string& name) {
  VertexCache cache;
  cache.spacing = source.spacing;
  cache.inSeconds = source.inSeconds;
  cache.samples = source.frames;
  cache.positions.reserve(3 * mesh.positions.size() * static_cast<std::size_t>(source.frames));
  std::vector<unsigned char> sample(static_cast<std::size_t>(source.points) * kPointBytes);
  for (std::int32_t s = 0; s < source.frames; ++s) {
    if (std::fread(sample.data(), 1, sample.size(), stream) != sample.size())
      return StoppedWithin(name, "sample " + std::to_string(s));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const std::size_t vertex = SourceOf(mesh, v);
      const Vec3 x = source.pointOf(&sample[vertex * kPointBytes]);
      for (const double value : {x.x, x.y, x.z}) {
        if (const auto problem = CoordinateProblem(value, scale)) {
          return MakeError(name, "sample " + std::to_string(s) + ", vertex " + std::to_string(vertex) +
                                     " (counted from 0): " + *problem);
        }
        cache.positions.push_back(static_cast<float>(value));
      }
    }
  }
  cache.greatestMove = GreatestMove(cache, 3 * mesh.positions.size());
  return cache;
}

}  // namespace

Result<VertexCache> LoadVertexCache(const fs::path& file, const RestMesh& mesh, double scale) {
  const std::string name = PathText(file);
  const std::string extension = LowerExtension(file);
  const bool mdd = extension == ".mdd";
  if (extension != ".pc2" && !mdd) {
    return MakeError(name, "expected a vertex cache that ends in .pc2 or .mdd, got " +
                               (extension.empty() ? "no extension" : Quote(extension, 20)) +
                               "; export the animation as PointCache2 or MDD");
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
  const Stream stream(OpenFile(file, "rb"));
  if (!stream || code) return MakeError(name, "cannot be read: " + std::generic_category().message(errno));
  auto source = mdd ? ReadMddHead(stream.get(), size, name) : ReadPointCacheHead(stream.get(), size, name);
  if (!source) return source.diagnostics();
  if (const Status fits = CheckHead(*source, size, mesh, name); !fits) return fits.diagnostics();
  if (mdd) {
    if (const Status read = ReadMddTimes(stream.get(), name, *source); !read) return read.diagnostics();
  }
  return ReadSamples(stream.get(), *source, mesh, scale, name);
}

}  // namespace percale
