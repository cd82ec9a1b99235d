#include <imgui.h>

#include <algorithm>
#include <string>

#include "apps/viewer/panels.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kWidest = 620, kMargin = 10;  // [screen unit at scale 1]
constexpr float kHighest = 0.4f;              // Of the window.

ImVec4 ColorOf(const Message& message) {
  if (message.over) return ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled);
  switch (message.diagnostic.severity) {
    case Severity::Error:
      return {1.0f, 0.52f, 0.45f, 1};
    case Severity::Warning:
      return {1.0f, 0.80f, 0.35f, 1};
    case Severity::Note:
      break;
  }
  return ImGui::GetStyleColorVec4(ImGuiCol_Text);
}

const char* WordOf(const Message& message) {
  if (message.over) return "over:";
  switch (message.diagnostic.severity) {
    case Severity::Error:
      return "error:";
    case Severity::Warning:
      return "warning:";
    case Severity::Note:
      break;
  }
  return "note:";
}

std::string PlaceText(const Place& place) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.column > 0) text += ":" + std::to_string(place.column);
  return text.empty() ? text : text + ": ";
}

void DrawMessage(const Message& message) {
  ImGui::PushStyleColor(ImGuiCol_Text, ColorOf(message));
  ImGui::TextUnformatted(WordOf(message));
  ImGui::PopStyleColor();
  ImGui::SameLine();
  if (message.over) ImGui::PushStyleColor(ImGuiCol_Text, ColorOf(message));
  const Diagnostic& d = message.diagnostic;
  Wrapped(PlaceText(d.place) + d.message);
  if (!d.excerpt.empty() && !message.over) {
    ImGui::Indent();
    Wrapped(d.excerpt);
    ImGui::Unindent();
  }
  if (message.over) ImGui::PopStyleColor();
}

}  // namespace

void DrawMessages(Session& session, UiState& state, float pictureWidth, float height) {
  Messages& messages = session.messages();
  if (messages.list().empty()) return;
  const float margin = kMargin * state.scale;
  const float width = std::min(pictureWidth - 2 * margin, kWidest * state.scale);
  if (width < 100 * state.scale) return;
  ImGui::SetNextWindowPos({margin, height - margin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, kHighest * height});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("Messages", nullptr, kFlags)) {
    const int holding = messages.HoldingCount();
    const int over = static_cast<int>(messages.list().size()) - holding;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", ("Messages: " + std::to_string(holding) +
                               (over > 0 ? ", and " + std::to_string(over) + " that are over" : std::string()))
                                  .c_str());
    if (over > 0) {
      ImGui::SameLine();
      if (ImGui::SmallButton("Clear those")) messages.ClearOver();
      NoteBox(session, state, "messages clear");
    }
    for (const Message& message : messages.list()) DrawMessage(message);
    if (messages.list().size() > state.messagesSeen) ImGui::SetScrollHereY(1);
    state.messagesSeen = messages.list().size();
    NoteWindow(session, state, "messages");
  }
  ImGui::End();
}

}  // namespace percale::viewer
