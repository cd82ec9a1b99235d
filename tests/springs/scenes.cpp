#include "tests/springs/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "world/limits.h"

namespace percale::test {

Scene CourseScene(const std::string& name, int size) {
  Scene scene;
  scene.name = name;
  ClothSettings cloth;
  cloth.thickness *= 49.0 / (size - 1);
  cloth.numWidthPoints = cloth.numHeightPoints = size;
  const int last = size - 1;
  if (name == "pinned2") cloth.pinned = {{0, 0}, {last, 0}};
  if (name == "pinned4") cloth.pinned = {{0, 0}, {last, 0}, {0, last}, {last, last}};
  if (name == "sphere") scene.spheres.push_back({{0.5, 0.2, 0.5}, 0.2, 0.3});
  if (name == "plane" || name == "selfCollision") scene.planes.push_back({{0, 0, 0}, {0, 1, 0}, 0.5});
  if (name == "selfCollision") cloth.orientation = Orientation::Vertical;
  scene.cloths.push_back(cloth);
  return scene;
}

Scene SmallScene(int numWidth, int numHeight) {
  Scene scene;
  scene.name = "small";
  ClothSettings cloth;
  cloth.numWidthPoints = numWidth;
  cloth.numHeightPoints = numHeight;
  cloth.width = 0.1 * (numWidth - 1);
  cloth.height = 0.1 * (numHeight - 1);
  cloth.thickness = 0.045;
  cloth.ks = 500;
  scene.cloths.push_back(cloth);
  return scene;
}

Scene RandomScene(SplitMix64& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.NextUnit(); };
  const auto whole = [&](int low, int high) {
    return low + static_cast<int>(random.Next() % static_cast<std::uint64_t>(high - low + 1));
  };
  const auto chance = [&](double p) { return random.NextUnit() < p; };
  const auto vector = [&](double low, double high) {
    const double x = between(low, high), y = between(low, high), z = between(low, high);
    return Vec3{x, y, z};
  };

  Scene scene;
  scene.name = "random";
  SimulationSettings& simulation = scene.simulation;
  simulation.framesPerSecond = whole(60, 120);
  simulation.stepsPerFrame = whole(8, 30);
  if (chance(0.3)) simulation.gravity = vector(-10, 10);
  simulation.selfCollision = chance(0.85);
  simulation.hash = static_cast<HashFunction>(whole(0, 3));
  simulation.planeResponse = static_cast<PlaneResponse>(whole(0, 2));
  scene.planesFirst = chance(0.5);

  const int cloths = whole(1, 3);
  for (int c = 0; c < cloths; ++c) {
    ClothSettings cloth;
    cloth.numWidthPoints = whole(2, 13);
    cloth.numHeightPoints = whole(2, 13);
    cloth.width = between(0.3, 1.2);
    cloth.height = between(0.3, 1.2);
    cloth.orientation = chance(0.4) ? Orientation::Vertical : Orientation::Horizontal;
    if (chance(0.7)) cloth.origin = vector(-0.1, 0.1);
    cloth.thickness = chance(0.1) ? 0 : between(0.2, 1.1) * LargestSensibleThickness(cloth);
    cloth.enableStructural = chance(0.85);
    cloth.enableShearing = chance(0.75);
    cloth.enableBending = chance(0.75);
    cloth.damping = chance(0.1) ? 0 : chance(0.05) ? 100 : between(0, 2);
    cloth.density = chance(0.05) ? 0 : between(20, 300);
    const double stable = std::min(LargestStableKs(cloth, scene.TimeStep()), 20000.0);
    cloth.ks = chance(0.05) ? 0 : between(0.01, 0.5) * stable;
    cloth.seed = whole(0, 1000000);
    const int pins = chance(0.5) ? whole(1, 4) : chance(0.05) ? 13 * 13 * 4 : 0;
    for (int k = 0; k < pins; ++k) {
      const int i = whole(0, cloth.numWidthPoints - 1), j = whole(0, cloth.numHeightPoints - 1);
      cloth.pinned.push_back({i, j});
    }
    if (pins > 0 && chance(0.5)) {
      PinMotion motion;
      motion.cloth = c;
      if (chance(0.5)) motion.points = {cloth.pinned.front()};
      motion.start = between(0, 0.05);
      motion.end = motion.start + between(0.05, 0.3);
      motion.displacement = vector(-0.4, 0.4);
      scene.pinMotions.push_back(motion);
    }
    scene.cloths.push_back(cloth);
  }
  for (int k = whole(0, 2); k > 0; --k) {
    const Vec3 origin = vector(0.1, 0.9);
    scene.spheres.push_back({origin, between(0.05, 0.3), chance(0.2) ? std::round(between(0, 1)) : between(0, 1)});
  }
  for (int k = whole(0, 2); k > 0; --k) {
    const Vec3 point = vector(0, 0.9), normal = vector(-1, 1);
    scene.planes.push_back({point, normal + Vec3{0, 1.5, 0}, chance(0.2) ? std::round(between(0, 1)) : between(0, 1)});
  }
  if (chance(0.3)) {
    const Vec3 velocity = vector(-5, 5);
    scene.wind = {velocity, between(0.1, 3), between(0, 1), between(0.1, 2)};
  }
  return scene;
}

std::string FirstDifference(const bench::PlainTwin& twin, const World& world) {
  for (int c = 0; c < world.ClothCount(); ++c) {
    const std::vector<Vec3> expected = twin.Positions(c);
    const std::span<const Vec3> found = world.Cloth(c).positions();
    if (expected.size() != found.size()) return "cloth " + std::to_string(c) + " has another number of points";
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (std::memcmp(&expected[v], &found[v], sizeof(Vec3)) == 0) continue;
      char text[400];
      std::snprintf(text, sizeof text,
                    "frame %d, cloth %d, vertex %d: twin (%.17g %.17g %.17g), engine (%.17g %.17g %.17g)",
                    world.report().frame, c, static_cast<int>(v), expected[v].x, expected[v].y, expected[v].z,
                    found[v].x, found[v].y, found[v].z);
      return text;
    }
  }
  return "";
}

std::string RunBoth(const Scene& scene, int frames, int threads) {
  bench::PlainTwin twin(scene);
  World world(scene, {.threads = threads});
  for (int frame = 0; frame < frames; ++frame) {
    twin.Frame();
    if (const auto& divergence = world.Step().divergence) return "diverged: " + divergence->cause;
    const std::string difference = FirstDifference(twin, world);
    if (!difference.empty()) return difference;
  }
  return "";
}

bool AllFinite(const World& world) {
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    for (const Vec3& p : cloth.positions()) {
      if (!IsFinite(p)) return false;
    }
    for (const Vec3& v : cloth.velocities()) {
      if (!IsFinite(v)) return false;
    }
  }
  return true;
}

double LowestY(const World& world) {
  double y = INFINITY;
  for (int c = 0; c < world.ClothCount(); ++c) {
    for (const Vec3& p : world.Cloth(c).positions()) y = std::min(y, p.y);
  }
  return y;
}

double HighestY(const World& world) {
  double y = -INFINITY;
  for (int c = 0; c < world.ClothCount(); ++c) {
    for (const Vec3& p : world.Cloth(c).positions()) y = std::max(y, p.y);
  }
  return y;
}

double MeanY(const World& world) {
  double sum = 0;
  std::size_t count = 0;
  for (int c = 0; c < world.ClothCount(); ++c) {
    for (const Vec3& p : world.Cloth(c).positions()) sum += p.y;
    count += world.Cloth(c).positions().size();
  }
  return sum / static_cast<double>(count);
}

void Run(World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.Step();
}

}  // namespace percale::test
