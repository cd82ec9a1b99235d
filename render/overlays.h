#pragma once
/// \file
/// What can be drawn over a picture to see what the simulation is about: normals, pins, contacts, the
/// boxes of the spatial map; and the ropes of a scene. All are coloured lines and points.

#include <span>
#include <string_view>

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
  bool contacts = false;  ///< Between points of cloth, and with colliders.
  bool boxes = false;     ///< Of the spatial map, where several points share one.

  bool Any() const { return normals || pins || contacts || boxes; }
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
/// The edges of each box, brighter the more points are in it.
void AddBoxes(const BoxFinder& boxes, Marks& marks);

}  // namespace percale
