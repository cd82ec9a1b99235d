#pragma once
/// \file
/// What the write-up says in words and no single course shows, measured.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "apps/cli/measurements.h"
#include "render/picture.h"

namespace percale::cli {

// Names of the studies that are no courses.
inline constexpr const char* kHashStudies[] = {"hash exact", "hash linear", "hash powers", "hash brute"};
inline constexpr const char* kRatioStudy = "equal ratio";
inline constexpr const char* kSphereStudy = "sphere resolution";
inline constexpr const char* kLightStudy = "blinn-phong";
inline constexpr const char* kSpringsStudy = "springs";

/// How a scene is loaded from a course's name.
using SceneLoader = std::function<Scene(const std::string& course)>;

// Both are nothing once `goOn` says no, and have no rows where the simulation diverges.

/// One hash function at work on the falling sheet: every 10 frames, `frame`, `compared`, `false`,
/// `close` and `missed` pairs, `seconds` per step of self-collision, `highest_y` and `mean_y` [m].
/// `study` is one of kHashStudies.
std::optional<Course> StudyHash(const std::string& study, const SceneLoader& load, const std::function<bool()>& goOn);

/// Two sheets with equal ks / density: `farthest`, the most that a point of one rests from that of the other,
/// and `lowest_y_a` and `lowest_y_b` [m].
std::optional<Course> StudyRatio(const SceneLoader& load, const std::function<bool()>& goOn);

/// How many springs figures 1, 2 and 3 show: `all`, `no_shearing`, `only_shearing`.
Table CountSprings(const SceneLoader& load);

/// Frames that the above run: a measure of their time.
int HashStudyFrames();
int RatioStudyFrames();

/// What finer spheres gain, for 16, 32, 64 and 128 latitudes and longitudes: `displaced_rms`,
/// `displaced_max` and `smooth_rms`, the distances of the drawn from the exact surface [m];
/// `bump_change` and `displacement_change`, the mean difference per pixel of the picture from one of
/// a sphere too fine to tell, of 255. The camera is that of `view`.
Result<Table> StudySphere(Painter& painter, const std::filesystem::path& heightMap, const Scene& scene,
                          percale::View view, int width, int height);

/// What figures 31 to 34 add up to: `difference`, the greatest per channel between the sum of the
/// first three and the fourth on the cloth, of 255; `ambient_colors`, how many colours the first one shows.
Result<Table> StudyLight(const std::filesystem::path& folder);

}  // namespace percale::cli
