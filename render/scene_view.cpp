#include "render/scene_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "collide/poses.h"
#include "mesh/vertex_cache.h"
#include "render/heat_map.h"

namespace percale {
namespace {

constexpr double kWidestLight = 0.98;  // Sine of half the angle that a shadow map covers.
constexpr Color kPlaneColor{0.7f, 0.7f, 0.7f, 1};
constexpr Color kOverlayColor{0.08f, 0.08f, 0.08f, 1};
// Of the camera's distance, so that they look as large from anywhere: normals; patches of cloth whose contacts are
// one arrow, and how long and wide that is; the same of cones.
constexpr double kNormalLength = 0.015;
constexpr double kPatch = 0.03, kLongestArrow = 0.07, kArrowWidth = 0.0025;
constexpr double kConePatch = 0.08, kLongestCone = 0.1;
constexpr double kLeastForce = 1e-6;  // that has the longest arrow [N]

Color Times(const Color& a, const Vec3& b) {
  return {a[0] * float(b.x), a[1] * float(b.y), a[2] * float(b.z), a[3]};
}

// One cloth's mesh and what it was made of.
struct ClothMesh {
  std::shared_ptr<DrawMesh> mesh = std::make_shared<DrawMesh>();
  std::vector<Triangle> triangles;
  std::vector<Vec2> uv;
};

// Copies `from` into `to`; returns whether that changed anything.
template <class T>
bool Replace(std::vector<T>& to, std::span<const T> from) {
  if (to.size() == from.size() && (from.empty() || std::memcmp(to.data(), from.data(), from.size_bytes()) == 0))
    return false;
  to.assign(from.begin(), from.end());
  return true;
}

void Update(ClothMesh& cloth, const ClothShape& shape, Tangents tangents) {
  DrawMesh& mesh = *cloth.mesh;
  const std::size_t count = shape.positions.size();
  assert(shape.uv.size() == count);
  bool isOther = mesh.VertexCount() != count;
  mesh.positions.resize(count * 3);
  mesh.normals.resize(count * 4);
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions[3 * i + 0] = static_cast<float>(shape.positions[i].x);
    mesh.positions[3 * i + 1] = static_cast<float>(shape.positions[i].y);
    mesh.positions[3 * i + 2] = static_cast<float>(shape.positions[i].z);
  }
  if (Replace(cloth.uv, shape.uv)) {
    isOther = true;
    mesh.uv.clear();
    for (const Vec2& uv : shape.uv) mesh.uv.insert(mesh.uv.end(), {float(uv.x), float(uv.y)});
  }
  static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t) && sizeof(Edge) == 2 * sizeof(std::uint32_t));
  if (Replace(cloth.triangles, shape.triangles)) {
    isOther = true;
    mesh.triangles.resize(shape.triangles.size() * 3);
    if (!shape.triangles.empty())
      std::memcpy(mesh.triangles.data(), shape.triangles.data(), shape.triangles.size_bytes());
  }
  const auto* lines = reinterpret_cast<const std::uint32_t*>(shape.springs.data());
  isOther |= Replace(mesh.lines, std::span<const std::uint32_t>(lines, shape.springs.size() * 2));

  ComputeNormals(mesh.positions, shape.triangles, mesh.normals);
  if (tangents == Tangents::FromUv) {
    mesh.tangents.resize(count * 4);
    ComputeTangents(mesh.positions, shape.uv, mesh.normals, shape.triangles, mesh.tangents);
  } else {
    mesh.tangents.assign(count * 4, 0);
    for (std::size_t i = 0; i < count; ++i) mesh.tangents[4 * i] = 1;
  }
  mesh.shapeVersion += 1;
  if (isOther) mesh.meshVersion += 1;
}

struct Bounds {
  Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};

  void Add(const Vec3& a, const Vec3& b) {
    low = {std::min(low.x, a.x), std::min(low.y, a.y), std::min(low.z, a.z)};
    high = {std::max(high.x, b.x), std::max(high.y, b.y), std::max(high.z, b.z)};
  }
};

// A collider's mesh and what it was made of.
struct ColliderMesh {
  std::shared_ptr<DrawMesh> mesh;
  ColliderSettings settings;
  int latitudes = 0, longitudes = 0;
  Vec3 low, high;              // Its box, in the collider's frame.
  std::vector<Vec3> vertices;  // Of a mesh with a cache, as drawn.
};

