#pragma once
/// \file
/// The page that shows the figures: one HTML file that holds everything, and the same numbers as JSON.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/figure_claims.h"
#include "apps/cli/figure_table.h"

namespace percale::cli {

/// A figure that was made.
struct ShownFigure {
  const Figure* figure = nullptr;
  std::string shader;
  std::string command;                                          ///< As typed into a shell.
  std::vector<std::pair<std::string, std::string>> parameters;  ///< That differ from the scene's: name, value and unit.
  double framesPerSecond = 90;
  Table course;     ///< Up to its frame.
  std::string png;  ///< The picture, a whole file.
};

struct FigurePage {
  std::string version;
  int width = 0, height = 0;         ///< Of the pictures [pixel].
  std::vector<ShownFigure> figures;  ///< By number.
  std::optional<Findings> findings;  ///< None: not all figures and studies are there.
};

/// The page as HTML that needs no other file: style, pictures and plots are in it.
std::string FormatPage(const FigurePage& page);

/// Figures, claims and tables as JSON, for programs.
std::string FormatPageData(const FigurePage& page);

}  // namespace percale::cli
