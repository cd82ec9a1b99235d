#include "fabric/block_parts.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <tuple>
#include <vector>

namespace percale::fabric {

Slots FindBlockParts(const BlockPattern& pattern, std::span<const Triangle> triangles, const Lists& corners) {
  struct Sided {
    std::int32_t neighbour;
    BlockPart part;
  };
  Slots codes;
  codes.reserve(2 * corners.entry.size());
  std::vector<Sided> row;
  for (int v = 0; v < pattern.rows(); ++v) {
    const std::size_t begin = static_cast<std::size_t>(corners.first[static_cast<std::size_t>(v)]);
    const std::size_t end = static_cast<std::size_t>(corners.first[static_cast<std::size_t>(v) + 1]);
    row.clear();
    for (std::size_t e = begin; e < end; ++e) {
      const Triangle& t = triangles[static_cast<std::size_t>(corners.entry[e]) / 3];
      const std::int32_t corner[3] = {t.a, t.b, t.c};
      const int k = corners.entry[e] % 3;
      const auto place = static_cast<std::uint32_t>(e - begin);
      row.push_back({corner[(k + 1) % 3], {.corner = place}});
      row.push_back({corner[(k + 2) % 3],
                     {.corner = place, .from = k > 0 ? BlockPart::From::Before : BlockPart::From::TwoBehind}});
    }
    const auto key = [](const Sided& s) {
      return std::tuple(s.neighbour, s.part.from != BlockPart::From::Own, s.part.corner);
    };
    std::sort(row.begin(), row.end(), [&](const Sided& a, const Sided& b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < row.size(); ++i) {
      assert(pattern.Find(v, row[i].neighbour) >= 0);
      row[i].part.last = i + 1 == row.size() || row[i + 1].neighbour != row[i].neighbour;
      codes.push_back(row[i].part.Code());
    }
  }
  codes.shrink_to_fit();
  return codes;
}

}  // namespace percale::fabric
