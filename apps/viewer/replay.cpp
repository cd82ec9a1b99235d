#include "apps/viewer/replay.h"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "apps/viewer/session_log.h"
#include "apps/viewer/timeline.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"

namespace percale::viewer {
namespace {

constexpr double kLargest = 1e15;  // of a whole number that a double holds

/// What is wrong with a line; caught by Replay.
struct BadLine {
  Diagnostics diagnostics;
};

/// One line of a log. What it lacks, or has of another kind, is thrown as BadLine.
class Line {
 public:
  Line(std::string text, const std::string& file, int number) : file_(file), number_(number), doc_(Parse(text)) {
    if (doc_.Kind(0) != JsonKind::Object) Fail("expected an object, the line of a session log");
  }

  [[noreturn]] void Fail(const std::string& message) const {
    Diagnostic error = MakeError(file_, message);
    error.place.line = number_;
    throw BadLine{{error}};
  }
  [[noreturn]] void Fail(Diagnostics errors) const {
    for (Diagnostic& error : errors) {
      if (error.place.file.empty()) error.place = {.file = file_, .line = number_};
    }
    throw BadLine{std::move(errors)};
  }

  bool Has(std::string_view key) const { return doc_.Member(0, key) != 0; }
  JsonIndex Member(std::string_view key, JsonKind kind, const char* expected, JsonIndex object = 0) const {
    const JsonIndex member = doc_.Member(object, key);
    if (member == 0 || doc_.Kind(member) != kind) {
      Fail(std::string(key) + ": expected " + expected + ", got " + (member == 0 ? "nothing" : doc_.Source(member)));
    }
    return member;
  }
  double Number(std::string_view key, JsonIndex object = 0) const {
    return doc_.Number(Member(key, JsonKind::Number, "a number", object));
  }
  template <class T>
  T Whole(std::string_view key, JsonIndex object = 0) const {
    const double number = Number(key, object);
    const double most = std::min(kLargest, static_cast<double>(std::numeric_limits<T>::max()));
    if (!(number >= 0 && number <= most && number == std::floor(number)))
      Fail(std::string(key) + ": expected a whole number >= 0, got " + FormatNumber(number));
    return static_cast<T>(number);
  }
  const std::string& Text(std::string_view key) const { return doc_.Text(Member(key, JsonKind::Text, "a text")); }
  /// A value as JSON text.
  std::string Source(std::string_view key) const {
    if (!Has(key)) Fail(std::string(key) + ": expected a value, got nothing");
    return JsonText(doc_.Member(0, key));
  }
  std::string Where() const { return file_ + ":" + std::to_string(number_); }
  bool Flag(std::string_view key) const { return doc_.Boolean(Member(key, JsonKind::Boolean, "true or false")); }
  Vec3 Vector(std::string_view key, JsonIndex object = 0) const {
    const std::vector<JsonIndex> three =
        doc_.Children(Member(key, JsonKind::Array, "an array of three numbers", object));
    bool good = three.size() == 3;
    for (const JsonIndex i : three) good = good && doc_.Kind(i) == JsonKind::Number;
    if (!good) Fail(std::string(key) + ": expected an array of three numbers");
    return {doc_.Number(three[0]), doc_.Number(three[1]), doc_.Number(three[2])};
  }
  std::uint64_t Hash(std::string_view key) const {
    const std::string& text = Text(key);
    std::uint64_t hash = 0;
    char rest = 0;
    if (text.size() != 16 || std::sscanf(text.c_str(), "%16" SCNx64 "%c", &hash, &rest) != 1)
      Fail(std::string(key) + ": expected 16 hexadecimal digits, got " + Quote(text, 40));
    return hash;
  }
  std::vector<Handle> Handles() const {
    std::vector<Handle> handles;
    for (const JsonIndex one : doc_.Children(Member("handles", JsonKind::Array, "an array of handles"))) {
      if (doc_.Kind(one) != JsonKind::Object) Fail("handles: expected objects");
      Handle handle{.cloth = Whole<int>("cloth", one), .vertex = Whole<int>("vertex", one)};
      handle.target = Vector("target", one);
      handle.radius = Number("radius", one);
      handle.frequency = Number("frequency", one);
      if (const auto problem = Check(handle)) Fail("handles: " + *problem);
      handles.push_back(handle);
    }
    return handles;
  }
  Scene Config() const {
    Result<Scene> scene = ParseScene(Text("config"), file_ + ":" + std::to_string(number_) + " (config)");
    if (!scene) Fail(scene.diagnostics());
    return std::move(*scene);
  }

