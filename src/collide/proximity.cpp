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

/// A bound of how fast the two things approach each other.
double Approach(PairKind kind, const Corners<double>& way) {
  const Vector3<double> mean = (way[0] + way[1] + way[2] + way[3]) * 0.25;
  double squared[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3<double> own = way[k] - mean;
    squared[k] = Dot(own, own);
  }
  if (kind == PairKind::VertexTriangle)
    return std::sqrt(squared[0]) + std::sqrt(std::max({squared[1], squared[2], squared[3]}));
  return std::sqrt(std::max(squared[0], squared[1])) + std::sqrt(std::max(squared[2], squared[3]));
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
  double t = 0;
  PairState now = start;
  for (int advance = 0; advance < kMostAdvances; ++advance) {
    const double room = now.gap - floor;
    if (!(room > 0) || (advance > 0 && room <= enough)) break;
    t += room * kSafe / speed;
    if (t >= 1) return 1;
    const Corners<double> moved = After(x, way, t);
    now = StateOf(kind, moved);
    if (now.gap >= floor && GapAlong(kind, After(x, way, 1), now.normal) >= floor) return 1;
  }
  // The last advance was safe by its bound, whatever was measured where it ended.
  return t;
}

}  // namespace percale
