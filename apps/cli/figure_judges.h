#pragma once
/// \file
/// The judges of the write-up's parts, each in a file of its own, and what they share.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/figure_claims.h"

namespace percale::cli {

// Parts, as indices into FigureParts().
inline constexpr int kMasses = 0, kIntegration = 1, kColliders = 2, kSelfCollisions = 3, kShaders = 4;

// Each adds what it finds. The measurements must be complete.
void JudgeMasses(const Measured& measured, Findings& findings);
void JudgeIntegration(const Measured& measured, Findings& findings);
void JudgeColliders(const Measured& measured, Findings& findings);
void JudgeSelfCollisions(const Measured& measured, Findings& findings);
void JudgeShaders(const Measured& measured, Findings& findings);

Verdict Holds(bool holds);
/// Whether each value is greater than the one before.
bool Ascends(const std::vector<double>& values);

// Numbers as people say them.
std::string Meters(double value);                           ///< "0.736 m"
std::string Small(double meters);                           ///< "0.12 mm", "3.4 µm"
std::string Seconds(const std::optional<double>& seconds);  ///< "5.60 s", "not at all"
std::string Joined(const std::vector<std::string>& parts);  ///< "A, B and C"

/// A number that is read off each course of a sweep.
using PointValue = std::function<double(const SweepPoint&)>;
PointValue LastOf(const Measured& measured, const char* column);  ///< In the last frame.
PointValue FallTimeOf(const Measured& measured);                  ///< [s]; NaN where it did not fall.

std::vector<double> Values(std::span<const SweepPoint> sweep, const PointValue& value);
/// The same with names, for figures.json: "lowest_y at 500".
std::vector<std::pair<std::string, double>> NamedValues(std::span<const SweepPoint> sweep, const char* what,
                                                        const PointValue& value);
/// In words: "-0.142 m at 500 N/m and -0.083 m at 5000 N/m". `say` gives the words for a point, `unit` is that
/// of the sweep.
std::string List(std::span<const SweepPoint> sweep, const char* unit,
                 const std::function<std::string(const SweepPoint&)>& say);

/// A curve with a mark for each course of a sweep.
Series SweepSeries(const char* name, std::span<const SweepPoint> sweep, const PointValue& value);
/// Courses over their time, a curve each. Title and y axis are left to the caller.
Plot CoursePlot(const Measured& measured, std::span<const NamedCourse> courses, const char* column);

}  // namespace percale::cli
