#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/viewer/panels.h"
#include "apps/viewer/style.h"
#include "apps/viewer/widgets.h"

namespace percale::viewer {
namespace {

constexpr float kWidest = 620, kMargin = 10;  // [screen unit at scale 1]
constexpr float kPanelHeight = 0.4f;          // Of the window.

constexpr double kNoteTime = 8;  // A note is shown for so long [s].

/// What is wrong now, and what was noted a moment ago.
std::vector<const Message*> ShownMessages(const Messages& messages) {
  std::vector<const Message*> shown;
  for (const Message& message : messages.list()) {
    const bool isNote = message.diagnostic.severity == Severity::Note;
    if (!isNote || messages.Now() - message.time < kNoteTime) shown.push_back(&message);
  }
  return shown;
}

std::string PlaceText(const Place& place) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.column > 0) text += ":" + std::to_string(place.column);
  return text.empty() ? text : text + ": ";
}

/// The line of a text that a message is about, as a terminal shows it: with its number, and a caret below.
void DrawExcerpt(const Diagnostic& d) {
  const std::string margin = d.place.line > 0 ? std::to_string(d.place.line) + " | " : "";
  std::string text = d.excerpt;
  std::replace(text.begin(), text.end(), '\t', ' ');
  const float left = ImGui::GetCursorPosX();
  ImGui::TextDisabled("%s", margin.c_str());
  ImGui::SameLine(0, 0);
  ImGui::TextUnformatted(text.c_str());
  if (d.caret <= 0) return;
  // The caret counts characters, of which UTF-8 has up to four bytes.
  std::size_t bytes = 0;
  for (int at = 1; at < d.caret && bytes < text.size(); ++at) {
    do ++bytes;
    while (bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80);
  }
  const ImVec2 before = ImGui::CalcTextSize((margin + text.substr(0, bytes)).c_str());
  ImGui::SetCursorPosX(left + before.x);
  ImGui::TextColored({1.0f, 0.52f, 0.45f, 1}, "^");
}

void DrawMessage(const Message& message) {
  const Diagnostic& d = message.diagnostic;
  ImGui::PushStyleColor(ImGuiCol_Text, SeverityColor(d.severity));
  ImGui::TextUnformatted((std::string(SeverityName(d.severity)) + ":").c_str());
  ImGui::PopStyleColor();
  ImGui::SameLine();
  Wrapped(PlaceText(d.place) + d.message);
  if (!d.excerpt.empty()) {
    ImGui::Indent();
    DrawExcerpt(d);
    ImGui::Unindent();
  }
}

}  // namespace

void DrawMessages(Session& session, UiState& state, float pictureWidth, float height) {
  const std::vector<const Message*> shown = ShownMessages(session.messages());
  if (shown.empty() || state.kept.consoleVisible) return;
  const float margin = kMargin * state.scale;
  const float width = std::min(pictureWidth - 2 * margin, kWidest * state.scale);
  if (width < 100 * state.scale) return;
  ImGui::SetNextWindowPos({margin, height - margin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, kPanelHeight * height});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("Messages", nullptr, kFlags)) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Messages: %d", static_cast<int>(shown.size()));
    ImGui::SameLine();
    ActionButton(session, state, "console");
    for (const Message* message : shown) DrawMessage(*message);
    if (shown.size() > state.messagesSeen) ImGui::SetScrollHereY(1);
    state.messagesSeen = shown.size();
    NoteWindow(session, state, "messages");
  }
  ImGui::End();
}

}  // namespace percale::viewer
