#include "apps/viewer/palette.h"

#include <algorithm>
#include <cctype>

#include "apps/viewer/panels.h"
#include "apps/viewer/presets.h"
#include "apps/viewer/session.h"
#include "apps/viewer/ui_state.h"
#include "apps/viewer/widgets.h"
#include "core/text.h"
#include "io/atomic_file.h"

namespace percale::viewer {
namespace {

// Points for how a word of the query is in the text; tried so that "ks" finds the spring constant before
// everything with a k and an s.
constexpr int kWhole = 100, kAtWord = 40, kInRow = 20, kScattered = 4;
/// For each place that a command stands nearer to the top of the recent ones.
constexpr int kRecent = 2;

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::vector<std::string> Words(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c != ' ')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool IsLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

/// Of one word, both in lower case.
int WordScore(std::string_view word, std::string_view text) {
  int best = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !IsLetter(text[at - 1]), ends = end == text.size() || !IsLetter(text[end]);
    best = std::max(best, begins && ends ? kWhole : begins ? kAtWord : kInRow);
  }
  if (best > 0) return best;
  std::size_t at = 0;
  for (const char c : word) {
    at = text.find(c, at);
    if (at == std::string_view::npos) return 0;
    ++at;
  }
  return kScattered;
}

const Parameter& ParameterOf(const PaletteCommand& command) {
  const std::size_t dot = command.name.find('.');
  return *FindParameter(std::string_view(command.name).substr(0, dot), std::string_view(command.name).substr(dot + 1));
}

/// "cloth.ks" as the objects of the scene have it.
std::string CurrentValue(const Parameter& parameter, const Scene& scene, int index) {
  const std::string value = FormatValue(parameter.get(scene, static_cast<std::size_t>(std::max(index, 0))));
  return value + (parameter.unit.empty() ? "" : " " + Readable(parameter.unit));
}

/// Of several objects the one that the panels are about.
int IndexOf(const Parameter& parameter, const UiState& state) {
  return parameter.group == "cloth" ? state.cloth : Session::kAll;
}

/// A query that may end in a value.
struct Split {
  std::string words, value;
};

/// The query before its numbers, and these as JSON; or before its last word and that word.
std::optional<Split> SplitValue(const std::string& query) {
  std::string spaced = query;
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == '=' || c == ',' || c == '[' || c == ']'; }, ' ');
  std::vector<std::string> words = Words(spaced);
  std::size_t numbers = 0;
  while (numbers < words.size() && ParseTypedNumber(words[words.size() - 1 - numbers])) ++numbers;
  const std::size_t taken = std::max<std::size_t>(numbers, 1);
  if (taken >= words.size()) return std::nullopt;
  Split split;
  for (std::size_t i = 0; i < words.size() - taken; ++i) split.words += (i > 0 ? " " : "") + words[i];
  for (std::size_t i = words.size() - taken; i < words.size(); ++i) {
    split.value += (split.value.empty() ? "" : ", ") + words[i];
  }
  if (numbers > 1) split.value = "[" + split.value + "]";
  return split;
}

/// Whether text may be meant as a value of the parameter: what is no number may be a word of the query.
bool MayBeValue(const Parameter& parameter, const std::string& text) {
  const bool isWord = text.front() != '[' && !ParseTypedNumber(text);
  switch (parameter.kind) {
    case ValueKind::Number:
    case ValueKind::Integer:
    case ValueKind::Vector:
      return !isWord;
    case ValueKind::Boolean:
      return text == "true" || text == "false";
    case ValueKind::Choice:
      return std::find(parameter.choices.begin(), parameter.choices.end(), text) != parameter.choices.end();
    case ValueKind::Text:
    case ValueKind::GridPoints:
      break;
  }
  return false;
}

void SetTyped(const PaletteCommand& command, const std::string& typed, Session& session, const UiState& state) {
  const Parameter& parameter = ParameterOf(command);
  const int index = IndexOf(parameter, state);
  Scene changed = session.scene();
  const auto applied = ApplyAssignment(changed, command.name + "=" + typed);
  if (applied)
    session.SetParameter(parameter, index, parameter.get(changed, static_cast<std::size_t>(std::max(index, 0))));
  else
    session.Refuse(parameter, index, "expected " + DescribeExpected(parameter) + ", got " + Quote(typed, 40));
}

void AddScenes(Session& session, const UiState& state, std::vector<PaletteCommand>& commands) {
  const auto add = [&](const std::filesystem::path& file, const char* front, std::string detail) {
    PaletteCommand command{.kind = PaletteCommand::Kind::Scene, .file = file};
    command.name = PathText(std::filesystem::absolute(file).lexically_normal());
    const bool known = std::any_of(commands.begin(), commands.end(), [&](const PaletteCommand& c) {
      return c.kind == command.kind && c.name == command.name;
    });
    if (known) return;
    command.title = front + PathText(file.filename());
    command.detail = std::move(detail);
    commands.push_back(std::move(command));
  };
  for (const std::filesystem::path& file : session.SceneFiles()) add(file, "Scene: ", "");
  for (const std::string& recent : state.kept.recentScenes) {
    const std::filesystem::path file = TextPath(recent);
    add(file, "Recent scene: ", PathText(file.parent_path()));
  }
}

}  // namespace

std::string PaletteCommand::Id() const {
  constexpr std::string_view kKinds[] = {"action", "set", "shader", "scene", "preset", "panel"};
  return std::string(kKinds[static_cast<std::size_t>(kind)]) + " " + name;
}

