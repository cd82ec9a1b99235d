#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_laws.h"
#include "apps/cli/verify_specimen.h"
#include "core/text.h"

namespace percale::cli {
namespace {

/// ρ g L³ / B = Γ, for g [m/s²].
double GravityOf(double gamma, const StripSettings& s) {
  return gamma * s.rigidity / (s.density * s.length * s.length * s.length);
}

/// A strip clamped level at one end, its weight growing from case to case.
class Cantilever {
 public:
  explicit Cantilever(int along)
      : settings_{.along = along}, scene_(MakeScene(settings_)), world_(scene_, {.threads = 1}) {}

  /// Lets it hang with that Γ. False: it did not come to rest.
  bool Load(double gamma) {
    scene_.simulation.gravity = {0, -GravityOf(gamma, settings_), 0};
    world_.Apply(scene_);
    return Settle(world_, 1e-6, 400);
  }
  /// From the clamp to the tip along the middle: x and drop over L.
  std::vector<PlotPoint> Shape() const {
    std::vector<PlotPoint> shape;
    for (int i = 1; i < scene_.cloths[0].numWidthPoints; ++i) shape.push_back(At(i));
    return shape;
  }
  PlotPoint Tip() const { return At(scene_.cloths[0].numWidthPoints - 1); }

 private:
  static Scene MakeScene(const StripSettings& settings) {
    Scene scene = EmptyScene();
    scene.cloths.push_back(Strip(settings));
    return scene;
  }
  PlotPoint At(int column) const {
    const Vec3& x = world_.Cloth(0).positions()[std::size_t(MiddleOf(scene_.cloths[0], column))];
    return {x.x / settings_.length, -x.y / settings_.length};
  }

