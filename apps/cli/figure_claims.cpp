#include "apps/cli/figure_claims.h"

#include <algorithm>
#include <iterator>

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
  std::vector<std::string> names = {kRatioStudy, kSphereStudy, kLightStudy, kSlack,   kSoftest,
                                    kFold,       kFoldLight,   kFoldDense,  kFoldSoft};
  names.insert(names.end(), std::begin(kHashStudies), std::end(kHashStudies));
  for (const StudyCourse& course : StudyCourses()) names.push_back(course.name);
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) { return measured.count(name) != 0; });
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
