#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>

#include "apps/cli/pictures.h"
#include "apps/cli/platform.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_page.h"
#include "io/atomic_file.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kFactors[] = {0.5, 1, 2};  // of --fine
constexpr auto kPatience = std::chrono::milliseconds(50);

/// One run of a case, and where its result goes.
struct CaseRun {
  const VerifyCase* of = nullptr;
  Effort effort;
  CaseResult* result = nullptr;
};

/// Makes room for all results; the runs point into the report.
std::vector<CaseRun> Plan(const Options& options, VerifyReport& report) {
  for (const VerifyCase& each : VerifyCases()) {
    const auto& only = options.cases;
    if (only.empty() || std::find(only.begin(), only.end(), each.name) != only.end())
      report.cases.push_back({&each, {}, {}});
  }
  std::vector<CaseRun> runs;
  for (FinishedCase& finished : report.cases) {
    const VerifyCase* of = finished.of;
    runs.push_back({of, {}, &finished.result});
    if (!options.fine) continue;
    const std::vector<double> factors(std::begin(kFactors), std::end(kFactors));
    if (of->mesh) finished.refinements.push_back({"elements along an edge", factors, {}});
    if (of->step) finished.refinements.push_back({"steps per second", factors, {}});
    for (Refinement& refinement : finished.refinements) {
      const bool mesh = of->mesh && &refinement == &finished.refinements[0];
      refinement.results.resize(factors.size());
      for (std::size_t k = 0; k < factors.size(); ++k) {
        const Effort effort = mesh ? Effort{factors[k], 1} : Effort{1, factors[k]};
        runs.push_back({of, effort, &refinement.results[k]});
      }
    }
  }
  return runs;
}

/// Runs all on several threads. False: interrupted before the last.
bool RunAll(const std::vector<CaseRun>& runs, int threads, Progress& progress) {
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t k = next++; k < runs.size() && !stop; k = next++) {
      try {
        *runs[k].result = runs[k].of->run(runs[k].effort);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        stop = true;
      }
      ++done;
    }
  };
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) workers.emplace_back(work);
  while (done < runs.size() && !stop) {
    progress.Update(static_cast<int>(done));
    if (Interrupted()) stop = true;
    std::this_thread::sleep_for(kPatience);
  }
  for (std::thread& worker : workers) worker.join();
  progress.Finish(static_cast<int>(done));
  if (failure) std::rethrow_exception(failure);
  return !Interrupted() || done == runs.size();
}

}  // namespace

int Verify(const Options& options) {
  CatchInterrupts();
  const fs::path folder = TextPath(options.output.empty() ? "verify" : options.output);
  VerifyReport report;
  report.version = PERCALE_VERSION;
  const std::vector<CaseRun> runs = Plan(options, report);
  // A folder that cannot be written shows before the work, not after it.
  if (const int writable = MakeWritable(folder, "verify.html"); writable != kDone) return writable;
  const int threads = options.threads > 0 ? options.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  bool all = false;
  {
    Progress progress(options.progress, std::string(VerbName(Verb::Verify)), static_cast<int>(runs.size()));
    all = RunAll(runs, std::min(threads, static_cast<int>(runs.size())), progress);
  }
  if (!all) {
    std::erase_if(report.cases, [](const FinishedCase& finished) {
      const auto empty = [](const CaseResult& result) { return result.readings.empty(); };
      return empty(finished.result) ||
             std::any_of(finished.refinements.begin(), finished.refinements.end(), [&](const Refinement& refinement) {
               return std::any_of(refinement.results.begin(), refinement.results.end(), empty);
             });
    });
  }
  const Status status = WriteFile(folder / "verify.html", FormatPage(report));
  if (options.json) {
    std::fputs(FormatJson(report).c_str(), stdout);
  } else {
    std::fputs(FormatTable(report).c_str(), stdout);
    std::printf("\n%d of %d quantities within their gates\nreport            %s\n", report.Holding(), report.Readings(),
                PathText(folder / "verify.html").c_str());
  }
  PrintDiagnostics(status.diagnostics());
  if (!status) return kFailed;
  if (!all) {
    std::fprintf(stderr, "percale: interrupted; what was done is in the table and the report\n");
    return kInterrupted;
  }
  return report.Holding() == report.Readings() ? kDone : kFailed;
}

}  // namespace percale::cli
