#include "bench/fabric_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "bench/xpbd_cloth.h"
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
constexpr int kFrames = 60;
constexpr int kMeasuredFrames = 20;  // the last ones, over whose mean stretch methods are compared
constexpr double kGoal = 0.05;       // of the stretch beyond 1
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

/// What a method reached and what it took.
struct Run {
  std::string method;
  std::string setting;
  double milliseconds = 0;           // per frame: the median
  std::vector<double> stretch = {};  // 99th percentile, of each measured frame
  double error = 0;                  // of the mean of that beyond 1
};

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Runs a method frame by frame and measures.
template <class Frame, class Positions>
Run Measure(const std::string& method, const std::string& setting, const FabricModel& model, int frames, Frame&& frame,
            Positions&& positions) {
  Run run;
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

Run MeasureEngine(const Scene& base, const FabricModel& model, int newton, int linear, double tolerance, int threads,
                  int frames) {
  Scene scene = base;
  scene.simulation.newtonIterations = newton;
  scene.simulation.linearIterations = linear;
  scene.simulation.tolerance = tolerance;
  World world(scene, {.threads = threads});
  return Measure(
      "engine", std::to_string(newton) + " x " + std::to_string(linear), model, frames, [&] { world.Step(); },
      [&] { return world.Cloth(0).positions(); });
}

Run MeasureXpbd(const FabricModel& model, std::span<const std::uint8_t> free, int substeps, int frames) {
  XpbdCloth cloth(model, free);
  return Measure(
      "XPBD", std::to_string(substeps) + " substeps", model, frames, [&] { cloth.Frame(kFrame, substeps, kGravity); },
      [&] { return cloth.positions(); });
}

Run MeasureDirect(const FabricModel& model, std::span<const std::uint8_t> free, int newton, int frames) {
  fabric::ReferenceSolver solver(model);
  std::vector<Vec3> position = model.start, previous = position, predicted = position, y = position;
  const std::vector<fabric::VertexLoad> loads(position.size());
  const auto frame = [&] {
    for (std::size_t v = 0; v < position.size(); ++v) {
      y[v] = free[v] ? position[v] * 2 - previous[v] : position[v];
      predicted[v] = free[v] ? y[v] + kGravity * (kFrame * kFrame) : y[v];
    }
    solver.Begin({kFrame, position, predicted, loads, free});
    solver.Solve(y, {.maxIterations = newton, .tolerance = 1e-9});
    std::swap(previous, position);
    position = y;
  };
  return Measure("Newton, direct", std::to_string(newton) + " iterations", model, frames, frame,
                 [&] { return std::span<const Vec3>(position); });
}

struct Table {
  int side = 0;
  double stiffness = 0;
  double converged = 0;  // stretch
  std::vector<Run> runs;
};

void Compare(Run& run, const Run& converged) {
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  run.error = std::abs(mean(run.stretch) - mean(converged.stretch)) / (mean(converged.stretch) - 1);
}

Table MeasureTable(int side, double stiffness, int frames) {
  const Scene scene = HangingSheet(side, stiffness);
  const FabricModel model = fabric::BuildModel(scene, std::vector<RestMesh>{MakeGridMesh(scene.cloths[0])});
  std::vector<std::uint8_t> free(static_cast<std::size_t>(model.vertexCount), 1);
  for (const GridPoint& pin : scene.cloths[0].pinned) free[static_cast<std::size_t>(pin.j * side + pin.i)] = 0;
  Table table{side, stiffness, 0, {}};
  const Run converged = MeasureEngine(scene, model, 200, 200, 1e-6, 1, frames);
  table.converged = converged.stretch.back();
  for (const auto& [newton, linear] : {std::pair{1, 4}, {2, 6}, {3, 6}, {4, 8}, {8, 16}}) {
    table.runs.push_back(MeasureEngine(scene, model, newton, linear, 1e-3, 1, frames));
  }
  if (side <= kSmallDirect) {
    for (const int newton : {1, 2, 4}) table.runs.push_back(MeasureDirect(model, free, newton, frames));
  } else if (side <= kLargestDirect) {
    table.runs.push_back(MeasureDirect(model, free, 2, std::max(frames / 3, kMeasuredFrames)));
  }
  for (const int substeps : {10, 20, 40, 80, 160, 320}) {
    table.runs.push_back(MeasureXpbd(model, free, substeps, frames));
  }
  for (Run& run : table.runs) Compare(run, converged);
  return table;
}

/// The fastest run of a method whose error is within the goal, or none.
const Run* Fastest(const Table& table, const std::string& method) {
  const Run* best = nullptr;
  for (const Run& run : table.runs) {
    if (run.method == method && run.error <= kGoal && (!best || run.milliseconds < best->milliseconds)) best = &run;
  }
  return best;
}

struct Scale {
  int side = 0;
  double one = 0, many = 0;  // ns per vertex and frame
  bool equal = false;
};

Scale MeasureScale(int side, int threads, int frames) {
  Scale scale{side, 0, 0, false};
  const Scene scene = HangingSheet(side, 1);
  std::uint64_t hashes[2] = {};
  for (int run = 0; run < 2; ++run) {
    World world(scene, {.threads = run == 0 ? 1 : threads});
    std::vector<double> times;
    for (int f = 0; f < frames; ++f) {
      const auto start = std::chrono::steady_clock::now();
      world.Step();
      times.push_back(Seconds(start) * 1e9 / (static_cast<double>(side) * side));
    }
    (run == 0 ? scale.one : scale.many) = Median(times);
    hashes[run] = world.StateHash();
  }
  scale.equal = hashes[0] == hashes[1];
  return scale;
}

std::string Json(const std::vector<Table>& tables, const std::vector<Scale>& scales, int threads) {
  std::string text = "{\"threads\": " + std::to_string(threads) + ", \"pareto\": [";
  const char* separator = "";
  for (const Table& table : tables) {
    for (const Run& run : table.runs) {
      text += separator + std::string("\n  {\"side\": ") + std::to_string(table.side) +
              ", \"stiffness\": " + FormatNumber(table.stiffness) + ", \"method\": " + Quote(run.method) +
              ", \"setting\": " + Quote(run.setting) + ", \"ms_per_frame\": " + FormatNumber(run.milliseconds) +
              ", \"error\": " + FormatNumber(run.error) + "}";
      separator = ",";
    }
  }
  text += "\n], \"scaling\": [";
  separator = "";
  for (const Scale& scale : scales) {
    text += separator + std::string("\n  {\"side\": ") + std::to_string(scale.side) +
            ", \"ns_per_vertex_one_thread\": " + FormatNumber(scale.one) +
            ", \"ns_per_vertex_threads\": " + FormatNumber(scale.many) + "}";
    separator = ",";
  }
  return text + "\n]}\n";
}

void Print(const Table& table) {
  std::printf("\n%d x %d vertices, %g times cotton's stiffness; stretch of the converged run %.4f\n", table.side,
              table.side, table.stiffness, table.converged);
  std::printf("%-15s %-14s %12s %10s\n", "method", "setting", "ms per frame", "error");
  for (const Run& run : table.runs) {
    std::printf("%-15s %-14s %12.2f %9.1f%%\n", run.method.c_str(), run.setting.c_str(), run.milliseconds,
                100 * run.error);
  }
  const Run* engine = Fastest(table, "engine");
  for (const char* method : {"Newton, direct", "XPBD"}) {
    const Run* other = Fastest(table, method);
    if (engine && other)
      std::printf("within %.0f %%: %.1f times faster than %s\n", 100 * kGoal,
                  other->milliseconds / engine->milliseconds, method);
    else if (engine)
      std::printf("within %.0f %%: %s did not get there\n", 100 * kGoal, method);
  }
}

}  // namespace

