#pragma once
/// \file
/// What can be drawn over a picture to see what the simulation is about: normals, pins, contacts and their forces, the
/// boxes of the spatial map; and the ropes of a scene. All are coloured lines, points and triangles.

#include <span>
#include <string_view>
#include <vector>

#include "percale/contacts.h"
#include "percale/scene.h"
#include "percale/vec3.h"
#include "render/draw_list.h"

namespace percale {

struct ClothShape;
class BoxFinder;
class ContactFinder;

struct Overlays {
  bool normals = false;   ///< Of the vertices.
  bool pins = false;      ///< Points that are held.
  bool contacts = false;  ///< Between points of cloth, and with colliders; Engine::Fabric: their forces.
  bool cones = false;     ///< Of friction, Engine::Fabric.
  bool boxes = false;     ///< Of the spatial map, where several points share one; Engine::Springs.

  bool Any() const { return normals || pins || contacts || cones || boxes; }
  friend bool operator==(const Overlays&, const Overlays&) = default;
};

struct OverlayInfo {
  std::string_view name;   ///< On the command line: "normals".
  std::string_view label;  ///< "Normals".
  std::string_view help;
  bool Overlays::*shown;
};
/// In the order in which they are listed to people.
std::span<const OverlayInfo> AllOverlays();

/// A line of that length [m] from each vertex along its normal.
void AddNormals(const DrawMesh& mesh, double length, Marks& marks);
/// A dot on each pin.
void AddPins(const ClothShape& cloth, Marks& marks);
/// A rope from each point of the tethers to its anchor: straight where it is taut, else hanging through, a parabola
/// of about its length.
void AddTethers(const Scene& scene, std::span<const ClothShape> cloths, Marks& marks);
/// A line between two points of cloth that touch, a dot where a point touches a collider.
void AddContacts(std::span<const ClothShape> cloths, const ContactFinder& contacts, Marks& marks);
/// Adds up the contacts on each patch of cloth, some `size` [m] wide where it started: an arrow each for a picture that
/// can be read. Those of one patch that push to opposite sides stay apart; where cloth touches cloth, both sides have
/// one. The point is that of the contact next to the patch's middle.
std::vector<ContactForce> MergeContacts(std::span<const ClothShape> cloths, std::span<const ContactForce> contacts,
                                        double size);

/// How forces become lengths, and how thick that is.
struct ArrowScale {
  double force = 1;   ///< Of the longest arrow [N].
  double length = 0;  ///< Of that [m].
  double width = 0;   ///< Of a shaft [m].
  Vec3 eye;           ///< What is turned to it is brighter.
};
/// What sticks is green, what slides vermilion.
inline constexpr Rgb kStickColor{0, 0.62f, 0.451f}, kSlideColor{0.835f, 0.369f, 0};
/// A dot on each contact, and an arrow along its normal, as long as the force that presses.
void AddForces(std::span<const ContactForce> contacts, const ArrowScale& scale, Marks& marks);
/// Of each contact the cone, seen through, that its force must lie in, and that force. They grow with the root of the
/// force: their shape does not depend on it, and small ones can be read.
void AddCones(std::span<const ContactForce> contacts, const ArrowScale& scale, Marks& marks);
/// The edges of each box, brighter the more points are in it.
void AddBoxes(const BoxFinder& boxes, Marks& marks);

}  // namespace percale
