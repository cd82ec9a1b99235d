#include "collide/pair_finder.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "collide/chunk_lists.h"
#include "collide/clusters.h"
#include "collide/flat_regions.h"
#include "core/aligned.h"
#include "core/index.h"
#include "core/memory.h"

namespace percale {

using namespace collide;

namespace {

constexpr int kChunkVertices = 1024;  // that one thread takes at a time
constexpr int kLeastChunkBlocks = 2;  // of leaves, likewise
constexpr int kMostChunks = 512;
constexpr int kChunksAtOnce = 64;     // whose items have boxes at the same time
constexpr int kBoxedLeaves = 64;      // that one thread takes at a time
constexpr std::size_t kSamples = 63;  // for a median

static_assert(NearItems::kMostEdges == 3 * Clusters::kLeafItems * 3 * Clusters::kLeafItems);
static_assert(NearItems::kMostTriangles == 3 * Clusters::kLeafItems * Clusters::kLeafItems);
static_assert(TriangleShapes::kBlocks * kLanes == 2 * Clusters::kLeafItems);

int Blocks(std::int64_t count) {
  return static_cast<int>((count + kLanes - 1) / kLanes);
}

/// Shapes of the triangles of leaves, made when they are asked for. Those of a few leaves stay: pairs are searched for
/// along the mesh, so that what is asked for again is asked for soon.
class TriangleShapesOf {
 public:
  TriangleShapesOf(const Kernels& kernels, const LeafShapeArgs& args) : kernels_(kernels), args_(args) {
    leaf_.fill(-1);
  }
  const TriangleShapes& operator()(std::int32_t leaf) {
    const std::size_t place = Index(leaf) % kPlaces;
    if (std::exchange(leaf_[place], leaf) != leaf) kernels_.triangleShapes(args_, leaf, shapes_[place]);
    return shapes_[place];
  }

 private:
  static constexpr std::size_t kPlaces = 32;  // 25 kB, on the stack

  const Kernels& kernels_;
  const LeafShapeArgs& args_;
  std::array<std::int32_t, kPlaces> leaf_;  // -1: none
  std::array<TriangleShapes, kPlaces> shapes_;
};

using Write = int (*)(const WriteArgs&);

/// Adds what `write` writes to a list.
void AddPairs(ChunkLists<VertexQuad>& lists, int list, Write write, WriteArgs args) {
  for (int left = args.count; left > 0; left -= args.count) {
    const std::span<VertexQuad> room = lists.Room(list);
    args.count = static_cast<int>(std::min<std::int64_t>(left, static_cast<std::int64_t>(room.size())));
    args.to = room[0].data();
    lists.Add(list, write(args));
    args.numberA += args.count;
    args.numberB += args.count;
  }
}

/// All pairs of a kind: of several threads' lists, one list after another, or of one thread that adds them here.
class Pairs {
 public:
  explicit Pairs(int lists) : first_(Index(lists)) {}

  void Clear() { count_ = 0; }
  void Add(Write write, WriteArgs args) {
    if (args.count == 0) return;
    if (all_.size() < count_ + Index(args.count)) all_.resize((count_ + Index(args.count)) * 3 / 2);
    args.to = all_.data()->data() + 4 * count_;
    count_ += Index(write(args));
  }
  /// Makes room for what may be written to add as many again.
  void KeepRoom() {
    if (all_.size() < count_ + NearItems::kMostEdges) all_.resize(count_ + NearItems::kMostEdges);
  }
  void Join(const ChunkLists<VertexQuad>& lists, const Executor& executor) {
    count_ = 0;
    for (int list = 0; list < lists.lists(); ++list) {
      first_[Index(list)] = count_;
      count_ += Index(lists.Count(list));
    }
    if (all_.size() < count_) all_.resize(count_);
    executor.ForChunks(lists.lists(), [&](int list) {
      VertexQuad* to = all_.data() + first_[Index(list)];
      lists.ForEntries(list, [&](std::span<const VertexQuad> some) { to = std::copy(some.begin(), some.end(), to); });
    });
  }
  std::span<const VertexQuad> all() const { return {all_.data(), count_}; }
  std::size_t MemoryBytes() const { return all_.capacity() * sizeof all_[0] + first_.capacity() * sizeof first_[0]; }

