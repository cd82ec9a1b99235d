#pragma once
/// \file
/// The head of a PointCache2 file (.pc2): 12 bytes of signature, int32 version, int32 points, float start, float time
/// between frames, int32 frames; then three floats per point and frame, all little-endian.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "percale/diagnostic.h"
#include "percale/vec3.h"

namespace percale {

inline constexpr std::size_t kPointCacheHeadBytes = 32;
inline constexpr std::size_t kPointCachePointBytes = 12;

struct PointCacheHead {
  std::int32_t points = 0, frames = 0;
  double frameSeconds = 0;  ///< [s]
};

/// Reads the head of a file of `size` bytes, and fails with what was expected and found where the two disagree. `name`
/// stands for the file in messages.
Result<PointCacheHead> ParsePointCacheHead(const std::array<unsigned char, kPointCacheHeadBytes>& bytes,
                                           std::uint64_t size, const std::string& name);

/// The point in kPointCachePointBytes bytes.
Vec3 PointCachePoint(const unsigned char* bytes);

}  // namespace percale
