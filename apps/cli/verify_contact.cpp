#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_laws.h"
#include "apps/cli/verify_specimen.h"
#include "collide/poses.h"
#include "core/text.h"
#include "percale/intersections.h"

namespace percale::cli {
namespace {

/// Cotton that keeps no energy to itself.
ClothSettings Cotton(double width, double height, int columns, int rows) {
  return PlainSheet(width, height, columns, rows, 0.15, 261, 0.243, 4e-5);
}

Vec3 Still(int) {
  return {};
}

/// Σ m v of one cloth [kg m/s].
Vec3 Momentum(const World& world, int cloth) {
  const std::vector<double> mass = Masses(world.Cloth(cloth), world.scene().cloths[std::size_t(cloth)]);
  Vec3 sum;
  for (std::size_t v = 0; v < mass.size(); ++v) sum += world.Cloth(cloth).velocities()[v] * mass[v];
  return sum;
}

std::vector<Vec3> AllPositions(const World& world) {
  std::vector<Vec3> all;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const std::span<const Vec3> x = world.Cloth(c).positions();
    all.insert(all.end(), x.begin(), x.end());
  }
  return all;
}

/// How many vertices are inside of colliders.
std::int64_t CountInside(const World& world) {
  std::vector<PlacedSolid> solids;
  ListSolids(world.scene(), world.report().time, solids);
  std::int64_t count = 0;
  for (const Vec3& x : AllPositions(world)) {
    for (const PlacedSolid& solid : solids) count += DistanceTo(solid, x).distance < 0 ? 1 : 0;
  }
  return count;
}

/// Sheets of cotton, one on another, on a slope of tan α = 0.5 that falls along x.
class Block {
 public:
  Block(double friction, const Effort& effort)
      : rate_(Elements(60 * effort.step)), world_(MakeScene(friction, effort), {.threads = 1}) {
    const double distance = world_.scene().cloths[0].contactDistance;
    for (int c = 0; c < kLayers; ++c) {
      const std::span<const Vec3> rest = world_.Cloth(c).rest();
      const auto place = [&](int v) {
        const Vec3& x = rest[std::size_t(v)];
        return Down() * x.x + Normal() * (0.97 * distance * (c + 1)) + Vec3{0, 0, x.z};
      };
      Put(world_, place, Still, c);
    }
  }

  void Step() { world_.Step(); }
  int Steps(double seconds) const { return static_cast<int>(std::lround(seconds * rate_)); }
  const World& world() const { return world_; }
  double Velocity() const {
    Vec3 sum;
    for (int c = 0; c < kLayers; ++c) sum += Momentum(world_, c);
    const ClothSettings& cloth = world_.scene().cloths[0];
    return Dot(sum, Down()) / (kLayers * cloth.density * cloth.width * cloth.height);
  }

  static constexpr double kSlope = 0.5;  // tan α

 private:
  static constexpr int kLayers = 3;
  static Vec3 Down() { return Vec3{1, -kSlope, 0} / std::sqrt(1 + kSlope * kSlope); }
  static Vec3 Normal() { return Vec3{kSlope, 1, 0} / std::sqrt(1 + kSlope * kSlope); }

  Scene MakeScene(double friction, const Effort& effort) const {
    constexpr double kSide = 0.1;
    const int elements = Elements(6 * effort.mesh, 2);
    Scene scene = EmptyScene(rate_);
    scene.simulation.selfCollision = true;
    scene.simulation.gravity = {0, -kGravity, 0};
    ClothSettings layer = Cotton(kSide, kSide, elements, elements);
    layer.contactDistance = 0.3 * kSide / elements;
    layer.friction = 0.8;
    scene.cloths.assign(kLayers, layer);
    scene.planes.push_back({.point = {}, .normal = Normal(), .friction = friction});
    return scene;
  }

  int rate_;
  World world_;
};

}  // namespace

