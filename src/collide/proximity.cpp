#include "collide/proximity.h"

#include <algorithm>
#include <cmath>

#include "collide/kernels.h"

namespace percale {
namespace {

constexpr int kMostAdvances = 80;
/// An advance that leaves this share of the way to the floor is close enough.
constexpr double kClose = 0.05;
/// Takes rounding off what may be advanced.
constexpr double kSafe = 1 - 1e-9;

/// Whether one direction is seen to part a pair with the gap `floor` where it is now and where it will be then, and so
/// all the way between: that in which they are apart now, or then, or one between the two.
bool ArePartedThroughout(PairKind kind, const Corners<double>& x, const PairState& now, const Corners<double>& next,
                         const PairState& then, double floor) {
  if (now.gap >= floor && GapAlong(kind, next, now.normal) >= floor) return true;
  if (!(then.gap >= floor)) return false;
  if (GapAlong(kind, x, then.normal) >= floor) return true;
  const Vector3<double> sum = now.normal + then.normal;
  const double square = Dot(sum, sum);
  if (!(square > 0.01)) return false;
  const Vector3<double> between = sum * (1 / std::sqrt(square));
  return GapAlong(kind, x, between) >= floor && GapAlong(kind, next, between) >= floor;
}

}  // namespace

PairState StateOf(PairKind kind, const Corners<double>& x) {
  const Closest<double> closest = ClosestOf(kind, x);
  PairState state;
  state.weight = closest.weight;
  const double length = std::sqrt(closest.squared);
  if (!(length > 0)) {
    state.normal = {0, 1, 0};
    return state;
  }
  state.normal = closest.way * (1 / length);
  state.gap = std::max(0.0, GapAlong(kind, x, state.normal));
  return state;
}

void StatesOf(PairKind kind, std::span<const VertexQuad> pairs, std::span<const Vec3> x, std::span<PairState> states) {
  static_assert(sizeof(PairState) == collide::PairStateArgs::kNumbers * sizeof(double));
  static_assert(sizeof(VertexQuad) == 4 * sizeof(std::int32_t));
  if (pairs.empty()) return;
  collide::BestKernels().pairStates({.edges = kind == PairKind::EdgeEdge,
                                     .count = static_cast<int>(pairs.size()),
                                     .quads = pairs.front().data(),
                                     .x = x.data(),
                                     .states = states.front().weight.data()});
}

Corners<double> After(const Corners<double>& x, const Corners<double>& way, double t) {
  Corners<double> moved;
  for (std::size_t k = 0; k < 4; ++k) moved[k] = x[k] + way[k] * t;
  return moved;
}

bool StaysApart(PairKind kind, const Corners<double>& x, const Corners<double>& way, const PairState& start,
                double floor) {
  if (Approach(kind, way) <= (start.gap - floor) * kSafe) return true;
  return start.gap >= floor && GapAlong(kind, After(x, way, 1), start.normal) >= floor;
}

double ShareApart(PairKind kind, const Corners<double>& x, const Corners<double>& way, const PairState& start,
                  double floor) {
  if (StaysApart(kind, x, way, start, floor)) return 1;
  const double speed = Approach(kind, way);
  const double enough = kClose * (start.gap - floor);
  double t = 0, longest = 1;
  Corners<double> at = x;
  PairState now = start;
  for (int advance = 0; advance < kMostAdvances && t < 1; ++advance) {
    const double room = now.gap - floor;
    if (!(room > 0) || (advance > 0 && room <= enough)) return t;
    const double safe = room * kSafe / speed;
    // Farther than is safe at any rate, if it is seen to be.
    double step = std::min(longest, 1 - t);
    Corners<double> next;
    PairState then;
    for (; step > 2 * safe; step *= 0.5) {
      next = After(x, way, t + step);
      then = StateOf(kind, next);
      if (ArePartedThroughout(kind, at, now, next, then, floor)) break;
    }
    if (step <= 2 * safe) {
      if (t + safe >= 1) return 1;
      step = safe;
      next = After(x, way, t + step);
      then = StateOf(kind, next);
    }
    t += step;
    longest = 2 * step;
    at = next;
    now = then;
  }
  // The last advance was safe by its bound, whatever was measured where it ended.
  return std::min(t, 1.0);
}

}  // namespace percale
