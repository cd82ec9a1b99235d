#include "apps/cli/figure_studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "apps/cli/figure_table.h"
#include "apps/cli/session.h"
#include "collide/boxes.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kNearlyDown = 0.2;  // m; the free edge of pinned2 falls from 1 to about 0
constexpr int kLastFrames = 90;      // of a course: a second
constexpr int kFrames = 800;
constexpr int kPlaneFrames = 300;
constexpr int kSphereFrames = 400;

struct SweepPoint {
  double value;
  const char* course;
};
constexpr SweepPoint kStiffnesses[] = {
    {100, "pinned2 cloth.ks=100"},     {500, "pinned2 cloth.ks=500"},
    {1000, "pinned2 cloth.ks=1000"},   {5000, "pinned2"},
    {20000, "pinned2 cloth.ks=20000"}, {100000, "pinned2 cloth.ks=100000"},
};
constexpr SweepPoint kDensities[] = {
    // g/cm^2
    {1, "pinned2 cloth.density=10"},
    {5, "pinned2 cloth.ks=5000 cloth.density=50"},
    {15, "pinned2"},
    {100, "pinned2 cloth.density=1000"},
    {5000, "pinned2 cloth.ks=5000 cloth.density=50000"},
    {50000, "pinned2 cloth.density=500000"},
};
constexpr SweepPoint kDampings[] = {{0, "pinned2 cloth.damping=0"}, {0.2, "pinned2"}, {1, "pinned2 cloth.damping=1"}};
constexpr SweepPoint kDrapes[] = {{500, "sphere cloth.ks=500"}, {5000, "sphere"}, {50000, "sphere cloth.ks=50000"}};

struct PlaneCourse {
  const char* name;
  const char* course;
};
constexpr PlaneCourse kPlanes[] = {{"interpolate", "plane simulation.plane_response=interpolate"},
                                   {"offset", "plane simulation.plane_response=offset"},
                                   {"hold", "plane simulation.plane_response=hold"}};

constexpr const char* kSlack = "pinned2 cloth.ks=0";
constexpr const char* kSoftest = "pinned2 cloth.ks=5 cloth.density=50000";
constexpr const char* kFold = "selfCollision simulation.plane_response=hold";
constexpr const char* kFoldLight = "selfCollision simulation.plane_response=hold cloth.density=10";
constexpr const char* kFoldDense = "selfCollision simulation.plane_response=hold cloth.density=1000";
constexpr const char* kFoldSoft = "selfCollision simulation.plane_response=hold cloth.ks=500";

constexpr const char* kRatioA = "pinned2 cloth.ks=5000 cloth.density=50";
constexpr const char* kRatioB = "pinned2 cloth.ks=1000 cloth.density=10";

constexpr int kHashFrames = 60;  // the sheet is down, in layers
constexpr int kHashEvery = 10;

constexpr int kResolutions[] = {16, 32, 64, 128};
constexpr int kFinest = 512;                 // a sphere whose triangles are smaller than pixels
constexpr double kDrawnSphereRadius = 0.92;  // of the sphere's, as the renderer draws it

const Table& Find(const Measured& measured, const std::string& name) {
  return measured.at(name);
}

double Last(const Table& table, const char* column) {
  return table.At(table.rows.size() - 1, column);
}

std::string Meters(double value) {
  return Text("%.3f m", value);
}

/// A length as people say it.
std::string Small(double meters) {
  if (meters <= 0) return "0 mm";
  if (meters >= 1e-4) return Text("%.2g mm", meters * 1e3);
  return meters >= 1e-7 ? Text("%.2g µm", meters * 1e6) : Text("%.1e m", meters);
}

std::string Seconds(const std::optional<double>& seconds) {
  return seconds ? Text("%.2f s", *seconds) : "not at all";
}

/// "A, B and C"
std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return text;
}

/// A height map as the displacement shader reads it: the red channel, with linear interpolation, repeated.
class HeightMap {
 public:
  explicit HeightMap(const Image& image) : image_(image) {}

  double At(double u, double v) const {
    const double x = u * image_.width - 0.5, y = v * image_.height - 0.5;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double s = x - i, t = y - j;
    return (1 - t) * ((1 - s) * Texel(i, j) + s * Texel(i + 1, j)) +
           t * ((1 - s) * Texel(i, j + 1) + s * Texel(i + 1, j + 1));
  }

 private:
  double Texel(int i, int j) const {
    const auto wrapped = [](int k, int size) { return (k % size + size) % size; };
    return image_.At(wrapped(i, image_.width), wrapped(j, image_.height))[0] / 255.0;
  }
  const Image& image_;
};

/// Distances between the surface that is drawn and the exact one.
struct SurfaceError {
  double rms = 0, max = 0;  // m
};

