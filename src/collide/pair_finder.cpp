#include "collide/pair_finder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "collide/cluster_tree.h"

namespace percale {
namespace {

constexpr int kFan = ClusterTree::kFan;
constexpr double kFarthest = 1e30;  // m; what is farther away comes near nothing
constexpr int kChunkLeaves = 32;    // that one thread takes at a time

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Boxes at the start and at the end of a motion. A pair that is apart along one axis at both, the same one below, is
/// apart all the while: what moves along straight lines in common time keeps that in between.
struct Bounds {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low[6] = {kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity};  // x, y, z at the start, the end
  double high[6] = {-kInfinity, -kInfinity, -kInfinity, -kInfinity, -kInfinity, -kInfinity};

  void Add(const Bounds& o) {
    for (int i = 0; i < 6; ++i) {
      low[i] = std::min(low[i], o.low[i]);
      high[i] = std::max(high[i], o.high[i]);
    }
  }
  friend bool Near(const Bounds& a, const Bounds& b) {
    bool near = true;
    for (int i = 0; i < 3; ++i) {
      near = near && (b.low[i] <= a.high[i] || b.low[i + 3] <= a.high[i + 3]);
      near = near && (a.low[i] <= b.high[i] || a.low[i + 3] <= b.high[i + 3]);
    }
    return near;
  }
};

}  // namespace

struct PairFinder::Impl {
  struct Chunk {
    std::vector<VertexQuad> vertexTriangle, edgeEdge;
  };

  Impl(const ContactMesh& m, const Executor& e)
      : mesh(m),
        executor(e),
        tree(BuildClusterTree(m)),
        vertexBounds(m.body.size()),
        bounds(Index(tree.nodes())),
        chunks(Index((tree.leaves() + kChunkLeaves - 1) / kChunkLeaves)) {}

  /// Of vertex v, which is anywhere within the reach. Empty where that is too far or not a number.
  Bounds VertexBounds(const MeshMotion& motion, double reach, std::size_t v) const {
    Bounds b;
    const double x[3] = {motion.start[v].x, motion.start[v].y, motion.start[v].z};
    const double w[3] = {motion.way[v].x, motion.way[v].y, motion.way[v].z};
    const bool cut = !motion.cut.empty() && motion.cut[v] != 0;
    for (int i = 0; i < 3; ++i) {
      const double end = x[i] + w[i];
      if (!(std::abs(end) < kFarthest && std::abs(x[i]) < kFarthest)) return {};
      b.low[i] = x[i] - reach;
      b.high[i] = x[i] + reach;
      b.low[i + 3] = (cut ? std::min(x[i], end) : end) - reach;
      b.high[i + 3] = (cut ? std::max(x[i], end) : end) + reach;
    }
    return b;
  }
  Bounds Of(std::initializer_list<std::int32_t> vertices) const {
    Bounds b;
    for (const std::int32_t v : vertices) b.Add(vertexBounds[Index(v)]);
    return b;
  }

  void Visit(int level, int node, int leaf, bool clothPairs, Chunk& out) const;
  void Test(int a, int b, Chunk& out) const;

