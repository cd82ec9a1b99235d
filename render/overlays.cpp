#include "render/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "mesh/cloth_model.h"
#include "render/heat_scale.h"
#include "render/scene_view.h"
#include "world/measure.h"

namespace percale {
namespace {

constexpr OverlayInfo kOverlays[] = {
    {"normals", "Normals", "The direction in which each vertex faces", &Overlays::normals},
    {"pins", "Pins", "Points that are held", &Overlays::pins},
    {"contacts", "Contacts",
     "Fabric: what presses cloth, as arrows, green where it sticks and vermilion where it slides. Springs: lines "
     "between points of cloth that touch, dots where a point touches a collider",
     &Overlays::contacts},
    {"cones", "Friction cones",
     "Fabric: the cone that the force of a contact must lie in, and that force: on the cone's side, it slides",
     &Overlays::cones},
    {"boxes", "Boxes", "The boxes of the spatial map that hold more than one point, brighter the more they hold",
     &Overlays::boxes},
};

// Of Okabe and Ito, apart from those of the boxes.
constexpr Rgb kNormalColor{0.337f, 0.706f, 0.914f};
constexpr Rgb kPinColor{0.902f, 0.624f, 0};
constexpr Rgb kPairColor = kContactColors[1], kColliderColor = kContactColors[2];
constexpr Rgb kRopeColor{0.55f, 0.43f, 0.3f};
constexpr int kRopePieces = 16;
constexpr float kPinSize = 9, kContactSize = 5;  // [pixel]
constexpr Rgb kForceColor{0.1f, 0.1f, 0.1f};
constexpr std::uint8_t kGlass = 80;  // of 255
constexpr int kArrowSides = 8, kConeSides = 24;
// Of an arrow, in widths of its shaft, and the shortest that is drawn; its head takes at most so much of its length.
constexpr double kHeadWidth = 3, kHeadLength = 5, kLeastLength = 1.5, kMostHead = 0.6;
constexpr double kManyPoints = 64;  // that make a box as bright as can be

Mark At(const Vec3& p, const Rgb& color, float size = 1) {
  Mark mark;
  mark.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  for (std::size_t k = 0; k < 3; ++k) mark.color[k] = static_cast<std::uint8_t>(std::lround(255 * color[k]));
  mark.size = size;
  return mark;
}

Rgb Shaded(const Rgb& color, const Vec3& at, const Vec3& normal, const Vec3& eye) {
  const float facing = static_cast<float>(std::abs(Dot(normal, UnitOr(eye - at, {0, 0, 1}))));
  const float light = 0.6f + 0.4f * facing;
  return {color[0] * light, color[1] * light, color[2] * light};
}

/// Directions all around an axis, at right angles to it.
template <int kSides>
std::array<Vec3, kSides + 1> Around(const Vec3& axis) {
  const Vec3 side = UnitOr(Cross(axis, std::abs(axis.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}), {0, 0, 1});
  const Vec3 other = Cross(axis, side);
  std::array<Vec3, kSides + 1> directions;
  for (int k = 0; k <= kSides; ++k) {
    const double angle = 2 * std::numbers::pi * (k % kSides) / kSides;
    directions[static_cast<std::size_t>(k)] = side * std::cos(angle) + other * std::sin(angle);
  }
  return directions;
}

/// A body that turns about the way from `foot` by `along`, as wide as two radii at its ends.
void AddTaper(const Vec3& foot, const Vec3& along, double radius, double endRadius, const Rgb& color, const Vec3& eye,
              Marks& marks) {
  const auto around = Around<kArrowSides>(UnitOr(along, {0, 1, 0}));
  for (std::size_t k = 0; k < kArrowSides; ++k) {
    const Vec3 &u = around[k], &v = around[k + 1];
    const Mark a = At(foot + u * radius, Shaded(color, foot, u, eye));
    const Mark b = At(foot + v * radius, Shaded(color, foot, v, eye));
    const Mark c = At(foot + along + u * endRadius, Shaded(color, foot, u, eye));
    const Mark d = At(foot + along + v * endRadius, Shaded(color, foot, v, eye));
    for (const Mark& corner : {a, b, d, a, d, c}) marks.triangles.push_back(corner);
  }
}

void AddArrow(const Vec3& foot, const Vec3& way, const Rgb& color, const ArrowScale& scale, Marks& marks) {
  const double length = Length(way), head = std::min(kHeadLength * scale.width, kMostHead * length);
  if (length < kLeastLength * scale.width) return;
  const Vec3 neck = way * (1 - head / length);
  const double narrow = std::min(1.0, length / (kHeadLength * scale.width));  // short ones are thin as well
  AddTaper(foot, neck, 0.5 * narrow * scale.width, 0.5 * narrow * scale.width, color, scale.eye, marks);
  AddTaper(foot + neck, way - neck, 0.5 * narrow * kHeadWidth * scale.width, 0, color, scale.eye, marks);
}

const Rgb& ColorOf(const ContactForce& contact) {
  return contact.slides ? kSlideColor : kStickColor;
}

}  // namespace

std::span<const OverlayInfo> AllOverlays() {
  return kOverlays;
}

void AddNormals(const DrawMesh& mesh, double length, Marks& marks) {
  for (std::size_t v = 0; v < mesh.VertexCount(); ++v) {
    const float *p = &mesh.positions[3 * v], *n = &mesh.normals[4 * v];
    const Vec3 foot{p[0], p[1], p[2]}, along{n[0], n[1], n[2]};
    marks.lines.push_back(At(foot, kNormalColor));
    marks.lines.push_back(At(foot + length * along, kNormalColor));
  }
}

void AddPins(const ClothShape& cloth, Marks& marks) {
  for (const std::int32_t pin : cloth.pinned)
    marks.points.push_back(At(cloth.positions[static_cast<std::size_t>(pin)], kPinColor, kPinSize));
}

void AddTethers(const Scene& scene, std::span<const ClothShape> cloths, Marks& marks) {
  const Vec3& gravity = scene.simulation.gravity;
  const double g = Length(gravity);
  const Vec3 down = g > 0 ? gravity / g : Vec3{};
  for (const Tether& tether : scene.tethers) {
    const auto cloth = static_cast<std::size_t>(tether.cloth);
    for (const GridPoint& point : tether.points) {
      const auto vertex = VertexOf(scene.cloths[cloth], point);
      if (!vertex) continue;
      const Vec3 from = cloths[cloth].positions[static_cast<std::size_t>(*vertex)], way = tether.anchor - from;
      const double across = Length(way), slack = std::max(tether.length - across, 0.0);
      // A flat parabola over a way d that hangs through by s is d + 8 s^2 / 3 d long; upright it hangs by half.
      const double sag = std::min(std::sqrt(0.375 * across * slack) + 0.5 * slack, 0.5 * tether.length);
      const int pieces = slack > 0 ? kRopePieces : 1;
      const auto at = [&](int k) {
        const double t = static_cast<double>(k) / pieces;
        return At(from + t * way + 4 * sag * t * (1 - t) * down, kRopeColor);
      };
      for (int k = 0; k < pieces; ++k) {
        marks.lines.push_back(at(k));
        marks.lines.push_back(at(k + 1));
      }
    }
  }
}

void AddContacts(std::span<const ClothShape> cloths, const ContactFinder& contacts, Marks& marks) {
  const auto position = [&](const VertexRef& ref) {
    return cloths[static_cast<std::size_t>(ref.cloth)].positions[static_cast<std::size_t>(ref.vertex)];
  };
  for (const ContactPair& pair : contacts.pairs()) {
    marks.lines.push_back(At(position(pair.a), kPairColor));
    marks.lines.push_back(At(position(pair.b), kPairColor));
  }
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const std::span<const Contact> found = contacts.Of(static_cast<int>(c));
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (found[v] == Contact::Collider)
        marks.points.push_back(At(cloths[c].positions[v], kColliderColor, kContactSize));
    }
  }
}