CaseResult VerifyIncline(const Effort& effort) {
  constexpr double kSettle = 0.5, kStick = 10, kSlide = 0.5;  // s
  const double sine = Block::kSlope / std::hypot(1, Block::kSlope), cosine = sine / Block::kSlope;
  CaseResult result;
  {
    Block block(0.51, effort);
    for (int k = 0; k < block.Steps(kSettle); ++k) block.Step();
    const std::vector<Vec3> before = AllPositions(block.world());
    double way = 0;
    for (int k = 0; k < block.Steps(kStick); ++k) {
      block.Step();
      const std::vector<Vec3> now = AllPositions(block.world());
      for (std::size_t v = 0; v < now.size(); ++v) way = std::max(way, Length(now[v] - before[v]));
    }
    result.readings.push_back(Absolute("μ = 0.51: farthest way of a vertex in 10 s [m]", way, 0, 1e-4));
  }
  Plot plot;
  plot.title = "Velocity on the slope: measured (lines) and closed form (marks)";
  plot.x.label = "time [s]", plot.y.label = "velocity [m/s]";
  for (const double friction : {0.49, 0.3, 0.1}) {
    const double law = kGravity * (sine - friction * cosine);
    Block block(friction, effort);
    for (int k = 0; k < block.Steps(kSettle); ++k) block.Step();
    const double before = block.Velocity();
    Series line{"μ = " + FormatNumber(friction), {{0, before}}, false}, marks{"law", {}, true};
    for (int k = 1; k <= block.Steps(kSlide); ++k) {
      block.Step();
      line.points.push_back({kSlide * k / block.Steps(kSlide), block.Velocity()});
    }
    for (const double t : {0.0, 0.5 * kSlide, kSlide}) marks.points.push_back({t, before + law * t});
    result.readings.push_back(Relative("acceleration at μ = " + FormatNumber(friction) + " [m/s²]",
                                       (block.Velocity() - before) / kSlide, law, 0.01));
    plot.series.push_back(std::move(line));
    plot.series.push_back(std::move(marks));
  }
  result.plots.push_back(std::move(plot));
  return result;
}

