#include "io/point_cache.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "core/text.h"

namespace percale {
namespace {

std::uint32_t Number(const unsigned char* bytes) {
  std::uint32_t number = 0;
  for (int i = 0; i < 4; ++i) number |= std::uint32_t(bytes[i]) << (8 * i);
  return number;
}

double LittleEndianFloat(const unsigned char* bytes) {
  return double(std::bit_cast<float>(Number(bytes)));
}

}  // namespace

Result<PointCacheHead> ParsePointCacheHead(const std::array<unsigned char, kPointCacheHeadBytes>& bytes,
                                           std::uint64_t size, const std::string& name) {
  if (std::memcmp(bytes.data(), "POINTCACHE2\0", 12) != 0) {
    return MakeError(name, "expected a PointCache2 file, which starts with \"POINTCACHE2\"");
  }
  const auto int32 = [&](std::size_t at) { return static_cast<std::int32_t>(Number(&bytes[at])); };
  const std::int32_t version = int32(12), points = int32(16), frames = int32(28);
  const double frameSeconds = LittleEndianFloat(&bytes[24]);
  if (version != 1) return MakeError(name, "expected PointCache2 of version 1, got version " + std::to_string(version));
  if (points < 0) return MakeError(name, "expected a number of points >= 0, got " + std::to_string(points));
  if (frames < 0) return MakeError(name, "expected a number of frames >= 0, got " + std::to_string(frames));
  if (!std::isfinite(frameSeconds) || frameSeconds < 0) {
    return MakeError(name, "expected a time between frames >= 0, got " + FormatNumber(frameSeconds));
  }
  // By division: the product of two lies may overflow.
  const std::uint64_t payload = size - bytes.size(), all = payload / kPointCachePointBytes;
  const bool empty = points == 0 || frames == 0;
  const bool fits =
      payload % kPointCachePointBytes == 0 &&
      (empty ? all == 0 : all % std::uint64_t(points) == 0 && all / std::uint64_t(points) == std::uint64_t(frames));
  if (!fits) {
    return MakeError(name, "expected " + std::to_string(frames) + " frames of " + std::to_string(points) +
                               " points, 12 bytes each, after the header, got " + std::to_string(payload) +
                               " bytes; it was cut short or damaged");
  }
  return PointCacheHead{points, frames, frameSeconds};
}

Vec3 PointCachePoint(const unsigned char* bytes) {
  return {LittleEndianFloat(bytes), LittleEndianFloat(bytes + 4), LittleEndianFloat(bytes + 8)};
}

}  // namespace percale
