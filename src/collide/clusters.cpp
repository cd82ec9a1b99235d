#include "collide/clusters.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "collide/contact_mesh.h"
#include "core/index.h"
#include "core/memory.h"

namespace percale {
namespace {

constexpr std::size_t kLeafItems = Clusters::kLeafItems;
constexpr std::size_t kSmallestGroup = 4;  // of items that are sorted by place within a leaf

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

/// How many of so many groups go to the left: about half, a multiple of a power of two as large as may be, so that the
/// nodes above the leaves do not mix what lies apart.
std::size_t LeftGroups(std::size_t groups) {
  std::size_t unit = 1;
  while (4 * unit <= groups) unit *= 2;
  return std::max<std::size_t>(1, (groups / 2 + unit / 2) / unit) * unit;
}

/// Sorts items so that those of a group lie together, and within it those of half a group, and so on.
void Cut(std::span<Item> items, std::size_t group = kLeafItems) {
  const std::size_t groups = (items.size() + group - 1) / group;
  if (groups < 2) {
    if (group > kSmallestGroup) Cut(items, group / 2);
    return;
  }
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
  const std::size_t left = LeftGroups(groups) * group;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.corners < b.corners;
                   });
  Cut(items.first(left), group);
  Cut(items.subspan(left), group);
}

std::vector<Item> MakeItems(const ContactMesh& mesh, const EdgeMap& edgeMap) {
  std::vector<Item> items;
  items.reserve(mesh.triangles.size());
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

/// Adds leaf after leaf to the clusters of a mesh.
class LeafAdder {
 public:
  LeafAdder(ContactMesh& mesh, const EdgeMap& edgeMap)
      : mesh_(mesh),
        edgeMap_(edgeMap),
        vertexOwned_(Index(mesh.vertices()), 0),
        edgeOwned_(mesh.edges.size(), 0),
        listed_(Index(mesh.vertices()), -1) {
    mesh.clusters = {};
    mesh.clusters.vertexFirst = mesh.clusters.edgeFirst = mesh.clusters.triangleFirst = {0};
    edges_.reserve(mesh.edges.size());
  }

  /// Of one body. Its triangles overwrite those of the mesh: items have them all.
  void Add(std::span<const Item> leaf) {
    Clusters& clusters = mesh_.clusters;
    ListVertices(leaf, true);
    clusters.ownVertices.push_back(static_cast<std::int32_t>(clusters.vertices.size()) - clusters.vertexFirst.back());
    ListVertices(leaf, false);
    std::int32_t triangles = clusters.triangleFirst.back();
    for (const Item& item : leaf) {
      const auto [a, b, c] = item.corners;
      if (c >= 0) mesh_.triangles[Index(triangles++)] = {a, b, c};
      for (const Edge& side : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) TakeEdge(side);
    }
    clusters.vertexFirst.push_back(static_cast<std::int32_t>(clusters.vertices.size()));
    clusters.edgeFirst.push_back(static_cast<std::int32_t>(edges_.size()));
    clusters.triangleFirst.push_back(triangles);
    clusters.body.push_back(mesh_.body[Index(leaf[0].corners[0])]);
    const bool hasOnlyTriangles =
        std::all_of(leaf.begin(), leaf.end(), [](const Item& item) { return item.corners[2] >= 0; });
    clusters.hasOnlyTriangles.push_back(hasOnlyTriangles ? 1 : 0);
    if (clusters.body.back() < mesh_.clothBodies) ++clusters.clothLeaves;
  }

  /// The mesh's edges, leaf by leaf, when all leaves are added.
  std::vector<Edge> TakeEdges() { return std::move(edges_); }

 private:
  /// Those that are to be its own, or the others.
  void ListVertices(std::span<const Item> leaf, bool own) {
    const auto number = static_cast<std::int32_t>(mesh_.clusters.body.size());
    for (const Item& item : leaf) {
      for (const std::int32_t v : item.corners) {
        if (v < 0 || listed_[Index(v)] == number || (own && vertexOwned_[Index(v)])) continue;
        mesh_.clusters.vertices.push_back(v);
        listed_[Index(v)] = number;
        vertexOwned_[Index(v)] = 1;
      }
    }
  }
  void TakeEdge(const Edge& side) {
    const std::int32_t e = side.a < 0 || side.b < 0 ? -1 : edgeMap_.Find(side.a, side.b);
    if (e < 0 || edgeOwned_[Index(e)]) return;
    edgeOwned_[Index(e)] = 1;
    edges_.push_back(mesh_.edges[Index(e)]);
  }

  ContactMesh& mesh_;
  const EdgeMap& edgeMap_;
  std::vector<Edge> edges_;
  std::vector<char> vertexOwned_, edgeOwned_;
  std::vector<std::int32_t> listed_;  // per vertex, the last leaf that lists it
};

/// Makes the clusters, and sorts the triangles. Returns the edges as sorted.
std::vector<Edge> AddLeaves(ContactMesh& mesh) {
  const EdgeMap edgeMap(mesh);
  std::vector<Item> items = MakeItems(mesh, edgeMap);
  const auto bodyOf = [&](const Item& item) { return mesh.body[Index(item.corners[0])]; };
  const auto before = [&](const Item& a, const Item& b) { return bodyOf(a) < bodyOf(b); };
  if (!std::is_sorted(items.begin(), items.end(), before)) std::stable_sort(items.begin(), items.end(), before);

  LeafAdder adder(mesh, edgeMap);
  for (auto begin = items.begin(); begin != items.end();) {
    const auto end = std::find_if(begin, items.end(), [&](const Item& item) { return bodyOf(item) != bodyOf(*begin); });
    const std::span<Item> body(begin, end);
    Cut(body);
    for (std::size_t i = 0; i < body.size(); i += kLeafItems) {
      adder.Add(body.subspan(i, std::min(kLeafItems, body.size() - i)));
    }
    begin = end;
  }
  return adder.TakeEdges();
}

}  // namespace

ContactMesh Clustered(ContactMesh mesh) {
  std::vector<Edge> edges = AddLeaves(mesh);
  assert(edges.size() == mesh.edges.size());
  mesh.edges = std::move(edges);
  const auto trim = [](auto&... all) { (all.shrink_to_fit(), ...); };
  Clusters& c = mesh.clusters;
  trim(mesh.body, mesh.place, mesh.edges, mesh.triangles);
  trim(c.body, c.hasOnlyTriangles, c.vertexFirst, c.vertices, c.ownVertices, c.edgeFirst, c.triangleFirst);
  return mesh;
}

std::size_t Clusters::MemoryBytes() const {
  return BytesOf(body) + BytesOf(hasOnlyTriangles) + BytesOf(vertexFirst) + BytesOf(vertices) + BytesOf(ownVertices) +
         BytesOf(edgeFirst) + BytesOf(triangleFirst);
}

}  // namespace percale
