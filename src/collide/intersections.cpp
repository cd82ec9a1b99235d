#include "collide/intersections.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "collide/predicates.h"
#include "core/index.h"

namespace percale {
namespace {

// On sheets of 10,000 vertices, flat and wavy, 4 to 12 took the same time.
constexpr std::size_t kLeafTriangles = 8;
constexpr std::size_t kChunkLeaves = 32;
constexpr std::size_t kChunkTriangles = 2048;
/// A frame other than that of the coordinates is taken where its boxes have so much less area.
constexpr double kMuchSmaller = 0.5;
/// So often the tree is halved before its parts are built side by side.
constexpr int kCommonLevels = 4;

/// Along three axes. Empty ones lie apart from all others.
struct Bounds {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void Add(const Bounds& o) {
    low = {std::min(low.x, o.low.x), std::min(low.y, o.low.y), std::min(low.z, o.low.z)};
    high = {std::max(high.x, o.high.x), std::max(high.y, o.high.y), std::max(high.z, o.high.z)};
  }
  void Add(const Vec3& x) { Add(Bounds{x, x}); }
  void Widen(double by) {
    low -= {by, by, by};
    high += {by, by, by};
  }
  double Area() const {
    const Vec3 d = high - low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

/// Bounds in half of the memory, rounded outwards: where bounds meet, so do these.
struct TreeBox {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  float low[3]{kFar, kFar, kFar}, high[3]{-kFar, -kFar, -kFar};

  void Add(const TreeBox& o) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], o.low[k]);
      high[k] = std::max(high[k], o.high[k]);
    }
  }
  bool Meets(const TreeBox& o) const {
    return (low[0] <= o.high[0]) & (o.low[0] <= high[0]) & (low[1] <= o.high[1]) & (o.low[1] <= high[1]) &
           (low[2] <= o.high[2]) & (o.low[2] <= high[2]);
  }
  /// Twice where its middle is along an axis.
  float Centre(int axis) const { return low[axis] + high[axis]; }
};

/// The nearest floats are wrong by half of the first of these, relatively, or by less than the second.
constexpr double kFloatError = 0x1p-23, kLeastError = 1e-38;
/// Half of the largest float, so that sums of two are none that is infinite.
constexpr double kLargest = 1e38;

float Float(double a) {
  return static_cast<float>(std::clamp(a, -kLargest, kLargest));
}
TreeBox Round(const Bounds& b) {
  const double low[3] = {b.low.x, b.low.y, b.low.z}, high[3] = {b.high.x, b.high.y, b.high.z};
  TreeBox box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = Float(low[k] - (std::abs(low[k]) * kFloatError + kLeastError));
    box.high[k] = Float(high[k] + (std::abs(high[k]) * kFloatError + kLeastError));
  }
  return box;
}

using Corners3 = std::array<std::int32_t, 3>;

/// A triangle on its way into a leaf of the tree.
struct Placed {
  TreeBox box;
  std::int32_t triangle;
};

/// A part of the tree. What it consists of follows it; `next` comes behind all that.
struct Node {
  TreeBox box;
  std::uint32_t next = 0;
  std::uint32_t firstLeaf = 0, endLeaf = 0;
  bool obstaclesOnly = false;
};

bool Before(const Intersection& a, const Intersection& b) {
  return std::tie(a.edge[0], a.edge[1], a.triangle) < std::tie(b.edge[0], b.edge[1], b.triangle);
}

/// What was found, of which only the first few are kept.
struct Found {
  std::int64_t count = 0;
  std::vector<Intersection> first;

  void Add(const Intersection& one, std::size_t most) {
    ++count;
    first.push_back(one);
    if (first.size() >= 2 * most + 64) Shorten(most);
  }
  void Add(const Found& o) {
    count += o.count;
    first.insert(first.end(), o.first.begin(), o.first.end());
  }
  void Shorten(std::size_t most) {
    std::sort(first.begin(), first.end(), Before);
    first.resize(std::min(first.size(), most));
  }
};

}  // namespace

struct IntersectionJudge::Impl {
  struct OwnEdge {
    std::int32_t a, b;  // a < b
    TreeBox box;
  };

  int vertices, obstacles;
  std::span<const Triangle> triangles;
  std::vector<std::uint8_t> ownsSide;  // per triangle: bit k if it stands for the edge from corner k to the next
  std::span<const Vec3> positions;     // while they are judged
  std::vector<Vec3> seen;              // positions as they count, in the frame of the boxes
  double slack = 0;                    // of the triangles' bounds, for what `seen` has lost to rounding
  std::vector<Placed> placed;          // triangles, those of a leaf side by side
  std::vector<Node> nodes;
  std::vector<Found> found;  // per chunk of leaves

