#pragma once
/// \file
/// The inner loops of the continuum engine: pure functions over arrays that the caller owns. The same source is
/// compiled for several instruction sets and chosen once at run time (`BestKernels`); none of them contracts or
/// reorders arithmetic, so all give the same bits.

#include <cstdint>
#include <vector>

#include "fabric/energy/air.h"
#include "fabric/energy/membrane.h"
#include "fabric/real.h"
#include "fabric/shared_rows.h"
#include "math/vector3.h"
#include "percale/mesh.h"
#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale::fabric {

/// Kernels read so many numbers behind the last triangle's.
inline constexpr int kTrianglePad = 8;
/// Reals that a triangle's second derivative takes.
inline constexpr int kHessianReals = 27;

/// Some triangles of one cloth. Arrays are from the first triangle of all on.
struct MembraneArgs {
  int begin, end;
  const Triangle* triangles;
  const Vec3* x;                   ///< Positions [m].
  const Triangle* chartTriangles;  ///< The triangles, of points of the chart.
  const Vec2* chart;               ///< Where they lie in the material [m].
  const double* strength;          ///< Of each, over that of the law; or null: one.
  MembraneLaw law;
  StVenantKirchhoff<double> orthotropic;
  StableNeoHookean<double> neoHookean;
  double damping;          ///< Time constant of strain rates over the length of the step; 0 for none.
  double* startStrain[3];  ///< Strain at the start of the step, one array per component; padded.
  // A second derivative may keep so much compression: BucklingStress over `strength`, times `compression`.
  const double* mass;        ///< Per vertex [kg].
  double bendStiffness;      ///< Of the cloth [N m].
  const double* stiffening;  ///< Of each, over that; or null: one.
  double compression;        ///< How often the stress, over the length of the step [1/s].
  // Out, for triangles from `outFirst` on:
  int outFirst;
  Vec3* gradient;  ///< By corner a, b, c of each triangle [N].
  Real* hessian;   ///< Per triangle the blocks (a, b), (b, c), (c, a), column by column [N/m].
};

/// The triangle that is stretched most, the first of such.
struct MembraneStretch {
  double square = 0;  ///< Of the larger singular value of its deformation gradient.
  int triangle = -1;  ///< -1: none is stretched at all.
};

/// What pulls at a vertex beside gravity over one step, quadratic in its way w = y - x: energy ½ wᵀ B w - f·w [J].
struct VertexLoad {
  SymmetricMatrix3<double> stiffness;  ///< B, without negative eigenvalues [N/m].
  Vec3 force;                          ///< f [N].
};

/// The wind on some triangles, of any cloths. Arrays are from the first triangle or vertex of all on.
struct WindArgs {
  int begin, end;
  const Triangle* triangles;
  const Vec3* x;         ///< Positions [m].
  const Vec3* previous;  ///< A step before [m].
  double h;              ///< Of the step [s].
  Air<double> air;
  Vec3 wind;         ///< [m/s]
  int outFirst;      ///< Out, for triangles from this one on:
  VertexLoad* load;  ///< Per triangle what it loads each of its corners with.
};

/// Some rows of the matrix of plates.
struct PlateArgs {
  int begin, end;
  SharedRowsView<double> rows;  ///< [N/m]
  const std::uint8_t* isPlate;  ///< Per row: 0 where it does not count.
  const Vec3* x;                ///< Positions [m].
  Vec3* force;                  ///< Out, in rows that count: the row times the positions [N].
};

/// Some rows of the matrix. Arrays are from the first row or block of all on.
struct AssembleArgs {
  int begin, end;
  SharedRowsView<std::int32_t> columns;  ///< As BlockPattern has them ...
  const std::int32_t* storedFirst;       ///< ... and this.
  // As SystemMatrix has them, scalars that stand on the diagonals of blocks besides:
  const Real* diagonal;             ///< Per row, of its block on the diagonal.
  SharedRowsView<Real> constant;    ///< Of the other stored blocks of each row, first of all.
  const std::int32_t* cornerFirst;  ///< The corners of row v are [cornerFirst[v], cornerFirst[v + 1]) of ...
  const std::int32_t* corner;       ///< ... these: 3 * triangle + 0, 1, 2.
  // Codes of BlockPart, of either type; the other is null.
  const std::uint8_t* parts;
  const std::uint32_t* wideParts;
  std::int32_t cornersBegin, corners;  ///< As LiveTriangles has them, three times.
  const Real* hessian;                 ///< As MembraneArgs has it; one more can be read at the end.
  Real* blocks;                        ///< Out.
};

/// Some rows of a SystemMatrix and vectors over all rows. Arrays are from the first row or block of all on.
struct RowsArgs {
  int begin, end;
  SharedRowsView<std::int32_t> columns;  ///< As BlockPattern has them ...
  const std::int32_t* storedFirst;       ///< ... and this.
  const Real* blocks;                    ///< Nine per stored block, column by column; one more can be read at the end.
  SharedRowsView<Real> constant;  ///< As SystemMatrix has them: scalars outside the pattern come last in each row.
  const std::int32_t* extraBegin;
  const std::int32_t* extraEnd;
  const std::int32_t* extraColumn;
  const Real* extraBlocks;  ///< As in ExtraRows; null where there are none.
  const Real* inverse;      ///< Per row the inverse of its block on the diagonal, as `blocks`. For `smooth`.
  Real omega;               ///< For `smooth`.
  const Real* right;        ///< b. For `residual` and `smooth`.
  const Real* x;
  Real* y;  ///< Out; no other vector.
};

struct Kernels {
  const char* name;
  /// Writes startStrain.
  void (*membraneStrain)(const MembraneArgs&);
  /// Returns the greatest.
  MembraneStretch (*membraneStretch)(const MembraneArgs&);
  /// Returns the sum [J].
  double (*membraneEnergy)(const MembraneArgs&);
  /// Writes the gradient.
  void (*membraneGradient)(const MembraneArgs&);
  /// Writes the gradient and the second derivative, whose eigenvalues are bounded from below.
  void (*membraneTangent)(const MembraneArgs&);
  /// Of each row the sum of value times way from its own vertex; returns that of value times squared way [J].
  double (*plateForces)(const PlateArgs&);
  void (*windLoads)(const WindArgs&);
  /// Writes the blocks. What a membrane does to a vertex and to its neighbours adds up to nothing, as no translation
  /// strains it: so the block on the diagonal follows from the others.
  void (*assemble)(const AssembleArgs&);
  /// y = H x; returns x'y.
  double (*multiply)(const RowsArgs&);
  /// y = b - H x
  void (*residual)(const RowsArgs&);
  /// y = x + omega D^-1 (b - H x)
  void (*smooth)(const RowsArgs&);
};

/// All that the processor can run, the plain ones first and the fastest last.
std::vector<const Kernels*> RunnableKernels();
/// The last of them.
const Kernels& BestKernels();

}  // namespace percale::fabric
