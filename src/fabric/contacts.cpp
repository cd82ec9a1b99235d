#include "fabric/contacts.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/memory.h"

namespace percale::fabric {
namespace {

constexpr int kPairsPerChunk = 1024, kContactsPerChunk = 256;
/// Of so many pairs at a time the planes are found: they take 15 MB, and each thread of some has a few chunks.
constexpr std::size_t kPairsAtOnce = 64 * kPairsPerChunk;
/// A pull at what is tangled is as strong as so many contacts: of 80 heaps of sheets 4 were still tangled after 200
/// frames with 1, none with 4, one with 10.
constexpr double kPull = 4;
/// What is round meets triangles and edges where they come nearer to it than their own vertices, which feel it too: in
/// full where that is nearer by this share of the distance of contact.
constexpr double kFullSag = 0.25;
/// How stiff a contact is that begins, over the inertia of its sides, mass over h^2: stiff enough for what lies on
/// cloth, and not so stiff that vertices that touch move as one, which solvers take long to see.
constexpr double kStiffness = 20;
/// The gap that a plane's parabola is fitted at is within these shares of the distance of contact.
constexpr double kLeastFit = 0.05, kMostFit = 0.5;
/// Edges count in full where they cross so far from their ends, over their length.
constexpr double kFullCrossing = 0.1;
/// A contact is as stiff as to stop what comes near within this share of its distance.
constexpr double kStop = 0.3;

Vector3<double> Tangential(const Vector3<double>& v, const Vector3<double>& normal) {
  return v - normal * Dot(v, normal);
}

/// About the least eigenvalue of a symmetric block, positive definite: one over the sum of one over each, which is a
/// third of it at least. Of a vertex in cloth that is across the cloth, and is its inertia and the tension in it.
double Softest(const Real* block) {
  const double a = block[0], b = block[4], c = block[8], d = block[1], e = block[2], f = block[5];
  const double xx = b * c - f * f, yy = a * c - e * e, zz = a * b - d * d;
  return (a * xx - d * (d * c - e * f) + e * (d * f - b * e)) / (xx + yy + zz);
}

/// How much nearer a side of a pair comes to the other, of a point or an edge, than the vertices of that side do, where
/// the plane is [m]. `first`: the point or edge is the first side.
double SagOf(PairKind kind, const Corners<double>& x, const PairState& plane, bool first) {
  const bool edges = kind == PairKind::EdgeEdge;
  const std::size_t begin = edges && first ? 2 : first ? 1 : 0, end = edges && !first ? 2 : 4;
  const Vector3<double> from = edges ? x[first ? 0 : 2] : x[0];
  const Vector3<double> along = edges ? x[first ? 1 : 3] - from : Vector3<double>();
  const double squared = Dot(along, along);
  double mean = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const Vector3<double> way = x[k] - from;
    const double at = squared > 0 ? std::clamp(Dot(way, along) / squared, 0.0, 1.0) : 0;
    const Vector3<double> apart = way - along * at;
    mean += std::abs(plane.weight[k]) * std::sqrt(Dot(apart, apart));
  }
  return mean - plane.gap;
}

/// How the spring of friction is strained, where `sum` is that of weights times positions.
Vector3<double> Slide(const Contact& c, const Vector3<double>& sum) {
  return Tangential(sum - c.slideFrom, c.normal) + c.hold * (1 / c.stiffness);
}

/// Sum of weights times positions, of cloth.
Vector3<double> Sum(const Contact& c, std::span<const Vec3> y) {
  Vector3<double> sum;
  for (std::size_t k = 0; k < 4; ++k) {
    if (c.vertex[k] >= 0) sum += From<double>(y[Index(c.vertex[k])]) * c.weight[k];
  }
  return sum;
}

double EnergyOf(const Contact& c, std::span<const Vec3> y) {
  if (!c.seen) return 0;
  const Vector3<double> sum = Sum(c, y);
  const double depth = c.distance - Dot(c.normal, sum) - c.offset;
  const Vector3<double> slide = Slide(c, sum);
  return 0.5 * (depth > 0 || c.held ? c.stiffness * depth * depth : 0) + 0.5 * c.drag * Dot(slide, slide);
}

}  // namespace

