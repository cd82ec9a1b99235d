#include "apps/viewer/messages.h"

#include <algorithm>
#include <cstddef>

namespace percale::viewer {
namespace {

/// So many that are over are kept at most: the oldest go first.
constexpr std::size_t kMostOver = 200;

bool Same(const Diagnostic& a, const Diagnostic& b) {
  return a.severity == b.severity && a.message == b.message && a.place.file == b.place.file &&
         a.place.line == b.place.line && a.place.column == b.place.column;
}

}  // namespace

void Messages::Set(const std::string& source, const Diagnostics& diagnostics, bool replace) {
  const bool held = Holds(source);
  const auto remains = [&](const Message& m) {
    return std::any_of(diagnostics.begin(), diagnostics.end(),
                       [&](const Diagnostic& d) { return Same(d, m.diagnostic); });
  };
  for (Message& message : list_) {
    if (message.source == source && !message.over && !remains(message)) message.over = true;
  }
  if (replace) {
    list_.erase(
        std::remove_if(list_.begin(), list_.end(), [&](const Message& m) { return m.source == source && m.over; }),
        list_.end());
  }
  for (const Diagnostic& diagnostic : diagnostics) {
    const bool known = std::any_of(list_.begin(), list_.end(), [&](const Message& m) {
      return m.source == source && !m.over && Same(m.diagnostic, diagnostic);
    });
    if (!known) Add(source, diagnostic);
  }
  if (held && diagnostics.empty() && listener_) listener_(source, nullptr);

  std::size_t over =
      static_cast<std::size_t>(std::count_if(list_.begin(), list_.end(), [](const Message& m) { return m.over; }));
  for (auto m = list_.begin(); over > kMostOver && m != list_.end();) {
    if (!m->over) {
      ++m;
      continue;
    }
    m = list_.erase(m);
    --over;
  }
}

void Messages::Add(const std::string& source, Diagnostic diagnostic) {
  list_.push_back({source, std::move(diagnostic), false});
  if (listener_) listener_(source, &list_.back().diagnostic);
}

void Messages::ClearOver() {
  list_.erase(std::remove_if(list_.begin(), list_.end(), [](const Message& m) { return m.over; }), list_.end());
}

int Messages::HoldingCount() const {
  return static_cast<int>(std::count_if(list_.begin(), list_.end(), [](const Message& m) { return !m.over; }));
}

bool Messages::Holds(const std::string& source) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Message& m) { return m.source == source && !m.over; });
}

}  // namespace percale::viewer