/// The sphere's mesh with its corners moved out by `height` times the map, against the exact surface:
/// measured along rays from the centre, at points spread over all triangles.
SurfaceError MeasureSurface(int resolution, double radius, double height, const HeightMap& map) {
  const DrawMesh mesh = MakeSphereMesh(resolution, resolution);
  const auto unit = [&](std::uint32_t vertex) {
    const float* p = &mesh.positions[3 * vertex];
    return Vec3{p[0], p[1], p[2]};
  };
  const auto corner = [&](std::uint32_t vertex) {
    return (radius + height * map.At(mesh.uv[2 * vertex], mesh.uv[2 * vertex + 1])) * unit(vertex);
  };
  const int cuts = std::max(1, kFinest / resolution);
  SurfaceError error;
  double sum = 0, weights = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t* v = &mesh.triangles[t];
    const Vec3 a = corner(v[0]), b = corner(v[1]), c = corner(v[2]);
    const double weight = Length(Cross(unit(v[1]) - unit(v[0]), unit(v[2]) - unit(v[0])));
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; i + j < cuts; ++j) {
        const double s = (i + 1.0 / 3) / cuts, r = (j + 1.0 / 3) / cuts;
        const Vec3 p = (1 - s - r) * a + s * b + r * c;
        const Vec3 d = UnitOr(p, {0, 1, 0});
        // As MakeSphereMesh lays its texture.
        const double u = std::atan2(-d.x, -d.z) / (2 * std::numbers::pi), w = std::acos(d.y) / std::numbers::pi;
        const double apart = std::abs(Length(p) - (radius + height * map.At(u, w)));
        error.max = std::max(error.max, apart);
        sum += weight * apart * apart;
        weights += weight;
      }
    }
  }
  error.rms = std::sqrt(sum / weights);
  return error;
}

/// Mean difference per pixel where the sphere faces the camera, away from its outline.
double PictureChange(const Image& a, const Image& b, const Scene& scene, const OrbitCamera& camera) {
  const SphereSettings& sphere = scene.spheres[0];
  const Vec3 toEye = UnitOr(camera.position() - sphere.origin, {0, 0, 1});
  const double radius = kDrawnSphereRadius * sphere.radius;
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Vec3 ray = camera.Ray(x, y, a.width, a.height), from = camera.position() - sphere.origin;
      const double along = Dot(from, ray), inside = along * along - Dot(from, from) + radius * radius;
      if (inside < 0 || Dot(from + (-along - std::sqrt(inside)) * ray, toEye) < 0.5 * radius) continue;
      for (int k = 0; k < 3; ++k) sum += std::abs(int(a.At(x, y)[k]) - int(b.At(x, y)[k])) / 3.0;
      ++count;
    }
  }
  return count == 0 ? 0 : sum / count;
}

}  // namespace

std::vector<StudyCourse> StudyCourses() {
  std::vector<StudyCourse> courses;
  const auto add = [&](const auto& sweep, int frames) {
    for (const auto& point : sweep) courses.push_back({point.course, frames});
  };
  add(kStiffnesses, kFrames);
  add(kDensities, kFrames);
  add(kDampings, kFrames);
  add(kDrapes, kSphereFrames);
  add(kPlanes, kPlaneFrames);
  return courses;
}

int HashStudyFrames() {
  return kHashFrames;
}
int RatioStudyFrames() {
  return 2 * kFrames;
}

std::optional<Table> StudyHash(const std::string& study, const SceneLoader& load, const std::function<bool()>& goOn) {
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
    if (report.divergence) return table;
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
  return table;
}

std::optional<Table> StudyRatio(const SceneLoader& load, const std::function<bool()>& goOn) {
  std::vector<Course> courses;
  for (const char* name : {kRatioA, kRatioB}) {
    auto course = MeasureCourse(load(name), kFrames, {kFrames}, goOn);
    if (!course) return std::nullopt;
    courses.push_back(std::move(*course));
  }
  double farthest = 0;
  const std::vector<Vec3>&a = courses[0].shapes[kFrames][0], &b = courses[1].shapes[kFrames][0];
  for (std::size_t v = 0; v < a.size(); ++v) farthest = std::max(farthest, Length(a[v] - b[v]));
  return Table{{"farthest", "lowest_y_a", "lowest_y_b"},
               {{farthest, Last(courses[0].table, "lowest_y"), Last(courses[1].table, "lowest_y")}}};
}

Table CountSprings(const SceneLoader& load) {
  Table table{{"all", "no_shearing", "only_shearing"}, {{}}};
  for (const char* course : {"pinned2", "pinned2 cloth.enable_shearing=false",
                             "pinned2 cloth.enable_structural=false cloth.enable_bending=false"}) {
    table.rows[0].push_back(double(World(load(course), {.threads = 1}).Cloth(0).springs().size()));
  }
  return table;
}

