#pragma once
/// \file
/// The session log: one JSON object per line, written and flushed as things happen, so that a test
/// or a later replay can follow what the user did and what came of it.
///
/// Every line has "t", the wall-clock time since the start [s], and "event". By event:
///   start    scene, shader, root, width, height (window), samples, renderer, software, frame, hash
///   action   name, key: a key of the table in actions.cpp was pressed
///   ignored  name: the action had no effect, as a single frame while running
///   run      running, command: paused or resumed
///   step     frames, command
///   reset    command
///   set      path ("/cloth/0/ks"), value, command (absent where the simulation has no part in it)
///   uniform  shader, name, value (three numbers)
///   shader   name: the shader that is drawn with from now on
///   wireframe visible: the springs are drawn over the shader, or no longer
///   camera   azimuth, elevation [degree], distance [m], target [m]
///   done     command, frame, hash, kept: a command was carried out after that frame; kept: the
///            cloths are where they were. A change of settings that was overtaken by a newer one has
///            no line.
///   state    frame, step, time [s], running, hash, lowest (y of the lowest point) [m], stretch,
///            energy [J], rest, ms (of the last frame), drawn (pictures so far). After each command,
///            and ten times per second while running.
///   message  severity, source, text, and file, line, column where there is a place
///   mended   source: what messages of that source complained of is over
///   reload   what ("scene" or "shaders"), file
///   open     scene: another scene file
///   window   width, height [screen units], scale
///   panels   visible
///   help     visible
///   widget   name, x, y, width, height [screen units of the window]: where a control is drawn;
///            again when it has moved, and with width 0 when it has gone. Names are those of --set:
///            "cloth.ks" and "cloth.1.ks" are sliders, "cloth.ks box" the box to type in beside it,
///            "look.shader" a drop-down, "look.shader/Phong" an entry of its list.
///   exit     code: the last line
/// Hashes are 16 hexadecimal digits. Numbers of commands count from 1 (see simulation.h).

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "percale/diagnostic.h"
#include "percale/vec3.h"

namespace percale::viewer {

/// One line under construction.
class LogLine {
 public:
  explicit LogLine(std::string_view event);
  LogLine& Text(std::string_view key, std::string_view text);
  LogLine& Number(std::string_view key, double number);
  LogLine& Flag(std::string_view key, bool flag);
  LogLine& Hash(std::string_view key, std::uint64_t hash);
  LogLine& Vector(std::string_view key, const Vec3& v);
  /// `json` as it is.
  LogLine& Json(std::string_view key, std::string_view json);

  const std::string& text() const { return text_; }  ///< `,"event":"EVENT","KEY":VALUE...`

 private:
  std::string text_;
};

class SessionLog {
 public:
  SessionLog() = default;  ///< Writes nothing.
  /// Starts an empty file. Fails when it cannot be written.
  static Result<SessionLog> Open(const std::filesystem::path& file);
  ~SessionLog();
  SessionLog(SessionLog&& other) noexcept;
  SessionLog& operator=(SessionLog&& other) noexcept;

  bool enabled() const { return file_ != nullptr; }
  /// Appends a line. Does nothing without a file, or after a write has failed.
  void Write(const LogLine& line);

 private:
  std::FILE* file_ = nullptr;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace percale::viewer
