#include "mesh/topology.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/index.h"
#include "mesh/disjoint_sets.h"

namespace percale {
namespace {

std::int32_t Corner(const Triangle& t, int k) {
  return k == 0 ? t.a : k == 1 ? t.b : t.c;
}
std::int32_t Next(std::int32_t side) {
  return side % 3 == 2 ? side - 2 : side + 1;
}

/// Sums of the counts before each entry: where the entries of each bucket begin.
void BeginsFromCounts(std::vector<std::int32_t>& counts) {
  std::int32_t sum = 0;
  for (std::int32_t& count : counts) {
    const std::int32_t here = count;
    count = sum;
    sum += here;
  }
}

void FindComponents(Topology& topology, std::size_t vertexCount, std::span<const Triangle> triangles) {
  DisjointSets pieces(vertexCount);
  for (const Triangle& t : triangles) {
    pieces.Join(t.a, t.b);
    pieces.Join(t.a, t.c);
  }
  topology.component.assign(vertexCount, -1);
  for (std::size_t v = 0; v < vertexCount; ++v) {
    if (topology.cornerBegin[v] == topology.cornerBegin[v + 1]) continue;
    const std::int32_t root = pieces.Find(static_cast<std::int32_t>(v));
    topology.component[v] = Index(root) == v ? topology.componentCount++ : topology.component[Index(root)];
  }
}

/// Bits of the Hilbert curve for each axis.
constexpr int kBits = 21;

/// Number of a cell along the Hilbert curve.
std::uint64_t HilbertKey(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t kTop = 1u << (kBits - 1);
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& xi : x) {
      if ((xi & q) != 0) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ xi) & p;
        x[0] ^= t;
        xi ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    if ((x[2] & q) != 0) t ^= q - 1;
  }
  std::uint64_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t xi : x) key = (key << 1) | (((xi ^ t) >> bit) & 1);
  }
  return key;
}

}  // namespace

Topology BuildTopology(std::size_t vertexCount, std::span<const Triangle> triangles) {
  assert(triangles.size() <= 715'827'882);
  Topology topology;
  const std::size_t sides = 3 * triangles.size();

  topology.cornerBegin.assign(vertexCount + 1, 0);
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) ++topology.cornerBegin[Index(Corner(t, k))];
  }
  BeginsFromCounts(topology.cornerBegin);
  topology.corners.resize(sides);
  std::vector<std::int32_t> end = topology.cornerBegin;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k)
      topology.corners[Index(end[Index(Corner(triangles[t], k))]++)] = static_cast<std::int32_t>(3 * t) + k;
  }

  // The sides by the lower of their ends; then, within one lower end, by the other end and their number.
  struct Side {
    std::int32_t high, side;
  };
  const auto from = [&](std::int32_t side) { return Corner(triangles[Index(side / 3)], side % 3); };
  std::vector<std::int32_t> begin(vertexCount + 1, 0);
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) ++begin[Index(std::min(Corner(t, k), Corner(t, (k + 1) % 3)))];
  }
  BeginsFromCounts(begin);
  std::vector<Side> sorted(sides);
  end = begin;
  for (std::int32_t side = 0; Index(side) < sides; ++side) {
    const std::int32_t a = from(side), b = from(Next(side));
    assert(a != b);
    sorted[Index(end[Index(std::min(a, b))]++)] = {std::max(a, b), side};
  }
  topology.sideEdges.resize(sides);
  for (auto* list : {&topology.edgeTriangles, &topology.edgeOpposite}) list->reserve(sides / 2 + vertexCount / 8);
  topology.edges.reserve(sides / 2 + vertexCount / 8);
  for (std::size_t v = 0; v < vertexCount; ++v) {
    const auto first = sorted.begin() + begin[v], last = sorted.begin() + begin[v + 1];
    std::sort(first, last,
              [](const Side& a, const Side& b) { return a.high != b.high ? a.high < b.high : a.side < b.side; });
    for (auto s = first; s != last;) {
      const auto edge = static_cast<std::int32_t>(topology.edges.size());
      const auto low = static_cast<std::int32_t>(v);
      auto stop = s;
      for (; stop != last && stop->high == s->high; ++stop) topology.sideEdges[Index(stop->side)] = edge;
      topology.edges.push_back({low, s->high});
      std::array<std::int32_t, 2> meeting{-1, -1}, opposite{-1, -1};
      if (stop - s <= 2) {
        std::array<std::int32_t, 2> both{s->side, stop - s == 2 ? (s + 1)->side : -1};
        if (both[1] >= 0) {
          const bool forwards[2] = {from(both[0]) == low, from(both[1]) == low};
          if (forwards[0] == forwards[1]) topology.inconsistentEdges.push_back(edge);
          if (!forwards[0] && forwards[1]) std::swap(both[0], both[1]);
        } else {
          topology.boundaryEdges.push_back(edge);
        }
        for (std::size_t i = 0; i < 2 && both[i] >= 0; ++i) {
          meeting[i] = both[i] / 3;
          opposite[i] = from(Next(Next(both[i])));
        }
      } else {
        topology.nonManifoldEdges.push_back(edge);
      }
      topology.edgeTriangles.push_back(meeting);
      topology.edgeOpposite.push_back(opposite);
      s = stop;
    }
  }
  FindComponents(topology, vertexCount, triangles);
  return topology;
}

