#include "world/measure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/index.h"

namespace percale {
namespace {

double SquaredLength(const Vec3& a) {
  return Dot(a, a);
}

/// Of length over rest length; 1 for a spring without a rest length.
double SquaredRatio(std::span<const Vec3> positions, const Edge& spring, double atRest) {
  if (!(atRest > 0)) return 1;
  return SquaredLength(positions[Index(spring.a)] - positions[Index(spring.b)]) / (atRest * atRest);
}

constexpr std::size_t kBitsPerSlot = 16;
constexpr int kCellBits = 21;  // per axis: space repeats after 2^21 cells, which costs time alone

std::uint64_t Cell(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << kCellBits) - 1;
  return (static_cast<std::uint64_t>(x) & mask) | (static_cast<std::uint64_t>(y) & mask) << kCellBits |
         (static_cast<std::uint64_t>(z) & mask) << (2 * kCellBits);
}

/// The numbers of neighbouring cells, far from each other: their low bits choose a slot of a table.
std::uint32_t Mixed(std::uint64_t cell) {
  return static_cast<std::uint32_t>(cell * 0x9e3779b97f4a7c15u >> 32);
}
/// A box that has that cell.
Box BoxOfCell(std::uint64_t cell) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << kCellBits) - 1;
  const auto index = [&](int axis) { return static_cast<std::int64_t>(cell >> (axis * kCellBits) & mask); };
  return {index(0), index(1), index(2)};
}
Box CellOf(const Vec3& p, double size) {
  return BoxOf(p, {size, size, size});
}

bool TouchCloth(const ContactCloth& a, std::size_t p, const ContactCloth& b, std::size_t q) {
  const double near = ContactFinder::kNearShare * (a.thickness + b.thickness);
  if (!(near > 0 && SquaredLength(b.positions[q] - a.positions[p]) <= near * near)) return false;
  const double sheet = ContactFinder::kSheetShare * near;
  return &a != &b || SquaredLength(a.rest[q] - a.rest[p]) >= sheet * sheet;
}
bool Touches(const Vec3& p, const PlacedSolid& solid) {
  return std::abs(DistanceTo(solid, p).distance - solid.thickness) <= ContactFinder::kTouchDistance;
}

/// The cell itself, then half of those around it: of two neighbours one looks at the other.
constexpr Box kHalfAround[] = {{0, 0, 0},  {1, 0, 0},  {-1, 1, 0}, {0, 1, 0}, {1, 1, 0},  {-1, -1, 1}, {0, -1, 1},
                               {1, -1, 1}, {-1, 0, 1}, {0, 0, 1},  {1, 0, 1}, {-1, 1, 1}, {0, 1, 1},   {1, 1, 1}};

}  // namespace

void MeasureStretch(std::span<const Vec3> positions, std::span<const Edge> springs, std::span<const double> lengths,
                    std::span<double> greatest, std::span<double> least) {
  assert(lengths.size() == springs.size() && greatest.size() == positions.size() && least.size() == positions.size());
  constexpr double kNone = -1;
  std::fill(greatest.begin(), greatest.end(), kNone);
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const Edge& spring = springs[s];
    const double ratio = SquaredRatio(positions, spring, lengths[s]);
    for (const std::int32_t end : {spring.a, spring.b}) {
      double &most = greatest[Index(end)], &fewest = least[Index(end)];
      fewest = most == kNone ? ratio : std::min(fewest, ratio);
      most = std::max(most, ratio);
    }
  }
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const bool hasSpring = greatest[v] != kNone;
    greatest[v] = hasSpring ? std::sqrt(greatest[v]) : 1;
    least[v] = hasSpring ? std::sqrt(least[v]) : 1;
  }
}

void AppendStretch(std::span<const Vec3> positions, std::span<const Edge> springs, std::span<const double> lengths,
                   std::vector<double>& ratios) {
  assert(lengths.size() == springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s)
    ratios.push_back(std::sqrt(SquaredRatio(positions, springs[s], lengths[s])));
}

