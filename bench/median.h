#pragma once
/// \file
/// How the benchmarks sum up times: what else the machine does now and then moves the mean, but not the median.

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace percale::bench {

/// Of at least one value; of an even number of them the mean of the middle two.
inline double Median(std::vector<double> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

}  // namespace percale::bench
