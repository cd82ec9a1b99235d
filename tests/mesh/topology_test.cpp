#include "mesh/topology.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "core/index.h"
#include "math/splitmix64.h"
#include "mesh/mesh_problems.h"
#include "mesh/rest_mesh.h"

using namespace percale;

namespace {

using Ids = std::vector<std::int32_t>;

ClothSettings Sheet(int numWidth, int numHeight) {
  ClothSettings cloth;
  cloth.numWidthPoints = numWidth;
  cloth.numHeightPoints = numHeight;
  return cloth;
}

RestMesh Grid(int numWidth, int numHeight) {
  return MakeGridMesh(Sheet(numWidth, numHeight));
}

bool Runs(const Triangle& t, std::int32_t a, std::int32_t b) {
  return (t.a == a && t.b == b) || (t.b == a && t.c == b) || (t.c == a && t.a == b);
}

/// What a topology says, checked against the triangles one by one.
void CheckTopology(std::size_t vertexCount, const std::vector<Triangle>& triangles) {
  const Topology topology = BuildTopology(vertexCount, triangles);
  REQUIRE(topology.sideEdges.size() == 3 * triangles.size());
  REQUIRE(topology.edgeTriangles.size() == topology.edges.size());
  REQUIRE(topology.edgeOpposite.size() == topology.edges.size());
  for (std::size_t e = 1; e < topology.edges.size(); ++e) {
    const Edge &before = topology.edges[e - 1], &edge = topology.edges[e];
    CHECK(std::tie(before.a, before.b) < std::tie(edge.a, edge.b));
  }
  Ids boundary, nonManifold, inconsistent;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto [a, b] = topology.edges[e];
    CHECK(a < b);
    Ids meeting;  // the triangles of the edge by looking at all
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (Runs(triangles[t], a, b) || Runs(triangles[t], b, a)) meeting.push_back(std::int32_t(t));
    }
    REQUIRE(!meeting.empty());
    if (meeting.size() == 1) boundary.push_back(std::int32_t(e));
    if (meeting.size() > 2) {
      nonManifold.push_back(std::int32_t(e));
      CHECK(topology.edgeTriangles[e] == std::array<std::int32_t, 2>{-1, -1});
      CHECK(topology.edgeOpposite[e] == std::array<std::int32_t, 2>{-1, -1});
      continue;
    }
    if (meeting.size() == 2) {
      const bool first = Runs(triangles[Index(meeting[0])], a, b), second = Runs(triangles[Index(meeting[1])], a, b);
      if (first == second) inconsistent.push_back(std::int32_t(e));
      if (!first && second) std::swap(meeting[0], meeting[1]);
    }
    meeting.resize(2, -1);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(topology.edgeTriangles[e][i] == meeting[i]);
      if (meeting[i] < 0) {
        CHECK(topology.edgeOpposite[e][i] == -1);
        continue;
      }
      const Triangle& t = triangles[Index(meeting[i])];
      CHECK(t.a + t.b + t.c == a + b + topology.edgeOpposite[e][i]);
    }
  }
  CHECK(topology.boundaryEdges == boundary);
  CHECK(topology.nonManifoldEdges == nonManifold);
  CHECK(topology.inconsistentEdges == inconsistent);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::int32_t v[3] = {triangles[t].a, triangles[t].b, triangles[t].c};
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge& edge = topology.edges[Index(topology.sideEdges[3 * t + k])];
      CHECK(edge.a == std::min(v[k], v[(k + 1) % 3]));
      CHECK(edge.b == std::max(v[k], v[(k + 1) % 3]));
      const auto first = topology.corners.begin() + topology.cornerBegin[Index(v[k])];
      const auto last = topology.corners.begin() + topology.cornerBegin[Index(v[k]) + 1];
      CHECK(std::is_sorted(first, last));
      CHECK(std::binary_search(first, last, std::int32_t(3 * t + k)));
      CHECK(topology.component[Index(v[k])] == topology.component[Index(v[0])]);
    }
  }
  CHECK(topology.corners.size() == 3 * triangles.size());
}

Ids Turn(RestMesh& mesh, const Ids& triangles) {
  for (const std::int32_t t : triangles) {
    std::swap(mesh.triangles[Index(t)].b, mesh.triangles[Index(t)].c);
    std::swap(mesh.material[3 * Index(t) + 1], mesh.material[3 * Index(t) + 2]);
    for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * Index(t) + k].y *= -1;
  }
  return triangles;
}

