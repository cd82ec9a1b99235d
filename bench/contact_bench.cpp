#include "bench/contact_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <thread>

#include "bench/median.h"
#include "core/text.h"
#include "percale/fabrics.h"
#include "percale/intersections.h"
#include "percale/world.h"

namespace percale::bench {
namespace {

constexpr int kContactFrames = 120;
constexpr const char *kDrape = "drape", *kHanging = "no contact";
/// Where phases begin, as shares of the frames.
struct PhaseStart {
  const char* name;
  int quarter;
};
constexpr PhaseStart kDrapePhases[] = {{"falls", 0}, {"lands", 1}, {"rests in folds", 2}};
constexpr PhaseStart kHangingPhases[] = {{"swings", 0}};

Scene MakeScene(const std::string& name, int size) {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  ClothSettings cloth;
  SetFabric(cloth, Fabric::Cotton);
  cloth.numWidthPoints = cloth.numHeightPoints = size;
  if (name == kDrape) {
    scene.spheres.push_back({.origin = {0.5, 0.5, 0.5}, .radius = 0.2, .friction = 0.3});
    scene.planes.push_back({.point = {0.5, 0, 0.5}, .normal = {0, 1, 0}, .friction = 0.3});
  } else {
    cloth.pinned = {{0, 0}, {size - 1, 0}};
    scene.simulation.selfCollision = false;
  }
  scene.cloths.push_back(cloth);
  return scene;
}

/// Runs a scene; `hash` is that of its end, and `intersections` what the judge finds, where it is asked.
ContactRun Run(const std::string& name, std::span<const PhaseStart> phases, int size, int threads, int frames,
               std::uint64_t& hash, std::int64_t* intersections) {
  World world(MakeScene(name, size), {.threads = threads});
  ClothJudge judge(world, threads);
  ContactRun run{.scene = name, .size = size, .threads = threads};
  for (std::size_t p = 0; p < phases.size(); ++p) {
    const int begin = frames * phases[p].quarter / 4;
    const int end = p + 1 < phases.size() ? frames * phases[p + 1].quarter / 4 : frames;
    ContactPhase phase{.name = phases[p].name};
    std::vector<double> times;
    double total = 0, safeMove = 0;
    for (int frame = begin; frame < end; ++frame) {
      const StepReport& report = world.Step();
      double time = 0;
      for (const double stage : report.stageSeconds) time += stage;
      times.push_back(time);
      total += time;
      safeMove += report.stageSeconds[static_cast<std::size_t>(Stage::SelfCollide)];
      phase.worst = std::max(phase.worst, time);
      phase.contacts += static_cast<double>(report.selfContacts + report.colliderContacts) / (end - begin);
      run.lostMotion = std::max(run.lostMotion, report.lostMotion);
      run.splits += report.splits;
      if (intersections != nullptr) *intersections += judge.Count(world).count;
    }
    phase.frame = Median(times);
    phase.safeMove = safeMove / total;
    run.phases.push_back(phase);
  }
  hash = world.StateHash();
  std::fprintf(stderr, "%s %d x %d, %d thread(s)\n", name.c_str(), size, size, threads);
  return run;
}

/// The median time of a frame in a phase of the drape, or 0 where it was not run [s].
double TimeOf(const ContactBench& bench, int size, bool many, const std::string& phase) {
  for (const ContactRun& run : bench.runs) {
    if (run.scene != kDrape || run.size != size || (run.threads > 1) != many) continue;
    for (const ContactPhase& part : run.phases) {
      if (part.name == phase) return part.frame;
    }
  }
  return 0;
}

std::string Milliseconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f ms", 1e3 * seconds);
  return text;
}

}  // namespace

ContactBench MeasureContact(const ContactBenchOptions& options) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int many = options.threads > 0 ? options.threads : cores;
  const int frames = options.frames > 0 ? std::max(4, options.frames) : kContactFrames;
  ContactBench bench;
  for (const int size : options.sizes) {
    for (const bool drape : {true, false}) {
      const std::span<const PhaseStart> phases =
          drape ? std::span<const PhaseStart>(kDrapePhases) : std::span<const PhaseStart>(kHangingPhases);
      const char* const name = drape ? kDrape : kHanging;
      std::uint64_t one = 0, other = 0;
      bench.runs.push_back(Run(name, phases, size, 1, frames, one, drape ? &bench.intersections : nullptr));
      if (many == 1) continue;
      bench.runs.push_back(Run(name, phases, size, many, frames, other, nullptr));
      bench.equal = bench.equal && one == other;
    }
  }
  return bench;
}

