#pragma once
/// \file
/// The command palette without its window: what can be done by name, which of it a query means, and
/// doing it.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/viewer/actions.h"
#include "percale/parameters.h"

namespace percale::viewer {

class Session;
struct UiState;

struct PaletteCommand {
  enum class Kind { Action, Parameter, Shader, Scene, Preset, Panel } kind = Kind::Action;
  std::string title = {};   ///< "Shader: Phong"
  std::string detail = {};  ///< In grey beside it.
  std::string key = {};     ///< That does the same, if any.
  std::string name = {};    ///< Of what it concerns: of the action, parameter ("cloth.ks"), shader, preset, panel.
  std::filesystem::path file = {};  ///< Of a scene or preset.
  bool enabled = true;

  /// For the list of recent commands: "shader Phong".
  std::string Id() const;
};

/// A command that a query means, best first.
struct Match {
  const PaletteCommand* command;
  int score;
  std::string typed;  ///< The value for a parameter, as JSON or a bare word; empty: none.
};

/// How well `query` fits `text`, whatever their capitals: 0 not at all. Every word of the query must be
/// in the text, its letters in order; beginnings of words and letters in a row count more.
int FuzzyScore(std::string_view query, std::string_view text);

/// Everything there is to do, in an order that makes sense without a query.
std::vector<PaletteCommand> ListCommands(Session& session, const UiState& state);

/// What a query means: "ks", or with a value "ks 800", "gravity 0 -1.6 0". An empty one means everything,
/// the recent commands first.
std::vector<Match> FindCommands(const std::vector<PaletteCommand>& commands, const std::string& query,
                                const std::vector<std::string>& recent);

/// Does it. A parameter without a value is shown in its panel.
void RunCommand(const PaletteCommand& command, const std::string& typed, Session& session, UiState& state);

/// The open palette.
struct Palette {
  bool open = false;
  bool focus = false;  ///< The box has yet to take the keyboard.
  int asked = 0;       ///< Pictures since it was to.
  std::string query = {};
  int selected = 0;
  std::vector<PaletteCommand> commands = {};  ///< As of when it was opened.
  std::vector<SpecialKey> keys = {};          ///< Pressed since the last picture.
  std::string logged = {};                    ///< What the log has.
};

/// Opens it with a query to go on from, or closes it.
void OpenPalette(Session& session, UiState& state, const std::string& query = {});
void ClosePalette(Session& session, UiState& state);
/// A key that was pressed while it is open. Returns whether it took the key.
bool TakePaletteKey(const Key& key, Session& session, UiState& state);

}  // namespace percale::viewer
