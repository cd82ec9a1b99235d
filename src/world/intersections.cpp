#include "percale/intersections.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include "collide/intersections.h"
#include "core/executor.h"
#include "core/index.h"

namespace percale {
namespace {

std::vector<ClothTopology> TopologyOf(const World& world) {
  std::vector<ClothTopology> cloths;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    cloths.push_back({static_cast<int>(cloth.positions().size()), cloth.triangles()});
  }
  return cloths;
}

/// Where the edge p q comes closest to the plane of a b c.
Vec3 Meeting(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = Cross(b - a, c - a);
  const double above = Dot(normal, p - a), below = Dot(normal, q - a);
  const double share = above / (above - below);
  if (std::isfinite(share)) return p + std::clamp(share, 0.0, 1.0) * (q - p);
  // They lie in a plane: the middle of what their boxes have in common.
  const auto middle = [&](auto of) {
    const double low = std::max(std::min(of(p), of(q)), std::min({of(a), of(b), of(c)}));
    const double high = std::min(std::max(of(p), of(q)), std::max({of(a), of(b), of(c)}));
    return low + (high - low) / 2;
  };
  return {middle([](const Vec3& x) { return x.x; }), middle([](const Vec3& x) { return x.y; }),
          middle([](const Vec3& x) { return x.z; })};
}

}  // namespace

struct ClothJudge::Impl {
  explicit Impl(std::span<const ClothTopology> cloths, int threads) : executor(threads), judge(0, {}) {
    for (const ClothTopology& cloth : cloths) {
      for (const Triangle& t : cloth.triangles)
        triangles.push_back({firstVertex.back() + t.a, firstVertex.back() + t.b, firstVertex.back() + t.c});
      firstVertex.push_back(firstVertex.back() + cloth.vertices);
      firstTriangle.push_back(static_cast<std::int32_t>(triangles.size()));
    }
    judge = IntersectionJudge(firstVertex.back(), triangles);
  }

  /// Which of the ranges that begin at `first` an index is in.
  static int RangeOf(const std::vector<std::int32_t>& first, std::int32_t index) {
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), index) - first.begin()) - 1;
  }

  ClothIntersections Count(std::span<const Vec3> x, int most) {
    const IntersectionCount found = judge.Count(x, executor, most);
    ClothIntersections named{found.count, {}};
    for (const Intersection& each : found.first) {
      const Triangle& t = triangles[Index(each.triangle)];
      ClothIntersection one;
      one.edgeCloth = RangeOf(firstVertex, each.edge[0]);
      one.triangleCloth = RangeOf(firstTriangle, each.triangle);
      const std::int32_t shift = firstVertex[Index(one.edgeCloth)];
      one.edge = {each.edge[0] - shift, each.edge[1] - shift};
      one.triangle = each.triangle - firstTriangle[Index(one.triangleCloth)];
      one.place = Meeting(x[Index(each.edge[0])], x[Index(each.edge[1])], x[Index(t.a)], x[Index(t.b)], x[Index(t.c)]);
      named.first.push_back(one);
    }
    return named;
  }

  Executor executor;
  IntersectionJudge judge;
  std::vector<Triangle> triangles;                             // of all cloths, as one mesh
  std::vector<std::int32_t> firstVertex{0}, firstTriangle{0};  // of each cloth, and the end
  std::vector<Vec3> positions;
};

ClothJudge::ClothJudge(const World& world, int threads) : ClothJudge(TopologyOf(world), threads) {}
ClothJudge::ClothJudge(std::span<const ClothTopology> cloths, int threads)
    : impl_(std::make_unique<Impl>(cloths, threads)) {}
ClothJudge::~ClothJudge() = default;
ClothJudge::ClothJudge(ClothJudge&&) noexcept = default;
ClothJudge& ClothJudge::operator=(ClothJudge&&) noexcept = default;

ClothIntersections ClothJudge::Count(const World& world, int most) {
  std::vector<Vec3>& positions = impl_->positions;
  positions.clear();
  for (int c = 0; c < world.ClothCount(); ++c) {
    const auto x = world.Cloth(c).positions();
    positions.insert(positions.end(), x.begin(), x.end());
  }
  return Count(positions, most);
}

ClothIntersections ClothJudge::Count(std::span<const Vec3> positions, int most) {
  assert(positions.size() == Index(impl_->firstVertex.back()));
  return impl_->Count(positions, most);
}

}  // namespace percale