std::vector<ContactForce> MergeContacts(std::span<const ClothShape> cloths, std::span<const ContactForce> contacts,
                                        double size) {
  struct Member {
    std::array<std::int64_t, 5> patch;  // cloth, what is on the other side, and where the cloth started
    double off;                         // from the middle of the patch, squared, in its widths
    ContactForce contact;
  };
  std::vector<Member> members;
  const auto add = [&](const ContactForce& contact) {
    const auto cloth = static_cast<std::size_t>(contact.cloth), vertex = static_cast<std::size_t>(contact.vertex);
    if (cloth >= cloths.size() || vertex >= cloths[cloth].rest.size()) return;
    const Vec3 at = cloths[cloth].rest[vertex] / size;
    const Vec3 cell{std::floor(at.x), std::floor(at.y), std::floor(at.z)};
    const Vec3 off = at - cell - Vec3{0.5, 0.5, 0.5};
    members.push_back({{contact.cloth, contact.otherCloth, static_cast<std::int64_t>(cell.x),
                        static_cast<std::int64_t>(cell.y), static_cast<std::int64_t>(cell.z)},
                       Dot(off, off),
                       contact});
  };
  for (const ContactForce& contact : contacts) {
    add(contact);
    if (contact.otherCloth < 0) continue;
    ContactForce other = contact;
    std::swap(other.cloth, other.otherCloth);
    std::swap(other.vertex, other.otherVertex);
    other.normal = -contact.normal;
    other.friction = -contact.friction;
    add(other);
  }
  std::stable_sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.patch < b.patch; });
  std::vector<ContactForce> merged;
  for (auto first = members.begin(); first != members.end();) {
    const auto end = std::find_if(first, members.end(), [&](const Member& m) { return m.patch != first->patch; });
    for (const bool along : {true, false}) {
      const Member* middle = nullptr;
      ContactForce sum;
      Vec3 pressing;
      double all = 0, sliding = 0;
      for (auto member = first; member != end; ++member) {
        const ContactForce& contact = member->contact;
        if ((Dot(contact.normal, first->contact.normal) >= 0) != along) continue;
        if (!middle || member->off < middle->off) middle = &*member;
        pressing += contact.normal * contact.force;
        sum.friction += contact.friction;
        sum.coefficient += contact.coefficient * contact.force;
        all += contact.force;
        sliding += contact.slides ? contact.force : 0;
      }
      if (!(all > 0)) continue;
      ContactForce& one = merged.emplace_back(middle->contact);
      one.force = Length(pressing);
      one.normal = UnitOr(pressing, one.normal);
      one.friction = sum.friction;
      one.coefficient = sum.coefficient / all;
      one.slides = sliding > 0.5 * all;
    }
    first = end;
  }
  return merged;
}

