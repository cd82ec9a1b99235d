#pragma once
/// \file
/// The classic simulator as a textbook has it: one object per mass and per spring, a hash map of
/// vectors rebuilt at every step. It is the reference that the `springs` engine is held against, to
/// the last bit, and what its speed is compared with. Clarity before speed; no shared code with the
/// engine, so that a mistake in one is seen in the other.

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale::bench {

class PlainTwin {
 public:
  explicit PlainTwin(const Scene& scene);

  /// Runs one frame: scene.simulation.stepsPerFrame steps.
  void Frame();

  /// Positions of a cloth's points [m], in index order.
  std::vector<Vec3> Positions(int cloth) const;
  std::size_t PointCount() const { return points_.size(); }

  /// Takes changed settings of the same grids: everything that may change while a simulation runs.
  void SetScene(const Scene& scene);
  /// Puts a cloth's points somewhere else, at rest [m].
  void SetPositions(int cloth, std::span<const Vec3> positions);
  /// Pairs within 2 * thickness that the last step's spatial map did not bring together, and pairs
  /// that it brought together from different boxes; for the table of hash functions.
  struct PairCount {
    std::int64_t found = 0, missed = 0, falseNeighbours = 0;
  };
  PairCount CountPairs() const;

 private:
  struct PointMass {
    Vec3 start, position, previous, force;
    bool pinned = false;
    int cloth = 0;
  };
  enum class Kind { Structural, Shearing, Bending };
  struct Spring {
    PointMass* a;
    PointMass* b;
    double restLength;
    Kind kind;
    int cloth;
  };

  void BuildCloth(int cloth);
  void Step();
  void MovePins();
  void ApplyForces();
  void ApplyWind();
  void Integrate();
  void BuildSpatialMap();
  void SelfCollide(PointMass& point);
  void CollideWithSphere(PointMass& point, const SphereSettings& sphere);
  void CollideWithPlane(PointMass& point, const PlaneSettings& plane);
  void LimitStrain();

  std::uint64_t Hash(const Vec3& position) const;
  double Mass(int cloth) const;
  PointMass& At(int cloth, int i, int j);

  Scene scene_;
  std::vector<PointMass> points_;
  std::vector<std::size_t> firstPoint_;  // per cloth
  std::vector<Spring> springs_;
  std::unordered_map<std::uint64_t, std::vector<PointMass*>> map_;
  double time_ = 0;  // at the end of the step [s]
  double dt_;
};

}  // namespace percale::bench
