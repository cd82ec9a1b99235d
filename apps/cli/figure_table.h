#pragma once
/// \file
/// The 49 figures of the course's write-up as data: each is what `percale shot` is told.

#include <span>
#include <string>
#include <vector>

namespace percale::cli {

/// A simulation by its name: the scene and what is set in it, "pinned2 cloth.ks=500".
std::string CourseName(const std::string& scene, const std::string& set);

struct Figure {
  int number;           ///< 1..kFigureCount.
  const char* scene;    ///< Of the file scene/NAME.json.
  const char* set;      ///< Assignments to its parameters, PATH=VALUE with spaces between.
  int frame;            ///< Which frame is shown.
  const char* look;     ///< Options of `percale shot`: shader, sphere resolution, ...
  const char* camera;   ///< Options of `percale shot`: camera and target.
  const char* caption;  ///< Plain text.

  /// The simulation that it shows; figures with the same share it.
  std::string course() const { return CourseName(scene, set); }
};

inline constexpr int kFigureCount = 49;

/// All figures, by number.
std::span<const Figure> AllFigures();

/// A part of the write-up.
struct FigurePart {
  const char* title;
  const char* question;  ///< What the course asks there, in our words.
  int first, last;       ///< Figures.
};
std::span<const FigurePart> FigureParts();

/// "figure_07.png"
std::string FigureFile(int number);

/// The command-line arguments that say the same: scene/pinned2.json --set cloth.ks=500.
std::vector<std::string> CourseArguments(const std::string& name);
/// All arguments of `percale shot` but for the size and the file.
std::vector<std::string> ShotArguments(const Figure& figure);

}  // namespace percale::cli
