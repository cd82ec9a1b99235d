#include "apps/cli/figure_claims.h"

#include <algorithm>

#include "apps/cli/figure_judges.h"
#include "apps/cli/figure_studies.h"

namespace percale::cli {

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
  std::vector<StudyCourse> needed = StudyCourses();
  for (const char* name : {kRatioStudy, kSphereStudy, kLightStudy, kSlack, kSoftest, kFold, kFoldLight, kFoldDense,
                           kFoldSoft})  // the courses reach as far as their figures
    needed.push_back({name, 0});
  for (const char* name : kHashStudies) needed.push_back({name, 0});
  return std::all_of(needed.begin(), needed.end(), [&](const StudyCourse& each) {
    const auto found = measured.find(each.name);
    return found != measured.end() && int(found->second.rows.size()) > each.frames;
  });
}

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
