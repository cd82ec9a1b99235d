#include "collide/flat_regions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "core/index.h"
#include "core/memory.h"
#include "percale/vec3.h"

namespace percale {

using namespace collide;

namespace {

constexpr double kInside = 1e-8;     // of a region's size: what reaches into its hull by less than that is outside
constexpr double kAreaError = 1e-6;  // of a hull's area

double Cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}
Vec2 Minus(const Vec2& a, const Vec2& b) {
  return {a.x - b.x, a.y - b.y};
}
double Size(const Vec2& a) {
  return std::sqrt(a.x * a.x + a.y * a.y);
}

/// Sorts them, each once.
void Unite(std::vector<std::int32_t>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

using Polygon = std::vector<Vec2>;

double Area(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 2; i < p.size(); ++i) sum += Cross(Minus(p[i - 1], p[0]), Minus(p[i], p[0]));
  return sum / 2;
}

/// The convex hull, counterclockwise (Andrew 1979). Sorts the points.
void MakeHull(Polygon& points, Polygon& hull) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  hull.clear();
  const auto add = [&](const Vec2& p, std::size_t least) {
    while (hull.size() > least &&
           Cross(Minus(hull.back(), hull[hull.size() - 2]), Minus(p, hull[hull.size() - 2])) <= 0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
}

/// What lies to the left of a line: n·p >= d.
struct HalfPlane {
  Vec2 n;
  double d;
  double Depth(const Vec2& p) const { return n.x * p.x + n.y * p.y - d; }
};

/// What is within a hull by `inside`.
void MakeHalfPlanes(const Polygon& hull, double inside, std::vector<HalfPlane>& planes) {
  planes.clear();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 along = Minus(hull[(i + 1) % hull.size()], hull[i]);
    const double length = Size(along);
    const Vec2 n = {-along.y / length, along.x / length};
    planes.push_back({n, n.x * hull[i].x + n.y * hull[i].y + inside});
  }
}

enum class Location { Inside, Outside, Across };

/// Where a triangle lies. Across also where that is not plain to see.
Location LocationOf(const Vec2 (&corners)[3], const std::vector<HalfPlane>& planes) {
  bool isInside = true;
  for (const HalfPlane& plane : planes) {
    const double a = plane.Depth(corners[0]), b = plane.Depth(corners[1]), c = plane.Depth(corners[2]);
    if (a < 0 && b < 0 && c < 0) return Location::Outside;
    isInside = isInside && a >= 0 && b >= 0 && c >= 0;
  }
  return isInside ? Location::Inside : Location::Across;
}

/// Cuts off what is not in all of them.
void Clip(Polygon& polygon, const std::vector<HalfPlane>& planes, Polygon& scratch) {
  for (const HalfPlane& plane : planes) {
    double least = plane.Depth(polygon[0]), most = least;
    for (const Vec2& p : polygon) {
      least = std::min(least, plane.Depth(p));
      most = std::max(most, plane.Depth(p));
    }
    if (least >= 0) continue;
    if (most < 0) {
      polygon.clear();
      return;
    }
    scratch.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double ofP = plane.Depth(p), ofQ = plane.Depth(q);
      if (ofP >= 0) scratch.push_back(p);
      if ((ofP >= 0) != (ofQ >= 0)) {
        const double t = ofP / (ofP - ofQ);
        scratch.push_back({p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t});
      }
    }
    polygon.swap(scratch);
  }
}

/// What regions are made from, and scratch.
class Builder {
 public:
  explicit Builder(const ContactMesh& mesh);
  FlatRegions Make();

 private:
  const Triangle& At(std::int32_t t) const { return mesh_.triangles[Index(t)]; }
  Vec2 Place(std::int32_t vertex, int axis) const {
    const Vec3& p = mesh_.place[Index(vertex)];
    return axis == 0 ? Vec2{p.y, p.z} : axis == 1 ? Vec2{p.z, p.x} : Vec2{p.x, p.y};
  }
  double SignedArea(std::int32_t t, int axis) const {
    const Vec2 a = Place(At(t).a, axis);
    return Cross(Minus(Place(At(t).b, axis), a), Minus(Place(At(t).c, axis), a)) / 2;
  }
  void FindNeighbours();
  void FindLeafNeighbours();
  void ShapeLeaf(std::int32_t leaf);
  void AddInverses(const std::vector<std::array<float, 4>>& ofLeaf);
  void AddRegion(std::int32_t a, std::int32_t b);
  void AddAround(std::int32_t leaf);