 private:
  std::vector<std::size_t> first_;  // per list
  std::vector<VertexQuad> all_;     // never shrinks
  std::size_t count_ = 0;
};

/// Of the corners of items of that type, as one array.
template <class Item>
const std::int32_t* CornersOf(std::span<const Item> items) {
  static_assert(sizeof(Item) % sizeof(std::int32_t) == 0);
  return reinterpret_cast<const std::int32_t*>(items.data());
}

/// The median of some of them, by component: amid them, and no single one can draw it away.
std::array<double, 3> Middle(std::span<const Vec3> all) {
  std::array<double, 3> middle = {0, 0, 0};
  const std::size_t samples = std::min<std::size_t>(kSamples, all.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, kSamples> sorted;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      const Vec3& p = all[i * all.size() / samples];
      const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      if (std::abs(x) < kFarthest) sorted[count++] = x;
    }
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
    if (count > 0) middle[axis] = sorted[count / 2];
  }
  return middle;
}

}  // namespace

struct PairFinder::Impl {
  Impl(const ContactMesh& m, const Executor& e, const Kernels& k);

  void BoxVertices(const MeshMotion& motion, std::span<const double> reach);
  void BoxLeaves();
  LeafShapeArgs ShapeArgs(int begin, int end, bool haveCuts);
  void ShapeLeaves(std::span<const double> reach, bool haveCuts);
  void SearchLeaves(std::span<const double> reach, bool clothPairs, bool haveCuts);
  void TouchLeaves(int firstChunk, int endChunk);
  void BoxItems();
  void CompareItems(int firstChunk, int endChunk);
  void CompareItems();

  /// Calls body(begin, end, chunk) for all blocks of leaves.
  template <class Body>
  void ForBlocks(const Body& body) const {
    executor.ForChunks(
        chunks, [&](int chunk) { body(chunk * chunkBlocks, std::min((chunk + 1) * chunkBlocks, leafBlocks), chunk); });
  }
  LeafItems ItemsOf(int leaf) const;
  /// What items of the leaf are near within [m].
  float Distance(std::span<const double> reach, int leaf) const {
    return static_cast<float>(2 * reach[Index(clusters.body[Index(leaf)])] * (1 + 1e-6));
  }

  const ContactMesh& mesh;
  const Executor& executor;
  const Kernels& kernels;
  const Clusters& clusters;
  const FlatRegions regions;
  const int leafBlocks;
  const int chunkBlocks;  // of one chunk
  const int chunks;
  // Per leaf that is touched: of its edges, then come its triangles and its own vertices.
  std::vector<std::int32_t> firstItemBlock;
  AlignedVector<BoxRow> rows;                   // per vertex, and one more
  std::vector<AlignedVector<BoxBlock>> levels;  // boxes of leaves, of blocks of leaves, ... of all
  std::vector<const BoxBlock*> levelBlocks;
  std::vector<LeafShape> shapes;          // per leaf
  std::vector<std::uint8_t> areAllApart;  // per leaf, as FlatRegions has it
  AlignedVector<BoxBlock> itemBoxes;      // of the leaves that are touched
  std::vector<std::int32_t> touched;      // leaves that pairs of some chunks have
  std::vector<std::uint8_t> isTouched;    // per leaf: whether it is one of them
  ChunkLists<LeafPair> leafPairs;
  ChunkLists<VertexQuad> vertexTriangleLists, edgeEdgeLists;
  Pairs vertexTriangle, edgeEdge;
};

PairFinder::Impl::Impl(const ContactMesh& m, const Executor& e, const Kernels& k)
    : mesh(m),
      executor(e),
      kernels(k),
      clusters(m.clusters),
      regions(MakeFlatRegions(m)),
      leafBlocks(Blocks(clusters.leaves())),
      chunkBlocks(std::max(kLeastChunkBlocks, (leafBlocks + kMostChunks - 1) / kMostChunks)),
      chunks((leafBlocks + chunkBlocks - 1) / chunkBlocks),
      firstItemBlock(Index(clusters.leaves())),
      rows(m.body.size() + 1),
      shapes(Index(clusters.clothLeaves)),
      areAllApart(Index(clusters.clothLeaves)),
      isTouched(Index(clusters.leaves())),
      leafPairs(chunks),
      vertexTriangleLists(chunks),
      edgeEdgeLists(chunks),
      vertexTriangle(chunks),
      edgeEdge(chunks) {
  assert(!clusters.triangleFirst.empty() && Index(clusters.triangleFirst.back()) == mesh.triangles.size());
  BoxBlock empty;
  for (auto& extents : empty.extent) std::fill_n(extents, kLanes, -INFINITY);
  levels.emplace_back(Index(leafBlocks), empty);
  do {
    levels.emplace_back(Index(Blocks(static_cast<std::int64_t>(levels.back().size()))), empty);
  } while (levels.back().size() > 1);
  for (const auto& level : levels) levelBlocks.push_back(level.data());
}

