#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/frame_table.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/plot_widget.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"
#include "world/measure.h"

namespace percale::viewer {
namespace {

constexpr float kPlotsWidth = 430, kPlotsHeight = 620, kMargin = 10;  // [screen unit at scale 1]
constexpr float kSmallestPlot = 70;
constexpr int kPlots = 4;

// Of Okabe and Ito, lighter where they would be lost on a dark ground.
constexpr Rgb kOrange{0.902f, 0.624f, 0}, kSky{0.337f, 0.706f, 0.914f}, kGreen{0, 0.72f, 0.53f},
    kYellow{0.941f, 0.894f, 0.259f}, kBlue{0.22f, 0.55f, 0.85f}, kVermilion{0.90f, 0.42f, 0.10f},
    kPurple{0.8f, 0.475f, 0.655f}, kGrey{0.65f, 0.65f, 0.65f}, kRed{0.78f, 0.24f, 0.24f};
constexpr Rgb kStageColors[kStageCount] = {kGrey, kPurple, kOrange, kRed, kSky, kGreen, kVermilion, kYellow, kBlue};

/// Measures what only the plots need, of the newest frame.
void MeasureNewest(Session& session, std::vector<double>& ratios) {
  const std::span<const FrameRow> rows = session.frames().rows();
  const Snapshot& snapshot = session.snapshot();
  if (rows.empty() || rows.back().stretch99 || rows.back().report.frame != snapshot.report.frame) return;
  ratios.clear();
  for (const ClothCopy& cloth : snapshot.cloths)
    AppendStretch(cloth.positions, cloth.topology->springs, cloth.topology->restLengths, ratios);
  if (!ratios.empty()) session.frames().SetStretch99(snapshot.report.frame, Percentile(ratios, 0.99));
}

template <class Value>
PlotCurve Curve(std::string label, const Rgb& color, std::span<const FrameRow> rows, Value&& value) {
  PlotCurve curve{std::move(label), color, {}};
  curve.y.reserve(rows.size());
  for (const FrameRow& row : rows) curve.y.push_back(value(row));
  return curve;
}

std::vector<Plot> MakePlots(std::span<const FrameRow> rows, double potentialAtStart) {
  std::vector<Plot> plots;
  plots.push_back({"Energy", "J", false, {}});
  plots.back().curves = {
      Curve("kinetic", kOrange, rows, [](const FrameRow& row) { return row.report.kineticEnergy; }),
      Curve("gravity, from the start", kSky, rows,
            [&](const FrameRow& row) { return row.report.potentialEnergy - potentialAtStart; }),
      Curve("springs", kGreen, rows, [](const FrameRow& row) { return row.report.elasticEnergy; }),
  };
  plots.push_back({"Stretch", "", false, {}});
  plots.back().curves = {
      Curve("greatest", kVermilion, rows, [](const FrameRow& row) { return row.report.greatestStretch; }),
      Curve("99th percentile", kYellow, rows,
            [](const FrameRow& row) { return row.stretch99.value_or(std::numeric_limits<double>::quiet_NaN()); }),
  };
  plots.push_back({"Greatest move per frame", "mm", false, {}});
  plots.back().curves = {
      Curve("all points", kPurple, rows, [](const FrameRow& row) { return row.report.greatestMove * 1000; })};
  plots.push_back({"Time of a frame", "ms", true, {}});
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    plots.back().curves.push_back(
        Curve(std::string(StageName(static_cast<Stage>(stage))), kStageColors[stage], rows,
              [stage](const FrameRow& row) { return row.report.stageSeconds[stage] * 1000; }));
  }
  return plots;
}

}  // namespace

void DrawPlotsWindow(Session& session, UiState& state, float pictureWidth, float height) {
  if (!state.plotsVisible) return;
  MeasureNewest(session, state.plotRatios);
  const float margin = kMargin * state.scale;
  ImGui::SetNextWindowSize({std::min(kPlotsWidth * state.scale, pictureWidth - 2 * margin),
                            std::min(kPlotsHeight * state.scale, height - 8 * margin)},
                           ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowPos({margin, height - margin}, ImGuiCond_FirstUseEver, {0, 1});
  const bool shown = ImGui::Begin("Plots", &state.plotsVisible, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav);
  if (shown) {
    NoteWindow(session, state, "plots");
    bool held = state.plotsHeld.has_value();
    if (ImGui::Checkbox("Hold", &held)) HoldPlots(session, state, held);
    NoteBox(session, state, "plots hold");
    ImGui::SameLine();
    if (ImGui::Button("Export CSV")) session.ExportPlots(ShownFrames(session, state));
    NoteBox(session, state, "plots export");
    const std::span<const FrameRow> rows = ShownFrames(session, state);
    ImGui::SameLine();
    if (rows.empty()) {
      ImGui::TextDisabled("nothing yet: P runs the simulation");
    } else {
      ImGui::TextDisabled("frames %d to %d", rows.front().report.frame, rows.back().report.frame);
      std::vector<double> time;
      for (const FrameRow& row : rows) time.push_back(row.report.time);
      const std::vector<Plot> plots = MakePlots(rows, session.frames().potentialAtStart());
      const float labels = (kPlots + 1) * ImGui::GetTextLineHeightWithSpacing();  // one takes two lines
      const float room = (ImGui::GetContentRegionAvail().y - labels) / kPlots - ImGui::GetStyle().ItemSpacing.y;
      for (const Plot& plot : plots)
        DrawPlot(plot, time, "s", std::max(room, kSmallestPlot * state.scale), state.scale, state.plotCursor);
      if (!ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows)) state.plotCursor.reset();
    }
  }
  ImGui::End();
}

std::span<const FrameRow> ShownFrames(Session& session, const UiState& state) {
  return state.plotsHeld ? std::span<const FrameRow>(*state.plotsHeld) : session.frames().rows();
}

void HoldPlots(Session& session, UiState& state, bool hold) {
  const std::span<const FrameRow> rows = session.frames().rows();
  if (hold)
    state.plotsHeld.emplace(rows.begin(), rows.end());
  else
    state.plotsHeld.reset();
  session.log().Write(LogLine("plots").Flag("visible", state.plotsVisible).Flag("held", hold));
}

}  // namespace percale::viewer
