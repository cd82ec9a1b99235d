#include "collide/untangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "mesh/disjoint_sets.h"

namespace percale {
namespace {

/// An edge that lies this flat in the triangle says nothing of how the curve gets shorter: sine of the angle between
/// them.
constexpr double kFlat = 0.05;
/// Ways shorter than this are none: the sum of unit vectors.
constexpr double kNoWay = 0.05;
/// A part goes back where the triangles that it passes through have this share of their normals in common: all around
/// a tube they have none.
constexpr double kInCommon = 0.3;
/// What lies within so many edges of each other are neighbours.
constexpr int kNeighbours = 2;

/// The weight of a part that is pinned.
constexpr std::int64_t kHeld = std::numeric_limits<std::int64_t>::max();

Vector3<double> Unit(const Vector3<double>& v) {
  const double length = std::sqrt(Dot(v, v));
  return length > 0 ? v * (1 / length) : Vector3<double>{};
}

std::array<std::int32_t, 3> CornersOf(const Triangle& t) {
  return {t.a, t.b, t.c};
}

/// A curve as it lies in one of the two cloths that meet along it.
struct Seam {
  std::int32_t sheet = 0, other = 0;  // The latter the same curve in the other cloth.
  int back = 0;                       // The side of the other cloth whose part is the smaller one.
  std::int64_t weight = 0;            // Of that.
  std::vector<std::size_t> meetings;
};

}  // namespace

Untangler::Untangler(const ContactMesh& mesh) : mesh_(mesh) {
  triangles_ = ListBy(mesh.vertices(), 3 * mesh.triangles.size(),
                      [&](std::size_t corner) { return CornersOf(mesh.triangles[corner / 3])[corner % 3]; });
  for (std::int32_t& corner : triangles_.entry) corner /= 3;
}

std::span<const std::int32_t> Untangler::TrianglesOf(std::int32_t vertex) const {
  const std::size_t first = Index(triangles_.first[Index(vertex)]), end = Index(triangles_.first[Index(vertex) + 1]);
  return std::span(triangles_.entry).subspan(first, end - first);
}

/// Calls f with each triangle that has the edge.
template <class F>
void Untangler::ForTrianglesOf(std::int32_t from, std::int32_t to, const F& f) const {
  for (const std::int32_t t : TrianglesOf(from)) {
    const auto corner = CornersOf(mesh_.triangles[Index(t)]);
    if (std::find(corner.begin(), corner.end(), to) != corner.end()) f(t);
  }
}

/// Whether no triangle has the edge, as those of solids.
bool Untangler::IsLone(const std::array<std::int32_t, 2>& edge) const {
  bool lone = true;
  ForTrianglesOf(edge[0], edge[1], [&](std::int32_t) { lone = false; });
  return lone;
}

/// Whether one of the others is within so many edges of a vertex.
bool Untangler::AreNeighbours(std::int32_t vertex, std::span<const std::int32_t> others, int edges) const {
  if (std::find(others.begin(), others.end(), vertex) != others.end()) return true;
  if (edges == 0) return false;
  for (const std::int32_t t : TrianglesOf(vertex)) {
    for (const std::int32_t next : CornersOf(mesh_.triangles[Index(t)])) {
      if (next != vertex && AreNeighbours(next, others, edges - 1)) return true;
    }
  }
  return false;
}

void Untangler::Take(std::vector<Intersection> met) {
  met_ = std::move(met);
  near_.clear();
  if (met_.empty()) return;
  FollowCurves();
  MarkNear();
}

/// A curve goes on from pair to pair within two triangles that meet; one of them is of the cloth of the edge of the
/// first, and of the second too, or it is the other. What a cloth has in common with the edges of one solid counts as
/// one curve.
void Untangler::FollowCurves() {
  struct Piece {
    std::int32_t low, high, own, pair;
  };
  std::vector<Piece> pieces;
  for (std::size_t m = 0; m < met_.size(); ++m) {
    const std::int32_t t = met_[m].triangle, pair = static_cast<std::int32_t>(m);
    const std::array<std::int32_t, 2> edge = {met_[m].edge[0], met_[m].edge[1]};
    if (IsLone(edge)) {
      const std::int32_t solid = -1 - mesh_.body[Index(edge[0])];
      pieces.push_back({solid, mesh_.body[Index(mesh_.triangles[Index(t)].a)], solid, pair});
    }
    ForTrianglesOf(edge[0], edge[1], [&](std::int32_t own) {
      pieces.push_back({std::min(own, t), std::max(own, t), own, pair});
    });
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.low, a.high, a.pair) < std::tie(b.low, b.high, b.pair);
  });
  DisjointSets sheets(2 * met_.size());  // of each pair that of the edge, then that of the triangle
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const Piece &a = pieces[k - 1], &b = pieces[k];
    if (a.low != b.low || a.high != b.high) continue;
    const std::int32_t turned = a.own == b.own ? 0 : 1;
    sheets.Join(2 * a.pair, 2 * b.pair + turned);
    sheets.Join(2 * a.pair + 1, 2 * b.pair + 1 - turned);
  }
  sheets_.clear();
  other_.assign(2 * met_.size(), -1);
  for (std::int32_t m = 0; m < static_cast<std::int32_t>(met_.size()); ++m) {
    const Sheets own = sheets_.emplace_back(Sheets{sheets.Find(2 * m), sheets.Find(2 * m + 1)});
    other_[Index(own.edge)] = own.triangle;
    other_[Index(own.triangle)] = own.edge;
  }
}