TurnedTriangles FindOrientation(const Topology& topology) {
  TurnedTriangles result;
  const std::size_t count = topology.sideEdges.size() / 3;
  std::vector<bool> inconsistent(topology.edges.size());
  for (const std::int32_t edge : topology.inconsistentEdges) inconsistent[Index(edge)] = true;
  std::vector<std::int8_t> turned(count, -1);  // against the lowest triangle of the patch; -1: not met yet
  std::vector<std::int32_t> patch;
  for (std::size_t seed = 0; seed < count; ++seed) {
    if (turned[seed] >= 0) continue;
    patch.assign(1, static_cast<std::int32_t>(seed));
    turned[seed] = 0;
    bool twoSided = true;
    std::size_t different = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::int32_t t = patch[i];
      different += turned[Index(t)] != 0 ? 1 : 0;
      for (int k = 0; k < 3; ++k) {
        const std::int32_t edge = topology.sideEdges[3 * Index(t) + static_cast<std::size_t>(k)];
        const auto& both = topology.edgeTriangles[Index(edge)];
        if (both[1] < 0) continue;
        const std::int32_t other = both[0] == t ? both[1] : both[0];
        const auto wanted = static_cast<std::int8_t>((turned[Index(t)] != 0) != inconsistent[Index(edge)] ? 1 : 0);
        if (turned[Index(other)] < 0) {
          turned[Index(other)] = wanted;
          patch.push_back(other);
        } else if (turned[Index(other)] != wanted) {
          twoSided = false;
        }
      }
    }
    if (!twoSided) {
      result.oneSided.push_back(static_cast<std::int32_t>(seed));
      continue;
    }
    const bool turnDifferent = 2 * different <= patch.size();
    for (const std::int32_t t : patch) {
      if ((turned[Index(t)] != 0) == turnDifferent) result.turn.push_back(t);
    }
  }
  std::sort(result.turn.begin(), result.turn.end());
  return result;
}

std::vector<std::int32_t> LocalityOrder(std::span<const Vec3> positions) {
  struct Keyed {
    std::uint64_t key;
    std::int32_t vertex;
  };
  std::vector<Keyed> keyed(positions.size());
  Vec3 low, high;
  if (!positions.empty()) low = high = positions[0];
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double longest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  constexpr double kCells = static_cast<double>((1 << kBits) - 1);
  const auto cell = [&](double x) { return longest > 0 ? static_cast<std::uint32_t>(x / longest * kCells) : 0u; };
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 p = positions[v] - low;
    keyed[v] = {HilbertKey({cell(p.x), cell(p.y), cell(p.z)}), static_cast<std::int32_t>(v)};
  }
  std::sort(keyed.begin(), keyed.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.vertex < b.vertex; });
  std::vector<std::int32_t> order(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].vertex;
  return order;
}

void ReorderMesh(RestMesh& mesh, std::span<const std::int32_t> order) {
  assert(order.size() == mesh.positions.size());
  std::vector<std::int32_t> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) number[Index(order[i])] = static_cast<std::int32_t>(i);
  const auto take = [&](auto& values) {
    if (values.empty()) return;
    auto old = values;
    for (std::size_t i = 0; i < order.size(); ++i) values[i] = old[Index(order[i])];
  };
  take(mesh.positions);
  take(mesh.uv);
  take(mesh.source);
  for (VertexGroup& group : mesh.groups) {
    for (std::int32_t& v : group.vertices) v = number[Index(v)];
    std::sort(group.vertices.begin(), group.vertices.end());
  }
  for (Triangle& t : mesh.triangles) t = {number[Index(t.a)], number[Index(t.b)], number[Index(t.c)]};

  const auto lowest = [&](std::int32_t t) {
    return std::min({mesh.triangles[Index(t)].a, mesh.triangles[Index(t)].b, mesh.triangles[Index(t)].c});
  };
  std::vector<std::int32_t> sorted(mesh.triangles.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](std::int32_t s, std::int32_t t) {
    const std::int32_t a = lowest(s), b = lowest(t);
    return a != b ? a < b : s < t;
  });
  const std::vector<Triangle> triangles = mesh.triangles;
  const std::vector<Vec2> material = mesh.material;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    mesh.triangles[i] = triangles[Index(sorted[i])];
    for (std::size_t k = 0; k < 3 && !material.empty(); ++k)
      mesh.material[3 * i + k] = material[3 * Index(sorted[i]) + k];
  }
}

}  // namespace percale
