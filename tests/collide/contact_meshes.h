#pragma once
/// \file
/// Meshes and motions to find pairs in, and the finding by comparing all with all.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/pair_finder.h"
#include "core/index.h"
#include "math/splitmix64.h"

namespace percale::test {

/// A mesh with a motion: what PairFinder::Find takes.
struct MovingMesh {
  ContactMesh mesh;
  std::vector<Vec3> start, way;
  std::vector<std::uint8_t> cut;
  std::vector<double> reach;
  bool clothPairs = true;

  MeshMotion Motion() const { return {start, way, cut}; }

  /// Adds a vertex of the last body.
  std::int32_t AddVertex(const Vec3& place) {
    mesh.body.push_back(static_cast<std::int32_t>(reach.size()) - 1);
    mesh.place.push_back(place);
    start.push_back(place);
    way.push_back({});
    if (mesh.clothBodies == static_cast<int>(reach.size())) mesh.clothVertices = mesh.vertices();
    return mesh.vertices() - 1;
  }
  /// Cloths come before obstacles.
  void AddBody(double reachOfBody, bool obstacle = false) {
    reach.push_back(reachOfBody);
    if (!obstacle) mesh.clothBodies = static_cast<int>(reach.size());
  }
  /// With those of its edges that are new.
  void AddTriangle(std::int32_t a, std::int32_t b, std::int32_t c) {
    mesh.triangles.push_back({a, b, c});
    AddEdge(a, b), AddEdge(b, c), AddEdge(c, a);
  }
  void AddEdge(std::int32_t a, std::int32_t b) {
    if (edges_.emplace(std::minmax(a, b), 0).second) mesh.edges.push_back({a, b});
  }

 private:
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges_;
};

/// Adds a body: a grid of n x n vertices in the plane z = 0, `spacing` apart, without the cells that `hole` says.
inline void AddSheet(MovingMesh& m, int n, double spacing, double reach, bool obstacle = false,
                     const std::function<bool(int, int)>& hole = {}) {
  m.AddBody(reach, obstacle);
  const std::int32_t first = m.mesh.vertices();
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) m.AddVertex({i * spacing, j * spacing, 0});
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      if (hole && hole(i, j)) continue;
      const std::int32_t a = first + j * n + i, b = a + 1, c = a + n, d = c + 1;
      if ((i + j) % 2 == 0) {
        m.AddTriangle(a, b, d), m.AddTriangle(a, d, c);
      } else {
        m.AddTriangle(a, b, c), m.AddTriangle(b, d, c);
      }
    }
  }
}

inline Vec3 RandomVector(SplitMix64& random, double size) {
  const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
  return Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1} * size;
}

/// Puts sheets into a shape, given per place.
template <class Shape>
void SetShape(MovingMesh& m, const Shape& shape) {
  for (std::size_t v = 0; v < m.start.size(); ++v) m.start[v] = shape(m.mesh.place[v]);
}

/// A sheet of that width on a ball, whose rest hangs down in folds.
inline Vec3 Drape(const Vec3& p, double width) {
  const double x = p.x - width / 2, y = p.y - width / 2, r = std::hypot(x, y), ball = width / 4;
  const double angle = std::atan2(y, x), onBall = ball * std::numbers::pi / 2;
  if (r < onBall) {
    const double s = r > 0 ? ball * std::sin(r / ball) / r : 1;
    return {x * s, y * s, ball * std::cos(r / ball)};
  }
  const double down = r - onBall, out = ball * (1 + 0.6 * down / ball * std::sin(8 * angle));
  return {out * std::cos(angle), out * std::sin(angle), -down};
}

/// A sheet of that width folded to and fro in so many layers that lie `apart`.
inline Vec3 Layers(const Vec3& p, double width, int layers, double apart) {
  const double part = width / layers, turns = std::floor(p.x / part), along = p.x - turns * part;
  const bool back = std::fmod(turns, 2) != 0;
  return {back ? part - along : along, p.y, turns * apart};
}

using PairSet = std::vector<VertexQuad>;

/// Where vertices are at that time, those that may be cut somewhere on their way there.
inline std::vector<Vec3> PositionsAt(const MovingMesh& m, double time, SplitMix64& random) {
  std::vector<Vec3> x;
  for (std::size_t v = 0; v < m.start.size(); ++v) {
    const bool cut = !m.cut.empty() && m.cut[v] != 0;
    x.push_back(m.start[v] + m.way[v] * (time * (cut ? random.NextUnit() : 1)));
  }
  return x;
}

/// Two ways to write the same pair become one.
inline PairSet Sorted(std::span<const VertexQuad> vertexTriangle) {
  PairSet set(vertexTriangle.begin(), vertexTriangle.end());
  for (VertexQuad& q : set) std::sort(q.begin() + 1, q.end());
  std::sort(set.begin(), set.end());
  return set;
}
inline PairSet SortedEdges(std::span<const VertexQuad> edgeEdge) {
  PairSet set(edgeEdge.begin(), edgeEdge.end());
  for (VertexQuad& q : set) {
    if (q[0] > q[1]) std::swap(q[0], q[1]);
    if (q[2] > q[3]) std::swap(q[2], q[3]);
    if (q[0] > q[2]) std::swap(q[0], q[2]), std::swap(q[1], q[3]);
  }
  std::sort(set.begin(), set.end());
  return set;
}

