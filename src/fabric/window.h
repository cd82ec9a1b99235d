#pragma once
/// \file
/// Results that are made in order, used in about the same order and then forgotten: room for those that are needed at
/// once is all they take.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace percale::fabric {

/// Makers 0, 1, 2, ... make results that users 0, 1, 2, ... need. Maker m writes to slot m % slots.
struct Window {
  std::vector<std::int32_t> end;  ///< Per user: makers before that must have made theirs, and no others before it.
  int slots = 1;                  ///< In the worst order as many as there are makers.
};

/// `first` and `last`: per user the least and the greatest maker that it needs; of one that needs none, first > last.
inline Window MakeWindow(int makers, std::span<const std::int32_t> first, std::span<const std::int32_t> last) {
  Window window;
  window.end.resize(first.size());
  std::int32_t end = 0;
  for (std::size_t user = 0; user < first.size(); ++user) window.end[user] = end = std::max(end, last[user] + 1);
  std::int32_t begin = makers;  // of what this user and those behind it need
  for (std::size_t user = first.size(); user-- > 0;) {
    begin = std::min(begin, first[user]);
    window.slots = std::max(window.slots, static_cast<int>(window.end[user] - begin));
  }
  return window;
}

}  // namespace percale::fabric
