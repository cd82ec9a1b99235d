#include "apps/cli/figure_studies.h"

#include <algorithm>
#include <cmath>

#include "apps/cli/figure_courses.h"
#include "collide/boxes.h"

namespace percale::cli {
namespace {

constexpr int kHashFrames = 60;  // the sheet is down, in layers
constexpr int kHashEvery = 10;

}  // namespace

int HashStudyFrames() {
  return kHashFrames;
}
int RatioStudyFrames() {
  return 2 * kHangingFrames;
}

std::optional<Course> StudyHash(const std::string& study, const SceneLoader& load, const std::function<bool()>& goOn) {
  Scene scene = load(kFold);
  const auto found = std::find(std::begin(kHashStudies), std::end(kHashStudies), study);
  scene.simulation.hash = static_cast<HashFunction>(found - std::begin(kHashStudies));
  World world(scene, {.threads = 1});
  Table table;
  table.columns = {"frame", "compared", "false", "close", "missed", "seconds", "highest_y", "mean_y"};
  double seconds = 0;
  while (world.report().frame < kHashFrames) {
    if (!goOn()) return std::nullopt;
    const StepReport& report = world.Step();
    if (report.divergence) return Course{{}, {}, report.divergence};
    seconds += report.stageSeconds[std::size_t(Stage::FindContacts)];
    seconds += report.stageSeconds[std::size_t(Stage::SelfCollide)];
    if (report.frame % kHashEvery != 0) continue;
    const auto positions = world.Cloth(0).positions();
    const PairCounts pairs =
        CountPairs(positions, BoxSize(scene.cloths), 2 * scene.cloths[0].thickness, scene.simulation.hash);
    double highest = -INFINITY, sum = 0;
    for (const Vec3& x : positions) {
      highest = std::max(highest, x.y);
      sum += x.y;
    }
    table.rows.push_back({double(report.frame), double(pairs.compared), double(pairs.fromOtherBoxes),
                          double(pairs.close), double(pairs.missed),
                          seconds / (kHashEvery * scene.simulation.stepsPerFrame), highest,
                          sum / double(positions.size())});
    seconds = 0;
  }
  return Course{std::move(table), {}, {}};
}

std::optional<Course> StudyRatio(const SceneLoader& load, const std::function<bool()>& goOn) {
  std::vector<Course> courses;
  for (const char* name : {kRatioA, kRatioB}) {
    auto course = MeasureCourse(load(name), kHangingFrames, {kHangingFrames}, goOn);
    if (!course) return std::nullopt;
    if (course->divergence) return Course{{}, {}, course->divergence};
    courses.push_back(std::move(*course));
  }
  double farthest = 0;
  const std::vector<Vec3>&a = courses[0].shapes[kHangingFrames][0], &b = courses[1].shapes[kHangingFrames][0];
  for (std::size_t v = 0; v < a.size(); ++v) farthest = std::max(farthest, Length(a[v] - b[v]));
  Table table{{"farthest", "lowest_y_a", "lowest_y_b"},
              {{farthest, Last(courses[0].table, "lowest_y"), Last(courses[1].table, "lowest_y")}}};
  return Course{std::move(table), {}, {}};
}

Table CountSprings(const SceneLoader& load) {
  Table table{{"all", "no_shearing", "only_shearing"}, {{}}};
  for (const char* course : {"pinned2", "pinned2 cloth.enable_shearing=false",
                             "pinned2 cloth.enable_structural=false cloth.enable_bending=false"}) {
    table.rows[0].push_back(double(World(load(course), {.threads = 1}).Cloth(0).springs().size()));
  }
  return table;
}

}  // namespace percale::cli
