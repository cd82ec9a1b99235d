#include "world/divergence.h"

#include <string>

#include "core/text.h"
#include "percale/interaction.h"
#include "world/limits.h"

namespace percale {

Divergence ExplainDivergence(const Scene& scene, std::int64_t step, int cloth, int vertex) {
  Divergence d{step, cloth, vertex, "", ""};
  const ClothSettings& settings = scene.cloths[static_cast<std::size_t>(cloth)];
  const std::string prefix = scene.cloths.size() > 1 ? "cloth." + std::to_string(cloth) + "." : "cloth.";
  if (scene.simulation.engine == Engine::Fabric) {
    d.cause =
        "a vertex left the bounds of the simulation (1000 km from the origin), or a triangle became 1000 times too "
        "long";
    d.remedy =
        "let the cloth be held by a pin, lower simulation.gravity, wind.velocity or cloth.pressure, or raise "
        "simulation.steps_per_frame";
    return d;
  }
  const double largestKs = LargestStableKs(settings, scene.TimeStep());
  const double largestThickness = LargestSensibleThickness(settings);
  if (settings.ks >= largestKs) {
    d.cause = "the springs are too stiff for the step: " + prefix + "ks is " + FormatNumber(settings.ks) +
              " N/m, stable below " + FormatNumber(RoundDown(largestKs, 2)) + " N/m at this density and " +
              std::to_string(scene.simulation.stepsPerFrame) + " steps per frame";
    d.remedy = "set " + prefix + "ks=" + FormatNumber(RoundDown(largestKs, 2)) + ", or simulation.steps_per_frame=" +
               std::to_string(SmallestStableStepsPerFrame(settings, scene.simulation.framesPerSecond));
  } else if (scene.simulation.selfCollision && settings.thickness > largestThickness) {
    d.cause = "the cloth is thicker than its grid allows: " + prefix + "thickness is " +
              FormatNumber(settings.thickness) + " m, so that points at rest push each other apart";
    d.remedy = "set " + prefix + "thickness=" + FormatNumber(RoundDown(largestThickness, 2)) +
               " or less, or take fewer points";
  } else {
    d.cause =
        "a point left the bounds of the simulation (1000 km from the origin), or its spring became 1000 times too long";
    d.remedy =
        "let the cloth land on something, lower simulation.gravity, wind.velocity or wind.drag, or raise "
        "simulation.steps_per_frame";
  }
  return d;
}

Divergence ExplainForce(std::int64_t step, int cloth, int vertex, const Vec3& force) {
  return {step, cloth, vertex,
          "the force function gave (" + FormatNumber(force.x) + ", " + FormatNumber(force.y) + ", " +
              FormatNumber(force.z) + ") N; expected finite numbers, together at most " + FormatNumber(kMostForce) +
              " N",
          "mend the function that was given to World::SetForces, then go on from Reset or Restore"};
}

}  // namespace percale
