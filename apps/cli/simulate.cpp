#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "apps/cli/platform.h"
#include "apps/cli/run.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"
#include "io/report_table.h"
#include "percale/mesh_file.h"
#include "world/measure.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

/// The frames of a run on their way into a file.
class Recorder {
 public:
  Recorder(const Options& options, const World& world)
      : world_(world), every_(options.every), evenly_(CacheKindOf(TextPath(options.output)) == CacheKind::Pc2) {}

  int Open(const Options& options) {
    const double frameSeconds = double(every_.value_or(1)) / world_.scene().simulation.framesPerSecond;
    auto writer = CacheWriter::Open(TextPath(options.output), frameSeconds);
    if (!writer) {
      PrintDiagnostics(writer.diagnostics());
      return kFailed;
    }
    writer_ = std::move(*writer);
    return kDone;
  }

  int OnFrame() {
    const int frame = world_.report().frame;
    if (every_ ? frame % *every_ != 0 : !evenly_) return kDone;
    return Add(frame);
  }

  /// After the run: the last frame, unless it is there or would come out of step.
  int Finish(std::vector<fs::path>& written) {
    const int frame = world_.report().frame;
    if (last_ != frame && !evenly_) {
      if (const int code = Add(frame); code != kDone) return code;
    }
    auto files = writer_->Finish();
    if (!files) {
      PrintDiagnostics(files.diagnostics());
      return kFailed;
    }
    written = std::move(*files);
    return kDone;
  }

 private:
  int Add(int frame) {
    if (Status status = writer_->Add(world_, frame); !status) {
      PrintDiagnostics(status.diagnostics());
      return kFailed;
    }
    last_ = frame;
    return kDone;
  }

  const World& world_;
  std::optional<int> every_;
  bool evenly_;  // frames at equal distances only
  std::optional<CacheWriter> writer_;
  int last_ = -1;
};

/// What the frames did, on its way into a table.
class ReportRecorder {
 public:
  explicit ReportRecorder(const World& world) : world_(world) {}

  int Open(const std::string& file) {
    auto opened = AtomicFile::Create(TextPath(file));
    if (!opened) return Told(opened.diagnostics());
    file_.emplace(std::move(*opened));
    return Write(ReportTableHeader());
  }

  int OnFrame() {
    if (world_.report().frame == 0) return kDone;  // nothing has been done yet
    stretch_.clear();
    for (int c = 0; c < world_.ClothCount(); ++c) {
      const ClothView cloth = world_.Cloth(c);
      AppendStretch(cloth.positions(), cloth.springs(), cloth.restLengths(), stretch_);
    }
    std::optional<double> stretch99;
    if (!stretch_.empty()) stretch99 = Percentile(stretch_, 0.99);
    return Write(ReportTableRow(world_.report(), stretch99));
  }

  int Finish() {
    const Status status = file_->Commit();
    return status ? kDone : Told(status.diagnostics());
  }

 private:
  int Write(const std::string& line) {
    const Status status = file_->Write(line);
    return status ? kDone : Told(status.diagnostics());
  }
  static int Told(const Diagnostics& diagnostics) {
    PrintDiagnostics(diagnostics);
    return kFailed;
  }

  const World& world_;
  std::optional<AtomicFile> file_;
  std::vector<double> stretch_;
};