  const ContactMesh& mesh;
  const Executor& executor;
  const ClusterTree tree;
  std::vector<Bounds> vertexBounds;
  std::vector<Bounds> bounds;  // per node
  std::vector<Chunk> chunks;
  std::vector<VertexQuad> vertexTriangle, edgeEdge;
};

/// Tests a leaf against those below a node that do not come before it.
void PairFinder::Impl::Visit(int level, int node, int leaf, bool clothPairs, Chunk& out) const {
  if (!Near(bounds[Index(leaf)], bounds[Index(tree.levelFirst[Index(level)] + node)])) return;
  if (level == 0) {
    const bool otherCloth = node < tree.clothLeaves;
    if (node >= leaf && (leaf < tree.clothLeaves) && (clothPairs || !otherCloth)) Test(leaf, node, out);
    return;
  }
  const int size = tree.levelFirst[Index(level)] - tree.levelFirst[Index(level - 1)];
  for (int child = kFan * node; child < std::min(kFan * (node + 1), size); ++child) {
    Visit(level - 1, child, leaf, clothPairs, out);
  }
}

void PairFinder::Impl::Test(int a, int b, Chunk& out) const {
  const auto testVertices = [&](int one, int other) {
    for (const std::int32_t v : tree.OwnVertices(one)) {
      for (const Triangle& t : tree.Triangles(other)) {
        if (!Near(Of({v}), Of({t.a, t.b, t.c})) || v == t.a || v == t.b || v == t.c) continue;
        out.vertexTriangle.push_back({v, t.a, t.b, t.c});
      }
    }
  };
  testVertices(a, b);
  if (a != b) testVertices(b, a);
  const auto ofA = tree.Edges(a), ofB = tree.Edges(b);
  for (std::size_t i = 0; i < ofA.size(); ++i) {
    const Edge& e = ofA[i];
    for (std::size_t j = a == b ? i + 1 : 0; j < ofB.size(); ++j) {
      const Edge& f = ofB[j];
      if (!Near(Of({e.a, e.b}), Of({f.a, f.b})) || e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b) continue;
      out.edgeEdge.push_back({e.a, e.b, f.a, f.b});
    }
  }
}

PairFinder::PairFinder(const ContactMesh& mesh, const Executor& executor)
    : impl_(std::make_unique<Impl>(mesh, executor)) {}
PairFinder::~PairFinder() = default;

void PairFinder::Find(const MeshMotion& motion, std::span<const double> reach, bool clothPairs) {
  Impl& s = *impl_;
  const ClusterTree& tree = s.tree;
  s.vertexTriangle.clear();
  s.edgeEdge.clear();
  if (tree.leaves() == 0) return;
  for (std::size_t v = 0; v < s.vertexBounds.size(); ++v) {
    s.vertexBounds[v] = s.VertexBounds(motion, reach[Index(s.mesh.body[v])], v);
  }
  for (int leaf = 0; leaf < tree.leaves(); ++leaf) {
    Bounds b;
    for (const std::int32_t v : tree.Vertices(leaf)) b.Add(s.vertexBounds[Index(v)]);
    s.bounds[Index(leaf)] = b;
  }
  for (int level = 1; level < tree.levels(); ++level) {
    const int below = tree.levelFirst[Index(level - 1)], begin = tree.levelFirst[Index(level)];
    for (int node = begin; node < tree.levelFirst[Index(level + 1)]; ++node) {
      Bounds b;
      const int first = below + kFan * (node - begin);
      for (int child = first; child < std::min(first + kFan, begin); ++child) b.Add(s.bounds[Index(child)]);
      s.bounds[Index(node)] = b;
    }
  }
  s.executor.ForChunks(static_cast<int>(s.chunks.size()), [&](int chunk) {
    Impl::Chunk& out = s.chunks[Index(chunk)];
    out.vertexTriangle.clear();
    out.edgeEdge.clear();
    const int begin = chunk * kChunkLeaves, end = std::min(begin + kChunkLeaves, tree.leaves());
    for (int leaf = begin; leaf < end; ++leaf) s.Visit(tree.levels() - 1, 0, leaf, clothPairs, out);
  });
  for (const Impl::Chunk& chunk : s.chunks) {
    s.vertexTriangle.insert(s.vertexTriangle.end(), chunk.vertexTriangle.begin(), chunk.vertexTriangle.end());
    s.edgeEdge.insert(s.edgeEdge.end(), chunk.edgeEdge.begin(), chunk.edgeEdge.end());
  }
}

std::span<const VertexQuad> PairFinder::vertexTriangle() const {
  return impl_->vertexTriangle;
}

std::span<const VertexQuad> PairFinder::edgeEdge() const {
  return impl_->edgeEdge;
}

std::size_t PairFinder::MemoryBytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof v[0]; };
  std::size_t sum = impl_->tree.MemoryBytes() + bytes(impl_->vertexBounds) + bytes(impl_->bounds) +
                    bytes(impl_->chunks) + bytes(impl_->vertexTriangle) + bytes(impl_->edgeEdge);
  for (const Impl::Chunk& chunk : impl_->chunks) sum += bytes(chunk.vertexTriangle) + bytes(chunk.edgeEdge);
  return sum;
}

}  // namespace percale