int BenchFabric(const FabricBenchOptions& options) {
  const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  const int frames = std::max(options.frames > 0 ? options.frames : kFrames, kMeasuredFrames + 1);
  std::vector<Table> tables;
  for (const int side : options.sizes) {
    for (const double stiffness : kStiffnesses) {
      std::fprintf(stderr, "%d x %d, stiffness x %g\n", side, side, stiffness);
      tables.push_back(MeasureTable(side, stiffness, frames));
      if (!options.json) Print(tables.back());
      std::fflush(stdout);
    }
  }
  std::vector<Scale> scales;
  bool equal = true;
  for (const int side : {32, 100, 316, 1000}) {
    std::fprintf(stderr, "scaling: %d x %d\n", side, side);
    scales.push_back(MeasureScale(side, threads, side > 500 ? 5 : side > 200 ? 15 : 60));
    equal = equal && scales.back().equal;
  }
  if (options.json) {
    std::printf("%s", Json(tables, scales, threads).c_str());
  } else {
    std::printf("\nNanoseconds per vertex and frame of the engine at its defaults\n%10s %12s %12s  %s\n", "vertices",
                "1 thread", (std::to_string(threads) + " threads").c_str(), "positions");
    for (const Scale& scale : scales) {
      std::printf("%10d %12.0f %12.0f  %s\n", scale.side * scale.side, scale.one, scale.many,
                  scale.equal ? "equal to the last bit" : "DIFFER");
    }
  }
  return equal ? 0 : 1;
}

}  // namespace percale::bench
