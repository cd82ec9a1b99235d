#pragma once
/// \file
/// Numbers that were measured: tables, the files that keep them, and the course of a simulation.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale::cli {

struct Table {
  std::vector<std::string> columns;       ///< Names.
  std::vector<std::vector<double>> rows;  ///< As long as `columns` each.

  // The column must be there, and the row.
  std::vector<double> Column(std::string_view column) const;  ///< One value per row.
  double At(std::size_t row, std::string_view column) const;
};

/// Keeps a table as CSV. `key`, one line, says what it was measured from. Fails when the file cannot be written;
/// an older one then stays.
Status WriteTable(const std::filesystem::path& file, const std::string& key, const Table& table);
/// The table of a file; nothing where it is missing, damaged, or was measured from something else.
std::optional<Table> ReadTable(const std::filesystem::path& file, const std::string& key);

/// Positions, cloth by cloth.
using ClothShapes = std::vector<std::vector<Vec3>>;
/// A copy of where all points are now [m].
ClothShapes ShapeOf(const World& world);

/// How a simulation went: a row for the start and for each frame, with the columns `time` [s],
/// `lowest_y`, `highest_y`, `mean_y` [m], `stretch` (greatest length over rest length),
/// `kinetic_energy` [J], `move` (farthest way of a point over the frame [m]), `at_rest` (0 or 1) and
/// `folding` (mean angle between neighbouring squares of the first cloth [degree]).
struct Course {
  Table table;
  std::map<int, ClothShapes> shapes;     ///< Of the frames that were asked for.
  std::optional<Divergence> divergence;  ///< Set: the course ends with the last good frame.
};

/// Runs the scene on one thread. `goOn` is asked before each frame; nothing once it says no.
std::optional<Course> MeasureCourse(const Scene& scene, int frames, const std::set<int>& shapes,
                                    const std::function<bool()>& goOn);

}  // namespace percale::cli
