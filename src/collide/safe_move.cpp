#include "collide/safe_move.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/index.h"
#include "core/memory.h"

namespace percale {
namespace {

constexpr int kPairsPerChunk = 1024;
/// Of so many pairs at a time it is seen whether they are near: they take 6 MB, and each thread of some has chunks.
constexpr std::size_t kPairsAtOnce = 64 * kPairsPerChunk;
/// Sweeps from which on what fails goes half as far, and no farther at all.
constexpr int kHalveFrom = 10, kStopFrom = 25;
/// Searches from which on every vertex counts as cut, so that no more is needed; and after which a move that may give
/// up does.
constexpr int kMostSearches = 10, kFewSearches = 4;
/// Then nothing goes farther than so many distances of contact.
constexpr double kLongest = 60;
/// Cloth is in contact with itself below this share of the distance that the pair has in the flat mesh.
constexpr double kOwnShare = 0.35;

Corners<double> Gather(std::span<const Vec3> x, const VertexQuad& quad) {
  Corners<double> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = From<double>(x[Index(quad[k])]);
  return corners;
}

constexpr PairKind kKinds[2] = {PairKind::VertexTriangle, PairKind::EdgeEdge};

int Chunks(std::size_t pairs) {
  return static_cast<int>((pairs + kPairsPerChunk - 1) / kPairsPerChunk);
}

/// Calls body(chunk, begin, end) for the chunks of so many pairs.
template <class Body>
void ForChunks(const Executor& executor, std::size_t pairs, Body&& body) {
  executor.ForChunks(Chunks(pairs), [&](int chunk) {
    const std::size_t begin = Index(chunk) * kPairsPerChunk;
    body(chunk, begin, std::min(pairs, begin + kPairsPerChunk));
  });
}

}  // namespace

double FloorOf(double gap, double distance, double core) {
  if (core > 0) return gap > core ? core + FloorOf(gap - core, distance) : 0.5 * gap;
  return std::min(0.999 * gap, std::max(std::min(0.2 * gap, 0.25 * distance), 0.05 * distance));
}

SafeMove::SafeMove(const ContactMesh& mesh, const Executor& executor)
    : mesh_(mesh), executor_(executor), finder_(mesh, executor) {
  for (std::vector<std::uint8_t>* flags : {&cut_, &changed_, &next_}) flags->resize(Index(mesh.vertices()));
}

void SafeMove::Clear() {
  for (NearPairs& pairs : pairs_) pairs.Resize(0);
}

std::size_t SafeMove::MemoryBytes() const {
  std::size_t sum = finder_.MemoryBytes() + BytesOf(limited_) + BytesOf(least_) + BytesOf(cut_) + BytesOf(changed_) +
                    BytesOf(next_) + BytesOf(someEnd_);
  for (const NearPairs* pairs : {&pairs_[0], &pairs_[1], &some_})
    sum += BytesOf(pairs->vertex) + BytesOf(pairs->distance) + BytesOf(pairs->start);
  for (const std::vector<double>& shares : shares_) sum += BytesOf(shares);
  return sum;
}

double SafeMove::DistanceOf(PairKind kind, const VertexQuad& quad, const ContactDistances& distances) const {
  const std::int32_t one = mesh_.body[Index(quad[0])], other = mesh_.body[Index(quad[3])];
  const double distance = distances.Between(one, other) - distances.CoreOf(one, other);
  if (one != other) return distance;
  const Corners<double> place = Gather(mesh_.place, quad);
  // Most pairs lie far apart in the mesh, and that is seen at once.
  const Vector3<double> way = place[0] - place[3];
  const Vector3<double> p = place[1] - place[0], q = place[2] - place[3];
  const double reach = distance / kOwnShare + std::sqrt(Dot(p, p)) + std::sqrt(Dot(q, q));
  if (Dot(way, way) > 4 * reach * reach) return distance;
  return std::min(distance, kOwnShare * std::sqrt(ClosestOf(kind, place).squared));
}

/// Calls body(kind, begin, end) for pairs of one kind, chunk by chunk.
template <class Body>
void SafeMove::ForPairs(Body&& body) {
  for (std::size_t kind = 0; kind < 2; ++kind) {
    ForChunks(executor_, pairs_[kind].size(), [&](int, std::size_t begin, std::size_t end) { body(kind, begin, end); });
  }
}

/// All pairs that might meet or be in contact soon, and how they are at the start.
void SafeMove::Search(const Ways& ways, std::span<const Vec3> gone, const ContactDistances& distances) {
  finder_.Find({.start = ways.start, .way = gone, .cut = cut_}, distances.half, distances.clothPairs);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const std::span<const VertexQuad> found = kind == 0 ? finder_.vertexTriangle() : finder_.edgeEdge();
    pairs_[kind].Resize(0);
    for (std::size_t first = 0; first < found.size(); first += kPairsAtOnce)
      Keep(kind, found.subspan(first, std::min(kPairsAtOnce, found.size() - first)), ways, distances);
    shares_[kind].assign(pairs_[kind].size(), 1);
  }
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{1});
}