Result<Table> StudySphere(Painter& painter, const fs::path& heightMap, const Scene& scene, View view, int width,
                          int height) {
  const auto image = ReadPng(heightMap);
  if (!image) return image.diagnostics();
  const HeightMap map(*image);
  const double radius = kDrawnSphereRadius * scene.spheres[0].radius;
  view.cloths = false;
  Diagnostics problems;
  const auto paint = [&](const char* shader, int resolution) {
    view.look.shader = shader;
    view.sphereLatitudes = view.sphereLongitudes = resolution;
    auto picture = painter.Paint(scene, {}, view);
    if (picture) return std::move(*picture);
    problems = picture.diagnostics();
    return MakeImage(width, height);
  };
  const Image finestBump = paint("Bump", kFinest), finestDisplacement = paint("Displacement", kFinest);
  Table table;
  table.columns = {"resolution", "displaced_rms", "displaced_max", "smooth_rms", "bump_change", "displacement_change"};
  for (const int resolution : kResolutions) {
    const SurfaceError displaced = MeasureSurface(resolution, radius, view.look.heightScaling, map);
    const SurfaceError smooth = MeasureSurface(resolution, radius, 0, map);
    table.rows.push_back({double(resolution), displaced.rms, displaced.max, smooth.rms,
                          PictureChange(paint("Bump", resolution), finestBump, scene, view.camera),
                          PictureChange(paint("Displacement", resolution), finestDisplacement, scene, view.camera)});
  }
  if (!problems.empty()) return problems;
  return table;
}

Result<Table> StudyLight(const fs::path& folder) {
  std::vector<Image> images;
  for (const int number : {31, 32, 33, 34}) {
    auto image = ReadPng(folder / FigureFile(number));
    if (!image) return image.diagnostics();
    images.push_back(std::move(*image));
  }
  const Image& whole = images[3];
  const std::uint8_t* const background = whole.At(0, 0);
  const auto isBackground = [&](const std::uint8_t* pixel) { return std::equal(pixel, pixel + 3, background); };
  // Pixels on the outline mix with the background, which each picture adds once.
  const auto isInside = [&](int x, int y) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int i = x + dx, j = y + dy;
        if (i < 0 || j < 0 || i >= whole.width || j >= whole.height) return false;
        for (const Image& image : images) {
          if (isBackground(image.At(i, j))) return false;
        }
      }
    }
    return true;
  };
  std::set<std::array<int, 3>> ambient;
  int difference = 0;
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x) {
      if (!isInside(x, y)) continue;
      std::array<int, 3> color{};
      for (std::size_t k = 0; k < 3; ++k) {
        int sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += images[i].At(x, y)[k];
        difference = std::max(difference, std::abs(std::min(sum, 255) - whole.At(x, y)[k]));
        color[k] = images[0].At(x, y)[k];
      }
      ambient.insert(color);
    }
  }
  return Table{{"difference", "ambient_colors"}, {{double(difference), double(ambient.size())}}};
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

const char* VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::Holds:
      return "holds";
    case Verdict::Partly:
      return "partly";
    case Verdict::Fails:
      break;
  }
  return "does not hold";
}

bool IsComplete(const Measured& measured) {
  std::vector<std::string> names = {kRatioStudy, kSphereStudy, kLightStudy, kSlack,   kSoftest,
                                    kFold,       kFoldLight,   kFoldDense,  kFoldSoft};
  names.insert(names.end(), std::begin(kHashStudies), std::end(kHashStudies));
  for (const StudyCourse& course : StudyCourses()) names.push_back(course.name);
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) { return measured.count(name) != 0; });
}

