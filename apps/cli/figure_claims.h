#pragma once
/// \file
/// A verdict on each claim of the write-up, from what was measured, with plots and tables.

#include <string>
#include <utility>
#include <vector>

#include "apps/cli/figure_courses.h"
#include "apps/cli/figure_plot.h"

namespace percale::cli {

enum class Verdict { Holds, Partly, Fails };
const char* VerdictName(Verdict verdict);  ///< "holds", "partly", "does not hold"

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

/// Whether all is there that `Judge` needs, beside the figures.
bool IsComplete(const Measured& measured);
/// What the measurements, which are complete, say of the write-up.
Findings Judge(const Measured& measured);

}  // namespace percale::cli
