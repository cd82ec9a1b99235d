#pragma once
/// \file
/// `percale bench fabric`: what the continuum engine costs for what accuracy, beside other solvers.

#include <cstdint>
#include <string>
#include <vector>

namespace percale::bench {

struct FabricBenchOptions {
  std::vector<int> sizes;  ///< Vertices along a side of the sheet, each >= 3; empty: 32, 64, 100 for error against
                           ///< time, 32 to 1000 for the cost per vertex.
  int threads = 0;         ///< Of the many-threaded runs, >= 1; 0: one per core.
  int frames = 0;          ///< Simulated per run; 0: 60, fewer for the largest sheets.
};

/// One method at one setting.
struct FabricRun {
  std::string method;             ///< "engine", "Newton, direct" or "XPBD".
  std::string setting;            ///< "3 x 6": iterations of Newton, and of the linear solver in each.
  double milliseconds = 0;        ///< Per frame on one thread: the median.
  double manyMilliseconds = 0;    ///< The same on several threads; 0 where the method has one only.
  double error = 0;               ///< Of the 99th-percentile stretch beyond 1, relative to the converged run's.
  std::vector<double> stretch{};  ///< That percentile in each of the measured frames.
};

/// All methods on one sheet.
struct FabricTable {
  int side = 0;          ///< Vertices.
  double stiffness = 0;  ///< Times cotton's.
  double converged = 0;  ///< 99th-percentile stretch of the converged run in the last frame.
  std::vector<FabricRun> runs;

  /// The fastest run of a method whose error is within the goal of 5 %, or null.
  const FabricRun* Fastest(const std::string& method) const;
  /// How many times faster the engine is than that method, both within the goal. Where the method is never within it,
  /// that of its slowest run, and `least` says so. 0 without a run of either.
  double Faster(const std::string& method, bool& least) const;
};

/// The engine at its defaults on one sheet.
struct FabricScale {
  int side = 0;                  ///< Vertices.
  double one = 0, many = 0;      ///< Time per vertex and frame on one thread, on several [ns].
  double meanwhile = 0;          ///< The first of a sheet of 10,000 vertices, between the frames of this one [ns].
  double newton = 0;             ///< Newton's iterations per frame.
  double linear = 0;             ///< Linear iterations per frame.
  std::uint64_t peakMemory = 0;  ///< Of the whole program so far [byte]; 0 where the system does not say.
  bool equal = false;            ///< Whether positions are the same for both numbers of threads.
};

/// A goal of the project beside what was measured.
struct FabricTarget {
  std::string what, goal, measured;
  bool holds = false;
};

struct FabricBench {
  int threads = 0;
  std::vector<FabricTable> tables;
  std::vector<FabricScale> scales;

  bool Equal() const;
  /// Those that this bench has measured.
  std::vector<FabricTarget> Targets() const;
};

/// A square metre of cloth hangs from its upper corners. For each size and three stiffnesses: the time per frame and
/// the error of the 99th-percentile stretch against a converged run, of the engine at several numbers of iterations, of
/// Newton's method with a direct solve, and of extended position-based dynamics with several numbers of substeps. Then
/// the time per vertex by the number of vertices and threads. Progress goes to stderr.
FabricBench MeasureFabric(const FabricBenchOptions& options);

std::string FormatTables(const FabricBench& bench);
std::string FormatJson(const FabricBench& bench);

}  // namespace percale::bench
