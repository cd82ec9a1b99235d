#include "collide/clusters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "tests/collide/contact_meshes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// Whether two lists have the same things, in any order.
template <class Item>
bool AreSame(std::vector<Item> a, std::vector<Item> b) {
  const auto isLess = [](const Item& one, const Item& other) { return std::memcmp(&one, &other, sizeof one) < 0; };
  std::sort(a.begin(), a.end(), isLess);
  std::sort(b.begin(), b.end(), isLess);
  return a == b;
}

/// What is wrong with the leaves of a mesh, or nothing.
std::string Fault(const ContactMesh& given) {
  const ContactMesh mesh = Clustered(given);
  const Clusters& clusters = mesh.clusters;
  std::vector<int> vertexSeen(Index(mesh.vertices()), 0);
  for (int leaf = 0; leaf < clusters.leaves(); ++leaf) {
    const std::int32_t body = clusters.body[Index(leaf)];
    if (leaf > 0 && body < clusters.body[Index(leaf - 1)]) return "bodies that do not ascend";
    if ((leaf < clusters.clothLeaves) != (body < mesh.clothBodies)) return "an obstacle's leaf among those of cloths";
    const auto vertices = clusters.Vertices(leaf);
    const auto lists = [&](std::int32_t v) { return std::count(vertices.begin(), vertices.end(), v) == 1; };
    for (const std::int32_t v : vertices) {
      if (mesh.body[Index(v)] != body || !lists(v)) return "a vertex of another body, or listed twice";
    }
    for (const std::int32_t v : clusters.OwnVertices(leaf)) ++vertexSeen[Index(v)];
    for (const Edge& e : mesh.Edges(leaf)) {
      if (!lists(e.a) || !lists(e.b)) return "an edge whose leaf does not list its ends";
    }
    for (const Triangle& t : mesh.Triangles(leaf)) {
      if (!lists(t.a) || !lists(t.b) || !lists(t.c)) return "a triangle whose leaf does not list its corners";
    }
    if (mesh.Triangles(leaf).size() > std::size_t{Clusters::kLeafItems}) return "a leaf that is too large";
  }
  for (const int seen : vertexSeen) {
    if (seen != 1) return "a vertex that is not some one leaf's own";
  }
  if (Index(clusters.edgeFirst.back()) != mesh.edges.size()) return "edges in no leaf";
  if (Index(clusters.triangleFirst.back()) != mesh.triangles.size()) return "triangles in no leaf";
  if (!AreSame(mesh.edges, given.edges)) return "edges other than the mesh's";
  if (!AreSame(mesh.triangles, given.triangles)) return "triangles other than the mesh's";
  if (mesh.edges.capacity() != mesh.edges.size() || mesh.triangles.capacity() != mesh.triangles.size() ||
      clusters.vertices.capacity() != clusters.vertices.size()) {
    return "room to spare";
  }
  return "";
}

}  // namespace

TEST_CASE("each vertex, edge and triangle belongs to one leaf, with all that it takes") {
  for (const int n : {2, 3, 9, 40}) {
    MovingMesh m;
    AddSheet(m, n, 0.01, 0, false, [](int i, int j) { return (i * j) % 7 == 3; });
    AddSheet(m, 3, 0.01, 0);
    AddSheet(m, 5, 0.01, 0, true);
    m.AddBody(0, true);
    for (int i = 0; i < 50; ++i) {
      const std::int32_t v = m.AddVertex({0.1 * i, 0, 0});
      if (i % 3 != 0) m.AddEdge(v - 1, v);
    }
    CHECK(Fault(m.mesh) == "");
  }
  CHECK(Fault({}) == "");
}

TEST_CASE("leaves are full, and no longer than they have to be") {
  MovingMesh m;
  AddSheet(m, 65, 0.01, 0);
  const Clusters clusters = Clustered(m.mesh).clusters;
  CHECK(clusters.leaves() == 2 * 64 * 64 / Clusters::kLeafItems);
  double longest = 0;
  for (int leaf = 0; leaf < clusters.leaves(); ++leaf) {
    for (const std::int32_t v : clusters.Vertices(leaf)) {
      for (const std::int32_t w : clusters.Vertices(leaf)) {
        longest = std::max(longest, Length(m.start[Index(v)] - m.start[Index(w)]));
      }
    }
  }
  CHECK(longest < 0.07);  // of 4 x 2 cells and their like
}
