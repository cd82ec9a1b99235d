#include "apps/viewer/plot_widget.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "render/ticks.h"

namespace percale::viewer {
namespace {

// Around the curves [screen unit at scale 1].
constexpr float kLeft = 52, kRight = 8, kGap = 4;
constexpr float kTickDistance = 26, kWideTickDistance = 70;
constexpr ImU32 kGridColor = IM_COL32(255, 255, 255, 28), kFrameColor = IM_COL32(255, 255, 255, 90),
                kBackColor = IM_COL32(0, 0, 0, 90), kCursorColor = IM_COL32(255, 255, 255, 150);

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

ImU32 ColorOf(const Rgb& color) {
  return ImGui::GetColorU32({color[0], color[1], color[2], 1});
}

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Of all curves, opened to whole steps between ticks so that it holds still while values move a little.
Range RangeOf(const Plot& plot, std::size_t count, int ticks, double& step) {
  Range range;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (const PlotCurve& curve : plot.curves) {
      if (!plot.stacked) range.Add(curve.y[i]);
      sum += curve.y[i];
    }
    if (plot.stacked) range.Add(sum);
  }
  if (plot.stacked) range.low = 0;
  if (!(range.low <= range.high)) range = {0, 1};
  if (range.high - range.low < 1e-9 * std::max(std::abs(range.high), 1e-6)) {
    const double around = std::max(std::abs(range.high) * 0.1, 1e-6);
    range = {plot.stacked ? 0 : range.low - around, range.high + around};
  }
  step = RoundUp((range.high - range.low) / ticks);
  range.low = std::floor(range.low / step + 1e-9) * step;
  range.high = std::ceil(range.high / step - 1e-9) * step;
  return range;
}

/// The labels in their colours, as many to a line as fit.
void DrawLabels(const Plot& plot) {
  const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
  const std::string title = plot.title + (plot.unit.empty() ? "" : " (" + plot.unit + ")");
  ImGui::TextUnformatted(title.c_str());
  for (const PlotCurve& curve : plot.curves) {
    ImGui::SameLine();
    if (ImGui::GetCursorPosX() + ImGui::CalcTextSize(curve.label.c_str()).x > right) ImGui::NewLine();
    ImGui::TextColored({curve.color[0], curve.color[1], curve.color[2], 1}, "%s", curve.label.c_str());
  }
}

}  // namespace

void DrawPlot(const Plot& plot, std::span<const double> x, const std::string& xUnit, float height, float scale,
              std::optional<double>& cursor) {
  DrawLabels(plot);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float lineHeight = ImGui::GetTextLineHeight();
  const ImVec2 min{corner.x + kLeft * scale, corner.y + kGap * scale};
  const ImVec2 max{std::max(corner.x + ImGui::GetContentRegionAvail().x - kRight * scale, min.x + 20 * scale),
                   std::max(corner.y + height - lineHeight - kGap * scale, min.y + 20 * scale)};
  ImGui::InvisibleButton(plot.title.c_str(), {max.x - corner.x, height});
  const bool hovered = ImGui::IsItemHovered();

  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(min, max, kBackColor);
  double step = 1;
  const int rows = std::max(2, static_cast<int>((max.y - min.y) / (kTickDistance * scale)));
  const Range range = RangeOf(plot, x.size(), rows, step);
  const double first = x.empty() ? 0 : x.front(), last = x.size() < 2 ? first + 1 : x.back();
  const auto atX = [&](double value) {
    return min.x + static_cast<float>((value - first) / (last - first)) * (max.x - min.x);
  };
  const auto atY = [&](double value) {
    return max.y - static_cast<float>((value - range.low) / (range.high - range.low)) * (max.y - min.y);
  };

  for (const double tick : Ticks(range.low, range.high, rows)) {
    const std::string text = TickText(tick, step);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list.AddLine({min.x, atY(tick)}, {max.x, atY(tick)}, kGridColor);
    list.AddText({min.x - size.x - kGap * scale, atY(tick) - size.y / 2}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                 text.c_str());
  }
  const int columns = std::max(2, static_cast<int>((max.x - min.x) / (kWideTickDistance * scale)));
  const std::vector<double> xTicks = Ticks(first, last, columns);
  for (std::size_t i = 0; i < xTicks.size(); ++i) {
    const double tick = xTicks[i], between = xTicks.size() > 1 ? xTicks[1] - xTicks[0] : last - first;
    std::string text = TickText(tick, between);
    if (i + 1 == xTicks.size()) text += " " + xUnit;
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    list.AddLine({atX(tick), min.y}, {atX(tick), max.y}, kGridColor);
    list.AddText({std::min(atX(tick) - width / 2, max.x - width), max.y + kGap / 2 * scale},
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
  }

  list.PushClipRect(min, max, true);
  if (plot.stacked) {
    // A column of the screen after the other, each for the frame that it shows.
    std::size_t i = 0;
    for (float column = min.x; column < max.x && !x.empty(); ++column) {
      while (i + 1 < x.size() && atX(x[i]) < column) ++i;
      double base = 0;
      for (const PlotCurve& curve : plot.curves) {
        list.AddRectFilled({column, atY(base + curve.y[i])}, {column + 1, atY(base)}, ColorOf(curve.color));
        base += curve.y[i];
      }
    }
  } else {
    for (const PlotCurve& curve : plot.curves) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isfinite(curve.y[i])) list.PathLineTo({atX(x[i]), atY(curve.y[i])});
      }
      list.PathStroke(ColorOf(curve.color), ImDrawFlags_None, 1.5f * scale);
    }
  }
  list.PopClipRect();
  list.AddRect(min, max, kFrameColor);

  if (hovered && !x.empty()) {
    const double share = static_cast<double>((ImGui::GetMousePos().x - min.x) / (max.x - min.x));
    cursor = std::clamp(first + share * (last - first), first, last);
  }
  if (!cursor || x.empty()) return;
  const auto next = std::lower_bound(x.begin(), x.end(), *cursor);
  const std::size_t i = std::min(static_cast<std::size_t>(next - x.begin()), x.size() - 1);
  list.AddLine({atX(x[i]), min.y}, {atX(x[i]), max.y}, kCursorColor);
  if (!hovered) return;
  ImGui::BeginTooltip();
  ImGui::Text("%s %s", Number(x[i]).c_str(), xUnit.c_str());
  for (const PlotCurve& curve : plot.curves) {
    if (!std::isfinite(curve.y[i])) continue;
    ImGui::TextColored({curve.color[0], curve.color[1], curve.color[2], 1}, "%s", curve.label.c_str());
    ImGui::SameLine();
    ImGui::Text("%s %s", Number(curve.y[i]).c_str(), plot.unit.c_str());
  }
  ImGui::EndTooltip();
}

}  // namespace percale::viewer
