#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/memory.h"
#include "core/text.h"
#include "percale/parameters.h"
#include "world/limits.h"

namespace percale {
namespace {

/// Points of all cloths together: their indices, and those of their springs (six per point), fit
/// 32 bits.
constexpr std::int64_t kMostPoints = std::int64_t{1} << 27;
/// What one point takes in a World and in a picture of it, measured generously [byte].
constexpr std::int64_t BytesPerPoint(Engine engine) {
  return engine == Engine::Fabric ? 3600 : 720;
}
/// A spacing below this is lost in coordinates of the order of 1 m [m].
constexpr double kSmallestSpacing = 1e-9;
/// A normal shorter than this has no direction that could be trusted.
constexpr double kShortestNormal = 1e-9;
constexpr int kMostStepsPerFrame = 100000;
constexpr std::size_t kLongestShaderName = 100;
/// Of a list of a million wrong pins nobody reads more.
constexpr std::size_t kMostMessages = 10000;

using Indices = std::vector<std::size_t>;

class Checker {
 public:
  explicit Checker(const Scene& scene) : scene_(scene) {}

  Diagnostics Check() {
    CheckValues();
    // What follows computes with the values, so it needs them to be in range.
    if (HasErrors(diagnostics_)) return std::move(diagnostics_);
    if (scene_.cloths.empty()) Error("/cloth", "expected at least one cloth, got none; state an object \"cloth\"");
    CheckSize();
    for (std::size_t c = 0; c < scene_.cloths.size(); ++c) CheckCloth(c);
    for (std::size_t p = 0; p < scene_.planes.size(); ++p) CheckPlane(p);
    for (std::size_t m = 0; m < scene_.pinMotions.size(); ++m) CheckMotion(m);
    CheckShader();
    return std::move(diagnostics_);
  }

 private:
  void Error(const std::string& path, const std::string& message) {
    if (diagnostics_.size() < kMostMessages || !hasErrors_) diagnostics_.push_back(MakeError(path + ": " + message));
    hasErrors_ = true;
  }
  void Warn(const std::string& path, const std::string& message) {
    if (diagnostics_.size() < kMostMessages) diagnostics_.push_back(MakeWarning(path + ": " + message));
  }

  void CheckValues() {
    for (const Parameter& parameter : Parameters()) {
      const ParameterGroup& group = *FindGroup(parameter.group);
      for (std::size_t i = 0; i < group.count(scene_); ++i) {
        const auto problem = CheckValue(parameter, parameter.get(scene_, i));
        if (!problem) continue;
        const std::string index = group.isArray ? "/" + std::to_string(i) : "";
        Error("/" + std::string(group.name) + index + "/" + std::string(parameter.name), *problem);
      }
    }
  }

  void CheckSize() {
    std::int64_t points = 0;
    std::size_t largest = 0;
    const auto count = [&](std::size_t c) {
      return std::int64_t{scene_.cloths[c].numWidthPoints} * scene_.cloths[c].numHeightPoints;
    };
    for (std::size_t c = 0; c < scene_.cloths.size(); ++c) {
      points += count(c);
      if (count(c) > count(largest)) largest = c;
    }
    std::int64_t most = kMostPoints;
    std::string why = "that the program can number";
    const std::uint64_t memory = AvailableMemory();
    const std::int64_t bytesPerPoint = BytesPerPoint(scene_.simulation.engine);
    if (memory > 0 && memory / static_cast<std::uint64_t>(bytesPerPoint) < static_cast<std::uint64_t>(most)) {
      most = static_cast<std::int64_t>(memory / static_cast<std::uint64_t>(bytesPerPoint));
      why = "that fit this machine's memory, at " + std::to_string(bytesPerPoint) + " bytes each";
    }
    if (points <= most) return;
    const ClothSettings& cloth = scene_.cloths[largest];
    Error(Path(largest, "num_width_points"),
          "expected at most " + std::to_string(most) + " points in all cloths together, the most " + why + "; got " +
              std::to_string(points) + ", of which this cloth has " + std::to_string(cloth.numWidthPoints) + " x " +
              std::to_string(cloth.numHeightPoints));
  }

