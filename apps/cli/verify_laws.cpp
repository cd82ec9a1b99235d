#include "apps/cli/verify_laws.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace percale::cli {
namespace {

/// Where f, which is below 0 at `low` and above it at `high`, is 0.
template <class Function>
double Bisect(double low, double high, Function f) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    if (high - low < 1e-11 * std::abs(middle)) break;
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

constexpr int kSteps = 2000;  // of the fourth-order Runge-Kutta method

/// The strip from its tip back to the clamp: φ'' = Γ u sin φ, where φ is the angle from the vertical and u the way from
/// the tip, starting with φ = `tip` and no curvature. Returns φ at the clamp, at most a bit more than π/2; appends
/// (x, drop) as seen from the tip.
double Shoot(double gamma, double tip, std::vector<PlotPoint>* shape) {
  double state[4] = {tip, 0, 0, 0};  // φ, φ', x, drop
  const double du = 1.0 / kSteps;
  const auto slope = [&](double u, const double(&y)[4], double(&dy)[4]) {
    dy[0] = y[1], dy[1] = gamma * u * std::sin(y[0]), dy[2] = std::sin(y[0]), dy[3] = std::cos(y[0]);
  };
  for (int k = 0; k < kSteps; ++k) {
    if (shape) shape->push_back({state[2], state[3]});
    const double u = k * du;
    double k1[4], k2[4], k3[4], k4[4], y[4];
    slope(u, state, k1);
    for (int i = 0; i < 4; ++i) y[i] = state[i] + 0.5 * du * k1[i];
    slope(u + 0.5 * du, y, k2);
    for (int i = 0; i < 4; ++i) y[i] = state[i] + 0.5 * du * k2[i];
    slope(u + 0.5 * du, y, k3);
    for (int i = 0; i < 4; ++i) y[i] = state[i] + du * k3[i];
    slope(u + du, y, k4);
    for (int i = 0; i < 4; ++i) state[i] += du / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    if (state[0] > std::numbers::pi / 2 + 0.5) break;  // has turned too far: the tip starts nearer to the vertical
  }
  if (shape) shape->push_back({state[2], state[3]});
  return state[0];
}

/// A strip on a table by the angle ψ at its lower end from the force that acts there: ψ'' = -q² sin ψ from that end on,
/// which bears no moment. The clamp lies where the way from the end to it has the strip's own direction.
PressedStrip PressStrip(double tip) {
  struct Clamp {
    double angle = 0, along = 0, across = 0;  // as seen from the force
  };
  std::vector<PlotPoint> way;
  const auto shoot = [&](double q) {
    constexpr int kFew = 400;
    double psi = tip, turn = 0;
    Clamp clamp;
    way.assign(1, {});
    const double ds = 1.0 / kFew;
    for (int k = 0; k < kFew; ++k) {  // Störmer, Verlet: of second order, and the period of the pendulum hardly drifts
      const double half = turn - 0.5 * ds * q * q * std::sin(psi);
      const double middle = psi + 0.5 * ds * half;
      clamp.along += ds * std::cos(middle), clamp.across += ds * std::sin(middle);
      psi += ds * half;
      turn = half - 0.5 * ds * q * q * std::sin(psi);
      way.push_back({clamp.along, clamp.across});
    }
    clamp.angle = psi;
    return clamp;
  };
  const auto off = [](const Clamp& c) { return c.along * std::sin(c.angle) - c.across * std::cos(c.angle); };
  const double period = PendulumPeriod(tip);
  const double q = Bisect(std::numbers::pi * period, 1.5 * std::numbers::pi * period,
                          [&](double guess) { return off(shoot(guess)); });
  const Clamp clamp = shoot(q);
  const double c = std::cos(clamp.angle), s = std::sin(clamp.angle);
  PressedStrip strip;
  strip.shortening = 1 - (clamp.along * c + clamp.across * s);
  strip.friction = std::abs(s / c);
  for (const PlotPoint& p : way) strip.shape.push_back({p.y * c - p.x * s, p.x * c + p.y * s});
  return strip;
}

}  // namespace

HeavyElastica SolveHeavyElastica(double gamma) {
  assert(gamma > 0 && gamma <= 5000);
  // Near the vertical φ grows e-fold many times over: its logarithm is what is sought.
  const double level = std::numbers::pi / 2;
  const double tip =
      std::exp(Bisect(-110, std::log(level), [&](double log) { return Shoot(gamma, std::exp(log), nullptr) - level; }));
  HeavyElastica strip;
  std::vector<PlotPoint> fromTip;
  Shoot(gamma, tip, &fromTip);
  strip.reach = fromTip.back().x, strip.drop = fromTip.back().y;
  for (auto point = fromTip.rbegin(); point != fromTip.rend(); ++point) {
    strip.shape.push_back({strip.reach - point->x, strip.drop - point->y});
  }
  return strip;
}

double GammaOfChord(double angle) {
  return Bisect(1e-3, 2000, [&](double gamma) {
    const HeavyElastica strip = SolveHeavyElastica(gamma);
    return std::atan2(strip.drop, strip.reach) - angle;
  });
}

double CatenarySag(double length) {
  // y = c cosh(x/c) between ±1/2 has length 2 c sinh(1/(2c)); with q = 1/(2c) that is sinh(q)/q.
  const double q = Bisect(1e-9, 50, [&](double s) { return std::sinh(s) / s - length; });
  return (std::cosh(q) - 1) / (2 * q);
}

double PendulumPeriod(double angle) {
  double a = 1, b = std::cos(0.5 * angle);
  for (int k = 0; k < 20; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b), a = mean;
  }
  return 1 / a;
}

double StripCompliance(double warp, double weft, double poisson, double shear, double angle) {
  const double cc = std::cos(angle) * std::cos(angle), ss = std::sin(angle) * std::sin(angle);
  return cc * cc / warp + cc * ss * (1 / shear - 2 * poisson / warp) + ss * ss / weft;
}

PressedStrip SolvePressedStrip(double shortening) {
  assert(shortening > 0 && shortening <= 0.6);
  return PressStrip(Bisect(1e-3, 1.8, [&](double tip) { return PressStrip(tip).shortening - shortening; }));
}

}  // namespace percale::cli
