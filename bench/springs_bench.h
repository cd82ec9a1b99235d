#pragma once
/// \file
/// `percale bench springs`: the speed of the spring engine beside that of the plain twin.

#include <filesystem>
#include <vector>

namespace percale::bench {

struct SpringsBenchOptions {
  /// Folder that holds scene/pinned2.json and scene/selfCollision.json; empty: the same scenes,
  /// built in code.
  std::filesystem::path root;
  std::vector<int> sizes{50, 100, 200};  ///< Points along a side of the sheet, each >= 3.
  int threads = 0;                       ///< Of the many-threaded runs, >= 1; 0: one per core.
  int frames = 0;                        ///< Timed per round, of which there are five; 0: fewer for larger sheets.
  bool json = false;                     ///< One JSON object on stdout instead of tables.
};

/// Times pinned2 and selfCollision at each size, and the four hash functions, and prints tables to
/// stdout, progress to stderr. Twin and engine take turns over the same frames, and each number is
/// the median over the rounds, so a machine that others use as well distorts neither.
/// Returns the program's exit code: 0; 1 when a position differs between twin and engine, or
/// between numbers of threads; 3 when a scene file cannot be read.
int BenchSprings(const SpringsBenchOptions& options);

}  // namespace percale::bench
