#pragma once
/// \file
/// What `percale verify` tells: a table for the terminal, one HTML page, and the same as JSON.

#include <string>
#include <vector>

#include "apps/cli/verify_cases.h"

namespace percale::cli {

/// A case with finer and coarser meshes, or longer and shorter steps, by the factor of Effort.
struct Refinement {
  std::string axis;  ///< "elements along an edge", "steps per second", both relative.
  std::vector<double> factors;
  std::vector<CaseResult> results;  ///< One per factor.
};

struct FinishedCase {
  const VerifyCase* of = nullptr;
  CaseResult result;
  std::vector<Refinement> refinements;
};

struct VerifyReport {
  std::string version;
  std::vector<FinishedCase> cases;

  int Readings() const;
  int Holding() const;
};

/// In columns, subject by subject.
std::string FormatTable(const VerifyReport& report);
/// A page that needs no other file.
std::string FormatPage(const VerifyReport& report);
std::string FormatJson(const VerifyReport& report);

}  // namespace percale::cli
