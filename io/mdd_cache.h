#pragma once
/// \file
/// The head of an MDD file (.mdd), as LightWave and Blender write it: int32 frames, int32 points, a float time per
/// frame [s]; then three floats per point and frame, all big-endian.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "percale/diagnostic.h"
#include "percale/vec3.h"

namespace percale {

inline constexpr std::size_t kMddHeadBytes = 8;
inline constexpr std::size_t kMddTimeBytes = 4;
inline constexpr std::size_t kMddPointBytes = 12;

struct MddHead {
  std::int32_t points = 0, frames = 0;
};

/// Reads the head of a file of `size` bytes, and fails with what was expected and found where the two disagree. `name`
/// stands for the file in messages.
Result<MddHead> ParseMddHead(const std::array<unsigned char, kMddHeadBytes>& bytes, std::uint64_t size,
                             const std::string& name);

/// The time between two frames, by the times that follow the head [s]; 0 of a single one. Fails where they are not
/// even.
Result<double> ParseMddSpacing(std::span<const unsigned char> times, const std::string& name);

/// The point in kMddPointBytes bytes.
Vec3 MddPoint(const unsigned char* bytes);

}  // namespace percale
