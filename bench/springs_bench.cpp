#include "bench/springs_bench.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <thread>

#include "bench/median.h"
#include "bench/plain_twin.h"
#include "core/text.h"
#include "percale/scene_file.h"
#include "percale/world.h"
#include "springs/kernels.h"

namespace percale::bench {
namespace {

constexpr int kRounds = 5;
constexpr int kPointsPerRound = 40000;  // times frames; keeps a default run below a minute
constexpr int kHashSize = 50;           // points along a side in the table of hash functions
constexpr int kHashFrame = 60;          // where the falling sheet lies in many layers

using Clock = std::chrono::steady_clock;
using StageTimes = std::array<double, kStageCount>;

template <class Function>
double Seconds(Function&& function) {
  const Clock::time_point start = Clock::now();
  function();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Case {
  std::string name;
  int size = 0;
  int frames = 0;                        // timed, in all rounds together
  double twin = 0, one = 0, many = 0;    // ns per point and step
  double ratioOne = 0, ratioMany = 0;    // of the twin's time
  StageTimes stagesOne{}, stagesMany{};  // ns per point and step
  bool equal = false;                    // to the last bit
};

struct HashRow {
  const char* name = "";
  PlainTwin::PairCount pairs;
  double time = 0;  // ms per step
};

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

std::optional<Scene> FindScene(const SpringsBenchOptions& options, const std::string& name, int size) {
  Scene scene;
  if (options.root.empty()) {
    scene = CourseScene(name);
  } else {
    Result<Scene> loaded = LoadScene(options.root / "scene" / (name + ".json"));
    if (!loaded) {
      std::fputs(Format(loaded.diagnostics()).c_str(), stderr);
      return std::nullopt;
    }
    scene = *loaded;
  }
  Resize(scene, size);
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

Case TimeCase(const Scene& scene, const std::string& name, int size, int threads, int frames) {
  Case result{.name = name, .size = size, .frames = kRounds * frames};
  std::fprintf(stderr, "%s %d x %d\n", name.c_str(), size, size);
  PlainTwin twin(scene);
  World one(scene, {.threads = 1}), many(scene, {.threads = threads});
  StageTimes warmUp{};
  twin.Frame();
  RunFrames(one, 1, warmUp);
  RunFrames(many, 1, warmUp);

  const double toNs = 1e9 / (static_cast<double>(twin.PointCount()) * scene.simulation.stepsPerFrame * frames);
  std::vector<double> twinTimes, oneTimes, manyTimes, ratiosOne, ratiosMany;
  std::vector<StageTimes> stagesOne, stagesMany;
  for (int round = 0; round < kRounds; ++round) {
    StageTimes timesOne{}, timesMany{};
    twinTimes.push_back(toNs * Seconds([&] {
                          for (int frame = 0; frame < frames; ++frame) twin.Frame();
                        }));
    oneTimes.push_back(toNs * Seconds([&] { RunFrames(one, frames, timesOne); }));
    manyTimes.push_back(toNs * Seconds([&] { RunFrames(many, frames, timesMany); }));
    ratiosOne.push_back(twinTimes.back() / oneTimes.back());
    ratiosMany.push_back(twinTimes.back() / manyTimes.back());
    stagesOne.push_back(timesOne);
    stagesMany.push_back(timesMany);
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
  result.equal = SameBits(twin, one) && SameBits(twin, many);
  return result;
}

/// The same folded sheet for each hash function: the pairs that its buckets bring together, and the
/// time of the steps that follow.
std::array<HashRow, 4> CompareHashes(Scene scene) {
  std::fprintf(stderr, "hash functions\n");
  constexpr HashFunction functions[4] = {HashFunction::Exact, HashFunction::Linear, HashFunction::Powers,
                                         HashFunction::Brute};
  std::array<HashRow, 4> rows{{{"exact", {}, 0}, {"linear", {}, 0}, {"powers", {}, 0}, {"brute", {}, 0}}};
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
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t h = 0; h < rows.size(); ++h) {
      times[h].push_back(1e3 / scene.simulation.stepsPerFrame * Seconds([&] { worlds[h].Step(); }));
    }
  }
  for (std::size_t h = 0; h < rows.size(); ++h) rows[h].time = Median(times[h]);
  return rows;
}

void PrintTables(const std::vector<Case>& cases, const std::array<HashRow, 4>& hashes, int threads) {
  std::printf("Nanoseconds per point and step, kernels for %s; the plain twin is the textbook program.\n",
              springs::BestKernels().name);
  std::printf("%-14s %11s %7s %11s %9s %11s %8s %11s  %s\n", "scene", "grid", "frames", "plain twin", "1 thread",
              (std::to_string(threads) + " threads").c_str(), "faster", "faster", "positions");
  for (const Case& c : cases) {
    const std::string grid = std::to_string(c.size) + " x " + std::to_string(c.size);
    std::printf("%-14s %11s %7d %11.1f %9.1f %11.1f %7.1fx %10.1fx  %s\n", c.name.c_str(), grid.c_str(), c.frames,
                c.twin, c.one, c.many, c.ratioOne, c.ratioMany, c.equal ? "equal to the last bit" : "DIFFERENT");
  }

  std::printf("\nThe same by stage\n%-14s %11s %7s", "scene", "grid", "threads");
  for (int s = 0; s < kStageCount; ++s) std::printf(" %13s", std::string(StageName(static_cast<Stage>(s))).c_str());
  std::printf("\n");
  for (const Case& c : cases) {
    const std::string grid = std::to_string(c.size) + " x " + std::to_string(c.size);
    for (const bool alone : {true, false}) {
      std::printf("%-14s %11s %7d", c.name.c_str(), grid.c_str(), alone ? 1 : threads);
      for (const double time : alone ? c.stagesOne : c.stagesMany) std::printf(" %13.2f", time);
      std::printf("\n");
    }
  }

  std::printf("\nHash functions: selfCollision %d x %d, frame %d, one thread\n", kHashSize, kHashSize, kHashFrame);
  std::printf("%-14s %12s %13s %12s %13s\n", "function", "close pairs", "missed pairs", "false pairs", "ms per step");
  for (const HashRow& row : hashes) {
    std::printf("%-14s %12lld %13lld %12lld %13.3f\n", row.name, static_cast<long long>(row.pairs.found),
                static_cast<long long>(row.pairs.missed), static_cast<long long>(row.pairs.falseNeighbours), row.time);
  }
  std::printf(
      "Close: nearer than twice the thickness and in one bucket; missed: as near, but in different buckets;\n"
      "false: in one bucket, though their boxes differ.\n");
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

void PrintJson(const std::vector<Case>& cases, const std::array<HashRow, 4>& hashes, int threads) {
  std::string text = "{\n  \"kernels\": " + Quote(springs::BestKernels().name) +
                     ",\n  \"threads\": " + std::to_string(threads) + ",\n  \"ns_per_point_and_step\": [";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    text += (i > 0 ? ",\n" : "\n") + std::string("    {\"scene\": ") + Quote(c.name) +
            ", \"size\": " + std::to_string(c.size) + ", \"frames\": " + std::to_string(c.frames) +
            ", \"plain_twin\": " + Short(c.twin) + ", \"one_thread\": " + Short(c.one) +
            ", \"many_threads\": " + Short(c.many) + ", \"ratio_one_thread\": " + Short(c.ratioOne) +
            ", \"ratio_many_threads\": " + Short(c.ratioMany) + ", \"equal\": " + (c.equal ? "true" : "false") +
            ",\n     \"stages_one_thread\": " + StagesJson(c.stagesOne) +
            ",\n     \"stages_many_threads\": " + StagesJson(c.stagesMany) + "}";
  }
  text += "\n  ],\n  \"hash_functions\": [";
  for (std::size_t h = 0; h < hashes.size(); ++h) {
    const HashRow& row = hashes[h];
    text += (h > 0 ? ",\n" : "\n") + std::string("    {\"function\": ") + Quote(row.name) +
            ", \"close_pairs\": " + std::to_string(row.pairs.found) +
            ", \"missed_pairs\": " + std::to_string(row.pairs.missed) +
            ", \"false_pairs\": " + std::to_string(row.pairs.falseNeighbours) +
            ", \"ms_per_step\": " + Short(row.time) + "}";
  }
  std::puts((text + "\n  ]\n}").c_str());
}

}  // namespace

int BenchSprings(const SpringsBenchOptions& options) {
  constexpr int kInvalidScene = 3;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = options.threads > 0 ? options.threads : cores;
  std::vector<Case> cases;
  for (const char* name : {"pinned2", "selfCollision"}) {
    for (const int size : options.sizes) {
      const std::optional<Scene> scene = FindScene(options, name, size);
      if (!scene) return kInvalidScene;
      const int frames = options.frames > 0 ? options.frames : std::clamp(kPointsPerRound * 3 / (size * size), 2, 16);
      cases.push_back(TimeCase(*scene, name, size, threads, frames));
    }
  }
  const std::optional<Scene> folded = FindScene(options, "selfCollision", kHashSize);
  if (!folded) return kInvalidScene;
  const std::array<HashRow, 4> hashes = CompareHashes(*folded);
  if (options.json) {
    PrintJson(cases, hashes, threads);
  } else {
    PrintTables(cases, hashes, threads);
  }
  const bool equal = std::all_of(cases.begin(), cases.end(), [](const Case& c) { return c.equal; });
  if (!equal) std::fputs("error: the engine's positions differ from the plain twin's\n", stderr);
  return equal ? 0 : 1;
}

}  // namespace percale::bench
