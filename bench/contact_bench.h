#pragma once
/// \file
/// `percale bench contact`: what contact costs in the fabric engine.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/fabric_bench.h"

namespace percale::bench {

struct ContactBenchOptions {
  std::vector<int> sizes{50, 100};  ///< Points along a side of the sheet, each >= 3.
  int threads = 0;                  ///< Of the many-threaded runs, >= 1; 0: one per core.
  int frames = 0;                   ///< Of each run, >= 4; 0: 120.
};

/// A part of a run, the frames of which are alike.
struct ContactPhase {
  std::string name;
  double frame = 0;     ///< Median time of a frame [s].
  double worst = 0;     ///< Of the slowest frame [s].
  double safeMove = 0;  ///< Share of the safe move, with its search for pairs and their distances.
  double contacts = 0;  ///< Mean of what touches.
};

struct ContactRun {
  std::string scene;
  int size = 0;
  int threads = 0;
  double lostMotion = 0;  ///< Share of the ways of all vertices that was cut off, in the worst frame.
  int splits = 0;         ///< Steps that were done over in parts.
  std::vector<ContactPhase> phases{};
};

struct ContactBench {
  std::vector<ContactRun> runs;
  bool equal = true;               ///< All numbers of threads came to the same bits.
  std::int64_t intersections = 0;  ///< That the judge found, in all frames of all runs with one thread.
};

/// The goals of the project beside what was measured, of the sizes that were.
std::vector<FabricTarget> Targets(const ContactBench& bench);

/// Lets a sheet of cotton of 1 m^2 fall on a ball and a floor, where it comes to rest in folds, and the same sheet hang
/// by two corners with nothing to touch; each with one thread and with many.
ContactBench MeasureContact(const ContactBenchOptions& options);

std::string FormatTable(const ContactBench& bench);
std::string FormatJson(const ContactBench& bench);

}  // namespace percale::bench