void AddForces(std::span<const ContactForce> contacts, const ArrowScale& scale, Marks& marks) {
  for (const ContactForce& contact : contacts) {
    marks.points.push_back(At(contact.point, ColorOf(contact), kContactSize));
    AddArrow(contact.point, contact.normal * (contact.force / scale.force * scale.length), ColorOf(contact), scale,
             marks);
  }
}

void AddCones(std::span<const ContactForce> contacts, const ArrowScale& scale, Marks& marks) {
  for (const ContactForce& contact : contacts) {
    marks.points.push_back(At(contact.point, ColorOf(contact), kContactSize));
    const double height = std::sqrt(contact.force / scale.force) * scale.length, radius = contact.coefficient * height;
    if (height < kLeastLength * scale.width) continue;
    const Vec3 centre = contact.point + contact.normal * height;
    const auto around = Around<kConeSides>(contact.normal);
    for (std::size_t k = 0; k < kConeSides; ++k) {
      const Mark a = At(centre + around[k] * radius, ColorOf(contact));
      const Mark b = At(centre + around[k + 1] * radius, ColorOf(contact));
      marks.lines.push_back(a);
      marks.lines.push_back(b);
      for (Mark corner : {At(contact.point, ColorOf(contact)), a, b}) {
        corner.color[3] = kGlass;
        marks.glass.push_back(corner);
      }
    }
    AddArrow(contact.point, contact.Total() * (height / contact.force), kForceColor, scale, marks);
  }
}

void AddBoxes(const BoxFinder& boxes, Marks& marks) {
  const Vec3& size = boxes.size();
  for (const SharedBox& box : boxes.boxes()) {
    const Rgb color = HeatColor(std::log(box.points) / std::log(kManyPoints));
    const auto corner = [&](int k) {
      return At(box.corner + Vec3{k & 1 ? size.x : 0, k & 2 ? size.y : 0, k & 4 ? size.z : 0}, color);
    };
    for (int a = 0; a < 8; ++a) {
      for (const int axis : {1, 2, 4}) {
        if (a & axis) continue;
        marks.lines.push_back(corner(a));
        marks.lines.push_back(corner(a | axis));
      }
    }
  }
}

}  // namespace percale
