#pragma once
/// \file
/// What the write-up says in words, measured: the runs and tables that it takes, its plots, and a
/// verdict on each claim.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/figure_plot.h"
#include "apps/cli/measurements.h"
#include "render/picture.h"

namespace percale::cli {

/// All that was measured: courses by their name ("pinned2 cloth.ks=500"), studies by theirs.
using Measured = std::map<std::string, Table>;

/// A course that the studies read, beyond those of the figures.
struct StudyCourse {
  std::string name;
  int frames;
};
std::vector<StudyCourse> StudyCourses();

// Names of the studies that are no courses.
inline constexpr const char* kHashStudies[] = {"hash exact", "hash linear", "hash powers", "hash brute"};
inline constexpr const char* kRatioStudy = "equal ratio";
inline constexpr const char* kSphereStudy = "sphere resolution";
inline constexpr const char* kLightStudy = "blinn-phong";
inline constexpr const char* kSpringsStudy = "springs";

/// How a scene is loaded from a course's name.
using SceneLoader = std::function<Scene(const std::string& course)>;

/// One hash function at work on the falling sheet: every 10 frames, `frame`, `compared`, `false`,
/// `close` and `missed` pairs, `seconds` per step of self-collision, `highest_y` and `mean_y` [m].
/// `study` is one of kHashStudies. Nothing once `goOn` says no.
std::optional<Table> StudyHash(const std::string& study, const SceneLoader& load, const std::function<bool()>& goOn);

/// Two sheets with equal ks / density: the farthest that a point of one rests from that of the other.
std::optional<Table> StudyRatio(const SceneLoader& load, const std::function<bool()>& goOn);

/// How many springs figures 1, 2 and 3 show: `all`, `no_shearing`, `only_shearing`.
Table CountSprings(const SceneLoader& load);

/// Frames that the above run: a measure of their time.
int HashStudyFrames();
int RatioStudyFrames();

/// What finer spheres gain, for 16, 32, 64 and 128 latitudes and longitudes: `displaced_rms`,
/// `displaced_max` and `smooth_rms`, the distances of the drawn from the exact surface [m];
/// `bump_change` and `displacement_change`, the mean difference per pixel of the picture from one of
/// a sphere too fine to tell, of 255. The camera is that of `view`.
Result<Table> StudySphere(Painter& painter, const std::filesystem::path& heightMap, const Scene& scene, View view,
                          int width, int height);

/// What figures 31 to 34 add up to: `difference`, the greatest per channel between the sum of the
/// first three and the fourth on the cloth, of 255; `ambient_colors`, how many colours the first one shows.
Result<Table> StudyLight(const std::filesystem::path& folder);

enum class Verdict { Holds, Partly, Fails };
const char* VerdictName(Verdict verdict);

/// A sentence of the write-up in our words, and what we measured.
struct Claim {
  std::string id;
  int part = 0;         ///< Index into FigureParts().
  bool stated = false;  ///< Whether it is among those that Percale's contract names.
  std::string statement, measurement;
  Verdict verdict = Verdict::Holds;
  std::vector<std::pair<std::string, double>> numbers;
};

/// A plot and where it stands.
struct PartPlot {
  int part = 0;
  Plot plot;
};

/// Numbers side by side.
struct PartTable {
  int part = 0;
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::string note = {};  ///< Below it; may be empty.
};

struct Findings {
  std::vector<Claim> claims;
  std::vector<PartPlot> plots;
  std::vector<PartTable> tables;
};

/// Whether all is there that `Judge` needs.
bool IsComplete(const Measured& measured);
Findings Judge(const Measured& measured);

// What the page tells of a course.
/// When the lowest point fell below 0.2 m [s]; nothing if it did not.
std::optional<double> FallTime(const Table& course);
/// When the course came to rest [s]; nothing if it did not.
std::optional<double> RestTime(const Table& course);
/// How far a point moves in a frame, at most: the mean over the last second [m].
double ResidualMotion(const Table& course);

}  // namespace percale::cli
