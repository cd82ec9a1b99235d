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

/// Text on the picture, its upper left corner at (x, y), broken into lines at the width. Returns its height.
float DrawText(const std::string& text, float x, float y, float width, float scale) {
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width);
  const ImVec2 padding{6 * scale, 3 * scale};
  list->AddRectFilled({x - padding.x, y - padding.y}, {x + size.x + padding.x, y + size.y + padding.y},
                      IM_COL32(20, 20, 20, 170), 3 * scale);
  list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {x, y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str(),
                nullptr, width);
  return size.y;
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
  const float height = DrawText(text, margin, margin, width, state.scale);
  const std::string hint = HintText(state);
  if (!hint.empty()) DrawText(hint, margin, 2 * margin + height, width, state.scale);
  if (!session.logged() || hint == state.hintLogged) return;
  state.hintLogged = hint;
  session.log().Write(LogLine("hint").Text("text", hint));
}

}  // namespace percale::viewer
