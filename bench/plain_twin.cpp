#include "bench/plain_twin.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "math/pose.h"

namespace percale::bench {
namespace {

constexpr double kStretchLimit = 1.1;  // Provot 1995, section 5
constexpr double kPlaneOffset = 1e-4;  // m
constexpr double kBendingShare = 0.2;  // of ks
constexpr Vec3 kNoDirection{0, 1, 0};  // for coincident points

// The generator of the vertical sheet's random z: splitmix64.
std::uint64_t NextRandom(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

struct Box {
  std::int64_t x, y, z;
};

Box BoxOf(const Vec3& p, const Scene& scene) {
  double w = 0, h = 0;
  for (const ClothSettings& cloth : scene.cloths) {
    w = std::max(w, 3 * cloth.width / cloth.numWidthPoints);
    h = std::max(h, 3 * cloth.height / cloth.numHeightPoints);
  }
  const double t = std::max(w, h);
  return {static_cast<std::int64_t>(std::floor(p.x / w)), static_cast<std::int64_t>(std::floor(p.y / h)),
          static_cast<std::int64_t>(std::floor(p.z / t))};
}

}  // namespace

PlainTwin::PlainTwin(const Scene& scene) : scene_(scene), dt_(scene.TimeStep()) {
  std::size_t count = 0;
  for (const ClothSettings& cloth : scene_.cloths) {
    firstPoint_.push_back(count);
    count += static_cast<std::size_t>(cloth.numWidthPoints) * static_cast<std::size_t>(cloth.numHeightPoints);
  }
  points_.reserve(count);  // springs keep pointers into it
  for (int cloth = 0; cloth < static_cast<int>(scene_.cloths.size()); ++cloth) BuildCloth(cloth);
}

PlainTwin::PointMass& PlainTwin::At(int cloth, int i, int j) {
  const auto& settings = scene_.cloths[static_cast<std::size_t>(cloth)];
  return points_[firstPoint_[static_cast<std::size_t>(cloth)] +
                 static_cast<std::size_t>(j) * static_cast<std::size_t>(settings.numWidthPoints) +
                 static_cast<std::size_t>(i)];
}

void PlainTwin::BuildCloth(int cloth) {
  const ClothSettings& c = scene_.cloths[static_cast<std::size_t>(cloth)];
  const double spacingX = c.width / (c.numWidthPoints - 1);
  const double spacingY = c.height / (c.numHeightPoints - 1);
  std::uint64_t state = static_cast<std::uint64_t>(c.seed);
  for (int j = 0; j < c.numHeightPoints; ++j) {
    for (int i = 0; i < c.numWidthPoints; ++i) {
      PointMass p;
      if (c.orientation == Orientation::Horizontal) {
        p.start = {i * spacingX, 1, j * spacingY};
      } else {
        const double u = static_cast<double>(NextRandom(state) >> 11) * 0x1p-53;
        p.start = {i * spacingX, j * spacingY, (2 * u - 1) / 1000};
      }
      p.start += c.origin;
      p.position = p.previous = p.start;
      p.cloth = cloth;
      points_.push_back(p);
    }
  }
  for (const GridPoint& pin : c.pinned) At(cloth, pin.i, pin.j).pinned = true;

  const auto connect = [&](int i, int j, int di, int dj, Kind kind) {
    if (i + di < 0 || i + di >= c.numWidthPoints || j + dj < 0) return;
    PointMass& a = At(cloth, i, j);
    PointMass& b = At(cloth, i + di, j + dj);
    springs_.push_back({&a, &b, Length(b.start - a.start), kind, cloth});
  };
  for (int j = 0; j < c.numHeightPoints; ++j) {
    for (int i = 0; i < c.numWidthPoints; ++i) {
      connect(i, j, -1, 0, Kind::Structural);
      connect(i, j, 0, -1, Kind::Structural);
      connect(i, j, -1, -1, Kind::Shearing);
      connect(i, j, 1, -1, Kind::Shearing);
      connect(i, j, -2, 0, Kind::Bending);
      connect(i, j, 0, -2, Kind::Bending);
    }
  }
}

double PlainTwin::Mass(int cloth) const {
  const ClothSettings& c = scene_.cloths[static_cast<std::size_t>(cloth)];
  return c.width * c.height * c.density / (static_cast<double>(c.numWidthPoints) * c.numHeightPoints);
}

void PlainTwin::Frame() {
  for (int i = 0; i < scene_.simulation.stepsPerFrame; ++i) Step();
}

void PlainTwin::Step() {
  time_ += dt_;
  MovePins();
  ApplyForces();
  Integrate();
  if (scene_.simulation.selfCollision) {
    BuildSpatialMap();
    for (PointMass& point : points_) SelfCollide(point);
  }
  for (PointMass& point : points_) {
    if (point.pinned) continue;
    if (scene_.planesFirst) {
      for (const PlaneSettings& plane : scene_.planes) CollideWithPlane(point, plane);
    }
    for (const SphereSettings& sphere : scene_.spheres) CollideWithSphere(point, sphere);
    if (!scene_.planesFirst) {
      for (const PlaneSettings& plane : scene_.planes) CollideWithPlane(point, plane);
    }
  }
  LimitStrain();
}

void PlainTwin::MovePins() {
  if (scene_.pinMotions.empty()) return;
  const double time = time_;
  for (PointMass& point : points_) {
    if (!point.pinned) continue;
    Vec3 offset;
    Pose turned;
    bool turns = false;
    for (const PinMotion& motion : scene_.pinMotions) {
      if (motion.cloth != point.cloth) continue;
      bool concerned = motion.points.empty();
      for (const GridPoint& g : motion.points) concerned |= &At(point.cloth, g.i, g.j) == &point;
      if (!concerned) continue;
      const double s = std::clamp((time - motion.start) / (motion.end - motion.start), 0.0, 1.0);
      const double share = motion.steady ? s : s * s * (3 - 2 * s);
      offset += motion.displacement * share;
      if (motion.angle == 0 || share == 0) continue;
      const Matrix3<double> turn = RotationAbout(UnitOr(motion.axis, {0, 1, 0}), motion.angle * share);
      turned = {Product(turn, turned.rotation), motion.centre + Times(turn, turned.position - motion.centre)};
      turns = true;
    }
    point.previous = point.position;
    point.position = (turns ? ToWorld(turned, point.start) : point.start) + offset;
  }
}

void PlainTwin::ApplyForces() {
  for (PointMass& point : points_) point.force = Mass(point.cloth) * scene_.simulation.gravity;
  ApplyWind();
  for (const Spring& spring : springs_) {
    const ClothSettings& c = scene_.cloths[static_cast<std::size_t>(spring.cloth)];
    if (spring.kind == Kind::Structural && !c.enableStructural) continue;
    if (spring.kind == Kind::Shearing && !c.enableShearing) continue;
    if (spring.kind == Kind::Bending && !c.enableBending) continue;
    const double k = spring.kind == Kind::Bending ? kBendingShare * c.ks : c.ks;
    const Vec3 d = spring.b->position - spring.a->position;
    const double length = Length(d);
    if (length == 0) continue;
    const Vec3 force = d * (k * (length - spring.restLength) / length);
    spring.a->force += force;
    spring.b->force -= force;
  }
}

void PlainTwin::ApplyWind() {
  const WindSettings& wind = scene_.wind;
  if (wind.drag == 0) return;
  const double time = time_;
  const Vec3 air = wind.velocity * (1 + wind.gustiness * std::sin(2 * std::numbers::pi * time / wind.gustPeriod));
  for (int cloth = 0; cloth < static_cast<int>(scene_.cloths.size()); ++cloth) {
    const ClothSettings& c = scene_.cloths[static_cast<std::size_t>(cloth)];
    for (int j = 0; j < c.numHeightPoints; ++j) {
      for (int i = 0; i < c.numWidthPoints; ++i) {
        PointMass& point = At(cloth, i, j);
        const Vec3 alongWidth =
            At(cloth, std::min(i + 1, c.numWidthPoints - 1), j).position - At(cloth, std::max(i - 1, 0), j).position;
        const Vec3 alongHeight =
            At(cloth, i, std::min(j + 1, c.numHeightPoints - 1)).position - At(cloth, i, std::max(j - 1, 0)).position;
        const Vec3 normal = Cross(alongWidth, alongHeight);  // four times the point's area long
        const double length = Length(normal);
        if (length == 0) continue;
        const Vec3 velocity = (point.position - point.previous) / dt_;
        point.force += normal * (0.25 * wind.drag * Dot(normal, air - velocity) / length);
      }
    }
  }
}

void PlainTwin::Integrate() {
  for (PointMass& point : points_) {
    if (point.pinned) continue;
    const double mass = Mass(point.cloth);
    const double keep = 1 - scene_.cloths[static_cast<std::size_t>(point.cloth)].damping / 100;
    const double forceToWay = mass > 0 ? dt_ * dt_ / mass : 0;
    const Vec3 next = point.position + keep * (point.position - point.previous) + forceToWay * point.force;
    point.previous = point.position;
    point.position = next;
  }
}

std::uint64_t PlainTwin::Hash(const Vec3& position) const {
  const Box box = BoxOf(position, scene_);
  const auto power = [](std::int64_t base, int exponent) {
    std::uint64_t result = 1;
    for (int i = 0; i < exponent; ++i) result *= static_cast<std::uint64_t>(base);
    return result;
  };
  switch (scene_.simulation.hash) {
    case HashFunction::Linear:
      return static_cast<std::uint64_t>(7 * box.x + 5 * box.y + 3 * box.z);
    case HashFunction::Powers:
      return power(box.x, 6) + power(box.y, 4) + power(box.z, 2);
    case HashFunction::Brute:
      return 0;
    case HashFunction::Exact:
      break;
  }
  const std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(box.x) & mask) | (static_cast<std::uint64_t>(box.y) & mask) << 21 |
         (static_cast<std::uint64_t>(box.z) & mask) << 42;
}

void PlainTwin::BuildSpatialMap() {
  map_.clear();
  for (PointMass& point : points_) map_[Hash(point.position)].push_back(&point);
}

void PlainTwin::SelfCollide(PointMass& point) {
  // The bucket was chosen before any point moved in this stage; `point` itself has not moved yet.
  const auto found = map_.find(Hash(point.position));
  if (point.pinned || found == map_.end()) return;
  Vec3 correction;
  int count = 0;
  for (const PointMass* other : found->second) {
    if (other == &point) continue;
    const double apart = scene_.cloths[static_cast<std::size_t>(point.cloth)].thickness +
                         scene_.cloths[static_cast<std::size_t>(other->cloth)].thickness;
    const Vec3 d = point.position - other->position;
    const double distance = Length(d);
    if (distance > apart) continue;
    correction += distance > 0 ? d * ((apart - distance) / distance) : apart * kNoDirection;
    ++count;
  }
  if (count > 0) point.position += correction / (count * scene_.simulation.stepsPerFrame);
}

void PlainTwin::CollideWithSphere(PointMass& point, const SphereSettings& sphere) {
  const Vec3 d = point.position - sphere.origin;
  if (Length(d) > sphere.radius) return;
  const Vec3 target = sphere.origin + sphere.radius * UnitOr(d, kNoDirection);
  point.position = point.previous + (1 - sphere.friction) * (target - point.previous);
}

void PlainTwin::CollideWithPlane(PointMass& point, const PlaneSettings& plane) {
  const Vec3 normal = UnitOr(plane.normal, kNoDirection);
  const double before = Dot(point.previous - plane.point, normal);
  const double after = Dot(point.position - plane.point, normal);
  if ((before >= 0) == (after >= 0)) return;
  const double side = before >= 0 ? 1 : -1;
  Vec3 target;
  switch (scene_.simulation.planeResponse) {
    case PlaneResponse::Hold:
      point.position = point.previous;
      return;
    case PlaneResponse::Interpolate:
      target = point.previous + (before / (before - after)) * (point.position - point.previous);
      break;
    case PlaneResponse::Offset:
      target = point.position - after * normal;
      break;
  }
  target += side * kPlaneOffset * normal;
  point.position = point.previous + (1 - plane.friction) * (target - point.previous);
}

void PlainTwin::LimitStrain() {
  for (const Spring& spring : springs_) {
    const Vec3 d = spring.b->position - spring.a->position;
    const double length = Length(d);
    const double limit = kStretchLimit * spring.restLength;
    if (length <= limit || (spring.a->pinned && spring.b->pinned)) continue;
    const Vec3 excess = d * ((length - limit) / length);
    if (spring.a->pinned) {
      spring.b->position -= excess;
    } else if (spring.b->pinned) {
      spring.a->position += excess;
    } else {
      spring.a->position += 0.5 * excess;
      spring.b->position -= 0.5 * excess;
    }
  }
}

std::vector<Vec3> PlainTwin::Positions(int cloth) const {
  std::vector<Vec3> result;
  for (const PointMass& point : points_) {
    if (point.cloth == cloth) result.push_back(point.position);
  }
  return result;
}

void PlainTwin::SetScene(const Scene& scene) {
  scene_ = scene;
  dt_ = scene_.TimeStep();
}

void PlainTwin::SetPositions(int cloth, std::span<const Vec3> positions) {
  std::size_t next = firstPoint_[static_cast<std::size_t>(cloth)];
  for (const Vec3& position : positions) {
    points_[next].position = points_[next].previous = position;
    ++next;
  }
}

PlainTwin::PairCount PlainTwin::CountPairs() const {
  PairCount count;
  for (std::size_t a = 0; a < points_.size(); ++a) {
    for (std::size_t b = a + 1; b < points_.size(); ++b) {
      const Box boxA = BoxOf(points_[a].position, scene_), boxB = BoxOf(points_[b].position, scene_);
      const bool sameBox = boxA.x == boxB.x && boxA.y == boxB.y && boxA.z == boxB.z;
      const bool sameBucket = Hash(points_[a].position) == Hash(points_[b].position);
      const double apart = scene_.cloths[static_cast<std::size_t>(points_[a].cloth)].thickness +
                           scene_.cloths[static_cast<std::size_t>(points_[b].cloth)].thickness;
      const bool close = Length(points_[a].position - points_[b].position) <= apart;
      count.found += close && sameBucket;
      count.missed += close && !sameBucket;
      count.falseNeighbours += sameBucket && !sameBox;
    }
  }
  return count;
}

}  // namespace percale::bench
