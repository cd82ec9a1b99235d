#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "apps/cli/bench_page.h"
#include "apps/cli/pictures.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "bench/contact_bench.h"
#include "bench/fabric_bench.h"
#include "bench/springs_bench.h"
#include "core/text.h"
#include "io/atomic_file.h"

namespace percale::cli {
namespace {

constexpr const char* kStandardFolder = "benchmarks";
constexpr const char* kFabricPage = "fabric.html";

int BenchFabric(const Options& options) {
  const std::filesystem::path folder = TextPath(options.output.empty() ? kStandardFolder : options.output);
  // A folder that cannot be written shows before the work, not after it.
  if (const int writable = MakeWritable(folder, kFabricPage); writable != kDone) return writable;
  const bench::FabricBench bench =
      bench::MeasureFabric({.sizes = options.sizes, .threads = options.threads, .frames = options.frames.value_or(0)});
  std::fputs((options.json ? bench::FormatJson(bench) : bench::FormatTables(bench)).c_str(), stdout);
  auto files = FormatBenchPlots(bench);
  files.emplace_back(kFabricPage, FormatBenchPage(bench, PERCALE_VERSION));
  for (const auto& [name, content] : files) {
    const Status written = WriteFile(folder / name, content);
    PrintDiagnostics(written.diagnostics());
    if (!written) return kFailed;
  }
  if (!options.json) std::printf("\nreport            %s\n", PathText(folder / kFabricPage).c_str());
  if (!bench.Equal()) PrintError("positions differ between numbers of threads");
  return bench.Equal() ? kDone : kFailed;
}

int BenchContact(const Options& options) {
  bench::ContactBenchOptions settings{.threads = options.threads, .frames = options.frames.value_or(0)};
  if (!options.sizes.empty()) settings.sizes = options.sizes;
  const bench::ContactBench bench = bench::MeasureContact(settings);
  std::fputs((options.json ? bench::FormatJson(bench) : bench::FormatTable(bench)).c_str(), stdout);
  if (!bench.equal) PrintError("positions differ between numbers of threads");
  return bench.equal ? kDone : kFailed;
}

}  // namespace

int Bench(const Options& options) {
  constexpr std::string_view kBenchmarks[] = {"springs", "fabric", "contact"};
  if (!options.benchmark.empty() &&
      std::find(std::begin(kBenchmarks), std::end(kBenchmarks), options.benchmark) == std::end(kBenchmarks)) {
    PrintError("there is no benchmark " + Quote(options.benchmark, 60) + DidYouMean(options.benchmark, kBenchmarks) +
               "; there are: springs, fabric, contact");
    return kUsage;
  }
  if (options.benchmark == "fabric") return BenchFabric(options);
  if (options.benchmark == "contact") return BenchContact(options);
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