/// What lies within kRings edges of a curve, in either sheet.
void Untangler::MarkNear() {
  near_.assign(Index(mesh_.vertices()), {-1, -1, -1, -1});
  const auto add = [](Near& near, std::int32_t sheet) {
    const auto place = std::find_if(near.begin(), near.end(), [&](std::int32_t s) { return s == sheet || s < 0; });
    if (place != near.end()) *place = sheet;
  };
  for (std::size_t m = 0; m < met_.size(); ++m) {
    for (const std::int32_t v : met_[m].edge) add(near_[Index(v)], sheets_[m].edge);
    for (const std::int32_t v : CornersOf(mesh_.triangles[Index(met_[m].triangle)]))
      add(near_[Index(v)], sheets_[m].triangle);
  }
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<Near> inner = near_;
    const auto spread = [&](std::int32_t from, std::int32_t to) {
      for (const std::int32_t sheet : inner[Index(from)]) {
        if (sheet >= 0) add(near_[Index(to)], sheet);
      }
    };
    for (const Edge& edge : mesh_.edges) {
      spread(edge.a, edge.b);
      spread(edge.b, edge.a);
    }
  }
}

bool Untangler::LetsPass(PairKind kind, const VertexQuad& quad) const {
  if (near_.empty()) return false;
  const std::size_t own = kind == PairKind::VertexTriangle ? 1 : 2;  // vertices of the first thing
  const std::span<const std::int32_t> first = std::span(quad).first(own), second = std::span(quad).subspan(own);
  const auto isNear = [&](std::int32_t sheet) {
    return std::any_of(second.begin(), second.end(), [&](std::int32_t v) {
      const Near& near = near_[Index(v)];
      return std::find(near.begin(), near.end(), sheet) != near.end();
    });
  };
  const bool meet = std::any_of(first.begin(), first.end(), [&](std::int32_t v) {
    const Near& near = near_[Index(v)];
    return std::any_of(near.begin(), near.end(),
                       [&](std::int32_t sheet) { return sheet >= 0 && isNear(other_[Index(sheet)]); });
  });
  if (!meet || mesh_.body[Index(first[0])] != mesh_.body[Index(second[0])]) return meet;
  return std::none_of(first.begin(), first.end(),
                      [&](std::int32_t v) { return AreNeighbours(v, second, kNeighbours); });
}

std::vector<Untangler::Meeting> Untangler::Locate(std::span<const Vec3> x) const {
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  std::vector<Meeting> meetings;
  meetings.reserve(met_.size());
  for (std::size_t m = 0; m < met_.size(); ++m) {
    const auto& [from, to] = met_[m].edge;
    const Triangle& t = mesh_.triangles[Index(met_[m].triangle)];
    const Vector3<double> a = at(from), b = at(to), p = at(t.a), q = at(t.b), r = at(t.c);
    const Vector3<double> area = Cross(q - p, r - p), n = Unit(area);
    const double before = Dot(p - a, n), across = Dot(b - a, n);
    const double share = across != 0 ? std::clamp(before / across, 0.0, 1.0) : 0.5;
    const Vector3<double> place = a + (b - a) * share;
    const double over = 1 / std::max(Dot(area, area), std::numeric_limits<double>::min());
    const double wq = Dot(Cross(place - p, r - p), area) * over, wr = Dot(Cross(q - p, place - p), area) * over;
    meetings.push_back({.edge = {from, to},
                        .corner = CornersOf(t),
                        .sheets = sheets_[m],
                        .weight = {1 - wq - wr, wq, wr},
                        .place = place,
                        .normal = n,
                        .towards = across > 0,
                        .pulled = share < 0.5 ? from : to,
                        .way = {}});
  }
  return meetings;
}

