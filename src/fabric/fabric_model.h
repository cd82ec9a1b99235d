#pragma once
/// \file
/// What the cloths of a scene are, apart from their state: all of them in one set of arrays. Geometry is built once;
/// what depends on materials follows changes of the settings.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fabric/energy/bending.h"
#include "fabric/energy/membrane.h"
#include "fabric/system_matrix.h"
#include "mesh/lists.h"
#include "percale/rest_mesh.h"
#include "percale/scene.h"

namespace percale::fabric {

/// Two triangles on an edge.
struct FabricHinge {
  std::int32_t vertex[4];        ///< The edge's ends, then the corner opposite of it in either triangle.
  std::int32_t triangle[2];      ///< That of vertex[2], that of vertex[3].
  double restAngle = 0;          ///< [rad]
  HingeWeights<double> weights;  ///< Of the vertices in the jump of slope across the edge [1/m].
};

/// A rope from a vertex to a place.
struct FabricTether {
  std::int32_t vertex = 0;
  Vec3 anchor;           ///< [m]
  double length = 0;     ///< [m]
  double stiffness = 0;  ///< [N/m]
};

/// The membrane of one cloth.
struct Membrane {
  MembraneLaw kind = MembraneLaw::StVenantKirchhoff;
  StVenantKirchhoff<double> orthotropic;
  StableNeoHookean<double> neoHookean;
  double damping = 0;        ///< Time constant of strain rates [s].
  double bendStiffness = 0;  ///< Mean of the directions [N m].
};

struct FabricModel {
  // Geometry.
  int vertexCount = 0;
  std::vector<int> firstVertex;    ///< Per cloth, and the end.
  std::vector<int> firstTriangle;  ///< Per cloth, and the end.
  std::vector<Vec3> start;         ///< [m]
  std::vector<Triangle> triangles;
  std::vector<Vec2> chart;               ///< Where vertices lie in the material, each place once, u along the warp [m].
  std::vector<Triangle> chartTriangles;  ///< The triangles, of points of the chart; none where point p is vertex p.
  bool hasPanels = false;                ///< Whether triangles lie side by side in the material.
  std::vector<FabricHinge> hinges;       ///< None of these four where no cloth bends by them, or did before.
  std::vector<int> firstHinge;           ///< Per cloth, and the end.
  std::vector<std::array<std::int32_t, 3>> hingeOf;  ///< Per triangle those opposite of its corners; -1 at a border.
  Lists corners;                                     ///< Per vertex its corners: 3 * triangle + 0, 1, 2, ascending.
  Lists hingeEnds;                                   ///< Per vertex its places in hinges: 4 * hinge + 0..3, ascending.

  // Materials.
  std::vector<double> mass;                    ///< Per vertex [kg].
  std::vector<Membrane> membranes;             ///< Per cloth.
  std::vector<double> strength;                ///< Per triangle: of its membrane over that of its cloth, by patches;
                                               ///< none without patches.
  std::vector<double> stiffening;              ///< Likewise `bendStiffness` of its membrane.
  std::vector<double> pressure;                ///< Per cloth [Pa].
  std::vector<double> bendDamping;             ///< Per cloth [s].
  std::vector<BendingMatrix<double>> bending;  ///< Per triangle, for the angles of its three hinges [N m]; none
                                               ///< where no cloth bends by them.
  std::vector<std::uint8_t> plate;             ///< Per vertex: 1 where the cloth bends by BendingLaw::Quadratic.
  ScalarMatrix plates;                         ///< Bending of all cloths as a quadratic of the positions, each row
                                               ///< with an entry on the diagonal [N/m].
  std::vector<FabricTether> tethers;
  std::vector<FoldYield<double>> yield;  ///< Per hinge; none where no cloth's folds set.
  bool anyHinges = false;                ///< Whether any cloth bends by BendingLaw::Hinges.

  int Cloths() const { return static_cast<int>(firstVertex.size()) - 1; }
  std::size_t ClothOf(std::int64_t triangle) const {
    const auto behind = std::upper_bound(firstTriangle.begin(), firstTriangle.end(), triangle);
    return static_cast<std::size_t>(behind - firstTriangle.begin()) - 1;
  }
  /// The triangles, of points of the chart.
  std::span<const Triangle> ChartTriangles() const { return chartTriangles.empty() ? triangles : chartTriangles; }
  /// Where a triangle's corner 0, 1, 2 lies in the material [m].
  const Vec2& Material(std::size_t triangle, int corner) const {
    const Triangle& t = ChartTriangles()[triangle];
    return chart[static_cast<std::size_t>(corner == 0 ? t.a : corner == 1 ? t.b : t.c)];
  }
  RestTriangle<double> Rest(std::size_t triangle) const;
  double Strength(std::size_t triangle) const { return strength.empty() ? 1 : strength[triangle]; }
  /// BucklingStress over `strength` [N s/m].
  double Buckling(std::size_t triangle) const;
};

/// `meshes`: one per cloth of the scene.
FabricModel BuildModel(const Scene& scene, std::span<const RestMesh> meshes);

/// Takes the materials of the scene, which must have the same cloths.
void TakeMaterials(const Scene& scene, FabricModel& model);

}  // namespace percale::fabric
