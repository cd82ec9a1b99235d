// Which items of two leaves are near each other. Included by kernels_impl.h inside the namespace of an instruction set,
// like everything there; never elsewhere.

constexpr int kMostBlocks = (48 + 16) / kLanes;  // of edges and triangles

inline int BlockCount(int items) {
  return (items + kLanes - 1) / kLanes;
}

/// Those edges and triangles of a leaf that may be near anything: as numbers, the edges' before the triangles', counted
/// in one row of blocks; and as a set per block.
struct Chosen {
  std::uint8_t numbers[(kMostBlocks + 1) * kLanes];
  std::uint8_t sets[kMostBlocks];
  int edges, all;

  /// Those near a box.
  Chosen(const LeafItems& items, const float* box) {
    const int edgeBlocks = BlockCount(items.edges), blocks = edgeBlocks + BlockCount(items.triangles);
    int count = 0;
    edges = 0;
    for (int block = 0; block < blocks; ++block) {
      const unsigned near = EightBoxes(items.edgeBoxes[block]).Near(box);
      sets[block] = static_cast<std::uint8_t>(near);
      PutLanes(numbers + count, near, block * kLanes);
      count += LaneCount(near);
      edges = block < edgeBlocks ? count : edges;
    }
    all = count;
  }
};

/// Pairs of chosen edges. Returns how many.
inline int NearEdges(const LeafItems& a, const Chosen& chosenA, const LeafItems& b, const Chosen& chosenB,
                     std::uint8_t* numberA, std::uint8_t* numberB) {
  int count = 0;
  for (int first = 0; first < b.edges; first += kLanes) {
    const unsigned set = chosenB.sets[first / kLanes];
    if (set == 0) continue;
    const EightBoxes boxes(b.edgeBoxes[first / kLanes]);
    for (int k = 0; k < chosenA.edges; ++k) {
      const int i = chosenA.numbers[k];
      const unsigned near = boxes.Near(BoxAt(a.edgeBoxes, i)) & set;
      PutSame(numberA + count, i);
      PutLanes(numberB + count, near, first);
      count += LaneCount(near);
    }
  }
  return count;
}

/// Pairs of the vertices of one leaf with the chosen triangles of another. Returns how many.
inline int NearTriangles(const LeafItems& ofVertices, const LeafItems& ofTriangles, const Chosen& chosen,
                         std::uint8_t* vertex, std::uint8_t* triangle) {
  int count = 0;
  if (chosen.all == chosen.edges) return 0;
  const int offset = BlockCount(ofTriangles.edges) * kLanes;
  for (int first = 0; first < ofVertices.vertices; first += kLanes) {
    const EightBoxes boxes(ofVertices.vertexBoxes[first / kLanes]);
    for (int k = chosen.edges; k < chosen.all; ++k) {
      const int i = chosen.numbers[k];
      const unsigned near = boxes.Near(BoxAt(ofTriangles.edgeBoxes, i));
      PutLanes(vertex + count, near, first);
      PutSame(triangle + count, i - offset);
      count += LaneCount(near);
    }
  }
  return count;
}

/// Pairs of all a with all b.
inline int AllNearPairs(const BoxBlock* a, int itemsA, const BoxBlock* b, int itemsB, std::uint8_t* numberA,
                        std::uint8_t* numberB) {
  int count = 0;
  for (int first = 0; first < itemsB; first += kLanes) {
    const EightBoxes boxes(b[first / kLanes]);
    for (int i = 0; i < itemsA; ++i) {
      const unsigned near = boxes.Near(BoxAt(a, i));
      PutSame(numberA + count, i);
      PutLanes(numberB + count, near, first);
      count += LaneCount(near);
    }
  }
  return count;
}

/// Pairs among all, each once.
inline int NearPairsOfOne(const BoxBlock* a, int items, std::uint8_t* lower, std::uint8_t* higher) {
  int count = 0;
  for (int first = 0; first < items; first += kLanes) {
    const EightBoxes boxes(a[first / kLanes]);
    const int end = first + kLanes < items ? first + kLanes : items;
    for (int i = 0; i < end; ++i) {
      unsigned near = boxes.Near(BoxAt(a, i));
      if (i >= first) near &= 0xfeu << (i - first);
      PutSame(lower + count, i);
      PutLanes(higher + count, near, first);
      count += LaneCount(near);
    }
  }
  return count;
}

void FindNearItems(const LeafItems& a, const LeafItems& b, bool same, NearItems& out) {
  if (same) {
    out.edges = NearPairsOfOne(a.edgeBoxes, a.edges, out.edgeA, out.edgeB);
    out.vertexTriangle =
        AllNearPairs(a.vertexBoxes, a.vertices, b.triangleBoxes, b.triangles, out.vertexA, out.triangleB);
    out.triangleVertex = 0;
    return;
  }
  const Chosen chosenA(a, BoxAt(b.leafBoxes, b.lane)), chosenB(b, BoxAt(a.leafBoxes, a.lane));
  out.edges = NearEdges(a, chosenA, b, chosenB, out.edgeA, out.edgeB);
  out.vertexTriangle = NearTriangles(a, b, chosenB, out.vertexA, out.triangleB);
  out.triangleVertex = NearTriangles(b, a, chosenA, out.vertexB, out.triangleA);
}