void PairFinder::Impl::BoxVertices(const MeshMotion& motion, std::span<const double> reach) {
  // Floats are exact near zero: that is where cloths shall be, at the start and at the end.
  const auto cloths = Index(mesh.clothVertices);
  const std::array<double, 3> origin = Middle(motion.start.first(cloths)), way = Middle(motion.way.first(cloths));
  const int count = mesh.vertices();
  executor.ForChunks((count + kChunkVertices - 1) / kChunkVertices, [&](int chunk) {
    kernels.vertexRows({.begin = chunk * kChunkVertices,
                        .end = std::min((chunk + 1) * kChunkVertices, count),
                        .vertices = count,
                        .start = motion.start.data(),
                        .way = motion.way.data(),
                        .cut = motion.cut.empty() ? nullptr : motion.cut.data(),
                        .body = mesh.body.data(),
                        .reach = reach.data(),
                        .origin = {origin[0], origin[1], origin[2]},
                        .originWay = {way[0], way[1], way[2]},
                        .rows = rows.data()});
  });
}

void PairFinder::Impl::BoxLeaves() {
  ForBlocks([&](int begin, int end, int) {
    kernels.leafBoxes({.begin = begin,
                       .end = end,
                       .leaves = clusters.leaves(),
                       .vertexFirst = clusters.vertexFirst.data(),
                       .vertices = clusters.vertices.data(),
                       .rows = rows.data(),
                       .boxes = levels[0].data()});
  });
  for (std::size_t level = 1; level < levels.size(); ++level) {
    kernels.parentBoxes(levels[level - 1].data(), static_cast<int>(levels[level - 1].size()), levels[level].data());
  }
}

LeafShapeArgs PairFinder::Impl::ShapeArgs(int begin, int end, bool haveCuts) {
  return {.begin = begin,
          .end = end,
          .triangleFirst = clusters.triangleFirst.data(),
          .corners = CornersOf(std::span<const Triangle>(mesh.triangles)),
          .vertexFirst = clusters.vertexFirst.data(),
          .vertices = clusters.vertices.data(),
          .inverse = regions.inverse.empty() ? nullptr : regions.inverse[0].data(),
          .inverseFirst = regions.inverseFirst.data(),
          .greatestSlope = regions.greatestSlope.data(),
          .rows = rows.data(),
          .boxes = levels[0].data(),
          .haveCuts = haveCuts,
          .shapes = shapes.data()};
}

void PairFinder::Impl::ShapeLeaves(std::span<const double> reach, bool haveCuts) {
  ForBlocks([&](int begin, int end, int) {
    kernels.leafShapes(ShapeArgs(begin * kLanes, std::min(end * kLanes, clusters.clothLeaves), haveCuts));
  });
  ForBlocks([&](int begin, int end, int) {
    for (int leaf = begin * kLanes; leaf < std::min(end * kLanes, clusters.clothLeaves); ++leaf) {
      areAllApart[Index(leaf)] = regions.AreAllApart(leaf, shapes, Distance(reach, leaf)) ? 1 : 0;
    }
  });
}

void PairFinder::Impl::SearchLeaves(std::span<const double> reach, bool clothPairs, bool haveCuts) {
  leafPairs.Clear();
  const LeafShapeArgs shapeArgs = ShapeArgs(0, clusters.clothLeaves, haveCuts);
  ForBlocks([&](int begin, int end, int chunk) {
    TriangleShapesOf triangleShapes(kernels, shapeArgs);
    const auto trianglesOf = std::ref(triangleShapes);
    const auto put = [&](const LeafPair* pairs, int count) {
      for (int i = 0; i < count; ++i) {
        const auto [a, b] = pairs[i];
        const std::int32_t pair = regions.Find(a, b);
        if (pair >= 0 && (areAllApart[Index(a)] != 0 ||
                          regions.AreApart(pair, a, b, shapes, trianglesOf, kernels, Distance(reach, a)))) {
          continue;
        }
        leafPairs.Room(chunk)[0] = pairs[i];
        leafPairs.Add(chunk, 1);
      }
    };
    kernels.search({.begin = begin,
                    .end = end,
                    .levels = levelBlocks.data(),
                    .levelCount = static_cast<int>(levels.size()),
                    .clothLeaves = clusters.clothLeaves,
                    .clothPairs = clothPairs,
                    .put = [](void* context, const LeafPair* pairs,
                              int count) { (*static_cast<decltype(put)*>(context))(pairs, count); },
                    .context = const_cast<void*>(static_cast<const void*>(&put))});
  });
  leafPairs.KeepRoom();
}

