#pragma once
/// \file
/// `percale bench fabric`: what the continuum engine costs for what accuracy, beside other solvers.

#include <vector>

namespace percale::bench {

struct FabricBenchOptions {
  std::vector<int> sizes{32, 100};  ///< Vertices along a side of the sheet, each >= 3, for error against time.
  int threads = 0;                  ///< Of the many-threaded runs, >= 1; 0: one per core.
  int frames = 0;                   ///< Simulated per run; 0: 60.
  bool json = false;                ///< One JSON object on stdout instead of tables.
};

/// A square metre of cloth hangs from its upper corners. For each size and three stiffnesses: the time per frame and
/// the error of the 99th-percentile stretch against a converged run, of the engine at several numbers of iterations, of
/// Newton's method with a direct solve, and of extended position-based dynamics with several numbers of substeps. Then
/// the time per vertex from 10^3 to 10^6 vertices, and that of two threads. Tables to stdout, progress to stderr.
/// Returns the program's exit code: 0; 1 when positions differ between numbers of threads.
int BenchFabric(const FabricBenchOptions& options);

}  // namespace percale::bench
