#pragma once
/// \file
/// The camera: it looks at a target from a distance, and is turned, shifted and brought nearer by
/// the mouse in the course's steps.

#include "percale/scene.h"
#include "render/mat4.h"

namespace percale {

class OrbitCamera {
 public:
  OrbitCamera() = default;

  /// The camera that a scene starts with: as its settings say, or when they are automatic, the
  /// course's, which follows from the cloths at the start: target (mean x, mean y / 2, mean z),
  /// distance 1.8 times the larger extent, looking along -z. With several cloths the mean is over
  /// all points, the extent that of all cloths together.
  static OrbitCamera ForScene(const Scene& scene);

  /// Left drag by (dx, dy) pixels, y growing downwards, in a window of that size: half a turn for a
  /// full width or height. The elevation stays within +-89 degrees.
  void Orbit(double dx, double dy, int width, int height);
  /// Right drag: shifts eye and target in the plane of the picture.
  void Pan(double dx, double dy, int width, int height);
  /// Wheel: `steps` > 0 brings the eye nearer, 0.09 times the scene's extent each, down to 0.09 and
  /// up to 18 times the extent.
  void Dolly(double steps);

  /// Clip space from world space, for a picture of that size [pixel, >= 1]. The field of view is
  /// 35 degrees vertical and 50 horizontal, one of them widened to the shape of the picture.
  Mat4 ViewProjection(int width, int height) const;
  /// Vertical field of view for a picture of that size [rad].
  static double VerticalAngle(int width, int height);

  Vec3 position() const;                           ///< Of the eye [m].
  const Vec3& target() const { return target_; }   ///< Point looked at [m].
  double distance() const { return distance_; }    ///< Eye to target [m].
  double azimuth() const { return azimuth_; }      ///< Turn about +y [degree].
  double elevation() const { return elevation_; }  ///< Above the horizon [degree].
  Vec3 right() const;                              ///< Unit vector to the right of the picture.
  Vec3 up() const;                                 ///< Unit vector to the top of the picture.

  /// Where the ray through the middle of pixel (x, y), from the top left, points: a unit vector.
  Vec3 Ray(double x, double y, int width, int height) const;

  /// The same view as settings of a scene (automatic = false).
  CameraSettings Settings() const;

 private:
  Vec3 target_{0.5, 0.5, 0.5};
  double distance_ = 1.8;
  double azimuth_ = 0;
  double elevation_ = 0;
  double extent_ = 1;  // Of the scene's cloths [m]: the measure of steps and limits.
};

}  // namespace percale