bool SameSurface(const ColliderSettings& a, const ColliderSettings& b) {
  return a.shape == b.shape && a.size == b.size && a.radius == b.radius && a.length == b.length &&
         a.tubeRadius == b.tubeRadius && a.loaded == b.loaded && HasCache(a) == HasCache(b);
}

Mat4 ModelOf(const Pose& pose) {
  Mat4 model;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) model(row, column) = pose.rotation(row, column);
  }
  model(0, 3) = pose.position.x;
  model(1, 3) = pose.position.y;
  model(2, 3) = pose.position.z;
  return model;
}

// The box of positions, x y z each.
Bounds BoundsOf(const std::vector<float>& positions) {
  float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f};
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], positions[i + k]);
      high[k] = std::max(high[k], positions[i + k]);
    }
  }
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

// From the light, the sphere around the box fills the picture.
Mat4 FitLight(const Vec3& light, const Bounds& box) {
  if (box.low.x > box.high.x) return {};
  const Vec3 center = 0.5 * (box.low + box.high);
  const double radius = std::max(0.5 * Length(box.high - box.low), 1e-6);
  const double distance = std::max(Length(center - light), 1e-6);
  // A light inside of the sphere sees but a part of it.
  const double angle = 2 * std::asin(std::min(radius / distance, kWidestLight));
  const double nearPlane = std::max(distance - radius, 0.01 * radius);
  const Vec3 view = center - light;
  const Vec3 up = std::abs(view.y) < 0.9 * Length(view) ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
  return Perspective(angle, 1, nearPlane, distance + radius) * LookAt(light, center, up);
}

}  // namespace

struct SceneView::Impl {
  std::vector<ClothMesh> cloths;
  std::shared_ptr<DrawMesh> sphere;
  int sphereLatitudes = 0, sphereLongitudes = 0;
  std::vector<PlaneSettings> planeSettings;
  std::vector<std::shared_ptr<DrawMesh>> planes;
  std::vector<ColliderMesh> colliders;
  std::shared_ptr<DrawMesh> background = std::make_shared<DrawMesh>(MakeSphereMesh(4, 8));
  std::vector<ClothShape> shapes;  // Of a World's cloths, while its list is made.
  HeatMap heatMap;
  ContactFinder contacts;
  BoxFinder boxes;
  SteadySpan arrowForces = SteadySpan(kLeastForce), coneForces = arrowForces;
  DrawList list;

  void UpdateColliders(const Scene& scene, const View& view, double time) {
    const int latitudes = std::max(2, view.sphereLatitudes), longitudes = std::max(3, view.sphereLongitudes);
    if (!sphere || sphereLatitudes != latitudes || sphereLongitudes != longitudes) {
      sphere = std::make_shared<DrawMesh>(MakeSphereMesh(latitudes, longitudes));
      sphereLatitudes = latitudes;
      sphereLongitudes = longitudes;
    }
    planes.resize(scene.planes.size());
    planeSettings.resize(scene.planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const PlaneSettings& now = scene.planes[i];
      if (planes[i] && planeSettings[i].point == now.point && planeSettings[i].normal == now.normal) continue;
      planes[i] = std::make_shared<DrawMesh>(MakePlaneMesh(now.point, now.normal));
      planeSettings[i] = now;
    }
    colliders.resize(scene.colliders.size());
    for (std::size_t i = 0; i < colliders.size(); ++i) {
      ColliderMesh& collider = colliders[i];
      const ColliderSettings& now = scene.colliders[i];
      std::vector<Vec3> vertices;
      if (HasCache(now)) {
        vertices.resize(now.loaded->mesh.positions.size());
        PlaceVertices(scene, now, time, vertices);
      }
      const bool same = collider.mesh && SameSurface(collider.settings, now) && collider.latitudes == latitudes &&
                        collider.longitudes == longitudes;
      if (same && vertices == collider.vertices) continue;
      auto mesh = std::make_shared<DrawMesh>(MakeColliderMesh(now, latitudes, longitudes, vertices));
      if (same) {
        mesh->shapeVersion = collider.mesh->shapeVersion + 1;
        mesh->meshVersion = collider.mesh->meshVersion + 1;
        std::swap(*collider.mesh, *mesh);
        mesh = collider.mesh;
      }
      collider = {std::move(mesh), now, latitudes, longitudes, {}, {}, std::move(vertices)};
      const Bounds box = BoundsOf(collider.mesh->positions);
      collider.low = box.low;
      collider.high = box.high;
    }
  }

