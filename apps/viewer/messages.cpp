#include "apps/viewer/messages.h"

#include <algorithm>
#include <cstdio>

namespace percale::viewer {
namespace {

bool Same(const Diagnostic& a, const Diagnostic& b) {
  return a.severity == b.severity && a.message == b.message && a.place.file == b.place.file &&
         a.place.line == b.place.line && a.place.column == b.place.column;
}

}  // namespace

const char* SeverityName(Severity severity) {
  return severity == Severity::Error ? "error" : severity == Severity::Warning ? "warning" : "note";
}

void Messages::Set(const std::string& source, const Diagnostics& diagnostics, bool replace) {
  const bool held = Holds(source);
  const auto isOver = [&](const Message& m) {
    return m.source == source && std::none_of(diagnostics.begin(), diagnostics.end(),
                                              [&](const Diagnostic& d) { return Same(d, m.diagnostic); });
  };
  list_.erase(std::remove_if(list_.begin(), list_.end(), isOver), list_.end());
  for (const Diagnostic& diagnostic : diagnostics) {
    const bool known = std::any_of(list_.begin(), list_.end(), [&](const Message& m) {
      return m.source == source && Same(m.diagnostic, diagnostic);
    });
    if (!known) Tell(source, diagnostic, replace);
  }
  if (held && diagnostics.empty() && listener_) listener_(source, nullptr);
}

void Messages::Tell(const std::string& source, Diagnostic diagnostic, bool replace) {
  const double now = Now();
  list_.push_back({source, diagnostic, now, 1});
  const auto told = std::find_if(history_.begin(), history_.end(), [&](const Message& m) {
    return m.source == source && (Same(m.diagnostic, diagnostic) || (replace && &m == &history_.back()));
  });
  if (told != history_.end()) {
    told->diagnostic = diagnostic;
    told->time = now;
    ++told->count;
    std::rotate(told, told + 1, history_.end());  // The newest is the last.
  } else {
    history_.push_back(list_.back());
  }
  if (listener_) listener_(source, &diagnostic);
}

bool Messages::Holds(const std::string& source) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Message& m) { return m.source == source; });
}

double Messages::Now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

Diagnostic MakeRefusal(std::string_view label, const std::string& why) {
  return MakeError(std::string(label) + ": " + why + "; the old value stays");
}

std::string ConsoleLine(const Message& message) {
  const Diagnostic& d = message.diagnostic;
  char time[40];
  std::snprintf(time, sizeof time, "%.1f s", message.time);
  std::string line = std::string(time) + "  " + SeverityName(d.severity) + "  " + message.source + "  ";
  if (!d.place.file.empty()) line += d.place.file + ":";
  if (d.place.line > 0) line += std::to_string(d.place.line) + ":";
  if (d.place.column > 0) line += std::to_string(d.place.column) + ":";
  if (!d.place.file.empty()) line += " ";
  line += d.message;
  if (message.count > 1) line += "  (" + std::to_string(message.count) + " times)";
  return line;
}

}  // namespace percale::viewer