int FuzzyScore(std::string_view query, std::string_view text) {
  const std::string lower = Lower(text);
  int score = 0;
  for (const std::string& word : Words(Lower(query))) {
    const int points = WordScore(word, lower);
    if (points == 0) return 0;
    score += points;
  }
  return score;
}

std::vector<PaletteCommand> ListCommands(Session& session, const UiState& state) {
  using Kind = PaletteCommand::Kind;
  std::vector<PaletteCommand> commands;
  for (const Action& action : Actions()) {
    if (action.name == "palette") continue;
    commands.push_back({.kind = Kind::Action,
                        .title = std::string(action.category) + ": " + std::string(action.title),
                        .detail = action.help == action.title ? "" : std::string(action.help),
                        .key = KeysText(action),
                        .name = std::string(action.name),
                        .enabled = !action.enabled || action.enabled(session, state)});
  }
  for (const std::string& shader : session.liveView().shaderNames()) {
    commands.push_back({.kind = Kind::Shader, .title = "Shader: " + shader, .name = shader});
  }
  for (const auto& preset : ListPresets(state.presetFolders)) {
    const Result<Preset> read = LoadPreset(preset.second);
    commands.push_back({.kind = Kind::Preset,
                        .title = "Preset: " + preset.first,
                        .detail = read ? read->description : "cannot be read",
                        .name = preset.first,
                        .file = preset.second});
  }
  AddScenes(session, state, commands);
  for (const Parameter& parameter : Parameters()) {
    // The camera is placed by the mouse, and the shader has entries of its own.
    if (parameter.group == "camera" || (parameter.group == "look" && parameter.name == "shader")) continue;
    if (FindGroup(parameter.group)->count(session.scene()) == 0 || !IsHeeded(parameter, session.scene())) continue;
    PaletteCommand command{.kind = Kind::Parameter};
    command.name = std::string(parameter.group) + "." + std::string(parameter.name);
    command.title = command.name;
    command.detail =
        std::string(parameter.label) + ": " + CurrentValue(parameter, session.scene(), IndexOf(parameter, state));
    commands.push_back(std::move(command));
  }
  for (const Panel& panel : Panels()) {
    if (panel.hasContent && !panel.hasContent(session)) continue;
    commands.push_back({.kind = Kind::Panel, .title = std::string("Panel: ") + panel.title, .name = panel.title});
  }
  return commands;
}

std::vector<Match> FindCommands(const std::vector<PaletteCommand>& commands, const std::string& query,
                                const std::vector<std::string>& recent) {
  const std::optional<Split> split = SplitValue(query);
  std::vector<Match> matches;
  for (const PaletteCommand& command : commands) {
    const auto place = std::find(recent.begin(), recent.end(), command.Id());
    const int bonus = kRecent * static_cast<int>(recent.end() - place);
    const std::string_view detail = command.kind == PaletteCommand::Kind::Parameter
                                        ? std::string_view(command.detail).substr(0, command.detail.find(':'))
                                        : std::string_view(command.detail);
    const auto score = [&](const std::string& words) {
      // What stands in grey counts less, and only where it has the words as they are.
      const int inTitle = FuzzyScore(words, command.title), inDetail = FuzzyScore(words, detail);
      return std::max(inTitle, inDetail >= kInRow ? inDetail / 2 : 0);
    };
    const int whole = query.empty() ? 1 : score(query);
    if (whole > 0) matches.push_back({&command, whole + bonus, {}});
    if (split && command.kind == PaletteCommand::Kind::Parameter && MayBeValue(ParameterOf(command), split->value)) {
      const int part = score(split->words);
      if (part > kScattered) matches.push_back({&command, part + kWhole + bonus, split->value});
    }
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) { return a.score > b.score; });
  return matches;
}

void RunCommand(const PaletteCommand& command, const std::string& typed, Session& session, UiState& state) {
  Remember(state.kept.recentCommands, command.Id());
  switch (command.kind) {
    case PaletteCommand::Kind::Action:
      return RunAction(FindAction(command.name), session, state);
    case PaletteCommand::Kind::Parameter:
      if (typed.empty())
        state.jump = command.name;
      else
        SetTyped(command, typed, session, state);
      return;
    case PaletteCommand::Kind::Shader:
      return session.SetShader(command.name);
    case PaletteCommand::Kind::Scene:
      session.OpenScene(command.file);
      return;
    case PaletteCommand::Kind::Preset:
      return ApplyPreset(command.file, session);
    case PaletteCommand::Kind::Panel:
      state.kept.panelsVisible = state.kept.panelsOpen[command.name] = true;
      state.jump = "panel " + command.name;
      return;
  }
}

void OpenPalette(Session& session, UiState& state, const std::string& query) {
  state.palette = {.open = true, .focus = true, .query = query, .commands = ListCommands(session, state)};
}

void ClosePalette(Session& session, UiState& state) {
  state.palette = {};
  session.log().Write(LogLine("palette").Flag("visible", false));
}

bool TakePaletteKey(const Key& key, Session& session, UiState& state) {
  if (!state.palette.open || !BelongsToTextInput(key)) return false;
  if (key.special == SpecialKey::Escape) {
    ClosePalette(session, state);
    return true;
  }
  // Arrows and Enter come after what was typed before them, which the box takes with the next picture.
  if (key.special != SpecialKey::None) state.palette.keys.push_back(key.special);
  // The box takes characters itself, as soon as it has the keyboard.
  if (key.character != 0 && !key.control && state.palette.focus) state.palette.query += key.character;
  return true;
}

}  // namespace percale::viewer
