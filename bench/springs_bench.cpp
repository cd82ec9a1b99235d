#include "bench/springs_bench.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>

#include "bench/median.h"
#include "core/text.h"
#include "percale/scene_file.h"
#include "percale/world.h"
#include "springs/kernels.h"

namespace percale::bench {
namespace {

constexpr int kRounds = 3;
constexpr int kFramesPerTurn = 5;
constexpr int kPointsPerRound = 600000;  // times frames; keeps a default run near a minute
constexpr int kMostFrames = 80;          // the falling sheet lies folded by then
constexpr int kHashRounds = 5;
constexpr int kHashSize = 50;   // points along a side in the table of hash functions
constexpr int kHashFrame = 60;  // where the falling sheet lies in many layers

using Clock = std::chrono::steady_clock;
using StageTimes = std::array<double, kStageCount>;

template <class Function>
double Seconds(Function&& function) {
  const Clock::time_point start = Clock::now();
  function();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The scenes of the course, in code.
Scene CourseScene(const std::string& name) {
  Scene scene;
  scene.name = name;
  ClothSettings cloth;
  if (name == "pinned2") {
    cloth.pinned = {{0, 0}, {cloth.numWidthPoints - 1, 0}};
  } else {
    cloth.orientation = Orientation::Vertical;
    scene.planes.push_back({});
  }
  scene.cloths.push_back(cloth);
  return scene;
}

/// The scene on a grid of `size` x `size` points. Pins stay at their share of the sheet, and twice
/// the thickness stays as far below the spacing as it is.
void Resize(Scene& scene, int size) {
  for (ClothSettings& cloth : scene.cloths) {
    const int lastI = cloth.numWidthPoints - 1, lastJ = cloth.numHeightPoints - 1;
    for (GridPoint& pin : cloth.pinned) pin = {pin.i * (size - 1) / lastI, pin.j * (size - 1) / lastJ};
    cloth.thickness *= static_cast<double>(std::min(lastI, lastJ)) / (size - 1);
    cloth.numWidthPoints = cloth.numHeightPoints = size;
  }
}

Result<Scene> FindScene(const SpringsBenchOptions& options, const std::string& name, int size) {
  Result<Scene> scene = options.root.empty() ? CourseScene(name) : LoadScene(options.root / "scene" / (name + ".json"));
  if (scene) Resize(*scene, size);
  return scene;
}

bool SameBits(const PlainTwin& twin, const World& world) {
  for (int c = 0; c < world.ClothCount(); ++c) {
    const std::vector<Vec3> expected = twin.Positions(c);
    const std::span<const Vec3> found = world.Cloth(c).positions();
    if (expected.size() != found.size()) return false;
    if (std::memcmp(expected.data(), found.data(), found.size_bytes()) != 0) return false;
  }
  return true;
}

/// Runs some frames and adds their stages to `stages` [s].
void RunFrames(World& world, int frames, StageTimes& stages) {
  for (int frame = 0; frame < frames; ++frame) {
    const StepReport& report = world.Step();
    for (std::size_t s = 0; s < stages.size(); ++s) stages[s] += report.stageSeconds[s];
  }
}

SpringsRun TimeScene(const Scene& scene, const std::string& name, int size, int threads, int frames) {
  SpringsRun result{.scene = name, .size = size, .frames = frames};
  std::fprintf(stderr, "%s %d x %d\n", name.c_str(), size, size);
  const double toNs =
      1e9 / (static_cast<double>(PlainTwin(scene).PointCount()) * scene.simulation.stepsPerFrame * frames);
  std::vector<double> twinTimes, oneTimes, manyTimes, ratiosOne, ratiosMany;
  std::vector<StageTimes> stagesOne, stagesMany;
  result.equal = true;
  for (int round = 0; round < kRounds; ++round) {
    PlainTwin twin(scene);
    World one(scene, {.threads = 1}), many(scene, {.threads = threads});
    StageTimes timesOne{}, timesMany{};
    // In turns, so that what else the machine does meets all of them.
    double twinTime = 0, oneTime = 0, manyTime = 0;
    for (int frame = 0; frame < frames; frame += kFramesPerTurn) {
      const int count = std::min(kFramesPerTurn, frames - frame);
      twinTime += Seconds([&] {
        for (int f = 0; f < count; ++f) twin.Frame();
      });
      oneTime += Seconds([&] { RunFrames(one, count, timesOne); });
      manyTime += Seconds([&] { RunFrames(many, count, timesMany); });
    }
    twinTimes.push_back(toNs * twinTime);
    oneTimes.push_back(toNs * oneTime);
    manyTimes.push_back(toNs * manyTime);
    ratiosOne.push_back(twinTimes.back() / oneTimes.back());
    ratiosMany.push_back(twinTimes.back() / manyTimes.back());
    stagesOne.push_back(timesOne);
    stagesMany.push_back(timesMany);
    result.equal = result.equal && SameBits(twin, one) && SameBits(twin, many);
  }
  result.twin = Median(twinTimes);
  result.one = Median(oneTimes);
  result.many = Median(manyTimes);
  result.ratioOne = Median(ratiosOne);
  result.ratioMany = Median(ratiosMany);
  for (std::size_t s = 0; s < kStageCount; ++s) {
    std::vector<double> a, b;
    for (const StageTimes& times : stagesOne) a.push_back(toNs * times[s]);
    for (const StageTimes& times : stagesMany) b.push_back(toNs * times[s]);
    result.stagesOne[s] = Median(a);
    result.stagesMany[s] = Median(b);
  }
  return result;
}

/// The same folded sheet for each hash function: the pairs that its buckets bring together, and the
/// time of the steps that follow.
std::vector<HashRun> CompareHashes(Scene scene) {
  std::fprintf(stderr, "hash functions\n");
  constexpr HashFunction functions[4] = {HashFunction::Exact, HashFunction::Linear, HashFunction::Powers,
                                         HashFunction::Brute};
  std::vector<HashRun> rows{{"exact", {}, 0}, {"linear", {}, 0}, {"powers", {}, 0}, {"brute", {}, 0}};
  std::vector<World> worlds;
  for (std::size_t h = 0; h < rows.size(); ++h) {
    scene.simulation.hash = HashFunction::Exact;
    World& world = worlds.emplace_back(scene, WorldOptions{.threads = 1});
    for (int frame = 0; frame < kHashFrame; ++frame) world.Step();
    scene.simulation.hash = functions[h];
    world.Apply(scene);
    PlainTwin twin(scene);
    for (int c = 0; c < world.ClothCount(); ++c) twin.SetPositions(c, world.Cloth(c).positions());
    rows[h].pairs = twin.CountPairs();
  }
  std::array<std::vector<double>, 4> times;
  for (int round = 0; round < kHashRounds; ++round) {
    for (std::size_t h = 0; h < rows.size(); ++h) {
      times[h].push_back(1e3 / scene.simulation.stepsPerFrame * Seconds([&] { worlds[h].Step(); }));
    }
  }
  for (std::size_t h = 0; h < rows.size(); ++h) rows[h].time = Median(times[h]);
  return rows;
}

/// Of the grid and the number of frames or threads, which begin the lines of two tables.
std::string LineStart(const SpringsRun& run, int number) {
  const std::string grid = std::to_string(run.size) + " x " + std::to_string(run.size);
  return Text("%-14s %11s %7d", run.scene.c_str(), grid.c_str(), number);
}

std::string StagesTable(const SpringsBench& bench) {
  std::string text = Text("\nThe same by stage\n%-14s %11s %7s", "scene", "grid", "threads");
  for (int s = 0; s < kStageCount; ++s) text += Text(" %13s", std::string(StageName(static_cast<Stage>(s))).c_str());
  text += "\n";
  for (const SpringsRun& run : bench.runs) {
    for (const bool alone : {true, false}) {
      text += LineStart(run, alone ? 1 : bench.threads);
      for (const double time : alone ? run.stagesOne : run.stagesMany) text += Text(" %13.2f", time);
      text += "\n";
    }
  }
  return text;
}

std::string HashTable(const SpringsBench& bench) {
  std::string text =
      Text("\nHash functions: selfCollision %d x %d, frame %d, one thread\n", kHashSize, kHashSize, kHashFrame);
  text += Text("%-14s %12s %13s %12s %13s\n", "function", "close pairs", "missed pairs", "false pairs", "ms per step");
  for (const HashRun& row : bench.hashes) {
    text += Text("%-14s %12lld %13lld %12lld %13.3f\n", row.function.c_str(), static_cast<long long>(row.pairs.found),
                 static_cast<long long>(row.pairs.missed), static_cast<long long>(row.pairs.falseNeighbours), row.time);
  }
  return text +
         "Close: nearer than twice the thickness and in one bucket; missed: as near, but in different buckets;\n"
         "false: in one bucket, though their boxes differ.\n";
}

/// Three decimals, whatever the locale.
std::string Short(double value) {
  return FormatNumber(static_cast<double>(static_cast<long long>(value * 1000 + 0.5)) / 1000);
}

std::string StagesJson(const StageTimes& stages) {
  std::string text = "{";
  for (std::size_t s = 0; s < stages.size(); ++s) {
    text += (s > 0 ? ", " : "") + Quote(StageName(static_cast<Stage>(s))) + ": " + Short(stages[s]);
  }
  return text + "}";
}

}  // namespace

bool SpringsBench::Equal() const {
  return std::all_of(runs.begin(), runs.end(), [](const SpringsRun& run) { return run.equal; });
}

Result<SpringsBench> MeasureSprings(const SpringsBenchOptions& options) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  SpringsBench bench;
  bench.threads = options.threads > 0 ? options.threads : cores;
  for (const char* name : {"pinned2", "selfCollision"}) {
    for (const int size : options.sizes) {
      const Result<Scene> scene = FindScene(options, name, size);
      if (!scene) return scene.diagnostics();
      const int frames =
          options.frames > 0 ? options.frames : std::clamp(kPointsPerRound / (size * size), 10, kMostFrames);
      bench.runs.push_back(TimeScene(*scene, name, size, bench.threads, frames));
    }
  }
  const Result<Scene> folded = FindScene(options, "selfCollision", kHashSize);
  if (!folded) return folded.diagnostics();
  bench.hashes = CompareHashes(*folded);
  return bench;
}

std::string FormatTables(const SpringsBench& bench) {
  std::string text = Text("Nanoseconds per point and step, kernels for %s; the plain twin is the textbook program.\n",
                          springs::BestKernels().name);
  text += Text("%-14s %11s %7s %11s %9s %11s %8s %11s  %s\n", "scene", "grid", "frames", "plain twin", "1 thread",
               (std::to_string(bench.threads) + " threads").c_str(), "faster", "faster", "positions");
  for (const SpringsRun& run : bench.runs) {
    text += LineStart(run, run.frames) + Text(" %11.1f %9.1f %11.1f %7.1fx %10.1fx  %s\n", run.twin, run.one, run.many,
                                              run.ratioOne, run.ratioMany,
                                              run.equal ? "equal to the last bit" : "DIFFERENT");
  }
  return text + StagesTable(bench) + HashTable(bench);
}

std::string FormatJson(const SpringsBench& bench) {
  std::string text = "{\n  \"kernels\": " + Quote(springs::BestKernels().name) +
                     ",\n  \"threads\": " + std::to_string(bench.threads) + ",\n  \"ns_per_point_and_step\": [";
  const char* separator = "\n";
  for (const SpringsRun& run : bench.runs) {
    text += separator + std::string("    {\"scene\": ") + Quote(run.scene) + ", \"size\": " + std::to_string(run.size) +
            ", \"frames\": " + std::to_string(run.frames) + ", \"plain_twin\": " + Short(run.twin) +
            ", \"one_thread\": " + Short(run.one) + ", \"many_threads\": " + Short(run.many) +
            ", \"ratio_one_thread\": " + Short(run.ratioOne) + ", \"ratio_many_threads\": " + Short(run.ratioMany) +
            ", \"equal\": " + (run.equal ? "true" : "false") +
            ",\n     \"stages_one_thread\": " + StagesJson(run.stagesOne) +
            ",\n     \"stages_many_threads\": " + StagesJson(run.stagesMany) + "}";
    separator = ",\n";
  }
  text += "\n  ],\n  \"hash_functions\": [";
  separator = "\n";
  for (const HashRun& row : bench.hashes) {
    text += separator + std::string("    {\"function\": ") + Quote(row.function) +
            ", \"close_pairs\": " + std::to_string(row.pairs.found) +
            ", \"missed_pairs\": " + std::to_string(row.pairs.missed) +
            ", \"false_pairs\": " + std::to_string(row.pairs.falseNeighbours) +
            ", \"ms_per_step\": " + Short(row.time) + "}";
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace percale::bench
