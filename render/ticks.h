#pragma once
/// \file
/// Round numbers for axes and legends.

#include <string>
#include <vector>

namespace percale {

/// The smallest of 1, 2 and 5 times a power of ten that is at least `number` > 0.
double RoundUp(double number);

/// The multiples of a round step from `low` to `high`, low < high, ascending. The step is the smallest that
/// goes into the range at most `most` >= 2 times.
std::vector<double> Ticks(double low, double high, int most);

/// A number as short as its neighbours at a distance of `step` > 0 allow: "0.25", "1200", "3e-07".
std::string TickText(double number, double step);

}  // namespace percale
