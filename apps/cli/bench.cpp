#include "bench/fabric_bench.h"
#include "bench/springs_bench.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "core/text.h"

namespace percale::cli {

int Bench(const Options& options) {
  constexpr std::string_view kBenchmarks[] = {"springs", "fabric"};
  if (!options.benchmark.empty() &&
      std::find(std::begin(kBenchmarks), std::end(kBenchmarks), options.benchmark) == std::end(kBenchmarks)) {
    PrintError("there is no benchmark " + Quote(options.benchmark, 60) + DidYouMean(options.benchmark, kBenchmarks) +
               "; there are: springs, fabric");
    return kUsage;
  }
  if (options.benchmark == "fabric") {
    bench::FabricBenchOptions bench;
    if (!options.sizes.empty()) bench.sizes = options.sizes;
    bench.threads = options.threads;
    bench.frames = options.frames.value_or(0);
    bench.json = options.json;
    return bench::BenchFabric(bench);
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
