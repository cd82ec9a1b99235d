#pragma once
/// \file
/// Everything that a key does, in one table: the keys, the help window and the log come from it.

#include <span>
#include <string_view>

namespace percale::viewer {

class Session;
struct UiState;

/// Keys that are no characters.
enum class SpecialKey { None, Escape, Tab, F1, F5 };

struct Action {
  std::string_view name;  ///< For the log: "pause".
  std::string_view key;   ///< As the help shows it: "P".
  std::string_view help;  ///< "Run or pause the simulation".
  char character = 0;     ///< The lower-case character that the key types, wherever the keyboard has it...
  SpecialKey special = SpecialKey::None;  ///< ...or a key without one.
  bool repeats = false;                   ///< Again while the key is held.
  /// Returns whether it had an effect.
  bool (*run)(Session&, UiState&) = nullptr;
};

/// In the order of the help window.
std::span<const Action> Actions();

/// What the mouse does, for the help window.
struct MouseHelp {
  std::string_view gesture, help;
};
std::span<const MouseHelp> MouseGestures();

/// Runs the action of a character or key, if there is one, and logs it. `repeated`: the key is held.
void RunAction(char character, SpecialKey special, bool repeated, Session& session, UiState& state);

}  // namespace percale::viewer
