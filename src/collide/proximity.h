#pragma once
/// \file
/// How near two small things are that move along straight lines: a vertex and a triangle, or two edges. Nothing that is
/// promised here rests on where their closest points were found: a gap is measured along a direction, and two convex
/// things with a gap along any direction are at least that far apart.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "collide/contact_mesh.h"
#include "math/vector3.h"
#include "percale/vec3.h"

namespace percale {

enum class PairKind { VertexTriangle, EdgeEdge };

/// The four vertices of a pair: a vertex and the corners of a triangle, or the ends of one edge and of another.
template <class T>
using Corners = std::array<Vector3<T>, 4>;

/// The closest points of a pair.
template <class T>
struct Closest {
  std::array<T, 4> weight{};  ///< Of the corners, in the way from the second thing's point to the first's: 1, -b, -c,
                              ///< -d or 1 - s, s, t - 1, -t. They sum to zero.
  Vector3<T> way;             ///< That way, the sum of weights times corners.
  T squared{};                ///< Its squared length; never less than that of the closest points.
};

namespace proximity {

template <class T>
void Keep(Closest<T>& best, const std::array<T, 4>& weight, const Corners<T>& x, auto valid) {
  // Weights sum to zero, so corners may count from the first: only short ways cancel.
  const Vector3<T> way = (x[1] - x[0]) * weight[1] + (x[2] - x[0]) * weight[2] + (x[3] - x[0]) * weight[3];
  const T squared = Dot(way, way);
  const T none = best.squared + best.squared;
  const auto better = best.squared > Select(valid, squared, none);
  for (std::size_t k = 0; k < 4; ++k) best.weight[k] = Select(better, weight[k], best.weight[k]);
  best.way = {Select(better, way.x, best.way.x), Select(better, way.y, best.way.y), Select(better, way.z, best.way.z)};
  best.squared = Select(better, squared, best.squared);
}

/// Where along ab the point nearest to p is, 0 .. 1; 0 where a and b are one.
template <class T>
T Along(const Vector3<T>& p, const Vector3<T>& a, const Vector3<T>& b) {
  const T zero = T(0.0), one = T(1.0);
  const Vector3<T> ab = b - a;
  const T length = Dot(ab, ab);
  const T s = Dot(p - a, ab) / Select(length > zero, length, one);
  return Lesser(Greater(s, zero), one);
}

}  // namespace proximity

/// Of x[0] and the triangle x[1] x[2] x[3].
template <class T>
Closest<T> ClosestVertexTriangle(const Corners<T>& x) {
  const T zero = T(0.0), one = T(1.0);
  const auto always = one > zero;
  Closest<T> best;
  best.squared = T(1e300);
  for (std::size_t k = 1; k < 4; ++k) {
    const std::size_t next = k % 3 + 1;
    const T s = proximity::Along(x[0], x[k], x[next]);
    std::array<T, 4> weight = {one, zero, zero, zero};
    weight[k] = s - one;
    weight[next] = zero - s;
    proximity::Keep(best, weight, x, always);
  }
  const Vector3<T> ab = x[2] - x[1], ac = x[3] - x[1], ap = x[0] - x[1];
  const Vector3<T> normal = Cross(ab, ac);
  const T square = Dot(normal, normal);
  const T over = one / Select(square > zero, square, one);
  const T b = Dot(Cross(ap, ac), normal) * over, c = Dot(Cross(ab, ap), normal) * over;
  const T inside = Lesser(Lesser(b, c), one - b - c);
  proximity::Keep(best, {one, b + c - one, zero - b, zero - c}, x, Select(square > zero, inside, zero) > zero);
  return best;
}

/// Of the edges x[0] x[1] and x[2] x[3].
template <class T>
Closest<T> ClosestEdgeEdge(const Corners<T>& x) {
  const T zero = T(0.0), one = T(1.0);
  const auto always = one > zero;
  Closest<T> best;
  best.squared = T(1e300);
  for (std::size_t k = 0; k < 2; ++k) {  // an end of the first edge
    const T t = proximity::Along(x[k], x[2], x[3]);
    std::array<T, 4> weight = {zero, zero, t - one, zero - t};
    weight[k] = one;
    proximity::Keep(best, weight, x, always);
  }
  for (std::size_t k = 2; k < 4; ++k) {
    const T s = proximity::Along(x[k], x[0], x[1]);
    std::array<T, 4> weight = {one - s, s, zero, zero};
    weight[k] = zero - one;
    proximity::Keep(best, weight, x, always);
  }
  const Vector3<T> p = x[1] - x[0], q = x[3] - x[2], r = x[0] - x[2];
  const T pp = Dot(p, p), qq = Dot(q, q), pq = Dot(p, q), pr = Dot(p, r), qr = Dot(q, r);
  const T determinant = pp * qq - pq * pq;
  const T over = one / Select(determinant > zero, determinant, one);
  const T s = (pq * qr - pr * qq) * over, t = (pp * qr - pq * pr) * over;
  const T inside = Lesser(Lesser(s, one - s), Lesser(t, one - t));
  proximity::Keep(best, {one - s, s, t - one, zero - t}, x, Select(determinant > zero, inside, zero) > zero);
  return best;
}

template <class T>
Closest<T> ClosestOf(PairKind kind, const Corners<T>& x) {
  return kind == PairKind::VertexTriangle ? ClosestVertexTriangle(x) : ClosestEdgeEdge(x);
}

/// How far the first thing lies beyond the second along a unit normal: where that is positive they are as far apart.
template <class T>
T GapAlong(PairKind kind, const Corners<T>& x, const Vector3<T>& normal) {
  const T y1 = Dot(x[1] - x[0], normal), y2 = Dot(x[2] - x[0], normal), y3 = Dot(x[3] - x[0], normal);
  const T zero = y1 - y1;
  if (kind == PairKind::VertexTriangle) return zero - Greater(Greater(y1, y2), y3);
  return Lesser(zero, y1) - Greater(y2, y3);
}

/// A pair as it is: the gap along the way between its closest points. `gap` is 0, and the normal any, where they meet.
struct PairState {
  std::array<double, 4> weight{};
  Vector3<double> normal;  ///< From the second thing to the first.
  double gap = 0;          ///< [m]; at most the distance, and all but rounding of it.
};
PairState StateOf(PairKind kind, const Corners<double>& x);
/// The same of many pairs of the vertices `x` [m], to the same bits and several at a time. `states`: one per pair.
void StatesOf(PairKind kind, std::span<const VertexQuad> pairs, std::span<const Vec3> x, std::span<PairState> states);

/// Where a pair is after the share t of its ways.
Corners<double> After(const Corners<double>& x, const Corners<double>& way, double t);

/// By how much the two things of a pair can come nearer to each other on their ways, at most [m].
inline double Approach(PairKind kind, const Corners<double>& way) {
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

/// Whether a pair, as it is at the start, keeps at least the gap `floor` > 0 all along its ways: because they are
/// short, or because the plane between them parts it at the end too. Between two such times a plane parts it as well:
/// the gap along one direction is concave in time.
bool StaysApart(PairKind kind, const Corners<double>& x, const Corners<double>& way, const PairState& start,
                double floor);

/// The share of its ways, 0 .. 1, over which a pair certainly keeps the gap `floor`, which it has at the start; 1 where
/// that is all of it, else less than what it could go. Conservative advancement: Mirtich 1996; with the bound of Li,
/// Kaufman, Jiang 2021, "Codimensional incremental potential contact", section 5. Of ways that are cut to that share
/// the end has a gap of `floor` at least.
double ShareApart(PairKind kind, const Corners<double>& x, const Corners<double>& way, const PairState& start,
                  double floor);

}  // namespace percale