namespace {

// Parts, as indices into FigureParts().
constexpr int kMasses = 0, kIntegration = 1, kColliders = 2, kSelfCollisions = 3, kShaders = 4;

Verdict Holds(bool holds) {
  return holds ? Verdict::Holds : Verdict::Fails;
}

bool Ascends(const std::vector<double>& values) {
  return std::is_sorted(values.begin(), values.end(), std::less_equal<>());
}

/// A value per point of a sweep.
template <class Sweep, class Value>
std::vector<double> Values(const Sweep& sweep, Value value) {
  std::vector<double> values;
  for (const auto& point : sweep) values.push_back(value(point));
  return values;
}

/// "-0.142 m at 500, -0.083 m at 5000"
template <class Sweep, class Say>
std::string List(const Sweep& sweep, const char* unit, Say say) {
  std::vector<std::string> parts;
  for (const auto& point : sweep) parts.push_back(say(point) + Text(" at %.6g", point.value) + unit);
  return Joined(parts);
}

/// A curve of one column of courses over their time, each a series.
template <class Sweep, class Name>
Plot CoursePlot(const Measured& measured, const Sweep& sweep, Name name, const char* column) {
  Plot plot;
  plot.x.label = "time [s]";
  for (const auto& point : sweep) {
    const Table& course = Find(measured, point.course);
    Series series{name(point), {}, false};
    for (std::size_t i = 0; i < course.rows.size(); ++i)
      series.points.push_back({course.At(i, "time"), course.At(i, column)});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

template <class Sweep, class Value>
Series SweepSeries(const char* name, const Sweep& sweep, Value value) {
  Series series{name, {}, true};
  for (const auto& point : sweep) series.points.push_back({double(point.value), value(point)});
  return series;
}

void JudgeMasses(const Measured& measured, Findings& findings) {
  const Table& springs = Find(measured, kSpringsStudy);
  const double all = springs.At(0, "all"), square = springs.At(0, "no_shearing"), only = springs.At(0, "only_shearing");
  findings.claims.push_back({"springs",
                             kMasses,
                             false,
                             "Springs go only where both ends exist, and their kinds can be told apart.",
                             Text("The sheet of 50 x 50 points has %.0f springs: %.0f without the shearing ones "
                                  "(structural and bending), %.0f "
                                  "shearing springs alone.",
                                  all, square, only),
                             Holds(square + only == all),
                             {{"all", all}, {"no shearing", square}, {"only shearing", only}}});
}

void JudgeIntegration(const Measured& measured, Findings& findings) {
  const auto course = [&](const auto& point) -> const Table& { return Find(measured, point.course); };
  const auto lowest = [&](const auto& point) { return Last(course(point), "lowest_y"); };
  const auto fall = [&](const auto& point) { return FallTime(course(point)).value_or(NAN); };
  const auto folding = [&](const auto& point) { return Last(course(point), "folding"); };
  const auto numbers = [&](const auto& sweep, const char* what, const auto& value) {
    std::vector<std::pair<std::string, double>> list;
    for (const auto& point : sweep) list.push_back({Text("%s at %.6g", what, point.value), value(point)});
    return list;
  };
  // How far fall times lie apart, as a share of the shortest.
  const auto spread = [&](const auto& sweep) {
    const std::vector<double> times = Values(sweep, fall);
    const auto ends = std::minmax_element(times.begin(), times.end());
    return *ends.second / *ends.first - 1;
  };

  findings.claims.push_back(
      {"sag-ks", kIntegration, true, "The stiffer the springs, the less the sheet sags.",
       "Lowest point " + List(kStiffnesses, " N/m", [&](const auto& p) { return Meters(lowest(p)); }) + ".",
       Holds(Ascends(Values(kStiffnesses, lowest))), numbers(kStiffnesses, "lowest_y", lowest)});
  std::vector<double> softToStiff = Values(kStiffnesses, folding);
  std::reverse(softToStiff.begin(), softToStiff.end());
  findings.claims.push_back({"creases-ks", kIntegration, false,
                             "A stiff sheet has few creases; the softer the springs, the more.",
                             "Mean angle between neighbouring squares at rest: " +
                                 List(kStiffnesses, " N/m", [&](const auto& p) { return Text("%.2f°", folding(p)); }) +
                                 ". From the softest to the stiffest it falls; where the limit on stretch holds the "
                                 "sheet, below 5000 N/m, the "
                                 "order is not strict.",
                             !(folding(kStiffnesses[0]) > folding(kStiffnesses[5])) ? Verdict::Fails
                             : Ascends(softToStiff)                                 ? Verdict::Holds
                                                                                    : Verdict::Partly,
                             numbers(kStiffnesses, "folding", folding)});
  findings.claims.push_back(
      {"figure-11",
       kIntegration,
       false,
       "A very high ks leaves the sheet straight; the write-up points to figure 11.",
       Text("That is figure 10, ks 100000 N/m: lowest point %.3f m. Figure 11 has ks 0 by its own caption, and hangs "
            "at %.3f m: the reference in the write-up is a slip.",
            Last(Find(measured, kStiffnesses[5].course), "lowest_y"), Last(Find(measured, kSlack), "lowest_y")),
       Verdict::Partly,
       {{"lowest_y of figure 10", Last(Find(measured, kStiffnesses[5].course), "lowest_y")},
        {"lowest_y of figure 11", Last(Find(measured, kSlack), "lowest_y")}}});
  findings.claims.push_back({"fall-ks", kIntegration, true, "The fall takes almost the same time whatever ks.",
                             "The lowest point passes 0.2 m after " +
                                 List(kStiffnesses, " N/m", [&](const auto& p) { return Text("%.3f s", fall(p)); }) +
                                 Text(": they differ by %.1f %%.", 100 * spread(kStiffnesses)),
                             Holds(spread(kStiffnesses) < 0.05), numbers(kStiffnesses, "fall_time", fall)});
  {
    const auto soft = RestTime(course(kStiffnesses[1])), usual = RestTime(course(kStiffnesses[3])),
               stiff = RestTime(course(kStiffnesses[5]));
    const double length = Last(course(kStiffnesses[1]), "time");
    findings.claims.push_back(
        {"oscillation-ks",
         kIntegration,
         false,
         "A soft sheet goes on oscillating for longer than a stiff one.",
         "At rest after: " +
             List(kStiffnesses, " N/m",
                  [&](const auto& p) {
                    const auto rest = RestTime(course(p));
                    return rest ? Text("%.2f s", *rest) : Text("more than %.1f s", length);
                  }) +
             ". Soft sheets tremble on: the limit on stretch pulls at them in every step.",
         Holds(soft.value_or(INFINITY) > stiff.value_or(INFINITY) || (usual && stiff && *usual > *stiff)),
         {{"rest at 500", soft.value_or(-1)},
          {"rest at 5000", usual.value_or(-1)},
          {"rest at 100000", stiff.value_or(-1)}}});
  }
  findings.claims.push_back({"fall-density", kIntegration, false,
                             "Density makes no difference to how fast the sheet falls.",
                             "The lowest point passes 0.2 m after " +
                                 List(kDensities, " g/cm²", [&](const auto& p) { return Text("%.3f s", fall(p)); }) +
                                 Text(": they differ by %.1f %%.", 100 * spread(kDensities)),
                             Holds(spread(kDensities) < 0.05), numbers(kDensities, "fall_time", fall)});
  findings.claims.push_back(
      {"sag-density", kIntegration, false, "A denser sheet sags deeper.",
       "Lowest point " + List(kDensities, " g/cm²", [&](const auto& p) { return Meters(lowest(p)); }) + ".",
       Holds(lowest(kDensities[0]) > lowest(kDensities[2]) && lowest(kDensities[2]) > lowest(kDensities[5])),
       numbers(kDensities, "lowest_y", lowest)});
  findings.claims.push_back({"folds-density", kIntegration, false,
                             "At 100 g/cm² (figure 16) there are more folds than at 1 g/cm² (figure 13).",
                             Text("Mean angle between neighbouring squares: %.2f° against %.2f°.",
                                  folding(kDensities[3]), folding(kDensities[0])),
                             Holds(folding(kDensities[3]) > folding(kDensities[0])),
                             numbers(kDensities, "folding", folding)});
  {
    const Table& ratio = Find(measured, kRatioStudy);
    const double farthest = ratio.At(0, "farthest");
    findings.claims.push_back({"ratio",
                               kIntegration,
                               true,
                               "Density and ks trade off: an equal ks / density gives an equal shape at rest.",
                               "5000 N/m at 5 g/cm² and 1000 N/m at 1 g/cm²: no point of one is farther than " +
                                   Small(farthest) + " from its place in the other.",
                               Holds(farthest < 1e-6),
                               {{"farthest", farthest}}});
  }
  {
    const Table& undamped = course(kDampings[0]);
    const double move = ResidualMotion(undamped);
    findings.claims.push_back(
        {"damping-0",
         kIntegration,
         true,
         "Without damping the sheet never comes to rest.",
         Text("After %.1f s a point still moves %s in a frame, and %.2f J of kinetic energy are left; with damping 0.2 "
              "the sheet was at rest after %s.",
              Last(undamped, "time"), Small(move).c_str(), Last(undamped, "kinetic_energy"),
              Seconds(RestTime(course(kDampings[1]))).c_str()),
         Holds(!RestTime(undamped) && move > 5e-3),
         {{"move", move}, {"kinetic_energy", Last(undamped, "kinetic_energy")}}});
  }
  {
    const double slow = fall(kDampings[2]) / fall(kDampings[1]);
    findings.claims.push_back({"damping-1",
                               kIntegration,
                               true,
                               "High damping makes the sheet fall much slower.",
                               "The lowest point passes 0.2 m after " +
                                   List(kDampings, " %", [&](const auto& p) { return Text("%.2f s", fall(p)); }) +
                                   Text(": %.1f times as long at 1 %% as at 0.2 %%.", slow),
                               Holds(slow > 2),
                               {{"times slower", slow}}});
    const std::size_t moment = 120;
    findings.claims.push_back(
        {"damping-creases",
         kIntegration,
         false,
         "High damping smooths the sheet (figures 14 and 17).",
         Text("1.33 s after the start the mean angle between neighbouring squares is %.2f° without damping and %.2f° "
              "at 1 %%.",
              course(kDampings[0]).At(moment, "folding"), course(kDampings[2]).At(moment, "folding")),
         Holds(course(kDampings[2]).At(moment, "folding") < course(kDampings[0]).At(moment, "folding")),
         {{"folding at 0", course(kDampings[0]).At(moment, "folding")},
          {"folding at 1", course(kDampings[2]).At(moment, "folding")}}});
    const auto rest = RestTime(course(kDampings[2]));
    const double move = ResidualMotion(course(kDampings[2]));
    findings.claims.push_back(
        {"damping-waves",
         kIntegration,
         false,
         "At high damping small waves run through the sheet without ever stopping.",
         Text("At 1 %% the sheet comes to rest after %s; over the last second no point moves more than %s in a frame.",
              Seconds(rest).c_str(), Small(move).c_str()),
         Holds(!rest && move > 1e-4),
         {{"rest", rest.value_or(-1)}, {"move", move}}});
  }

  const auto sweep = [&](const char* title, const auto& points, const char* x, const char* y, const auto& value) {
    Plot plot{title, {x, true, {}, {}}, {y, false, {}, {}}, {SweepSeries(title, points, value)}};
    findings.plots.push_back({kIntegration, std::move(plot)});
  };
  sweep("Sag against ks (pinned2, 15 g/cm²)", kStiffnesses, "ks [N/m]", "lowest point [m]", lowest);
  sweep("Sag against density (pinned2, 5000 N/m)", kDensities, "density [g/cm²]", "lowest point [m]", lowest);
  sweep("Fall time against ks (pinned2)", kStiffnesses, "ks [N/m]", "time until 0.2 m [s]", fall);
  findings.plots.back().plot.y.min = 0;
  const auto damping = [](const SweepPoint& p) { return Text("damping %.6g %%", p.value); };
  Plot energy = CoursePlot(measured, kDampings, damping, "kinetic_energy");
  energy.title = "Kinetic energy (pinned2)";
  energy.y = {"kinetic energy [J]", true, 1e-8, {}};
  findings.plots.push_back({kIntegration, std::move(energy)});
  Plot height = CoursePlot(measured, kDampings, damping, "lowest_y");
  height.title = "The fall (pinned2)";
  height.y.label = "lowest point [m]";
  findings.plots.push_back({kIntegration, std::move(height)});
}

void JudgeColliders(const Measured& measured, Findings& findings) {
  const auto course = [&](const auto& point) -> const Table& { return Find(measured, point.course); };
  const auto lowest = [&](const auto& point) { return Last(course(point), "lowest_y"); };
  findings.claims.push_back({"sphere-ks",
                             kColliders,
                             true,
                             "On the sphere ks 500 hangs lower than 50000: relaxed against tight.",
                             "Hem at " + List(kDrapes, " N/m", [&](const auto& p) { return Meters(lowest(p)); }) + ".",
                             Holds(Ascends(Values(kDrapes, lowest))),
                             {{"lowest_y at 500", lowest(kDrapes[0])}, {"lowest_y at 50000", lowest(kDrapes[2])}}});
  double moves[3];
  std::vector<std::string> said;
  for (std::size_t i : {0u, 1u, 2u}) {
    moves[i] = ResidualMotion(course(kPlanes[i]));
    said.push_back(Small(moves[i]) + " per frame with \"" + kPlanes[i].name + "\"");
  }
  const bool twoMove = std::min(moves[0], moves[1]) > 1e-4, thirdRests = moves[2] < 1e-4;
  findings.claims.push_back(
      {"plane-rest",
       kColliders,
       false,
       "Of the three ways to put a point back above the plane, the first two keep a resting sheet moving in every "
       "step, and the third does not.",
       "Once down, the point that moves most goes " + Joined(said) + " (mean of the last second).",
       twoMove && thirdRests   ? Verdict::Holds
       : twoMove || thirdRests ? Verdict::Partly
                               : Verdict::Fails,
       {{"interpolate", moves[0]}, {"offset", moves[1]}, {"hold", moves[2]}}});

  findings.plots.push_back({kColliders,
                            {"Hem of the drape against ks (sphere)",
                             {"ks [N/m]", true, {}, {}},
                             {"lowest point [m]", false, {}, {}},
                             {SweepSeries("lowest point", kDrapes, lowest)}}});
  Plot motion = CoursePlot(
      measured, kPlanes, [](const PlaneCourse& p) { return std::string(p.name); }, "move");
  motion.title = "Motion on the plane, by response";
  motion.y = {"farthest way of a point in a frame [m]", true, 1e-8, {}};
  findings.plots.push_back({kColliders, std::move(motion)});
}

void JudgeSelfCollisions(const Measured& measured, Findings& findings) {
  const auto mean = [&](const char* study, const char* column) {
    const std::vector<double> values = Find(measured, study).Column(column);
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / double(std::max<std::size_t>(1, values.size()));
  };
  PartTable table{kSelfCollisions,
                  "The hash functions on the falling sheet (selfCollision): means over frames 10, 20, ... 60",
                  {"function of the box", "pairs compared", "of these false", "close pairs", "of these missed",
                   "time per step", "highest, mean y in frame 30", "in frame 60"},
                  {}};
  const char* const names[] = {"exact: one bucket per box", "linear: 7x + 5y + 3z", "powers: x⁶ + y⁴ + z²",
                               "brute force"};
  double highest[4];
  for (std::size_t i : {0u, 1u, 2u, 3u}) {
    const char* const study = kHashStudies[i];
    const Table& rows = Find(measured, study);
    highest[i] = rows.At(2, "highest_y");
    const auto at = [&](std::size_t row) {
      return Text("%.2f, %.2f m", rows.At(row, "highest_y"), rows.At(row, "mean_y"));
    };
    table.rows.push_back({names[i], Text("%.0f", mean(study, "compared")), Text("%.0f", mean(study, "false")),
                          Text("%.0f", mean(study, "close")), Text("%.0f", mean(study, "missed")),
                          Text("%.3f ms", 1e3 * mean(study, "seconds")), at(2), at(5)});
  }
  table.note =
      "False pairs lie in different boxes but share a bucket: they are compared for nothing. Missed pairs are closer "
      "than "
      "2 · thickness, but their boxes do not meet: the course's method does not look across the borders of boxes, with "
      "any of the functions. Times are of this machine, on one thread.";
  findings.tables.push_back(std::move(table));

  const double apart = std::max(std::abs(highest[1] - highest[0]), std::abs(highest[2] - highest[0]));
  findings.claims.push_back(
      {"hash-realism",
       kSelfCollisions,
       false,
       "The two hash functions give comparably realistic folds.",
       Text("In frame 30 the sheet's top stands at %.3f m (linear) and %.3f m (powers), with exact boxes at %.3f m, "
            "with "
            "brute force at %.3f m. Both let false neighbours in, which costs time and changes little.",
            highest[1], highest[2], highest[0], highest[3]),
       Holds(apart < 0.02),
       {{"linear", highest[1]},
        {"powers", highest[2]},
        {"exact", highest[0]},
        {"brute", highest[3]},
        {"false pairs linear", mean(kHashStudies[1], "false")},
        {"false pairs exact", mean(kHashStudies[0], "false")},
        {"missed pairs linear", mean(kHashStudies[1], "missed")},
        {"missed pairs brute", mean(kHashStudies[3], "missed")}}});
  const double slower = mean(kHashStudies[3], "seconds") / mean(kHashStudies[1], "seconds");
  findings.claims.push_back(
      {"brute-slow",
       kSelfCollisions,
       false,
       "Brute force is painfully slow.",
       Text("%.2f ms per step against %.3f ms with the linear function: %.0f times as long, for 2500 points.",
            1e3 * mean(kHashStudies[3], "seconds"), 1e3 * mean(kHashStudies[1], "seconds"), slower),
       Holds(slower > 5),
       {{"times slower", slower}}});
  const double shared = mean(kHashStudies[2], "false");
  findings.claims.push_back(
      {"powers-unique",
       kSelfCollisions,
       false,
       "Even exponents, which take care of negative positions, make the distribution of x⁶ + y⁴ + z² unique.",
       Text("They cannot: boxes on either side of zero share a bucket, since (−x)⁶ = x⁶. On the falling sheet %.0f of "
            "%.0f pairs compared come from another box; negative indices need no special care in the linear function.",
            shared, mean(kHashStudies[2], "compared")),
       Holds(shared == 0),
       {{"false pairs", shared}}});

  const auto folding = [&](const char* course, std::size_t frame) {
    return Find(measured, course).At(frame, "folding");
  };
  const double light = folding(kFoldLight, 40), usual = folding(kFold, 40), dense = folding(kFoldDense, 40);
  findings.claims.push_back(
      {"waves-density",
       kSelfCollisions,
       false,
       "Denser sheets fold in more complex waves.",
       Text(
           "In frame 40 the mean angle between neighbouring squares is %.1f° at 1 g/cm², %.1f° at 15 and %.1f° at 100.",
           light, usual, dense),
       Holds(dense > light),
       {{"folding at 1", light}, {"folding at 15", usual}, {"folding at 100", dense}}});
  const double soft = folding(kFoldSoft, 20), stiff = folding(kFold, 20);
  findings.claims.push_back({"waves-ks",
                             kSelfCollisions,
                             false,
                             "A higher ks gives less complex waves.",
                             Text("In frame 20: %.1f° at 500 N/m, %.1f° at 5000 N/m.", soft, stiff),
                             Holds(soft > stiff),
                             {{"folding at 500", soft}, {"folding at 5000", stiff}}});
  findings.claims.push_back(
      {"dense-flexes",
       kSelfCollisions,
       false,
       "Denser materials flex less, so ks should fall as the mass grows to model a loss of flexibility.",
       Text("The other way round: at equal ks the denser sheet folds more (figures 27 and 28: %.1f° against %.1f°), "
            "and since only "
            "ks / density matters, lowering ks as well makes it softer still: figure 6 (ks 5 at 5000 g/cm²) hangs at "
            "%.3f m, figure 5 (ks 5000 at 5 g/cm²) at %.3f m.",
            dense, light, Last(Find(measured, kSoftest), "lowest_y"), Last(Find(measured, kRatioA), "lowest_y")),
       Holds(dense < light),
       {{"folding at 1", light}, {"folding at 100", dense}}});
}

void JudgeShaders(const Measured& measured, Findings& findings) {
  const Table& sphere = Find(measured, kSphereStudy);
  const std::size_t coarse = 0, fine = sphere.rows.size() - 1;
  const auto at = [&](std::size_t row, const char* column) { return sphere.At(row, column); };
  const auto gain = [&](const char* column) { return at(coarse, column) / at(fine, column); };
  findings.claims.push_back(
      {"displacement-resolution",
       kShaders,
       true,
       "Displacement mapping gains much from a finer sphere.",
       Text("The drawn surface departs from the exact displaced one by %.1f mm (root mean square) at 16 x 16 and %.1f "
            "mm "
            "at 128 x 128; the picture from that of a sphere too fine to tell by %.1f and %.1f levels of 255.",
            1e3 * at(coarse, "displaced_rms"), 1e3 * at(fine, "displaced_rms"), at(coarse, "displacement_change"),
            at(fine, "displacement_change")),
       Holds(gain("displacement_change") > 3 && at(fine, "displaced_rms") < at(coarse, "displaced_rms")),
       {{"rms at 16", at(coarse, "displaced_rms")},
        {"rms at 128", at(fine, "displaced_rms")},
        {"change at 16", at(coarse, "displacement_change")},
        {"change at 128", at(fine, "displacement_change")}}});
  findings.claims.push_back(
      {"bump-resolution",
       kShaders,
       true,
       "Bump mapping gains nothing from a finer sphere.",
       Text("Away from its outline the picture changes by %.2f levels of 255 at 16 x 16 and %.2f at 128 x 128: nobody "
            "sees "
            "it. Only the outline has corners at 16.",
            at(coarse, "bump_change"), at(fine, "bump_change")),
       Holds(at(coarse, "bump_change") < 2),
       {{"change at 16", at(coarse, "bump_change")}, {"change at 128", at(fine, "bump_change")}}});
  const Table& light = Find(measured, kLightStudy);
  const double difference = light.At(0, "difference"), colors = light.At(0, "ambient_colors");
  findings.claims.push_back(
      {"blinn-phong",
       kShaders,
       false,
       "Ambient light gives every place the same colour, and the three kinds of light simply add up.",
       Text("Figure 31 has %.0f colour%s on the cloth. The sum of figures 31, 32 and 33 differs from figure 34 by at "
            "most "
            "%.0f of 255, which is rounding. The write-up calls all four figure 31 in its text.",
            colors, colors == 1 ? "" : "s", difference),
       Holds(colors == 1 && difference <= 2),
       {{"difference", difference}, {"ambient colours", colors}}});

  const auto series = [&](const char* name, const char* column, double scale) {
    Series line{name, {}, true};
    for (std::size_t i = 0; i < sphere.rows.size(); ++i)
      line.points.push_back({at(i, "resolution"), scale * at(i, column)});
    return line;
  };
  findings.plots.push_back(
      {kShaders,
       {"The drawn surface against the exact one (sphere)",
        {"latitudes and longitudes", true, {}, {}},
        {"distance, root mean square [mm]", true, {}, {}},
        {series("displaced", "displaced_rms", 1e3), series("not displaced (bump)", "smooth_rms", 1e3)}}});
  findings.plots.push_back({kShaders,
                            {"The picture against that of a very fine sphere",
                             {"latitudes and longitudes", true, {}, {}},
                             {"mean difference per pixel, of 255", false, 0.0, {}},
                             {series("Displacement", "displacement_change", 1), series("Bump", "bump_change", 1)}}});
  PartTable table{
      kShaders,
      "What a finer sphere gains",
      {"-a, -o", "displaced surface, rms", "greatest", "smooth surface, rms", "picture, Displacement", "Bump"},
      {}};
  for (std::size_t i = 0; i < sphere.rows.size(); ++i) {
    table.rows.push_back({Text("%.0f", at(i, "resolution")), Text("%.2f mm", 1e3 * at(i, "displaced_rms")),
                          Text("%.1f mm", 1e3 * at(i, "displaced_max")), Text("%.3f mm", 1e3 * at(i, "smooth_rms")),
                          Text("%.2f of 255", at(i, "displacement_change")),
                          Text("%.2f of 255", at(i, "bump_change"))});
  }
  findings.tables.push_back(std::move(table));
}

}  // namespace

Findings Judge(const Measured& measured) {
  Findings findings;
  JudgeMasses(measured, findings);
  JudgeIntegration(measured, findings);
  JudgeColliders(measured, findings);
  JudgeSelfCollisions(measured, findings);
  JudgeShaders(measured, findings);
  return findings;
}

}  // namespace percale::cli
