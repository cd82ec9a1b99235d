#include "apps/viewer/hand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/viewer/session.h"
#include "percale/parameters.h"

namespace percale::viewer {
namespace {

/// A press that moves no farther is a click [screen unit].
constexpr double kClickSlack = 4;
/// So near to an arrow of the gizmo counts as on it [screen unit].
constexpr double kArrowSlack = 7;
/// Length of the gizmo's arrows [screen unit].
constexpr double kArrowLength = 70;
/// Half the edge of the square that stands for a plane in the picture [m].
constexpr double kDrawnPlane = 2;
constexpr Vec3 kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Ray PointerRay(const Session& session, double x, double y, PictureSize size) {
  const OrbitCamera& camera = session.view().camera;
  return {camera.position(), camera.Ray(x - 0.5, y - 0.5, size.width, size.height)};
}

/// Where the ray meets a plane, in front of the eye.
std::optional<Vec3> MeetPlane(const Ray& ray, const Vec3& point, const Vec3& normal) {
  const double approach = Dot(ray.direction, normal);
  if (std::abs(approach) < 1e-9) return std::nullopt;
  const double t = Dot(point - ray.origin, normal) / approach;
  if (t <= 0) return std::nullopt;
  return ray.origin + ray.direction * t;
}

std::optional<double> MeetSphere(const Ray& ray, const Vec3& centre, double radius) {
  const Vec3 d = ray.origin - centre;
  const double half = Dot(d, ray.direction);
  const double square = half * half - Dot(d, d) + radius * radius;
  if (square < 0) return std::nullopt;
  const double t = -half - std::sqrt(square);
  return t > 0 ? std::optional(t) : std::nullopt;
}

/// How far along the line through `point` the ray comes nearest to it [m].
double AlongLine(const Ray& ray, const Vec3& point, const Vec3& axis) {
  const double b = Dot(ray.direction, axis);
  const Vec3 d = point - ray.origin;
  const double denominator = 1 - b * b;
  if (denominator < 1e-6) return 0;  // one looks along the axis
  return (b * Dot(d, ray.direction) - Dot(d, axis)) / denominator;
}

double DistanceToSegment(double x, double y, double ax, double ay, double bx, double by) {
  const double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(x - ax - t * dx, y - ay - t * dy);
}

const Vec3& PlaceOf(const ColliderRef& collider, const Scene& scene) {
  const auto i = static_cast<std::size_t>(collider.index);
  return collider.group == "sphere" ? scene.spheres[i].origin : scene.planes[i].point;
}

}  // namespace

std::optional<ColliderRef> Hand::Selected(const Session& session) const {
  if (!selected_) return std::nullopt;
  const std::size_t count = FindGroup(selected_->group)->count(session.scene());
  return static_cast<std::size_t>(selected_->index) < count ? selected_ : std::nullopt;
}

std::optional<Gizmo> GizmoOf(const ColliderRef& collider, const Session& session, PictureSize size) {
  const OrbitCamera& camera = session.view().camera;
  Gizmo gizmo;
  gizmo.centre = PlaceOf(collider, session.scene());
  const double depth = Dot(gizmo.centre - camera.position(), UnitOr(camera.target() - camera.position(), {0, 0, -1}));
  if (depth <= 0.02) return std::nullopt;
  const double unitsPerMetre =
      size.height / (2 * std::tan(OrbitCamera::VerticalAngle(size.width, size.height) / 2) * depth);
  gizmo.length = kArrowLength / unitsPerMetre;
  const Mat4 clip = camera.ViewProjection(size.width, size.height);
  for (int k = 0; k < 4; ++k) {
    const Vec3 p = TransformPoint(clip, k == 0 ? gizmo.centre : gizmo.centre + gizmo.length * kAxes[k - 1]);
    gizmo.x[k] = (p.x + 1) / 2 * size.width;
    gizmo.y[k] = (1 - p.y) / 2 * size.height;
  }
  return gizmo;
}

void Hand::Take(const InputEvent& event, bool inPicture, PictureSize size, Session& session) {
  switch (event.kind) {
    case InputEvent::Kind::Press:
      if (!inPicture || grip_ != Grip::None) return;
      button_ = event.button;
      x_ = pressX_ = event.x;
      y_ = pressY_ = event.y;
      Press(event, size, session);
      return;
    case InputEvent::Kind::Release:
      if (grip_ != Grip::None && button_ == event.button) Release(session);
      return;
    case InputEvent::Kind::Move:
      if (event.x == x_ && event.y == y_) return;
      Move(event, size, session);
      x_ = event.x;
      y_ = event.y;
      return;
    case InputEvent::Kind::Wheel:
      if (inPicture && event.steps != 0) session.liveView().Dolly(event.steps);
      return;
    default:
      return;
  }
}

void Hand::Press(const InputEvent& event, PictureSize size, Session& session) {
  const bool isLeft = event.button == InputEvent::Button::Left;
  const Ray ray = PointerRay(session, event.x, event.y, size);
  if (const auto selected = Selected(session); isLeft && selected && axis_ >= 0) {
    GripCollider(*selected, axis_, ray, PlaceOf(*selected, session.scene()), session);
    return;
  }
  if (isLeft && event.shift) {
    PressOnThings(ray, event, session);
    return;
  }
  grip_ = !isLeft || event.control ? Grip::Pan : Grip::Orbit;
}

/// The nearest of what the pointer is over: cloth, sphere or plane.
void Hand::PressOnThings(const Ray& ray, const InputEvent&, Session& session) {
  double nearest = std::numeric_limits<double>::infinity();
  const Snapshot& snapshot = session.snapshot();
  std::optional<ColliderRef> collider;
  const Scene& scene = session.scene();
  for (std::size_t c = 0; c < snapshot.cloths.size(); ++c) {
    const ClothCopy& cloth = snapshot.cloths[c];
    const auto hit = PickCloth(ray, cloth.positions, cloth.topology->triangles);
    if (!hit || hit->distance >= nearest) continue;
    nearest = hit->distance;
    cloth_ = static_cast<int>(c);
    vertex_ = hit->vertex;
    held_ = cloth.positions[static_cast<std::size_t>(hit->vertex)];
    grabbed_ = hit->point;
    grip_ = Grip::MaybePin;
  }
  const auto consider = [&](ColliderRef candidate, const Vec3& at) {
    const double distance = Length(at - ray.origin);
    if (distance >= nearest) return;
    nearest = distance;
    collider = candidate;
    grabbed_ = at;
  };
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    if (const auto t = MeetSphere(ray, scene.spheres[i].origin, scene.spheres[i].radius))
      consider({"sphere", static_cast<int>(i)}, ray.origin + ray.direction * *t);
  }
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const PlaneSettings& plane = scene.planes[i];
    const auto at = MeetPlane(ray, plane.point, UnitOr(plane.normal, {0, 1, 0}));
    if (at && Length(*at - plane.point) <= kDrawnPlane * std::sqrt(2.0)) consider({"plane", static_cast<int>(i)}, *at);
  }
  if (collider) {
    GripCollider(*collider, -1, ray, grabbed_, session);
  } else if (grip_ == Grip::None) {
    selected_.reset();
  } else {
    facing_ = UnitOr(session.view().camera.position() - session.view().camera.target(), {0, 0, 1});
  }
}