  Impl(int vertexCount, std::span<const Triangle> ofMesh, int obstaclesBegin)
      : vertices(vertexCount), obstacles(obstaclesBegin), triangles(ofMesh), ownsSide(triangles.size()) {
    struct Side {
      std::int32_t a, b, triangle, corner;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Corners3 c = CornersOf(t);
      for (std::int32_t k = 0; k < 3; ++k) {
        const std::int32_t from = c[Index(k)], to = c[Index((k + 1) % 3)];
        assert(from >= 0 && from < vertexCount && from != to);
        sides.push_back({std::min(from, to), std::max(from, to), static_cast<std::int32_t>(t), k});
      }
    }
    // Each edge is asked about once, by the lowest of its triangles.
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
      return std::tie(s.a, s.b, s.triangle) < std::tie(t.a, t.b, t.triangle);
    });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (i > 0 && sides[i].a == sides[i - 1].a && sides[i].b == sides[i - 1].b) continue;
      ownsSide[Index(sides[i].triangle)] |= static_cast<std::uint8_t>(1 << sides[i].corner);
    }
    sides = std::vector<Side>();  // unlike `= {}` that gives the memory back
    seen.resize(Index(vertices));
    placed.resize(triangles.size());
    for (std::size_t t = 0; t < placed.size(); ++t) placed[t].triangle = static_cast<std::int32_t>(t);
    const std::size_t leaves = Leaves();
    nodes.resize(leaves == 0 ? 0 : 2 * leaves - 1);
    found.resize((leaves + kChunkLeaves - 1) / kChunkLeaves);
  }

  std::size_t Leaves() const { return (triangles.size() + kLeafTriangles - 1) / kLeafTriangles; }
  std::size_t LeafBegin(std::size_t leaf) const { return std::min(leaf * kLeafTriangles, triangles.size()); }
  Corners3 CornersOf(std::size_t t) const { return {triangles[t].a, triangles[t].b, triangles[t].c}; }
  bool IsObstacle(std::int32_t vertex) const { return vertex >= obstacles; }

  /// A position as it counts.
  Vec3 At(std::int32_t v) const {
    const auto counted = [](double a) {
      assert(std::abs(a) <= kLargestExact);
      return std::abs(a) < kSmallestExact ? 0.0 : a;
    };
    const Vec3& p = positions[Index(v)];
    return {counted(p.x), counted(p.y), counted(p.z)};
  }

  void TakePositions(const Executor& executor) {
    ChooseFrame();
    const std::size_t chunks = (triangles.size() + kChunkTriangles - 1) / kChunkTriangles;
    executor.ForChunks(static_cast<int>(chunks), [&](int chunk) {
      const std::size_t begin = std::size_t(chunk) * kChunkTriangles;
      for (std::size_t i = begin; i < std::min(begin + kChunkTriangles, triangles.size()); ++i) {
        Bounds b = BoundsOf(CornersOf(Index(placed[i].triangle)));
        b.Widen(slack);
        placed[i].box = Round(b);
      }
    });
  }

  /// Long thin triangles across all axes have bounds that meet all others. Where the frame of the triangle with the
  /// longest side has much smaller ones, it is taken. Floats are exact near zero: there the first vertex is.
  void ChooseFrame() {
    for (std::int32_t v = 0; v < vertices; ++v) seen[Index(v)] = At(v);
    double longest = 0, farthest = 0, straight = 0;
    Vec3 along{1, 0, 0}, across{0, 1, 0};
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Corners3 c = CornersOf(t);
      straight += BoundsOf(c).Area();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 side = seen[Index(c[(k + 1) % 3])] - seen[Index(c[k])];
        if (Dot(side, side) <= longest) continue;
        longest = Dot(side, side);
        along = side;
        across = seen[Index(c[(k + 2) % 3])] - seen[Index(c[k])];
      }
    }
    along = UnitOr(along, {1, 0, 0});
    const Vec3 normal = UnitOr(Cross(along, across), {0, 0, 1}), third = Cross(normal, along);
    for (Vec3& p : seen) {
      farthest = std::max(farthest, std::abs(p.x) + std::abs(p.y) + std::abs(p.z));
      p = {Dot(along, p), Dot(third, p), Dot(normal, p)};
    }
    double turned = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) turned += BoundsOf(CornersOf(t)).Area();
    // What has a point in common has overlapping exact bounds along any direction. Each end of theirs is wrong by three
    // roundings of at most `farthest`, and widening adds one.
    constexpr double kHalfUlp = 0x1p-53;
    slack = 8 * kHalfUlp * farthest;
    if (!(turned < kMuchSmaller * straight)) {
      for (std::int32_t v = 0; v < vertices; ++v) seen[Index(v)] = At(v);
      slack = 0;
    }
    const Vec3 origin = seen[0];
    for (Vec3& p : seen) p -= origin;
  }

  Bounds BoundsOf(const Corners3& c) const {
    Bounds b;
    for (const std::int32_t v : c) b.Add(seen[Index(v)]);
    return b;
  }

  /// Halves the leaves of a node across their longest way, and places its two parts.
  void Halve(std::size_t at) {
    Node& node = nodes[at];
    const std::size_t middle = node.firstLeaf + (node.endLeaf - node.firstLeaf) / 2;
    const auto begin = placed.begin() + std::ptrdiff_t(LeafBegin(node.firstLeaf));
    const auto end = placed.begin() + std::ptrdiff_t(LeafBegin(node.endLeaf));
    TreeBox centres;
    for (auto p = begin; p != end; ++p) {
      for (int k = 0; k < 3; ++k) {
        centres.low[k] = std::min(centres.low[k], p->box.Centre(k));
        centres.high[k] = std::max(centres.high[k], p->box.Centre(k));
      }
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (centres.high[k] - centres.low[k] > centres.high[axis] - centres.low[axis]) axis = k;
    }
    std::nth_element(begin, placed.begin() + std::ptrdiff_t(LeafBegin(middle)), end,
                     [axis](const Placed& a, const Placed& b) { return a.box.Centre(axis) < b.box.Centre(axis); });
    const std::size_t left = at + 1, right = left + 2 * (middle - node.firstLeaf) - 1;
    nodes[left] = {{}, static_cast<std::uint32_t>(right), node.firstLeaf, static_cast<std::uint32_t>(middle), false};
    nodes[right] = {{}, node.next, static_cast<std::uint32_t>(middle), node.endLeaf, false};
  }

  void Gather(std::size_t at) {
    Node& node = nodes[at];
    const Node &left = nodes[at + 1], &right = nodes[left.next];
    node.box = left.box;
    node.box.Add(right.box);
    node.obstaclesOnly = left.obstaclesOnly && right.obstaclesOnly;
  }

  void Build(std::size_t at) {
    Node& node = nodes[at];
    if (node.endLeaf - node.firstLeaf > 1) {
      Halve(at);
      Build(at + 1);
      Build(nodes[at + 1].next);
      return Gather(at);
    }
    node.box = {};
    node.obstaclesOnly = true;
    for (std::size_t i = LeafBegin(node.firstLeaf); i < LeafBegin(node.endLeaf); ++i) {
      node.box.Add(placed[i].box);
      node.obstaclesOnly = node.obstaclesOnly && IsObstacle(triangles[Index(placed[i].triangle)].a);
    }
  }

  void BuildTree(const Executor& executor) {
    nodes[0] = {{}, static_cast<std::uint32_t>(nodes.size()), 0, static_cast<std::uint32_t>(Leaves()), false};
    std::vector<std::size_t> above, parts = {0};
    for (int level = 0; level < kCommonLevels; ++level) {
      executor.ForChunks(static_cast<int>(parts.size()), [&](int part) {
        const Node& node = nodes[parts[std::size_t(part)]];
        if (node.endLeaf - node.firstLeaf > 1) Halve(parts[std::size_t(part)]);
      });
      std::vector<std::size_t> halves;
      for (const std::size_t at : parts) {
        if (nodes[at].endLeaf - nodes[at].firstLeaf > 1) {
          above.push_back(at);
          halves.insert(halves.end(), {at + 1, nodes[at + 1].next});
        } else {
          halves.push_back(at);
        }
      }
      parts = std::move(halves);
    }
    executor.ForChunks(static_cast<int>(parts.size()), [&](int part) { Build(parts[std::size_t(part)]); });
    for (auto at = above.rbegin(); at != above.rend(); ++at) Gather(*at);
  }

  bool Meet(const OwnEdge& edge, const Corners3& c) const {
    const auto isCorner = [&](std::int32_t v) { return v == c[0] || v == c[1] || v == c[2]; };
    const bool shared = isCorner(edge.a);
    if (!shared && !isCorner(edge.b)) {
      if (IsObstacle(edge.a) && IsObstacle(c[0])) return false;
      return SegmentMeetsTriangle(At(edge.a), At(edge.b), At(c[0]), At(c[1]), At(c[2]));
    }
    if (shared && isCorner(edge.b)) return false;
    if (IsObstacle(edge.a)) return false;
    const std::int32_t from = shared ? edge.a : edge.b, to = shared ? edge.b : edge.a;
    const std::size_t k = c[0] == from ? 0 : c[1] == from ? 1 : 2;
    return SegmentRunsOnTriangle(At(to), At(c[k]), At(c[(k + 1) % 3]), At(c[(k + 2) % 3]));
  }

  /// Asks about the edges that the triangles of a leaf stand for.
  void Query(std::size_t leaf, std::size_t most, Found& out) const {
    std::array<OwnEdge, 3 * kLeafTriangles> edges;
    std::size_t count = 0;
    TreeBox all;
    bool obstaclesOnly = true;
    for (std::size_t i = LeafBegin(leaf); i < LeafBegin(leaf + 1); ++i) {
      const std::size_t t = Index(placed[i].triangle);
      const Corners3 c = CornersOf(t);
      for (std::size_t k = 0; k < 3; ++k) {
        if ((ownsSide[t] >> k & 1) == 0) continue;
        const std::int32_t from = c[k], to = c[(k + 1) % 3];
        OwnEdge& edge = edges[count++] = {std::min(from, to), std::max(from, to), {}};
        Bounds bounds;
        bounds.Add(seen[Index(from)]);
        bounds.Add(seen[Index(to)]);
        edge.box = Round(bounds);
        all.Add(edge.box);
        obstaclesOnly = obstaclesOnly && IsObstacle(from);
      }
    }
    for (std::size_t at = 0; at < nodes.size();) {
      const Node& node = nodes[at];
      if (!node.box.Meets(all) || (obstaclesOnly && node.obstaclesOnly)) {
        at = node.next;
        continue;
      }
      ++at;
      if (node.endLeaf - node.firstLeaf > 1) continue;
      for (std::size_t e = 0; e < count; ++e) {
        if (!edges[e].box.Meets(node.box)) continue;
        std::array<std::size_t, kLeafTriangles> near;  // gathered first: a branch on each would be mispredicted
        std::size_t nearCount = 0;
        for (std::size_t i = LeafBegin(node.firstLeaf); i < LeafBegin(node.endLeaf); ++i) {
          near[nearCount] = i;
          nearCount += edges[e].box.Meets(placed[i].box) ? 1 : 0;
        }
        for (std::size_t k = 0; k < nearCount; ++k) {
          const std::int32_t t = placed[near[k]].triangle;
          if (Meet(edges[e], CornersOf(Index(t)))) out.Add({{edges[e].a, edges[e].b}, t}, most);
        }
      }
    }
  }
};

