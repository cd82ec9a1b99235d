#include "apps/viewer/hand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "apps/viewer/hand_tools.h"
#include "apps/viewer/session.h"
#include "collide/poses.h"
#include "mesh/vertex_cache.h"
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
/// A collider goes at most so far in a frame of the simulation [m]: where frames take long the hand is far ahead, and
/// what jumps after it would tear at the cloth and make frames longer still. Its next move waits for that frame.
constexpr double kColliderLead = 0.05;
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

/// Where the ray meets a collider, a solid or a mesh, as it is at `time` [s].
std::optional<double> MeetCollider(const Ray& ray, const Scene& scene, int index, double time) {
  const ColliderSettings& collider = scene.colliders[static_cast<std::size_t>(index)];
  const Pose pose = PoseOf(scene, index, time);
  const Ray local{ToLocal(pose, ray.origin), TransposedTimes(pose.rotation, ray.direction)};
  if (collider.shape == ColliderShape::Mesh) {
    if (!collider.loaded) return std::nullopt;
    std::vector<Vec3> positions(collider.loaded->mesh.positions.size());
    PlaceVertices(scene, collider, time, positions);
    const auto hit = PickCloth(local, positions, collider.loaded->mesh.triangles);
    return hit ? std::optional(hit->distance) : std::nullopt;
  }
  // As far as the distance at each place is free (Hart 1996, "Sphere tracing").
  constexpr int kMostSteps = 200;
  constexpr double kTouch = 1e-5, kFarthest = 1e3;  // [m]
  const Solid solid = MakeSolid(collider);
  double t = 0;
  for (int step = 0; step < kMostSteps && t < kFarthest; ++step) {
    const double free = DistanceTo(solid, local.origin + local.direction * t).distance;
    if (free < kTouch) return t > 0 ? std::optional(t) : std::nullopt;
    t += free;
  }
  return std::nullopt;
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

/// Whether it is an endless plane, by whichever key.
bool IsPlane(const ColliderRef& collider, const Scene& scene) {
  const auto i = static_cast<std::size_t>(collider.index);
  return collider.group == "plane" ||
         (collider.group == "collider" && scene.colliders[i].shape == ColliderShape::Plane);
}

/// The normal of what IsPlane.
Vec3 NormalOf(const ColliderRef& plane, const Session& session) {
  const auto i = static_cast<std::size_t>(plane.index);
  if (plane.group == "plane") return UnitOr(session.scene().planes[i].normal, {0, 1, 0});
  return Times(PoseOf(session.scene(), plane.index, session.snapshot().report.time).rotation, {0, 1, 0});
}

/// Where it is in the picture, carried by its motions.
Vec3 PlaceOf(const ColliderRef& collider, const Session& session) {
  const Scene& scene = session.scene();
  const auto i = static_cast<std::size_t>(collider.index);
  if (collider.group == "sphere") return scene.spheres[i].origin;
  if (collider.group == "plane") return scene.planes[i].point;
  return PoseOf(scene, collider.index, session.snapshot().report.time).position;
}

/// The value of the parameter that puts it at `place` in the picture.
Vec3 SettingOf(const ColliderRef& collider, const Session& session, const Vec3& place) {
  if (collider.group != "collider") return place;
  // Its motions turn and shift its position: a pose, which is undone.
  const Scene& scene = session.scene();
  Scene alone;
  alone.colliders.resize(1);
  for (const ColliderMotion& motion : scene.colliderMotions) {
    if (motion.collider != collider.index) continue;
    alone.colliderMotions.push_back(motion);
    alone.colliderMotions.back().collider = 0;
  }
  const auto carried = [&](const Vec3& position) {
    alone.colliders[0].position = position;
    return PoseOf(alone, 0, session.snapshot().report.time).position;
  };
  const Vec3 origin = carried({}), way = place - origin;
  return {Dot(way, carried({1, 0, 0}) - origin), Dot(way, carried({0, 1, 0}) - origin),
          Dot(way, carried({0, 0, 1}) - origin)};
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
  gizmo.centre = PlaceOf(collider, session);
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
    GripCollider(*selected, axis_, ray, PlaceOf(*selected, session), session);
    return;
  }
  if (isLeft && event.shift) {
    PressOnThings(ray, event, session);
    return;
  }
  grip_ = !isLeft || event.control ? Grip::Pan : Grip::Orbit;
}

/// The nearest of what the pointer is over: cloth or collider.
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
  const auto considerPlane = [&](const ColliderRef& plane) {
    const Vec3 point = PlaceOf(plane, session);
    const auto at = MeetPlane(ray, point, NormalOf(plane, session));
    if (at && Length(*at - point) <= kDrawnPlane * std::sqrt(2.0)) consider(plane, *at);
  };
  for (std::size_t i = 0; i < scene.planes.size(); ++i) considerPlane({"plane", static_cast<int>(i)});
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const ColliderRef ref{"collider", static_cast<int>(i)};
    if (IsPlane(ref, scene)) {
      considerPlane(ref);
    } else if (const auto t = MeetCollider(ray, scene, ref.index, snapshot.report.time)) {
      consider(ref, ray.origin + ray.direction * *t);
    }
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
  goal_.reset();
  session.HoldChanges(true);
  selected_ = collider;
  axis_ = axis;
  held_ = PlaceOf(collider, session);
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

/// Along the axis of the gizmo; else in the plane of the picture, a plane along its normal.
void Hand::MoveCollider(const Ray& ray, Session& session) {
  const auto selected = Selected(session);
  if (!selected) return;
  Vec3 place = held_;
  if (axis_ >= 0) {
    place += kAxes[axis_] * (AlongLine(ray, held_, kAxes[axis_]) - Dot(grabbed_ - held_, kAxes[axis_]));
  } else if (IsPlane(*selected, session.scene())) {
    const Vec3 normal = NormalOf(*selected, session);
    place += normal * AlongLine(ray, grabbed_, normal);
  } else {
    const auto at = MeetPlane(ray, grabbed_, facing_);
    if (!at) return;
    place += *at - grabbed_;
  }
  goal_ = place;
  Follow(session);
}

void Hand::Follow(Session& session) {
  const auto selected = Selected(session);
  if (!selected || !goal_) return;
  Vec3 place = *goal_;
  if (session.playback().running()) {
    if (!session.playback().caughtUp()) return;
    place = Towards(PlaceOf(*selected, session), place, kColliderLead);
  }
  if (place == *goal_) goal_.reset();
  const char* const name = selected->group == "sphere" ? "origin" : selected->group == "plane" ? "point" : "position";
  session.SetParameter(*FindParameter(selected->group, name), selected->index, SettingOf(*selected, session, place));
}

void Hand::Release(Session& session) {
  const Grip grip = std::exchange(grip_, Grip::None);
  if (grip == Grip::MaybePin) session.TogglePin(cloth_, vertex_);
  if (grip == Grip::Cloth) session.LetGo();
  if (grip == Grip::Collider) session.HoldChanges(false);
}

}  // namespace percale::viewer
