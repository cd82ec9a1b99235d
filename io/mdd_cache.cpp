#include "io/mdd_cache.h"

#include <bit>
#include <cmath>

#include "core/text.h"

namespace percale {
namespace {

/// How far a time may be off an even one, as a share of the time between two: exporters round to milliseconds.
constexpr double kUneven = 0.05;
/// The same of what a float loses of a late time.
constexpr double kFloatRounding = 1.2e-7;

std::uint32_t BigEndianNumber(const unsigned char* bytes) {
  std::uint32_t number = 0;
  for (int i = 0; i < 4; ++i) number = number << 8 | bytes[i];
  return number;
}

double BigEndianFloat(const unsigned char* bytes) {
  return double(std::bit_cast<float>(BigEndianNumber(bytes)));
}

}  // namespace

Result<MddHead> ParseMddHead(const std::array<unsigned char, kMddHeadBytes>& bytes, std::uint64_t size,
                             const std::string& name) {
  const auto frames = static_cast<std::int32_t>(BigEndianNumber(&bytes[0])),
             points = static_cast<std::int32_t>(BigEndianNumber(&bytes[4]));
  if (frames < 0) return MakeError(name, "expected a number of frames >= 0, got " + std::to_string(frames));
  if (points < 0) return MakeError(name, "expected a number of points >= 0, got " + std::to_string(points));
  // By division: the product of two lies may overflow.
  const std::uint64_t frame = kMddTimeBytes + kMddPointBytes * std::uint64_t(points), payload = size - bytes.size();
  if (payload % frame != 0 || payload / frame != std::uint64_t(frames)) {
    return MakeError(name, "expected " + std::to_string(frames) + " frames of " + std::to_string(points) +
                               " points, 12 bytes each and 4 for its time, after the header, got " +
                               std::to_string(payload) + " bytes; it was cut short or damaged, or is no MDD file");
  }
  return MddHead{points, frames};
}

Result<double> ParseMddSpacing(std::span<const unsigned char> times, const std::string& name) {
  const std::size_t count = times.size() / kMddTimeBytes;
  const auto at = [&](std::size_t i) { return BigEndianFloat(&times[kMddTimeBytes * i]); };
  const auto sampleTime = [](std::size_t i) { return "the time of sample " + std::to_string(i) + ": expected "; };
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(at(i)))
      return MakeError(name, sampleTime(i) + "a number, got " + (std::isnan(at(i)) ? "NaN" : "Infinity"));
  }
  if (count < 2) return 0.0;
  const double first = at(0), spacing = (at(count - 1) - first) / static_cast<double>(count - 1);
  if (spacing < 0) {
    return MakeError(name, "expected times that rise, got " + FormatNumber(RoundDown(first, 4)) +
                               " s at the first and " + FormatNumber(RoundDown(at(count - 1), 4)) +
                               " s at the last; export the frames in order");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double even = first + spacing * static_cast<double>(i);
    if (std::abs(at(i) - even) <= kUneven * spacing + kFloatRounding * std::abs(at(i))) continue;
    return MakeError(name, sampleTime(i) + FormatNumber(RoundDown(even, 4)) +
                               " s, for the times of samples must be even, got " + FormatNumber(RoundDown(at(i), 4)) +
                               " s; export every frame, in order");
  }
  return spacing;
}

Vec3 MddPoint(const unsigned char* bytes) {
  return {BigEndianFloat(bytes), BigEndianFloat(bytes + 4), BigEndianFloat(bytes + 8)};
}

}  // namespace percale
