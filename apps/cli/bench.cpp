#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// A folder that cannot be written shows before the work, not after it. None was asked for where it is empty.
int CheckFolder(const std::filesystem::path& folder, const std::string& name) {
  return folder.empty() ? int(kDone) : MakeWritable(folder, name);
}

/// Names of files, and what they hold.
using Files = std::vector<std::pair<std::string, std::string>>;

/// What was measured, printed as asked and written into the folder both ways, along with `more`; without a folder only
/// printed. Returns the exit code.
int Report(const Options& options, const std::string& name, const std::string& tables, const std::string& json,
           const std::filesystem::path& folder, Files more = {}) {
  std::fputs((options.json ? json : tables).c_str(), stdout);
  if (folder.empty()) return kDone;
  more.emplace_back(name + ".txt", tables);
  more.emplace_back(name + ".json", json);
  for (const auto& [file, content] : more) {
    const Status written = WriteFile(folder / file, content);
    PrintDiagnostics(written.diagnostics());
    if (!written) return kFailed;
  }
  if (!options.json) std::printf("\nreport            %s\n", PathText(folder / more.front().first).c_str());
  return kDone;
}

int BenchFabric(const Options& options) {
  const std::filesystem::path folder = TextPath(options.output.empty() ? kStandardFolder : options.output);
  if (const int writable = CheckFolder(folder, kFabricPage); writable != kDone) return writable;
  const bench::FabricBench bench =
      bench::MeasureFabric({.sizes = options.sizes, .threads = options.threads, .frames = options.frames.value_or(0)});
  Files files = {{kFabricPage, FormatBenchPage(bench, PERCALE_VERSION)}};
  for (auto& plot : FormatBenchPlots(bench)) files.push_back(std::move(plot));
  const int code =
      Report(options, "fabric", bench::FormatTables(bench), bench::FormatJson(bench), folder, std::move(files));
  if (code != kDone) return code;
  if (!bench.Equal()) PrintError("positions differ between numbers of threads");
  return bench.Equal() ? kDone : kFailed;
}

int BenchContact(const Options& options) {
  const std::filesystem::path folder = TextPath(options.output);
  if (const int writable = CheckFolder(folder, "contact.txt"); writable != kDone) return writable;
  bench::ContactBenchOptions settings{.threads = options.threads, .frames = options.frames.value_or(0)};
  if (!options.sizes.empty()) settings.sizes = options.sizes;
  const bench::ContactBench bench = bench::MeasureContact(settings);
  const int code = Report(options, "contact", bench::FormatTable(bench), bench::FormatJson(bench), folder);
  if (code != kDone) return code;
  if (!bench.equal) PrintError("positions differ between numbers of threads");
  return bench.equal ? kDone : kFailed;
}

int BenchSprings(const Options& options) {
  bench::SpringsBenchOptions settings;
  if (!options.sizes.empty()) settings.sizes = options.sizes;
  settings.threads = options.threads;
  settings.frames = options.frames.value_or(0);
  if (const auto root = FindRoot(options.root)) {
    settings.root = *root;
  } else if (!options.root.empty()) {
    PrintDiagnostics(root.diagnostics());
    return kUsage;
  }
  const std::filesystem::path folder = TextPath(options.output);
  if (const int writable = CheckFolder(folder, "springs.txt"); writable != kDone) return writable;
  const auto bench = bench::MeasureSprings(settings);
  PrintDiagnostics(bench.diagnostics());
  if (!bench) return kInvalid;
  const int code = Report(options, "springs", bench::FormatTables(*bench), bench::FormatJson(*bench), folder);
  if (code != kDone) return code;
  if (!bench->Equal()) PrintError("the engine's positions differ from the plain twin's");
  return bench->Equal() ? kDone : kFailed;
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
  return BenchSprings(options);
}

}  // namespace percale::cli
