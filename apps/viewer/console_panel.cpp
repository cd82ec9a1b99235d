#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "apps/viewer/actions.h"
#include "apps/viewer/palette.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/session.h"
#include "apps/viewer/style.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kHeight = 0.4f;  // Of the window.

bool IsShown(const Message& message, const UiState& state) {
  if (!state.consoleShows[static_cast<std::size_t>(message.diagnostic.severity)]) return false;
  return state.consoleFilter.empty() || FuzzyScore(state.consoleFilter, ConsoleLine(message)) > 0;
}

void DrawHead(Session& session, UiState& state) {
  constexpr const char* kLabels[] = {"errors", "warnings", "notes"};
  for (std::size_t i = 0; i < state.consoleShows.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    ImGui::Checkbox(kLabels[i], &state.consoleShows[i]);
    Control(session, state, std::string("console ") + kLabels[i],
            std::string("Shows or hides the ") + kLabels[i] + ".");
  }
  char filter[100];
  std::snprintf(filter, sizeof filter, "%s", state.consoleFilter.c_str());
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - 70 * state.scale, 60 * state.scale));
  if (ImGui::InputTextWithHint("##filter", "filter", filter, sizeof filter)) state.consoleFilter = filter;
  Control(session, state, "console filter", "Shows the messages that hold all of these words.");
  ImGui::SameLine();
  if (ImGui::Button("Copy")) {
    std::string text;
    for (const Message& message : session.messages().history()) {
      if (IsShown(message, state)) text += ConsoleLine(message) + "\n";
    }
    ImGui::SetClipboardText(text.c_str());
    session.log().Write(LogLine("copied").Text("text", text));
  }
  Control(session, state, "console copy", "Copies the messages that are shown here.");
}

}  // namespace

void DrawConsole(Session& session, UiState& state, float pictureWidth, float height) {
  if (!state.kept.consoleVisible) return;
  const float high = kHeight * height;
  ImGui::SetNextWindowPos({0, height - high});
  ImGui::SetNextWindowSize({pictureWidth, high});
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                           ImGuiWindowFlags_NoFocusOnAppearing;
  if (state.keyboardIn != KeyboardIn::Console) flags |= ImGuiWindowFlags_NoNav;
  bool stays = true;
  if (ImGui::Begin(kConsoleTitle, &stays, flags)) {
    DrawHead(session, state);
    ImGui::BeginChild("messages");
    const auto& history = session.messages().history();
    for (const Message& message : history) {
      if (!IsShown(message, state)) continue;
      ImGui::PushStyleColor(ImGuiCol_Text, SeverityColor(message.diagnostic.severity));
      Wrapped(ConsoleLine(message));
      ImGui::PopStyleColor();
    }
    if (history.empty()) ImGui::TextDisabled("Nothing to tell so far.");
    if (history.size() > state.consoleSeen) ImGui::SetScrollHereY(1);
    state.consoleSeen = history.size();
    ImGui::EndChild();
    NoteWindow(session, state, "console");
  }
  ImGui::End();
  if (!stays) RunAction(FindAction("console"), session, state);
}

}  // namespace percale::viewer