CaseResult VerifyCapstan(const Effort& effort) {
  // A belt over a drum that turns under it, held at one end and pulled down at the other, so that it slips everywhere.
  constexpr double kRadius = 0.05, kHang = 0.06, kWidth = 0.02, kStiffness = 100, kPull = 2;  // m, N/m
  constexpr double kSpeed = 90;                                                               // °/s
  const int rate = Elements(100 * effort.step), around = Elements(32 * effort.mesh, 4);
  const double arc = std::numbers::pi * kRadius, spacing = arc / around;
  const int hanging = Elements(kHang / spacing, 2), columns = around + 2 * hanging;
  CaseResult result;
  Plot plot;
  plot.title = "Tension along the belt: measured (lines) and closed form (marks)";
  plot.x.label = "angle around the drum [°]", plot.y = {"tension over that of the free end", true, {}, {}};
  for (const double friction : {0.1, 0.2, 0.3, 0.5}) {
    Scene scene = EmptyScene(rate);
    ClothSettings belt = PlainSheet(spacing * columns, kWidth, columns, 2, 0.15, kStiffness, 0, 0);
    belt.contactDistance = 0.1 * spacing;
    PinColumn(belt, 0);
    scene.cloths.push_back(belt);
    ColliderSettings drum;
    drum.shape = ColliderShape::Cylinder;
    drum.rotation = {90, 0, 0};
    drum.radius = kRadius - 0.5 * belt.contactDistance;
    drum.length = 3 * kWidth;
    drum.friction = friction;
    scene.colliders.push_back(drum);
    constexpr double kLong = 100;  // s
    scene.colliderMotions.push_back(
        {.end = kLong, .displacement = {}, .axis = {0, 0, -1}, .angle = kLong * kSpeed, .steady = true});
    World world(scene, {.threads = 1});
    const std::span<const Vec3> rest = world.Cloth(0).rest();
    const auto place = [&](int v) {
      const Vec3& x = rest[std::size_t(v)];
      const double s = x.x - hanging * spacing;
      if (s < 0) return Vec3{-kRadius, s, x.z};
      if (s > arc) return Vec3{kRadius, arc - s, x.z};
      return Vec3{-kRadius * std::cos(s / kRadius), kRadius * std::sin(s / kRadius), x.z};
    };
    Put(world, place, Still);
    world.SetForces([&](const ForceCall& call) {
      for (int j = 0; j < belt.numHeightPoints; ++j) {
        const double share = j == 1 ? 0.5 : 0.25;
        call.forces[std::size_t((j + 1) * belt.numWidthPoints - 1)] = {0, -kPull * kWidth * share, 0};
      }
    });
    bool still = false;
    for (int k = 0; k < 4 * rate && !still; ++k) {
      if (world.Step().divergence) break;
      still = k > rate / 2 && world.report().greatestMove < 1e-8;
    }
    // Of the element after a column, by its stretch [N/m].
    const std::span<const Vec3> x = world.Cloth(0).positions();
    const auto tension = [&](int column) {
      const auto v = static_cast<std::size_t>(MiddleOf(belt, column));
      const double stretch = Length(x[v + 1] - x[v]) / spacing;
      return kStiffness * stretch * (stretch * stretch - 1) / 2;
    };
    result.readings.push_back(Relative("force held over force hung, μ = " + FormatNumber(friction),
                                       still ? tension(0) / tension(columns - 1) : NAN,
                                       std::exp(friction * std::numbers::pi), 0.03));
    Series line{"μ = " + FormatNumber(friction), {}, false};
    for (int i = columns - 1; i >= 0; --i) {
      const auto v = static_cast<std::size_t>(MiddleOf(belt, i));
      const Vec3 middle = (x[v] + x[v + 1]) / 2;
      const double angle = std::atan2(std::max(middle.y, 0.0), middle.x) * 180 / std::numbers::pi;
      line.points.push_back({angle, tension(i) / tension(columns - 1)});
    }
    plot.series.push_back(std::move(line));
  }
  for (const double friction : {0.1, 0.5}) {
    Series marks{"law", {}, true};
    for (double angle = 0; angle < 181; angle += 45)
      marks.points.push_back({angle, std::exp(friction * angle * std::numbers::pi / 180)});
    plot.series.push_back(std::move(marks));
  }
  result.plots.push_back(std::move(plot));
  result.note = "The drum turns at 90° a second under the belt, which has no weight and hardly bends.";
  return result;
}

