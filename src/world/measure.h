#pragma once
/// \file
/// What can be read off cloths as they lie: what heat maps colour, plots draw and inspectors tell. Pure
/// functions of positions over memory of the caller; nothing allocates once its memory is warm.

#include <cstdint>
#include <span>
#include <vector>

#include "collide/boxes.h"
#include "collide/poses.h"
#include "mesh/engine_types.h"
#include "percale/interaction.h"
#include "percale/mesh.h"
#include "percale/scene.h"

namespace percale {

/// Per vertex the greatest and the least length over rest length of the springs that end there; 1 where
/// there is none. `lengths` are those of the springs at rest [m].
void MeasureStretch(std::span<const Vec3> positions, std::span<const Edge> springs, std::span<const double> lengths,
                    std::span<double> greatest, std::span<double> least);

/// Adds the length over rest length of each spring to `ratios`.
void AppendStretch(std::span<const Vec3> positions, std::span<const Edge> springs, std::span<const double> lengths,
                   std::vector<double>& ratios);

/// The smallest of the values that a share 0..1 of them does not exceed: 0.99 gives the 99th percentile.
/// Reorders the values, of which there must be one.
double Percentile(std::span<double> values, double share);

/// Per vertex the length of its velocity [m/s].
void MeasureSpeed(std::span<const Vec3> velocities, std::span<double> speeds);

/// Mean curvature of a surface of triangles.
class CurvatureMeter {
 public:
  /// Per vertex the mean of the two principal curvatures [1/m], > 0 where the surface bulges to the side
  /// that its triangles turn counterclockwise to: half of what the cotangent formula (Meyer, Desbrun,
  /// Schröder and Barr 2003, "Discrete differential-geometry operators for triangulated 2-manifolds",
  /// equation 8) gives along the normal, over a third of the triangles' areas. At the border, where the
  /// formula sees one side alone, what bends across the border counts for nothing.
  void Measure(std::span<const Vec3> positions, std::span<const Triangle> triangles, std::span<double> curvatures);

 private:
  struct Sums {
    Vec3 bend, normal;  // weighted ways from the neighbours [m]; twice the area of the triangles [m^2]
    double area = 0;    // twice that of the triangles [m^2]
  };
  std::vector<Sums> sums_;
};

/// A box of the spatial map that several points share.
struct SharedBox {
  Vec3 corner;  ///< The one with the least coordinates [m].
  int points = 0;
};

/// The boxes in which the springs engine looks for contacts at these positions, one span per cloth.
class BoxFinder {
 public:
  void Find(std::span<const ClothSettings> cloths, std::span<const std::span<const Vec3>> positions);
  const Vec3& size() const { return size_; }  ///< Of each box [m].
  std::span<const SharedBox> boxes() const { return boxes_; }

 private:
  Vec3 size_;
  std::vector<Box> boxOf_;  // per point, sorted
  std::vector<SharedBox> boxes_;
};

/// How a vertex touches.
enum class Contact : std::uint8_t { None, Cloth, Collider };

struct ContactCloth {
  std::span<const Vec3> positions, rest;
  double thickness = 0;  ///< [m]
};
struct ContactPair {
  VertexRef a, b;
};

/// What cloth may touch at `time` [s]: the colliders of the scene that its engine heeds, without meshes, and the balls.
std::vector<PlacedSolid> SolidsAt(const Scene& scene, double time, std::span<const Ball> balls);

/// Who touches whom: a search through all points, apart from the one that simulates.
class ContactFinder {
 public:
  /// Points of cloth touch when they are no farther apart than this times the sum of their thicknesses,
  /// the distance to which they are pushed; ...
  static constexpr double kNearShare = 1.05;
  /// ... unless they belong together: points of one cloth whose distance at rest is less than this times
  /// as large. Those are each other's spring neighbours, or as close.
  static constexpr double kSheetShare = 2.5;
  /// A point touches a collider at this distance from its surface, or from where its thickness ends, on either side
  /// [m]: a point on its way along it is put back a little off.
  static constexpr double kTouchDistance = 2e-3;
  /// No more pairs than these are listed.
  static constexpr std::size_t kMostPairs = 100'000;

  /// `solids`: the colliders, see SolidsAt.
  void Find(std::span<const ContactCloth> cloths, std::span<const PlacedSolid> solids);

  /// Per vertex of a cloth. A collider hides what else it touches.
  std::span<const Contact> Of(int cloth) const;
  /// Pairs of points of cloth, each once.
  std::span<const ContactPair> pairs() const { return pairs_; }

 private:
  VertexRef Ref(std::int32_t point) const;
  void FindPairs(std::span<const ContactCloth> cloths);

  std::vector<Vec3> positions_;           // of all cloths' points
  std::vector<Contact> contacts_;         // per point
  std::vector<std::int32_t> firstPoint_;  // per cloth, and one more
  std::vector<std::uint64_t> cells_;      // per point: the box of space that it is in
  std::vector<std::uint64_t> taken_;      // bits by mixed cell, set where there are points: in the cache, unlike those
  std::vector<std::int32_t> slotBegin_;   // per slot of the table of cells: its first entry in members_
  std::vector<std::int32_t> members_;     // points by slot, ascending
  std::vector<ContactPair> pairs_;
};

/// The same of one point alone, by comparing it with all others: how many points of cloth, and how many
/// colliders, it touches.
struct ContactCount {
  int cloth = 0, colliders = 0;
};
ContactCount CountContacts(const VertexRef& point, std::span<const ContactCloth> cloths,
                           std::span<const PlacedSolid> solids);

}  // namespace percale
