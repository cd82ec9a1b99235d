#include "fabric/fabric_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/index.h"
#include "mesh/cloth_model.h"
#include "mesh/topology.h"

namespace percale::fabric {
namespace {

/// Points of the material per vertex beyond which it is no chart: pieces of a few triangles have no coarse grid.
constexpr double kMostSeams = 1.5;

/// Turns a cloth's material coordinates so that u runs along the warp.
Vec2 AlongWarp(const Vec2& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x + s * p.y, c * p.y - s * p.x};
}

MaterialPoint Corner(const FabricModel& model, std::int64_t triangle, int corner) {
  const Vec2& p = model.Material(Index(triangle), corner);
  return {p.x, p.y};
}

/// The corner of a triangle at which `vertex` is.
MaterialPoint CornerAt(const FabricModel& model, std::int32_t triangle, std::int32_t vertex) {
  const Triangle& t = model.triangles[Index(triangle)];
  return Corner(model, triangle, t.a == vertex ? 0 : t.b == vertex ? 1 : 2);
}

/// Appends a cloth's vertices and triangles, and where these lie in the material.
void Append(const RestMesh& mesh, double warpAngle, FabricModel& model, std::vector<Vec2>& material) {
  const int first = model.vertexCount;
  model.firstVertex.push_back(first);
  model.firstTriangle.push_back(static_cast<int>(model.triangles.size()));
  model.vertexCount += static_cast<int>(mesh.positions.size());
  const std::size_t triangles = model.triangles.size() + mesh.triangles.size();
  model.triangles.reserve(triangles);
  material.reserve(3 * triangles);
  model.start.insert(model.start.end(), mesh.positions.begin(), mesh.positions.end());
  for (const Triangle& t : mesh.triangles) {
    model.triangles.push_back({t.a + first, t.b + first, t.c + first});
  }
  for (const Vec2& p : mesh.material) material.push_back(AlongWarp(p, warpAngle));
}

/// A hinge's four vertices, unfolded into the plane: the edge along x.
void Unfold(const FabricModel& model, FabricHinge& hinge) {
  Vec3 at[4];
  for (int t = 0; t < 2; ++t) {
    const Triangle& triangle = model.triangles[Index(hinge.triangle[t])];
    const std::int32_t corners[3] = {triangle.a, triangle.b, triangle.c};
    int opposite = 0;
    while (corners[opposite] != hinge.vertex[2 + t]) ++opposite;
    const int k0 = corners[(opposite + 1) % 3] == hinge.vertex[0] ? (opposite + 1) % 3 : (opposite + 2) % 3;
    const int k1 = 3 - opposite - k0;
    const MaterialPoint p0 = Corner(model, hinge.triangle[t], k0), p1 = Corner(model, hinge.triangle[t], k1),
                        p2 = Corner(model, hinge.triangle[t], opposite);
    const double length = std::hypot(p1.u - p0.u, p1.v - p0.v);
    const double along = ((p2.u - p0.u) * (p1.u - p0.u) + (p2.v - p0.v) * (p1.v - p0.v)) / length;
    const double height = 2 * model.Rest(Index(hinge.triangle[t])).area / length;
    // At a seam the two sides may be cut to slightly different lengths; the first counts.
    if (t == 0) at[1] = {length, 0, 0};
    at[2 + t] = {along, t == 0 ? height : -height, 0};
  }
  const Vector3<double> x[4] = {From<double>(at[0]), From<double>(at[1]), From<double>(at[2]), From<double>(at[3])};
  hinge.weights = MakeHingeWeights(x[0], x[1], x[2], x[3]);
}

/// Hinges, and what they belong to.
void FindHinges(FabricModel& model) {
  const Topology topology = BuildTopology(Index(model.vertexCount), model.triangles);
  std::vector<std::int32_t> hingeOfEdge(topology.edges.size(), -1);
  model.hinges.reserve(topology.edges.size());
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto& [t0, t1] = topology.edgeTriangles[e];
    if (t0 < 0 || t1 < 0) continue;
    hingeOfEdge[e] = static_cast<std::int32_t>(model.hinges.size());
    FabricHinge hinge{};
    hinge.vertex[0] = topology.edges[e].a, hinge.vertex[1] = topology.edges[e].b;
    hinge.vertex[2] = topology.edgeOpposite[e][0], hinge.vertex[3] = topology.edgeOpposite[e][1];
    hinge.triangle[0] = t0, hinge.triangle[1] = t1;
    model.hinges.push_back(hinge);
  }
  model.firstHinge.clear();
  for (const int first : model.firstVertex) {
    const auto at = std::lower_bound(model.hinges.begin(), model.hinges.end(), first,
                                     [](const FabricHinge& hinge, int v) { return hinge.vertex[0] < v; });
    model.firstHinge.push_back(static_cast<int>(at - model.hinges.begin()));
  }
  model.hingeOf.resize(model.triangles.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      model.hingeOf[t][k] = hingeOfEdge[Index(topology.sideEdges[3 * t + (k + 1) % 3])];
  }
  for (FabricHinge& hinge : model.hinges) Unfold(model, hinge);
  model.hingeEnds = ListBy(model.vertexCount, 4 * model.hinges.size(),
                           [&](std::size_t e) { return model.hinges[e / 4].vertex[e % 4]; });
}

