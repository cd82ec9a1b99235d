#include "collide/clusters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/collide/contact_meshes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// What is wrong with the leaves of a mesh, or nothing.
std::string Fault(const ContactMesh& mesh) {
  const Clusters clusters = MakeClusters(mesh);
  std::vector<int> vertexSeen(Index(mesh.vertices()), 0);
  std::vector<Edge> edges;
  std::size_t triangles = 0;
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
    for (const Edge& e : clusters.Edges(leaf)) {
      if (!lists(e.a) || !lists(e.b)) return "an edge whose leaf does not list its ends";
      edges.push_back(e);
    }
    for (const Triangle& t : clusters.Triangles(leaf)) {
      if (!lists(t.a) || !lists(t.b) || !lists(t.c)) return "a triangle whose leaf does not list its corners";
      ++triangles;
    }
    if (clusters.Triangles(leaf).size() > std::size_t{Clusters::kLeafItems}) return "a leaf that is too large";
  }
  for (const int seen : vertexSeen) {
    if (seen != 1) return "a vertex that is not some one leaf's own";
  }
  const auto less = [](const Edge& e, const Edge& f) { return e.a != f.a ? e.a < f.a : e.b < f.b; };
  std::vector<Edge> all = mesh.edges;
  std::sort(edges.begin(), edges.end(), less);
  std::sort(all.begin(), all.end(), less);
  if (edges != all) return "edges other than the mesh's";
  return triangles == mesh.triangles.size() ? "" : "triangles other than the mesh's";
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
  const Clusters clusters = MakeClusters(m.mesh);
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
