// Which items of two leaves are near each other. Included by kernels_impl.h inside the namespace of an instruction set,
// like everything there; never elsewhere.

constexpr int kMostItems = 48;
constexpr int kMostBlocks = kMostItems / kLanes;

/// Those of some items that may be near anything: as numbers, and as a set per block.
struct Chosen {
  std::uint8_t numbers[kMostItems + kLanes];
  std::uint8_t sets[kMostBlocks];
  int count = 0;

  /// Those near a box.
  Chosen(const BoxBlock* boxes, int items, OneBox box) {
    for (int first = 0; first < items; first += kLanes) {
      const unsigned near = EightBoxes(boxes[first / kLanes]).Near(box);
      sets[first / kLanes] = static_cast<std::uint8_t>(near);
      PutLanes(numbers + count, near, first);
      count += LaneCount(near);
    }
  }
};

/// Pairs of some of a with some of b, whose items are so many. Returns how many.
inline int NearPairs(const BoxBlock* a, const Chosen& someA, const BoxBlock* b, const Chosen& someB, int itemsB,
                     std::uint8_t* numberA, std::uint8_t* numberB) {
  int count = 0;
  for (int first = 0; first < itemsB; first += kLanes) {
    const unsigned set = someB.sets[first / kLanes];
    if (set == 0) continue;
    const EightBoxes boxes(b[first / kLanes]);
    for (int k = 0; k < someA.count; ++k) {
      const int i = someA.numbers[k];
      const unsigned near = boxes.Near(BoxAt(a, i)) & set;
      PutSame(numberA + count, i);
      PutLanes(numberB + count, near, first);
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
  const OneBox boxA = BoxAt(a.leafBoxes, a.lane), boxB = BoxAt(b.leafBoxes, b.lane);
  const Chosen edgesA(a.edgeBoxes, a.edges, boxB), edgesB(b.edgeBoxes, b.edges, boxA);
  out.edges = NearPairs(a.edgeBoxes, edgesA, b.edgeBoxes, edgesB, b.edges, out.edgeA, out.edgeB);
  const Chosen verticesA(a.vertexBoxes, a.vertices, boxB), trianglesB(b.triangleBoxes, b.triangles, boxA);
  out.vertexTriangle =
      NearPairs(a.vertexBoxes, verticesA, b.triangleBoxes, trianglesB, b.triangles, out.vertexA, out.triangleB);
  const Chosen verticesB(b.vertexBoxes, b.vertices, boxA), trianglesA(a.triangleBoxes, a.triangles, boxB);
  out.triangleVertex =
      NearPairs(b.vertexBoxes, verticesB, a.triangleBoxes, trianglesA, a.triangles, out.vertexB, out.triangleA);
}