 private:
  std::string JsonText(JsonIndex value) const {
    switch (doc_.Kind(value)) {
      case JsonKind::Number:
        return FormatNumber(doc_.Number(value));
      case JsonKind::Boolean:
        return doc_.Boolean(value) ? "true" : "false";
      case JsonKind::Text:
        return Quote(doc_.Text(value));
      case JsonKind::Array: {
        std::string list;
        for (const JsonIndex child : doc_.Children(value)) list += (list.empty() ? "" : ",") + JsonText(child);
        return "[" + list + "]";
      }
      default:
        Fail("value: expected a number, a text, true, false or an array");
    }
  }

  JsonDocument Parse(std::string& text) const {
    Result<JsonDocument> doc = JsonDocument::Parse(std::move(text), file_);
    if (!doc) Fail("expected a line of a session log, one JSON object, got something else");
    return std::move(*doc);
  }

  const std::string& file_;
  int number_;
  JsonDocument doc_;
};

/// Follows a log line by line.
class Player {
 public:
  Player(const ReplayOptions& options, ReplayResult& result) : options_(options), result_(result) {}

  /// Returns false when the replay is over.
  bool Take(const Line& line) {
    const std::string& event = line.Text("event");
    if (!timeline_) {
      if (event != "start") line.Fail("expected the line \"start\" of a session log, got " + Quote(event, 40));
      Start(line);
      return true;
    }
    if (event == "exit") {
      result_.complete = true;
      return false;
    }
    if (line.Has("config")) scene_ = line.Config();
    if (event == "set") Set(line);
    if (event == "done") return Done(line);
    if (event == "state") return State(line);
    if (line.Has("command")) waiting_[line.Whole<std::uint64_t>("command")] = Read(line, event);
    return true;
  }

  bool started() const { return timeline_ != nullptr; }

 private:
  void Start(const Line& line) {
    if (const int version = line.Whole<int>("log"); version != kLogVersion) {
      line.Fail("expected a session log of version " + std::to_string(kLogVersion) + ", got version " +
                std::to_string(version) + "; replay it with the version of Percale that wrote it");
    }
    scene_ = line.Config();
    timeline_ = std::make_unique<Timeline>(
        *scene_, Timeline::Options{options_.threads, true, line.Whole<std::size_t>("history")});
    Compare(line);
  }

  void Set(const Line& line) {
    // "/cloth/0/ks" there is "cloth.0.ks" here.
    std::string path = line.Text("path");
    if (path.empty() || path[0] != '/') line.Fail("path: expected a path such as /cloth/ks, got " + Quote(path, 60));
    path.erase(0, 1);
    for (char& c : path) c = c == '/' ? '.' : c;
    const auto applied = ApplyAssignment(*scene_, path + "=" + line.Source("value"));
    if (!applied) line.Fail(applied.diagnostics());
    if (const Status loaded = LoadMeshes(*scene_); !loaded) line.Fail(loaded.diagnostics());
    if (const Diagnostics problems = CheckScene(*scene_); HasErrors(problems)) line.Fail(problems);
  }

  Command Read(const Line& line, const std::string& event) {
    using enum Command::Kind;
    Command command;
    command.number = line.Whole<std::uint64_t>("command");
    command.undoable = line.Has("undoable") && line.Flag("undoable");
    if (event == "run") {
      command.kind = line.Flag("running") ? Run : Pause;
    } else if (event == "loop") {
      command.kind = Loop;
    } else if (event == "step") {
      command.kind = Step;
      command.frames = line.Whole<int>("frames");
    } else if (event == "reset") {
      command.kind = Reset;
    } else if (event == "set" || event == "settings" || event == "reload" || event == "open") {
      command.kind = Apply;
      command.scene = std::make_unique<Scene>(*scene_);
    } else if (event == "handles" || event == "place") {
      command.kind = event == "place" ? Place : Handles;
      command.handles = line.Handles();
    } else if (event == "ball") {
      command.kind = Ball;
      command.ball = {line.Vector("position"), line.Vector("velocity"), line.Number("radius"), line.Number("mass")};
      if (const auto problem = Check(command.ball)) line.Fail(*problem);
    } else if (event == "gust") {
      command.kind = Gust;
      command.gust = {line.Vector("velocity"), line.Number("drag"), line.Number("start"), line.Number("duration")};
      if (const auto problem = Check(command.gust)) line.Fail(*problem);
    } else if (event == "seek") {
      command.kind = Seek;
      command.frame = line.Whole<int>("frame");
    } else if (event == "restore") {
      command.kind = Restore;
      command.before = line.Whole<std::uint64_t>("before");
    } else if (event == "load") {
      command.kind = Load;
      Result<WorldState> state = options_.loadState(TextPath(line.Text("file")));
      if (!state) line.Fail(state.diagnostics());
      command.state = std::make_shared<const WorldState>(std::move(*state));
    } else if (event == "save") {
      command.kind = Save;
    } else if (event == "budget") {
      command.kind = Budget;
      command.budget = line.Whole<std::size_t>("bytes");
    } else {
      line.Fail("the event " + Quote(event, 40) + " is not known to have a command");
    }
    return command;
  }