  static std::string Path(std::size_t cloth, const char* name) {
    return "/cloth/" + std::to_string(cloth) + "/" + name;
  }
  static std::string Text(const GridPoint& p) { return "[" + std::to_string(p.i) + ", " + std::to_string(p.j) + "]"; }
  static bool Inside(const ClothSettings& cloth, const GridPoint& p) {
    return p.i >= 0 && p.j >= 0 && p.i < cloth.numWidthPoints && p.j < cloth.numHeightPoints;
  }

  void CheckCloth(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (cloth.width / (cloth.numWidthPoints - 1) < kSmallestSpacing)
      TooSmall(c, "width", cloth.width, cloth.numWidthPoints);
    if (cloth.height / (cloth.numHeightPoints - 1) < kSmallestSpacing)
      TooSmall(c, "height", cloth.height, cloth.numHeightPoints);
    CheckPins(c);
    if (scene_.simulation.engine == Engine::Fabric)
      CheckFabric(c);
    else
      CheckSprings(c);
  }

  void CheckFabric(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (cloth.density == 0)
      Error(Path(c, "density"), "expected a number > 0 kg/m^2, got 0: nothing could move the cloth");
    // The weft narrows the warp by the same energy: nu_weft = nu stretch_weft / stretch_warp.
    const double most = std::sqrt(cloth.stretchWarp / cloth.stretchWeft);
    if (std::abs(cloth.poissonRatio) >= most) {
      Error(
          Path(c, "poisson_ratio"),
          "expected a number between -" + FormatNumber(RoundDown(most, 4)) + " and " +
              FormatNumber(RoundDown(most, 4)) +
              ", the root of stretch_warp / stretch_weft: beyond it the cloth would gain energy by being pulled; got " +
              FormatNumber(cloth.poissonRatio));
    }
    if (cloth.membraneLaw == MembraneLaw::NeoHookean && cloth.stretchWarp != cloth.stretchWeft) {
      Warn(Path(c, "membrane_law"),
           "neo_hookean has one stiffness for all directions, the mean of stretch_warp and stretch_weft");
    }
  }

  void CheckSprings(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (cloth.density == 0) {
      Warn(Path(c, "density"),
           "the cloth has no mass: neither gravity nor its springs move it; state a density > 0 kg/m^2");
    }
    const double largestKs = LargestStableKs(cloth, scene_.TimeStep());
    if (cloth.ks >= largestKs) {
      const int steps = SmallestStableStepsPerFrame(cloth, scene_.simulation.framesPerSecond);
      std::string remedy = "lower ks below " + FormatNumber(RoundDown(largestKs, 4)) + " N/m";
      if (steps <= kMostStepsPerFrame)
        remedy += ", or set simulation.steps_per_frame to " + std::to_string(steps) + " or more";
      Warn(Path(c, "ks"), FormatNumber(cloth.ks) + " N/m is above the stable limit of " +
                              FormatNumber(RoundDown(largestKs, 4)) +
                              " N/m at this mass and time step, so the cloth will blow up; " + remedy);
    }
    const double largestThickness = LargestSensibleThickness(cloth);
    if (scene_.simulation.selfCollision && cloth.thickness > largestThickness) {
      Warn(Path(c, "thickness"), "points keep 2 * " + FormatNumber(cloth.thickness) +
                                     " m apart, which is more than the grid's smallest spacing of " +
                                     FormatNumber(RoundDown(2 * largestThickness, 4)) +
                                     " m, so the sheet will swell at once; lower thickness to " +
                                     FormatNumber(RoundDown(largestThickness, 4)) + " m or less");
    }
  }

  void TooSmall(std::size_t c, const char* side, double extent, int points) {
    Error(Path(c, side), "expected a spacing of at least " + FormatNumber(kSmallestSpacing) +
                             " m between the grid's points, got " + FormatNumber(extent) + " m for " +
                             std::to_string(points) + " points");
  }

  /// The pins of a cloth, sorted, for look-up.
  static std::vector<GridPoint> SortedPins(const ClothSettings& cloth) {
    std::vector<GridPoint> pins = cloth.pinned;
    std::sort(pins.begin(), pins.end(), Before);
    return pins;
  }
  static bool Before(const GridPoint& a, const GridPoint& b) { return a.j != b.j ? a.j < b.j : a.i < b.i; }

