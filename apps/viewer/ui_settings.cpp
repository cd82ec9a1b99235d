#include "apps/viewer/ui_settings.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"

namespace percale::viewer {
namespace {

constexpr std::size_t kMostRecent = 12;
constexpr double kLargestWindow = 32768;  // [pixel]

/// Reads the members of one object; what is of another kind than expected is told.
class Reader {
 public:
  Reader(const JsonDocument& document, Diagnostics& problems) : document_(document), problems_(problems) {}

  void Flag(JsonIndex value, bool& to) {
    if (Is(value, JsonKind::Boolean, "true or false")) to = document_.Boolean(value);
  }
  void Whole(JsonIndex value, int& to) {
    if (!Is(value, JsonKind::Number, "a whole number")) return;
    const double number = document_.Number(value);
    if (std::abs(number) <= kLargestWindow)
      to = static_cast<int>(number);
    else
      Tell(value, "a whole number of at most 32768");
  }
  template <class Add>
  void Texts(JsonIndex value, Add add) {
    if (!Is(value, JsonKind::Array, "an array of texts")) return;
    for (const JsonIndex text : document_.Children(value)) {
      if (Is(text, JsonKind::Text, "a text")) add(document_.Text(text));
    }
  }
  bool Is(JsonIndex value, JsonKind kind, const char* expected) {
    if (document_.Kind(value) == kind) return true;
    Tell(value, expected);
    return false;
  }

 private:
  void Tell(JsonIndex value, const char* expected) {
    problems_.push_back(document_.About(
        value, Severity::Warning,
        std::string("expected ") + expected + ", got " + document_.Source(value) + "; the default is taken"));
  }

  const JsonDocument& document_;
  Diagnostics& problems_;
};

std::string TextList(const auto& texts) {
  std::string json;
  for (const std::string& text : texts) json += (json.empty() ? "" : ", ") + Quote(text);
  return "[" + json + "]";
}

const char* FlagText(bool flag) {
  return flag ? "true" : "false";
}

}  // namespace

void Remember(std::vector<std::string>& recent, std::string_view text) {
  const std::string first(text);
  recent.erase(std::remove(recent.begin(), recent.end(), first), recent.end());
  recent.insert(recent.begin(), first);
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

UiSettings LoadUiSettings(const std::filesystem::path& file, Diagnostics& problems) {
  UiSettings settings;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return settings;
  if (!std::filesystem::is_regular_file(status)) {
    problems.push_back(MakeError(PathText(file), "expected a file; the viewer's settings are not kept"));
    problems.back().severity = Severity::Warning;
    return settings;
  }
  const Result<JsonDocument> read = JsonDocument::Load(file);
  if (!read) {
    for (Diagnostic problem : read.diagnostics()) {
      problem.severity = Severity::Warning;
      problem.message += "; the viewer's settings are the defaults";
      problems.push_back(std::move(problem));
    }
    return settings;
  }
  const JsonDocument& document = *read;
  Reader reader(document, problems);
  if (!reader.Is(0, JsonKind::Object, "an object")) return settings;
  for (const JsonIndex member : document.Children(0)) {
    const std::string& key = document.Key(member);
    if (key == "panels_visible") {
      reader.Flag(member, settings.panelsVisible);
    } else if (key == "console_visible") {
      reader.Flag(member, settings.consoleVisible);
    } else if (key == "panels_open") {
      if (!reader.Is(member, JsonKind::Object, "an object")) continue;
      for (const JsonIndex panel : document.Children(member))
        reader.Flag(panel, settings.panelsOpen[document.Key(panel)]);
    } else if (key == "recent_scenes") {
      reader.Texts(member, [&](const std::string& text) { settings.recentScenes.push_back(text); });
    } else if (key == "recent_commands") {
      reader.Texts(member, [&](const std::string& text) { settings.recentCommands.push_back(text); });
    } else if (key == "used_hints") {
      reader.Texts(member, [&](const std::string& text) { settings.usedHints.insert(text); });
    } else if (key == "window") {
      WindowPlace place;
      if (!reader.Is(member, JsonKind::Object, "an object")) continue;
      if (const JsonIndex x = document.Member(member, "x")) reader.Whole(x, place.x);
      if (const JsonIndex y = document.Member(member, "y")) reader.Whole(y, place.y);
      if (const JsonIndex width = document.Member(member, "width")) reader.Whole(width, place.width);
      if (const JsonIndex height = document.Member(member, "height")) reader.Whole(height, place.height);
      if (place.width > 0 && place.height > 0) settings.window = place;
    }  // Of another version of the program: no reason to complain.
  }
  return settings;
}

Status SaveUiSettings(const std::filesystem::path& file, const UiSettings& settings) {
  std::string json = "{\n";
  if (const auto& window = settings.window) {
    json += "  \"window\": {\"x\": " + std::to_string(window->x) + ", \"y\": " + std::to_string(window->y) +
            ", \"width\": " + std::to_string(window->width) + ", \"height\": " + std::to_string(window->height) +
            "},\n";
  }
  json += std::string("  \"panels_visible\": ") + FlagText(settings.panelsVisible) + ",\n";
  json += std::string("  \"console_visible\": ") + FlagText(settings.consoleVisible) + ",\n";
  std::string open;
  for (const auto& [title, isOpen] : settings.panelsOpen) {
    open += (open.empty() ? "" : ", ") + Quote(title) + ": " + FlagText(isOpen);
  }
  json += "  \"panels_open\": {" + open + "},\n";
  json += "  \"recent_scenes\": " + TextList(settings.recentScenes) + ",\n";
  json += "  \"recent_commands\": " + TextList(settings.recentCommands) + ",\n";
  json += "  \"used_hints\": " + TextList(settings.usedHints) + "\n}\n";

  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);  // What fails here fails below, with its place.
  return WriteFile(file, json);
}

}  // namespace percale::viewer
