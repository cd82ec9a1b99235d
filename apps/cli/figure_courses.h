#pragma once
/// \file
/// The courses of simulations that the write-up compares, and what is read off a course.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/measurements.h"

namespace percale::cli {

/// All that was measured: courses by their name ("pinned2 cloth.ks=500"), studies by theirs.
using Measured = std::map<std::string, Table>;

/// One course of several that differ in one number.
struct SweepPoint {
  double value;
  const char* course;
};
inline constexpr SweepPoint kStiffnesses[] = {
    // N/m
    {100, "pinned2 cloth.ks=100"},     {500, "pinned2 cloth.ks=500"},
    {1000, "pinned2 cloth.ks=1000"},   {5000, "pinned2"},
    {20000, "pinned2 cloth.ks=20000"}, {100000, "pinned2 cloth.ks=100000"},
};
inline constexpr SweepPoint kDensities[] = {
    // g/cm^2
    {1, "pinned2 cloth.density=10"},
    {5, "pinned2 cloth.ks=5000 cloth.density=50"},
    {15, "pinned2"},
    {100, "pinned2 cloth.density=1000"},
    {5000, "pinned2 cloth.ks=5000 cloth.density=50000"},
    {50000, "pinned2 cloth.density=500000"},
};
inline constexpr SweepPoint kDampings[] = {
    // % per step
    {0, "pinned2 cloth.damping=0"},
    {0.2, "pinned2"},
    {1, "pinned2 cloth.damping=1"},
};
inline constexpr SweepPoint kDrapes[] = {
    // N/m
    {500, "sphere cloth.ks=500"},
    {5000, "sphere"},
    {50000, "sphere cloth.ks=50000"},
};

/// One course of several that differ in what has a name.
struct NamedCourse {
  const char* name;
  const char* course;
};
inline constexpr NamedCourse kPlanes[] = {
    {"interpolate", "plane simulation.plane_response=interpolate"},
    {"offset", "plane simulation.plane_response=offset"},
    {"hold", "plane simulation.plane_response=hold"},
};

inline constexpr const char* kSlack = "pinned2 cloth.ks=0";
inline constexpr const char* kSoftest = "pinned2 cloth.ks=5 cloth.density=50000";
inline constexpr const char* kFold = "selfCollision simulation.plane_response=hold";
inline constexpr const char* kFoldLight = "selfCollision simulation.plane_response=hold cloth.density=10";
inline constexpr const char* kFoldDense = "selfCollision simulation.plane_response=hold cloth.density=1000";
inline constexpr const char* kFoldSoft = "selfCollision simulation.plane_response=hold cloth.ks=500";

// An equal ks / density.
inline constexpr const char* kRatioA = "pinned2 cloth.ks=5000 cloth.density=50";
inline constexpr const char* kRatioB = "pinned2 cloth.ks=1000 cloth.density=10";

// Frames after which what comes to rest has done so.
inline constexpr int kHangingFrames = 800;
inline constexpr int kDrapeFrames = 400;
inline constexpr int kPlaneFrames = 300;

/// A course that the studies read, beyond those of the figures.
struct StudyCourse {
  std::string name;
  int frames;
};
std::vector<StudyCourse> StudyCourses();

/// The value in the last row.
double Last(const Table& table, const char* column);
/// When the lowest point fell below 0.2 m [s]; nothing if it did not.
std::optional<double> FallTime(const Table& course);
/// When the course came to rest [s]; nothing if it did not.
std::optional<double> RestTime(const Table& course);
/// How far a point moves in a frame, at most: the mean over the last second [m].
double ResidualMotion(const Table& course);

}  // namespace percale::cli
