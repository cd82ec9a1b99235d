#include "fabric/contact_step.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "collide/predicates.h"
#include "core/index.h"
#include "mesh/topology.h"

namespace percale::fabric {
namespace {

/// The distance of contact where the scene states none, over the mean edge.
constexpr double kDistance = 0.3;
/// What is round is felt by triangles and edges as well as by vertices where it is smaller than so many mean edges:
/// else it does not stand out between the vertices that it holds, even of cloth stretched fourfold.
constexpr double kCoarse = 10;
/// What was near is looked for along no longer a way, over the distance.
constexpr double kLookBack = 10;
/// So many are untangled at a time.
constexpr int kMostTangled = 1 << 20;
/// How near cloth may come to a solid, over the distance.
constexpr double kLeastGap = 0.2;

/// Where each vertex of a cloth lies in the flat fabric, where that is one place for all its triangles; else where it
/// starts.
void PlaceCloth(const FabricModel& model, int cloth, std::vector<Vec3>& place) {
  const int firstVertex = model.firstVertex[Index(cloth)], endVertex = model.firstVertex[Index(cloth) + 1];
  std::vector<Vec2> flat(Index(endVertex - firstVertex));
  std::vector<std::uint8_t> known(flat.size(), 0);
  bool one = !model.chart.empty();
  for (int t = model.firstTriangle[Index(cloth)]; one && t < model.firstTriangle[Index(cloth) + 1]; ++t) {
    const Triangle& triangle = model.triangles[Index(t)];
    const std::int32_t corner[3] = {triangle.a, triangle.b, triangle.c};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = Index(corner[k] - firstVertex);
      const Vec2& at = model.Material(Index(t), static_cast<int>(k));
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

/// The mean length of a cloth's edges [m].
std::vector<double> MeanEdges(const ContactMesh& mesh) {
  std::vector<double> length(Index(mesh.clothBodies), 0), count(length);
  for (const Edge& edge : mesh.edges) {
    const std::size_t body = Index(mesh.body[Index(edge.a)]);
    length[body] += Length(mesh.place[Index(edge.a)] - mesh.place[Index(edge.b)]);
    ++count[body];
  }
  for (std::size_t c = 0; c < length.size(); ++c) length[c] /= std::max(count[c], 1.0);
  return length;
}

/// `meanEdges`: out, the mean length of each cloth's edges [m].
ContactMesh MakeContactMesh(const FabricModel& model, const Obstacles& obstacles, std::vector<double>& meanEdges) {
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
  meanEdges = MeanEdges(mesh);  // sums depend on the order: as topology has them, and without obstacles
  obstacles.AddTo(mesh);
  return Clustered(std::move(mesh));
}

}  // namespace

ContactStep::ContactStep(const Scene& scene, const FabricModel& model, const Executor& executor, VertexScratch& scratch)
    : model_(model),
      executor_(executor),
      obstacles_(scene),
      mesh_(MakeContactMesh(model, obstacles_, meanEdges_)),
      safeMove_(mesh_, executor),
      contacts_(mesh_, executor),
      start_(scratch.first),
      way_(scratch.second) {
  scratch.Fit(Index(mesh_.vertices()));
  share_.resize(Index(mesh_.vertices()));
  for (std::vector<Vec3>* vectors : {&obstacleBefore_, &obstacle_, &obstacleTarget_})
    vectors->resize(Index(obstacles_.vertices()));
  Configure(scene);
  Restart(scene, 0);
}

void ContactStep::Configure(const Scene& scene) {
  obstacles_.Configure(scene);
  distances_.half.assign(Index(mesh_.bodies()), 0);
  distances_.core.assign(Index(mesh_.bodies()), 0);
  if (distances_.clothPairs != scene.simulation.selfCollision) judged_ = false;
  distances_.clothPairs = scene.simulation.selfCollision;
  surfaces_.assign(Index(mesh_.bodies()), {});
  double most = 0;
  for (std::size_t c = 0; c < meanEdges_.size(); ++c) {
    const ClothSettings& cloth = scene.cloths[c];
    distances_.half[c] = 0.5 * (cloth.contactDistance > 0 ? cloth.contactDistance : kDistance * meanEdges_[c]);
    surfaces_[c] = {.friction = cloth.friction};
    most = std::max(most, distances_.half[c]);
  }
  distance_ = 2 * most;
  const double longest = meanEdges_.empty() ? 0 : *std::max_element(meanEdges_.begin(), meanEdges_.end());
  std::size_t body = meanEdges_.size();
  for (const Obstacle& obstacle : obstacles_.all()) {
    const double core = obstacle.core < kCoarse * longest ? obstacle.core : 0;
    const double thickness = obstacle.collider >= 0 ? scene.colliders[Index(obstacle.collider)].thickness : 0;
    distances_.core[body] = core;
    distances_.half[body] = most + thickness + core;
    surfaces_[body++] = {.friction = FrictionOf(scene, obstacle), .rulesFriction = true, .core = core};
  }
  listed_ = false;
}

void ContactStep::Restart(const Scene& scene, double time) {
  safeMove_.Clear();
  contacts_.Clear();
  ListSolids(scene, time, placed_);
  solids_.clear();
  for (const PlacedSolid& solid : placed_) solids_.push_back({solid, solid});
  obstacles_.PlaceAt(scene, time, obstacle_);
  obstacleBefore_ = obstacleTarget_ = obstacle_;
  Disentangle();
  judged_ = listed_ = false;
  time_ = time;
}

int ContactStep::MoveColliders(const Scene& scene, double time) {
  const auto jumps = [&](int collider) { return collider >= 0 && Jumps(scene, collider, time_, time); };
  int jumped = 0;
  rewound_.solids = solids_;
  rewound_.obstacleBefore = obstacleBefore_;
  rewound_.obstacle = obstacle_;
  rewound_.time = time_;
  ListSolids(scene, time, placed_);
  const bool same = solids_.size() == placed_.size();
  solids_.resize(placed_.size());
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    SolidStep& step = solids_[s];
    const bool jump = jumps(placed_[s].collider);
    jumped += jump ? 1 : 0;
    step = {same && !jump ? step.end : placed_[s], placed_[s]};
    step.start.solid = step.end.solid;
    step.start.thickness = step.end.thickness;
  }
  obstacles_.PlaceAt(scene, time, obstacleTarget_);
  for (const Obstacle& obstacle : obstacles_.all()) {
    if (!jumps(obstacle.collider)) continue;
    if (scene.colliders[Index(obstacle.collider)].shape == ColliderShape::Mesh) ++jumped;
    for (std::size_t v = Index(obstacle.first); v < Index(obstacle.first) + obstacle.local.size(); ++v)
      obstacleBefore_[v] = obstacle_[v] = obstacleTarget_[v];
  }
  if (jumped > 0) judged_ = listed_ = false;
  time_ = time;
  return jumped;
}

void ContactStep::Begin(std::span<const Vec3> previous, std::span<const Vec3> start) {
  moves_ = 0;
  if (!judged_) Judge(start);
  if (listed_) return;
  const std::size_t cloth = start.size();
  for (std::size_t v = 0; v < cloth; ++v) way_[v] = start[v] - previous[v];
  for (std::size_t v = 0; v < obstacle_.size(); ++v) way_[cloth + v] = obstacle_[v] - obstacleBefore_[v];
  double longest = 0;
  for (const Vec3& way : way_) longest = std::max(longest, Length(way));
  const double share = std::min(1.0, kLookBack * distance_ / std::max(longest, 1e-300));
  for (std::size_t v = 0; v < way_.size(); ++v) {
    way_[v] *= share;
    start_[v] = (v < cloth ? start[v] : obstacle_[v - cloth]) - way_[v];
  }
  safeMove_.List(start_, way_, distances_);
  listed_ = true;
}

/// Which solids the surfaces are those of, where triangles and edges feel them.
void ContactStep::FindRoundSurfaces() {
  std::size_t body = Index(mesh_.clothBodies);
  for (const Obstacle& obstacle : obstacles_.all()) {
    ContactSurface& surface = surfaces_[body++];
    surface.solid = nullptr;
    if (surface.core == 0) continue;
    const auto isIt = [&](const SolidStep& solid) { return solid.end.collider == obstacle.collider; };
    // Spheres come first.
    surface.solid =
        obstacle.sphere >= 0 ? &solids_[Index(obstacle.sphere)] : &*std::find_if(solids_.begin(), solids_.end(), isIt);
  }
}

void ContactStep::FindPlanes(std::span<const Vec3> begin, std::span<const Vec3> now, std::span<const Vec3> ahead,
                             std::span<const std::uint8_t> free, double h, bool firm) {
  const std::size_t cloth = now.size();
  ForRange(executor_, cloth, [&](int vertex) {
    const std::size_t v = Index(vertex);
    start_[v] = now[v];
    way_[v] = ahead[v] - now[v];
  });
  for (std::size_t v = 0; v < obstacle_.size(); ++v) {
    start_[cloth + v] = obstacle_[v];
    way_[cloth + v] = obstacleTarget_[v] - obstacle_[v];
  }
  FindRoundSurfaces();
  contacts_.Begin({.begin = begin,
                   .start = start_,
                   .way = way_,
                   .free = free,
                   .mass = model_.mass,
                   .h = h,
                   .firm = firm,
                   .surfaces = surfaces_});
  contacts_.AddPairs(PairKind::VertexTriangle, safeMove_.vertexTriangle());
  contacts_.AddPairs(PairKind::EdgeEdge, safeMove_.edgeEdge());
  tangles_.clear();
  if (untangler_) untangler_->Find(start_, free, tangles_);
  contacts_.AddTangles(tangles_, distances_);
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    const ContactSurface surface{.friction = solids_[s].end.friction, .rulesFriction = true};
    const auto distanceOf = [&](std::size_t v) { return 2 * distances_.half[Index(mesh_.body[v])]; };
    meetings_.resize(cloth);  // before the first solid there are none
    ForRange(executor_, cloth, [&](int vertex) {
      const std::size_t v = Index(vertex);
      meetings_[v].any = false;
      if (!free[v]) return;
      meetings_[v] = Meet(solids_[s], now[v], ahead[v], kLeastGap * distanceOf(v), kSoon * distanceOf(v));
    });
    for (std::size_t v = 0; v < cloth; ++v) {
      const SolidMeeting& meeting = meetings_[v];
      if (!meeting.any) continue;
      // What is deep inside comes out in some steps.
      const double deep = std::min(0.0, meeting.gap + kDeepest * distanceOf(v));
      const Vec3 in = meeting.normal * deep;
      contacts_.AddPlane({ContactKey::Kind::Shape, {static_cast<std::int32_t>(v), static_cast<std::int32_t>(s), 0, 0}},
                         static_cast<std::int32_t>(v), meeting.gap - deep, distanceOf(v), From<double>(meeting.normal),
                         From<double>(meeting.point + in), From<double>(meeting.pointBefore + in), surface);
    }
  }
}

SafeMoveReport ContactStep::Move(std::span<const Vec3> now, std::span<Vec3> end, bool mayGiveUp) {
  const std::size_t cloth = now.size();
  ForRange(executor_, cloth, [&](int vertex) {
    const std::size_t v = Index(vertex);
    start_[v] = now[v];
    const double least = kLeastGap * 2 * distances_.half[Index(mesh_.body[v])];
    for (const SolidStep& solid : solids_) end[v] = Outside(solid, now[v], end[v], least);
    way_[v] = end[v] - now[v];
  });
  for (std::size_t v = 0; v < obstacle_.size(); ++v) {
    start_[cloth + v] = obstacle_[v];
    way_[cloth + v] = obstacleTarget_[v] - obstacle_[v];
  }
  const SafeMoveReport report = safeMove_.Move(start_, way_, distances_, share_, mayGiveUp);
  if (report.gaveUp) return report;
  for (std::size_t v = 0; v < cloth; ++v) {
    if (share_[v] < 1) end[v] = now[v] + way_[v] * share_[v];
  }
  for (std::size_t v = 0; v < obstacle_.size(); ++v) {
    const double share = share_[cloth + v];
    if (moves_ == 0) obstacleBefore_[v] = obstacle_[v];
    obstacle_[v] = share < 1 ? obstacle_[v] + way_[cloth + v] * share : obstacleTarget_[v];
  }
  // The list is that of the step's way only if all went it, and in one.
  listed_ = report.cut == 0 && moves_ == 0;
  ++moves_;
  return report;
}

void ContactStep::Rewind() {
  solids_ = rewound_.solids;
  obstacleBefore_ = rewound_.obstacleBefore;
  obstacle_ = rewound_.obstacle;
  time_ = rewound_.time;
  moves_ = 0;
  // What was seen may have been seen after a jump.
  judged_ = judged_ && tangled() == 0;
  listed_ = false;
}

void ContactStep::End(std::span<const Vec3> y) {
  contacts_.End(y);
  if (tangled() > 0) Judge(y);
}

void ContactStep::MoveAside(std::span<const Vec3> now, std::span<Vec3> end) {
  if (!judged_) Judge(now);
  obstacleTarget_ = obstacle_;
  for (SolidStep& solid : solids_) solid.start = solid.end;
  Move(now, end);
  if (tangled() > 0) Judge(end);
  listed_ = false;
}

/// What passes through what. Those pairs are let be until they have come apart.
void ContactStep::Judge(std::span<const Vec3> cloth) {
  std::copy(cloth.begin(), cloth.end(), start_.begin());
  std::copy(obstacle_.begin(), obstacle_.end(), start_.begin() + static_cast<std::ptrdiff_t>(cloth.size()));
  std::vector<Intersection> met;
  if ((distances_.clothPairs || !obstacle_.empty()) && (judge_ || !NothingIsNear())) {
    if (!judge_) judge_.emplace(mesh_.vertices(), mesh_.triangles, mesh_.clothVertices);
    met = judge_->Count(start_, executor_, kMostTangled).first;
  }
  JudgeLoneEdges(met);
  if (!distances_.clothPairs) {
    std::erase_if(met, [&](const Intersection& one) {
      return std::max(one.edge[1], mesh_.triangles[Index(one.triangle)].a) < mesh_.clothVertices;
    });
  }
  if (met.empty()) {
    Disentangle();
  } else {
    if (!untangler_) untangler_.emplace(mesh_);
    untangler_->Take(std::move(met));
    safeMove_.Exempt(&*untangler_);
  }
  judged_ = true;
  listed_ = false;  // A list says which pairs are let be.
}

/// Whether it is seen soon that at start_ nothing meets, since no two things without a vertex in common come near:
/// where an edge runs through a triangle, it is within the radius of the largest circle in the triangle of a side, and
/// so within 0.289 of the longest side. (With one vertex in common it ends on the triangle, or crosses the side
/// opposite.)
bool ContactStep::NothingIsNear() {
  double longest = 0;
  for (const Edge& edge : mesh_.edges)
    longest = std::max(longest, Length(start_[Index(edge.a)] - start_[Index(edge.b)]));
  const double least = 0.15 * longest;
  if (least > distance_) return false;  // too much would be near
  ContactDistances reach = distances_;
  for (double& half : reach.half) half = std::max(half, least);
  std::fill(way_.begin(), way_.end(), Vec3{});
  return !safeMove_.AnyNear(start_, way_, reach);
}

/// Nothing is tangled, so far as is known.
void ContactStep::Disentangle() {
  safeMove_.Exempt(nullptr);
  judge_.reset();
  untangler_.reset();
}

/// The edges of solids, of which the judge knows nothing, each against all triangles of cloth: they are few.
void ContactStep::JudgeLoneEdges(std::vector<Intersection>& met) {
  const auto apart = [](double a, double b, double p, double q, double r) {
    return std::max(a, b) < std::min({p, q, r}) || std::min(a, b) > std::max({p, q, r});
  };
  const std::int32_t first = mesh_.clothVertices;
  for (const Edge& edge : obstacles_.loneEdges()) {
    const std::int32_t from = first + std::min(edge.a, edge.b), to = first + std::max(edge.a, edge.b);
    const Vec3 &a = start_[Index(from)], &b = start_[Index(to)];
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      const Triangle& triangle = mesh_.triangles[t];
      const Vec3 &p = start_[Index(triangle.a)], &q = start_[Index(triangle.b)], &r = start_[Index(triangle.c)];
      if (apart(a.x, b.x, p.x, q.x, r.x) || apart(a.y, b.y, p.y, q.y, r.y) || apart(a.z, b.z, p.z, q.z, r.z)) continue;
      if (SegmentMeetsTriangle(a, b, p, q, r)) met.push_back({{from, to}, static_cast<std::int32_t>(t)});
    }
  }
}