/// Takes the leaves that the pairs of these chunks have, and makes room for the boxes of their items.
void PairFinder::Impl::TouchLeaves(int firstChunk, int endChunk) {
  for (const std::int32_t leaf : touched) isTouched[Index(leaf)] = 0;
  touched.clear();
  const auto touch = [&](std::int32_t leaf) {
    if (std::exchange(isTouched[Index(leaf)], std::uint8_t{1}) == 0) touched.push_back(leaf);
  };
  for (int chunk = firstChunk; chunk < endChunk; ++chunk) {
    leafPairs.ForEntries(chunk, [&](std::span<const LeafPair> pairs) {
      for (const LeafPair& pair : pairs) touch(pair.a), touch(pair.b);
    });
  }
  std::int32_t blocks = 0;
  for (const std::int32_t leaf : touched) {
    const auto count = [](const auto& items) { return Blocks(static_cast<std::int64_t>(items.size())); };
    firstItemBlock[Index(leaf)] = blocks;
    blocks += count(mesh.Edges(leaf)) + count(clusters.OwnVertices(leaf)) + count(mesh.Triangles(leaf));
  }
  if (itemBoxes.size() < Index(blocks)) itemBoxes.resize(Index(blocks) * 3 / 2);
}

LeafItems PairFinder::Impl::ItemsOf(int leaf) const {
  LeafItems items;
  items.leafBoxes = &levels[0][Index(leaf / kLanes)];
  items.lane = leaf % kLanes;
  items.edges = static_cast<int>(mesh.Edges(leaf).size());
  items.vertices = static_cast<int>(clusters.OwnVertices(leaf).size());
  items.triangles = static_cast<int>(mesh.Triangles(leaf).size());
  items.edgeBoxes = itemBoxes.data() + firstItemBlock[Index(leaf)];
  items.triangleBoxes = items.edgeBoxes + Blocks(items.edges);
  items.vertexBoxes = items.triangleBoxes + Blocks(items.triangles);
  return items;
}

void PairFinder::Impl::BoxItems() {
  const int count = static_cast<int>(touched.size());
  executor.ForChunks((count + kBoxedLeaves - 1) / kBoxedLeaves, [&](int chunk) {
    for (int i = chunk * kBoxedLeaves; i < std::min((chunk + 1) * kBoxedLeaves, count); ++i) {
      const std::int32_t leaf = touched[Index(i)];
      BoxBlock* to = itemBoxes.data() + firstItemBlock[Index(leaf)];
      const auto box = [&](const std::int32_t* corners, int cornersPerItem, std::size_t number) {
        const int items = static_cast<int>(number);
        if (items == 0) return;
        for (auto& extents : to[Blocks(items) - 1].extent) std::fill_n(extents, kLanes, -INFINITY);
        kernels.itemBoxes({corners, cornersPerItem, items, rows.data(), to});
        to += Blocks(items);
      };
      box(CornersOf(mesh.Edges(leaf)), 2, mesh.Edges(leaf).size());
      box(CornersOf(mesh.Triangles(leaf)), 3, mesh.Triangles(leaf).size());
      box(CornersOf(clusters.OwnVertices(leaf)), 1, clusters.OwnVertices(leaf).size());
    }
  });
}

