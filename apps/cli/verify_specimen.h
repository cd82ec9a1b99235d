#pragma once
/// \file
/// What the cases of `percale verify` are made of: strips and sheets of fabric, held at their ends, without air; and
/// ways to let them come to rest.

#include <functional>
#include <vector>

#include "core/executor.h"
#include "fabric/fabric_engine.h"
#include "fabric/fabric_model.h"
#include "fabric/reference_solver.h"
#include "percale/rest_mesh.h"
#include "percale/scene.h"
#include "percale/world.h"

namespace percale::cli {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// So many steps of one second, each solved to rounding, in empty space.
Scene EmptyScene(int stepsPerSecond = 1);

/// An isotropic sheet that keeps no energy to itself: no damping, and yarns that do not lock. It lies in the plane
/// y = 0, `columns` elements along x from 0 to `width`, `rows` along z. `stiffness` [N/m], `rigidity` [N m].
ClothSettings PlainSheet(double width, double height, int columns, int rows, double density, double stiffness,
                         double poisson, double rigidity);

enum class End { Free, Hinged, Clamped };

/// A strip along x from 0 to `length`, across z. A clamp is two columns of pins with the end of the strip midway
/// between them: there the first bend would be that of the mirror image, and the error is of second order.
struct StripSettings {
  double length = 1, width = .1 * 1;  ///< [m]
  int along = 80, across = 2;         ///< Elements.
  End left = End::Clamped, right = End::Free;
  double density = 0.01;   ///< [kg/m^2]: light, so that steps of a second damp every mode.
  double rigidity = 1e-4;  ///< B [N m]
  /// K L²/B: how much stiffer it is against stretching than against bending.
  double slenderness = 1e6;
  double poisson = 0;
};
ClothSettings Strip(const StripSettings& settings);
void PinColumn(ClothSettings& cloth, int column);
void PinRow(ClothSettings& cloth, int row);

/// The vertex in the middle of that column of a grid.
int MiddleOf(const ClothSettings& cloth, int column);

/// Whole elements, at least `least`.
int Elements(double count, int least = 1);

/// Steps until no vertex moves more than `move` [m] in a frame. False: it moved on for `most` frames,
/// diverged, or the solver could go no further.
bool Settle(World& world, double move = 1e-9, int most = 200);

/// Puts the cloth where `place` takes each vertex, pins included, with the velocity that `velocity` says there.
void Put(World& world, const std::function<Vec3(int vertex)>& place, const std::function<Vec3(int vertex)>& velocity,
         int cloth = 0);

/// Masses of a grid's vertices: a third of each triangle at each corner [kg].
std::vector<double> Masses(const ClothView& cloth, const ClothSettings& settings);

/// One cloth of any mesh, stepped as World steps grids.
class MeshRun {
 public:
  /// The scene's one cloth gives the material; pins are vertices of the mesh.
  MeshRun(Scene scene, RestMesh mesh, const std::vector<std::int32_t>& pinned);

  void Step();
  /// As above, without frames.
  bool Settle(double move, int most);
  /// Puts every vertex there, at rest.
  void Put(std::span<const Vec3> positions);
  /// Takes settings for the same mesh.
  void Configure(const Scene& scene);

  const RestMesh& mesh() const { return mesh_; }
  std::span<const Vec3> positions() const { return positions_; }
  double greatestMove() const { return greatestMove_; }

 private:
  Scene scene_;
  RestMesh mesh_;
  Executor executor_;
  fabric::FabricEngine engine_;
  std::vector<Vec3> positions_, previous_;
  double time_ = 0, greatestMove_ = 0;
};

/// One grid cloth without inertia, under its weight alone. Solved directly: for states that are hardly stable.
class StaticSheet {
 public:
  explicit StaticSheet(const ClothSettings& cloth);

  /// Goes to where all forces balance with that gravity [m/s²]. False: there is no such place nearby.
  bool Solve(const Vec3& gravity);
  /// No small displacement whatever lowers the energy.
  bool IsStable();

  std::span<Vec3> positions() { return positions_; }

 private:
  fabric::FabricModel model_;
  fabric::ReferenceSolver solver_;
  std::vector<Vec3> positions_;
  std::vector<fabric::VertexLoad> loads_;
  std::vector<std::uint8_t> free_;
};

/// The load below which `isStable` is true and above which it is false, to a millionth; `guess` > 0 is where to begin.
double CriticalLoad(double guess, const std::function<bool(double load)>& isStable);

}  // namespace percale::cli
