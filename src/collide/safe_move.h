#pragma once
/// \file
/// Moves all vertices of a mesh along straight lines as far as they can go without anything passing through anything.
/// docs/contact.md has the argument why nothing can.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/pair_finder.h"
#include "collide/proximity.h"
#include "collide/untangle.h"
#include "core/executor.h"

namespace percale {

/// How near things may come to each other.
struct ContactDistances {
  std::vector<double> half;  ///< Per body: two are in contact when nearer than the sum of theirs [m].
  bool clothPairs = true;    ///< Whether cloth feels cloth.
  std::vector<double>
      core{};  ///< Per body: so much of its half is solid all around its vertices and edges [m]; or none.

  /// Below which two bodies are in contact, with what is solid between them [m].
  double Between(std::int32_t body, std::int32_t other) const {
    return half[static_cast<std::size_t>(body)] + half[static_cast<std::size_t>(other)];
  }
  /// What is solid between two bodies, of their distance [m].
  double CoreOf(std::int32_t body, std::int32_t other) const {
    return core.empty() ? 0 : core[static_cast<std::size_t>(body)] + core[static_cast<std::size_t>(other)];
  }
};

/// Two things that are nearer than so many times their distance of contact may be in contact soon.
inline constexpr double kSoon = 2;

/// What is near a way: two things each.
struct NearPairs {
  std::vector<VertexQuad> vertex;
  std::vector<double> distance;  ///< Below which they are in contact [m].
  std::vector<PairState> start;  ///< As the move began.

  std::size_t size() const { return vertex.size(); }
  void Resize(std::size_t count) { vertex.resize(count), distance.resize(count), start.resize(count); }
};

struct SafeMoveReport {
  int detections = 0;    ///< Searches for pairs.
  std::int64_t cut = 0;  ///< Vertices that did not go all their way.
  double lost = 0;       ///< Sum of what was cut off the ways [m].
  double worst = 0;      ///< The most that was cut off a way [m].
  double wanted = 0;     ///< Sum of the ways [m].
  bool gaveUp = false;   ///< Nothing else was found out.
};

class SafeMove {
 public:
  /// Both must outlive it. The mesh has its clusters.
  SafeMove(const ContactMesh& mesh, const Executor& executor);

  /// What it lets pass through each other from now on is not kept apart. None: all is. It must outlive its use.
  void Exempt(const Untangler* untangler) { untangler_ = untangler; }

  /// Shortens ways from `start` so that no pair meets: writes the share of its way that each vertex goes. A vertex
  /// without a way stays. `mayGiveUp`: where one cut leads to the next for long, the report may say so instead.
  /// Allocates only where there are more pairs than ever before.
  SafeMoveReport Move(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances,
                      std::span<double> share, bool mayGiveUp = false);

  /// Lists what is near a way that is gone already.
  void List(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances);

  /// Whether any two things without a vertex in common may come nearer than the halves of their bodies on their ways.
  bool AnyNear(std::span<const Vec3> start, std::span<const Vec3> way, const ContactDistances& distances);

  /// All that was in contact or soon to be in the last move or on the last way listed, or would be after such a way
  /// once more; and more. Not what may pass through each other.
  const NearPairs& vertexTriangle() const { return pairs_[0]; }
  const NearPairs& edgeEdge() const { return pairs_[1]; }
  /// Forgets them.
  void Clear();
  /// Of all that it holds.
  std::size_t MemoryBytes() const;

  /// Below which the two of a pair count as in contact, beyond their cores: the sum of their bodies' halves, less where
  /// they are as near in the mesh itself.
  double DistanceOf(PairKind kind, const VertexQuad& quad, const ContactDistances& distances) const;

 private:
  struct Ways {
    std::span<const Vec3> start, way;
    std::span<double> share;
  };

  /// Where all may go as far as `gone`.
  void Search(const Ways& ways, std::span<const Vec3> gone, const ContactDistances& distances);
  void Keep(std::size_t kind, std::span<const VertexQuad> found, const Ways& ways, const ContactDistances& distances);
  template <class Body>
  void ForPairs(Body&& body);
  bool LimitWays(const Ways& ways, const ContactDistances& distances);
  std::int64_t Cut(const Ways& ways, const ContactDistances& distances, int sweep);

  const ContactMesh& mesh_;
  const Executor& executor_;
  PairFinder finder_;
  const Untangler* untangler_ = nullptr;
  NearPairs pairs_[2];                // by kind
  NearPairs some_;                    // of some that are found at a time: what each chunk keeps, from where it begins
  std::vector<std::size_t> someEnd_;  // per chunk
  std::vector<double> shares_[2];     // per pair, of the last test
  std::vector<Vec3> limited_;         // per vertex: the way that it may go; none before LimitWays
  std::vector<double> least_;         // per vertex: of the pairs that fail in a sweep; none before any did
  std::vector<std::uint8_t> cut_, changed_, next_;  // per vertex
};

/// How near a pair may come that starts at a distance `gap` and is in contact below `distance` [m]: so far that it can
/// get there again and again and never meets, and not so far that fast cloth stops in the air.
double FloorOf(double gap, double distance, double core = 0);

}  // namespace percale
