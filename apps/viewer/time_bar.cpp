#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "apps/viewer/actions.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr double kMegabyte = 1 << 20;              // [bytes]
constexpr int kBudgets[] = {64, 256, 1024, 4096};  // To choose from [MB].
constexpr float kShortestTrack = 60;               // [screen unit at scale 1]

enum class Icon { First, Back, Run, Pause, Forth, Last, Loop };

/// An icon within a square, drawn: fonts that have these signs are rare.
void DrawIcon(Icon icon, ImVec2 min, float size, ImU32 color) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const float x = min.x + 0.25f * size, y = min.y + 0.25f * size, s = 0.5f * size, bar = 0.14f * size;
  const auto triangle = [&](float left, float right, bool forth) {
    const float base = forth ? left : right, tip = forth ? right : left;
    list->AddTriangleFilled({base, y}, {base, y + s}, {tip, y + s / 2}, color);
  };
  switch (icon) {
    case Icon::First:
    case Icon::Last: {
      const bool forth = icon == Icon::Last;
      triangle(forth ? x : x + bar, forth ? x + s - bar : x + s, forth);
      const float left = forth ? x + s - bar : x;
      list->AddRectFilled({left, y}, {left + bar, y + s}, color);
      break;
    }
    case Icon::Back:
    case Icon::Forth:
      triangle(x + 0.1f * s, x + 0.9f * s, icon == Icon::Forth);
      break;
    case Icon::Run:
      list->AddTriangleFilled({x, y - 0.1f * s}, {x, y + 1.1f * s}, {x + s, y + s / 2}, color);
      break;
    case Icon::Pause:
      for (const float left : {x, x + s - 1.5f * bar})
        list->AddRectFilled({left, y}, {left + 1.5f * bar, y + s}, color);
      break;
    case Icon::Loop: {
      const ImVec2 centre{x + s / 2, y + s / 2};
      list->PathArcTo(centre, 0.5f * s, -0.5f, 4.7f);
      list->PathStroke(color, 0, 0.12f * size);
      list->AddTriangleFilled({centre.x + 0.05f * s, centre.y - 0.85f * s},
                              {centre.x + 0.05f * s, centre.y - 0.15f * s}, {centre.x + 0.5f * s, centre.y - 0.5f * s},
                              color);
      break;
    }
  }
}

/// A square button for an action of the table.
void IconButton(Session& session, UiState& state, Icon icon, std::string_view name, bool lit = false) {
  const Action& action = FindAction(name);
  const float size = ImGui::GetFrameHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  const bool pressed = ImGui::Button(("##" + std::string(name)).c_str(), {size, size});
  if (lit) ImGui::PopStyleColor();
  DrawIcon(icon, at, size, ImGui::GetColorU32(ImGuiCol_Text));
  const std::string keys = KeysText(action);
  Control(session, state, "button " + std::string(name),
          std::string(action.help) + (keys.empty() ? "" : "\n\nKey: " + keys));
  ImGui::SameLine();
  if (pressed) RunAction(action, session, state);
}

/// The frames that are kept, with the present one as a handle.
void Track(Session& session, UiState& state, float width) {
  const HistoryInfo& history = session.snapshot().history;
  const float height = ImGui::GetFrameHeight(), radius = 0.32f * height;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("##track", {width, height});
  const float left = at.x + radius, right = at.x + width - radius, middle = at.y + height / 2;
  const int count = std::max(history.lastFrame - history.firstFrame, 1);
  const bool held = ImGui::IsItemActive();
  if (held) {
    const float share = std::clamp((ImGui::GetIO().MousePos.x - left) / (right - left), 0.0f, 1.0f);
    const int frame = history.firstFrame + std::min(static_cast<int>(std::lround(static_cast<double>(share) * count)),
                                                    history.lastFrame - history.firstFrame);
    if (frame != session.playback().frame() || session.playback().running() || session.playback().looping())
      session.playback().Seek(frame);
  }
  Control(
      session, state, "track",
      "Frames " + std::to_string(history.firstFrame) + " to " + std::to_string(history.lastFrame) +
          " are kept: click or drag to go to one. What you then change or run on takes the place of the later ones.");

  const float share = std::clamp(
      static_cast<float>(session.playback().frame() - history.firstFrame) / static_cast<float>(count), 0.0f, 1.0f);
  const float x = left + share * (right - left), half = 0.11f * height;
  ImDrawList* const list = ImGui::GetWindowDrawList();
  list->AddRectFilled({left, middle - half}, {right, middle + half}, ImGui::GetColorU32(ImGuiCol_FrameBg), half);
  list->AddRectFilled({left, middle - half}, {x, middle + half}, ImGui::GetColorU32(ImGuiCol_SliderGrab), half);
  const bool bright = held || ImGui::IsItemHovered();
  list->AddCircleFilled({x, middle}, radius, ImGui::GetColorU32(bright ? ImGuiCol_SliderGrabActive : ImGuiCol_Text));
}

