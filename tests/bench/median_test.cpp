#include "bench/median.h"

#include <doctest/doctest.h>

#include <vector>

using percale::bench::Median;

TEST_CASE("as many values lie below the median as above it, in whatever order they come") {
  CHECK(Median({4}) == 4);
  for (const auto& values : {std::vector<double>{1, 2, 7}, {2, 7, 1}, {7, 2, 1}}) CHECK(Median(values) == 2);
  for (const auto& values : {std::vector<double>{1, 2, 4, 9}, {9, 4, 2, 1}, {2, 9, 1, 4}}) CHECK(Median(values) == 3);
}

TEST_CASE("a value that is far off does not move the median") {
  CHECK(Median({1, 2, 3, 1e9, 4}) == 3);
  CHECK(Median({5, 5}) == 5);
}
