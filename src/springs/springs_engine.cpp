#include "springs/springs_engine.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "collide/ball.h"
#include "collide/boxes.h"
#include "core/index.h"

namespace percale::springs {
namespace {

constexpr double kStretchLimit = 1.1;  // of the rest length; Provot 1995, section 5
constexpr double kNearShare = 0.01;    // a spring this close to the limit is looked at; tuned on pinned2
constexpr double kBendingShare = 0.2;  // bending springs have this share of ks
constexpr double kFarAway = 4;         // of a cloth's size: a point farther from its first is not measured in float
constexpr double kBound = 1e6;         // m; a cloth this far out has diverged
constexpr int kPointsPerChunk = 2560;  // of all loops, where there are threads; below it a second one does not pay
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Square of the length from which on a spring is looked at, when measured in float from positions relative to another
/// point, `farthest` from it at most along each axis: each is off by 2^-24 of that, and the length by as much of itself
/// and more.
float NearSquared(double rest, double farthest) {
  const double near = (1 - kNearShare) * kStretchLimit * rest;
  const double measured = std::max(0.0, near - 4 * 0x1p-24 * farthest);
  return static_cast<float>(measured * measured * (1 - 1e-6));
}

/// Point p of arrays with one axis each.
Vec3 Get(const double* const axes[3], int p) {
  return {axes[0][p], axes[1][p], axes[2][p]};
}
void Put(double* const axes[3], int p, const Vec3& at) {
  axes[0][p] = at.x, axes[1][p] = at.y, axes[2][p] = at.z;
}

}  // namespace

SpringsEngine::SpringsEngine(const Scene& scene, std::span<const ClothModel> models, const Executor& executor,
                             const Kernels& kernels)
    : executor_(executor), kernels_(kernels) {
  int widest = 0;
  for (const ClothModel& model : models) {
    AddSheet(model);
    widest = std::max(widest, model.numWidth);
  }

  pointsPerChunk_ = executor_.threads() > 1 ? kPointsPerChunk : std::max(pointCount_, 1);
  const std::size_t count = Index(pointCount_);
  axisStride_ = GridPadding(widest) + RoundUpToPad(pointCount_) + kGridPad;
  positionStore_.resize(Index(3 * axisStride_));
  previousStore_.resize(positionStore_.size());
  for (int axis = 0; axis < 3; ++axis) {
    positions_[axis] = positionStore_.data() + axis * axisStride_ + GridPadding(widest);
    previous_[axis] = previousStore_.data() + axis * axisStride_ + GridPadding(widest);
  }
  fixed_.assign(count, 0);
  touched_.reserve(count);
  boxKeys_.resize(count);
  boxPlaces_.resize(count);
  boxChanges_.resize(count);
  boxesWrap_.assign(Index(PointChunks()), 0);
  thickness_.resize(count);
  map_.Reserve(pointCount_);
  scratchPerChunk_ = IntegrateScratch(widest);
  integrateScratch_.assign(Index(chunkCount_) * Index(scratchPerChunk_), 0);
  markScratchPerChunk_ = MarkScratch(widest);
  markScratch_.assign(Index(chunkCount_) * Index(markScratchPerChunk_), 0);
  const int bucketChunks = pointCount_ / pointsPerChunk_ + 2;
  bucketChunks_.reserve(Index(bucketChunks));
  bucketScratch_.resize(3 * (count + Index(kGridPad * bucketChunks)));
  chunkCounts_.resize(Index(std::max({chunkCount_, bucketChunks, PointChunks()})));
  Configure(scene);
  Reset();
}

/// Appends a cloth: its points, springs and chunks.
void SpringsEngine::AddSheet(const ClothModel& model) {
  Sheet sheet;
  sheet.numWidth = model.numWidth;
  sheet.numHeight = model.numHeight;
  sheet.firstPoint = pointCount_;
  firstPoint_.push_back(pointCount_);
  pointCount_ += model.PointCount();
  sheet.kinds.assign(Index(model.PointCount() + MarkPadding(model.numWidth)), 0);
  double shortest = kInfinity, farthest = 0;
  for (const Vec3& at : model.start) farthest = std::max(farthest, Length(at - model.start[0]));
  sheet.farthest = static_cast<float>(kFarAway * farthest);
  sheet.nearSquared.assign(Index(kSpringKinds * sheet.NearStride()), std::numeric_limits<float>::infinity());
  sheet.rest.assign(Index(kSpringKinds * sheet.RestStride()), kNoSpringRest);
  for (int kind = 0; kind < kSpringKinds; ++kind) {
    const auto [di, dj] = kSpringSteps[kind];
    float* const nearSquared = sheet.nearSquared.data() + kind * sheet.NearStride();
    for (int j = 0; j < model.numHeight; ++j) {
      for (int i = 0; i < model.numWidth; ++i) {
        if (i + di < 0 || i + di >= model.numWidth || j + dj < 0) continue;
        const int p = j * model.numWidth + i;
        sheet.kinds[Index(p)] |= static_cast<std::uint8_t>(1u << kind);
        const double rest = Length(model.start[Index(p + dj * model.numWidth + di)] - model.start[Index(p)]);
        sheet.Rest(kind)[p] = rest;
        nearSquared[i] = std::min(nearSquared[i], NearSquared(rest, sheet.farthest));
        shortest = std::min(shortest, rest);
      }
    }
  }
  // Both ends of a spring may spend it, and sums in float round.
  sheet.moveBudget = static_cast<float>(0.49 * kNearShare * kStretchLimit * shortest);
  sheet.nearKinds.assign(Index(model.PointCount() + MarkPadding(model.numWidth)), 0);
  sheet.moved.assign(Index(model.PointCount()), 0);
  sheet.rowsPerChunk = sheet.numHeight;
  if (executor_.threads() > 1) {
    sheet.rowsPerChunk = std::max(16, (kPointsPerChunk + sheet.numWidth - 1) / sheet.numWidth);
  }
  sheet.firstChunk = chunkCount_;
  chunkCount_ += (sheet.numHeight + sheet.rowsPerChunk - 1) / sheet.rowsPerChunk;
  start_.insert(start_.end(), model.start.begin(), model.start.end());
  sheets_.push_back(std::move(sheet));
}

void SpringsEngine::Configure(const Scene& scene) {
  scene_ = scene;
  dt_ = scene_.TimeStep();
  greatestApart_ = 0;
  sameThickness_ = true;
  for (std::size_t c = 0; c < sheets_.size(); ++c) {
    const ClothSettings& cloth = scene_.cloths[c];
    Sheet& sheet = sheets_[c];
    for (int kind = 0; kind < kSpringKinds; ++kind) {
      const bool bending = kind == static_cast<int>(SpringKind::TwoLeft) || kind == static_cast<int>(SpringKind::TwoUp);
      sheet.stiffness[kind] = !Enabled(cloth, static_cast<SpringKind>(kind)) ? 0
                              : bending                                      ? kBendingShare * cloth.ks
                                                                             : cloth.ks;
    }
    sheet.mass = PointMass(cloth);
    sheet.masses.assign(Index(sheet.PointCount()), sheet.mass);
    sheet.keep = 1 - cloth.damping / 100;
    const auto first = thickness_.begin() + sheet.firstPoint;
    std::fill(first, first + sheet.PointCount(), cloth.thickness);
    greatestApart_ = std::max(greatestApart_, 2 * cloth.thickness);
    sameThickness_ = sameThickness_ && cloth.thickness == scene_.cloths[0].thickness;
  }
  boxSize_ = BoxSize(scene_.cloths);
  bound_ = std::min(kBound, 0x1p50 * std::min(boxSize_.x, boxSize_.y));  // beyond it box indices would not be exact

  UpdatePins();
}

void SpringsEngine::UpdatePins() {
  for (const Pin& pin : pins_.All()) fixed_[Index(pin.point)] = 0;
  pins_.Update(scene_, firstPoint_, time_, [&](int point) { return Get(positions_, point); });
  for (const Pin& pin : pins_.All()) fixed_[Index(pin.point)] = 1;
}

void SpringsEngine::Reset() {
  for (int p = 0; p < pointCount_; ++p) {
    Put(positions_, p, start_[Index(p)]);
    Put(previous_, p, start_[Index(p)]);
  }
  pins_.Reset([&](int point) { return start_[Index(point)]; });
  time_ = 0;
  ForgetBoxes();
}

/// The points are somewhere else: the spatial map starts anew.
void SpringsEngine::ForgetBoxes() {
  std::fill(boxesWrap_.begin(), boxesWrap_.end(), 0);
  std::fill(boxKeys_.begin(), boxKeys_.end(), ~std::uint64_t{0});
  mapBuilt_ = false;
}

/// Calls body(sheet, rowBegin, rowEnd, chunk) for chunks of rows of all sheets.
template <class Body>
void SpringsEngine::ForRowChunks(Body&& body) {
  executor_.ForChunks(chunkCount_, [&](int chunk) {
    std::size_t s = sheets_.size() - 1;
    while (sheets_[s].firstChunk > chunk) --s;
    Sheet& sheet = sheets_[s];
    const int begin = (chunk - sheet.firstChunk) * sheet.rowsPerChunk;
    body(sheet, begin, std::min(begin + sheet.rowsPerChunk, sheet.numHeight), chunk);
  });
}

int SpringsEngine::PointChunks() const {
  return (pointCount_ + pointsPerChunk_ - 1) / pointsPerChunk_;
}

/// Calls body(begin, end, chunk) for chunks of all points.
template <class Body>
void SpringsEngine::ForPointChunks(Body&& body) {
  executor_.ForChunks(PointChunks(), [&](int chunk) {
    const int begin = chunk * pointsPerChunk_;
    body(begin, std::min(begin + pointsPerChunk_, pointCount_), chunk);
  });
}

std::int64_t SpringsEngine::SumChunkCounts(int chunks) const {
  std::int64_t sum = 0;
  for (int chunk = 0; chunk < chunks; ++chunk) sum += chunkCounts_[Index(chunk)];
  return sum;
}

void SpringsEngine::MoveColliders(double time) {
  time_ = time;
  if (!pins_.MoveTo(time)) return;
  for (const Pin& pin : pins_.All()) Put(positions_, pin.point, pin.target);
}

/// Several winds at once act as one: their drags add, and so do their pushes.
void SpringsEngine::ComputeWind(double time, std::span<const Gust> gusts) {
  for (auto& axis : windForce_) axis.resize(Index(kGridPad + pointCount_ + kGridPad));
  const WindSettings& wind = scene_.wind;
  double drag = wind.drag;
  Vec3 air = wind.velocity * (1 + wind.gustiness * std::sin(2 * std::numbers::pi * time / wind.gustPeriod));
  for (const Gust& gust : gusts) {
    const double phase = std::numbers::pi * (time - gust.start) / gust.duration;
    if (phase <= 0 || phase >= std::numbers::pi) continue;
    const double strength = std::sin(phase) * std::sin(phase);
    const double added = gust.drag * strength;
    if (drag + added <= 0) continue;
    air = (air * drag + gust.velocity * (strength * added)) / (drag + added);
    drag += added;
  }
  const auto position = [&](int p) { return Get(positions_, p); };
  double* const windForces[3] = {windForce_[0].data() + kGridPad, windForce_[1].data() + kGridPad,
                                 windForce_[2].data() + kGridPad};
  ForRowChunks([&](const Sheet& sheet, int rowBegin, int rowEnd, int) {
    for (int j = rowBegin; j < rowEnd; ++j) {
      const int row = sheet.firstPoint + j * sheet.numWidth;
      const int up = j > 0 ? sheet.numWidth : 0, down = j + 1 < sheet.numHeight ? sheet.numWidth : 0;
      for (int i = 0; i < sheet.numWidth; ++i) {
        const int p = row + i;
        const Vec3 alongWidth = position(i + 1 < sheet.numWidth ? p + 1 : p) - position(i > 0 ? p - 1 : p);
        const Vec3 alongHeight = position(p + down) - position(p - up);
        // Differences over two spacings, or over one at the border, where a point has half the area:
        // either way the normal is four times as long as the point's area is large.
        const Vec3 normal = Cross(alongWidth, alongHeight);
        const double length = Length(normal);
        Vec3 force;
        if (length > 0) {
          const Vec3 velocity = (position(p) - Get(previous_, p)) / dt_;
          force = normal * (0.25 * drag * Dot(normal, air - velocity) / length);
        }
        Put(windForces, p, force);
      }
    }
  });
}

bool SpringsEngine::ApplyForces(double time, std::span<const Gust> gusts) {
  const bool windy = scene_.wind.drag > 0 || !gusts.empty();
  if (windy) ComputeWind(time, gusts);
  const Vec3 gravity = scene_.simulation.gravity;
  ForRowChunks([&](const Sheet& sheet, int rowBegin, int rowEnd, int chunk) {
    IntegrateArgs args{};
    args.numWidth = sheet.numWidth;
    args.numHeight = sheet.numHeight;
    args.rowBegin = rowBegin;
    args.rowEnd = rowEnd;
    const double weight[3] = {sheet.mass * gravity.x, sheet.mass * gravity.y, sheet.mass * gravity.z};
    for (int axis = 0; axis < 3; ++axis) {
      args.weight[axis] = weight[axis];
      args.extraForce[axis] = windy ? windForce_[axis].data() + kGridPad + sheet.firstPoint : nullptr;
    }
    args.x = positions_[0] + sheet.firstPoint;
    args.previous = previous_[0] + sheet.firstPoint;
    args.stride = axisStride_;
    args.rest = sheet.Rest(0);
    args.restStride = sheet.RestStride();
    for (int kind = 0; kind < kSpringKinds; ++kind) args.stiffness[kind] = sheet.stiffness[kind];
    args.keep = sheet.keep;
    args.forceToWay = sheet.mass > 0 ? dt_ * dt_ / sheet.mass : 0;
    args.bound = bound_;
    args.scratch = integrateScratch_.data() + Index(chunk) * Index(scratchPerChunk_);
    chunkCounts_[Index(chunk)] = kernels_.integrate(args);
  });
  for (int axis = 0; axis < 3; ++axis) std::swap(positions_[axis], previous_[axis]);
  HoldPins(0, pointCount_);
  for (const Pin& pin : pins_.All()) Put(previous_, pin.point, pin.previousTarget);
  return SumChunkCounts(chunkCount_) == 0;
}

/// Puts the pins among the points begin <= p < end back where they are held.
void SpringsEngine::HoldPins(int begin, int end) {
  const std::span<const Pin> pins = pins_.All();
  const auto before = [](const Pin& pin, int point) { return pin.point < point; };
  auto pin = std::lower_bound(pins.begin(), pins.end(), begin, before);
  for (; pin != pins.end() && pin->point < end; ++pin) Put(positions_, pin->point, pin->target);
}

void SpringsEngine::FindContacts() {
  if (!scene_.simulation.selfCollision) return;
  ForPointChunks([&](int begin, int end, int chunk) {
    chunkCounts_[Index(chunk)] =
        scene_.simulation.hash == HashFunction::Exact
            ? kernels_.boxKeys({begin,
                                end - begin,
                                {positions_[0] + begin, positions_[1] + begin, positions_[2] + begin},
                                {boxSize_.x, boxSize_.y, boxSize_.z},
                                boxKeys_.data() + begin,
                                boxPlaces_.data() + begin,
                                boxChanges_.data() + begin,
                                &boxesWrap_[Index(chunk)]})
            : HashKeys(begin, end);
  });
  if (!mapBuilt_) {
    map_.Build(boxKeys_);
    mapBuilt_ = true;
  } else {
    std::size_t changes = 0;  // of all chunks, brought together
    for (int chunk = 0; chunk < PointChunks(); ++chunk) {
      const std::size_t count = Index(chunkCounts_[Index(chunk)]);
      std::copy_n(boxChanges_.data() + chunk * pointsPerChunk_, count, boxChanges_.data() + changes);
      changes += count;
    }
    map_.Update(boxKeys_, {boxChanges_.data(), changes});
  }
  bucketChunks_.clear();
  if (PointChunks() == 1) {
    bucketChunks_.push_back({map_.BucketCount(), 0});
    return;
  }
  std::int32_t points = 0, pointsBefore = 0;
  for (int bucket = 0; bucket < map_.BucketCount(); ++bucket) {
    points += map_.Count()[bucket];
    if (points - pointsBefore < pointsPerChunk_ && bucket + 1 < map_.BucketCount()) continue;
    bucketChunks_.push_back({bucket + 1, pointsBefore});
    pointsBefore = points;
  }
}

/// Keys of the points begin <= p < end by one of the write-up's hash functions. Lists the points whose
/// key changed and returns how many there are.
std::int64_t SpringsEngine::HashKeys(int begin, int end) {
  const HashFunction hash = scene_.simulation.hash;
  std::int64_t changed = 0;
  for (int p = begin; p < end; ++p) {
    const std::uint64_t key = SharedBucket(BoxOf(Get(positions_, p), boxSize_), hash);
    if (key != boxKeys_[Index(p)]) boxChanges_[Index(begin + changed++)] = p;
    boxKeys_[Index(p)] = key;
  }
  return changed;
}

void SpringsEngine::SelfCollide() {
  if (!scene_.simulation.selfCollision) return;
  const int chunks = static_cast<int>(bucketChunks_.size());
  const bool near = scene_.simulation.hash == HashFunction::Exact &&
                    std::find(boxesWrap_.begin(), boxesWrap_.end(), 1) == boxesWrap_.end();
  executor_.ForChunks(chunks, [&](int chunk) {
    BucketArgs args{};
    args.bucketBegin = chunk == 0 ? 0 : bucketChunks_[Index(chunk - 1)].bucketEnd;
    args.bucketEnd = bucketChunks_[Index(chunk)].bucketEnd;
    args.first = map_.First();
    args.count = map_.Count();
    args.members = map_.Members();
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = positions_[axis];
    args.fixed = fixed_.data();
    args.thickness = thickness_.data();
    args.greatestApart = greatestApart_;
    args.sameThickness = sameThickness_;
    args.place = near ? boxPlaces_.data() : nullptr;
    args.boxSize = boxSize_.z;
    args.stepsPerFrame = scene_.simulation.stepsPerFrame;
    // No bucket of a chunk has more points than the chunk.
    args.scratch = bucketScratch_.data() + 3 * (bucketChunks_[Index(chunk)].pointsBefore + kGridPad * chunk);
    args.others = boxChanges_.data() + bucketChunks_[Index(chunk)].pointsBefore;
    chunkCounts_[Index(chunk)] = kernels_.separateBuckets(args);
  });
  counts_.selfContacts += SumChunkCounts(chunks) / 2;
}

void SpringsEngine::Collide() {
  if (scene_.spheres.empty() && scene_.planes.empty()) return;
  ForPointChunks([&](int begin, int end, int chunk) {
    ColliderArgs args{};
    args.begin = begin;
    args.end = end;
    for (int axis = 0; axis < 3; ++axis) {
      args.x[axis] = positions_[axis];
      args.previous[axis] = previous_[axis];
    }
    std::int64_t contacts = 0;
    const auto spheres = [&] {
      for (const SphereSettings& sphere : scene_.spheres) {
        args.origin[0] = sphere.origin.x, args.origin[1] = sphere.origin.y, args.origin[2] = sphere.origin.z;
        args.radius = sphere.radius;
        args.friction = sphere.friction;
        contacts += kernels_.collideSphere(args);
      }
    };
    const auto planes = [&] {
      for (const PlaneSettings& plane : scene_.planes) {
        const Vec3 normal = UnitOr(plane.normal, {0, 1, 0});
        args.origin[0] = plane.point.x, args.origin[1] = plane.point.y, args.origin[2] = plane.point.z;
        args.normal[0] = normal.x, args.normal[1] = normal.y, args.normal[2] = normal.z;
        args.friction = plane.friction;
        args.response = static_cast<int>(scene_.simulation.planeResponse);
        contacts += kernels_.collidePlane(args);
      }
    };
    if (scene_.planesFirst) planes();
    spheres();
    if (!scene_.planesFirst) planes();
    HoldPins(begin, end);
    chunkCounts_[Index(chunk)] = contacts;
  });
  counts_.colliderContacts += SumChunkCounts(PointChunks());
}

void SpringsEngine::Pull(const Handle& handle) {
  const int centre = sheets_[Index(handle.cloth)].firstPoint + handle.vertex;
  // m (x' - x) / dt^2 = k (target - x') - c (x' - before) / dt, with k = m w^2 and c = 2 m w.
  const double w = 2 * std::numbers::pi * handle.frequency * dt_;
  const Vec3 x = Get(positions_, centre), before = Get(previous_, centre);
  MovePatch(handle, ((handle.target - x) * (w * w) + (before - x) * (2 * w)) / (1 + w * w + 2 * w), false);
}

void SpringsEngine::AddForces(int cloth, std::span<const Vec3> forces) {
  const Sheet& sheet = sheets_[Index(cloth)];
  if (sheet.mass <= 0) return;
  for (std::size_t v = 0; v < forces.size(); ++v) {
    const int p = sheet.firstPoint + static_cast<int>(v);
    if (!fixed_[Index(p)]) Shift(p, forces[v] * (dt_ * dt_ / sheet.mass), false);
  }
}

void SpringsEngine::Place(const Handle& handle) {
  const int centre = sheets_[Index(handle.cloth)].firstPoint + handle.vertex;
  MovePatch(handle, handle.target - Get(positions_, centre), true);
}

/// Moves the vertex of a handle by `way`, and the cloth around it along, less and less towards the radius.
/// Pins stay, unless the vertex is one itself: then it moves alone.
void SpringsEngine::MovePatch(const Handle& handle, const Vec3& way, bool keepVelocity) {
  const Sheet& sheet = sheets_[Index(handle.cloth)];
  const int centre = sheet.firstPoint + handle.vertex;
  if (const Pin* pin = pins_.Find(centre)) {
    pins_.Shift(Index(pin - pins_.All().data()), way);
    Shift(centre, way, keepVelocity);
    return;
  }
  for (int p = sheet.firstPoint; p < sheet.firstPoint + sheet.PointCount(); ++p) {
    const double share = GripShare(handle, start_[Index(p)] - start_[Index(centre)]);
    if (!fixed_[Index(p)] && share > 0) Shift(p, way * share, keepVelocity);
  }
}

void SpringsEngine::Shift(int point, const Vec3& way, bool keepVelocity) {
  Put(positions_, point, Get(positions_, point) + way);
  if (keepVelocity) Put(previous_, point, Get(previous_, point) + way);
}

void SpringsEngine::CollideBall(Ball& ball) {
  struct Points {
    SpringsEngine& e;
    std::size_t sheet = 0;  // of the last point asked for
    int count() const { return e.pointCount_; }
    bool fixed(int p) const { return e.fixed_[Index(p)]; }
    Vec3 at(int p) const { return Get(e.positions_, p); }
    void put(int p, const Vec3& x) { Put(e.positions_, p, x); }
    double mass(int p) {
      while (sheet + 1 < e.sheets_.size() && p >= e.sheets_[sheet + 1].firstPoint) ++sheet;
      while (p < e.sheets_[sheet].firstPoint) --sheet;
      return e.sheets_[sheet].mass;
    }
  };
  counts_.colliderContacts += PushApart(ball, dt_, Points{*this}, touched_);
}

void SpringsEngine::LimitStrain() {
  ForRowChunks([&](Sheet& sheet, int rowBegin, int rowEnd, int chunk) {
    LongSpringsArgs args{};
    args.numWidth = sheet.numWidth;
    args.rowBegin = rowBegin;
    args.rowEnd = rowEnd;
    for (int axis = 0; axis < 3; ++axis) {
      args.x[axis] = positions_[axis] + sheet.firstPoint;
      args.origin[axis] = args.x[axis][0];
    }
    args.farthest = sheet.farthest;
    args.nearSquared = sheet.nearSquared.data();
    args.nearStride = sheet.NearStride();
    args.scratch = markScratch_.data() + Index(chunk) * Index(markScratchPerChunk_);
    args.nearKinds = sheet.nearKinds.data();
    chunkCounts_[Index(chunk)] = kernels_.markLongSprings(args);
  });
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const int end = s + 1 < sheets_.size() ? sheets_[s + 1].firstChunk : chunkCount_;
    std::int64_t found = 0;
    for (int chunk = sheets_[s].firstChunk; chunk < end; ++chunk) found |= chunkCounts_[Index(chunk)];
    if (found == 0) continue;
    Sheet& sheet = sheets_[s];
    if ((found & kSomeAreFarAway) != 0) sheet.nearKinds = sheet.kinds;
    std::fill(sheet.moved.begin(), sheet.moved.end(), 0.0f);
    StrainArgs args{};
    args.numWidth = sheet.numWidth;
    args.pointCount = sheet.PointCount();
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = positions_[axis] + sheet.firstPoint;
    args.fixed = fixed_.data() + sheet.firstPoint;
    for (int kind = 0; kind < kSpringKinds; ++kind) args.rest[kind] = sheet.Rest(kind);
    args.limit = kStretchLimit;
    args.kinds = sheet.kinds.data();
    args.marks = sheet.nearKinds.data();
    args.moved = sheet.moved.data();
    args.budget = sheet.moveBudget;
    counts_.limitedSprings += kernels_.limitStrain(args);
  }
}

