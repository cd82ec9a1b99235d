#include "render/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace percale {

double RoundUp(double number) {
  const double power = std::pow(10, std::floor(std::log10(number)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (number <= digit * power * (1 + 1e-9)) return digit * power;
  }
  return 10 * power;
}

std::vector<double> Ticks(double low, double high, int most) {
  std::vector<double> ticks;
  const double step = RoundUp((high - low) / most);
  const double slack = 1e-6 * step, first = std::ceil((low - slack) / step);
  for (int i = 0; i <= most; ++i) {
    const double tick = (first + i) * step + 0.0;  // no -0
    if (!(tick <= high + slack)) break;
    // Between neighbouring doubles there is nothing.
    if (ticks.empty() || tick > ticks.back()) ticks.push_back(tick);
  }
  return ticks;
}

std::string TickText(double number, double step) {
  char text[40];
  const double size = std::max(std::abs(number), step);
  if (size >= 1e6 || size < 1e-4) {
    std::snprintf(text, sizeof text, "%.3g", std::abs(number) < 1e-6 * step ? 0.0 : number);
    return text;
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::snprintf(text, sizeof text, "%.*f", decimals, number);
  return text;
}

}  // namespace percale