/// A band of 2 n triangles whose ends are joined, after half a turn when `twisted`.
RestMesh Band(int n, bool twisted) {
  RestMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * i / n, turn = twisted ? angle / 2 : 0;
    for (const double w : {-0.2, 0.2}) {
      const double r = 1 + w * std::sin(turn);
      mesh.positions.push_back({r * std::cos(angle), w * std::cos(turn), r * std::sin(angle)});
    }
  }
  for (int i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    std::int32_t a = 2 * i, b = a + 1, c = last ? 0 : a + 2, d = last ? 1 : a + 3;
    if (last && twisted) std::swap(c, d);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({c, b, d});
  }
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, {}, std::nullopt);
  return mesh;
}

std::vector<std::tuple<int, int, int>> Indices(const RestMesh& mesh) {
  std::vector<std::tuple<int, int, int>> out;
  for (const Triangle& t : mesh.triangles) out.emplace_back(t.a, t.b, t.c);
  return out;
}

}  // namespace

TEST_CASE("A topology tells what looking at all triangles tells") {
  CheckTopology(0, {});
  CheckTopology(3, {});
  CheckTopology(3, {{0, 1, 2}});
  CheckTopology(12, Grid(4, 3).triangles);
  CheckTopology(MakeDisc(1, 3).positions.size(), MakeDisc(1, 3).triangles);
  CheckTopology(10, Band(5, false).triangles);
  CheckTopology(10, Band(5, true).triangles);
  SplitMix64 random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<Triangle> soup;
    for (int i = 0; i < 30; ++i) {
      std::int32_t v[3];
      for (std::int32_t& x : v) x = std::int32_t(random.Next() % 9);
      if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) soup.push_back({v[0], v[1], v[2]});
    }
    CheckTopology(10, soup);
  }
}

TEST_CASE("Pieces hang together by vertices, and are numbered by their lowest") {
  const std::vector<Triangle> triangles{{5, 6, 7}, {1, 2, 3}, {3, 8, 9}};
  const Topology topology = BuildTopology(11, triangles);
  CHECK(topology.componentCount == 2);
  CHECK(topology.component == Ids{-1, 0, 0, 0, -1, 1, 1, 1, 0, 0, -1});
}

TEST_CASE("An inner edge of a grid has two triangles, and all edges in the interior are hinges") {
  const RestMesh mesh = Grid(6, 5);
  const Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
  CHECK(topology.componentCount == 1);
  CHECK(topology.boundaryEdges.size() == 2 * (5 + 4));
  CHECK(2 * topology.edges.size() == 3 * mesh.triangles.size() + topology.boundaryEdges.size());
  CHECK(topology.inconsistentEdges.empty());
  CHECK(topology.nonManifoldEdges.empty());
}

TEST_CASE("Triangles that face the wrong way are found and turned") {
  RestMesh mesh = Grid(6, 5);
  const auto good = Indices(mesh);
  const Ids turned = Turn(mesh, {3, 4, 11, 39});
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK_FALSE(problems.HasErrors());
  CHECK(problems.turned == turned);
  CHECK(problems.mirrored.empty());
  RepairMesh(mesh, problems);
  CHECK(Indices(mesh) == good);
  CHECK(DescribeMeshProblems(FindMeshProblems(mesh)).empty());
}

TEST_CASE("The fewer are turned, in each piece by itself; of equally many those unlike the first") {
  RestMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {6, 1, 0}, {7, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 5, 6}, {5, 6, 7}, {5, 8, 7}};
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, {}, std::nullopt);
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK(problems.turned == Ids{1, 3});
  RepairMesh(mesh, problems);
  CHECK(BuildTopology(mesh.positions.size(), mesh.triangles).inconsistentEdges.empty());
}

TEST_CASE("A Moebius strip has one side, whatever its triangles are like; a band has two") {
  for (const Ids& turned : {Ids{}, Ids{1, 2, 7}}) {
    RestMesh strip = Band(10, true);
    Turn(strip, turned);
    const MeshProblems problems = FindMeshProblems(strip);
    CHECK_FALSE(problems.HasErrors());
    CHECK(problems.oneSided == Ids{0});
    CHECK(problems.turned.empty());

    RestMesh band = Band(10, false);
    Turn(band, turned);
    CHECK(FindMeshProblems(band).oneSided.empty());
    CHECK(FindMeshProblems(band).turned == turned);
  }
}