/// A triangle's bending as a quadratic of the positions of its corners and of the vertices across its edges.
struct Plate {
  std::int32_t vertex[6];  // -1: none
  QuadraticBending<double> element;
};
Plate PlateOf(const FabricModel& model, std::int32_t triangle) {
  const Triangle& tri = model.triangles[Index(triangle)];
  Plate plate{{tri.a, tri.b, tri.c, -1, -1, -1}, {}};
  HingeWeights<double> weights[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t h = model.hingeOf[Index(triangle)][k];
    if (h < 0) continue;
    const FabricHinge& hinge = model.hinges[Index(h)];
    const std::size_t side = hinge.triangle[0] == triangle ? 0 : 1;
    const double* w = hinge.weights.vertex;
    const bool alike = hinge.vertex[0] == plate.vertex[(k + 1) % 3];
    plate.vertex[3 + k] = hinge.vertex[3 - side];
    weights[k] = {{w[alike ? 0 : 1], w[alike ? 1 : 0], w[2 + side], w[3 - side]}};
  }
  plate.element = MakeQuadraticBending(model.bending[Index(triangle)], weights);
  return plate;
}

/// Adds up the plates row by row: what touches a vertex are its own triangles, and those across an edge from it.
void AssemblePlates(FabricModel& model) {
  model.plates = ScalarMatrix();
  RowSharer<double> plates(model.vertexCount);
  std::vector<std::int32_t> triangles;
  std::vector<std::pair<std::int32_t, double>> row;
  for (int v = 0; v < model.vertexCount; ++v) {
    triangles.clear();
    row.assign(1, {v, 0.0});  // also where nothing bends
    for (std::int32_t e = model.corners.first[Index(v)]; e < model.corners.first[Index(v) + 1]; ++e) {
      triangles.push_back(model.corners.entry[Index(e)] / 3);
    }
    for (std::int32_t e = model.hingeEnds.first[Index(v)]; e < model.hingeEnds.first[Index(v) + 1]; ++e) {
      const std::int32_t end = model.hingeEnds.entry[Index(e)];
      if (end % 4 >= 2) triangles.push_back(model.hinges[Index(end / 4)].triangle[3 - end % 4]);
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    for (const std::int32_t t : triangles) {
      const Plate plate = PlateOf(model, t);
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6 && plate.vertex[i] == v; ++j) {
          if (plate.vertex[j] < 0) continue;
          row.emplace_back(plate.vertex[j], plate.element.entry[i <= j ? Upper6(i, j) : Upper6(j, i)]);
        }
      }
    }
    SumByColumn(row);
    plates.Append(row);
  }
  model.plates = plates.Take();
}