Contacts::Contacts(const ContactMesh& mesh, const Executor& executor)
    : mesh_(mesh), executor_(executor), triangles_(Index(mesh.vertices())), border_(Index(mesh.vertices())) {
  std::vector<int> surplus(triangles_.size());  // of edges over triangles
  for (const Edge& edge : mesh.edges) ++surplus[Index(edge.a)], ++surplus[Index(edge.b)];
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t v : {triangle.a, triangle.b, triangle.c}) {
      --surplus[Index(v)];
      if (triangles_[Index(v)] < 255) ++triangles_[Index(v)];
    }
  }
  for (std::size_t v = 0; v < surplus.size(); ++v) border_[v] = surplus[v] > 0 ? 1 : 0;
}

/// Points where things touch are often those of several pairs: a vertex that is near another is near all triangles
/// there, and so are all edges of both. Of such pairs each counts for its share: what is nearest to a side of a
/// triangle, which two have, for half, to a corner for one of those that meet there; and edges where they cross, not
/// where an end of one is nearest, which is a vertex's to mind.
double Contacts::ShareOf(PairKind kind, const VertexQuad& vertex, const std::array<double, 4>& weight) const {
  const auto lone = [&](std::size_t a, std::size_t b) {
    return triangles_[Index(vertex[a])] == 0 && triangles_[Index(vertex[b])] == 0;
  };
  if (kind == PairKind::EdgeEdge) {
    const double inside =
        std::min({std::abs(weight[0]), std::abs(weight[1]), std::abs(weight[2]), std::abs(weight[3])});
    if (lone(0, 1) || lone(2, 3)) return 1;
    return std::min(1.0, inside / kFullCrossing);
  }
  int corners = 0, borders = 0;
  std::int32_t last = -1;
  for (std::size_t k = 1; k < 4; ++k) {
    if (weight[k] == 0) continue;
    ++corners;
    borders += border_[Index(vertex[k])];
    last = vertex[k];
  }
  if (corners == 1) return 1.0 / triangles_[Index(last)];
  return corners == 2 && borders < 2 ? 0.5 : 1;
}

void Contacts::Begin(const Step& step) {
  step_ = step;
  contacts_.clear();
  first_ = true;
}

void Contacts::Clear() {
  contacts_.clear();
  memory_.Clear(0);
}

/// What resists a change of its gap [N/m], if each vertex were alone: `ofVertex(v)` of each along the normal; 0 where
/// all is pinned.
template <class OfVertex>
double Contacts::Resistance(const Contact& c, OfVertex&& ofVertex) const {
  double compliance = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::int32_t v = c.vertex[k];
    if (v >= 0 && step_.free[Index(v)]) compliance += c.weight[k] * c.weight[k] / ofVertex(v);
  }
  return compliance > 0 ? 1 / compliance : 0;
}

/// Of a contact that begins. `approach`: how far beyond contact inertia alone would lead [m].
void Contacts::Start(double gap, double reach, double approach, double counts, Contact& c) const {
  c.gap = gap;
  c.reach = reach;
  c.counts = counts;
  const double inertia = Resistance(c, [&](std::int32_t v) { return step_.mass[Index(v)] / (step_.h * step_.h); });
  Fit(inertia * std::max(kStiffness, approach / (kStop * reach)), c);
}

/// The force is k (r - d) down to half the distance of contact r, and from there on grows as 1 / d^2; the parabola has
/// that force and its slope at the gap of the start.
void Contacts::Fit(double k, Contact& c) {
  c.base = k;
  const double fit = std::clamp(c.gap, kLeastFit * c.reach, kMostFit * c.reach);
  if (fit == kMostFit * c.reach) {
    c.stiffness = c.counts * k;
    c.distance = c.reach;
    return;
  }
  const double share = 0.5 * c.reach / fit;
  const double force = 0.5 * k * c.reach * share * share;
  c.stiffness = c.counts * 2 * force / fit;
  c.distance = 1.5 * fit;
}