TEST_CASE("Each kind of error is found, and nothing else") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto check = [](const RestMesh& mesh, Ids MeshProblems::*list, const Ids& ids) {
    const MeshProblems problems = FindMeshProblems(mesh);
    CHECK(problems.HasErrors());
    CHECK(problems.*list == ids);
    const auto described = DescribeMeshProblems(problems);
    REQUIRE(described.size() == 1);
    CHECK(described[0].severity == Severity::Error);
    CHECK(described[0].message.find("(" + std::to_string(ids[0])) != std::string::npos);
  };
  RestMesh mesh = Grid(4, 4);
  SUBCASE("index") {
    mesh.triangles[2].b = 16;
    mesh.triangles[5].c = -1;
    check(mesh, &MeshProblems::badIndex, {2, 5});
  }
  SUBCASE("repeated") {
    mesh.triangles[7].b = mesh.triangles[7].a;
    check(mesh, &MeshProblems::repeatedVertex, {7});
  }
  SUBCASE("position") {
    mesh.positions[3].y = nan;
    mesh.positions[5].x = infinity;
    mesh.positions[6].z = -2e6;
    check(mesh, &MeshProblems::badPosition, {3, 5, 6});
  }
  SUBCASE("material") {
    mesh.material[3 * 4 + 1].x = nan;
    mesh.material[3 * 6 + 2].y = 1e7;
    check(mesh, &MeshProblems::badMaterial, {4, 6});
  }
  SUBCASE("no area") {
    mesh.material[3 * 4 + 1] = mesh.material[3 * 4];
    for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * 8 + k] = {double(k), 1e-7 * double(k * k)};
    check(mesh, &MeshProblems::noArea, {4, 8});
  }
}

TEST_CASE("Duplicates and lone vertices go, and everything else stays in its order") {
  RestMesh mesh = Grid(3, 3);
  const RestMesh good = mesh;
  // A lone vertex before and one in the middle; a triangle again, from another corner and turned over.
  for (const std::int32_t at : {0, 5}) {
    mesh.positions.insert(mesh.positions.begin() + at, Vec3{9, 9, 9});
    mesh.uv.insert(mesh.uv.begin() + at, Vec2{9, 9});
    for (Triangle& t : mesh.triangles) {
      for (std::int32_t* v : {&t.a, &t.b, &t.c}) *v += *v >= at ? 1 : 0;
    }
  }
  mesh.source.resize(mesh.positions.size());
  std::iota(mesh.source.begin(), mesh.source.end(), 0);
  mesh.groups = {{"all", mesh.source}, {"lone", {0, 5}}};
  const Triangle t = mesh.triangles[2];
  mesh.triangles.insert(mesh.triangles.begin() + 3, Triangle{t.b, t.a, t.c});
  for (const std::size_t k : {1, 0, 2}) {
    const Vec2 corner = mesh.material[6 + k];
    mesh.material.insert(mesh.material.begin() + 9 + (k == 1 ? 0 : k == 0 ? 1 : 2), corner);
  }
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK_FALSE(problems.HasErrors());
  CHECK(problems.duplicates == Ids{3});
  CHECK(problems.unreferenced == Ids{0, 5});
  CHECK(problems.nonManifold.empty());
  CHECK(problems.turned.empty());
  CHECK(problems.mirrored.empty());
  const MeshMap map = RepairMesh(mesh, problems);
  CHECK(map.vertices == Ids{-1, 0, 1, 2, 3, -1, 4, 5, 6, 7, 8});
  CHECK(map.triangles == Ids{0, 1, 2, -1, 3, 4, 5, 6, 7});
  CHECK(mesh.positions == good.positions);
  CHECK(mesh.uv == good.uv);
  CHECK(mesh.material == good.material);
  CHECK(Indices(mesh) == Indices(good));
  CHECK(mesh.source == Ids{1, 2, 3, 4, 6, 7, 8, 9, 10});
  CHECK(mesh.groups[0].vertices == Ids{0, 1, 2, 3, 4, 5, 6, 7, 8});
  CHECK(mesh.groups[1].vertices.empty());
}

TEST_CASE("What is clockwise in the fabric is mirrored, its lengths kept") {
  RestMesh mesh = Grid(4, 4);
  const std::vector<Vec2> good = mesh.material;
  for (const std::size_t t : {2, 9}) {
    for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * t + k].y *= -1;
  }
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK(problems.mirrored == Ids{2, 9});
  RepairMesh(mesh, problems);
  CHECK(mesh.material == good);
}

TEST_CASE("A fin is allowed, and its foot is no hinge") {
  RestMesh mesh = Grid(3, 3);
  mesh.positions.push_back({0.1, 2, 0.1});
  mesh.uv.push_back({});
  mesh.triangles.push_back({1, 4, 9});
  mesh.material = MaterialFromShape(mesh.positions, mesh.triangles, {}, std::nullopt);
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK_FALSE(problems.HasErrors());
  REQUIRE(problems.nonManifold.size() == 1);
  CHECK(problems.nonManifold[0].a == 1);
  CHECK(problems.nonManifold[0].b == 4);
  const auto described = DescribeMeshProblems(problems);
  REQUIRE(described.size() == 1);
  CHECK(described[0].severity == Severity::Warning);
  CHECK(described[0].message.find("1-4") != std::string::npos);
}

