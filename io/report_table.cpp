#include "io/report_table.h"

#include "core/text.h"

namespace percale {

std::string ReportTableHeader() {
  std::string line =
      "frame,time_s,kinetic_energy_J,potential_energy_J,elastic_energy_J,greatest_stretch,stretch_p99,"
      "greatest_move_m,self_contacts,collider_contacts,limited_springs,"
      "newton_iterations,linear_iterations,residual,converged,"
      "intersections,squeezed,lost_motion,splits";
  for (int stage = 0; stage < kStageCount; ++stage) line += "," + std::string(StageName(Stage(stage))) + "_s";
  return line + "\n";
}

std::string ReportTableRow(const StepReport& report, std::optional<double> stretch99) {
  std::string line = std::to_string(report.frame);
  const auto add = [&](double number) { line += "," + FormatNumber(number); };
  for (const double number :
       {report.time, report.kineticEnergy, report.potentialEnergy, report.elasticEnergy, report.greatestStretch})
    add(number);
  line += "," + (stretch99 ? FormatNumber(*stretch99) : std::string());
  add(report.greatestMove);
  for (const std::int64_t count : {report.selfContacts, report.colliderContacts, report.limitedSprings})
    line += "," + std::to_string(count);
  line += "," + std::to_string(report.newtonIterations) + "," + std::to_string(report.linearIterations);
  add(report.residual);
  line += report.converged ? ",1" : ",0";
  line += "," + std::to_string(report.intersections) + "," + std::to_string(report.squeezed);
  add(report.lostMotion);
  line += "," + std::to_string(report.splits);
  for (const double seconds : report.stageSeconds) add(seconds);
  return line + "\n";
}

}  // namespace percale