std::size_t Contacts::MemoryBytes() const {
  return BytesOf(triangles_) + BytesOf(border_) + BytesOf(contacts_) + BytesOf(found_) + BytesOf(foundEnd_) +
         BytesOf(states_) + BytesOf(terms_) + BytesOf(chunkSums_) + memory_.Bytes();
}

void Contacts::ReadMemory(std::vector<Touch>& touches) const {
  touches.clear();
  memory_.ForAll([&](const ContactKey& key, const Stick& stick) {
    touches.push_back({static_cast<std::int32_t>(key.kind), key.number, ToVec3(stick.hold), stick.force});
  });
  std::sort(touches.begin(), touches.end(),
            [](const Touch& a, const Touch& b) { return a.kind != b.kind ? a.kind < b.kind : a.number < b.number; });
}

void Contacts::WriteMemory(std::span<const Touch> touches) {
  memory_.Clear(touches.size());
  for (const Touch& touch : touches) {
    memory_.Put({static_cast<ContactKey::Kind>(touch.kind), touch.number}, {From<double>(touch.hold), touch.force});
  }
}

double Contacts::FrictionOf(const ContactSurface& a, const ContactSurface& b) const {
  if (a.rulesFriction) return a.friction;
  if (b.rulesFriction) return b.friction;
  return 0.5 * (a.friction + b.friction);
}

/// Goes on with the friction of the step before.
void Contacts::Remember(Contact& contact) const {
  const Stick* stick = memory_.Find(contact.key);
  if (stick == nullptr) return;
  contact.hold = Tangential(stick->hold, contact.normal);
  contact.force = stick->force;
}

void Contacts::AddPairs(PairKind kind, const NearPairs& pairs) {
  for (std::size_t first = 0; first < pairs.size(); first += kPairsAtOnce) {
    AddPairs(kind, pairs, first, std::min(pairs.size(), first + kPairsAtOnce));
  }
}

void Contacts::AddPairs(PairKind kind, const NearPairs& pairs, std::size_t first, std::size_t last) {
  const std::size_t count = last - first;
  const int chunks = Chunks(static_cast<int>(count), kPairsPerChunk);
  if (found_.size() < count) found_.resize(count), states_.resize(count);
  foundEnd_.resize(Index(chunks));
  executor_.ForChunks(chunks, [&](int chunk) {
    const std::size_t begin = Index(chunk) * kPairsPerChunk, end = std::min(count, begin + kPairsPerChunk);
    std::size_t& next = foundEnd_[Index(chunk)];
    next = begin;
    StatesOf(kind, std::span(pairs.vertex).subspan(first + begin, end - begin), step_.start,
             std::span(states_).subspan(begin, end - begin));
    for (std::size_t p = begin; p < end; ++p) {
      const VertexQuad& vertex = pairs.vertex[first + p];
      const PairState& now = states_[p];
      const double distance = pairs.distance[first + p];
      const ContactSurface& a = step_.surfaces[Index(mesh_.body[Index(vertex[0])])];
      const ContactSurface& b = step_.surfaces[Index(mesh_.body[Index(vertex[3])])];
      if (!(now.gap > 0)) continue;
      const double core = a.core + b.core, solid = std::min(core, now.gap + kDeepest * distance);
      const double gap = now.gap - solid;
      Corners<double> x, way;
      for (std::size_t k = 0; k < 4; ++k) {
        x[k] = From<double>(step_.start[Index(vertex[k])]);
        way[k] = From<double>(step_.way[Index(vertex[k])]);
      }
      PairState plane = now;
      Corners<double> at = x;  // where the plane is
      const double share = ShareApart(kind, x, way, now, FloorOf(now.gap, distance, core));
      if (share < 1) {
        at = After(x, way, share);
        plane = StateOf(kind, at);
        if (!(plane.gap > 0)) at = x, plane = now;
      } else if (gap >= kSoon * distance) {
        continue;
      }
      double counts = ShareOf(kind, vertex, plane.weight);
      if (core > 0) counts *= std::clamp(SagOf(kind, at, plane, a.core > 0) / (kFullSag * distance), 0.0, 1.0);
      if (counts == 0) continue;
      Contact& c = found_[next];
      c = {};
      c.key = {kind == PairKind::VertexTriangle ? ContactKey::Kind::VertexTriangle : ContactKey::Kind::EdgeEdge,
               vertex};
      c.normal = plane.normal;
      Vector3<double> obstacle, obstacleBefore;
      double side = 0;  // of the obstacle: its weights' sum
      for (std::size_t k = 0; k < 4; ++k) {
        const std::int32_t v = vertex[k];
        c.weight[k] = plane.weight[k];
        c.vertex[k] = v < mesh_.clothVertices ? v : -1;
        if (c.vertex[k] >= 0) {
          c.slideFrom += From<double>(step_.begin[Index(v)]) * plane.weight[k];
          continue;
        }
        obstacle += (x[k] + way[k]) * plane.weight[k];
        obstacleBefore += x[k] * plane.weight[k];
        side += plane.weight[k];
      }
      c.offset = Dot(c.normal, obstacle) - solid;
      if (core > 0) {
        const SolidStep& round = *(a.core > 0 ? a : b).solid;
        const Vec3 surface = ToVec3(obstacle * side - c.normal * (core * side));
        obstacle = From<double>(surface) * side;
        obstacleBefore = From<double>(ToWorld(round.start.pose, ToLocal(round.end.pose, surface))) * side;
      }
      c.slideFrom += obstacleBefore - obstacle;
      double ahead = -solid;
      for (std::size_t k = 0; k < 4; ++k) ahead += c.weight[k] * Dot(c.normal, x[k] + way[k]);
      Start(gap, distance, distance - ahead, counts, c);
      c.friction = FrictionOf(a, b);
      if (c.stiffness > 0) ++next;
    }
  });
  for (int chunk = 0; chunk < chunks; ++chunk) {
    const Contact* const found = found_.data();
    contacts_.insert(contacts_.end(), found + Index(chunk) * kPairsPerChunk, found + foundEnd_[Index(chunk)]);
  }
}

