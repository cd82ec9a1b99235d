#include <imgui.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

#include "apps/viewer/actions.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "io/atomic_file.h"

namespace percale::viewer {

namespace {

constexpr std::string_view kHints[] = {"pause", "help", "palette"};

constexpr ImU32 kWarning = IM_COL32(255, 150, 70, 255);

ImVec2 SizeOf(const std::string& text, float width) {
  return ImGui::CalcTextSize(text.c_str(), nullptr, false, width);
}

/// Text on the picture, its upper left corner at `place`, broken into lines at the width.
void DrawText(const std::string& text, const ImVec2& place, float width, float scale, ImU32 color) {
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  const ImVec2 size = SizeOf(text, width), padding{6 * scale, 3 * scale};
  list->AddRectFilled({place.x - padding.x, place.y - padding.y},
                      {place.x + size.x + padding.x, place.y + size.y + padding.y}, IM_COL32(20, 20, 20, 170),
                      3 * scale);
  list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), place, color, text.c_str(), nullptr, width);
}

/// "no intersections in frame 12"; empty before that is known.
std::string IntersectionText(const Session& session) {
  const auto found = session.intersections();
  if (!found) return {};
  const std::string count = found->count == 0 ? "no" : std::to_string(found->count);
  return count + (found->count == 1 ? " intersection" : " intersections") + " in frame " + std::to_string(found->frame);
}

/// The keys to begin with that the user has not used yet.
std::string HintText(const UiState& state) {
  std::string text;
  for (const std::string_view name : kHints) {
    if (state.kept.usedHints.count(std::string(name)) > 0) continue;
    const Action& action = FindAction(name);
    text += (text.empty() ? "" : "    ") + KeyText(action.key) + ": " + std::string(action.title);
  }
  return text;
}

}  // namespace

void NoteUsed(std::string_view action, UiState& state) {
  if (std::find(std::begin(kHints), std::end(kHints), action) != std::end(kHints))
    state.kept.usedHints.insert(std::string(action));
}

void DrawStatusLine(Session& session, UiState& state, float pictureWidth) {
  std::string text = PathText(session.sceneFile().filename());
  if (session.snapshot().report.divergence)
    text += "   blown up: R starts over";
  else if (session.playback().running())
    text += "   running: P pauses";
  else
    text += "   paused: P runs, N steps one frame";
  text += "   F1 help";
  if (const std::string history = HistoryText(session); !history.empty()) text += "   " + history;
  const float margin = 10 * state.scale;
  const float width = std::max(pictureWidth - 2 * margin, 1.0f);
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  const ImVec2 size = SizeOf(text, width);
  DrawText(text, {margin, margin}, width, state.scale, ink);
  float next = 2 * margin + size.y;
  if (const std::string counted = IntersectionText(session); !counted.empty()) {
    const ImU32 color = session.intersections()->count > 0 ? kWarning : ink;
    // Beside the rest, or below it.
    const bool beside = size.x + 2 * margin + SizeOf(counted, -1).x <= width;
    DrawText(counted, beside ? ImVec2{3 * margin + size.x, margin} : ImVec2{margin, next}, width, state.scale, color);
    if (!beside) next += margin + SizeOf(counted, width).y;
  }
  const std::string hint = HintText(state);
  if (!hint.empty()) DrawText(hint, {margin, next}, width, state.scale, ink);
  if (!session.logged() || hint == state.hintLogged) return;
  state.hintLogged = hint;
  session.log().Write(LogLine("hint").Text("text", hint));
}

}  // namespace percale::viewer