  const ContactMesh& mesh_;
  const Clusters& clusters_;
  std::vector<std::int32_t> leafOf_;                       // per triangle
  std::vector<std::array<std::int32_t, 3>> neighbours_;    // per triangle: beyond ab, bc, ca; or -1
  std::vector<std::vector<std::int32_t>> leafNeighbours_;  // with itself, ascending
  std::vector<int> view_;         // per leaf: the axis that places are seen along, plus 3 if from below; or -1
  std::vector<double> altitude_;  // per leaf, the least
  std::vector<Polygon> hulls_;    // per leaf, of its places so seen
  std::vector<double> area_;      // per triangle, likewise
  struct ByBytes {
    bool operator()(const std::vector<std::array<float, 4>>& a, const std::vector<std::array<float, 4>>& b) const {
      return a.size() != b.size() ? a.size() < b.size() : std::memcmp(&a[0], &b[0], a.size() * sizeof a[0]) < 0;
    }
  };
  std::map<std::vector<std::array<float, 4>>, std::int32_t, ByBytes> inverseFirst_;  // of leaves so far
  FlatRegions regions_;

  std::vector<std::array<float, 4>> inverses_;  // of a leaf
  Polygon points_, hull_, piece_, scratch_;
  std::vector<HalfPlane> planes_;
  std::vector<std::int32_t> open_, seen_, leaves_;  // triangles, triangles' last pair, leaves of a region
  std::int32_t pair_ = 0;
};

Builder::Builder(const ContactMesh& mesh) : mesh_(mesh), clusters_(mesh.clusters) {
  leafOf_.reserve(mesh.triangles.size());
  area_.reserve(mesh.triangles.size());
  for (std::int32_t leaf = 0; leaf < clusters_.leaves(); ++leaf) {
    leafOf_.insert(leafOf_.end(), mesh.Triangles(leaf).size(), leaf);
  }
  seen_.assign(mesh.triangles.size(), -1);
}

/// Triangles that run a common edge in opposite ways, and no others have it.
void Builder::FindNeighbours() {
  struct Side {
    std::int32_t low, high, number;  // as Topology has numbers
  };
  const auto from = [&](std::int32_t number) {
    const Triangle& t = At(number / 3);
    return number % 3 == 0 ? t.a : number % 3 == 1 ? t.b : t.c;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh_.triangles.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto number = static_cast<std::int32_t>(3 * t);
    const std::int32_t v[] = {from(number), from(number + 1), from(number + 2)};
    for (std::int32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(v[k], v[(k + 1) % 3]);
      sides.push_back({low, high, number + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.number} < std::array{b.low, b.high, b.number};
  });
  neighbours_.assign(mesh_.triangles.size(), {-1, -1, -1});
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    const std::int32_t one = sides[begin].number, other = sides[end - 1].number;
    if (end - begin != 2 || from(one) == from(other)) continue;
    neighbours_[Index(one / 3)][Index(one % 3)] = other / 3;
    neighbours_[Index(other / 3)][Index(other % 3)] = one / 3;
  }
}

