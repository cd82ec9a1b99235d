#pragma once
/// \file
/// The inner loops of the search for pairs: pure functions over arrays that the caller owns. The same source is
/// compiled for several instruction sets and chosen once at run time (`BestKernels`); all give the same bits.

#include <cstdint>
#include <vector>

#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale::collide {

/// What lies farther from the origin comes near nothing [m].
inline constexpr float kFarthest = 1e30f;
/// Boxes side by side.
inline constexpr int kLanes = 8;

/// The box of a vertex at the start and at the end of a motion, as a BoxBlock has it. Numbers are rounded such that it
/// grows.
struct alignas(16) BoxRow {
  float extent[12];  ///< [m]
};

/// The boxes of eight things: how far they go towards -x, -y, -z at the start, the same at the end, then towards x, y,
/// z at the start and at the end [m]. Empty ones go to -infinity.
struct alignas(64) BoxBlock {
  float extent[12][kLanes];
};

struct RowArgs {
  int begin, end;           ///< Vertices.
  int vertices;             ///< Of all.
  const Vec3* start;        ///< [m]
  const Vec3* way;          ///< [m]
  const std::uint8_t* cut;  ///< As MeshMotion has it; or null.
  const std::int32_t* body;
  const double* reach;  ///< Per body [m].
  double origin[3];     ///< Boxes at the start are relative to it [m] ...
  double originWay[3];  ///< ... and at the end to that and this [m].
  BoxRow* rows;         ///< Out: what a vertex reaches; empty for what is farther than kFarthest or not a number.
                        ///< Behind the last is one more, which is read too, whatever it holds.
};

struct LeafBoxArgs {
  int begin, end;  ///< Blocks of leaves.
  int leaves;      ///< Of all.
  const std::int32_t* vertexFirst;
  const std::int32_t* vertices;  ///< As Clusters has them.
  const BoxRow* rows;
  BoxBlock* boxes;  ///< Out; those behind the last leaf are empty.
};

/// How the triangles of a leaf lie in space, at any time of a motion.
struct LeafShape {
  float x[3], y[3];  ///< What positions change by with places, along two axes, for a triangle in the middle.
  float deviation;   ///< No triangle's are farther from that, as the norm of a 3 x 2 matrix.
  float error;       ///< Nor from what TriangleShapes has.
};

/// The same of each of its triangles, those at the start before those at the end, eight by eight. Behind the last of
/// them the first stands again.
struct alignas(64) TriangleShapes {
  static constexpr int kBlocks = 4;
  int blocks;
  float x[kBlocks][3][kLanes], y[kBlocks][3][kLanes];
};

struct LeafShapeArgs {
  int begin, end;  ///< Leaves.
  const std::int32_t* triangleFirst;
  const std::int32_t* corners;  ///< Of the triangles.
  const std::int32_t* vertexFirst;
  const std::int32_t* vertices;
  const float* inverse;
  const std::int32_t* inverseFirst;  ///< As FlatRegions has them.
  const float* greatestSlope;        ///< As FlatRegions has it; leaves that have none are left out.
  const BoxRow* rows;
  const BoxBlock* boxes;  ///< Of leaves.
  bool haveCuts;          ///< Whether any vertex may be cut.
  LeafShape* shapes;      ///< Out.
};

/// Items of one kind.
struct ItemBoxArgs {
  const std::int32_t* corners;
  int cornersPerItem;  ///< 1, 2 or 3.
  int items;
  const BoxRow* rows;
  BoxBlock* boxes;  ///< Out; those behind the last item are not written.
};

/// Leaf a does not come behind leaf b.
struct LeafPair {
  std::int32_t a, b;
};

struct SearchArgs {
  int begin, end;                 ///< Blocks of leaves.
  const BoxBlock* const* levels;  ///< Boxes of leaves, then of the blocks before; the last is one block with one box.
  int levelCount;                 ///< At least two.
  int clothLeaves;                ///< Leaves from here on are those of obstacles.
  bool clothPairs;                ///< Whether a cloth leaf is to be compared with cloth leaves.
  void (*put)(void* context, const LeafPair* pairs, int count);  ///< Takes what is found, up to kLanes at a time.
  void* context;
};

/// What a leaf has. Behind the last item of a kind its last block has empty boxes.
struct LeafItems {
  const BoxBlock* leafBoxes;  ///< In which the leaf's is ...
  int lane;                   ///< ... here.
  int edges, triangles, vertices;
  const BoxBlock* edgeBoxes;      ///< Blocks of edges, then of triangles.
  const BoxBlock* triangleBoxes;  ///< Behind those of edges.
  const BoxBlock* vertexBoxes;    ///< Of its own.
};

/// Pairs of items of two leaves a and b, each by its number in its leaf. Arrays have room for one block more than there
/// can be.
struct NearItems {
  static constexpr int kMostEdges = 48 * 48, kMostTriangles = 48 * 16;
  int edges = 0, vertexTriangle = 0, triangleVertex = 0;
  std::uint8_t edgeA[kMostEdges + kLanes], edgeB[kMostEdges + kLanes];
  std::uint8_t vertexA[kMostTriangles + kLanes], triangleB[kMostTriangles + kLanes];
  std::uint8_t triangleA[kMostTriangles + kLanes], vertexB[kMostTriangles + kLanes];
};

/// Pairs that are to be written as four vertices each.
struct WriteArgs {
  int count;
  const std::uint8_t* numberA;
  const std::uint8_t* numberB;
  const std::int32_t* a;  ///< The vertices of items of a, one item after another.
  const std::int32_t* b;
  std::int32_t* to;  ///< Out: room for all.
};

/// How pairs of things are: proximity.h says what a PairState is.
struct PairStateArgs {
  static constexpr int kNumbers = 8;  ///< Of a state: four weights, a normal and a gap.
  bool edges;                         ///< Two edges each, or a vertex and a triangle.
  int count;
  const std::int32_t* quads;  ///< Four vertices per pair.
  const Vec3* x;              ///< [m]
  double* states;             ///< Out: kNumbers per pair.
};

struct Kernels {
  const char* name;
  void (*vertexRows)(const RowArgs&);
  void (*leafBoxes)(const LeafBoxArgs&);
  /// Writes the box of each block of `boxes` to its lane of `parents`.
  void (*parentBoxes)(const BoxBlock* boxes, int blocks, BoxBlock* parents);
  void (*leafShapes)(const LeafShapeArgs&);
  /// Writes those of the triangles of one leaf, which must not be left out.
  void (*triangleShapes)(const LeafShapeArgs&, int leaf, TriangleShapes& to);
  /// Whether (Gᵀ F + Fᵀ G) / 2 > least for the shapes F of all triangles, where G is x, y.
  bool (*areMonotone)(const TriangleShapes& triangles, const float x[3], const float y[3], float least);
  void (*itemBoxes)(const ItemBoxArgs&);
  /// Finds the leaves that are near each other.
  void (*search)(const SearchArgs&);
  /// Finds the items that are near each other; in a leaf itself (`same`) pairs of edges once.
  void (*nearItems)(const LeafItems& a, const LeafItems& b, bool same, NearItems& out);
  /// Writes pairs of a vertex and a triangle, without those with a vertex in common; returns how many.
  int (*writeVertexTriangle)(const WriteArgs&);
  /// The same of two edges.
  int (*writeEdgeEdge)(const WriteArgs&);
  void (*pairStates)(const PairStateArgs&);
};

/// All that the processor can run, the plain ones first and the fastest last.
std::vector<const Kernels*> RunnableKernels();
/// The last of them.
const Kernels& BestKernels();

}  // namespace percale::collide
