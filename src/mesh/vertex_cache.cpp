#include "mesh/vertex_cache.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace percale {
namespace {

/// From here on the spacing of a file that does not say is in frames, below it in seconds.
constexpr double kLeastFrames = 0.2;

}  // namespace

bool HasCache(const ColliderSettings& settings) {
  return settings.shape == ColliderShape::Mesh && !settings.cache.empty() && settings.loaded && settings.loadedCache;
}

bool LacksCache(const ColliderSettings& settings) {
  if (settings.shape != ColliderShape::Mesh || settings.cache.empty()) return false;
  const VertexCache* const cache = settings.loadedCache.get();
  if (!cache || cache->file != settings.cache || !settings.loaded) return true;
  const std::size_t numbers = 3 * settings.loaded->mesh.positions.size();
  return cache->positions.size() != numbers * static_cast<std::size_t>(cache->samples);
}

double SampleSeconds(const Scene& scene, const ColliderSettings& settings) {
  if (settings.cacheRate > 0) return 1 / settings.cacheRate;
  const double spacing = settings.loadedCache->spacing;
  return settings.loadedCache->inSeconds || spacing < kLeastFrames ? spacing
                                                                   : spacing / scene.simulation.framesPerSecond;
}

void PlaceVertices(const Scene& scene, const ColliderSettings& settings, double time, std::span<Vec3> positions) {
  assert(settings.loaded && positions.size() == settings.loaded->mesh.positions.size());
  if (!HasCache(settings)) {
    const std::vector<Vec3>& rest = settings.loaded->mesh.positions;
    std::copy(rest.begin(), rest.end(), positions.begin());
    return;
  }
  const VertexCache& cache = *settings.loadedCache;
  const int last = cache.samples - 1;
  const double seconds = SampleSeconds(scene, settings);
  const double at = last > 0 ? std::clamp((time - settings.cacheStart) / seconds, 0.0, static_cast<double>(last)) : 0.0;
  const int sample = std::min(static_cast<int>(at), std::max(last - 1, 0));
  const double share = at - sample;
  const std::size_t numbers = 3 * positions.size();
  const float* const from = cache.positions.data() + numbers * static_cast<std::size_t>(sample);
  const float* const to = sample < last ? from + numbers : from;
  const auto between = [&](std::size_t k) {
    const double a = static_cast<double>(from[k]), b = static_cast<double>(to[k]);
    return settings.meshScale * (a + (b - a) * share);
  };
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] = {between(3 * v), between(3 * v + 1), between(3 * v + 2)};
}

}  // namespace percale