/// All pairs that no axis keeps more than the sum of reaches plus `more` apart, at the start and at the end, with the
/// same one above.
struct AllPairs {
  PairSet vertexTriangle, edgeEdge;
};

namespace all_pairs {

struct Item {
  std::vector<std::int32_t> vertices;
  std::array<double, 6> low, high;  // x, y, z at the start, the end
  double least, most;               // of x
};

inline Item MakeItem(const MovingMesh& m, std::vector<std::int32_t> vertices, double more) {
  Item item{std::move(vertices), {}, {}, 0, 0};
  item.low.fill(INFINITY), item.high.fill(-INFINITY);
  const auto add = [&](std::size_t at, const Vec3& p, double reach) {
    const double x[3] = {p.x, p.y, p.z};
    for (std::size_t i = 0; i < 3; ++i) {
      item.low[at + i] = std::min(item.low[at + i], x[i] - reach);
      item.high[at + i] = std::max(item.high[at + i], x[i] + reach);
    }
  };
  for (const std::int32_t v : item.vertices) {
    const double reach = m.reach[Index(m.mesh.body[Index(v)])] + more / 2;
    const Vec3 start = m.start[Index(v)];
    add(0, start, reach);
    add(3, start + m.way[Index(v)], reach);
    if (!m.cut.empty() && m.cut[Index(v)] != 0) add(3, start, reach);
  }
  item.least = std::min(item.low[0], item.low[3]);
  item.most = std::max(item.high[0], item.high[3]);
  return item;
}

inline bool Apart(const Item& a, const Item& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.high[i] < b.low[i] && a.high[i + 3] < b.low[i + 3]) return true;
    if (b.high[i] < a.low[i] && b.high[i + 3] < a.low[i + 3]) return true;
  }
  return false;
}

inline bool Counts(const MovingMesh& m, const Item& a, const Item& b) {
  const bool clothA = m.mesh.body[Index(a.vertices[0])] < m.mesh.clothBodies;
  const bool clothB = m.mesh.body[Index(b.vertices[0])] < m.mesh.clothBodies;
  if ((!clothA && !clothB) || (clothA && clothB && !m.clothPairs)) return false;
  for (const std::int32_t v : a.vertices) {
    if (std::find(b.vertices.begin(), b.vertices.end(), v) != b.vertices.end()) return false;
  }
  return true;
}

/// Items in the order of their least x; calls `pair` for all that are near, with either first.
template <class Pair>
void ForNear(const MovingMesh& m, std::vector<Item>& items, const Pair& pair) {
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.least < b.least; });
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t j = i + 1; j < items.size() && items[j].least <= items[i].most; ++j) {
      if (!Apart(items[i], items[j]) && Counts(m, items[i], items[j])) pair(items[i].vertices, items[j].vertices);
    }
  }
}

}  // namespace all_pairs

inline AllPairs FindAll(const MovingMesh& m, double more = 0) {
  AllPairs all;
  std::vector<all_pairs::Item> items;
  for (const Edge& e : m.mesh.edges) items.push_back(all_pairs::MakeItem(m, {e.a, e.b}, more));
  all_pairs::ForNear(m, items, [&](const auto& a, const auto& b) { all.edgeEdge.push_back({a[0], a[1], b[0], b[1]}); });
  items.clear();
  for (const Triangle& t : m.mesh.triangles) items.push_back(all_pairs::MakeItem(m, {t.a, t.b, t.c}, more));
  for (std::int32_t v = 0; v < m.mesh.vertices(); ++v) items.push_back(all_pairs::MakeItem(m, {v}, more));
  all_pairs::ForNear(m, items, [&](const auto& a, const auto& b) {
    if (a.size() == b.size()) return;
    const auto& vertex = a.size() == 1 ? a : b;
    const auto& triangle = a.size() == 1 ? b : a;
    all.vertexTriangle.push_back({vertex[0], triangle[0], triangle[1], triangle[2]});
  });
  all.vertexTriangle = Sorted(all.vertexTriangle);
  all.edgeEdge = SortedEdges(all.edgeEdge);
  return all;
}

inline double PointEdgeDistance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double square = Dot(ab, ab), t = square > 0 ? std::clamp(Dot(p - a, ab) / square, 0.0, 1.0) : 0;
  return Length(p - (a + ab * t));
}

inline double PointTriangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double sides = std::min({PointEdgeDistance(p, a, b), PointEdgeDistance(p, b, c), PointEdgeDistance(p, c, a)});
  const Vec3 n = Cross(b - a, c - a);
  if (Dot(n, n) == 0) return sides;
  const bool isAbove =
      Dot(Cross(b - a, p - a), n) >= 0 && Dot(Cross(c - b, p - b), n) >= 0 && Dot(Cross(a - c, p - c), n) >= 0;
  return isAbove ? std::abs(Dot(p - a, n)) / Length(n) : sides;
}

inline double EdgeDistance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ends = std::min(
      {PointEdgeDistance(a, c, d), PointEdgeDistance(b, c, d), PointEdgeDistance(c, a, b), PointEdgeDistance(d, a, b)});
  const Vec3 n = Cross(b - a, d - c);
  const double square = Dot(n, n);
  if (square == 0) return ends;
  const double s = Dot(Cross(c - a, d - c), n) / square, t = Dot(Cross(c - a, b - a), n) / square;
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? std::abs(Dot(c - a, n)) / std::sqrt(square) : ends;
}

}  // namespace percale::test