void Contacts::AddTangles(std::span<const Tangle> tangles, const ContactDistances& distances) {
  for (const Tangle& tangle : tangles) {
    Contact c;
    c.key.kind = ContactKey::Kind::Tangle;
    c.normal = tangle.direction;
    const auto put = [&](std::size_t k, std::int32_t v, double weight) {
      c.weight[k] = weight;
      c.vertex[k] = v < mesh_.clothVertices ? v : -1;
      // What is no gap now is to become one of the distance.
      const Vec3 moved = c.vertex[k] < 0 ? step_.way[Index(v)] : -step_.start[Index(v)];
      c.offset += weight * Dot(c.normal, From<double>(moved));
    };
    put(0, tangle.vertex, 1);
    for (std::size_t k = 0; k < 3; ++k) put(k + 1, tangle.corner[k], -tangle.weight[k]);
    const double distance = distances.Between(mesh_.body[Index(tangle.vertex)], mesh_.body[Index(tangle.corner[0])]);
    Start(distance, distance, distance, kPull, c);
    if (c.stiffness > 0) contacts_.push_back(c);
  }
}

void Contacts::AddPlane(const ContactKey& key, std::int32_t vertex, double gap, double distance,
                        const Vector3<double>& normal, const Vector3<double>& point, const Vector3<double>& pointBefore,
                        const ContactSurface& surface) {
  Contact& c = contacts_.emplace_back();
  c.key = key;
  c.vertex = {vertex, -1, -1, -1};
  c.weight = {1, 0, 0, 0};
  c.normal = normal;
  c.offset = -Dot(normal, point);
  c.slideFrom = From<double>(step_.begin[Index(vertex)]) + point - pointBefore;
  const ContactSurface& own = step_.surfaces[Index(mesh_.body[Index(vertex)])];
  const Vec3 ahead = step_.start[Index(vertex)] + step_.way[Index(vertex)];
  Start(gap, distance, distance - Dot(normal, From<double>(ahead) - point), 1, c);
  c.friction = FrictionOf(own, surface);
}