/// Makes the corners that agree on a vertex and its place in the material one point. `material`: per corner.
void FindChart(const std::vector<Vec2>& material, FabricModel& model) {
  std::vector<std::int32_t> corners;  // of a vertex
  model.chart.reserve(Index(model.vertexCount));
  model.chartTriangles.resize(model.triangles.size());
  for (std::size_t v = 0; v < Index(model.vertexCount); ++v) {
    corners.assign(model.corners.entry.begin() + model.corners.first[v],
                   model.corners.entry.begin() + model.corners.first[v + 1]);
    const auto at = [&](std::int32_t corner) { return material[Index(corner)]; };
    std::sort(corners.begin(), corners.end(), [&](std::int32_t a, std::int32_t b) {
      const Vec2 p = at(a), q = at(b);
      return std::tie(p.x, p.y, a) < std::tie(q.x, q.y, b);
    });
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (k == 0 || !(at(corners[k]) == at(corners[k - 1]))) model.chart.push_back(at(corners[k]));
      Triangle& t = model.chartTriangles[Index(corners[k] / 3)];
      (corners[k] % 3 == 0 ? t.a : corners[k] % 3 == 1 ? t.b : t.c) = static_cast<std::int32_t>(model.chart.size()) - 1;
    }
  }
  model.hasPanels = static_cast<double>(model.chart.size()) <= kMostSeams * model.vertexCount;
  if (model.chartTriangles == model.triangles) model.chartTriangles = std::vector<Triangle>();
}

/// Which vertices of its cloth a patch holds, one byte each.
std::vector<std::uint8_t> VerticesOf(const Patch& patch, const ClothSettings& cloth, std::size_t count) {
  std::vector<std::uint8_t> in(count, 1);
  if (!patch.group.empty()) {
    in.assign(count, 0);
    if (const VertexGroup* const group = FindVertexGroup(cloth, patch.group)) {
      for (const std::int32_t v : group->vertices) in[Index(v)] = 1;
    }
  }
  if (patch.rectangle.size() == 2) {
    const GridPoint &a = patch.rectangle[0], &b = patch.rectangle[1];
    for (std::size_t v = 0; v < count; ++v) {
      const GridPoint p = PointOf(cloth, static_cast<std::int32_t>(v));
      const bool inside = p.i >= std::min(a.i, b.i) && p.i <= std::max(a.i, b.i) && p.j >= std::min(a.j, b.j) &&
                          p.j <= std::max(a.j, b.j);
      in[v] = in[v] && inside;
    }
  }
  return in;
}

/// Factors of the patches that a triangle lies in.
struct Factors {
  double stretch = 1, bend = 1, density = 1;
};

/// Those of each triangle; none without patches.
std::vector<Factors> FindFactors(const Scene& scene, const FabricModel& model) {
  std::vector<Factors> factors(scene.patches.empty() ? 0 : model.triangles.size());
  for (const Patch& patch : scene.patches) {
    const auto c = Index(patch.cloth);
    const int first = model.firstVertex[c];
    const std::vector<std::uint8_t> in = VerticesOf(patch, scene.cloths[c], Index(model.firstVertex[c + 1] - first));
    for (std::size_t t = Index(model.firstTriangle[c]); t < Index(model.firstTriangle[c + 1]); ++t) {
      const Triangle& corners = model.triangles[t];
      if (!in[Index(corners.a - first)] || !in[Index(corners.b - first)] || !in[Index(corners.c - first)]) continue;
      factors[t].stretch *= patch.stretch;
      factors[t].bend *= patch.bend;
      factors[t].density *= patch.density;
    }
  }
  return factors;
}

const ClothSettings& ClothOf(const Scene& scene, const FabricModel& model, const FabricHinge& hinge) {
  return scene.cloths[model.ClothOf(hinge.triangle[0])];
}

