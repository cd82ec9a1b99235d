#pragma once
/// \file
/// `percale bench springs`: the speed of the spring engine beside that of the plain twin.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/plain_twin.h"
#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale::bench {

struct SpringsBenchOptions {
  /// Folder that holds scene/pinned2.json and scene/selfCollision.json; empty: the same scenes,
  /// built in code.
  std::filesystem::path root;
  std::vector<int> sizes{50, 100, 200};  ///< Points along a side of the sheet, each >= 3.
  int threads = 0;                       ///< Of the many-threaded runs, >= 1; 0: one per core.
  int frames = 0;                        ///< Timed, from the start of the scene; 0: fewer for larger sheets.
};

/// Twin and engine on one scene. Times are the median over the rounds, per point and step [ns].
struct SpringsRun {
  std::string scene;
  int size = 0;
  int frames = 0;                      ///< Timed, from the start of the scene.
  double twin = 0, one = 0, many = 0;  ///< Of the twin, of the engine on one thread and on many.
  double ratioOne = 0, ratioMany = 0;  ///< How many times faster than the twin.
  std::array<double, kStageCount> stagesOne{}, stagesMany{};
  bool equal = false;  ///< Twin and engine come to the same bits.
};

/// A hash function on a folded sheet.
struct HashRun {
  std::string function;
  PlainTwin::PairCount pairs;
  double time = 0;  ///< Of a step [ms].
};

struct SpringsBench {
  int threads = 0;
  std::vector<SpringsRun> runs;
  std::vector<HashRun> hashes;

  bool Equal() const;
};

/// Times pinned2 and selfCollision at each size, and the four hash functions; progress goes to stderr. Twin and engine
/// take turns over the same frames, and each number is the median of three rounds, so a machine that others use as well
/// distorts neither. Fails when a scene file cannot be read.
Result<SpringsBench> MeasureSprings(const SpringsBenchOptions& options);

std::string FormatTables(const SpringsBench& bench);
std::string FormatJson(const SpringsBench& bench);

}  // namespace percale::bench