/// Of some pairs that were found those that are to be minded. Most are not: boxes of neighbours overlap. What stays
/// farther apart than soon in contact, even if it goes the same ways twice, is not; unless one of it was cut, for then
/// the others may leave it behind.
void SafeMove::Keep(std::size_t kind, std::span<const VertexQuad> found, const Ways& ways,
                    const ContactDistances& distances) {
  if (some_.size() < found.size()) some_.Resize(found.size());
  someEnd_.resize(Index(Chunks(found.size())));
  const auto staysFar = [&](const VertexQuad& v, const PairState& now) {
    if (cut_[Index(v[0])] | cut_[Index(v[1])] | cut_[Index(v[2])] | cut_[Index(v[3])]) return false;
    const std::int32_t one = mesh_.body[Index(v[0])], other = mesh_.body[Index(v[3])];
    const double core = distances.CoreOf(one, other);
    double distance = distances.Between(one, other) - core;
    if (one == other) {
      // What are the closest points now is as near in the flat mesh as any, or less so.
      Vector3<double> way;
      for (std::size_t k = 0; k < 4; ++k) way += From<double>(mesh_.place[Index(v[k])]) * now.weight[k];
      distance = std::min(distance, kOwnShare * std::sqrt(Dot(way, way)));
    }
    const double room = now.gap - core - kSoon * distance;
    return room > 0 && 2 * Approach(kKinds[kind], Gather(ways.way, v)) < room;
  };
  ForChunks(executor_, found.size(), [&](int chunk, std::size_t begin, std::size_t end) {
    std::size_t next = begin;
    StatesOf(kKinds[kind], found.subspan(begin, end - begin), ways.start,
             std::span(some_.start).subspan(begin, end - begin));
    for (std::size_t p = begin; p < end; ++p) {
      const VertexQuad& v = found[p];
      const PairState state = some_.start[p];
      if (staysFar(v, state)) continue;
      if (untangler_ && untangler_->LetsPass(kKinds[kind], v)) continue;
      some_.vertex[next] = v;
      some_.distance[next] = DistanceOf(kKinds[kind], v, distances);
      some_.start[next++] = state;
    }
    someEnd_[Index(chunk)] = next;
  });
  NearPairs& pairs = pairs_[kind];
  for (int chunk = 0; chunk < Chunks(found.size()); ++chunk) {
    const auto append = [&](const auto& from, auto& to) {
      to.insert(to.end(), from.data() + Index(chunk) * kPairsPerChunk, from.data() + someEnd_[Index(chunk)]);
    };
    append(some_.vertex, pairs.vertex);
    append(some_.distance, pairs.distance);
    append(some_.start, pairs.start);
  }
}

/// Tests the pairs of vertices that changed, and shortens the ways of those that fail. Returns how many do.
std::int64_t SafeMove::Cut(const Ways& ways, const ContactDistances& distances, int sweep) {
  ForPairs([&](std::size_t kind, std::size_t begin, std::size_t end) {
    const NearPairs& pairs = pairs_[kind];
    for (std::size_t p = begin; p < end; ++p) {
      shares_[kind][p] = 1;
      const VertexQuad& v = pairs.vertex[p];
      if (!(changed_[Index(v[0])] | changed_[Index(v[1])] | changed_[Index(v[2])] | changed_[Index(v[3])])) continue;
      const double gap = pairs.start[p].gap;
      if (!(gap > 0)) continue;
      Corners<double> way;
      for (std::size_t k = 0; k < 4; ++k) way[k] = From<double>(ways.way[Index(v[k])]) * ways.share[Index(v[k])];
      const double core = distances.CoreOf(mesh_.body[Index(v[0])], mesh_.body[Index(v[3])]);
      shares_[kind][p] =
          ShareApart(kKinds[kind], Gather(ways.start, v), way, pairs.start[p], FloorOf(gap, pairs.distance[p], core));
    }
  });
  const auto fails = [](double share) { return share < 1; };
  if (std::none_of(shares_[0].begin(), shares_[0].end(), fails) &&
      std::none_of(shares_[1].begin(), shares_[1].end(), fails)) {
    return 0;
  }
  std::int64_t failed = 0;
  std::fill(next_.begin(), next_.end(), std::uint8_t{0});
  least_.assign(next_.size(), 1.0);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    for (std::size_t p = 0; p < pairs_[kind].size(); ++p) {
      double share = shares_[kind][p];
      if (share >= 1) continue;
      ++failed;
      if (sweep >= kStopFrom)
        share = 0;
      else if (sweep >= kHalveFrom)
        share *= 0.5;
      for (const std::int32_t v : pairs_[kind].vertex[p]) {
        const Vec3& way = ways.way[Index(v)];
        if (Dot(way, way) == 0) continue;
        least_[Index(v)] = std::min(least_[Index(v)], share);
        next_[Index(v)] = 1;
      }
    }
  }
  for (std::size_t v = 0; v < least_.size(); ++v) ways.share[v] *= least_[v];
  std::swap(changed_, next_);
  return failed;
}

