#include "collide/cluster_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace percale {
namespace {

constexpr int kLeafItems = ClusterTree::kLeafItems;

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// The corners of a triangle, the ends of an edge or a vertex; the rest is -1.
struct Item {
  std::array<std::int32_t, 3> corners;
  std::array<double, 3> centre;
};

/// Edges by their lower vertex.
class EdgeMap {
 public:
  explicit EdgeMap(const ContactMesh& mesh) : edges_(mesh.edges), first_(Index(mesh.vertices()) + 1) {
    for (const Edge& e : edges_) ++first_[Index(std::min(e.a, e.b))];
    std::int32_t sum = 0;
    for (std::int32_t& first : first_) sum += first, first = sum;
    at_.resize(edges_.size());
    for (std::size_t e = edges_.size(); e-- > 0;) {
      at_[Index(--first_[Index(std::min(edges_[e].a, edges_[e].b))])] = static_cast<std::int32_t>(e);
    }
  }
  /// Which edge joins the two, or -1.
  std::int32_t Find(std::int32_t a, std::int32_t b) const {
    const std::size_t low = Index(std::min(a, b));
    for (std::int32_t i = first_[low]; i < first_[low + 1]; ++i) {
      const Edge& e = edges_[Index(at_[Index(i)])];
      if (std::max(e.a, e.b) == std::max(a, b)) return at_[Index(i)];
    }
    return -1;
  }

 private:
  const std::vector<Edge>& edges_;
  std::vector<std::int32_t> first_, at_;
};

/// How many of so many leaves go to the left: about half, in groups as large as may be, so that the nodes above the
/// leaves do not mix what lies apart.
std::size_t LeftLeaves(std::size_t leaves) {
  std::size_t group = 1;
  while (4 * group <= leaves) group *= 2;
  return std::max<std::size_t>(1, (leaves / 2 + group / 2) / group) * group;
}

/// Sorts items so that each kLeafItems of them lie together.
void Cut(std::span<Item> items) {
  const std::size_t leaves = (items.size() + kLeafItems - 1) / kLeafItems;
  if (leaves < 2) return;
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Item& item : items) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item.centre[axis]);
      high[axis] = std::max(high[axis], item.centre[axis]);
    }
  }
  std::size_t axis = 0;
  for (const std::size_t other : {1, 2}) {
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  }
  const std::size_t left = LeftLeaves(leaves) * kLeafItems;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.corners < b.corners;
                   });
  Cut(items.first(left));
  Cut(items.subspan(left));
}

std::vector<Item> MakeItems(const ContactMesh& mesh, const EdgeMap& edgeMap) {
  std::vector<Item> items;
  std::vector<char> edgeSeen(mesh.edges.size(), 0), vertexSeen(Index(mesh.vertices()), 0);
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    Item item = {{a, b, c}, {0, 0, 0}};
    double count = 0;
    for (const std::int32_t v : item.corners) {
      if (v < 0) continue;
      const Vec3& p = mesh.place[Index(v)];
      item.centre[0] += p.x, item.centre[1] += p.y, item.centre[2] += p.z;
      vertexSeen[Index(v)] = 1;
      ++count;
    }
    for (double& x : item.centre) x = std::isfinite(x) ? x / count : 0;
    items.push_back(item);
  };
  for (const Triangle& t : mesh.triangles) {
    add(t.a, t.b, t.c);
    for (const std::int32_t e : {edgeMap.Find(t.a, t.b), edgeMap.Find(t.b, t.c), edgeMap.Find(t.c, t.a)}) {
      if (e >= 0) edgeSeen[Index(e)] = 1;
    }
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!edgeSeen[e]) add(mesh.edges[e].a, mesh.edges[e].b, -1);
  }
  for (std::int32_t v = 0; v < mesh.vertices(); ++v) {
    if (!vertexSeen[Index(v)]) add(v, -1, -1);
  }
  return items;
}

}  // namespace

ClusterTree BuildClusterTree(const ContactMesh& mesh) {
  const EdgeMap edgeMap(mesh);
  std::vector<Item> items = MakeItems(mesh, edgeMap);
  const auto bodyOf = [&](const Item& item) { return mesh.body[Index(item.corners[0])]; };
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return bodyOf(a) < bodyOf(b); });

  ClusterTree tree;
  std::vector<char> vertexOwned(Index(mesh.vertices()), 0), edgeOwned(mesh.edges.size(), 0);
  std::vector<std::int32_t> listed(Index(mesh.vertices()), -1);  // per vertex, the last leaf that lists it
  tree.vertexFirst = tree.edgeFirst = tree.triangleFirst = {0};
  const auto addLeaf = [&](std::span<const Item> leaf) {
    const auto number = static_cast<std::int32_t>(tree.body.size());
    const auto list = [&](bool owned) {
      for (const Item& item : leaf) {
        for (const std::int32_t v : item.corners) {
          if (v < 0 || listed[Index(v)] == number || (owned && vertexOwned[Index(v)])) continue;
          tree.vertices.push_back(v);
          listed[Index(v)] = number;
          vertexOwned[Index(v)] = 1;
        }
      }
    };
    list(true);
    tree.ownVertices.push_back(static_cast<std::int32_t>(tree.vertices.size()) - tree.vertexFirst.back());
    list(false);
    for (const Item& item : leaf) {
      const auto [a, b, c] = item.corners;
      if (c >= 0) tree.triangles.push_back({a, b, c});
      for (const Edge& side : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) {
        const std::int32_t e = side.a < 0 || side.b < 0 ? -1 : edgeMap.Find(side.a, side.b);
        if (e < 0 || edgeOwned[Index(e)]) continue;
        edgeOwned[Index(e)] = 1;
        tree.edges.push_back(mesh.edges[Index(e)]);
      }
    }
    tree.vertexFirst.push_back(static_cast<std::int32_t>(tree.vertices.size()));
    tree.edgeFirst.push_back(static_cast<std::int32_t>(tree.edges.size()));
    tree.triangleFirst.push_back(static_cast<std::int32_t>(tree.triangles.size()));
    tree.body.push_back(bodyOf(leaf[0]));
    if (tree.body.back() < mesh.clothBodies) ++tree.clothLeaves;
  };
  for (auto begin = items.begin(); begin != items.end();) {
    const auto end = std::find_if(begin, items.end(), [&](const Item& item) { return bodyOf(item) != bodyOf(*begin); });
    const std::span<Item> body(begin, end);
    Cut(body);
    for (std::size_t i = 0; i < body.size(); i += kLeafItems) {
      addLeaf(body.subspan(i, std::min<std::size_t>(kLeafItems, body.size() - i)));
    }
    begin = end;
  }
  assert(tree.edges.size() == mesh.edges.size());

  tree.levelFirst = {0};
  int count = tree.leaves();
  while (true) {
    tree.levelFirst.push_back(tree.levelFirst.back() + count);
    if (count <= 1) break;
    count = (count + ClusterTree::kFan - 1) / ClusterTree::kFan;
  }
  return tree;
}

std::size_t ClusterTree::MemoryBytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof v[0]; };
  return bytes(body) + bytes(vertexFirst) + bytes(vertices) + bytes(ownVertices) + bytes(edgeFirst) + bytes(edges) +
         bytes(triangleFirst) + bytes(triangles) + bytes(levelFirst);
}

}  // namespace percale
