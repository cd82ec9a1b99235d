#include "world/divergence.h"

#include <cmath>
#include <string>

#include "percale/parameters.h"
#include "world/limits.h"

namespace percale {
namespace {

/// Two significant digits, rounded down: a limit to stay below.
std::string RoundedDown(double value) {
  if (!(value > 0) || !std::isfinite(value)) return FormatValue(value);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return FormatValue(std::floor(value / unit) * unit);
}

}  // namespace

Divergence ExplainDivergence(const Scene& scene, std::int64_t step, int cloth, int vertex) {
  Divergence d{step, cloth, vertex, "", ""};
  const ClothSettings& settings = scene.cloths[static_cast<std::size_t>(cloth)];
  const std::string prefix = scene.cloths.size() > 1 ? "cloth." + std::to_string(cloth) + "." : "cloth.";
  const double largestKs = LargestStableKs(settings, scene.TimeStep());
  const double largestThickness = LargestSensibleThickness(settings);
  if (settings.ks >= largestKs) {
    d.cause = "the springs are too stiff for the step: " + prefix + "ks is " + FormatValue(settings.ks) +
              " N/m, stable below " + RoundedDown(largestKs) + " N/m at this density and " +
              std::to_string(scene.simulation.stepsPerFrame) + " steps per frame";
    d.remedy = "set " + prefix + "ks=" + RoundedDown(largestKs) + ", or simulation.steps_per_frame=" +
               std::to_string(SmallestStableStepsPerFrame(settings, scene.simulation.framesPerSecond));
  } else if (scene.simulation.selfCollision && settings.thickness > largestThickness) {
    d.cause = "the cloth is thicker than its grid allows: " + prefix + "thickness is " +
              FormatValue(settings.thickness) + " m, so that points at rest push each other apart";
    d.remedy = "set " + prefix + "thickness=" + RoundedDown(largestThickness) + " or less, or take fewer points";
  } else {
    d.cause = "a point left the bounds of the simulation (1000 km from the origin)";
    d.remedy = "let the cloth land on something, lower simulation.gravity or wind.velocity, or raise " +
               std::string("simulation.steps_per_frame");
  }
  return d;
}

}  // namespace percale
