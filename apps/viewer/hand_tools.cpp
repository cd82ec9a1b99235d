#include "apps/viewer/hand_tools.h"

#include <algorithm>
#include <cmath>

#include "mesh/cloth_model.h"

namespace percale::viewer {
namespace {

// A grip holds so much of the cloth's extent around it, but at least so many spacings of its grid.
constexpr double kGripShare = 0.06, kGripSpacings = 2.5;
// So far ahead of its vertex a grip draws, over its radius: of a cloth of 1 m^2 and 0.15 kg with some 20 N, and at
// 60 frames a second as fast as 4 m/s.
constexpr double kGripLead = 1.5;
// So far stretched, a spring at a pin is taut.
constexpr double kTaut = 1.5;
// A ball, for a cloth of 1 m: its radius [m], its share of the cloths' mass, its speed [m/s]; and how many
// radii before the eye it starts, so that it does not fill the picture.
constexpr double kBallSize = 0.07, kBallMass = 0.1, kBallSpeed = 5, kBallStart = 6;
// A gust: its speed [m/s], how it pushes a cloth that faces it [m/s^2], how long it blows [s]; the least drag that
// is felt [kg/(m^2 s)].
constexpr double kGustSpeed = 8, kGustPush = 30, kGustDuration = 0.8, kLeastDrag = 0.01;

}  // namespace

Handle GripOf(const Scene& scene, int index, int vertex, const Vec3& at) {
  const ClothSize size = SizeOf(scene.cloths[static_cast<std::size_t>(index)]);
  Handle handle{.cloth = index, .vertex = vertex, .target = at};
  handle.radius = std::max(kGripShare * size.extent, kGripSpacings * size.spacing);
  return handle;
}

Vec3 Towards(const Vec3& from, const Vec3& to, double most) {
  const Vec3 way = to - from;
  const double length = Length(way);
  return length > most ? from + way * (most / length) : to;
}

Vec3 LeadOf(const Handle& grip, const Vec3& at, const Vec3& hand) {
  return Towards(at, hand, kGripLead * grip.radius);
}

Vec3 CarriedWay(int pin, const Vec3& way, std::span<const Vec3> positions, std::span<const Edge> springs,
                std::span<const double> restLengths) {
  Vec3 pull;  // of the taut springs
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto [a, b] = springs[s];
    if (a != pin && b != pin) continue;
    const Vec3 to = positions[static_cast<std::size_t>(a == pin ? b : a)] - positions[static_cast<std::size_t>(pin)];
    const double length = Length(to), excess = length - kTaut * restLengths[s];
    if (excess > 0) pull += to * (excess / length);
  }
  const Vec3 back = UnitOr(pull, {});
  return way - back * std::min(Dot(way, back), 0.0);
}

Ball BallFrom(const Scene& scene, const Vec3& point, const Vec3& direction) {
  double extent = 0, mass = 0;
  for (const ClothSettings& cloth : scene.cloths) {
    const ClothSize size = SizeOf(cloth);
    extent = std::max(extent, size.extent);
    mass += size.area * cloth.density;
  }
  const Vec3 ahead = UnitOr(direction, {0, 0, -1});
  Ball ball;
  ball.radius = kBallSize * extent;
  ball.position = point + ahead * (kBallStart * ball.radius);
  ball.mass = mass > 0 ? kBallMass * mass : 1;
  ball.velocity = ahead * (kBallSpeed * std::sqrt(extent));
  return ball;
}

Gust GustTowards(const Scene& scene, const Vec3& direction) {
  double density = 0;
  for (const ClothSettings& cloth : scene.cloths) density = std::max(density, cloth.density);
  Gust gust;
  gust.velocity = UnitOr(direction, {0, 0, -1}) * kGustSpeed;
  gust.drag = std::max({scene.wind.drag, kGustPush * density / kGustSpeed, kLeastDrag});
  gust.duration = kGustDuration;
  return gust;
}

}  // namespace percale::viewer