CaseResult VerifyStickSlip(const Effort& effort) {
  constexpr double kLength = 1, kWidth = 0.1, kStart = 0.01, kBeyond = 0.05;  // m; of the length
  constexpr double kSpeed = 0.01, kSlip = 0.002;                              // m/s, of the length
  const int along = Elements(60 * effort.mesh, 10), rate = Elements(30 * effort.step);
  CaseResult result;
  Plot plot;
  plot.title = "When the strip lets go: closed form (line) and measured (marks)";
  plot.x.label = "ε, rise of the table over L", plot.y.label = "μ";
  Series line{"closed form", {}, false}, marks{"measured", {}, true};
  const PressedStrip first = SolvePressedStrip(kStart);
  for (const double shortening : {0.05, 0.1, 0.2, 0.3, 0.4}) {
    const double friction = SolvePressedStrip(shortening).friction;
    Scene scene = EmptyScene(rate);
    ClothSettings strip = Strip({.length = kLength, .width = kWidth, .along = along, .slenderness = 1e5});
    const double spacing = strip.width / along;
    strip.contactDistance = 0.1 * spacing;
    strip.bendDamping = 0.1;
    scene.cloths.push_back(strip);
    // A round bar for a table: pressed far, the strip sags beside its end, and would lie on a bar, where the closed
    // form has it stand on its end. But the side of a cone meets vertices alone, and of these only the last are near.
    // So the bar is a cone, too slim to show. It is rough until half of the way.
    constexpr double kRough = 2;
    constexpr double kRadius = 0.02 * kLength;
    ColliderSettings bar;
    bar.shape = ColliderShape::Cone;
    bar.rotation = {90, 0, 0};
    bar.radius = 2 * kRadius;  // of the base; half as much where the strip is
    bar.length = 5000 * kRadius;
    bar.position = {0, -(1 - kStart) * kLength - 0.8 * strip.contactDistance - kRadius, 0};
    bar.friction = kRough;
    scene.colliders.push_back(bar);
    const double way = (shortening + kBeyond - kStart) * kLength, seconds = way / kSpeed;
    scene.colliderMotions.push_back({.end = seconds, .displacement = {0, way, 0}, .steady = true});
    World world(scene, {.threads = 1});
    const std::span<const Vec3> rest = world.Cloth(0).rest();
    const auto place = [&](int v) {
      const Vec3& x = rest[std::size_t(v)];
      const double z = x.z - 0.5 * kWidth;
      if (x.x <= 0) return Vec3{0, -x.x, z};
      const double at = (1 - x.x / kLength) * double(first.shape.size() - 1);
      const std::size_t k = std::min(static_cast<std::size_t>(at), first.shape.size() - 2);
      const PlotPoint &p = first.shape[k], &q = first.shape[k + 1];
      const double t = at - double(k), up = p.y + (q.y - p.y) * t - (1 - kStart);
      return Vec3{kLength * (p.x + (q.x - p.x) * t), kLength * up, z};
    };
    Put(world, place, Still);
    const auto tip = [&] { return world.Cloth(0).positions()[std::size_t(MiddleOf(strip, along))]; };
    double stood = 0, slipped = NAN;
    for (int k = 0; k < seconds * rate && !(slipped > 0); ++k) {
      if (world.Step().divergence) break;
      const double risen = 1 + tip().y / kLength;
      if (scene.colliders[0].friction == kRough) {
        stood = tip().x;
        if (risen < 0.5 * shortening) continue;
        scene.colliders[0].friction = friction;
        world.Apply(scene);
      } else if (std::abs(tip().x - stood) > kSlip * kLength) {
        slipped = risen;
      }
    }
    // What lets go at ε, by what let go nearby: both closed forms rise alike there.
    const double measured = slipped > 0 ? friction * friction / SolvePressedStrip(slipped).friction : NAN;
    result.readings.push_back(Relative("critical μ at ε = " + FormatNumber(shortening), measured, friction, 0.1));
    if (slipped > 0) marks.points.push_back({slipped, friction});
  }
  for (double at = 0.01; at < 0.455; at += 0.01) line.points.push_back({at, SolvePressedStrip(at).friction});
  plot.series = {std::move(line), std::move(marks)};
  result.plots.push_back(std::move(plot));
  return result;
}

CaseResult VerifyPinch(const Effort& effort) {
  constexpr double kWidth = 0.15, kHeight = 0.2, kLift = 0.1;                               // m
  constexpr double kPlateWidth = 0.08, kPlateHeight = 0.04, kPlateDepth = 0.02, kY = 0.06;  // m
  constexpr double kRise = 1, kHold = 60;                                                   // s
  const int rate = Elements(60 * effort.step), columns = Elements(12 * effort.mesh, 2);
  const double spacing = kWidth / columns, distance = 0.3 * spacing;
  Scene scene = EmptyScene(rate);
  scene.simulation.selfCollision = true;
  scene.simulation.gravity = {0, -kGravity, 0};
  scene.cloths.push_back(Cotton(kWidth, kHeight, columns, Elements(kHeight / spacing, 2)));
  scene.cloths[0].contactDistance = distance;
  for (const int side : {0, 1}) {
    ColliderSettings plate;
    plate.shape = ColliderShape::Box;
    plate.size = {kPlateWidth, kPlateHeight, kPlateDepth};
    plate.position = {0, kY, (side == 0 ? -1 : 1) * (kPlateDepth / 2 + 0.6 * distance)};
    plate.friction = 0.5;
    scene.colliders.push_back(plate);
    scene.colliderMotions.push_back(
        {.collider = side, .start = kRise, .end = 2 * kRise, .displacement = {0, kLift, 0}});
  }
  World world(scene, {.threads = 1});
  const std::span<const Vec3> rest = world.Cloth(0).rest();
  // The plates hold it near its upper edge.
  Put(
      world,
      [&](int v) {
        return Vec3{rest[std::size_t(v)].x - 0.5 * kWidth, rest[std::size_t(v)].z + kY + kPlateHeight / 2 - kHeight, 0};
      },
      Still);
  std::vector<std::size_t> held;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const Vec3& x = world.Cloth(0).positions()[v];
    if (std::abs(x.x) < 0.5 * kPlateWidth && std::abs(x.y - kY) < 0.5 * kPlateHeight) held.push_back(v);
  }
  ClothJudge judge(world, 1);
  std::vector<Vec3> before;
  double slip = 0;
  std::int64_t crossings = 0, inside = 0;
  for (int k = 0; k < (2 * kRise + kHold) * rate; ++k) {
    if (world.Step().divergence) slip = NAN;
    if (k < kRise * rate) {
      before = AllPositions(world);
      continue;
    }
    if (k % rate == 0) crossings += judge.Count(world).count, inside += CountInside(world);
    if (k < 2 * kRise * rate) continue;
    for (const std::size_t v : held)
      slip = std::max(slip, Length(world.Cloth(0).positions()[v] - before[v] - Vec3{0, kLift, 0}));
  }
  CaseResult result;
  result.readings.push_back(Absolute("slip in 60 s [m]", held.empty() ? NAN : slip, 0, 1e-4));
  result.readings.push_back(Absolute("crossings of cloth with cloth", double(crossings), 0, 0));
  result.readings.push_back(Absolute("vertices inside of a plate", double(inside), 0, 0));
  return result;
}

