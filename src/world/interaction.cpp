#include "world/interaction.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "collide/poses.h"
#include "core/text.h"

namespace percale {
namespace {

constexpr double kRestitution = 0.5;   // share of the speed along the normal that a bounce gives back
constexpr double kFarthestBall = 100;  // m; a ball this far away is nobody's concern

/// Puts a ball that has sunk in by `depth` [m] back along the unit normal, and turns its velocity.
void Bounce(Ball& ball, const Vec3& normal, double depth, double friction) {
  ball.position += normal * depth;
  const double approach = -Dot(ball.velocity, normal);
  if (approach <= 0) return;
  const double impulse = (1 + kRestitution) * approach;  // per mass [m/s]
  const Vec3 sliding = ball.velocity + normal * approach;
  const double speed = Length(sliding);
  const double kept = speed > 0 ? std::max(0.0, 1 - friction * impulse / speed) : 0;
  ball.velocity = sliding * kept + normal * (impulse - approach);
}

/// Off a collider that is no mesh, as it moves in the step.
void BounceOff(const Scene& scene, int collider, double time, double dt, Ball& ball) {
  const ColliderSettings& settings = scene.colliders[static_cast<std::size_t>(collider)];
  const Pose pose = PoseOf(scene, collider, time), before = PoseOf(scene, collider, time - dt);
  const Vec3 local = ToLocal(pose, ball.position);
  const SolidSample sample = DistanceTo(MakeSolid(settings), local);
  const double depth = ball.radius - sample.distance;
  if (!(depth > 0)) return;
  const Vec3 foot = local - sample.normal * sample.distance;
  const Vec3 velocity = (ToWorld(pose, foot) - ToWorld(before, foot)) / dt;
  ball.velocity -= velocity;
  Bounce(ball, Times(pose.rotation, sample.normal), depth, settings.friction);
  ball.velocity += velocity;
}

std::optional<std::string> Positive(std::string_view name, double value, std::string_view unit) {
  if (std::isfinite(value) && value > 0) return std::nullopt;
  return std::string(name) + ": expected a number > 0 " + std::string(unit) + ", got " + FormatNumber(value);
}

std::optional<std::string> Finite(std::string_view name, const Vec3& v) {
  constexpr double kLargest = 1e6;
  if (IsFinite(v) && std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= kLargest) return std::nullopt;
  return std::string(name) + ": expected three numbers -1e6..1e6";
}

}  // namespace

void MoveBalls(const Scene& scene, double time, double dt, std::vector<Ball>& balls) {
  for (Ball& ball : balls) {
    const Vec3 before = ball.position;
    ball.velocity += scene.simulation.gravity * dt;
    ball.position += ball.velocity * dt;
    for (const SphereSettings& sphere : scene.spheres) {
      const Vec3 d = ball.position - sphere.origin;
      const double depth = ball.radius + sphere.radius - Length(d);
      if (depth > 0) Bounce(ball, UnitOr(d, {0, 1, 0}), depth, sphere.friction);
    }
    for (const PlaneSettings& plane : scene.planes) {
      Vec3 normal = UnitOr(plane.normal, {0, 1, 0});
      if (Dot(before - plane.point, normal) < 0) normal = -normal;
      const double depth = ball.radius - Dot(ball.position - plane.point, normal);
      if (depth > 0) Bounce(ball, normal, depth, plane.friction);
    }
    if (scene.simulation.engine != Engine::Fabric) continue;
    for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
      if (scene.colliders[c].shape != ColliderShape::Mesh) BounceOff(scene, static_cast<int>(c), time, dt, ball);
    }
  }
  balls.erase(std::remove_if(balls.begin(), balls.end(),
                             [](const Ball& ball) { return !(Length(ball.position) <= kFarthestBall); }),
              balls.end());
}

std::optional<std::string> Check(const Handle& handle) {
  if (auto problem = Finite("target", handle.target)) return problem;
  if (auto problem = Positive("radius", handle.radius, "m")) return problem;
  return Positive("frequency", handle.frequency, "Hz");
}

std::optional<std::string> Check(const Ball& ball) {
  if (auto problem = Finite("position", ball.position)) return problem;
  if (auto problem = Finite("velocity", ball.velocity)) return problem;
  if (auto problem = Positive("radius", ball.radius, "m")) return problem;
  return Positive("mass", ball.mass, "kg");
}

std::optional<std::string> Check(const Gust& gust) {
  if (auto problem = Finite("velocity", gust.velocity)) return problem;
  if (!std::isfinite(gust.start)) return "start: expected a number of seconds";
  if (auto problem = Positive("drag", gust.drag, "kg/(m^2 s)")) return problem;
  return Positive("duration", gust.duration, "s");
}

}  // namespace percale
