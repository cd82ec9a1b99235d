#include "mesh/pins.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "mesh/cloth_model.h"

namespace percale {

void Pins::Update(const Scene& scene, std::span<const int> firstPoint, double time,
                  const std::function<Vec3(int point)>& position) {
  const std::vector<Pin> old = std::exchange(pins_, {});
  time_ = time;
  motions_.clear();
  first_.clear();
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    first_.push_back(pins_.size());
    for (const std::int32_t vertex : PinnedVertices(scene.cloths[c])) {
      const int point = firstPoint[c] + vertex;
      const Vec3 at = position(point);
      Pin pin{.point = point, .anchor = at, .target = at, .previousTarget = at};
      pin.firstMotion = static_cast<int>(motions_.size());
      for (const PinMotion& motion : scene.pinMotions) {
        if (static_cast<std::size_t>(motion.cloth) != c) continue;
        const bool named = std::any_of(motion.points.begin(), motion.points.end(),
                                       [&](const GridPoint& g) { return VertexOf(scene.cloths[c], g) == vertex; });
        if (!named && !motion.points.empty()) continue;
        motions_.push_back(motion);
        motions_.back().points.clear();
        motions_.back().axis = UnitOr(motion.axis, {0, 1, 0});
      }
      pin.motionCount = static_cast<int>(motions_.size()) - pin.firstMotion;
      const auto before =
          std::lower_bound(old.begin(), old.end(), point, [](const Pin& p, int other) { return p.point < other; });
      if (before != old.end() && before->point == point) {
        pin.anchor = before->anchor;
        pin.target = pin.previousTarget = before->target;  // a pin that is no longer carried stands still
      } else {
        pin.anchor = CarriageOf(pin, time).Undo(at);
      }
      pins_.push_back(pin);
    }
  }
  first_.push_back(pins_.size());
}

void Pins::Reset(const std::function<Vec3(int point)>& position) {
  time_ = 0;
  for (Pin& pin : pins_) pin.anchor = pin.target = pin.previousTarget = position(pin.point);
}

bool Pins::MoveTo(double time) {
  time_ = time;
  if (motions_.empty()) return false;
  for (Pin& pin : pins_) {
    pin.previousTarget = pin.target;
    pin.target = CarriageOf(pin, time).Carry(pin.anchor);
  }
  return true;
}

void Pins::Shift(std::size_t index, const Vec3& way) {
  Pin& pin = pins_[index];
  const Carriage carriage = CarriageOf(pin, time_);
  pin.anchor += carriage.turns ? TransposedTimes(carriage.pose.rotation, way) : way;
  pin.target = pin.previousTarget = pin.target + way;
}

const Pin* Pins::Find(int point) const {
  const auto pin =
      std::lower_bound(pins_.begin(), pins_.end(), point, [](const Pin& p, int other) { return p.point < other; });
  return pin != pins_.end() && pin->point == point ? &*pin : nullptr;
}

void Pins::ReadAnchors(std::size_t cloth, std::vector<Vec3>& anchors) const {
  anchors.clear();
  for (const Pin& pin : Of(cloth)) anchors.push_back(pin.anchor);
}

void Pins::WriteAnchors(std::size_t cloth, std::span<const Vec3> anchors, double time,
                        const std::function<Vec3(int point)>& position) {
  assert(anchors.size() == Count(cloth));
  time_ = time;
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    Pin& pin = pins_[first_[cloth] + k];
    pin.anchor = anchors[k];
    pin.target = pin.previousTarget = position(pin.point);
  }
}

Pins::Carriage Pins::CarriageOf(const Pin& pin, double time) const {
  Carriage carriage;
  for (int m = 0; m < pin.motionCount; ++m) {
    const PinMotion& motion = motions_[static_cast<std::size_t>(pin.firstMotion + m)];
    const double share = MotionShare(motion.start, motion.end, motion.steady, time);
    carriage.way += motion.displacement * share;
    if (motion.angle == 0 || share == 0) continue;
    const Matrix3<double> turn = RotationAbout(motion.axis, motion.angle * share);
    carriage.turns = true;
    carriage.pose.rotation = Product(turn, carriage.pose.rotation);
    carriage.pose.position = motion.centre + Times(turn, carriage.pose.position - motion.centre);
  }
  return carriage;
}

}  // namespace percale