std::string MemoryText(const HistoryInfo& history) {
  char text[80];
  std::snprintf(text, sizeof text, "%.0f / %.0f MB", std::ceil(static_cast<double>(history.bytes) / kMegabyte),
                static_cast<double>(history.budget) / kMegabyte);
  return text;
}

/// How much memory the history has, as a list to choose from.
void BudgetChoice(Session& session, UiState& state, const std::string& text) {
  ImGui::SetNextItemWidth(ImGui::CalcTextSize(text.c_str()).x + ImGui::GetFrameHeight() +
                          2 * ImGui::GetStyle().FramePadding.x);
  if (!BeginList(session, state, "history budget", "Memory that past frames take, of what they may take", text)) return;
  for (const int megabytes : kBudgets) {
    const std::size_t bytes = static_cast<std::size_t>(megabytes) << 20;
    const std::string entry = std::to_string(megabytes) + " MB";
    if (ImGui::Selectable(entry.c_str(), bytes == session.snapshot().history.budget)) session.SetHistoryBudget(bytes);
    NoteBox(session, state, "history budget/" + std::to_string(megabytes));
  }
  ImGui::EndCombo();
}

}  // namespace

std::string HistoryText(const Session& session) {
  const HistoryInfo& history = session.snapshot().history;
  return history.budget == 0 ? std::string() : "history " + MemoryText(history);
}

float DrawTimeBar(Session& session, UiState& state, float pictureWidth, float height) {
  const Snapshot& snapshot = session.snapshot();
  if (snapshot.history.budget == 0) return 0;
  const ImVec2 padding{8 * state.scale, 5 * state.scale};
  const float barHeight = ImGui::GetFrameHeight() + 2 * padding.y;
  ImGui::SetNextWindowPos({0, height - barHeight});
  ImGui::SetNextWindowSize({pictureWidth, barHeight});
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollbar |
                                      ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoFocusOnAppearing |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;
  const bool shown = ImGui::Begin("Time", nullptr, kFlags);
  ImGui::PopStyleVar(2);
  if (shown) {
    NoteWindow(session, state, "time bar");
    IconButton(session, state, Icon::First, "first_frame");
    IconButton(session, state, Icon::Back, "step_back");
    IconButton(session, state, session.playback().running() || session.playback().looping() ? Icon::Pause : Icon::Run,
               "pause");
    IconButton(session, state, Icon::Forth, "step_forward");
    IconButton(session, state, Icon::Last, "last_frame");
    IconButton(session, state, Icon::Loop, "loop", session.playback().looping());
    char time[80];
    std::snprintf(time, sizeof time, "frame %d   %.2f s", snapshot.report.frame, snapshot.report.time);
    const std::string memory = MemoryText(snapshot.history);
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    // Room for larger numbers, so that the track does not move with each frame.
    const float timeWidth = std::max(ImGui::CalcTextSize("frame 00000   000.00 s").x, ImGui::CalcTextSize(time).x);
    const float memoryWidth =
        ImGui::CalcTextSize(memory.c_str()).x + ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().FramePadding.x;
    // In a narrow window the track stays, and what the status line tells as well goes.
    const float room = ImGui::GetContentRegionAvail().x;
    const bool withTime = room - timeWidth - gap > kShortestTrack * state.scale;
    const bool withMemory = withTime && room - timeWidth - memoryWidth - 2 * gap > kShortestTrack * state.scale;
    const float track = room - (withTime ? timeWidth + gap : 0) - (withMemory ? memoryWidth + gap : 0);
    if (track > 0.5f * kShortestTrack * state.scale) Track(session, state, track);
    if (withTime) {
      ImGui::SameLine();
      const float from = ImGui::GetCursorPosX();
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(time);
      if (withMemory) {
        ImGui::SameLine(from + timeWidth + gap);
        BudgetChoice(session, state, memory);
      }
    }
  }
  ImGui::End();
  return barHeight;
}

}  // namespace percale::viewer