/// Lets all go only so far that their ways, each anywhere along its own, do not come near everything. False: they
/// do not anyway.
bool SafeMove::LimitWays(const Ways& ways, const ContactDistances& distances) {
  double longest = 0, distance = 0;
  for (std::size_t v = 0; v < ways.way.size(); ++v) longest = std::max(longest, Length(ways.way[v]) * ways.share[v]);
  for (std::size_t body = 0; body < distances.half.size(); ++body) {
    const auto number = static_cast<std::int32_t>(body);
    distance = std::max(distance, 2 * distances.half[body] - distances.CoreOf(number, number));
  }
  const double most = kLongest * distance;
  if (longest <= most) return false;
  limited_.resize(ways.way.size());
  for (std::size_t v = 0; v < ways.way.size(); ++v) {
    ways.share[v] *= most / longest;
    limited_[v] = ways.way[v] * ways.share[v];
  }
  return true;
}

void SafeMove::List(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances) {
  std::fill(cut_.begin(), cut_.end(), std::uint8_t{0});
  Search({start, way, {}}, way, distances);
}

bool SafeMove::AnyNear(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances) {
  finder_.Find({.start = start, .way = way, .cut = {}}, distances.half, distances.clothPairs);
  std::atomic<bool> any = false;
  for (const PairKind kind : kKinds) {
    const std::span<const VertexQuad> found =
        kind == PairKind::VertexTriangle ? finder_.vertexTriangle() : finder_.edgeEdge();
    ForChunks(executor_, found.size(), [&](int, std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end && !any; ++p) {
        const VertexQuad& v = found[p];
        const double reach = distances.Between(mesh_.body[Index(v[0])], mesh_.body[Index(v[3])]);
        const double least = StateOf(kind, Gather(start, v)).gap - Approach(kind, Gather(way, v));
        if (!(least >= reach)) any = true;
      }
    });
  }
  return any;
}

SafeMoveReport SafeMove::Move(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances,
                              std::span<double> share, bool mayGiveUp) {
  SafeMoveReport report;
  const Ways ways{start, way, share};
  std::fill(share.begin(), share.end(), 1.0);
  std::fill(cut_.begin(), cut_.end(), std::uint8_t{0});
  std::span<const Vec3> gone = way;
  Search(ways, gone, distances);
  ++report.detections;
  for (int sweep = 0; Cut(ways, distances, sweep) > 0; ++sweep) {
    // Whoever is cut may meet what was not listed.
    bool more = false;
    for (std::size_t v = 0; v < cut_.size(); ++v) {
      if (!changed_[v] || cut_[v]) continue;
      cut_[v] = 1;
      more = true;
    }
    if (!more) continue;
    if (mayGiveUp && report.detections >= kFewSearches) {
      report.gaveUp = true;
      return report;
    }
    if (report.detections + 1 >= kMostSearches) {
      std::fill(cut_.begin(), cut_.end(), std::uint8_t{1});
      if (LimitWays(ways, distances)) gone = limited_;
    }
    Search(ways, gone, distances);
    ++report.detections;
  }
  for (std::size_t v = 0; v < share.size(); ++v) {
    const double wanted = Length(way[v]), lost = 1 - share[v];
    report.wanted += wanted;
    report.lost += wanted * lost;
    report.worst = std::max(report.worst, wanted * lost);
    report.cut += lost > 0 ? 1 : 0;
  }
  return report;
}

}  // namespace percale