void ContactStep::ReadState(std::vector<Touch>& touches, std::vector<Vec3>& obstacles) const {
  contacts_.ReadMemory(touches);
  obstacles.assign(obstacleBefore_.begin(), obstacleBefore_.end());
  obstacles.insert(obstacles.end(), obstacle_.begin(), obstacle_.end());
}

void ContactStep::WriteState(std::span<const Touch> touches, std::span<const Vec3> obstacles) {
  contacts_.WriteMemory(touches);
  if (obstacles.size() != 2 * obstacle_.size()) return;
  const auto middle = obstacles.begin() + static_cast<std::ptrdiff_t>(obstacle_.size());
  std::copy(obstacles.begin(), middle, obstacleBefore_.begin());
  std::copy(middle, obstacles.end(), obstacle_.begin());
}

std::int64_t ContactStep::CountSqueezed(std::span<const Vec3> y) const {
  std::atomic<std::int64_t> count = 0;
  ForRange(executor_, y.size(), [&](int v) {
    for (const SolidStep& solid : solids_) {
      if (DistanceTo(solid.end, y[Index(v)]).distance < 0) ++count;
    }
  });
  for (std::size_t v = 0; v < obstacle_.size(); ++v) count += obstacle_[v] == obstacleTarget_[v] ? 0 : 1;
  return count;
}

}  // namespace percale::fabric
