#pragma once
/// \file
/// The inner loops of the spring engine: pure functions over arrays that the caller owns. The same
/// source is compiled for several instruction sets and chosen once at run time (`BestKernels`);
/// none of them contracts or reorders arithmetic, so all give the same bits.

#include <cstdint>

namespace percale::springs {

/// The rest length that stands where a point creates no spring of a kind.
inline constexpr double kNoSpringRest = 1e300;
/// Kernels read this many numbers before and after a sheet's positions, and after its rest lengths;
/// `GridPadding` more positions before it, for the springs that its first rows do not have.
inline constexpr int kGridPad = 4;
inline int GridPadding(int numWidth) {
  return 2 * numWidth + kGridPad;
}

/// Forces and Verlet integration over some rows of one cloth.
struct IntegrateArgs {
  int numWidth, numHeight;
  int rowBegin, rowEnd;         ///< Rows whose points are moved.
  const double* x[3];           ///< Positions, one array per axis, from the cloth's first point on [m].
  double* previous[3];          ///< In: positions one step ago. Out: positions one step on. [m]
  const double* rest[6];        ///< Rest length of the spring of each kind that a point creates, or kNoSpringRest [m].
  double stiffness[6];          ///< Of each kind [N/m]; 0 for kinds that are not enabled.
  double weight[3];             ///< Force on every point: mass times accelerations [N].
  const double* extraForce[3];  ///< More force, one per point [N]; null: none.
  double keep;                  ///< Share of the velocity that is kept in a step.
  double forceToWay;            ///< dt^2 / mass [m/N]; 0 for a cloth without mass.
  double bound;                 ///< Coordinates beyond it count as diverged [m].
  double* scratch;              ///< IntegrateScratch(numWidth) doubles that start as zero.
};

/// Which springs are longer than they may be.
struct LongSpringsArgs {
  int numWidth;
  int rowBegin, rowEnd;
  const double* x[3];
  const double* rest[6];
  double limit;             ///< Greatest length over rest length.
  std::uint8_t* longKinds;  ///< Out: per point one bit per kind of spring, set where it may be too long.
};

struct BoxKeyArgs {
  int count;
  const double* x[3];
  double boxSize[3];   ///< [m]
  std::uint64_t* key;  ///< Out: three box indices of 21 bits each.
};

/// Buckets of the spatial map, whose points push each other apart.
struct BucketArgs {
  int bucketBegin, bucketEnd;
  const std::int32_t* first;    ///< Per bucket: index of its first member; one more at the end.
  const std::int32_t* members;  ///< Indices into x, ascending within a bucket.
  double* x[3];                 ///< In and out.
  const std::uint8_t* fixed;    ///< Per point: 1 for pins.
  const double* thickness;      ///< Per point [m].
  double greatestApart;         ///< No two points have a greater sum of thicknesses [m].
  double stepsPerFrame;
  double* scratch;  ///< 3 * (points of the largest bucket + 4) doubles.
};

/// Points begin <= p < end against one collider.
struct ColliderArgs {
  int begin, end;
  double* x[3];               ///< In and out.
  const double* previous[3];  ///< Positions before this step.
  double origin[3];           ///< Of the sphere, or a point of the plane.
  double normal[3];           ///< Of the plane, of length 1.
  double radius;              ///< Of the sphere [m].
  double friction;
  int response;  ///< Of the plane: percale::PlaneResponse.
};

struct Kernels {
  const char* name;
  /// Returns 0 when every point stays within bounds.
  std::int64_t (*integrate)(const IntegrateArgs&);
  /// Returns the number of springs marked. Marks are conservative: measure before you shorten.
  std::int64_t (*markLongSprings)(const LongSpringsArgs&);
  void (*boxKeys)(const BoxKeyArgs&);
  /// Returns the number of (point, neighbour) contacts.
  std::int64_t (*separateBuckets)(const BucketArgs&);
  /// Return the number of points put back.
  std::int64_t (*collideSphere)(const ColliderArgs&);
  std::int64_t (*collidePlane)(const ColliderArgs&);
};

/// Doubles of scratch that `integrate` needs for a cloth of that width: 27 rows with zeros at both ends.
inline constexpr int kRowPad = 2;
inline int RowStride(int numWidth) {
  return numWidth + 2 * kRowPad;
}
inline int IntegrateScratch(int numWidth) {
  return 27 * RowStride(numWidth);
}

/// For the processor that we run on.
const Kernels& BestKernels();
/// For any processor of the platform: the plain twin of the others.
const Kernels& BaselineKernels();

}  // namespace percale::springs
