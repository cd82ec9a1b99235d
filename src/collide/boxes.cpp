#include "collide/boxes.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace percale {
namespace {

constexpr double kBoxesPerSpacing = 3;  // a box of the spatial map spans three spacings of the grid

std::int64_t BoxIndex(double coordinate, double size) {
  return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / size), -1e15, 1e15));
}

std::uint64_t Power(std::int64_t base, int exponent) {
  std::uint64_t result = 1;
  for (int i = 0; i < exponent; ++i) result *= static_cast<std::uint64_t>(base);
  return result;
}

}  // namespace

Vec3 BoxSize(std::span<const ClothSettings> cloths) {
  double width = 0, height = 0;
  for (const ClothSettings& cloth : cloths) {
    width = std::max(width, kBoxesPerSpacing * cloth.width / cloth.numWidthPoints);
    height = std::max(height, kBoxesPerSpacing * cloth.height / cloth.numHeightPoints);
  }
  return {width, height, std::max(width, height)};
}

Box BoxOf(const Vec3& point, const Vec3& boxSize) {
  return {BoxIndex(point.x, boxSize.x), BoxIndex(point.y, boxSize.y), BoxIndex(point.z, boxSize.z)};
}

std::uint64_t SharedBucket(const Box& box, HashFunction hash) {
  switch (hash) {
    case HashFunction::Linear:
      return static_cast<std::uint64_t>(7 * box.x + 5 * box.y + 3 * box.z);
    case HashFunction::Powers:
      return Power(box.x, 6) + Power(box.y, 4) + Power(box.z, 2);
    case HashFunction::Exact:
    case HashFunction::Brute:
      break;
  }
  return 0;
}

PairCounts CountPairs(std::span<const Vec3> positions, const Vec3& boxSize, double distance, HashFunction hash) {
  std::vector<Box> boxes;
  std::vector<std::uint64_t> buckets;
  for (const Vec3& point : positions) {
    boxes.push_back(BoxOf(point, boxSize));
    buckets.push_back(SharedBucket(boxes.back(), hash));
  }
  PairCounts counts;
  for (std::size_t a = 0; a < positions.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const bool sameBox = boxes[a] == boxes[b];
      const bool compared = hash == HashFunction::Exact ? sameBox : buckets[a] == buckets[b];
      const Vec3 apart = positions[a] - positions[b];
      const bool close = Dot(apart, apart) <= distance * distance;
      counts.compared += compared;
      counts.fromOtherBoxes += compared && !sameBox;
      counts.close += close;
      counts.missed += close && !compared;
    }
  }
  return counts;
}

}  // namespace percale
