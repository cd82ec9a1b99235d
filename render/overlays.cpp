#include "render/overlays.h"

#include <algorithm>
#include <cmath>

#include "mesh/cloth_model.h"
#include "render/heat_scale.h"
#include "render/scene_view.h"
#include "world/measure.h"

namespace percale {
namespace {

constexpr OverlayInfo kOverlays[] = {
    {"normals", "Normals", "The direction in which each vertex faces", &Overlays::normals},
    {"pins", "Pins", "Points that are held", &Overlays::pins},
    {"contacts", "Contacts", "Lines between points of cloth that touch, dots where a point touches a collider",
     &Overlays::contacts},
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
constexpr double kManyPoints = 64;               // that make a box as bright as can be

Mark At(const Vec3& p, const Rgb& color, float size = 1) {
  Mark mark;
  mark.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  for (std::size_t k = 0; k < 3; ++k) mark.color[k] = static_cast<std::uint8_t>(std::lround(255 * color[k]));
  mark.size = size;
  return mark;
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
