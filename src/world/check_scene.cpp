#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "collide/shapes.h"
#include "core/memory.h"
#include "core/text.h"
#include "mesh/cloth_model.h"
#include "mesh/collider_mesh.h"
#include "mesh/pins.h"
#include "mesh/rest_mesh.h"
#include "mesh/vertex_cache.h"
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
/// Of more pins not all pairs are compared.
constexpr std::size_t kMostComparedPins = 500;
/// Between two samples of a cache [s].
constexpr double kShortestSample = 1e-5, kLongestSample = 1e4;
/// At so many times of a motion that turns.
constexpr int kPartsOfTurn = 8;
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
    for (std::size_t p = 0; p < scene_.patches.size(); ++p) CheckPatch(p);
    for (std::size_t t = 0; t < scene_.tethers.size(); ++t) CheckTether(t);
    for (std::size_t p = 0; p < scene_.planes.size(); ++p) CheckPlane(p);
    for (std::size_t m = 0; m < scene_.pinMotions.size(); ++m) CheckMotion(m);
    for (std::size_t c = 0; c < scene_.colliders.size(); ++c) CheckCollider(c);
    for (std::size_t m = 0; m < scene_.colliderMotions.size(); ++m) CheckColliderMotion(m);
    CheckShader();
    if (scene_.simulation.engine == Engine::Fabric && !hasErrors_ && !scene_.pinMotions.empty()) WarnOfPinsApart();
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
    const auto count = [&](std::size_t c) { return VertexCount(scene_.cloths[c]); };
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
    const bool grid = cloth.shape == Shape::Grid;
    Error(Path(largest, grid                         ? "num_width_points"
                        : cloth.shape == Shape::Disc ? "rings"
                                                     : "mesh"),
          "expected at most " + std::to_string(most) + " points in all cloths together, the most " + why + "; got " +
              std::to_string(points) + ", of which this cloth has " +
              (grid ? std::to_string(cloth.numWidthPoints) + " x " + std::to_string(cloth.numHeightPoints)
                    : std::to_string(VertexCount(cloth))));
  }

  static std::string Path(std::size_t cloth, const char* name) {
    return "/cloth/" + std::to_string(cloth) + "/" + name;
  }
  static std::string Text(const GridPoint& p) { return "[" + std::to_string(p.i) + ", " + std::to_string(p.j) + "]"; }
  static std::string Text(const ClothSettings& cloth, const GridPoint& p) {
    return cloth.shape == Shape::Grid || p.j != 0 ? Text(p) : std::to_string(p.i);
  }
  static bool Inside(const ClothSettings& cloth, const GridPoint& p) { return VertexOf(cloth, p).has_value(); }
  /// Which points a cloth has.
  static std::string Points(const ClothSettings& cloth) {
    switch (cloth.shape) {
      case Shape::Grid:
        return "a point of the grid, from [0, 0] to [" + std::to_string(cloth.numWidthPoints - 1) + ", " +
               std::to_string(cloth.numHeightPoints - 1) + "]";
      case Shape::Disc:
        return "a vertex of the disc, from 0 to " + std::to_string(VertexCount(cloth) - 1);
      case Shape::Mesh:
        break;
    }
    const std::vector<std::int32_t>& source = cloth.loaded->mesh.source;
    const std::int64_t last = source.empty() ? VertexCount(cloth) - 1 : source.back();
    return "a vertex of the mesh, from 0 to " + std::to_string(last) +
           (last + 1 == VertexCount(cloth) ? "" : ", that belongs to a triangle and was not welded to a lower one");
  }

  /// Whether there is something to check further.
  bool CheckShape(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (scene_.simulation.engine == Engine::Springs && cloth.shape != Shape::Grid) {
      Error(Path(c, "shape"), "expected \"grid\", the one shape of the engine springs, got " +
                                  FormatValue(FindParameter("cloth", "shape")->get(scene_, c)) +
                                  "; set simulation.engine to \"fabric\"");
      return false;
    }
    if (cloth.shape == Shape::Mesh) return CheckMesh(c);
    if (!cloth.mesh.empty()) Warn(Path(c, "mesh"), NotRead(cloth.mesh));
    if (!cloth.pinnedGroup.empty()) {
      Error(Path(c, "pinned_group"), "expected none, for only a mesh has groups; list the points in `pinned`, got " +
                                         Quote(cloth.pinnedGroup, 40));
    }
    return true;
  }

  static std::string NotRead(const std::string& mesh) {
    return Quote(mesh, 80) + " is not read, for `shape` says otherwise; set it to \"mesh\"";
  }

  bool CheckMesh(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (cloth.mesh.empty()) {
      Error(Path(c, "mesh"), "expected the file of a mesh, .obj or .ply, got none");
      return false;
    }
    const LoadedMesh* const loaded = cloth.loaded.get();
    if (!loaded || loaded->file != cloth.mesh || loaded->options != MeshOptionsOf(cloth)) {
      Error(Path(c, "mesh"), Quote(cloth.mesh, 80) + " is not loaded with these settings; call LoadMeshes first");
      return false;
    }
    if (!cloth.pinnedGroup.empty() && !FindVertexGroup(cloth, cloth.pinnedGroup))
      Error(Path(c, "pinned_group"), NoGroup(cloth, cloth.pinnedGroup));
    return true;
  }

  static std::string NoGroup(const ClothSettings& cloth, const std::string& name) {
    std::vector<std::string_view> names;
    std::string list;
    constexpr std::size_t kMostNamed = 20;
    for (const VertexGroup& group : cloth.loaded->mesh.groups) {
      if (names.size() < kMostNamed) list += (names.empty() ? "" : ", ") + Quote(group.name, 40);
      names.push_back(group.name);
    }
    if (names.size() > kMostNamed) list += ", ...";
    return "expected a group of the mesh, got " + Quote(name, 40) + DidYouMean(name, names) + "; " +
           (names.empty() ? "it has none: name them by g or o in an .obj" : "it has " + list);
  }

  void CheckPatch(std::size_t p) {
    const Patch& patch = scene_.patches[p];
    const std::string path = "/patch/" + std::to_string(p);
    if (!CheckClothIndex(path, patch.cloth)) return;
    if (scene_.simulation.engine != Engine::Fabric) Warn(path, "only the engine \"fabric\" heeds this");
    const ClothSettings& cloth = scene_.cloths[static_cast<std::size_t>(patch.cloth)];
    const bool grid = cloth.shape == Shape::Grid;
    if (!patch.group.empty()) {
      if (cloth.shape != Shape::Mesh)
        Error(path + "/group", "expected none, for only a mesh has groups, got " + Quote(patch.group, 40) +
                                   (grid ? "; state a `rectangle`" : ""));
      else if (cloth.loaded && !FindVertexGroup(cloth, patch.group))
        Error(path + "/group", NoGroup(cloth, patch.group));
    }
    if (patch.rectangle.empty()) return;
    if (!grid) {
      Error(path + "/rectangle", std::string("expected none, for the cloth is no grid") +
                                     (cloth.shape == Shape::Mesh ? "; state a `group`" : ""));
    } else if (patch.rectangle.size() != 2) {
      Error(path + "/rectangle", "expected two opposite corners, [[i0, j0], [i1, j1]], got " +
                                     std::to_string(patch.rectangle.size()) +
                                     (patch.rectangle.size() == 1 ? " point" : " points"));
    } else {
      for (std::size_t k = 0; k < 2; ++k) {
        if (!Inside(cloth, patch.rectangle[k]))
          Error(path + "/rectangle/" + std::to_string(k),
                "expected " + Points(cloth) + ", got " + Text(patch.rectangle[k]));
      }
    }
  }

  /// Whether there is a cloth of that index.
  bool CheckClothIndex(const std::string& path, int index) {
    const std::size_t cloths = scene_.cloths.size();
    if (static_cast<std::size_t>(index) < cloths) return true;
    Error(path + "/cloth", "expected the index of a cloth, " +
                               (cloths == 1 ? "0 as there is only one" : "from 0 to " + std::to_string(cloths - 1)) +
                               ", got " + std::to_string(index));
    return false;
  }

  void CheckCloth(std::size_t c) {
    if (!CheckShape(c)) return;
    if (scene_.cloths[c].shape == Shape::Grid) CheckSpacing(c);
    CheckPins(c);
    if (scene_.simulation.engine == Engine::Fabric)
      CheckFabric(c);
    else
      CheckSprings(c);
  }

  void CheckSpacing(std::size_t c) {
    const ClothSettings& cloth = scene_.cloths[c];
    if (cloth.width / (cloth.numWidthPoints - 1) < kSmallestSpacing)
      TooSmall(c, "width", cloth.width, cloth.numWidthPoints);
    if (cloth.height / (cloth.numHeightPoints - 1) < kSmallestSpacing)
      TooSmall(c, "height", cloth.height, cloth.numHeightPoints);
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
    if (cloth.restAngles == RestAngles::Start && cloth.bendingLaw == BendingLaw::Quadratic) {
      Warn(Path(c, "rest_angles"), "bending_law quadratic bends back to flat; set it to \"hinges\"");
    }
    if (cloth.foldYield > 0 && cloth.bendingLaw == BendingLaw::Quadratic) {
      Warn(Path(c, "fold_yield"), "no fold sets with bending_law quadratic; set it to \"hinges\"");
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
            "expected " + Points(cloth) + ", got " + Text(cloth, cloth.pinned[k]));
    }
    for (const std::size_t k : Repeated(cloth.pinned)) {
      Warn(Path(c, "pinned") + "/" + std::to_string(k),
           Text(cloth, cloth.pinned[k]) + " is pinned already; the second mention does nothing");
    }
  }

  void CheckPlane(std::size_t p) {
    CheckDirection("/plane/" + std::to_string(p) + "/normal", scene_.planes[p].normal, "[0, 1, 0] for a floor");
  }

  void CheckDirection(const std::string& path, const Vec3& direction, const std::string& example) {
    if (Length(direction) >= kShortestNormal) return;
    Error(path, "expected a direction, such as " + example + ", got " + FormatValue(direction) + ", which has none");
  }

  void CheckCollider(std::size_t c) {
    const ColliderSettings& collider = scene_.colliders[c];
    const std::string path = "/collider/" + std::to_string(c);
    if (collider.shape == ColliderShape::Torus && collider.tubeRadius >= collider.radius) {
      Error(path + "/tube_radius", "expected less than the radius of its ring, " + FormatNumber(collider.radius) +
                                       " m, got " + FormatNumber(collider.tubeRadius) +
                                       " m: the tube would run into itself; for a ball take the shape \"sphere\"");
    }
    if (scene_.simulation.engine != Engine::Fabric) {
      Warn(path, "only the engine \"fabric\" heeds this");
      return;
    }
    CheckCache(c);
    if (collider.shape != ColliderShape::Mesh) {
      if (!collider.mesh.empty()) Warn(path + "/mesh", NotRead(collider.mesh));
      return;
    }
    if (collider.mesh.empty()) {
      Error(path + "/mesh", "expected the file of a mesh, .obj or .ply, got none");
    } else if (LacksMesh(collider)) {
      Error(path + "/mesh", Quote(collider.mesh, 80) + " is not loaded with these settings; call LoadMeshes first");
    } else if (const int open = collider.loaded->openEdges; open > 0 && !collider.twoSided) {
      Warn(path + "/two_sided",
           "the mesh is open: " + std::to_string(open) + (open == 1 ? " edge has" : " edges have") +
               " one triangle only, so it has no inside, and cloth that comes from behind is drawn "
               "through; set this to true, or close the mesh");
    }
  }

  void CheckCache(std::size_t c) {
    const ColliderSettings& collider = scene_.colliders[c];
    const std::string path = "/collider/" + std::to_string(c);
    if (collider.cache.empty()) {
      for (const char* const key : {"cache_rate", "cache_start"}) {
        const Parameter& parameter = *FindParameter("collider", key);
        if (parameter.get(scene_, c) != DefaultValue(parameter))
          Warn(path + "/" + key, "the collider has no `cache` that it could belong to");
      }
      return;
    }
    if (collider.shape != ColliderShape::Mesh) {
      Error(path + "/cache", "expected none, for only the shape \"mesh\" has vertices that could move, got " +
                                 Quote(collider.cache, 40));
      return;
    }
    if (!collider.loaded) return;  // told at the mesh
    if (LacksCache(collider)) {
      Error(path + "/cache", Quote(collider.cache, 80) + " is not loaded with these settings; call LoadMeshes first");
      return;
    }
    const double seconds = SampleSeconds(scene_, collider);
    const bool fits = seconds >= kShortestSample && seconds <= kLongestSample;
    if (collider.loadedCache->samples == 1) return;
    if (collider.cacheRate > 0 || fits) {
      const double move = collider.meshScale * static_cast<double>(collider.loadedCache->greatestMove);
      WarnOfLeap(path + "/cache", move * std::min(scene_.TimeStep() / seconds, 1.0), SizeOf(collider),
                 "lower `cache_rate`");
      return;
    }
    Error(path + "/cache", "the file states " + FormatNumber(RoundDown(collider.loadedCache->spacing, 4)) +
                               " from sample to sample, which is " + FormatNumber(RoundDown(seconds, 4)) +
                               " s here; expected from " + FormatNumber(kShortestSample) + " to " +
                               FormatNumber(kLongestSample) +
                               " s; state the samples per second in `cache_rate`, such as 24");
  }

  void CheckColliderMotion(std::size_t m) {
    const ColliderMotion& motion = scene_.colliderMotions[m];
    const std::string path = "/collider_motion/" + std::to_string(m);
    if (!motion.jump) CheckTimes(path, motion.start, motion.end);
    if (motion.angle != 0) CheckDirection(path + "/axis", motion.axis, "[0, 1, 0] for the vertical");
    const std::size_t colliders = scene_.colliders.size();
    if (static_cast<std::size_t>(motion.collider) < colliders) {
      if (motion.end > motion.start && scene_.simulation.engine == Engine::Fabric) WarnOfLeap(path, motion);
      return;
    }
    Error(path + "/collider",
          colliders == 0
              ? "there is no collider that could move; state a \"collider\": those of \"sphere\" and \"plane\" do not"
              : "expected the index of a collider, " +
                    (colliders == 1 ? "0 as there is only one" : "from 0 to " + std::to_string(colliders - 1)) +
                    ", got " + std::to_string(motion.collider));
  }

  /// The longest edge of its box, in its own frame [m].
  static double SizeOf(const ColliderSettings& collider) {
    if (collider.shape != ColliderShape::Mesh) {
      const Vec3 half = HalfExtent(MakeSolid(collider));
      return 2 * std::max({half.x, half.y, half.z});
    }
    if (!collider.loaded) return std::numeric_limits<double>::infinity();
    Vec3 low = collider.loaded->mesh.positions.front(), high = low;
    for (const Vec3& x : collider.loaded->mesh.positions) {
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  }

  /// What goes farther in a step than it is large was hardly meant to sweep up all that is on its way.
  void WarnOfLeap(const std::string& path, const ColliderMotion& motion) {
    if (motion.jump) return;
    const ColliderSettings& collider = scene_.colliders[static_cast<std::size_t>(motion.collider)];
    const double arm = motion.ownCentre ? 0 : Length(collider.position - motion.centre);
    const double way = Length(motion.displacement) + std::abs(motion.angle) * (std::numbers::pi / 180) * arm;
    const double fastest = motion.steady ? 1 : 1.5;  // The greatest slope of s² (3 - 2 s).
    WarnOfLeap(path, way * std::min(fastest * scene_.TimeStep() / (motion.end - motion.start), 1.0), SizeOf(collider),
               "set `jump` to true if cloth is not to be swept along");
  }
  void WarnOfLeap(const std::string& path, double way, double size, const std::string& remedy) {
    if (!(way > size)) return;
    Warn(path, "goes up to " + FormatNumber(RoundDown(way, 3)) + " m in a step of " +
                   FormatNumber(RoundDown(scene_.TimeStep(), 3)) + " s, farther than the collider is large, " +
                   FormatNumber(RoundDown(size, 3)) + " m; slow it down, raise simulation.steps_per_frame, or " +
                   remedy);
  }

  void CheckTimes(const std::string& path, double start, double end) {
    if (end > start) return;
    Error(path + "/end",
          "expected a time after the start at " + FormatNumber(start) + " s, got " + FormatNumber(end) + " s");
  }

  void CheckTether(std::size_t t) {
    const Tether& tether = scene_.tethers[t];
    const std::string path = "/tether/" + std::to_string(t);
    if (!CheckClothIndex(path, tether.cloth)) return;
    if (scene_.simulation.engine != Engine::Fabric) Warn(path, "only the engine \"fabric\" heeds this");
    const ClothSettings& cloth = scene_.cloths[static_cast<std::size_t>(tether.cloth)];
    if (tether.points.empty()) Error(path + "/points", "expected at least one point");
    if (cloth.shape == Shape::Mesh && !cloth.loaded) return;
    for (std::size_t k = 0; k < tether.points.size(); ++k) {
      if (VertexOf(cloth, tether.points[k])) continue;
      Error(path + "/points/" + std::to_string(k),
            "expected " + Points(cloth) + ", got " + Text(cloth, tether.points[k]));
    }
  }

  void CheckMotion(std::size_t m) {
    const PinMotion& motion = scene_.pinMotions[m];
    const std::string path = "/pin_motion/" + std::to_string(m);
    CheckTimes(path, motion.start, motion.end);
    if (motion.angle != 0) CheckDirection(path + "/axis", motion.axis, "[0, 1, 0] for the vertical");
    if (!CheckClothIndex(path, motion.cloth)) return;
    const ClothSettings& cloth = scene_.cloths[static_cast<std::size_t>(motion.cloth)];
    const std::string whose = scene_.cloths.size() == 1 ? "of the cloth" : "of cloth " + std::to_string(motion.cloth);
    if (cloth.shape == Shape::Mesh && !cloth.loaded) return;
    const std::vector<std::int32_t> pins = PinnedVertices(cloth);
    if (pins.empty()) {
      Error(path + (motion.points.empty() ? "" : "/points"),
            "there is no pin " + whose + " that could move; state its `pinned` points");
      return;
    }
    for (std::size_t k = 0; k < motion.points.size(); ++k) {
      const auto vertex = VertexOf(cloth, motion.points[k]);
      if (vertex && std::binary_search(pins.begin(), pins.end(), *vertex)) continue;
      Error(path + "/points/" + std::to_string(k), "expected a pinned point " + whose + ", got " +
                                                       Text(cloth, motion.points[k]) +
                                                       "; add it to `pinned` or take it out here");
    }
    for (const std::size_t k : Repeated(motion.points)) {
      Warn(path + "/points/" + std::to_string(k),
           Text(cloth, motion.points[k]) + " is moved already; the second mention does nothing");
    }
  }

  /// Pins that are carried farther apart than the cloth between them is long, of cloths that are flat at the start.
  void WarnOfPinsApart() {
    for (std::size_t c = 0; c < scene_.cloths.size(); ++c) {
      const ClothSettings& cloth = scene_.cloths[c];
      std::vector<std::int32_t> vertices = PinnedVertices(cloth);
      if (cloth.shape == Shape::Mesh || vertices.size() < 2 || vertices.size() > kMostComparedPins) continue;
      Scene alone;
      alone.cloths = {cloth};
      std::vector<double> times;
      for (const PinMotion& motion : scene_.pinMotions) {
        if (static_cast<std::size_t>(motion.cloth) != c) continue;
        alone.pinMotions.push_back(motion);
        alone.pinMotions.back().cloth = 0;
        // What is turned may be farther off on the way.
        const int parts = motion.angle != 0 ? kPartsOfTurn : 1;
        for (int k = 1; k <= parts; ++k) times.push_back(motion.start + (motion.end - motion.start) * k / parts);
      }
      if (times.empty()) continue;
      const std::vector<Vec3> start = MakeClothMesh(cloth).positions;
      Pins pins;
      pins.Update(alone, std::vector<int>{0}, 0, [&](int v) { return start[static_cast<std::size_t>(v)]; });
      double worst = 1 + cloth.strainLimit;
      std::string message;
      for (const double time : times) {
        pins.MoveTo(time);
        for (const Pin& a : pins.All()) {
          for (const Pin& b : pins.All().first(static_cast<std::size_t>(&a - pins.All().data()))) {
            const double apart = Length(a.target - b.target), cloth0 = Length(a.anchor - b.anchor);
            if (!(apart > worst * cloth0)) continue;
            worst = apart / cloth0;
            message = "pins " + Text(cloth, PointOf(cloth, b.point)) + " and " + Text(cloth, PointOf(cloth, a.point)) +
                      " are carried " + FormatNumber(RoundDown(apart, 3)) + " m apart at " + FormatNumber(time) +
                      " s, with " + FormatNumber(RoundDown(cloth0, 3)) +
                      " m of cloth between them: more than its strain_limit of " + FormatNumber(cloth.strainLimit) +
                      " lets it stretch";
          }
        }
      }
      if (!message.empty()) Warn("/pin_motion", message);
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