  /// Places in `points` whose point stands earlier in the list as well.
  static Indices Repeated(const std::vector<GridPoint>& points) {
    Indices order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return Before(points[a], points[b]); });
    Indices repeated;
    for (std::size_t k = 1; k < order.size(); ++k) {
      if (points[order[k]] == points[order[k - 1]]) repeated.push_back(order[k]);
    }
    std::sort(repeated.begin(), repeated.end());
    return repeated;
  }

  void CheckPins(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    for (std::size_t k = 0; k < cloth.pinned.size(); ++k) {
      if (Inside(cloth, cloth.pinned[k])) continue;
      Error(Path(c, "pinned") + "/" + std::to_string(k),
            "expected a point of the grid, from [0, 0] to [" + std::to_string(cloth.numWidthPoints - 1) + ", " +
                std::to_string(cloth.numHeightPoints - 1) + "], got " + Text(cloth.pinned[k]));
    }
    for (const std::size_t k : Repeated(cloth.pinned)) {
      Warn(Path(c, "pinned") + "/" + std::to_string(k),
           Text(cloth.pinned[k]) + " is pinned already; the second mention does nothing");
    }
  }

  void CheckPlane(std::size_t p) {
    const Vec3& normal = scene_.planes[p].normal;
    if (Length(normal) >= kShortestNormal) return;
    Error("/plane/" + std::to_string(p) + "/normal",
          "expected a direction, such as [0, 1, 0] for a floor, got " + FormatValue(normal) + ", which has none");
  }

  void CheckMotion(std::size_t m) {
    const PinMotion& motion = scene_.pinMotions[m];
    const std::string path = "/pin_motion/" + std::to_string(m);
    if (!(motion.end > motion.start)) {
      Error(path + "/end", "expected a time after the start at " + FormatNumber(motion.start) + " s, got " +
                               FormatNumber(motion.end) + " s");
    }
    const std::size_t cloths = scene_.cloths.size();
    if (static_cast<std::size_t>(motion.cloth) >= cloths) {
      Error(path + "/cloth", "expected the index of a cloth, " +
                                 (cloths == 1 ? "0 as there is only one" : "from 0 to " + std::to_string(cloths - 1)) +
                                 ", got " + std::to_string(motion.cloth));
      return;
    }
    const ClothSettings& cloth = scene_.cloths[static_cast<std::size_t>(motion.cloth)];
    const std::string whose = cloths == 1 ? "of the cloth" : "of cloth " + std::to_string(motion.cloth);
    if (cloth.pinned.empty()) {
      Error(path + (motion.points.empty() ? "" : "/points"),
            "there is no pin " + whose + " that could move; state its `pinned` points");
      return;
    }
    const std::vector<GridPoint> pins = SortedPins(cloth);
    for (std::size_t k = 0; k < motion.points.size(); ++k) {
      if (std::binary_search(pins.begin(), pins.end(), motion.points[k], Before)) continue;
      Error(path + "/points/" + std::to_string(k), "expected a pinned point " + whose + ", got " +
                                                       Text(motion.points[k]) +
                                                       "; add it to `pinned` or take it out here");
    }
    for (const std::size_t k : Repeated(motion.points)) {
      Warn(path + "/points/" + std::to_string(k),
           Text(motion.points[k]) + " is moved already; the second mention does nothing");
    }
  }

  /// The name becomes part of a file's path, and must not lead out of the folder of shaders.
  void CheckShader() {
    const std::string& name = scene_.look.shader;
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 && c != '/' && c != '\\' && c != ':';
    });
    if (plain && !name.empty() && name.size() <= kLongestShaderName && name[0] != '.') return;
    Error("/look/shader",
          "expected the name of a shader without folder or ending, such as \"Phong\", got " + Quote(name, 40));
  }

  const Scene& scene_;
  Diagnostics diagnostics_;
  bool hasErrors_ = false;
};

}  // namespace

Diagnostics CheckScene(const Scene& scene) {
  return Checker(scene).Check();
}

}  // namespace percale