/// The sum over the triangles of the edge of the way that the curve goes on in each, and of what the point where they
/// meet moves along the edge with that.
Vector3<double> Untangler::ShorterWay(const Meeting& meeting, std::span<const Vec3> x) const {
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  const auto [from, to] = meeting.edge;
  const Vector3<double> e = Unit(at(to) - at(from));
  const double across = Dot(e, meeting.normal);
  Vector3<double> way;
  if (!(std::abs(across) >= kFlat)) return way;
  ForTrianglesOf(from, to, [&](std::int32_t t) {
    const auto corner = CornersOf(mesh_.triangles[Index(t)]);
    const std::int32_t opposite = corner[0] + corner[1] + corner[2] - from - to;
    const Vector3<double> inwards = at(opposite) - meeting.place;
    Vector3<double> along = Unit(Cross(meeting.normal, Cross(e, inwards)));
    if (Dot(along, inwards - e * Dot(e, inwards)) < 0) along = -along;
    way += along - meeting.normal * (2 * Dot(e, along) / across);
  });
  return way;
}

/// The sum of the unit normals of the triangles of an edge.
Vector3<double> Untangler::NormalAt(const std::array<std::int32_t, 2>& edge, std::span<const Vec3> x) const {
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  Vector3<double> normal;
  ForTrianglesOf(edge[0], edge[1], [&](std::int32_t t) {
    const Triangle& own = mesh_.triangles[Index(t)];
    normal += Unit(Cross(at(own.b) - at(own.a), at(own.c) - at(own.a)));
  });
  return normal;
}

/// How many vertices are nearest to each side of each curve, by edges that pass through nothing; kHeld where one of
/// them is pinned. That of a meeting's EndOn(side) is number 2 sheets.edge + side.
std::vector<std::int64_t> Untangler::WeighParts(std::span<const std::uint8_t> free,
                                                std::span<const Meeting> meetings) const {
  const std::size_t count = Index(mesh_.vertices());
  std::vector<std::array<std::int32_t, 2>> cut;
  std::vector<std::uint8_t> ends(count, 0);  // of edges that are cut
  for (const Meeting& meeting : meetings) {
    cut.push_back(meeting.edge);
    for (const std::int32_t v : meeting.edge) ends[Index(v)] = 1;
  }
  std::sort(cut.begin(), cut.end());
  const auto isCut = [&](std::int32_t u, std::int32_t v) {
    return ends[Index(u)] && ends[Index(v)] &&
           std::binary_search(cut.begin(), cut.end(), std::array{std::min(u, v), std::max(u, v)});
  };

  std::vector<std::int64_t> weight(4 * meetings.size(), 0);
  std::vector<std::int32_t> part(count, -1), reached;
  const auto reach = [&](std::int32_t v, std::int32_t number) {
    if (part[Index(v)] >= 0) return;
    part[Index(v)] = number;
    reached.push_back(v);
    std::int64_t& own = weight[Index(number)];
    const bool held = Index(v) < free.size() && !free[Index(v)];
    own = held || own == kHeld ? kHeld : own + 1;
  };
  for (const Meeting& meeting : meetings) {
    for (const int side : {0, 1}) reach(meeting.EndOn(side), 2 * meeting.sheets.edge + side);
  }
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const std::int32_t from = reached[k];
    for (const std::int32_t t : TrianglesOf(from)) {
      for (const std::int32_t to : CornersOf(mesh_.triangles[Index(t)])) {
        if (!isCut(from, to)) reach(to, part[Index(from)]);
      }
    }
  }
  return weight;
}