TEST_CASE("A repaired mesh has nothing left to repair") {
  SplitMix64 random(5);
  for (int round = 0; round < 200; ++round) {
    RestMesh mesh;
    for (int i = 0; i < 10; ++i) mesh.positions.push_back({random.NextUnit(), random.NextUnit(), random.NextUnit()});
    for (int i = 0; i < 4 + round % 12; ++i) {
      std::int32_t v[3];
      for (std::int32_t& x : v) x = std::int32_t(random.Next() % 10);
      if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) mesh.triangles.push_back({v[0], v[1], v[2]});
    }
    for (std::size_t i = 0; i < 3 * mesh.triangles.size(); ++i)
      mesh.material.push_back({random.NextUnit(), random.NextUnit()});
    const MeshProblems problems = FindMeshProblems(mesh);
    if (problems.HasErrors()) continue;
    RepairMesh(mesh, problems);
    const MeshProblems after = FindMeshProblems(mesh);
    CHECK_FALSE(after.HasErrors());
    CHECK(after.duplicates.empty());
    CHECK(after.unreferenced.empty());
    CHECK(after.turned.empty());
    CHECK(after.mirrored.empty());
    CHECK(after.nonManifold.size() == problems.nonManifold.size());
    CHECK(after.oneSided.size() == problems.oneSided.size());
  }
}

TEST_CASE("A message names the first few") {
  MeshProblems problems;
  problems.noArea = {4};
  problems.turned = {1, 2};
  problems.duplicates = {1, 2, 3, 4, 5, 6, 7};
  const auto described = DescribeMeshProblems(problems);
  REQUIRE(described.size() == 3);
  CHECK(described[0].message.find("1 triangle has no area at rest (4, counted from 0); ") == 0);
  CHECK(described[0].triangle == 4);
  CHECK(described[1].message.find("7 triangles have the vertices of others (1, 2, 3, 4, 5 and 2 more, counted") == 0);
  CHECK(described[2].message.find("2 triangles face the other way than their neighbours (1 and 2, counted") == 0);
}

TEST_CASE("The order along a Hilbert curve steps from cell to neighbouring cell") {
  std::vector<Vec3> positions;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 8; ++z) positions.push_back({double(x), double(y), double(z)});
    }
  }
  const auto order = LocalityOrder(positions);
  REQUIRE(order.size() == positions.size());
  CHECK(std::set<std::int32_t>(order.begin(), order.end()).size() == order.size());
  for (std::size_t i = 1; i < order.size(); ++i)
    CHECK(Length(positions[Index(order[i])] - positions[Index(order[i - 1])]) == 1);

  CHECK(LocalityOrder({}).empty());
  CHECK(LocalityOrder(std::vector<Vec3>(3, Vec3{1, 2, 3})) == Ids{0, 1, 2});
}

TEST_CASE("Reordering changes the numbers and not the mesh") {
  RestMesh mesh = MakeDisc(1, 6);
  mesh.groups = {{"rim", {91, 92, 100}}};
  mesh.source.resize(mesh.positions.size());
  std::iota(mesh.source.begin(), mesh.source.end(), 0);
  const RestMesh before = mesh;
  const auto order = LocalityOrder(mesh.positions);
  ReorderMesh(mesh, order);
  CHECK(mesh.source == order);
  // Each triangle under its old numbers, with its place in the fabric.
  const auto corners = [](const RestMesh& m) {
    std::vector<std::array<double, 9>> all;
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
      std::array<double, 9> row{};
      const std::int32_t v[3] = {m.triangles[t].a, m.triangles[t].b, m.triangles[t].c};
      for (std::size_t k = 0; k < 3; ++k) {
        row[k] = m.source[Index(v[k])];
        row[3 + 2 * k] = m.material[3 * t + k].x;
        row[4 + 2 * k] = m.material[3 * t + k].y;
      }
      all.push_back(row);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  CHECK(corners(mesh) == corners(before));
  for (std::size_t v = 0; v < order.size(); ++v) {
    CHECK(mesh.positions[v] == before.positions[Index(order[v])]);
    CHECK(mesh.uv[v] == before.uv[Index(order[v])]);
  }
  Ids rim;
  for (const std::int32_t v : mesh.groups[0].vertices) rim.push_back(mesh.source[Index(v)]);
  std::sort(rim.begin(), rim.end());
  CHECK(rim == Ids{91, 92, 100});
  CHECK(DescribeMeshProblems(FindMeshProblems(mesh)).empty());
}
