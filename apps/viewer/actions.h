#pragma once
/// \file
/// Everything that the user can have done by a key or by the command palette, in one table: the keys,
/// the help window, the palette, tooltips, the log and the key table of docs/viewer.md come from it.

#include <span>
#include <string>
#include <string_view>

namespace percale::viewer {

class Session;
struct UiState;

/// Keys that are no characters.
// clang-format off
enum class SpecialKey {
  None, Escape, Tab, Enter, Delete, Home, End, Left, Right, Up, Down,
  F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12,
};
// clang-format on

/// A key as it is pressed: a character wherever the keyboard has it, or a key without one.
struct Key {
  char character = 0;  ///< In lower case, ASCII: 'p', '[', ' '.
  SpecialKey special = SpecialKey::None;
  bool control = false;  ///< With Ctrl.
  bool shift = false;    ///< With Shift; only beside Ctrl or for a special key, else the character tells.
  friend bool operator==(const Key&, const Key&) = default;
  explicit operator bool() const { return character != 0 || special != SpecialKey::None; }
};

/// "P", "Ctrl+Shift+Z", "F5", "Space"; empty for no key.
std::string KeyText(const Key& key);

struct Action {
  std::string_view name;      ///< For the log: "pause".
  std::string_view category;  ///< "Simulation", "View", "Scene", "Edit" or "Window".
  std::string_view title;     ///< In the palette: "Run or pause".
  std::string_view help;      ///< One sentence: "Run or pause the simulation".
  Key key = {};               ///< None: by the palette only.
  Key otherKey = {};          ///< Does the same.
  bool repeats = false;       ///< Again while the key is held.
  /// Whether it can act now; null: always.
  bool (*enabled)(const Session&, const UiState&) = nullptr;
  /// Returns whether it had an effect.
  bool (*run)(Session&, UiState&) = nullptr;
};

/// In the order of the help window, category by category.
std::span<const Action> Actions();

/// The action of that name, which must exist.
const Action& FindAction(std::string_view name);

/// The keys of an action: "Ctrl+Tab, F6".
std::string KeysText(const Action& action);

/// What the mouse does, for the help window.
struct MouseHelp {
  std::string_view gesture, help;
};
std::span<const MouseHelp> MouseGestures();

/// Runs an action, if it can act now, and logs it.
void RunAction(const Action& action, Session& session, UiState& state);
/// Runs the action of a key, if there is one. `repeated`: the key is held.
void RunAction(const Key& key, bool repeated, Session& session, UiState& state);

/// Whether a box that takes text, or a list that hangs open, has its own use for the key. The others
/// run actions even then.
bool BelongsToTextInput(const Key& key);

/// Whether controls that have the keyboard use the key: to move among them, to press and to set them.
bool BelongsToControls(const Key& key);

}  // namespace percale::viewer
