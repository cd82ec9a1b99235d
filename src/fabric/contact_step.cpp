#include "fabric/contact_step.h"

#include <algorithm>
#include <cmath>

#include "mesh/topology.h"

namespace percale::fabric {
namespace {

/// The distance of contact where the scene states none, over the mean edge.
constexpr double kDistance = 0.3;
/// How near cloth may come to a solid, how near it feels it soon, and how deep in it counts at most, over the distance.
constexpr double kLeastGap = 0.2, kSoon = 2, kDeepest = 0.5;

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Where each vertex of a cloth lies in the flat fabric, where that is one place for all its triangles; else where it
/// starts.
void PlaceCloth(const FabricModel& model, int cloth, std::vector<Vec3>& place) {
  const int firstVertex = model.firstVertex[Index(cloth)], endVertex = model.firstVertex[Index(cloth) + 1];
  std::vector<Vec2> flat(Index(endVertex - firstVertex));
  std::vector<std::uint8_t> known(flat.size(), 0);
  bool one = !model.material.empty();
  for (int t = model.firstTriangle[Index(cloth)]; one && t < model.firstTriangle[Index(cloth) + 1]; ++t) {
    const Triangle& triangle = model.triangles[Index(t)];
    const std::int32_t corner[3] = {triangle.a, triangle.b, triangle.c};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = Index(corner[k] - firstVertex);
      const Vec2& at = model.material[3 * Index(t) + k];
      if (!known[v]) flat[v] = at;
      known[v] = 1;
      one = one && flat[v] == at;
    }
  }
  for (int v = firstVertex; v < endVertex; ++v) {
    const Vec2& at = flat[Index(v - firstVertex)];
    place[Index(v)] = one ? Vec3{at.x, at.y, 0} : model.start[Index(v)];
  }
}

ContactMesh MakeContactMesh(const FabricModel& model) {
  ContactMesh mesh;
  mesh.clothVertices = model.vertexCount;
  mesh.clothBodies = model.Cloths();
  mesh.place.resize(Index(model.vertexCount));
  for (int c = 0; c < model.Cloths(); ++c) {
    mesh.body.resize(Index(model.firstVertex[Index(c) + 1]), c);
    PlaceCloth(model, c, mesh.place);
  }
  mesh.triangles = model.triangles;
  mesh.edges = BuildTopology(Index(model.vertexCount), model.triangles).edges;
  return mesh;
}

}  // namespace

ContactStep::ContactStep(const Scene& scene, const FabricModel& model, const Executor& executor)
    : mesh_(MakeContactMesh(model)), safeMove_(mesh_, executor), contacts_(mesh_, executor) {
  const std::size_t count = Index(mesh_.vertices());
  for (std::vector<Vec3>* vectors : {&begin_, &start_, &way_}) vectors->resize(count);
  share_.resize(count);
  Configure(scene);
}

void ContactStep::Configure(const Scene& scene) {
  distances_.half.assign(Index(mesh_.bodies()), 0);
  distances_.clothPairs = scene.simulation.selfCollision;
  surfaces_.assign(Index(mesh_.bodies()), {});
  std::vector<double> length(Index(mesh_.clothBodies), 0);
  std::vector<std::int64_t> edges(Index(mesh_.clothBodies), 0);
  for (const Edge& edge : mesh_.edges) {
    const std::size_t body = Index(mesh_.body[Index(edge.a)]);
    if (Index(mesh_.clothBodies) <= body) continue;
    length[body] += Length(mesh_.place[Index(edge.a)] - mesh_.place[Index(edge.b)]);
    ++edges[body];
  }
  for (std::size_t c = 0; c < Index(mesh_.clothBodies); ++c) {
    const ClothSettings& cloth = scene.cloths[c];
    const double mean = edges[c] > 0 ? length[c] / static_cast<double>(edges[c]) : 0;
    distances_.half[c] = 0.5 * (cloth.contactDistance > 0 ? cloth.contactDistance : kDistance * mean);
    surfaces_[c] = {.friction = cloth.friction};
  }
}

void ContactStep::MoveColliders(const Scene& scene, double time) {
  ListSolids(scene, time, placed_);
  const bool known = solids_.size() == placed_.size();
  solids_.resize(placed_.size());
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    SolidStep& step = solids_[s];
    step = {known ? step.end : placed_[s], placed_[s]};
    step.start.solid = step.end.solid;
  }
}

void ContactStep::Clear() {
  solids_.clear();
  safeMove_.Clear();
  contacts_.Clear();
}

void ContactStep::FindPlanes(std::span<const Vec3> begin, std::span<const Vec3> start, std::span<const Vec3> ahead,
                             std::span<const std::uint8_t> free, std::span<const double> mass, double h) {
  for (std::size_t v = 0; v < start.size(); ++v) {
    begin_[v] = begin[v];
    start_[v] = start[v];
    way_[v] = ahead[v] - start[v];
  }
  contacts_.Begin(
      {.begin = begin_, .start = start_, .way = way_, .free = free, .mass = mass, .h = h, .surfaces = surfaces_});
  contacts_.AddPairs(PairKind::VertexTriangle, safeMove_.vertexTriangle());
  contacts_.AddPairs(PairKind::EdgeEdge, safeMove_.edgeEdge());
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    const ContactSurface surface{.friction = solids_[s].end.friction, .rulesFriction = true};
    for (std::size_t v = 0; v < start.size(); ++v) {
      if (!free[v]) continue;
      const double distance = 2 * distances_.half[Index(mesh_.body[v])];
      const SolidMeeting meeting = Meet(solids_[s], start[v], ahead[v], kLeastGap * distance, kSoon * distance);
      if (!meeting.any) continue;
      // What is deep inside comes out in some steps.
      const double deep = std::min(0.0, meeting.gap + kDeepest * distance);
      const Vec3 in = meeting.normal * deep;
      contacts_.AddPlane({ContactKey::Kind::Shape, {static_cast<std::int32_t>(v), static_cast<std::int32_t>(s), 0, 0}},
                         static_cast<std::int32_t>(v), meeting.gap - deep, distance, From<double>(meeting.normal),
                         From<double>(meeting.point + in), From<double>(meeting.pointBefore + in), surface);
    }
  }
}

SafeMoveReport ContactStep::Move(std::span<const Vec3> start, std::span<Vec3> end) {
  for (std::size_t v = 0; v < start.size(); ++v) {
    start_[v] = start[v];
    for (const SolidStep& solid : solids_)
      end[v] = Outside(solid, start[v], end[v], kLeastGap * 2 * distances_.half[Index(mesh_.body[v])]);
    way_[v] = end[v] - start[v];
  }
  const SafeMoveReport report = safeMove_.Move(start_, way_, distances_, share_);
  for (std::size_t v = 0; v < start.size(); ++v) {
    if (share_[v] < 1) end[v] = start[v] + way_[v] * share_[v];
  }
  return report;
}

std::int64_t ContactStep::CountInside(std::span<const Vec3> y) const {
  std::int64_t inside = 0;
  for (const SolidStep& solid : solids_) {
    for (const Vec3& at : y) inside += DistanceTo(solid.end, at).distance < 0 ? 1 : 0;
  }
  return inside;
}

}  // namespace percale::fabric
