#pragma once
/// \file
/// The cases of `percale verify`: each sets up a cloth, runs it and measures what a closed form foretells.

#include <span>
#include <string>
#include <vector>

#include "apps/cli/figure_plot.h"

namespace percale::cli {

/// How finely a case is computed, against what its numbers are stated for.
struct Effort {
  double mesh = 1;  ///< Times as many elements along an edge, > 0.
  double step = 1;  ///< Times as many steps per second, > 0. Cases of statics do not heed it.
};

/// A number that was measured, and the bounds within which it is right. NaN is right nowhere.
struct Reading {
  std::string what;  ///< With the unit: "H/W at Γ = 10".
  double measured = 0;
  double expected = 0;
  double error = 0;
  bool share = false;  ///< The error is relative.
  double low = 0, high = 0;
  std::string gate;  ///< For people: "2 %".

  bool Holds() const { return measured >= low && measured <= high; }
};

/// Within `share` of what is expected.
Reading Relative(std::string what, double measured, double expected, double share);
/// At most `most` away from what is expected.
Reading Absolute(std::string what, double measured, double expected, double most);
/// What is expected is no more than one value in a range.
Reading Between(std::string what, double measured, double expected, double low, double high);

struct CaseResult {
  std::vector<Reading> readings;
  std::vector<Plot> plots;
  std::string note;  ///< What a reader of the numbers should know; may be empty.

  bool Holds() const;
};

struct VerifyCase {
  const char* name;     ///< As after --only: "cantilever".
  const char* subject;  ///< "Bending", "Membrane", "Time", "Contact", "Drape".
  const char* title;
  const char* law;     ///< What is expected, as a formula.
  const char* source;  ///< Where that is from.
  CaseResult (*run)(const Effort&);
  bool mesh = false;  ///< Finer meshes come closer to what is expected.
  bool step = false;  ///< So do shorter steps.
};

/// All, subject by subject. The one list of them.
std::span<const VerifyCase> VerifyCases();

// Bending
CaseResult VerifyCantilever(const Effort& effort);
CaseResult VerifyChordAngle(const Effort& effort);
CaseResult VerifyLateralBuckling(const Effort& effort);
CaseResult VerifySelfBuckling(const Effort& effort);
CaseResult VerifyColumns(const Effort& effort);
CaseResult VerifyFrequency(const Effort& effort);
// Membrane
CaseResult VerifyHangingSheet(const Effort& effort);
CaseResult VerifyCatenary(const Effort& effort);
CaseResult VerifyPatch(const Effort& effort);
CaseResult VerifyOrthotropy(const Effort& effort);
CaseResult VerifyBalloon(const Effort& effort);
// Time
CaseResult VerifyFreeMotion(const Effort& effort);
CaseResult VerifyMomentum(const Effort& effort);
CaseResult VerifyPendulum(const Effort& effort);
CaseResult VerifyDecay(const Effort& effort);
CaseResult VerifyOrder(const Effort& effort);
// Contact
CaseResult VerifyIncline(const Effort& effort);
CaseResult VerifyCapstan(const Effort& effort);
CaseResult VerifyStickSlip(const Effort& effort);
CaseResult VerifyPinch(const Effort& effort);
CaseResult VerifyImpact(const Effort& effort);
// Drape
CaseResult VerifyDrape(const Effort& effort);

}  // namespace percale::cli