  /// Arrows and cones of the contacts, as long as the strongest of them allows.
  void AddContactForces(std::span<const ClothShape> shown, const View& view, std::span<const ContactForce> forces) {
    const double distance = view.camera.distance();
    const bool cones = view.overlays.cones;
    // Powers of two: while one draws near, patches stay what they are for a while.
    const double size = std::exp2(std::round(std::log2((cones ? kConePatch : kPatch) * distance)));
    const std::vector<ContactForce> merged = MergeContacts(shown, forces, size);
    double most = 0;
    for (const ContactForce& contact : merged) most = std::max(most, contact.force);
    list.arrowForce = (cones ? coneForces : arrowForces).Update(most);
    const ArrowScale scale{.force = list.arrowForce,
                           .length = (cones ? kLongestCone : kLongestArrow) * distance,
                           .width = kArrowWidth * distance,
                           .eye = view.camera.position()};
    if (cones)
      AddCones(merged, scale, list.marks);
    else
      AddForces(merged, scale, list.marks);
  }

  void AddOverlays(const Scene& scene, std::span<const ClothShape> shown, const View& view,
                   std::span<const ContactForce> forces) {
    Marks& marks = list.marks;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (view.overlays.normals) AddNormals(*cloths[i].mesh, kNormalLength * view.camera.distance(), marks);
      if (view.overlays.pins) AddPins(shown[i], marks);
    }
    const bool springs = scene.simulation.engine == Engine::Springs;
    if (view.ShowsForces() && !springs) AddContactForces(shown, view, forces);
    if (!springs) return;
    if (view.overlays.contacts) AddContacts(shown, contacts, marks);
    if (!view.overlays.boxes) return;
    std::vector<std::span<const Vec3>> positions;
    for (const ClothShape& cloth : shown) positions.push_back(cloth.positions);
    boxes.Find(scene.cloths, positions);
    AddBoxes(boxes, marks);
  }
};

View View::ForScene(const Scene& scene) {
  View view;
  view.look = scene.look;
  view.camera = OrbitCamera::ForScene(scene);
  return view;
}

SceneView::SceneView() : impl_(std::make_unique<Impl>()) {}
SceneView::~SceneView() = default;
SceneView::SceneView(SceneView&&) noexcept = default;
SceneView& SceneView::operator=(SceneView&&) noexcept = default;

const DrawList& SceneView::Update(const World& world, const View& view, int width, int height) {
  std::vector<ClothShape>& shapes = impl_->shapes;
  shapes.clear();
  for (int i = 0; i < world.ClothCount(); ++i) {
    const ClothView cloth = world.Cloth(i);
    shapes.push_back({cloth.positions(), cloth.uv(), cloth.triangles(), cloth.springs(), cloth.rest(),
                      cloth.velocities(), cloth.pinned(), cloth.restLengths()});
  }
  std::vector<ContactForce> contacts;
  if (view.ShowsForces()) contacts = ReadContacts(world);
  return Update(world.scene(), shapes, view, width, height, world.balls(), world.report().time, contacts);
}