/// Leaves that share a vertex, and those nearly as close: it takes leaves' altitudes.
void Builder::FindLeafNeighbours() {
  // Leaves of each vertex, ascending: of vertex v at [first[v], first[v + 1]).
  std::vector<std::int32_t> first(Index(mesh_.vertices()) + 1, 0);
  for (const std::int32_t v : clusters_.vertices) ++first[Index(v) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::int32_t> leavesOf(clusters_.vertices.size()), end(first.begin(), first.end() - 1);
  std::vector<std::array<Vec3, 2>> boxes;  // of places
  for (std::int32_t leaf = 0; leaf < clusters_.clothLeaves; ++leaf) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low = {kInfinity, kInfinity, kInfinity}, high = -low;
    for (const std::int32_t v : clusters_.Vertices(leaf)) {
      leavesOf[Index(end[Index(v)]++)] = leaf;
      const Vec3& p = mesh_.place[Index(v)];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    boxes.push_back({low, high});
  }
  std::vector<std::vector<std::int32_t>> sharing(Index(clusters_.clothLeaves));
  for (std::int32_t leaf = 0; leaf < clusters_.clothLeaves; ++leaf) {
    auto& all = sharing[Index(leaf)];
    for (const std::int32_t v : clusters_.Vertices(leaf)) {
      all.insert(all.end(), leavesOf.begin() + first[Index(v)], leavesOf.begin() + end[Index(v)]);
    }
    Unite(all);
  }
  leafNeighbours_ = sharing;
  for (std::int32_t leaf = 0; leaf < clusters_.clothLeaves; ++leaf) {
    const auto isClose = [&, a = boxes[Index(leaf)]](std::int32_t other) {
      const auto& b = boxes[Index(other)];
      const Vec3 gap = {std::max(a[0].x - b[1].x, b[0].x - a[1].x), std::max(a[0].y - b[1].y, b[0].y - a[1].y),
                        std::max(a[0].z - b[1].z, b[0].z - a[1].z)};
      return std::max({gap.x, gap.y, gap.z}) <= altitude_[Index(leaf)];
    };
    auto& all = leafNeighbours_[Index(leaf)];
    for (const std::int32_t near : sharing[Index(leaf)]) {
      for (const std::int32_t next : sharing[Index(near)]) {
        if (next > leaf && isClose(next)) all.push_back(next);
      }
    }
    Unite(all);
  }
}

void Builder::ShapeLeaf(std::int32_t leaf) {
  double normal[3] = {0, 0, 0};
  const std::int32_t begin = clusters_.triangleFirst[Index(leaf)], end = clusters_.triangleFirst[Index(leaf) + 1];
  for (std::int32_t t = begin; t < end; ++t) {
    for (int axis = 0; axis < 3; ++axis) normal[axis] += SignedArea(t, axis);
  }
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto axis = static_cast<int>(std::max_element(normal, normal + 3, smaller) - normal);
  bool isFlat = clusters_.hasOnlyTriangles[Index(leaf)] != 0;
  double slope = 0, altitude = std::numeric_limits<double>::infinity();
  inverses_.clear();
  for (std::int32_t t = begin; t < end; ++t) {
    const Vec2 a = Place(At(t).a, axis), ab = Minus(Place(At(t).b, axis), a), ac = Minus(Place(At(t).c, axis), a);
    const double twice = Cross(ab, ac);
    isFlat = isFlat && twice * normal[axis] > 0;  // else it is turned over or has no area
    area_.push_back(std::abs(twice) / 2);
    const double sides[] = {Size(ab), Size(ac), Size(Minus(ac, ab))};
    altitude = std::min(altitude, std::abs(twice) / *std::max_element(sides, sides + 3));
    slope = std::max(slope, (sides[0] + sides[1] + sides[2]) / std::abs(twice));
    inverses_.push_back({static_cast<float>(ac.y / twice), static_cast<float>(-ac.x / twice),
                         static_cast<float>(-ab.y / twice), static_cast<float>(ab.x / twice)});
  }
  AddInverses(inverses_);
  altitude_.push_back(altitude);
  points_.clear();
  if (isFlat) {
    for (const std::int32_t v : clusters_.Vertices(leaf)) points_.push_back(Place(v, axis));
    MakeHull(points_, hull_);
    points_ = hull_;
  }
  hulls_.push_back(points_);
  view_.push_back(!isFlat ? -1 : normal[axis] > 0 ? axis : axis + 3);
  regions_.greatestSlope.push_back(isFlat ? static_cast<float>(slope * (1 + 1e-6)) : -1.0f);
}

void Builder::AddInverses(const std::vector<std::array<float, 4>>& ofLeaf) {
  const auto next = static_cast<std::int32_t>(regions_.inverse.size());
  const std::int32_t first = ofLeaf.empty() ? 0 : inverseFirst_.try_emplace(ofLeaf, next).first->second;
  if (first == next) regions_.inverse.insert(regions_.inverse.end(), ofLeaf.begin(), ofLeaf.end());
  regions_.inverseFirst.push_back(first);
}

/// Adds the region of two leaves, if they have one.
void Builder::AddRegion(std::int32_t a, std::int32_t b) {
  const int view = view_[Index(a)], axis = view % 3;
  if (view < 0 || view_[Index(b)] != view) return;
  points_ = hulls_[Index(a)];
  points_.insert(points_.end(), hulls_[Index(b)].begin(), hulls_[Index(b)].end());
  MakeHull(points_, hull_);
  const double hullArea = Area(hull_);
  MakeHalfPlanes(hull_, kInside * std::sqrt(hullArea), planes_);

  // From the first triangle on to all that the hull reaches into.
  double covered = 0, altitude = std::numeric_limits<double>::infinity();
  std::size_t inLeaves = 0;
  leaves_.clear();
  open_ = {clusters_.triangleFirst[Index(a)]};
  ++pair_;
  seen_[Index(open_[0])] = pair_;
  while (!open_.empty()) {
    const std::int32_t t = open_.back(), leaf = leafOf_[Index(t)];
    open_.pop_back();
    const Vec2 corners[] = {Place(At(t).a, axis), Place(At(t).b, axis), Place(At(t).c, axis)};
    const Location location = leaf == a || leaf == b ? Location::Inside : LocationOf(corners, planes_);
    if (location == Location::Outside) continue;
    double area = area_[Index(t)];
    if (location == Location::Across) {
      piece_.assign(corners, corners + 3);
      Clip(piece_, planes_, scratch_);
      if (piece_.empty()) continue;
      area = std::abs(Area(piece_));
    }
    if (view_[Index(leaf)] != view) return;
    covered += area;
    inLeaves += leaf == a || leaf == b ? 1 : 0;
    if (leaves_.empty() || leaves_.back() != leaf) leaves_.push_back(leaf);
    altitude = std::min(altitude, altitude_[Index(leaf)]);
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t next = neighbours_[Index(t)][side];
      if (next < 0) {
        piece_ = {corners[side], corners[(side + 1) % 3]};
        Clip(piece_, planes_, scratch_);
        if (!piece_.empty()) return;  // the mesh has a border there
      } else if (seen_[Index(next)] != pair_) {
        seen_[Index(next)] = pair_;
        open_.push_back(next);
      }
    }
  }
  // It is covered once, and by what hangs together with both.
  const std::size_t triangles = mesh_.Triangles(a).size() + (a == b ? 0 : mesh_.Triangles(b).size());
  if (inLeaves != triangles || !(std::abs(covered - hullArea) <= kAreaError * hullArea)) return;
  Unite(leaves_);
  regions_.other.push_back(b);
  regions_.altitude.push_back(static_cast<float>(altitude * (1 - 1e-6)));
  regions_.region.insert(regions_.region.end(), leaves_.begin(), leaves_.end());
  regions_.regionFirst.push_back(static_cast<std::int32_t>(regions_.region.size()));
}

