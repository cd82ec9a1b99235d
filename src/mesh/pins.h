#pragma once
/// \file
/// The pins of all cloths of a scene: where each is held, and where its motions carry it.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/pose.h"
#include "percale/interaction.h"
#include "percale/scene.h"

namespace percale {

struct Pin {
  int point = 0;                         ///< Index among the points of all cloths.
  Vec3 anchor;                           ///< Where it is without motions [m].
  Vec3 target;                           ///< Where it is now [m].
  Vec3 previousTarget;                   ///< Where it was one step ago [m].
  int firstMotion = 0, motionCount = 0;  ///< Places in the list of motions.
};

class Pins {
 public:
  /// Takes the pins that the scene states. Those that there were stay where they are held; what is pinned from now
  /// on is held where it is at `time` [s]. `firstPoint`: per cloth the index of its first point.
  void Update(const Scene& scene, std::span<const int> firstPoint, double time,
              const std::function<Vec3(int point)>& position);
  /// Holds each where it is, and lets its motions begin anew.
  void Reset(const std::function<Vec3(int point)>& position);
  /// Carries them to where they are at `time` [s]. Returns false, and does nothing, where none moves.
  bool MoveTo(double time);
  /// Holds pin `index` of the list `way` farther off, at once.
  void Shift(std::size_t index, const Vec3& way);

  /// Ascending by point.
  std::span<const Pin> All() const { return pins_; }
  /// Those of one cloth, and where they begin in the list.
  std::span<const Pin> Of(std::size_t cloth) const { return All().subspan(first_[cloth], Count(cloth)); }
  std::size_t First(std::size_t cloth) const { return first_[cloth]; }
  std::size_t Count(std::size_t cloth) const { return first_[cloth + 1] - first_[cloth]; }
  /// The pin of a point, or null.
  const Pin* Find(int point) const;

  /// Where the pins of a cloth are held apart from their motions [m].
  void ReadAnchors(std::size_t cloth, std::vector<Vec3>& anchors) const;
  /// The same, set; each is where `position` says at `time` [s]. One anchor per pin of the cloth.
  void WriteAnchors(std::size_t cloth, std::span<const Vec3> anchors, double time,
                    const std::function<Vec3(int point)>& position);

 private:
  /// What motions do to a pin: they turn it, and displace it by a way [m].
  struct Carriage {
    bool turns = false;  // else the pose says nothing
    Pose pose;
    Vec3 way;

    Vec3 Carry(const Vec3& anchor) const { return (turns ? ToWorld(pose, anchor) : anchor) + way; }
    Vec3 Undo(const Vec3& target) const { return turns ? ToLocal(pose, target - way) : target - way; }
  };
  Carriage CarriageOf(const Pin& pin, double time) const;

  std::vector<Pin> pins_;
  std::vector<std::size_t> first_;  // per cloth, and the end
  std::vector<PinMotion> motions_;  // of all pins, each as often as it has pins
  double time_ = 0;                 // at which the targets are [s]
};

/// What share of a grip's way a vertex goes along that is `offset` from its vertex in the rest shape [m]: less and
/// less towards the grip's radius.
inline double GripShare(const Handle& handle, const Vec3& offset) {
  const double share = 1 - Dot(offset, offset) / (handle.radius * handle.radius);
  return share > 0 ? share * share : 0;
}

}  // namespace percale
