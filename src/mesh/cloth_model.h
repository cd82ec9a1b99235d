#pragma once
/// \file
/// What a cloth is, apart from its state: built once from its settings, then immutable.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "percale/mesh.h"
#include "percale/scene.h"

namespace percale {

struct ClothModel {
  int numWidth = 0, numHeight = 0;  ///< Grid points; point (i, j) is index j * numWidth + i. 0 of what is no grid.
  std::vector<Vec3> start;          ///< Positions at the start [m].
  std::vector<Vec2> uv;             ///< Of a grid (i / (numWidth - 1), j / (numHeight - 1)).
  std::vector<Triangle> triangles;  ///< Of a grid two per quad: A C B and B C D.

  int PointCount() const { return static_cast<int>(start.size()); }
};

/// The regular grid of the classic simulator. `settings` must be valid.
ClothModel MakeGrid(const ClothSettings& settings);

/// How many vertices the cloth has.
std::int64_t VertexCount(const ClothSettings& settings);

/// The vertex that a scene names, or nothing if the cloth has none of that name; and the name of a vertex.
std::optional<std::int32_t> VertexOf(const ClothSettings& settings, const GridPoint& point);
GridPoint PointOf(const ClothSettings& settings, std::int32_t vertex);

/// How the settings want their mesh read.
MeshOptions MeshOptionsOf(const ClothSettings& settings);

/// The vertices of a group of the cloth's mesh, or null.
const VertexGroup* FindVertexGroup(const ClothSettings& settings, std::string_view name);

/// How large a cloth is, and how fine.
struct ClothSize {
  double extent = 0;   ///< Longest side [m].
  double area = 0;     ///< At rest [m^2].
  double spacing = 0;  ///< From vertex to vertex, at most [m]; of a mesh about.
};
ClothSize SizeOf(const ClothSettings& settings);

/// The vertices that the settings pin, ascending, each once.
std::vector<std::int32_t> PinnedVertices(const ClothSettings& settings);

/// Mass of one point of a grid [kg].
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
/// How long each spring is between points at rest [m].
std::vector<double> LengthsOf(std::span<const Edge> springs, std::span<const Vec3> rest);

}  // namespace percale