const DrawList& SceneView::Update(const Scene& scene, std::span<const ClothShape> cloths, const View& view, int width,
                                  int height, std::span<const Ball> balls, double time,
                                  std::span<const ContactForce> contacts) {
  DrawList& list = impl_->list;
  list.viewProjection = view.camera.ViewProjection(width, height);
  list.cameraPosition = view.camera.position();
  list.normalScaling = static_cast<float>(view.look.normalScaling);
  list.heightScaling = static_cast<float>(view.look.heightScaling);
  list.uniforms = view.uniforms;
  list.textures = view.textures;
  list.shadowMapSize = view.shadowMapSize;
  list.items.clear();

  const Color color = Times(Color{1, 1, 1, 1}, view.look.color);
  const bool heat = view.cloths && view.heatMap.quantity != Quantity::None;
  const bool linesOnly = view.look.shader == "Wireframe" && !heat;
  Bounds casters;
  impl_->cloths.resize(cloths.size());
  if (view.cloths && (view.heatMap.quantity == Quantity::Contact ||
                      (view.overlays.contacts && scene.simulation.engine == Engine::Springs)))
    FindContacts(scene, cloths, balls, time, impl_->contacts);
  if (heat) impl_->heatMap.Measure(view.heatMap, cloths, impl_->contacts);
  list.heatScale = heat ? impl_->heatMap.scale() : HeatScale{};
  for (std::size_t i = 0; view.cloths && i < cloths.size(); ++i) {
    percale::Update(impl_->cloths[i], cloths[i], view.look.tangents);
    std::vector<float>& values = impl_->cloths[i].mesh->values;
    values.clear();
    if (heat) values.assign(impl_->heatMap.Values(i).begin(), impl_->heatMap.Values(i).end());
    DrawItem item{impl_->cloths[i].mesh, DrawItem::Primitive::Lines, view.look.shader, color, {}, false};
    if (i < scene.cloths.size()) {
      item.color = Times(color, scene.cloths[i].color);
      item.backColor = Times(color, scene.cloths[i].backColor);
    }
    if (linesOnly) {
      list.items.push_back(item);
      continue;
    }
    item.primitive = DrawItem::Primitive::Triangles;
    item.pushBack = view.wireframe;
    item.castsShadow = true;
    item.heatMap = heat;
    list.items.push_back(item);
    if (cloths[i].positions.empty()) continue;
    const Bounds box = BoundsOf(item.mesh->positions);
    casters.Add(box.low, box.high);
  }

  impl_->UpdateColliders(scene, view, time);
  if (view.colliders) {
    const auto addSphere = [&](const Vec3& centre, double radius) {
      DrawItem item{impl_->sphere, DrawItem::Primitive::Triangles, view.look.shader, color, {}, false};
      item.model(0, 0) = item.model(1, 1) = item.model(2, 2) = radius;
      item.model(0, 3) = centre.x;
      item.model(1, 3) = centre.y;
      item.model(2, 3) = centre.z;
      item.surface = Surface::Sphere;
      item.castsShadow = true;
      list.items.push_back(std::move(item));
      const Vec3 extent{radius, radius, radius};
      casters.Add(centre - extent, centre + extent);
    };
    const double drawnRadius = scene.simulation.engine == Engine::Springs ? kDrawnSphereRadius : 1;
    for (const SphereSettings& s : scene.spheres) addSphere(s.origin, drawnRadius * s.radius);
    for (const Ball& ball : balls) addSphere(ball.position, kDrawnSphereRadius * ball.radius);
    for (const std::shared_ptr<DrawMesh>& plane : impl_->planes) {
      // A sheet that lies on a plane has its springs in the plane, as far as depth can tell.
      list.items.push_back(
          {plane, DrawItem::Primitive::Triangles, view.look.shader, kPlaneColor, {}, view.wireframe, Surface::Plane});
    }
    for (std::size_t i = 0; i < impl_->colliders.size(); ++i) {
      const ColliderSettings& settings = scene.colliders[i];
      const ColliderMesh& collider = impl_->colliders[i];
      if (collider.mesh->positions.empty()) continue;
      const Pose pose = PoseOf(scene, static_cast<int>(i), time);
      DrawItem item{collider.mesh, DrawItem::Primitive::Triangles, view.look.shader, color, ModelOf(pose), false};
      item.backColor = Times(Color{1, 1, 1, 1}, settings.color);
      if (settings.shape == ColliderShape::Plane) {
        item.color = Times(kPlaneColor, settings.color);
        item.surface = Surface::Plane;
        item.pushBack = view.wireframe;
        list.items.push_back(std::move(item));
        continue;
      }
      item.color = Times(color, settings.color);
      item.surface = Surface::Sphere;
      item.castsShadow = true;
      list.items.push_back(std::move(item));
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p =
            ToWorld(pose, {corner & 1 ? collider.high.x : collider.low.x, corner & 2 ? collider.high.y : collider.low.y,
                           corner & 4 ? collider.high.z : collider.low.z});
        casters.Add(p, p);
      }
    }
  }
  if (view.cloths && view.wireframe && !linesOnly) {
    for (const ClothMesh& cloth : impl_->cloths) {
      list.items.push_back({cloth.mesh, DrawItem::Primitive::Lines, "Wireframe", kOverlayColor, {}, false});
    }
  }
  // Last, where nothing else was drawn. Seen from the middle of a ball, only directions count.
  DrawItem background{impl_->background,  DrawItem::Primitive::Triangles, view.look.shader, color, {}, false,
                      Surface::Background};
  background.model(0, 3) = list.cameraPosition.x;
  background.model(1, 3) = list.cameraPosition.y;
  background.model(2, 3) = list.cameraPosition.z;
  list.items.push_back(std::move(background));
  list.lightViewProjection = FitLight(list.lightPosition, casters);
  list.marks.Clear();
  list.arrowForce = 0;
  if (view.cloths) AddTethers(scene, cloths, list.marks);
  if (view.cloths && view.overlays.Any()) impl_->AddOverlays(scene, cloths, view, contacts);
  return list;
}

}  // namespace percale
