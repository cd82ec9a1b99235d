#pragma once
/// \file
/// What the viewer has to tell its user: what is wrong now, and the history of all that was told.

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"

namespace percale::viewer {

/// What the user reads before a message: "error", "warning" or "note".
const char* SeverityName(Severity severity);

struct Message {
  std::string source;  ///< What it concerns: "scene", "shader Phong", "/cloth/0/ks", "divergence", ...
  Diagnostic diagnostic;
  double time = 0;  ///< When it was told last, since the start [s].
  int count = 1;    ///< How often it was told.
};

class Messages {
 public:
  /// Called for each message that is new, and with null for each source whose last one is over.
  using Listener = std::function<void(const std::string& source, const Diagnostic* diagnostic)>;
  explicit Messages(Listener listener = {}) : listener_(std::move(listener)) {}

  /// What holds about `source` from now on; none: all is well. What held before and does not any
  /// more is over. Settings that are dragged change their warning's numbers many times: with
  /// `replace`, the history has the newest in place of the one before.
  void Set(const std::string& source, const Diagnostics& diagnostics, bool replace = false);
  /// One more about `source`.
  void Add(const std::string& source, Diagnostic diagnostic) { Tell(source, std::move(diagnostic), false); }

  const std::vector<Message>& list() const { return list_; }        ///< What holds, oldest first.
  const std::vector<Message>& history() const { return history_; }  ///< Everything, oldest first, repeated ones once.
  bool Holds(const std::string& source) const;
  double Now() const;  ///< Since the start [s].

 private:
  void Tell(const std::string& source, Diagnostic diagnostic, bool replace);

  std::vector<Message> list_, history_;
  Listener listener_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Of what was typed for a parameter, and will not do: "Damping: WHY; the old value stays".
Diagnostic MakeRefusal(std::string_view label, const std::string& why);

/// A message as it is copied: "12.3 s  error  scene  a.json:3:7: ... (3 times)".
std::string ConsoleLine(const Message& message);

}  // namespace percale::viewer
