#include "world/limits.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>

namespace percale {

double LargestStableKs(const ClothSettings& cloth, double timeStep) {
  const double mass = PointMass(cloth);
  if (!(mass > 0)) return std::numeric_limits<double>::infinity();
  return mass / (2 * timeStep * timeStep);
}

int SmallestStableStepsPerFrame(const ClothSettings& cloth, int framesPerSecond) {
  const double mass = PointMass(cloth);
  if (!(mass > 0) || !(cloth.ks > 0)) return 1;
  const double steps = std::floor(std::sqrt(2 * cloth.ks / mass) / framesPerSecond) + 1;
  return steps < INT_MAX ? std::max(1, static_cast<int>(steps)) : INT_MAX;
}

double LargestSensibleThickness(const ClothSettings& cloth) {
  return 0.5 * std::min(cloth.width / (cloth.numWidthPoints - 1), cloth.height / (cloth.numHeightPoints - 1));
}

}  // namespace percale
