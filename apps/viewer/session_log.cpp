#include "apps/viewer/session_log.h"

#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"

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