double Percentile(std::span<double> values, double share) {
  assert(!values.empty() && share >= 0 && share <= 1);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

void MeasureSpeed(std::span<const Vec3> velocities, std::span<double> speeds) {
  assert(speeds.size() == velocities.size());
  for (std::size_t v = 0; v < velocities.size(); ++v) speeds[v] = Length(velocities[v]);
}

void CurvatureMeter::Measure(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                             std::span<double> curvatures) {
  assert(curvatures.size() == positions.size());
  sums_.assign(positions.size(), {});
  for (const Triangle& t : triangles) {
    Sums* const corners[3] = {&sums_[Index(t.a)], &sums_[Index(t.b)], &sums_[Index(t.c)]};
    const Vec3 p[3] = {positions[Index(t.a)], positions[Index(t.b)], positions[Index(t.c)]};
    const Vec3 normal = Cross(p[1] - p[0], p[2] - p[0]);
    const double area = Length(normal);  // twice the triangle's
    if (!(area > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      // The cotangent of the angle at k weighs the edge that it faces.
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const Vec3 way = (Dot(p[i] - p[k], p[j] - p[k]) / area) * (p[i] - p[j]);
      corners[i]->bend += way;
      corners[j]->bend -= way;
      corners[k]->normal += normal;
      corners[k]->area += area;
    }
  }
  for (std::size_t v = 0; v < sums_.size(); ++v) {
    const Sums& sum = sums_[v];
    // 2 H = bend / (2 A) along the normal, A a third of the triangles' area.
    const double twoA = sum.area / 3;
    curvatures[v] = sum.area > 0 ? 0.5 * Dot(sum.bend, UnitOr(sum.normal, {})) / twoA : 0;
  }
}

void BoxFinder::Find(std::span<const ClothSettings> cloths, std::span<const std::span<const Vec3>> positions) {
  size_ = BoxSize(cloths);
  boxOf_.clear();
  boxes_.clear();
  for (const std::span<const Vec3> points : positions) {
    for (const Vec3& p : points) boxOf_.push_back(BoxOf(p, size_));
  }
  std::sort(boxOf_.begin(), boxOf_.end(),
            [](const Box& a, const Box& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  for (std::size_t begin = 0, end = 0; begin < boxOf_.size(); begin = end) {
    while (end < boxOf_.size() && boxOf_[end] == boxOf_[begin]) ++end;
    if (end - begin < 2) continue;
    const Box& box = boxOf_[begin];
    const Vec3 corner{double(box.x) * size_.x, double(box.y) * size_.y, double(box.z) * size_.z};
    boxes_.push_back({corner, static_cast<int>(end - begin)});
  }
}

std::vector<PlacedSolid> SolidsAt(const Scene& scene, double time, std::span<const Ball> balls) {
  std::vector<PlacedSolid> solids;
  ListSolids(scene, time, solids);
  if (scene.simulation.engine == Engine::Springs)
    std::erase_if(solids, [](const PlacedSolid& solid) { return solid.collider >= 0; });
  for (const Ball& ball : balls) {
    SphereSettings sphere;
    sphere.origin = ball.position;
    sphere.radius = ball.radius;
    solids.push_back({MakeSolid(sphere), PoseOf(sphere), 0, 0, -1});
  }
  return solids;
}

void ContactFinder::Find(std::span<const ContactCloth> cloths, std::span<const PlacedSolid> solids) {
  positions_.clear();
  firstPoint_.assign(1, 0);
  pairs_.clear();
  for (const ContactCloth& cloth : cloths) {
    positions_.insert(positions_.end(), cloth.positions.begin(), cloth.positions.end());
    firstPoint_.push_back(static_cast<std::int32_t>(positions_.size()));
  }
  contacts_.assign(positions_.size(), Contact::None);
  FindPairs(cloths);
  for (const PlacedSolid& solid : solids) {
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      if (Touches(positions_[p], solid)) contacts_[p] = Contact::Collider;
    }
  }
}

std::span<const Contact> ContactFinder::Of(int cloth) const {
  const std::size_t first = Index(firstPoint_[Index(cloth)]), end = Index(firstPoint_[Index(cloth) + 1]);
  return std::span(contacts_).subspan(first, end - first);
}

VertexRef ContactFinder::Ref(std::int32_t point) const {
  const auto next = std::upper_bound(firstPoint_.begin(), firstPoint_.end(), point);
  const auto cloth = static_cast<int>(next - firstPoint_.begin()) - 1;
  return {cloth, point - firstPoint_[Index(cloth)]};
}

/// Points sorted by the cell that they are in, cells as large as the greatest distance that counts.
void ContactFinder::FindPairs(std::span<const ContactCloth> cloths) {
  double thickest = 0;
  for (const ContactCloth& cloth : cloths) thickest = std::max(thickest, cloth.thickness);
  const double size = 2 * kNearShare * thickest;
  if (!(size > 0)) return;

  std::size_t slots = 64;
  while (slots < 2 * positions_.size()) slots *= 2;
  slotBegin_.assign(slots + 1, 0);
  const auto slotMask = static_cast<std::uint32_t>(slots - 1);
  // Most cells around a point are empty. With so many bits one in 32 of these is taken for another.
  const auto bitMask = static_cast<std::uint32_t>(kBitsPerSlot * slots - 1);
  taken_.assign(kBitsPerSlot * slots / 64, 0);
  cells_.resize(positions_.size());
  members_.resize(positions_.size());
  for (std::size_t p = 0; p < positions_.size(); ++p) {
    const Box at = CellOf(positions_[p], size);
    cells_[p] = Cell(at.x, at.y, at.z);
    const std::uint32_t mixed = Mixed(cells_[p]), bit = mixed & bitMask;
    ++slotBegin_[mixed & slotMask];
    taken_[bit / 64] |= std::uint64_t{1} << bit % 64;
  }
  std::int32_t begin = 0;
  for (std::int32_t& slot : slotBegin_) begin += std::exchange(slot, begin);
  for (std::size_t p = 0; p < positions_.size(); ++p) {
    members_[Index(slotBegin_[Mixed(cells_[p]) & slotMask]++)] = static_cast<std::int32_t>(p);
  }
  // Each slot's entry is where the next one begins by now.
  const auto slotMembers = [&](std::uint32_t slot) {
    const std::int32_t first = slot == 0 ? 0 : slotBegin_[slot - 1];
    return std::span(members_).subspan(Index(first), Index(slotBegin_[slot] - first));
  };

  for (std::size_t c = 0; c < cloths.size(); ++c) {
    for (std::int32_t p = firstPoint_[c]; p < firstPoint_[c + 1]; ++p) {
      // Each coordinate of the cells around, in its place in their numbers.
      const Box at = BoxOfCell(cells_[Index(p)]);
      std::uint64_t x[3], y[3], z[3];
      for (int k = -1; k <= 1; ++k) {
        x[k + 1] = Cell(at.x + k, 0, 0);
        y[k + 1] = Cell(0, at.y + k, 0);
        z[k + 1] = Cell(0, 0, at.z + k);
      }
      for (const Box& step : kHalfAround) {
        const std::uint64_t cell = x[step.x + 1] | y[step.y + 1] | z[step.z + 1];
        const bool own = &step == kHalfAround;
        const std::uint32_t mixed = Mixed(cell), bit = mixed & bitMask;
        if (!(taken_[bit / 64] >> bit % 64 & 1)) continue;
        for (const std::int32_t q : slotMembers(mixed & slotMask)) {
          if (cells_[Index(q)] != cell || (own && q <= p)) continue;
          std::size_t d = c;  // the cloth of q
          while (q < firstPoint_[d]) --d;
          while (q >= firstPoint_[d + 1]) ++d;
          if (!TouchCloth(cloths[c], Index(p - firstPoint_[c]), cloths[d], Index(q - firstPoint_[d]))) continue;
          contacts_[Index(p)] = contacts_[Index(q)] = Contact::Cloth;
          if (pairs_.size() < kMostPairs) pairs_.push_back({Ref(std::min(p, q)), Ref(std::max(p, q))});
        }
      }
    }
  }
}

ContactCount CountContacts(const VertexRef& point, std::span<const ContactCloth> cloths,
                           std::span<const PlacedSolid> solids) {
  ContactCount count;
  const ContactCloth& own = cloths[Index(point.cloth)];
  for (const ContactCloth& cloth : cloths) {
    for (std::size_t q = 0; q < cloth.positions.size(); ++q)
      count.cloth += TouchCloth(own, Index(point.vertex), cloth, q);
  }
  const Vec3& at = own.positions[Index(point.vertex)];
  for (const PlacedSolid& solid : solids) count.colliders += Touches(at, solid);
  return count;
}

}  // namespace percale