/// What the pairs of a leaf have in all.
void Builder::AddAround(std::int32_t leaf) {
  float altitude = std::numeric_limits<float>::infinity();
  const auto pair = Index(regions_.first[Index(leaf)]);
  for (std::size_t k = pair; k < regions_.altitude.size(); ++k) altitude = std::min(altitude, regions_.altitude[k]);
  leaves_.assign(regions_.region.begin() + regions_.regionFirst[pair], regions_.region.end());
  Unite(leaves_);
  regions_.first.push_back(static_cast<std::int32_t>(regions_.other.size()));
  regions_.around.insert(regions_.around.end(), leaves_.begin(), leaves_.end());
  regions_.aroundFirst.push_back(static_cast<std::int32_t>(regions_.around.size()));
  regions_.aroundAltitude.push_back(altitude);
}

FlatRegions Builder::Make() {
  FindNeighbours();
  for (std::int32_t leaf = 0; leaf < clusters_.clothLeaves; ++leaf) ShapeLeaf(leaf);
  inverseFirst_.clear();
  FindLeafNeighbours();
  regions_.first = regions_.regionFirst = regions_.aroundFirst = {0};
  for (std::int32_t leaf = 0; leaf < clusters_.clothLeaves; ++leaf) {
    for (const std::int32_t other : leafNeighbours_[Index(leaf)]) {
      if (other >= leaf) AddRegion(leaf, other);
    }
    AddAround(leaf);
  }
  const auto trim = [](auto&... all) { (all.shrink_to_fit(), ...); };
  trim(regions_.inverse, regions_.inverseFirst, regions_.greatestSlope, regions_.first, regions_.other);
  trim(regions_.altitude, regions_.regionFirst, regions_.region, regions_.aroundFirst, regions_.around);
  trim(regions_.aroundAltitude);
  return std::move(regions_);
}

float Dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

std::int32_t FlatRegions::Find(std::int32_t a, std::int32_t b) const {
  for (std::int32_t pair = first[Index(a)]; pair < first[Index(a) + 1]; ++pair) {
    if (other[Index(pair)] == b) return pair;
  }
  return -1;
}

// With G = F of the leaf itself, and differences from it by their norms.
bool FlatRegions::AreAllApart(std::int32_t leaf, std::span<const LeafShape> shapes, float distance) const {
  const LeafShape& g = shapes[Index(leaf)];
  float most = 0;
  for (std::int32_t i = aroundFirst[Index(leaf)]; i < aroundFirst[Index(leaf) + 1]; ++i) {
    const LeafShape& f = shapes[Index(around[Index(i)])];
    float square = 0;
    for (int k = 0; k < 3; ++k) {
      square += (f.x[k] - g.x[k]) * (f.x[k] - g.x[k]) + (f.y[k] - g.y[k]) * (f.y[k] - g.y[k]);
    }
    const float deviation = std::sqrt(square) + f.deviation;
    if (!(deviation <= most)) most = deviation;  // also if it is not a number
  }
  const float xx = Dot(g.x, g.x), yy = Dot(g.y, g.y), xy = Dot(g.x, g.y);
  const float middle = (xx + yy) / 2, half = std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
  const float norm = std::sqrt(middle + half);
  return middle - half - norm * most > distance * norm / aroundAltitude[Index(leaf)] * 1.0001f;
}

bool FlatRegions::AreApart(std::int32_t pair, std::int32_t a, std::int32_t b, std::span<const LeafShape> shapes,
                           const std::function<const TriangleShapes&(std::int32_t)>& trianglesOf,
                           const Kernels& kernels, float distance) const {
  float x[3], y[3];  // of G
  for (int i = 0; i < 3; ++i) {
    x[i] = (shapes[Index(a)].x[i] + shapes[Index(b)].x[i]) / 2;
    y[i] = (shapes[Index(a)].y[i] + shapes[Index(b)].y[i]) / 2;
  }
  const float xx = Dot(x, x), yy = Dot(y, y), xy = Dot(x, y);
  const float norm = std::sqrt((xx + yy) / 2 + std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy));
  const float least = distance * norm / altitude[Index(pair)] * 1.0001f;
  for (std::int32_t i = regionFirst[Index(pair)]; i < regionFirst[Index(pair) + 1]; ++i) {
    const std::int32_t leaf = region[Index(i)];
    const LeafShape& f = shapes[Index(leaf)];
    const float fxx = Dot(x, f.x), fyy = Dot(y, f.y), fxy = (Dot(x, f.y) + Dot(y, f.x)) / 2;
    // m = (fxx + fyy) / 2 - root(square) - norm * deviation > least
    const float root = (fxx + fyy) / 2 - norm * f.deviation - least;
    const float square = (fxx - fyy) * (fxx - fyy) / 4 + fxy * fxy;
    if (root > 0 && root * root > square) continue;
    if (!kernels.areMonotone(trianglesOf(leaf), x, y, least + norm * f.error)) return false;
  }
  return true;
}

std::size_t FlatRegions::MemoryBytes() const {
  return BytesOf(inverse) + BytesOf(inverseFirst) + BytesOf(greatestSlope) + BytesOf(first) + BytesOf(other) +
         BytesOf(altitude) + BytesOf(regionFirst) + BytesOf(region) + BytesOf(aroundFirst) + BytesOf(around) +
         BytesOf(aroundAltitude);
}

FlatRegions MakeFlatRegions(const ContactMesh& mesh) {
  return Builder(mesh).Make();
}

}  // namespace percale