  StripSettings settings_;
  Scene scene_;
  World world_;
};

constexpr double kGammas[] = {0.1, 1, 2, 4, 8, 10, 20, 50, 100, 1000};
constexpr double kHeavy = 50;              // from here on it bends near the clamp alone, along Γ^(-1/3) of its length
constexpr double kShown[] = {1, 10, 100};  // in the plot

}  // namespace

CaseResult VerifyCantilever(const Effort& effort) {
  CaseResult result;
  Cantilever light(Elements(40 * effort.mesh, 4)), heavy(Elements(120 * effort.mesh, 4));
  Plot plot;
  plot.title = "Cantilever: closed form (lines) and measured (marks)";
  plot.x.label = "x / L", plot.y.label = "height / L";
  for (const double gamma : kGammas) {
    Cantilever& strip = gamma < kHeavy ? light : heavy;
    const bool still = strip.Load(gamma);
    const HeavyElastica law = SolveHeavyElastica(gamma);
    const PlotPoint tip = strip.Tip();
    result.readings.push_back(
        Relative("H/W at Γ = " + FormatNumber(gamma), still ? tip.y / tip.x : NAN, law.drop / law.reach, 0.02));
    if (std::find(std::begin(kShown), std::end(kShown), gamma) == std::end(kShown)) continue;
    Series line{"Γ = " + FormatNumber(gamma), {}, false};
    for (const PlotPoint& point : law.shape) line.points.push_back({point.x, -point.y});
    plot.series.push_back(std::move(line));
    std::vector<PlotPoint> few;
    const std::vector<PlotPoint> shape = strip.Shape();
    const std::size_t every = std::max<std::size_t>(1, shape.size() / 16);
    for (std::size_t i = 0; i < shape.size(); i += every) few.push_back({shape[i].x, -shape[i].y});
    plot.series.push_back({"measured", few, true});
  }
  result.plots.push_back(std::move(plot));
  return result;
}

CaseResult VerifyChordAngle(const Effort& effort) {
  constexpr double kAngle = 41.5 * std::numbers::pi / 180;
  Cantilever strip(Elements(40 * effort.mesh, 4));
  const auto over = [&](double gamma) {
    const PlotPoint tip = strip.Load(gamma) ? strip.Tip() : PlotPoint{NAN, NAN};
    return std::atan2(tip.y, tip.x) - kAngle;
  };
  double a = 6, b = 10, fa = over(a), fb = over(b);
  for (int k = 0; k < 6 && std::abs(fb) > 1e-6; ++k) {  // the secant method
    const double next = b - fb * (b - a) / (fb - fa);
    a = b, fa = fb;
    b = next, fb = over(b);
  }
  CaseResult result;
  result.readings.push_back(
      Relative("Γ where the chord hangs at 41.5°", std::abs(fb) < 1e-4 ? b : NAN, GammaOfChord(kAngle), 0.03));
  return result;
}

CaseResult VerifyLateralBuckling(const Effort& effort) {
  CaseResult result;
  for (const double poisson : {0.0, 0.3}) {
    // The law is that of a narrow strip: the clamp hinders the twist over about half the width. High on edge as it
    // is, it must not bend in its plane: K W²/12 is 3300 B.
    const StripSettings strip{.width = 0.02,
                              .along = Elements(80 * effort.mesh, 8),
                              .across = Elements(4 * effort.mesh, 2),
                              .slenderness = 1e8,
                              .poisson = poisson};
    const double critical = CriticalLoad(1, [&](double gamma) {
      StaticSheet sheet(Strip(strip));
      return sheet.Solve({0, 0, GravityOf(gamma, strip)}) && sheet.IsStable();
    });
    result.readings.push_back(Relative("critical Γ at ν = " + FormatNumber(poisson), critical,
                                       kLateralBuckling * (1 - poisson) * std::sqrt(2 * (1 + poisson)), 0.05));
  }
  return result;
}

CaseResult VerifySelfBuckling(const Effort& effort) {
  const StripSettings strip{.along = Elements(40 * effort.mesh, 4)};
  const double critical = CriticalLoad(1, [&](double gamma) {
    StaticSheet sheet(Strip(strip));
    return sheet.Solve({-GravityOf(gamma, strip), 0, 0}) && sheet.IsStable();
  });
  CaseResult result;
  result.readings.push_back(Relative("critical ρ g L³/B", critical, kSelfBuckling, 0.05));
  return result;
}

CaseResult VerifyColumns(const Effort& effort) {
  struct Column {
    const char* ends;
    End left, right;
    double law;  // P L²/B
  };
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  const Column columns[] = {{"hinged and hinged", End::Hinged, End::Hinged, kPi2},
                            {"clamped and free", End::Clamped, End::Free, kPi2 / 4},
                            {"clamped and hinged", End::Clamped, End::Hinged, kClampedHingedColumn},
                            {"clamped and clamped", End::Clamped, End::Clamped, 4 * kPi2}};
  CaseResult result;
  for (const Column& column : columns) {
    const StripSettings strip{
        .along = Elements(40 * effort.mesh, 4), .left = column.left, .right = column.right, .slenderness = 1e5};
    const double critical = CriticalLoad(1, [&](double load) {
      // Pressed together evenly until it bears that load. Force per width of a St. Venant-Kirchhoff strip that is
      // λ times as long: K λ (1 - λ²)/2. A dead load at a free end has no second derivative.
      double stretch = 1 - load / strip.slenderness;
      for (int k = 0; k < 20; ++k) {
        stretch = 1 - 2 * load / strip.slenderness / (stretch * (1 + stretch));
      }
      StaticSheet sheet(Strip(strip));
      for (Vec3& x : sheet.positions()) x.x *= stretch;
      return sheet.IsStable();
    });
    result.readings.push_back(Relative(std::string("critical P L²/B, ") + column.ends, critical, column.law, 0.03));
  }
  return result;
}

CaseResult VerifyFrequency(const Effort& effort) {
  const StripSettings strip{.along = Elements(40 * effort.mesh, 4), .density = 0.01, .rigidity = 0.01};
  const double law = kCantileverMode / (2 * std::numbers::pi * strip.length * strip.length) *
                     std::sqrt(strip.rigidity / strip.density);
  Scene scene = EmptyScene();
  scene.cloths.push_back(Strip(strip));
  scene.simulation.gravity = {0, -GravityOf(0.1, strip), 0};
  World world(scene, {.threads = 1});
  bool still = Settle(world, 1e-7);
  // Let go; damped by the integrator alone, which slows a mode by the share (ωh)²/3.
  const int rate = Elements(200 * law * effort.step);
  scene.simulation.framesPerSecond = rate;
  scene.simulation.gravity = {};
  world.Apply(scene);
  Put(
      world, [&](int v) { return world.Cloth(0).positions()[std::size_t(v)]; }, [](int) { return Vec3{}; });
  const auto tip = static_cast<std::size_t>(MiddleOf(scene.cloths[0], strip.along));
  std::vector<double> crossings;
  double before = world.Cloth(0).positions()[tip].y;
  const int most = static_cast<int>(3 * rate / law);
  for (int k = 0; k < most && crossings.size() < 3; ++k) {
    still = still && !world.Step().divergence;
    const double now = world.Cloth(0).positions()[tip].y;
    if ((before < 0) != (now < 0)) crossings.push_back((k + before / (before - now)) / rate);
    before = now;
  }
  CaseResult result;
  result.readings.push_back(
      Relative("frequency [Hz]", still && crossings.size() == 3 ? 1 / (crossings[2] - crossings[0]) : NAN, law, 0.03));
  return result;
}

}  // namespace percale::cli