IntersectionJudge::IntersectionJudge(int vertices, std::span<const Triangle> triangles)
    : IntersectionJudge(vertices, triangles, vertices) {}
IntersectionJudge::IntersectionJudge(int vertices, std::span<const Triangle> triangles, int obstacles)
    : impl_(std::make_unique<Impl>(vertices, triangles, obstacles)) {}
IntersectionJudge::~IntersectionJudge() = default;
IntersectionJudge::IntersectionJudge(IntersectionJudge&&) noexcept = default;
IntersectionJudge& IntersectionJudge::operator=(IntersectionJudge&&) noexcept = default;

IntersectionCount IntersectionJudge::Count(std::span<const Vec3> positions, const Executor& executor, int most) {
  Impl& impl = *impl_;
  assert(positions.size() == impl.seen.size() && most >= 0);
  if (impl.triangles.empty()) return {};
  impl.positions = positions;
  impl.TakePositions(executor);
  impl.BuildTree(executor);
  const auto kept = static_cast<std::size_t>(most);
  executor.ForChunks(static_cast<int>(impl.found.size()), [&](int chunk) {
    Found& found = impl.found[std::size_t(chunk)];
    found = {};
    const std::size_t begin = std::size_t(chunk) * kChunkLeaves;
    for (std::size_t leaf = begin; leaf < std::min(begin + kChunkLeaves, impl.Leaves()); ++leaf)
      impl.Query(leaf, kept, found);
  });
  Found all;
  for (Found& found : impl.found) all.Add(std::exchange(found, {}));
  all.Shorten(kept);
  return {all.count, std::move(all.first)};
}

}  // namespace percale
