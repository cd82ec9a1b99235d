#include "bench/fabric_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <thread>

#include "bench/median.h"
#include "bench/xpbd_cloth.h"
#include "core/memory.h"
#include "core/text.h"
#include "fabric/newton.h"
#include "fabric/reference_solver.h"
#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"
#include "percale/world.h"

namespace percale::bench {
namespace {

using fabric::FabricModel;

constexpr double kFrame = 1.0 / 60;
constexpr Vec3 kGravity{0, -9.8, 0};
constexpr int kCostFrames = 60;
constexpr int kSizes[] = {32, 64, 100};  // for error against time
constexpr int kScaleSizes[] = {32, 100, 316, 1000};
constexpr int kMeasuredFrames = 20;  // the last ones, over whose mean stretch methods are compared
constexpr int kScaleFrames = 10;     // the same for all sizes: the cost changes as the sheet falls
// Vertices along a side of the sheet that others are compared with, frame by frame: other work comes and goes in
// minutes.
constexpr int kScaleSide = 100;
constexpr double kGoal = 0.05;  // of the stretch beyond 1
// Vertices along a side beyond which the direct solver does less, and nothing: it would take minutes.
constexpr int kSmallDirect = 50, kLargestDirect = 128;
constexpr double kStiffnesses[] = {1, 8, 64};  // times cotton's

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// A square metre that hangs from its upper corners, and falls into its weight.
Scene HangingSheet(int side, double stiffness) {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  scene.simulation.gravity = kGravity;
  scene.wind.airDensity = 0;
  ClothSettings& cloth = scene.cloths.emplace_back();
  SetFabric(cloth, Fabric::Cotton);
  cloth.stretchWarp *= stiffness, cloth.stretchWeft *= stiffness, cloth.shear *= stiffness;
  cloth.stretchDamping = 0;
  cloth.strainLimit = 100;
  cloth.numWidthPoints = cloth.numHeightPoints = side;
  cloth.orientation = Orientation::Vertical;
  // Over a tenth of each side, so that the strain at the pins has a limit as the mesh is refined.
  const int held = std::max(1, side / 10);
  for (int i = 0; i < held; ++i) {
    cloth.pinned.push_back({i, side - 1});
    cloth.pinned.push_back({side - 1 - i, side - 1});
  }
  return scene;
}

/// Runs a method frame by frame and measures.
template <class Frame, class Positions>
FabricRun Measure(const std::string& method, const std::string& setting, const FabricModel& model, int frames,
                  Frame&& frame, Positions&& positions) {
  FabricRun run;
  run.method = method;
  run.setting = setting;
  std::vector<double> times;
  for (int f = 0; f < frames; ++f) {
    const auto start = std::chrono::steady_clock::now();
    frame();
    times.push_back(Seconds(start) * 1000);
    if (f >= frames - kMeasuredFrames) run.stretch.push_back(Stretch99(model, positions()));
  }
  run.milliseconds = Median(times);
  return run;
}

FabricRun MeasureEngine(const Scene& base, const FabricModel& model, int newton, int linear, double tolerance,
                        int threads, int frames) {
  Scene scene = base;
  scene.simulation.newtonIterations = newton;
  scene.simulation.linearIterations = linear;
  scene.simulation.tolerance = tolerance;
  World world(scene, {.threads = threads});
  return Measure(
      "engine", std::to_string(newton) + " x " + std::to_string(linear), model, frames, [&] { world.Step(); },
      [&] { return world.Cloth(0).positions(); });
}

/// `model`: one that bends by hinges.
FabricRun MeasureXpbd(const FabricModel& model, std::span<const std::uint8_t> free, int substeps, int frames) {
  XpbdCloth cloth(model, free);
  return Measure(
      "XPBD", std::to_string(substeps) + " substeps", model, frames, [&] { cloth.Frame(kFrame, substeps, kGravity); },
      [&] { return cloth.positions(); });
}

FabricRun MeasureDirect(const FabricModel& model, std::span<const std::uint8_t> free, int newton, int frames) {
  fabric::ReferenceSolver solver(model);
  std::vector<Vec3> position = model.start, previous = position, y = position;
  const std::vector<fabric::VertexLoad> loads(position.size());
  const auto frame = [&] {
    for (std::size_t v = 0; v < position.size(); ++v) y[v] = free[v] ? position[v] * 2 - previous[v] : position[v];
    solver.Begin({kFrame, position, previous, kGravity * (kFrame * kFrame), loads, free});
    solver.Solve(y, {.maxIterations = newton, .tolerance = 1e-9});
    std::swap(previous, position);
    position = y;
  };
  return Measure("Newton, direct", std::to_string(newton) + " iterations", model, frames, frame,
                 [&] { return std::span<const Vec3>(position); });
}

void Compare(FabricRun& run, const FabricRun& converged) {
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  run.error = std::abs(mean(run.stretch) - mean(converged.stretch)) / (mean(converged.stretch) - 1);
}

FabricTable MeasureTable(int side, double stiffness, int threads, int frames) {
  const Scene scene = HangingSheet(side, stiffness);
  const FabricModel model = fabric::BuildModel(scene, std::vector<RestMesh>{MakeGridMesh(scene.cloths[0])});
  std::vector<std::uint8_t> free(static_cast<std::size_t>(model.vertexCount), 1);
  for (const GridPoint& pin : scene.cloths[0].pinned) free[static_cast<std::size_t>(pin.j * side + pin.i)] = 0;
  FabricTable table{side, stiffness, 0, {}};
  const FabricRun converged = MeasureEngine(scene, model, 40, 60, 1e-6, threads, frames);
  table.converged = converged.stretch.back();
  for (const auto& [newton, linear] : {std::pair{1, 4}, {2, 6}, {3, 6}, {4, 8}, {8, 16}}) {
    FabricRun run = MeasureEngine(scene, model, newton, linear, 1e-3, 1, frames);
    if (threads > 1) {
      run.manyMilliseconds = MeasureEngine(scene, model, newton, linear, 1e-3, threads, frames).milliseconds;
    }
    table.runs.push_back(std::move(run));
  }
  if (side <= kSmallDirect) {
    for (const int newton : {1, 2, 4}) table.runs.push_back(MeasureDirect(model, free, newton, frames));
  } else if (side <= kLargestDirect) {
    table.runs.push_back(MeasureDirect(model, free, 2, std::max(frames / 3, kMeasuredFrames)));
  }
  Scene hinged = scene;
  hinged.cloths[0].bendingLaw = BendingLaw::Hinges;
  const FabricModel hinges = fabric::BuildModel(hinged, std::vector<RestMesh>{MakeGridMesh(scene.cloths[0])});
  for (const int substeps : {10, 20, 40, 80, 160, 320}) {
    table.runs.push_back(MeasureXpbd(hinges, free, substeps, frames));
  }
  for (FabricRun& run : table.runs) Compare(run, converged);
  return table;
}

/// The same, begun flat and level, so that it is alike at all sizes: a sheet that starts upright starts with the
/// course's noise of 1 mm, which is a tenth of an edge at 100 x 100 and all of one at 1000 x 1000.
Scene SwingingSheet(int side) {
  Scene scene = HangingSheet(side, 1);
  scene.cloths[0].orientation = Orientation::Horizontal;
  return scene;
}

/// Adds the time per vertex [ns] of a frame of a sheet with `side` vertices along a side.
StepReport TimedStep(World& world, int side, std::vector<double>& times) {
  const auto start = std::chrono::steady_clock::now();
  const StepReport report = world.Step();
  times.push_back(Seconds(start) * 1e9 / (static_cast<double>(side) * side));
  return report;
}

FabricScale MeasureScale(int side, int threads, int frames) {
  FabricScale scale;
  scale.side = side;
  const Scene scene = SwingingSheet(side);
  World other(SwingingSheet(kScaleSide), {.threads = 1});
  std::uint64_t hashes[2] = {};
  for (int run = 0; run < 2; ++run) {
    World world(scene, {.threads = run == 0 ? 1 : threads});
    std::vector<double> times, otherTimes;
    double newton = 0, linear = 0;
    for (int f = 0; f < frames; ++f) {
      const StepReport report = TimedStep(world, side, times);
      newton += report.newtonIterations, linear += report.linearIterations;
      if (run > 0) continue;
      other.Reset();
      for (int k = 0; k < frames; ++k) TimedStep(other, kScaleSide, otherTimes);
    }
    if (run == 0)
      scale.one = Median(times), scale.meanwhile = Median(otherTimes);
    else
      scale.many = Median(times);
    scale.newton = newton / frames, scale.linear = linear / frames;
    hashes[run] = world.StateHash();
  }
  scale.peakMemory = PeakMemory();
  scale.equal = hashes[0] == hashes[1];
  return scale;
}

}  // namespace

const FabricRun* FabricTable::Fastest(const std::string& method) const {
  const FabricRun* best = nullptr;
  for (const FabricRun& run : runs) {
    if (run.method == method && run.error <= kGoal && (!best || run.milliseconds < best->milliseconds)) best = &run;
  }
  return best;
}

double FabricTable::Faster(const std::string& method, bool& least) const {
  const FabricRun *engine = Fastest("engine"), *other = Fastest(method);
  least = !other;
  for (const FabricRun& run : runs) {
    if (least && run.method == method && (!other || run.milliseconds > other->milliseconds)) other = &run;
  }
  return engine && other ? other->milliseconds / engine->milliseconds : 0;
}

bool FabricBench::Equal() const {
  return std::all_of(scales.begin(), scales.end(), [](const FabricScale& scale) { return scale.equal; });
}

std::vector<FabricTarget> FabricBench::Targets() const {
  std::vector<FabricTarget> targets;
  for (const FabricTable& table : tables) {
    const FabricRun* const engine = table.Fastest("engine");
    if (table.side != 100 || table.stiffness != 1 || !engine) continue;
    const std::string what = "a frame of 10,000 vertices within 5 %, engine " + engine->setting;
    targets.push_back(
        {what + ", one thread", "< 16 ms", Text("%.1f ms", engine->milliseconds), engine->milliseconds < 16});
    if (threads == 2) {
      const double many = engine->manyMilliseconds;
      targets.push_back({what + ", two threads", "< 9 ms", Text("%.1f ms", many), many < 9});
    }
    for (const char* method : {"XPBD", "Newton, direct"}) {
      bool least = false;
      const double faster = table.Faster(method, least);
      if (faster > 0) {
        targets.push_back({std::string("times faster than ") + method + " there", ">= 8",
                           Text(least ? "more than %.0f" : "%.0f", faster), faster >= 8});
      }
    }
  }
  double ratio = 0;
  for (const FabricScale& scale : scales) {
    if (scale.side > kScaleSide) ratio = std::max(ratio, scale.one / scale.meanwhile);
  }
  if (ratio > 0) {
    targets.push_back(
        {"greatest time per vertex beyond 10,000, over the time there", "<= 1.5", Text("%.2f", ratio), ratio <= 1.5});
  }
  for (const FabricScale& scale : scales) {
    if (scale.side != 1000 || scale.peakMemory == 0) continue;
    const double gigabytes = static_cast<double>(scale.peakMemory) / 1e9;
    targets.push_back({"memory of 1,000,000 vertices", "<= 1 GB", Text("%.2f GB", gigabytes), gigabytes <= 1});
  }
  if (!scales.empty()) {
    targets.push_back({"positions for one and several threads", "equal bits", Equal() ? "equal" : "differ", Equal()});
  }
  return targets;
}

FabricBench MeasureFabric(const FabricBenchOptions& options) {
  FabricBench bench;
  bench.threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  const int frames = std::max(options.frames > 0 ? options.frames : kCostFrames, kMeasuredFrames + 1);
  const auto sizes = [&](std::span<const int> standard) {
    return options.sizes.empty() ? std::vector<int>(standard.begin(), standard.end()) : options.sizes;
  };
  for (const int side : sizes(kSizes)) {
    for (const double stiffness : kStiffnesses) {
      std::fprintf(stderr, "%d x %d, stiffness x %g\n", side, side, stiffness);
      bench.tables.push_back(MeasureTable(side, stiffness, bench.threads, frames));
    }
  }
  for (const int side : sizes(kScaleSizes)) {
    std::fprintf(stderr, "cost per vertex: %d x %d\n", side, side);
    bench.scales.push_back(MeasureScale(side, bench.threads, std::min(frames, kScaleFrames)));
  }
  return bench;
}

std::string FormatTables(const FabricBench& bench) {
  std::string text;
  const std::string many = std::to_string(bench.threads) + " threads";
  for (const FabricTable& table : bench.tables) {
    text += Text("%d x %d vertices, %g times cotton's stiffness; stretch of the converged run %.4f\n", table.side,
                 table.side, table.stiffness, table.converged);
    text += Text("%-15s %-14s %12s %12s %10s\n", "method", "setting", "ms, 1 thread", many.c_str(), "error");
    for (const FabricRun& run : table.runs) {
      const std::string other = run.manyMilliseconds > 0 ? Text("%.2f", run.manyMilliseconds) : "";
      text += Text("%-15s %-14s %12.2f %12s %9.1f%%\n", run.method.c_str(), run.setting.c_str(), run.milliseconds,
                   other.c_str(), 100 * run.error);
    }
    for (const char* method : {"Newton, direct", "XPBD"}) {
      bool least = false;
      const double faster = table.Faster(method, least);
      if (faster > 0) {
        text += Text("within %.0f %%: %s%.1f times faster than %s%s\n", 100 * kGoal, least ? "more than " : "", faster,
                     method, least ? ", which did not get there" : "");
      }
    }
    text += "\n";
  }
  text += "The engine at its defaults: time per vertex and frame, and that of 10,000 in between\n";
  text += Text("%10s %12s %12s %12s %8s %8s %18s  %s\n", "vertices", "ns, 1 thread", "10,000", many.c_str(), "Newton",
               "linear", "ns per Newton it.", "positions");
  for (const FabricScale& scale : bench.scales) {
    text += Text("%10d %12.0f %12.0f %12.0f %8.1f %8.1f %18.0f  %s\n", scale.side * scale.side, scale.one,
                 scale.meanwhile, scale.many, scale.newton, scale.linear,
                 scale.newton > 0 ? scale.one / scale.newton : 0, scale.equal ? "equal to the last bit" : "DIFFER");
  }
  text += "\n";
  for (const FabricTarget& target : bench.Targets()) {
    text += Text("%-62s %10s  %-14s %s\n", target.what.c_str(), target.goal.c_str(), target.measured.c_str(),
                 target.holds ? "holds" : "MISSED");
  }
  return text;
}

std::string FormatJson(const FabricBench& bench) {
  std::string text = "{\"threads\": " + std::to_string(bench.threads) + ", \"error_against_time\": [";
  const char* separator = "";
  for (const FabricTable& table : bench.tables) {
    for (const FabricRun& run : table.runs) {
      text += separator + std::string("\n  {\"side\": ") + std::to_string(table.side) +
              ", \"stiffness\": " + FormatNumber(table.stiffness) + ", \"method\": " + Quote(run.method) +
              ", \"setting\": " + Quote(run.setting) + ", \"ms_per_frame\": " + FormatNumber(run.milliseconds);
      if (run.manyMilliseconds > 0) text += ", \"ms_per_frame_threads\": " + FormatNumber(run.manyMilliseconds);
      text += ", \"error\": " + FormatNumber(run.error) + "}";
      separator = ",";
    }
  }
  text += "\n], \"scaling\": [";
  separator = "";
  for (const FabricScale& scale : bench.scales) {
    text += separator + std::string("\n  {\"side\": ") + std::to_string(scale.side) +
            ", \"ns_per_vertex_one_thread\": " + FormatNumber(scale.one) +
            ", \"ns_per_vertex_of_10000_meanwhile\": " + FormatNumber(scale.meanwhile) +
            ", \"ns_per_vertex_threads\": " + FormatNumber(scale.many) + ", \"newton\": " + FormatNumber(scale.newton) +
            ", \"linear\": " + FormatNumber(scale.linear) + ", \"peak_bytes\": " + std::to_string(scale.peakMemory) +
            "}";
    separator = ",";
  }
  text += "\n], \"targets\": [";
  separator = "";
  for (const FabricTarget& target : bench.Targets()) {
    text += separator + std::string("\n  {\"what\": ") + Quote(target.what) + ", \"goal\": " + Quote(target.goal) +
            ", \"measured\": " + Quote(target.measured) + ", \"holds\": " + (target.holds ? "true" : "false") + "}";
    separator = ",";
  }
  return text + "\n]}\n";
}

}  // namespace percale::bench
