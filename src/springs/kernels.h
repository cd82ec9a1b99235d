#pragma once
/// \file
/// The inner loops of the spring engine: pure functions over arrays that the caller owns. The same
/// source is compiled for several instruction sets and chosen once at run time (`BestKernels`);
/// none of them contracts or reorders arithmetic, so all give the same bits.

#include <cstdint>
#include <limits>
#include <vector>

namespace percale::springs {

/// The rest length that stands where a point creates no spring of a kind.
inline constexpr double kNoSpringRest = std::numeric_limits<double>::infinity();
/// Kernels read this many numbers after a sheet's positions, rest lengths and forces, and before its rest
/// lengths and forces, ...
inline constexpr int kGridPad = 8;
inline int RoundUpToPad(int count) {
  return (count + kGridPad - 1) / kGridPad * kGridPad;
}
/// ... and this many positions before it, for the springs that its first rows do not have.
inline int GridPadding(int numWidth) {
  return RoundUpToPad(2 * numWidth) + kGridPad;
}

/// Forces and Verlet integration over some rows of one cloth.
struct IntegrateArgs {
  int numWidth, numHeight;
  int rowBegin, rowEnd;  ///< Rows whose points are moved.
  const double* x;       ///< Positions along the first axis, from the cloth's first point on [m]; those along the
                         ///< second and third are `stride` and 2 `stride` numbers behind.
  double* previous;      ///< Likewise. In: positions one step ago. Out: positions one step on. [m]
  std::int64_t stride;
  const double* rest;  ///< Rest lengths of the springs of the first kind, by the point that creates them, or
                       ///< kNoSpringRest [m]; those of the other kinds follow `restStride` numbers apart.
  std::int64_t restStride;
  double stiffness[6];          ///< Of each kind [N/m]; 0 for kinds that are not enabled.
  double weight[3];             ///< Force on every point: mass times accelerations [N].
  const double* extraForce[3];  ///< More force, one per point [N]; null: none.
  double keep;                  ///< Share of the velocity that is kept in a step.
  double forceToWay;            ///< dt^2 / mass [m/N]; 0 for a cloth without mass.
  double bound;                 ///< Coordinates beyond it count as diverged [m].
  double* scratch;              ///< IntegrateScratch(numWidth) doubles; best at a multiple of 64 bytes.
};

/// Which springs are so long that the strain limit has to look at them. Some that are not may be told, too.
struct LongSpringsArgs {
  int numWidth;
  int rowBegin, rowEnd;
  const double* x[3];
  double origin[3];          ///< Positions are taken relative to it, in float [m]:
  float farthest;            ///< springs are told of points up to so far from it along each axis [m].
  const float* nearSquared;  ///< Per column of points: square of the length from which on its springs of the first
                             ///< kind count as near their limit, less what positions in float are off [m^2]; infinite
                             ///< where there are none, and for kGridPad columns more. Of the other kinds: `nearStride`
                             ///< numbers apart.
  std::int64_t nearStride;
  std::uint8_t* nearKinds;  ///< Out: per point one bit per kind of spring, set where it is near its limit or longer.
  float* scratch;           ///< MarkScratch(numWidth) floats.
};
/// What it returns.
enum : std::int64_t {
  kSomeAreNear = 1,     ///< Some springs are near their limit.
  kSomeAreFarAway = 2,  ///< Some points are too far away: any spring may be near its limit.
};

struct GreatestStretchArgs {
  int numWidth;
  std::int64_t pointCount;
  const double* x[3];
  const double* rest[6];
};
struct GreatestStretchResult {
  double squaredRatio;  ///< Of length and rest length.
  std::int64_t point;   ///< That creates the spring.
};

/// What is stored in the springs of one cloth.
struct ElasticEnergyArgs {
  int numWidth;
  std::int64_t pointCount;
  const double* x[3];
  const double* rest[6];
  double stiffness[6];  ///< Of each kind [N/m]; 0 for kinds that are not enabled.
};

/// The strain limit looks for bits of this many points at once.
inline constexpr int kMarkBlock = 64;
/// Zeros that it needs behind the bits of the last point: springs created there do not exist.
inline int MarkPadding(int numWidth) {
  return 2 * numWidth + kMarkBlock;
}

/// The strain limit's sweep over the springs of one cloth.
struct StrainArgs {
  int numWidth;
  std::int64_t pointCount;
  double* x[3];               ///< In and out.
  const std::uint8_t* fixed;  ///< Per point: 1 for pins.
  const double* rest[6];
  double limit;               ///< Greatest length over rest length.
  const std::uint8_t* kinds;  ///< Per point: a bit for each kind of spring that it creates; then MarkPadding zeros.
  std::uint8_t* marks;        ///< In: those that are near their limit; then MarkPadding zeros. Changed.
  float* moved;               ///< Per point: zero. Changed.
  float budget;               ///< While no end moves farther, a spring that is not near its limit stays below it [m].
};

/// A point's place in its box has this many bits for each axis, ...
inline constexpr int kPlaceBits = 14;
/// ... each of which is less than this many units off.
inline constexpr double kPlaceError = 2.5;

struct BoxKeyArgs {
  int firstPoint, count;
  const double* x[3];     ///< From the first of the points on.
  double boxSize[3];      ///< [m]; none is longer than the third.
  std::uint64_t* key;     ///< In and out, from the first of the points on: three box indices of 21 bits each.
  std::uint64_t* place;   ///< Out, likewise: where the points are in their boxes, from the lower end of each axis on,
                          ///< in 2^-kPlaceBits of the longest side of a box; 16 bits each for x, y, z and zero.
  std::int32_t* changed;  ///< Out: the points whose key is another than it was. As much room as there are points.
  std::uint8_t* wraps;    ///< Set to 1 when an index does not fit, so that far boxes may share a key.
};

/// Buckets of the spatial map, whose points push each other apart.
struct BucketArgs {
  int bucketBegin, bucketEnd;
  const std::int32_t* first;    ///< Per bucket: index of its first member.
  const std::int32_t* count;    ///< Per bucket: how many there are.
  const std::int32_t* members;  ///< Indices into x, ascending within a bucket. Behind them stand 8 others.
  double* x[3];                 ///< In and out.
  const std::uint8_t* fixed;    ///< Per point: 1 for pins.
  const double* thickness;      ///< Per point [m].
  double greatestApart;         ///< No two points have a greater sum of thicknesses [m].
  bool sameThickness;           ///< Whether all pairs have that sum.
  const std::uint64_t* place;   ///< Where they are in their box (BoxKeyArgs), which those of a bucket share; null where
                                ///< they may not.
  double boxSize;               ///< Longest side of a box [m].
  double stepsPerFrame;
  double* scratch;       ///< 3 * (points of the largest bucket + kGridPad) doubles.
  std::int32_t* others;  ///< As many numbers as the largest bucket has points.
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
  /// Returns 0 when no spring is near its limit, or which of the above holds.
  std::int64_t (*markLongSprings)(const LongSpringsArgs&);
  /// Returns the number of springs shortened.
  std::int64_t (*limitStrain)(const StrainArgs&);
  GreatestStretchResult (*greatestStretch)(const GreatestStretchArgs&);
  /// Returns half of the stiffness times the square of what is longer or shorter than at rest, of all [J].
  double (*elasticEnergy)(const ElasticEnergyArgs&);
  /// Returns the number of points whose key changed.
  std::int64_t (*boxKeys)(const BoxKeyArgs&);
  /// Returns the number of (point, neighbour) contacts.
  std::int64_t (*separateBuckets)(const BucketArgs&);
  /// Return the number of points put back.
  std::int64_t (*collideSphere)(const ColliderArgs&);
  std::int64_t (*collidePlane)(const ColliderArgs&);
};

/// `integrate` keeps sums of forces for this many points, six numbers each: a power of two that holds a row and a
/// block.
int ForceRingSize(int numWidth);
/// Doubles of scratch that `integrate` needs for a cloth of that width; a multiple of kGridPad.
int IntegrateScratch(int numWidth);

/// Floats of scratch that `markLongSprings` needs for a cloth of that width: for three rows.
int MarkScratch(int numWidth);

/// All that the processor can run, the plain ones first and the fastest last.
std::vector<const Kernels*> RunnableKernels();
/// The last of them.
const Kernels& BestKernels();
/// The first of them: for any processor of the platform, the plain twin of the others.
const Kernels& BaselineKernels();

}  // namespace percale::springs
