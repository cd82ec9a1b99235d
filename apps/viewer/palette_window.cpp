#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/palette.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/style.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kPaletteWidth = 560;    // [screen unit at scale 1]
constexpr float kPaletteHeight = 0.7f;  // Of the window.
constexpr int kMostRows = 14;
constexpr int kAskEvery = 4;  // Pictures: the box takes the keyboard a picture or two after it was asked to.

/// The cursor goes behind the text that is there already.
int AtTheEnd(ImGuiInputTextCallbackData* data) {
  if (!static_cast<const Palette*>(data->UserData)->focus) return 0;
  data->CursorPos = data->BufTextLen;
  data->ClearSelection();
  return 0;
}

void DrawBox(const Session& session, UiState& state) {
  Palette& palette = state.palette;
  char text[200];
  std::snprintf(text, sizeof text, "%s", palette.query.c_str());
  ImGui::SetNextItemWidth(-1);
  if (palette.focus && palette.asked++ % kAskEvery == 0) ImGui::SetKeyboardFocusHere();
  ImGui::InputTextWithHint("##query", "a command, a scene, a shader, or a parameter with its value: ks 800", text,
                           sizeof text, ImGuiInputTextFlags_CallbackAlways, &AtTheEnd, &palette);
  NoteBox(session, state, "palette query");
  if (ImGui::IsItemActive()) palette.focus = false;
  if (palette.query != text) palette.selected = 0;
  palette.query = text;
}

/// Title, in grey what it is, and at the right its key.
void DrawRow(const Match& match, bool selected, float width) {
  const PaletteCommand& command = *match.command;
  std::string title = command.title, detail = command.detail;
  if (!match.typed.empty()) title += " = " + match.typed;
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 at{ImGui::GetItemRectMin().x + style.ItemSpacing.x, ImGui::GetItemRectMin().y + style.ItemSpacing.y / 2};
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const ImU32 grey = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const ImU32 bright = ImGui::GetColorU32(command.enabled || selected ? ImGuiCol_Text : ImGuiCol_TextDisabled);
  const float right = at.x + width - style.ItemSpacing.x, keyWidth = ImGui::CalcTextSize(command.key.c_str()).x;
  list->AddText(at, bright, title.c_str());
  const float detailAt = at.x + ImGui::CalcTextSize(title.c_str()).x + 2 * style.ItemSpacing.x;
  list->PushClipRect(at, {right - keyWidth - style.ItemSpacing.x, at.y + ImGui::GetTextLineHeight()}, true);
  list->AddText({detailAt, at.y}, grey, detail.c_str());
  list->PopClipRect();
  list->AddText({right - keyWidth, at.y}, ImGui::GetColorU32(AccentColor()), command.key.c_str());
}

void Log(Session& session, UiState& state, const std::vector<Match>& matches) {
  const std::string first =
      matches.empty() ? "" : matches[static_cast<std::size_t>(state.palette.selected)].command->Id();
  const std::string seen = state.palette.query + "\n" + first;
  if (!session.logged() || seen == state.palette.logged) return;
  state.palette.logged = seen;
  session.log().Write(LogLine("palette")
                          .Flag("visible", true)
                          .Text("query", state.palette.query)
                          .Text("selected", first)
                          .Number("count", static_cast<double>(matches.size())));
}

}  // namespace

void DrawPalette(Session& session, UiState& state, float windowWidth, float height) {
  Palette& palette = state.palette;
  if (!palette.open) return;
  const float width = std::min(kPaletteWidth * state.scale, windowWidth - 8 * state.scale);
  ImGui::SetNextWindowPos({windowWidth / 2, height * 0.12f}, ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowSize({width, 0});
  if (palette.focus) ImGui::SetNextWindowFocus();
  constexpr ImGuiWindowFlags kFlags =
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoScrollbar;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("Palette", nullptr, kFlags);
  ImGui::PopStyleVar();
  DrawBox(session, state);
  const std::vector<Match> matches = FindCommands(palette.commands, palette.query, state.kept.recentCommands);
  const int count = static_cast<int>(matches.size());
  int run = -1;
  bool closes = ImGui::IsMouseClicked(0) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows);
  bool moved = false;
  for (const SpecialKey key : std::exchange(palette.keys, {})) {
    const int step = key == SpecialKey::Down ? 1 : key == SpecialKey::Up ? -1 : 0;
    if (step != 0 && count > 0) {
      palette.selected = (palette.selected + step + count) % count;
      moved = true;
    }
    if (key == SpecialKey::Enter && count > 0) run = palette.selected;
  }
  palette.selected = std::clamp(palette.selected, 0, std::max(count - 1, 0));
  Log(session, state, matches);

  const float line = ImGui::GetTextLineHeightWithSpacing();
  const int most = std::max(3, static_cast<int>((kPaletteHeight * height - 2 * line) / line));
  ImGui::BeginChild("list", {0, line * static_cast<float>(std::clamp(count, 1, std::min(kMostRows, most)))});
  if (count == 0) ImGui::TextDisabled("Nothing has that name.");
  ImGuiListClipper clipper;
  clipper.Begin(count);
  if (moved) clipper.ForceDisplayRangeByIndices(palette.selected, palette.selected + 1);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const Match& match = matches[static_cast<std::size_t>(i)];
      const float rowWidth = ImGui::GetContentRegionAvail().x;
      ImGui::PushID(i);
      if (ImGui::Selectable("", i == palette.selected)) run = i;
      ImGui::PopID();
      NoteBox(session, state, "palette/" + match.command->Id());
      DrawRow(match, i == palette.selected, rowWidth);
      if (moved && i == palette.selected) ImGui::SetScrollHereY();
    }
  }
  ImGui::EndChild();
  NoteWindow(session, state, "palette");
  ImGui::End();

  if (run >= 0) {
    const Match& match = matches[static_cast<std::size_t>(run)];
    const PaletteCommand command = *match.command;
    ClosePalette(session, state);
    RunCommand(command, match.typed, session, state);
  } else if (closes) {
    ClosePalette(session, state);
  }
}

}  // namespace percale::viewer
