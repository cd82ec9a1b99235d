#pragma once
/// \file
/// What the viewer has to tell its user. A message stays until what it complains of is over, and
/// after that, in grey, until the user clears the list: none is lost.

#include <functional>
#include <string>
#include <vector>

#include "percale/diagnostic.h"

namespace percale::viewer {

struct Message {
  std::string source;  ///< What it concerns: "scene", "shader Phong", "/cloth/0/ks", "divergence", ...
  Diagnostic diagnostic;
  bool over = false;  ///< It holds no longer.
};

class Messages {
 public:
  /// Called for each message that is new, and with null for each source whose last one is over.
  using Listener = std::function<void(const std::string& source, const Diagnostic* diagnostic)>;
  explicit Messages(Listener listener = {}) : listener_(std::move(listener)) {}

  /// What holds about `source` from now on; none: all is well. What held before and does not any
  /// more is over. Settings that are dragged change their warning's numbers many times: with
  /// `replace`, messages that are over are dropped at once.
  void Set(const std::string& source, const Diagnostics& diagnostics, bool replace = false);
  /// One more about `source`.
  void Add(const std::string& source, Diagnostic diagnostic);
  /// Forgets what is over.
  void ClearOver();

  const std::vector<Message>& list() const { return list_; }  ///< Oldest first.
  int HoldingCount() const;
  bool Holds(const std::string& source) const;

 private:
  std::vector<Message> list_;
  Listener listener_;
};

}  // namespace percale::viewer
