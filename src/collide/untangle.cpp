#include "collide/untangle.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// An edge that lies this flat in the triangle is not asked: sine of the angle between them.
constexpr double kFlat = 0.05;
/// Ways shorter than this are none: the sum of unit vectors.
constexpr double kNoWay = 0.05;

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

Vector3<double> Unit(const Vector3<double>& v) {
  const double length = std::sqrt(Dot(v, v));
  return length > 0 ? v * (1 / length) : Vector3<double>{};
}

std::array<std::int32_t, 3> CornersOf(const Triangle& t) {
  return {t.a, t.b, t.c};
}

}  // namespace

Untangler::Untangler(const ContactMesh& mesh) : mesh_(mesh) {
  first_.assign(Index(mesh.vertices()) + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : CornersOf(t)) ++first_[Index(v) + 1];
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  triangle_.resize(Index(first_.back()));
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::int32_t v : CornersOf(mesh.triangles[t]))
      triangle_[Index(next[Index(v)]++)] = static_cast<std::int32_t>(t);
  }
}

/// Of the edge: the sum over its triangles of the way that the curve goes on in each, and of what the point where they
/// meet moves along the edge with that. An edge of no triangle is drawn back from its nearer end.
Vector3<double> Untangler::WayOf(const Intersection& meeting, std::span<const Vec3> x, const Vector3<double>& normal,
                                 const Vector3<double>& place) const {
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  const auto [from, to] = meeting.edge;
  const Vector3<double> e = Unit(at(to) - at(from));
  const double across = Dot(e, normal);
  Vector3<double> way;
  bool any = false;
  for (std::int32_t k = first_[Index(from)]; k < first_[Index(from) + 1]; ++k) {
    const auto corner = CornersOf(mesh_.triangles[Index(triangle_[Index(k)])]);
    if (std::find(corner.begin(), corner.end(), to) == corner.end()) continue;
    any = true;
    const std::int32_t opposite = corner[0] + corner[1] + corner[2] - from - to;
    const Vector3<double> inwards = at(opposite) - place;
    Vector3<double> along = Unit(Cross(normal, Cross(e, inwards)));
    if (Dot(along, inwards - e * Dot(e, inwards)) < 0) along = -along;
    way += along - normal * (2 * Dot(e, along) / across);
  }
  if (any) return way;
  const Vector3<double> ahead = at(to) - place, behind = place - at(from);
  return Dot(ahead, ahead) < Dot(behind, behind) ? -e : e;
}

void Untangler::Find(std::span<const Intersection> met, std::span<const Vec3> x, std::vector<Tangle>& tangles) const {
  tangles.clear();
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  for (const Intersection& meeting : met) {
    const Triangle& t = mesh_.triangles[Index(meeting.triangle)];
    const Vector3<double> a = at(meeting.edge[0]), b = at(meeting.edge[1]);
    const Vector3<double> p = at(t.a), q = at(t.b), r = at(t.c);
    const Vector3<double> area = Cross(q - p, r - p), n = Unit(area);
    if (!(std::abs(Dot(Unit(b - a), n)) >= kFlat)) continue;
    const double above = Dot(a - p, n), below = Dot(p - b, n);
    const double s = std::clamp(above / (above + below), 0.0, 1.0);
    const Vector3<double> place = a + (b - a) * s;
    const Vector3<double> way = WayOf(meeting, x, n, place);
    const double length = std::sqrt(Dot(way, way));
    if (!(length > kNoWay)) continue;
    const double over = 1 / Dot(area, area);
    const double wq = Dot(Cross(place - p, r - p), area) * over, wr = Dot(Cross(q - p, place - p), area) * over;
    tangles.push_back(
        {s < 0.5 ? meeting.edge[0] : meeting.edge[1], {t.a, t.b, t.c}, {1 - wq - wr, wq, wr}, way * (1 / length)});
  }
}

}  // namespace percale