CaseResult VerifyImpact(const Effort& effort) {
  constexpr double kSide = 0.2, kTilt = 0.1, kTime = 0.4;  // m, rad, s
  const int elements = Elements(10 * effort.mesh, 2), rate = Elements(100 * effort.step);
  CaseResult result;
  for (const double speed : {1.0, 2.0}) {
    Scene scene = EmptyScene(rate);
    scene.simulation.selfCollision = true;
    scene.cloths.assign(2, Cotton(kSide, kSide, elements, elements));
    World world(scene, {.threads = 1});
    const Vec3 velocity = Vec3{0.4, -1, 0.2} * speed;
    const std::span<const Vec3> rest = world.Cloth(1).rest();
    const auto place = [&](int v) {
      const Vec3& x = rest[std::size_t(v)];
      return Vec3{x.x * std::cos(kTilt) + 0.3 * kSide, x.x * std::sin(kTilt) + 0.25 * kSide, x.z + 0.2 * kSide};
    };
    Put(
        world, place, [&](int) { return velocity; }, 1);
    ClothJudge judge(world, 1);
    const Vec3 before = Momentum(world, 1), along = velocity / Length(velocity);
    double drift = 0;
    std::int64_t touching = 0, crossings = 0;
    Series sum{"both", {}, false}, resting{"the sheet at rest", {}, false}, flying{"the sheet that flies", {}, false};
    for (int k = 0; k < kTime * rate; ++k) {
      touching += world.Step().selfContacts;
      crossings += judge.Count(world).count;
      const Vec3 first = Momentum(world, 0), second = Momentum(world, 1);
      drift = std::max(drift, Length(first + second - before) / Length(before));
      const double time = world.report().time;
      resting.points.push_back({time, Dot(first, along)});
      flying.points.push_back({time, Dot(second, along)});
      sum.points.push_back({time, Dot(first + second, along)});
    }
    const std::string at = " at " + FormatNumber(speed) + " m/s";
    result.readings.push_back(Absolute("drift of Σ m v" + at + ", over all", touching > 0 ? drift : NAN, 0, 1e-6));
    result.readings.push_back(Absolute("crossings of cloth with cloth" + at, double(crossings), 0, 0));
    Plot plot;
    plot.title = "Σ m v along the flight" + at;
    plot.x.label = "time [s]", plot.y.label = "[kg m/s]";
    plot.series = {std::move(sum), std::move(resting), std::move(flying)};
    result.plots.push_back(std::move(plot));
  }
  return result;
}

}  // namespace percale::cli
