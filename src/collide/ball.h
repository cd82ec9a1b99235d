#pragma once
/// \file
/// A ball that flies against cloth.

#include <cstdint>
#include <vector>

#include "percale/interaction.h"
#include "percale/vec3.h"

namespace percale {

/// Pushes points and ball apart, each by the other's share of their masses, and changes the ball's velocity by the way
/// it was pushed over the step `dt` [s]. Momentum is kept, apart from fixed points, which a ball does not feel.
/// `points` has count(), fixed(p), mass(p), at(p) and put(p, position). `touched` is scratch. Returns how many points
/// the ball touched.
template <class Points>
std::int64_t PushApart(Ball& ball, double dt, Points&& points, std::vector<std::int32_t>& touched) {
  touched.clear();
  double touchedMass = 0;
  Vec3 momentum;  // that the points would gain if they alone gave way [kg m]
  const auto push = [&](int p) {
    const Vec3 d = points.at(p) - ball.position;
    return UnitOr(d, {0, 1, 0}) * (ball.radius - Length(d));
  };
  for (int p = 0; p < points.count(); ++p) {
    const Vec3 d = points.at(p) - ball.position;
    if (Dot(d, d) >= ball.radius * ball.radius || points.fixed(p)) continue;
    touched.push_back(p);
    touchedMass += points.mass(p);
    momentum += push(p) * points.mass(p);
  }
  if (touched.empty()) return 0;
  const double share = ball.mass / (ball.mass + touchedMass);
  for (const std::int32_t p : touched) points.put(p, points.at(p) + push(p) * share);
  const Vec3 way = momentum * (-share / ball.mass);
  ball.position += way;
  ball.velocity += way / dt;
  return static_cast<std::int64_t>(touched.size());
}

}  // namespace percale
