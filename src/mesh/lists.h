#pragma once
/// \file
/// Lists of what belongs to each of many, in two arrays.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace percale {

/// For each of `count` items the list of what belongs to it: entries of item i are [first[i], first[i + 1]).
struct Lists {
  std::vector<std::int32_t> first, entry;
};

/// Lists of 0 .. entries-1 by what each belongs to, owner(entry), ascending.
template <class Owner>
Lists ListBy(int count, std::size_t entries, Owner&& owner) {
  Lists lists;
  lists.first.assign(static_cast<std::size_t>(count) + 1, 0);
  for (std::size_t e = 0; e < entries; ++e) ++lists.first[static_cast<std::size_t>(owner(e)) + 1];
  for (std::size_t i = 1; i < lists.first.size(); ++i) lists.first[i] += lists.first[i - 1];
  lists.entry.resize(entries);
  std::vector<std::int32_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t e = 0; e < entries; ++e) {
    lists.entry[static_cast<std::size_t>(next[static_cast<std::size_t>(owner(e))]++)] = static_cast<std::int32_t>(e);
  }
  return lists;
}

}  // namespace percale
