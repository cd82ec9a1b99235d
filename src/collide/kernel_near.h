// Which boxes of a block are near a box. Included by kernels_impl.h inside the namespace of an instruction set, like
// everything there; never elsewhere.

// Two boxes are apart if along one axis one is below the other at the start and at the end: for what moves along
// straight lines in common time keeps that in between.

/// A box, by its place in a block: numbers are kLanes apart.
struct OneBox {
  const float* low;
  const float* high;
};
inline OneBox BoxAt(const BoxBlock* blocks, int index) {
  const BoxBlock& block = blocks[index / kLanes];
  return {block.low[0] + index % kLanes, block.high[0] + index % kLanes};
}

/// Eight boxes, in registers.
class EightBoxes {
 public:
#if defined(__AVX2__)
  explicit EightBoxes(const BoxBlock& block) {
    for (int i = 0; i < 6; ++i) {
      low_[i] = _mm256_load_ps(block.low[i]);
      high_[i] = _mm256_load_ps(block.high[i]);
    }
  }
  /// A bit for each of them that is near.
  unsigned Near(OneBox box) const {
#if defined(__AVX512VL__)
    // Signs of differences are as good as comparisons, and cheaper than masks.
    __m256i apart = _mm256_setzero_si256();
    for (int i = 0; i < 3; ++i) {
      constexpr int kOrBothOthers = 0xf8;
      apart = _mm256_ternarylogic_epi32(apart, Less(All(box.high, i), low_[i]), Less(All(box.high, i + 3), low_[i + 3]),
                                        kOrBothOthers);
      apart = _mm256_ternarylogic_epi32(apart, Less(high_[i], All(box.low, i)), Less(high_[i + 3], All(box.low, i + 3)),
                                        kOrBothOthers);
    }
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(apart))) ^ 0xff;
#else
    __m256 apart = _mm256_setzero_ps();
    for (int i = 0; i < 3; ++i) {
      apart = _mm256_or_ps(apart, _mm256_and_ps(_mm256_cmp_ps(low_[i], All(box.high, i), _CMP_GT_OQ),
                                                _mm256_cmp_ps(low_[i + 3], All(box.high, i + 3), _CMP_GT_OQ)));
      apart = _mm256_or_ps(apart, _mm256_and_ps(_mm256_cmp_ps(high_[i], All(box.low, i), _CMP_LT_OQ),
                                                _mm256_cmp_ps(high_[i + 3], All(box.low, i + 3), _CMP_LT_OQ)));
    }
    return static_cast<unsigned>(_mm256_movemask_ps(apart)) ^ 0xff;
#endif
  }

 private:
  static __m256 All(const float* from, int i) {
    return _mm256_set1_ps(from[i * kLanes]);
  }
  /// The sign bit.
  static __m256i Less(__m256 a, __m256 b) {
    return _mm256_castps_si256(_mm256_sub_ps(a, b));
  }
  __m256 low_[6], high_[6];
#elif defined(__SSE2__)
  explicit EightBoxes(const BoxBlock& block) : block_(block) {}
  /// A bit for each of them that is near.
  unsigned Near(OneBox box) const {
    unsigned apart[2];
    for (int half = 0; half < 2; ++half) {
      __m128 sum = _mm_setzero_ps();
      for (int i = 0; i < 3; ++i) {
        sum = _mm_or_ps(sum, _mm_and_ps(_mm_cmpgt_ps(_mm_load_ps(block_.low[i] + 4 * half), All(box.high, i)),
                                        _mm_cmpgt_ps(_mm_load_ps(block_.low[i + 3] + 4 * half), All(box.high, i + 3))));
        sum = _mm_or_ps(sum, _mm_and_ps(_mm_cmplt_ps(_mm_load_ps(block_.high[i] + 4 * half), All(box.low, i)),
                                        _mm_cmplt_ps(_mm_load_ps(block_.high[i + 3] + 4 * half), All(box.low, i + 3))));
      }
      apart[half] = static_cast<unsigned>(_mm_movemask_ps(sum));
    }
    return (apart[0] | apart[1] << 4) ^ 0xff;
  }

 private:
  static __m128 All(const float* from, int i) {
    return _mm_set1_ps(from[i * kLanes]);
  }
  const BoxBlock& block_;
#else
  explicit EightBoxes(const BoxBlock& block) : block_(block) {}
  /// A bit for each of them that is near.
  unsigned Near(OneBox box) const {
    unsigned near = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      bool apart = false;
      for (int i = 0; i < 3; ++i) {
        const float* high = box.high + i * kLanes;
        const float* low = box.low + i * kLanes;
        apart |= block_.low[i][lane] > high[0] && block_.low[i + 3][lane] > high[3 * kLanes];
        apart |= block_.high[i][lane] < low[0] && block_.high[i + 3][lane] < low[3 * kLanes];
      }
      near |= (apart ? 0u : 1u) << lane;
    }
    return near;
  }

 private:
  const BoxBlock& block_;
#endif
};

/// For each set of lanes, which they are and how many.
struct LaneTable {
  std::uint8_t lanes[256][kLanes];
  std::uint8_t count[256];

  constexpr LaneTable() : lanes(), count() {
    for (int set = 0; set < 256; ++set) {
      for (int lane = 0; lane < kLanes; ++lane) {
        if ((set >> lane & 1) != 0) lanes[set][count[set]++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
};
constexpr LaneTable kLaneTable;

inline int LaneCount(unsigned lanes) {
#if defined(__POPCNT__)
  return __builtin_popcount(lanes);
#else
  return kLaneTable.count[lanes];
#endif
}

/// Numbers that are added to without a branch, since nobody can predict how many lanes are set. Writes whole blocks.
inline void PutLanes(std::uint8_t* to, unsigned lanes, int first) {
  std::uint64_t bytes;
  memcpy(&bytes, kLaneTable.lanes[lanes], sizeof bytes);
  bytes += static_cast<std::uint64_t>(first) * 0x0101010101010101u;
  memcpy(to, &bytes, sizeof bytes);
}
inline void PutSame(std::uint8_t* to, int number) {
  const std::uint64_t bytes = static_cast<std::uint64_t>(number) * 0x0101010101010101u;
  memcpy(to, &bytes, sizeof bytes);
}
