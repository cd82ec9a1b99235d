#include "apps/cli/measurements.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/index.h"
#include "core/text.h"
#include "io/atomic_file.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

/// Mean angle between the normals of neighbouring squares of the grid [degree].
double Folding(std::span<const Vec3> x, int numWidth, int numHeight) {
  const int wide = numWidth - 1, high = numHeight - 1;
  std::vector<Vec3> normals;
  normals.reserve(Index(wide * high));
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i) {
      const std::size_t a = Index(j * numWidth + i), b = a + 1, c = a + Index(numWidth), d = c + 1;
      normals.push_back(UnitOr(Cross(x[d] - x[a], x[c] - x[b]), {0, 0, 1}));
    }
  }
  double sum = 0;
  int pairs = 0;
  const auto add = [&](std::size_t square, std::size_t neighbour) {
    sum += std::acos(std::clamp(Dot(normals[square], normals[neighbour]), -1.0, 1.0));
    ++pairs;
  };
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i) {
      const std::size_t square = Index(j * wide + i);
      if (i > 0) add(square, square - 1);
      if (j > 0) add(square, square - Index(wide));
    }
  }
  return pairs == 0 ? 0 : sum / pairs * 180 / std::numbers::pi;
}

std::vector<double> MeasureFrame(const World& world) {
  const StepReport& report = world.report();
  double lowest = INFINITY, highest = -INFINITY, sum = 0, count = 0;
  for (int c = 0; c < world.ClothCount(); ++c) {
    for (const Vec3& x : world.Cloth(c).positions()) {
      lowest = std::min(lowest, x.y);
      highest = std::max(highest, x.y);
      sum += x.y;
      ++count;
    }
  }
  const ClothSettings& cloth = world.scene().cloths[0];
  return {report.time,
          lowest,
          highest,
          sum / count,
          report.frame == 0 ? 1 : report.greatestStretch,
          report.kineticEnergy,
          report.greatestMove,
          double(report.atRest),
          cloth.shape == percale::Shape::Grid
              ? Folding(world.Cloth(0).positions(), cloth.numWidthPoints, cloth.numHeightPoints)
              : 0};
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

std::vector<double> Table::Column(std::string_view column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  assert(found != columns.end());
  std::vector<double> values;
  for (const std::vector<double>& row : rows) values.push_back(row[Index(found - columns.begin())]);
  return values;
}

double Table::At(std::size_t row, std::string_view column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  assert(found != columns.end() && row < rows.size());
  return rows[row][Index(found - columns.begin())];
}

Status WriteTable(const fs::path& file, const std::string& key, const Table& table) {
  std::string text = "# " + key + "\n";
  for (std::size_t c = 0; c < table.columns.size(); ++c) text += (c > 0 ? "," : "") + table.columns[c];
  for (const std::vector<double>& row : table.rows) {
    text += "\n";
    for (std::size_t c = 0; c < row.size(); ++c) text += (c > 0 ? "," : "") + FormatNumber(row[c]);
  }
  text += "\n# end\n";
  return WriteFile(file, text);
}

std::optional<Table> ReadTable(const fs::path& file, const std::string& key) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || line != "# " + key || !std::getline(in, line)) return std::nullopt;
  Table table;
  table.columns = Cells(line);
  while (std::getline(in, line)) {
    if (line == "# end") return table;
    std::vector<double> row;
    for (const std::string& cell : Cells(line)) {
      const auto number = ParseNumber(cell);
      if (!number) return std::nullopt;
      row.push_back(*number);
    }
    if (row.size() != table.columns.size()) return std::nullopt;
    table.rows.push_back(std::move(row));
  }
  return std::nullopt;  // the end is missing
}

ClothShapes ShapeOf(const World& world) {
  ClothShapes shape;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const auto positions = world.Cloth(c).positions();
    shape.emplace_back(positions.begin(), positions.end());
  }
  return shape;
}

std::optional<Course> MeasureCourse(const Scene& scene, int frames, const std::set<int>& shapes,
                                    const std::function<bool()>& goOn) {
  World world(scene, {.threads = 1});
  Course course;
  course.table.columns = {"time",           "lowest_y", "highest_y", "mean_y", "stretch",
                          "kinetic_energy", "move",     "at_rest",   "folding"};
  for (;;) {
    const int frame = world.report().frame;
    course.table.rows.push_back(MeasureFrame(world));
    if (shapes.count(frame) != 0) course.shapes[frame] = ShapeOf(world);
    if (frame == frames) return course;
    if (!goOn()) return std::nullopt;
    if (world.Step().divergence) {
      course.divergence = world.report().divergence;
      return course;
    }
  }
}

}  // namespace percale::cli
