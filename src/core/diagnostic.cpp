#include "percale/diagnostic.h"

#include <algorithm>

namespace percale {
namespace {

const char* Name(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "error";
    case Severity::Warning:
      return "warning";
    case Severity::Note:
      break;
  }
  return "note";
}

/// One cell per character, so that the caret stands below what it marks, and nothing that a
/// terminal would obey.
std::string Printable(const std::string& text) {
  std::string out = text;
  for (char& c : out) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\t')
      c = ' ';
    else if (byte < 0x20 || byte == 0x7f)
      c = '?';
  }
  return out;
}

}  // namespace

std::string Format(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  const std::string line = std::to_string(place.line);
  std::string out = place.file;
  if (place.line > 0) out += (out.empty() ? "" : ":") + line;
  if (place.line > 0 && place.column > 0) out += ":" + std::to_string(place.column);
  if (!out.empty()) out += ": ";
  out += std::string(Name(diagnostic.severity)) + ": " + diagnostic.message + "\n";
  if (diagnostic.excerpt.empty()) return out;

  const std::string margin(place.line > 0 ? line.size() : 0, ' ');
  out += "  " + (place.line > 0 ? line : margin) + " | " + Printable(diagnostic.excerpt) + "\n";
  if (diagnostic.caret > 0) out += "  " + margin + " | " + std::string(diagnostic.caret - 1, ' ') + "^\n";
  return out;
}

std::string Format(const Diagnostics& diagnostics) {
  std::string out;
  for (const Diagnostic& diagnostic : diagnostics) out += Format(diagnostic);
  return out;
}

bool HasErrors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::Error; });
}

Diagnostic MakeError(std::string message) {
  return MakeError({}, std::move(message));
}
Diagnostic MakeError(std::string file, std::string message) {
  return {Severity::Error, {std::move(file), 0, 0}, std::move(message), {}, 0};
}

Diagnostic MakeWarning(std::string message) {
  return MakeWarning({}, std::move(message));
}
Diagnostic MakeWarning(std::string file, std::string message) {
  return {Severity::Warning, {std::move(file), 0, 0}, std::move(message), {}, 0};
}

Diagnostic MakeNote(std::string message) {
  return MakeNote({}, std::move(message));
}
Diagnostic MakeNote(std::string file, std::string message) {
  return {Severity::Note, {std::move(file), 0, 0}, std::move(message), {}, 0};
}

}  // namespace percale