void Hand::GripCollider(ColliderRef collider, int axis, const Ray& ray, const Vec3& at, Session& session) {
  grip_ = Grip::Collider;
  session.HoldChanges(true);
  selected_ = collider;
  axis_ = axis;
  held_ = PlaceOf(collider, session.scene());
  grabbed_ = axis >= 0 ? held_ + kAxes[axis] * AlongLine(ray, held_, kAxes[axis]) : at;
  facing_ = UnitOr(session.view().camera.position() - session.view().camera.target(), {0, 0, 1});
}

void Hand::Move(const InputEvent& event, PictureSize size, Session& session) {
  const Ray ray = PointerRay(session, event.x, event.y, size);
  switch (grip_) {
    case Grip::None: {
      axis_ = -1;
      const auto selected = Selected(session);
      const auto gizmo = selected ? GizmoOf(*selected, session, size) : std::nullopt;
      double nearest = kArrowSlack;
      for (int k = 0; gizmo && k < 3; ++k) {
        const double d =
            DistanceToSegment(event.x, event.y, gizmo->x[0], gizmo->y[0], gizmo->x[k + 1], gizmo->y[k + 1]);
        if (d < nearest) {
          nearest = d;
          axis_ = k;
        }
      }
      return;
    }
    case Grip::Orbit:
      session.liveView().Orbit(event.x - x_, event.y - y_, size.width, size.height);
      return;
    case Grip::Pan:
      session.liveView().Pan(event.x - x_, event.y - y_, size.width, size.height);
      return;
    case Grip::MaybePin:
      if (std::hypot(event.x - pressX_, event.y - pressY_) <= kClickSlack) return;
      session.Grip(cloth_, vertex_);
      grip_ = Grip::Cloth;
      [[fallthrough]];
    case Grip::Cloth:
      if (const auto at = MeetPlane(ray, grabbed_, facing_)) session.MoveGrip(held_ + (*at - grabbed_));
      return;
    case Grip::Collider:
      MoveCollider(ray, session);
      return;
  }
}

/// Along the axis of the gizmo; else a sphere in the plane of the picture, a plane along its normal.
void Hand::MoveCollider(const Ray& ray, Session& session) {
  const auto selected = Selected(session);
  if (!selected) return;
  const bool isPlane = selected->group == "plane";
  Vec3 place = held_;
  if (axis_ >= 0) {
    place += kAxes[axis_] * (AlongLine(ray, held_, kAxes[axis_]) - Dot(grabbed_ - held_, kAxes[axis_]));
  } else if (isPlane) {
    const Vec3 normal = UnitOr(session.scene().planes[static_cast<std::size_t>(selected->index)].normal, {0, 1, 0});
    place += normal * AlongLine(ray, grabbed_, normal);
  } else {
    const auto at = MeetPlane(ray, grabbed_, facing_);
    if (!at) return;
    place += *at - grabbed_;
  }
  session.SetParameter(*FindParameter(selected->group, isPlane ? "point" : "origin"), selected->index, place);
}

void Hand::Release(Session& session) {
  const Grip grip = std::exchange(grip_, Grip::None);
  if (grip == Grip::MaybePin) session.TogglePin(cloth_, vertex_);
  if (grip == Grip::Cloth) session.LetGo();
  if (grip == Grip::Collider) session.HoldChanges(false);
}

}  // namespace percale::viewer
