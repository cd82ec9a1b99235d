#include "percale/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "collide/obstacles.h"
#include "collide/poses.h"
#include "collide/proximity.h"
#include "core/index.h"
#include "math/vector3.h"

namespace percale {
namespace {

/// Friction that is less than all there can be by no more than this share of it was cut off there.
constexpr double kRounding = 1e-9;

/// Finds back what the touches of a state are about.
class Reader {
 public:
  explicit Reader(const WorldState& state) : state_(state), scene_(*state.scene) {
    for (const WorldState::Cloth& cloth : state.cloths)
      firstVertex_.push_back(firstVertex_.back() + static_cast<int>(cloth.positions.size()));
    ListSolids(scene_, state.report.time, solids_);
    if (!state.obstacles.empty()) obstacles_.emplace(scene_);
  }

  /// Nothing where the touch is of no such state.
  std::optional<ContactForce> Read(const Touch& touch) const {
    ContactForce contact;
    contact.force = touch.force;
    contact.friction = -touch.hold;
    if (touch.kind == 2) {
      if (!IsCloth(touch.number[0]) || touch.number[1] < 0 || Index(touch.number[1]) >= solids_.size()) return {};
      Name(touch.number[0], contact.cloth, contact.vertex);
      const PlacedSolid& solid = solids_[Index(touch.number[1])];
      const Vec3& at = PositionOf(touch.number[0]);
      const SolidSample sample = DistanceTo(solid, at);
      contact.normal = sample.normal;
      contact.point = at - sample.normal * (0.5 * sample.distance);
      contact.coefficient = solid.friction;
      return Finished(contact);
    }
    const PairKind kind = touch.kind == 0 ? PairKind::VertexTriangle : PairKind::EdgeEdge;
    Corners<double> x;
    for (std::size_t k = 0; k < 4; ++k) {
      if (touch.number[k] < 0 || touch.number[k] >= EndVertex()) return {};
      x[k] = From<double>(PositionOf(touch.number[k]));
    }
    const PairState pair = StateOf(kind, x);
    contact.normal = ToVec3(pair.normal);
    std::size_t most[2] = {0, 3};  // on the side of the normal, and on the other
    for (std::size_t k = 0; k < 4; ++k) {
      contact.point += 0.5 * std::abs(pair.weight[k]) * ToVec3(x[k]);
      const bool first = k == 0 || (k == 1 && kind == PairKind::EdgeEdge);
      std::size_t& leader = most[first ? 0 : 1];
      if (std::abs(pair.weight[k]) > std::abs(pair.weight[leader])) leader = k;
    }
    const std::int32_t a = touch.number[most[0]], b = touch.number[most[1]];
    contact.coefficient = FrictionOf(a, b);
    if (IsCloth(a)) {
      Name(a, contact.cloth, contact.vertex);
      if (IsCloth(b)) Name(b, contact.otherCloth, contact.otherVertex);
    } else {
      Name(b, contact.cloth, contact.vertex);
      contact.normal = -contact.normal;
      contact.friction = -contact.friction;
    }
    return Finished(contact);
  }

 private:
  bool IsCloth(std::int32_t vertex) const { return vertex < firstVertex_.back(); }
  /// Of cloths and obstacles.
  std::int32_t EndVertex() const {
    return firstVertex_.back() + static_cast<std::int32_t>(obstacles_ ? state_.obstacles.size() / 2 : 0);
  }
  void Name(std::int32_t number, int& cloth, int& vertex) const {
    cloth =
        static_cast<int>(std::upper_bound(firstVertex_.begin(), firstVertex_.end(), number) - firstVertex_.begin()) - 1;
    vertex = number - firstVertex_[Index(cloth)];
  }
  const Vec3& PositionOf(std::int32_t number) const {
    // The first half of the obstacles is where they were.
    if (!IsCloth(number)) return state_.obstacles[state_.obstacles.size() / 2 + Index(number - firstVertex_.back())];
    int cloth = 0, vertex = 0;
    Name(number, cloth, vertex);
    return state_.cloths[Index(cloth)].positions[Index(vertex)];
  }
  /// A collider rules alone.
  double FrictionOf(std::int32_t a, std::int32_t b) const {
    double sum = 0;
    for (const std::int32_t number : {a, b}) {
      if (IsCloth(number)) {
        int cloth = 0, vertex = 0;
        Name(number, cloth, vertex);
        sum += scene_.cloths[Index(cloth)].friction;
        continue;
      }
      const std::span<const Obstacle> all = obstacles_->all();
      const auto next = std::upper_bound(all.begin(), all.end(), number - firstVertex_.back(),
                                         [](std::int32_t v, const Obstacle& obstacle) { return v < obstacle.first; });
      return percale::FrictionOf(scene_, *std::prev(next));
    }
    return 0.5 * sum;
  }
  /// As the normal is now, which was another one when the step began.
  static ContactForce Finished(ContactForce contact) {
    const double most = contact.coefficient * contact.force, length = Length(contact.friction);
    contact.slides = length >= most * (1 - kRounding);
    contact.friction -= contact.normal * Dot(contact.normal, contact.friction);
    return contact;
  }

  const WorldState& state_;
  const Scene& scene_;
  std::vector<int> firstVertex_{0};  // of each cloth, and the end
  std::vector<PlacedSolid> solids_;
  std::optional<Obstacles> obstacles_;
};

}  // namespace

std::vector<ContactForce> ReadContacts(const WorldState& state) {
  std::vector<ContactForce> contacts;
  if (state.touches.empty()) return contacts;
  const Reader reader(state);
  for (const Touch& touch : state.touches) {
    if (const auto contact = reader.Read(touch)) contacts.push_back(*contact);
  }
  return contacts;
}

std::vector<ContactForce> ReadContacts(const World& world) {
  if (world.scene().simulation.engine != Engine::Fabric) return {};
  WorldState state;
  world.Save(state);
  return ReadContacts(state);
}

}  // namespace percale