/// Angles at which folds set: a yield curvature over the width that a hinge stands for, (A1 + A2) / |e|.
std::vector<FoldYield<double>> FindYield(const Scene& scene, const FabricModel& model) {
  std::vector<FoldYield<double>> yield;
  const auto sets = [](const ClothSettings& c) { return c.foldYield > 0 && c.bendingLaw == BendingLaw::Hinges; };
  if (std::none_of(scene.cloths.begin(), scene.cloths.end(), sets)) return yield;
  yield.assign(model.hinges.size(), {.angle = std::numeric_limits<double>::infinity()});
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    const FabricHinge& hinge = model.hinges[h];
    const ClothSettings& cloth = ClothOf(scene, model, hinge);
    if (!sets(cloth)) continue;
    const MaterialPoint from = CornerAt(model, hinge.triangle[0], hinge.vertex[0]),
                        to = CornerAt(model, hinge.triangle[0], hinge.vertex[1]);
    const double area = model.Rest(Index(hinge.triangle[0])).area + model.Rest(Index(hinge.triangle[1])).area;
    const double length = std::hypot(to.u - from.u, to.v - from.v);
    yield[h] = {.angle = cloth.foldYield * area / length, .hardening = cloth.foldHardening};
  }
  return yield;
}

}  // namespace

RestTriangle<double> FabricModel::Rest(std::size_t triangle) const {
  const auto t = static_cast<std::int64_t>(triangle);
  return MakeRestTriangle<double>(Corner(*this, t, 0), Corner(*this, t, 1), Corner(*this, t, 2));
}

double FabricModel::Buckling(std::size_t triangle) const {
  const Triangle& t = triangles[triangle];
  const double factor = stiffening.empty() ? 1 : stiffening[triangle];
  const double stiffness = membranes[ClothOf(static_cast<std::int64_t>(triangle))].bendStiffness * factor;
  return BucklingStress(stiffness, mass[Index(t.a)] + mass[Index(t.b)] + mass[Index(t.c)], Rest(triangle).area) /
         Strength(triangle);
}

FabricModel BuildModel(const Scene& scene, std::span<const RestMesh> meshes) {
  FabricModel model;
  std::vector<Vec2> material;
  for (std::size_t c = 0; c < meshes.size(); ++c) {
    Append(meshes[c], scene.cloths[c].warpAngle * std::numbers::pi / 180, model, material);
  }
  model.firstVertex.push_back(model.vertexCount);
  model.firstTriangle.push_back(static_cast<int>(model.triangles.size()));
  model.corners = ListBy(model.vertexCount, 3 * model.triangles.size(), [&](std::size_t e) {
    const Triangle& t = model.triangles[e / 3];
    return e % 3 == 0 ? t.a : e % 3 == 1 ? t.b : t.c;
  });
  FindChart(material, model);
  material = std::vector<Vec2>();
  TakeMaterials(scene, model);
  return model;
}

