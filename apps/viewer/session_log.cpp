#include "apps/viewer/session_log.h"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"
#include "percale/scene_file.h"

namespace percale::viewer {

LogLine::LogLine(std::string_view event) {
  Text("event", event);
}

LogLine& LogLine::Json(std::string_view key, std::string_view json) {
  text_ += ",\"";
  text_ += key;
  text_ += "\":";
  text_ += json;
  return *this;
}

LogLine& LogLine::Text(std::string_view key, std::string_view text) {
  return Json(key, Quote(text));
}
LogLine& LogLine::Number(std::string_view key, double number) {
  return Json(key, std::isfinite(number) ? FormatNumber(number) : "null");
}
LogLine& LogLine::Flag(std::string_view key, bool flag) {
  return Json(key, flag ? "true" : "false");
}
LogLine& LogLine::Hash(std::string_view key, std::uint64_t hash) {
  char digits[19];
  std::snprintf(digits, sizeof digits, "\"%016" PRIx64 "\"", hash);
  return Json(key, digits);
}
LogLine& LogLine::Vector(std::string_view key, const Vec3& v) {
  return Json(key, "[" + FormatNumber(v.x) + "," + FormatNumber(v.y) + "," + FormatNumber(v.z) + "]");
}

LogLine& LogLine::Config(const Scene& scene) {
  return Text("config", FormatScene(WithAbsolutePaths(scene)));
}

LogLine DescribeCommand(const Command& command) {
  using enum Command::Kind;
  const auto line = [&] {
    switch (command.kind) {
      case Run:
        return LogLine("run").Flag("running", true);
      case Pause:
        return LogLine("run").Flag("running", false);
      case Loop:
        return LogLine("loop");
      case Step:
        return LogLine("step").Number("frames", command.frames);
      case Reset:
        return LogLine("reset");
      case Apply:
        return LogLine("settings");
      case Handles:
      case Place: {
        std::string list;
        for (const Handle& handle : command.handles) {
          LogLine one("handle");
          one.Number("cloth", handle.cloth).Number("vertex", handle.vertex).Vector("target", handle.target);
          one.Number("radius", handle.radius).Number("frequency", handle.frequency);
          list += (list.empty() ? "{" : ",{") + one.text().substr(1) + "}";
        }
        return LogLine(command.kind == Handles ? "handles" : "place").Json("handles", "[" + list + "]");
      }
      case Ball:
        return LogLine("ball")
            .Vector("position", command.ball.position)
            .Vector("velocity", command.ball.velocity)
            .Number("radius", command.ball.radius)
            .Number("mass", command.ball.mass);
      case Gust:
        return LogLine("gust")
            .Vector("velocity", command.gust.velocity)
            .Number("drag", command.gust.drag)
            .Number("start", command.gust.start)
            .Number("duration", command.gust.duration);
      case Seek:
        return LogLine("seek").Number("frame", command.frame);
      case Restore:
        return LogLine("restore").Number("before", static_cast<double>(command.before));
      case Load:
        return LogLine("load");
      case Save:
        return LogLine("save");
      case Budget:
        break;
    }
    return LogLine("budget").Number("bytes", static_cast<double>(command.budget));
  };
  LogLine text = line();
  if (command.undoable) text.Flag("undoable", true);
  return text;
}

std::string ValuePath(const Parameter& parameter, int index) {
  std::string path = "/" + std::string(parameter.group);
  if (FindGroup(parameter.group)->isArray && index >= 0) path += "/" + std::to_string(index);
  return path + "/" + std::string(parameter.name);
}

LogLine DescribeSettings(const Scene& scene) {
  return LogLine("settings").Config(scene);
}

std::vector<LogLine> DescribeValues(const Scene& before, const Scene& after) {
  std::vector<LogLine> lines;
  std::vector<Difference> differences = Differences(before, after);
  // A choice that brings others along comes before these.
  std::stable_partition(differences.begin(), differences.end(),
                        [](const Difference& d) { return d.parameter->choose; });
  for (const auto& [parameter, index] : differences) {
    LogLine& line = lines.emplace_back("set");
    line.Text("path", ValuePath(*parameter, static_cast<int>(index)));
    line.Json("value", FormatValue(parameter->get(after, index)));
  }
  return lines;
}

Result<SessionLog> SessionLog::Open(const std::filesystem::path& file) {
  SessionLog log;
  log.file_ = OpenFile(file, "wb");
  if (!log.file_) {
    return MakeError(PathText(file), std::string("the session log cannot be written: ") + std::strerror(errno) +
                                         "; name a file in a folder that exists and that you may write to");
  }
  return log;
}

SessionLog::~SessionLog() {
  if (file_) std::fclose(file_);
}
SessionLog::SessionLog(SessionLog&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), start_(other.start_) {}
SessionLog& SessionLog::operator=(SessionLog&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(start_, other.start_);
  return *this;
}

void SessionLog::Write(const LogLine& line) {
  if (!file_) return;
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
  const std::string text = "{\"t\":" + FormatNumber(std::round(time.count() * 1e6) / 1e6) + line.text() + "}\n";
  if (std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fflush(file_) == 0) return;
  std::fprintf(stderr, "percale: warning: the session log cannot be written any more: %s\n", std::strerror(errno));
  std::fclose(std::exchange(file_, nullptr));
}

}  // namespace percale::viewer