std::vector<FabricTarget> Targets(const ContactBench& bench) {
  std::vector<FabricTarget> targets;
  for (const char* phase : {"falls", "lands", "rests in folds"}) {
    const double one = TimeOf(bench, 100, false, phase), many = TimeOf(bench, 100, true, phase);
    const std::string what = std::string("10,000 vertices, ") + phase;
    if (many > 0)
      targets.push_back({what + ", several threads", "at most 33.3 ms", Milliseconds(many), many <= 1.0 / 30});
    if (one > 0) targets.push_back({what + ", one thread", "at most 25 ms", Milliseconds(one), one <= 0.025});
    const double large = TimeOf(bench, 316, false, phase);
    if (one > 0 && large > 0) {
      targets.push_back({std::string("100,000 vertices over 10,000, ") + phase, "at most 15",
                         FormatNumber(std::round(10 * large / one) / 10), large <= 15 * one});
    }
  }
  double lost = 0, share = 0;
  for (const ContactRun& run : bench.runs) {
    lost = std::max(lost, run.lostMotion);
    for (const ContactPhase& phase : run.phases) share = std::max(share, phase.safeMove);
  }
  const auto percent = [](double value) { return FormatNumber(std::round(1000 * value) / 10) + " %"; };
  targets.push_back({"motion lost to the safe move, worst frame", "under 1 %", percent(lost), lost < 0.01});
  targets.push_back({"share of the safe move, worst phase", "under 33 %", percent(share), share < 1.0 / 3});
  targets.push_back({"intersections", "0", std::to_string(bench.intersections), bench.intersections == 0});
  return targets;
}

std::string FormatTable(const ContactBench& bench) {
  std::string text = "scene        vertices  threads  phase            ms per frame   worst  safe move  contacts\n";
  char line[160];
  for (const ContactRun& run : bench.runs) {
    for (const ContactPhase& phase : run.phases) {
      std::snprintf(line, sizeof line, "%-11s %9d %8d  %-15s %13.1f %7.1f %8.0f %% %9.0f\n", run.scene.c_str(),
                    run.size * run.size, run.threads, phase.name.c_str(), 1e3 * phase.frame, 1e3 * phase.worst,
                    100 * phase.safeMove, phase.contacts);
      text += line;
    }
  }
  text += "\ntarget                                             goal             measured\n";
  for (const FabricTarget& target : Targets(bench)) {
    std::snprintf(line, sizeof line, "%-50s %-16s %-10s %s\n", target.what.c_str(), target.goal.c_str(),
                  target.measured.c_str(), target.holds ? "holds" : "does not hold");
    text += line;
  }
  return text + "same bits for any number of threads: " + (bench.equal ? "yes" : "NO") + "\n";
}

std::string FormatJson(const ContactBench& bench) {
  std::string text = "{\"runs\": [";
  const char* separator = "";
  for (const ContactRun& run : bench.runs) {
    for (const ContactPhase& phase : run.phases) {
      text +=
          separator + std::string("\n  {\"scene\": ") + Quote(run.scene) +
          ", \"vertices\": " + std::to_string(run.size * run.size) + ", \"threads\": " + std::to_string(run.threads) +
          ", \"phase\": " + Quote(phase.name) + ", \"ms_per_frame\": " + FormatNumber(1e3 * phase.frame) +
          ", \"ms_worst\": " + FormatNumber(1e3 * phase.worst) + ", \"safe_move\": " + FormatNumber(phase.safeMove) +
          ", \"contacts\": " + FormatNumber(phase.contacts) + "}";
      separator = ",";
    }
  }
  text += "\n], \"targets\": [";
  separator = "";
  for (const FabricTarget& target : Targets(bench)) {
    text += separator + std::string("\n  {\"what\": ") + Quote(target.what) + ", \"goal\": " + Quote(target.goal) +
            ", \"measured\": " + Quote(target.measured) + ", \"holds\": " + (target.holds ? "true" : "false") + "}";
    separator = ",";
  }
  return text + "\n], \"equal\": " + (bench.equal ? "true" : "false") + "}\n";
}

}  // namespace percale::bench
