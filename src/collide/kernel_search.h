// Which leaves are near each other. Included by kernels_impl.h inside the namespace of an instruction set, like
// everything there; never elsewhere.

/// Leaves of two blocks, the second not before the first.
inline void SearchBlocks(const SearchArgs& a, int first, int second) {
  unsigned allowed = 0xff;
  if (!a.clothPairs && a.clothLeaves > second * kLanes) {
    const int cloth = a.clothLeaves - second * kLanes;
    allowed = cloth < kLanes ? 0xffu << cloth & 0xff : 0;
  }
  const unsigned near = EightBoxes(a.levels[0][first]).Near(BoxAt(a.levels[1], second));
  const EightBoxes boxes(a.levels[0][second]);
  LeafPair pairs[kLanes];
  for (int k = 0; k < kLaneTable.count[near]; ++k) {
    const int lane = kLaneTable.lanes[near][k], leaf = first * kLanes + lane;
    if (leaf >= a.clothLeaves) break;
    unsigned others = boxes.Near(BoxAt(a.levels[0], leaf)) & allowed;
    if (first == second) others &= 0xffu << lane;
    const int count = kLaneTable.count[others];
    for (int i = 0; i < kLanes; ++i) pairs[i] = {leaf, second * kLanes + kLaneTable.lanes[others][i]};
    if (count > 0) a.put(a.context, pairs, count);
  }
}

/// A block of leaves against those of a block of nodes that do not come before it.
void Visit(const SearchArgs& a, int leafBlock, int level, int block) {
  const unsigned near = EightBoxes(a.levels[level][block]).Near(BoxAt(a.levels[1], leafBlock));
  for (int k = 0; k < kLaneTable.count[near]; ++k) {
    const int child = block * kLanes + kLaneTable.lanes[near][k];
    const std::int64_t end = (child + std::int64_t{1}) << 3 * (level - 1);  // of the blocks of leaves below it
    if (end <= leafBlock) continue;
    if (level == 1) {
      SearchBlocks(a, leafBlock, child);
    } else {
      Visit(a, leafBlock, level - 1, child);
    }
  }
}

void Search(const SearchArgs& a) {
  for (int block = a.begin; block < a.end && block * kLanes < a.clothLeaves; ++block) {
    Visit(a, block, a.levelCount - 1, 0);
  }
}
