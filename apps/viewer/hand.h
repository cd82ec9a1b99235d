#pragma once
/// \file
/// What the mouse does in the picture: turn the view, drag the cloth, pin it, move colliders.

#include <optional>
#include <string_view>

#include "apps/viewer/window.h"
#include "mesh/pick.h"
#include "percale/vec3.h"

namespace percale::viewer {

class Session;

/// The part of the window that shows the scene [screen unit].
struct PictureSize {
  int width = 1, height = 1;
};

/// A sphere, plane or other collider of the scene.
struct ColliderRef {
  std::string_view group;  ///< "sphere", "plane" or "collider".
  int index = 0;
  friend bool operator==(const ColliderRef&, const ColliderRef&) = default;
};

class Hand {
 public:
  /// Takes what the user did. `inPicture`: the pointer is over the picture, not over a panel.
  void Take(const InputEvent& event, bool inPicture, PictureSize size, Session& session);

  /// Leads a collider on to where it was dragged, as far as it may go in a frame of the simulation. Once per picture.
  void Follow(Session& session);

  /// Something is being dragged that can be undone.
  bool dragging() const { return grip_ == Grip::Cloth || grip_ == Grip::Collider; }
  /// Which collider the gizmo is at, if it still exists.
  std::optional<ColliderRef> Selected(const Session& session) const;
  void Deselect() { selected_.reset(); }
  /// The axis of the gizmo that is dragged or pointed at: 0 x, 1 y, 2 z; -1: none.
  int axis() const { return axis_; }

 private:
  enum class Grip { None, Orbit, Pan, MaybePin, Cloth, Collider };

  void Press(const InputEvent& event, PictureSize size, Session& session);
  void PressOnThings(const Ray& ray, const InputEvent& event, Session& session);
  void GripCollider(ColliderRef collider, int axis, const Ray& ray, const Vec3& at, Session& session);
  void Move(const InputEvent& event, PictureSize size, Session& session);
  void MoveCollider(const Ray& ray, Session& session);
  void Release(Session& session);

  Grip grip_ = Grip::None;
  InputEvent::Button button_ = InputEvent::Button::Left;
  double x_ = 0, y_ = 0;            // Of the pointer [screen unit].
  double pressX_ = 0, pressY_ = 0;  // At the press.

  // What is held: a vertex of a cloth, or a collider, and where.
  int cloth_ = 0, vertex_ = 0;
  Vec3 held_;     // Of the thing, at the press [m].
  Vec3 grabbed_;  // The point under the pointer, at the press [m].
  Vec3 facing_;   // The normal of the plane in which the pointer moves the thing.
  std::optional<ColliderRef> selected_;
  int axis_ = -1;
  std::optional<Vec3> goal_;  // Where the collider is dragged [m], until it is there.
};

/// A gizmo as it stands in the picture: its centre and the ends of its arrows [screen unit].
struct Gizmo {
  Vec3 centre;                  ///< [m]
  double length = 0;            ///< Of an arrow [m].
  double x[4] = {}, y[4] = {};  ///< The centre, then the ends along x, y, z.
};

/// The gizmo of a collider; nothing where it is behind the eye.
std::optional<Gizmo> GizmoOf(const ColliderRef& collider, const Session& session, PictureSize size);

}  // namespace percale::viewer