void TakeMaterials(const Scene& scene, FabricModel& model) {
  const bool hadHinges = !model.hinges.empty();
  if (!hadHinges) FindHinges(model);
  model.membranes.clear();
  model.pressure.clear();
  model.bendDamping.clear();
  model.anyHinges = false;
  model.plate.clear();
  for (const ClothSettings& cloth : scene.cloths) {
    Membrane membrane;
    membrane.kind = cloth.membraneLaw;
    membrane.damping = cloth.stretchDamping;
    membrane.bendStiffness = std::sqrt(cloth.bendWarp * cloth.bendWeft);
    membrane.orthotropic = OrthotropicMembrane(cloth.stretchWarp, cloth.stretchWeft, cloth.poissonRatio, cloth.shear);
    StVenantKirchhoff<double>& law = membrane.orthotropic;
    const double limit = cloth.strainLimit;
    law.limitU = law.limitV = limit + 0.5 * limit * limit;
    // At twice the limit the yarns hold as much again as the weave.
    law.limitStiffnessU = law.c11 / limit, law.limitStiffnessV = law.c22 / limit;
    membrane.neoHookean = NeoHookeanMembrane(0.5 * (cloth.stretchWarp + cloth.stretchWeft), cloth.poissonRatio);
    model.membranes.push_back(membrane);
    model.pressure.push_back(cloth.pressure);
    model.bendDamping.push_back(cloth.bendDamping);
    const bool plate = cloth.bendingLaw == BendingLaw::Quadratic;
    model.anyHinges = model.anyHinges || !plate;
    model.plate.resize(Index(model.firstVertex[model.membranes.size()]), plate ? 1 : 0);
  }
  const std::vector<Factors> factors = FindFactors(scene, model);
  const auto factorsOf = [&](std::size_t t) { return factors.empty() ? Factors() : factors[t]; };
  model.strength.clear();
  model.stiffening.clear();
  model.strength.reserve(factors.size());
  model.stiffening.reserve(factors.size());
  for (const Factors& factor : factors) {
    model.strength.push_back(factor.stretch);
    model.stiffening.push_back(factor.bend);
  }
  for (FabricHinge& hinge : model.hinges) {
    const auto x = [&](int k) { return From<double>(model.start[Index(hinge.vertex[k])]); };
    const bool flat = ClothOf(scene, model, hinge).restAngles == RestAngles::Flat;
    hinge.restAngle = flat ? 0 : HingeAngle(x(0), x(1), x(2), x(3));
  }
  model.yield = FindYield(scene, model);
  model.tethers.clear();
  for (const Tether& tether : scene.tethers) {
    const auto c = Index(tether.cloth);
    for (const GridPoint& point : tether.points) {
      if (const auto vertex = VertexOf(scene.cloths[c], point))
        model.tethers.push_back({model.firstVertex[c] + *vertex, tether.anchor, tether.length, tether.stiffness});
    }
  }

  model.mass.assign(Index(model.vertexCount), 0);
  model.bending.assign(model.triangles.size(), {});
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const Triangle& triangle = model.triangles[t];
    const std::int32_t corners[3] = {triangle.a, triangle.b, triangle.c};
    const ClothSettings& cloth = scene.cloths[model.ClothOf(static_cast<std::int64_t>(t))];
    const double density = cloth.density * factorsOf(t).density;
    const double area = model.Rest(t).area;
    for (const std::int32_t v : corners) model.mass[Index(v)] += density * area / 3;

    const double bendWarp = cloth.bendWarp * factorsOf(t).bend, bendWeft = cloth.bendWeft * factorsOf(t).bend;
    const double mixed = std::sqrt(bendWarp * bendWeft);
    const BendingStiffness stiffness{bendWarp, cloth.poissonRatio * mixed, bendWeft,
                                     0.5 * (1 - cloth.poissonRatio) * mixed};
    const auto self = static_cast<std::int32_t>(t);
    const MaterialPoint points[3] = {Corner(model, self, 0), Corner(model, self, 1), Corner(model, self, 2)};
    MaterialPoint across[3] = {};
    bool present[3] = {};
    double areaAcross[3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t h = model.hingeOf[t][k];
      if (h < 0) continue;
      const FabricHinge& hinge = model.hinges[Index(h)];
      const std::size_t side = hinge.triangle[0] == self ? 0 : 1;
      const std::int32_t other = hinge.triangle[1 - side];
      const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
      present[k] = true;
      areaAcross[k] = model.Rest(Index(other)).area;
      across[k] = UnfoldedApex(points[from], points[to], points[k], CornerAt(model, other, corners[from]),
                               CornerAt(model, other, corners[to]), CornerAt(model, other, hinge.vertex[3 - side]));
    }
    model.bending[t] = mixed > 0 ? MakeFittedBendingMatrix(stiffness, points, across, present)
                                 : MakeBendingMatrix(stiffness, points, areaAcross);
  }
  AssemblePlates(model);
  // Unlike `= {}` these give the memory back. Hinges that ever bent stay, as folds in them may have set.
  if (!model.anyHinges) model.bending = std::vector<BendingMatrix<double>>();
  if (!model.anyHinges && !hadHinges) {
    model.hinges = std::vector<FabricHinge>();
    model.firstHinge.assign(model.firstVertex.size(), 0);
    model.hingeOf = std::vector<std::array<std::int32_t, 3>>();
    model.hingeEnds = Lists();
  }
}

}  // namespace percale::fabric