/// Along each curve the smaller part of one cloth goes back through the other, which makes way for it.
void Untangler::SendPartsBack(std::span<const Vec3> x, std::span<const std::uint8_t> free,
                              std::span<Meeting> meetings) const {
  const std::vector<std::int64_t> weight = WeighParts(free, meetings);
  std::vector<Seam> seams;
  std::vector<std::int32_t> seamOf(2 * meetings.size(), -1);  // per sheet
  for (std::size_t m = 0; m < meetings.size(); ++m) {
    const Sheets sheets = meetings[m].sheets;
    std::int32_t& seam = seamOf[Index(sheets.edge)];
    if (seam < 0) {
      seam = static_cast<std::int32_t>(seams.size());
      const std::int64_t* const sides = &weight[2 * Index(sheets.edge)];
      seams.push_back({sheets.edge, sheets.triangle, sides[1] < sides[0] ? 1 : 0, std::min(sides[0], sides[1]), {}});
    }
    seams[Index(seam)].meetings.push_back(m);
  }
  std::stable_sort(seams.begin(), seams.end(), [](const Seam& a, const Seam& b) { return a.weight < b.weight; });

  std::vector<int> backOf(2 * meetings.size(), -1);  // per sheet of which a part goes back
  const auto wayBack = [](int back, const Vector3<double>& normal) { return back == 1 ? -normal : normal; };
  for (const Seam& seam : seams) {
    const int back = backOf[Index(seam.other)];
    if (back >= 0) {
      for (const std::size_t m : seam.meetings) {
        Meeting& meeting = meetings[m];
        meeting.way = -wayBack(back, NormalAt(meeting.edge, x));
        meeting.pulled = meeting.EndOn(Dot(meeting.way, meeting.normal) > 0 ? 0 : 1);
      }
      continue;
    }
    Vector3<double> common;
    for (const std::size_t m : seam.meetings) common += meetings[m].normal;
    if (std::sqrt(Dot(common, common)) < kInCommon * static_cast<double>(seam.meetings.size())) continue;
    if (seam.weight == kHeld) continue;
    backOf[Index(seam.sheet)] = seam.back;
    for (const std::size_t m : seam.meetings) {
      meetings[m].way = wayBack(seam.back, meetings[m].normal);
      meetings[m].pulled = meetings[m].EndOn(seam.back);
    }
  }
}

/// Cloth leaves a solid whose edges pass through it to the side where it is farther from the middle.
void Untangler::LeaveSolids(std::span<const Vec3> x, std::span<Meeting> meetings) const {
  const auto at = [&](std::int32_t v) { return From<double>(x[Index(v)]); };
  std::vector<Vector3<double>> outwards(2 * meetings.size());  // per sheet
  const auto forLone = [&](const auto& f) {
    for (Meeting& meeting : meetings) {
      if (meeting.edge[0] >= mesh_.clothVertices && IsLone(meeting.edge))
        f(meeting, outwards[Index(meeting.sheets.edge)]);
    }
  };
  forLone([&](const Meeting& meeting, Vector3<double>& out) {
    const auto body = std::equal_range(mesh_.body.begin(), mesh_.body.end(), mesh_.body[Index(meeting.edge[0])]);
    Vector3<double> middle;
    for (auto b = body.first; b != body.second; ++b) middle += at(static_cast<std::int32_t>(b - mesh_.body.begin()));
    middle = middle * (1 / static_cast<double>(body.second - body.first));
    out += meeting.normal * Dot(meeting.place - middle, meeting.normal);
  });
  forLone([&](Meeting& meeting, const Vector3<double>& out) {
    const Vector3<double> e = Unit(at(meeting.edge[1]) - at(meeting.edge[0]));
    meeting.way = Dot(e, out) > 0 ? -e : e;
  });
}

void Untangler::Find(std::span<const Vec3> x, std::span<const std::uint8_t> free, std::vector<Tangle>& tangles) const {
  tangles.clear();
  if (met_.empty()) return;
  std::vector<Meeting> meetings = Locate(x);
  for (Meeting& meeting : meetings) meeting.way = ShorterWay(meeting, x);
  SendPartsBack(x, free, meetings);
  LeaveSolids(x, meetings);
  for (const Meeting& m : meetings) {
    const double length = std::sqrt(Dot(m.way, m.way));
    if (length > kNoWay) tangles.push_back({m.pulled, m.corner, m.weight, m.way * (1 / length)});
  }
}

}  // namespace percale
