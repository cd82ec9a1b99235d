#pragma once
/// \file
/// What a cloth is, apart from its state: built once from its settings, then immutable.

#include <cstdint>
#include <vector>

#include "percale/mesh.h"
#include "percale/scene.h"

namespace percale {

struct ClothModel {
  int numWidth = 0, numHeight = 0;  ///< Grid points; point (i, j) is index j * numWidth + i.
  std::vector<Vec3> start;          ///< Positions at the start [m].
  std::vector<Vec2> uv;             ///< (i / (numWidth - 1), j / (numHeight - 1)).
  std::vector<Triangle> triangles;  ///< Two per quad: A C B and B C D.

  int PointCount() const { return numWidth * numHeight; }
};

/// The regular grid of the classic simulator. `settings` must be valid.
ClothModel MakeGrid(const ClothSettings& settings);

/// The vertices that the settings pin, ascending, each once.
std::vector<std::int32_t> PinnedVertices(const ClothSettings& settings);

/// Mass of one point of the cloth [kg].
double PointMass(const ClothSettings& settings);

/// The kinds of springs, in the order in which a point creates them.
enum class SpringKind { Left, Up, UpperLeft, UpperRight, TwoLeft, TwoUp };
inline constexpr int kSpringKinds = 6;

/// Step in i and j from the point that creates a spring to its other end.
struct GridStep {
  int di, dj;
};
inline constexpr GridStep kSpringSteps[kSpringKinds] = {{-1, 0}, {0, -1}, {-1, -1}, {1, -1}, {-2, 0}, {0, -2}};

/// Whether `cloth` enables springs of that kind.
bool Enabled(const ClothSettings& cloth, SpringKind kind);

/// The springs of the enabled kinds in creation order: point by point, each to its other end.
std::vector<Edge> EnabledSprings(const ClothModel& model, const ClothSettings& settings);

}  // namespace percale