/// Sums energyOf(contact) over all, in order.
template <class Body>
double Contacts::SumEnergies(Body&& energyOf) {
  const int count = static_cast<int>(contacts_.size()), chunks = Chunks(count, kContactsPerChunk);
  chunkSums_.resize(Index(chunks));
  executor_.ForChunks(chunks, [&](int chunk) {
    double sum = 0;
    const int end = std::min(count, (chunk + 1) * kContactsPerChunk);
    for (int c = chunk * kContactsPerChunk; c < end; ++c) sum += energyOf(contacts_[Index(c)]);
    chunkSums_[Index(chunk)] = sum;
  });
  double energy = 0;
  for (const double part : chunkSums_) energy += part;
  return energy;
}

double Contacts::Energy(std::span<const Vec3> y) {
  return SumEnergies([&](const Contact& c) { return EnergyOf(c, y); });
}

double Contacts::Update(std::span<const Vec3> y, const SystemMatrix& matrix) {
  const double energy = SumEnergies([&](Contact& c) {
    if (first_) Remember(c);
    const Vector3<double> sum = Sum(c, y);
    const double depth = c.distance - Dot(c.normal, sum) - c.offset;
    c.held = first_ && c.force > 0;
    c.active = depth > 0 || c.held;
    if (c.active && step_.firm) {
      const double k = kStiffness * Resistance(c, [&](std::int32_t v) { return Softest(matrix.DiagonalBlock(v)); });
      if (k > c.base) Fit(k, c);
    }
    c.seen = (!first_ && c.seen) || c.active;
    // What presses is what pressed a step ago: where a contact begins, the first guess of it is far too great.
    if (!first_) c.force = c.active ? c.stiffness * depth : 0;
    const Vector3<double> slide = Slide(c, sum);
    const double length = std::sqrt(Dot(slide, slide)), most = c.friction * c.force;
    c.drag = !c.active ? 0 : most < c.stiffness * length ? most / length : most > 0 ? c.stiffness : 0;
    return EnergyOf(c, y);
  });
  first_ = false;
  return energy;
}

void Contacts::AddGradient(std::span<const Vec3> y, std::span<Vec3> gradient) const {
  for (const Contact& c : contacts_) {
    if (!c.active) continue;
    const Vector3<double> sum = Sum(c, y);
    const double depth = c.distance - Dot(c.normal, sum) - c.offset;
    Vector3<double> pull = Slide(c, sum) * c.drag;
    if (depth > 0 || c.held) pull -= c.normal * (c.stiffness * depth);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t v = c.vertex[k];
      if (v >= 0 && step_.free[Index(v)]) gradient[Index(v)] += ToVec3(pull * c.weight[k]);
    }
  }
}

std::span<const ExtraTerm> Contacts::Terms() {
  terms_.clear();
  for (const Contact& c : contacts_) {
    if (!c.active) continue;
    const Matrix3<double> block = Outer(c.normal, c.normal) * (c.stiffness - c.drag) + Diagonal(c.drag);
    ExtraTerm& term = terms_.emplace_back();
    term.vertex = c.vertex;
    for (std::size_t k = 0; k < 4; ++k) term.weight[k] = static_cast<Real>(c.weight[k]);
    for (std::size_t k = 0; k < 9; ++k) term.block[k] = static_cast<Real>(block.m[k]);
  }
  return terms_;
}

void Contacts::End(std::span<const Vec3> y) {
  nextMemory_.Clear(contacts_.size());
  for (Contact& c : contacts_) {
    const Vector3<double> sum = Sum(c, y);
    const double depth = c.distance - Dot(c.normal, sum) - c.offset;
    if (!(depth > 0) || c.key.kind == ContactKey::Kind::Tangle) continue;
    Stick stick;
    stick.force = c.stiffness * depth;
    stick.hold = Slide(c, sum) * c.stiffness;
    const double length = std::sqrt(Dot(stick.hold, stick.hold)), most = c.friction * stick.force;
    if (length > most) stick.hold = stick.hold * (most / length);
    nextMemory_.Put(c.key, stick);
  }
  std::swap(memory_, nextMemory_);
}

}  // namespace percale::fabric
