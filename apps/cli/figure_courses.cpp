#include "apps/cli/figure_courses.h"

#include <algorithm>

namespace percale::cli {
namespace {

constexpr double kNearlyDown = 0.2;  // m; the free edge of pinned2 falls from 1 to about 0
constexpr int kLastFrames = 90;      // of a course: a second

}  // namespace

std::vector<StudyCourse> StudyCourses() {
  std::vector<StudyCourse> courses;
  const auto add = [&](const auto& sweep, int frames) {
    for (const auto& point : sweep) courses.push_back({point.course, frames});
  };
  add(kStiffnesses, kHangingFrames);
  add(kDensities, kHangingFrames);
  add(kDampings, kHangingFrames);
  add(kDrapes, kDrapeFrames);
  add(kPlanes, kPlaneFrames);
  return courses;
}

double Last(const Table& table, const char* column) {
  return table.At(table.rows.size() - 1, column);
}

std::optional<double> FallTime(const Table& course) {
  const std::vector<double> y = course.Column("lowest_y"), time = course.Column("time");
  for (std::size_t i = 1; i < y.size(); ++i) {
    if (y[i] < kNearlyDown) return time[i] + (time[i - 1] - time[i]) * (kNearlyDown - y[i]) / (y[i - 1] - y[i]);
  }
  return std::nullopt;
}

std::optional<double> RestTime(const Table& course) {
  for (std::size_t i = 0; i < course.rows.size(); ++i) {
    if (course.At(i, "at_rest") != 0) return course.At(i, "time");
  }
  return std::nullopt;
}

double ResidualMotion(const Table& course) {
  const std::vector<double> moves = course.Column("move");
  const std::size_t count = std::min<std::size_t>(kLastFrames, moves.size());
  double sum = 0;
  for (std::size_t i = moves.size() - count; i < moves.size(); ++i) sum += moves[i];
  return count == 0 ? 0 : sum / double(count);
}

}  // namespace percale::cli
