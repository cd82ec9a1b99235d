#include "bench/springs_bench.h"

#include <string_view>

#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "core/text.h"

namespace percale::cli {

int Bench(const Options& options) {
  constexpr std::string_view kBenchmarks[] = {"springs"};
  if (!options.benchmark.empty() && options.benchmark != kBenchmarks[0]) {
    PrintError("there is no benchmark " + Quote(options.benchmark, 60) + DidYouMean(options.benchmark, kBenchmarks) +
               "; there is: springs");
    return kUsage;
  }
  bench::SpringsBenchOptions bench;
  if (auto root = FindRoot(options.root)) {
    bench.root = *root;
  } else if (!options.root.empty()) {
    PrintDiagnostics(root.diagnostics());
    return kUsage;
  }
  if (!options.sizes.empty()) bench.sizes = options.sizes;
  bench.threads = options.threads;
  bench.frames = options.frames.value_or(0);
  bench.json = options.json;
  return bench::BenchSprings(bench);
}

}  // namespace percale::cli