void SpringsEngine::ReadState(int cloth, std::span<Vec3> positions, std::span<Vec3> previous) const {
  const Sheet& sheet = sheets_[Index(cloth)];
  assert(positions.size() == Index(sheet.PointCount()) && previous.size() == positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const int p = sheet.firstPoint + static_cast<int>(v);
    positions[v] = Get(positions_, p);
    previous[v] = Get(previous_, p);
  }
}

std::span<const Vec3> SpringsEngine::Start(int cloth) const {
  const Sheet& sheet = sheets_[Index(cloth)];
  return std::span(start_).subspan(Index(sheet.firstPoint), Index(sheet.PointCount()));
}

void SpringsEngine::ReadAnchors(int cloth, std::vector<Vec3>& anchors) const {
  pins_.ReadAnchors(Index(cloth), anchors);
}

void SpringsEngine::WriteState(int cloth, std::span<const Vec3> positions, std::span<const Vec3> previous,
                               std::span<const Vec3> anchors, double time) {
  const Sheet& sheet = sheets_[Index(cloth)];
  assert(positions.size() == Index(sheet.PointCount()) && previous.size() == positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const int p = sheet.firstPoint + static_cast<int>(v);
    Put(positions_, p, positions[v]);
    Put(previous_, p, previous[v]);
  }
  pins_.WriteAnchors(Index(cloth), anchors, time, [&](int point) { return Get(positions_, point); });
  time_ = time;
  ForgetBoxes();
}

