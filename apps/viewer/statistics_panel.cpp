#include <imgui.h>

#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"
#include "core/text.h"

namespace percale::viewer {

void DrawStatisticsPanel(Session& session, UiState& state) {
  const Snapshot& snapshot = session.snapshot();
  const StepReport& report = snapshot.report;
  std::size_t points = 0, springs = 0;
  for (const ClothCopy& cloth : snapshot.cloths) {
    points += cloth.positions.size();
    springs += cloth.topology->springs.size();
  }
  FactRow(state, "Frame", Text("%d   (%.2f s)", report.frame, report.time));
  FactRow(state, "Cloth", Text("%zu points, %zu springs", points, springs));
  if (report.frame > 0) {
    FactRow(state, "Greatest stretch", Text("%.4f", report.greatestStretch));
    FactRow(state, "Kinetic energy", Text("%.4g J", report.kineticEnergy));
    FactRow(state, "At rest", report.atRest ? "yes" : Text("no, moves %.3g mm per frame", report.greatestMove * 1000));
    if (report.newtonIterations > 0 || !report.converged) {
      FactRow(state, "Solver",
              Text("%s, residual %.1e; %d Newton, %d linear", report.converged ? "converged" : "stopped",
                   report.residual, report.newtonIterations, report.linearIterations));
    }
    FactRow(state, "Contacts",
            Text("%lld cloth, %lld colliders", static_cast<long long>(report.selfContacts),
                 static_cast<long long>(report.colliderContacts)));
  }
  const auto number = [](std::int64_t count) { return static_cast<long long>(count); };
  if (report.intersections > 0) FactRow(state, "Tangled yet", Text("%lld pairs", number(report.intersections)));
  if (report.squeezed > 0) FactRow(state, "Squeezed", Text("%lld vertices", number(report.squeezed)));
  if (report.lostMotion > 0) FactRow(state, "Cut short", Text("%.2g %% of all motion", report.lostMotion * 100));
  if (report.contactBytes > 0)
    FactRow(state, "Contact memory", Text("%.1f MB", static_cast<double>(report.contactBytes) * 1e-6));
  FactRow(state, "Drawing", Text("%.1f ms", state.drawSeconds * 1000));
  if (snapshot.framesPerSecond > 0) FactRow(state, "Speed", Text("%.0f frames/s", snapshot.framesPerSecond));
  const bool open = ImGui::TreeNode("##stages", "A frame of simulation: %.2f ms", state.frameSeconds * 1000);
  Control(session, state, "statistics stages", "Where the time of a frame goes, stage by stage.");
  if (!open) return;
  for (int stage = 0; stage < kStageCount; ++stage) {
    const std::string name(StageName(static_cast<Stage>(stage)));
    FactRow(state, name.c_str(), Text("%6.3f ms", state.stageSeconds[static_cast<std::size_t>(stage)] * 1000));
  }
  ImGui::TreePop();
}

}  // namespace percale::viewer