  bool Done(const Line& line) {
    const auto number = line.Whole<std::uint64_t>("command");
    const auto found = waiting_.find(number);
    if (found == waiting_.end()) line.Fail("command " + std::to_string(number) + " is done, but was never given");
    Command command = std::move(found->second);
    waiting_.erase(waiting_.begin(), std::next(found));  // Earlier ones were overtaken.
    if (!GoTo(line, line.Whole<int>("at"))) return false;
    mode_ = ModeAfter(command.kind, mode_);
    const bool loads = command.kind == Command::Kind::Load;
    timeline_->Execute(std::move(command));
    ++result_.commands;
    if (loads && timeline_->Hash() != line.Hash("hash"))
      line.Fail("the file of the `load` of command " + std::to_string(number) +
                " holds another state than when the session loaded it");
    return Tell() && Compare(line);
  }

  bool State(const Line& line) { return GoTo(line, line.Whole<int>("frame")) && Compare(line); }

  /// To the frame that the log has got to.
  bool GoTo(const Line& line, int frame) {
    if (frame == Frame()) return true;
    if (mode_ == TimeMode::Looping) {
      if (!timeline_->Seek(frame)) line.Fail("frame " + std::to_string(frame) + " is not in the history");
      return true;
    }
    if (frame < Frame()) {
      line.Fail("expected frame " + std::to_string(Frame()) + " or a later one, got frame " + std::to_string(frame));
    }
    while (Frame() < frame) {
      if (!timeline_->StepFrame()) {
        return Differ(line, "the log reaches frame " + std::to_string(frame) + ", the replay blew up after frame " +
                                std::to_string(Frame()));
      }
      ++result_.frames;
      if (!Tell()) return false;
    }
    return true;
  }

  bool Compare(const Line& line) {
    ++result_.states;
    result_.hash = timeline_->Hash();
    const std::uint64_t expected = line.Hash("hash");
    if (result_.hash == expected && line.Whole<int>("frame") == Frame()) return true;
    char text[120];
    std::snprintf(text, sizeof text,
                  "the log tells frame %d with state %016" PRIx64 ", the replay is at frame %d with %016" PRIx64,
                  line.Whole<int>("frame"), expected, Frame(), result_.hash);
    return Differ(line, text);
  }

  bool Differ(const Line& line, const std::string& how) {
    result_.difference = line.Where() + ": " + how;
    return false;
  }

  int Frame() const { return timeline_->world().report().frame; }
  bool Tell() const { return !options_.onFrame || options_.onFrame(timeline_->world()); }

  const ReplayOptions& options_;
  ReplayResult& result_;
  std::unique_ptr<Timeline> timeline_;
  std::optional<Scene> scene_;                // As the session had it set.
  std::map<std::uint64_t, Command> waiting_;  // Given, not done yet.
  TimeMode mode_ = TimeMode::Paused;
};

/// The next line without its end; nothing at the end of the file. `whole` is false for a last line without end.
std::optional<std::string> ReadLine(std::FILE* file, bool& whole) {
  std::string line;
  for (int c; (c = std::getc(file)) != EOF;) {
    if (c == '\n') {
      whole = true;
      return line;
    }
    line += static_cast<char>(c);
  }
  whole = false;
  if (line.empty()) return std::nullopt;
  return line;
}

}  // namespace

Result<ReplayResult> Replay(const std::filesystem::path& file, const ReplayOptions& options) {
  const std::string name = PathText(file);
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return MakeError(name, "expected a session log, got a folder");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(OpenFile(file, "rb"), &std::fclose);
  if (!stream) return MakeError(name, std::string("cannot be read: ") + std::strerror(errno));
  ReplayResult result;
  Player player(options, result);
  int number = 0;
  try {
    bool whole = true;
    while (std::optional<std::string> text = ReadLine(stream.get(), whole)) {
      ++number;
      if (!whole) break;  // Broken off while it was written.
      if (text->empty()) continue;
      if (!player.Take(Line(std::move(*text), name, number))) return result;
    }
  } catch (const BadLine& bad) {
    return bad.diagnostics;
  }
  if (!player.started()) return MakeError(name, "expected a session log, got a file without a whole line");
  return {std::move(result), {MakeWarning(name, "the log breaks off: it lacks the line \"exit\"")}};
}

}  // namespace percale::viewer