void PairFinder::Impl::CompareItems(int firstChunk, int endChunk) {
  const bool isSerial = executor.threads() == 1;
  executor.ForChunks(endChunk - firstChunk, [&](int index) {
    const int chunk = firstChunk + index;
    const auto add = [&](Pairs& pairs, ChunkLists<VertexQuad>& lists, Write write, const WriteArgs& args) {
      if (isSerial) {
        pairs.Add(write, args);
      } else {
        AddPairs(lists, chunk, write, args);
      }
    };
    NearItems near;
    const auto compare = [&](const LeafPair& pair) {
      kernels.nearItems(ItemsOf(pair.a), ItemsOf(pair.b), pair.a == pair.b, near);
      const auto vertices = [&](int leaf) { return CornersOf(clusters.OwnVertices(leaf)); };
      const auto triangles = [&](int leaf) { return CornersOf(mesh.Triangles(leaf)); };
      const auto edges = [&](int leaf) { return CornersOf(mesh.Edges(leaf)); };
      add(vertexTriangle, vertexTriangleLists, kernels.writeVertexTriangle,
          {near.vertexTriangle, near.vertexA, near.triangleB, vertices(pair.a), triangles(pair.b), nullptr});
      add(vertexTriangle, vertexTriangleLists, kernels.writeVertexTriangle,
          {near.triangleVertex, near.vertexB, near.triangleA, vertices(pair.b), triangles(pair.a), nullptr});
      add(edgeEdge, edgeEdgeLists, kernels.writeEdgeEdge,
          {near.edges, near.edgeA, near.edgeB, edges(pair.a), edges(pair.b), nullptr});
    };
    leafPairs.ForEntries(chunk, [&](std::span<const LeafPair> pairs) {
      for (const LeafPair& pair : pairs) compare(pair);
    });
  });
}

void PairFinder::Impl::CompareItems() {
  vertexTriangleLists.Clear();
  edgeEdgeLists.Clear();
  for (int chunk = 0; chunk < chunks; chunk += kChunksAtOnce) {
    const int end = std::min(chunks, chunk + kChunksAtOnce);
    TouchLeaves(chunk, end);
    BoxItems();
    CompareItems(chunk, end);
  }
  if (executor.threads() == 1) {
    vertexTriangle.KeepRoom();
    edgeEdge.KeepRoom();
  } else {
    vertexTriangleLists.KeepRoom();
    edgeEdgeLists.KeepRoom();
    vertexTriangle.Join(vertexTriangleLists, executor);
    edgeEdge.Join(edgeEdgeLists, executor);
  }
}

PairFinder::PairFinder(const ContactMesh& mesh, const Executor& executor) : PairFinder(mesh, executor, BestKernels()) {}
PairFinder::PairFinder(const ContactMesh& mesh, const Executor& executor, const Kernels& kernels)
    : impl_(std::make_unique<Impl>(mesh, executor, kernels)) {}
PairFinder::~PairFinder() = default;

void PairFinder::Find(const MeshMotion& motion, std::span<const double> reach, bool clothPairs) {
  Impl& s = *impl_;
  assert(motion.start.size() == s.mesh.body.size() && motion.way.size() == s.mesh.body.size());
  assert(motion.cut.empty() || motion.cut.size() == s.mesh.body.size());
  assert(reach.size() >= Index(s.mesh.bodies()));
  s.vertexTriangle.Clear();
  s.edgeEdge.Clear();
  if (s.clusters.clothLeaves == 0) return;
  s.BoxVertices(motion, reach);
  s.BoxLeaves();
  if (clothPairs) s.ShapeLeaves(reach, !motion.cut.empty());
  s.SearchLeaves(reach, clothPairs, !motion.cut.empty());
  s.CompareItems();
}

std::span<const VertexQuad> PairFinder::vertexTriangle() const {
  return impl_->vertexTriangle.all();
}

std::span<const VertexQuad> PairFinder::edgeEdge() const {
  return impl_->edgeEdge.all();
}

std::size_t PairFinder::MemoryBytes() const {
  const Impl& s = *impl_;
  std::size_t sum = s.regions.MemoryBytes() + BytesOf(s.shapes) + BytesOf(s.areAllApart) + BytesOf(s.firstItemBlock) +
                    BytesOf(s.rows) + BytesOf(s.itemBoxes) + BytesOf(s.touched) + BytesOf(s.isTouched) +
                    s.leafPairs.MemoryBytes() + s.vertexTriangleLists.MemoryBytes() + s.edgeEdgeLists.MemoryBytes() +
                    s.vertexTriangle.MemoryBytes() + s.edgeEdge.MemoryBytes();
  for (const auto& level : s.levels) sum += BytesOf(level);
  return sum;
}

}  // namespace percale