void PrintSummary(std::FILE* out, const World& world, const RunTotals& totals, RunEnd end,
                  const std::vector<fs::path>& written, const Session& session) {
  const StepReport& report = world.report();
  const SimulationSettings& simulation = world.scene().simulation;
  double points = 0;
  for (int c = 0; c < world.ClothCount(); ++c) points += double(world.Cloth(c).positions().size());
  const double pointSteps = points * double(report.step);

  const char* ending = "";
  switch (end) {
    case RunEnd::AtRest:
      ending = ", at rest";
      break;
    case RunEnd::NotAtRest:
      ending = ", did not come to rest";
      break;
    case RunEnd::Interrupted:
      ending = ", interrupted";
      break;
    case RunEnd::Diverged:
      ending = ", diverged in the next";
      break;
    case RunEnd::Finished:
    case RunEnd::Failed:
      break;
  }
  std::fprintf(out, "scene             %s\n", PathText(session.file).c_str());
  std::fprintf(out, "points            %.0f\n", points);
  std::fprintf(out, "frames            %d%s\n", report.frame, ending);
  std::fprintf(out, "steps             %lld of 1/%lld s\n", static_cast<long long>(report.step),
               static_cast<long long>(simulation.framesPerSecond) * simulation.stepsPerFrame);
  std::fprintf(out, "simulated         %.4f s\n", report.time);
  std::fprintf(out, "wall time         %.3f s", totals.wallSeconds);
  if (totals.wallSeconds > 0) std::fprintf(out, ", %.2f times real time", report.time / totals.wallSeconds);
  if (pointSteps > 0) std::fprintf(out, ", %.1f ns per point and step", totals.wallSeconds * 1e9 / pointSteps);
  std::fprintf(out, "\n");
  if (pointSteps > 0) {
    std::fprintf(out, "%-17s %9s %7s %9s\n", "stage", "seconds", "share", "ns/pt/st");
    for (std::size_t i = 0; i < totals.stageSeconds.size(); ++i) {
      const double seconds = totals.stageSeconds[i];
      std::fprintf(out, "  %-15s %9.4f %6.1f%% %9.2f\n", std::string(StageName(static_cast<Stage>(i))).c_str(), seconds,
                   totals.wallSeconds > 0 ? 100 * seconds / totals.wallSeconds : 0, seconds * 1e9 / pointSteps);
    }
  }
  std::fprintf(out, "greatest stretch  %.6f, %.6f over the run\n", report.greatestStretch, totals.greatestStretch);
  std::fprintf(out, "kinetic energy    %.6g J\n", report.kineticEnergy);
  std::fprintf(out, "greatest move     %.6g m in the last frame\n", report.greatestMove);
  if (report.newtonIterations > 0 || !report.converged) {
    std::fprintf(out, "solver            %s, residual %.2e; %d Newton, %d linear iterations in the last frame\n",
                 report.converged ? "converged" : "stopped short", report.residual, report.newtonIterations,
                 report.linearIterations);
  }
  std::fprintf(out, "at rest           %s\n", report.atRest ? "yes" : "no");
  std::fprintf(out, "contacts          %lld in the cloth, %lld with colliders\n",
               static_cast<long long>(totals.selfContacts), static_cast<long long>(totals.colliderContacts));
  if (totals.contactBytes > 0) {
    std::fprintf(out, "contact memory    %.1f MB, grew last in frame %d\n",
                 static_cast<double>(totals.contactBytes) * 1e-6, totals.contactsGrewIn);
  }
  if (totals.splits > 0)
    std::fprintf(out, "splits            %lld steps done over in parts\n", static_cast<long long>(totals.splits));
  if (totals.jumps > 0)
    std::fprintf(out, "jumps             %lld of colliders\n", static_cast<long long>(totals.jumps));
  if (totals.mostIntersections > 0) {
    std::fprintf(out, "intersections     %lld left by the last frame, of at most %lld\n",
                 static_cast<long long>(report.intersections), static_cast<long long>(totals.mostIntersections));
  }
  std::fprintf(out, "limited springs   %lld\n", static_cast<long long>(totals.limitedSprings));
  std::fprintf(out, "state             %016llx\n", static_cast<unsigned long long>(world.StateHash()));
  constexpr std::size_t kNamed = 4;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const bool skip = written.size() > kNamed && i >= 2 && i + 1 < written.size();
    if (skip && i == 2) std::fprintf(out, "written           ... %zu more ...\n", written.size() - 3);
    if (!skip) std::fprintf(out, "written           %s\n", PathText(written[i]).c_str());
  }
}

}  // namespace

int Simulate(const Options& options) {
  auto opened = OpenSession(options);
  if (const int* code = std::get_if<int>(&opened)) return *code;
  Session& session = std::get<Session>(opened);
  if (!options.output.empty() && !CacheKindOf(TextPath(options.output))) {
    PrintError(
        "-o: expected a name that ends in .csv, .obj, .ply or .pc2 (or a whole number, the longitudes of spheres), "
        "got " +
        ShellWord(options.output));
    return kUsage;
  }

  CatchInterrupts();
  World world = MakeWorld(options, session);
  Recorder recorder(options, world);
  const bool records = !options.output.empty();
  if (records) {
    if (const int code = recorder.Open(options); code != kDone) return code;
  }
  ReportRecorder reports(world);
  const bool reporting = !options.csv.empty();
  if (reporting) {
    if (const int code = reports.Open(options.csv); code != kDone) return code;
  }
  RunTotals totals;
  const RunEnd end = Run(
      world, PlanRun(options, world, kDefaultFrames), options, session,
      [&] {
        const int code = reporting ? reports.OnFrame() : int(kDone);
        return code == kDone && records ? recorder.OnFrame() : code;
      },
      &totals);
  if (end == RunEnd::Failed) return kFailed;
  std::vector<fs::path> written;
  if (records) {
    if (const int code = recorder.Finish(written); code != kDone) return code;
  }
  if (reporting) {
    if (const int code = reports.Finish(); code != kDone) return code;
    written.push_back(TextPath(options.csv));
  }
  // A cache on stdout stays a cache.
  const auto toStdout = [](const std::string& file) { return file == "/dev/stdout" || file == "/dev/fd/1"; };
  const bool piped = toStdout(options.output) || toStdout(options.csv);
  PrintSummary(piped ? stderr : stdout, world, totals, end, written, session);
  return CodeOf(end);
}

}  // namespace percale::cli