Stretch SpringsEngine::GreatestStretch() const {
  Stretch greatest;  // its ratio squared, until the end
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Sheet& sheet = sheets_[s];
    GreatestStretchArgs args{};
    args.numWidth = sheet.numWidth;
    args.pointCount = sheet.PointCount();
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = positions_[axis] + sheet.firstPoint;
    for (int kind = 0; kind < kSpringKinds; ++kind) args.rest[kind] = sheet.Rest(kind);
    const GreatestStretchResult found = kernels_.greatestStretch(args);
    if (found.squaredRatio > greatest.ratio) {
      greatest = {found.squaredRatio, {static_cast<int>(s), static_cast<int>(found.point)}};
    }
  }
  greatest.ratio = std::sqrt(greatest.ratio);
  return greatest;
}

double SpringsEngine::ElasticEnergy() const {
  double energy = 0;
  for (const Sheet& sheet : sheets_) {
    ElasticEnergyArgs args{};
    args.numWidth = sheet.numWidth;
    args.pointCount = sheet.PointCount();
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = positions_[axis] + sheet.firstPoint;
    for (int kind = 0; kind < kSpringKinds; ++kind) {
      args.rest[kind] = sheet.Rest(kind);
      args.stiffness[kind] = sheet.stiffness[kind];
    }
    energy += kernels_.elasticEnergy(args);
  }
  return energy;
}

VertexRef SpringsEngine::FindOutOfBounds() const {
  const auto isOutside = [&](double x) { return !(std::abs(x) <= bound_); };
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const int count = sheets_[s].PointCount();
    bool any = false;
    for (const double* axis : positions_) {
      const double* const x = axis + sheets_[s].firstPoint;
      for (int v = 0; v < count; ++v) any |= isOutside(x[v]);  // without a way out, several at a time
    }
    for (int v = 0; any && v < count; ++v) {
      for (const double* axis : positions_) {
        if (isOutside(axis[Index(sheets_[s].firstPoint + v)])) return {static_cast<int>(s), v};
      }
    }
  }
  return {};
}

}  // namespace percale::springs
