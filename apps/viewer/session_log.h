#pragma once
/// \file
/// The session log: one JSON object per line, written and flushed as things happen, so that a test
/// or a later replay can follow what the user did and what came of it.
///
/// Every line has "t", the wall-clock time since the start [s], and "event". By event:
///   start    log (the version of this format), version (of the program), scene (its file), config (the
///            text of the scene itself), shader, root, width, height (window), samples, renderer, software,
///            history (its budget [bytes]), frame, hash
///   key      name, title, keys: a row of the table of actions; all of them after the start
///   action   name, key: an action of that table was run, by its key, the palette or a button
///   ignored  name: the action had no effect, as a single frame while running
///   run      running, command: paused or resumed
///   loop     command: the history is shown again and again
///   step     frames, command
///   reset    command
///   settings config (a scene), command (absent where the simulation has them already, or no part in what is
///            other): all settings at once
///   handles  handles (grips on the cloth, each with cloth, vertex, target [m], radius [m], frequency
///            [Hz]), command: they take the place of those there were
///   place    handles, command: the cloth is put there, while time stands
///   ball     position [m], velocity [m/s], radius [m], mass [kg], command
///   gust     velocity [m/s], drag [kg/(m^2 s)], start [s from now], duration [s], command
///   seek     frame, command: to that frame of the history
///   restore  before, command: to the state before the command of that number
///   save     command: the state is handed out, for a checkpoint or a picture
///   load     file, config, command: to the state in a checkpoint or a picture; the hash is in its line `done`
///   saved    what ("checkpoint", "picture", "film"), file: it has been written
///   record   recording: a film begins or ends
///   budget   bytes, command: of history
///   undo     label, and redo: what the lines after it do
///   set      path ("/cloth/0/ks"), value, command (absent where the simulation has no part in it)
///   uniform  shader, name, value (three numbers; without it, the default)
///   uniforms shader: all values are the shader's defaults again
///   shader   name: the shader that is drawn with from now on
///   texture  number (1 to 4), file: the shaders' texture from now on; empty: the project's own
///   wireframe visible: the springs are drawn over the shader, or no longer
///   camera   azimuth, elevation [degree], distance [m], target [m]
///   done     command, at, frame, hash, kept: a command was carried out after frame `at` and left `frame`;
///            kept: the cloths are where they were. Of changes of settings, of handles and of seeking, one that
///            was overtaken by a newer one has no line.
///   state    frame, step, time [s], running, hash, lowest (y of the lowest point) [m], stretch,
///            energy [J], rest, ms (of the last frame), drawn (pictures so far). After each command,
///            and ten times per second while running.
///   message  severity, source, text, and file, line, column where there is a place
///   mended   source: what messages of that source complained of is over
///   reload   what ("scene", "shaders", "texture", "uniforms"), file; for a scene config and command, as settings
///   open     scene: another scene file
///   heat_map quantity ("off", "stretch", ...), fixed, and low, high where the range is fixed
///   overlays normals, pins, contacts, boxes: whether each is shown
///   intersections  frame, count, ms: another number of them than before
///   plots    visible, held
///   export   file: the plots' numbers were written
///   inspector visible, held
///   inspect  cloth, vertex: the inspector describes another vertex
///   window   width, height [screen units], scale
///   panels   visible
///   panel    name, open
///   help     visible
///   console  visible
///   copied   text: of the console, to the clipboard
///   palette  visible, and while it is: query, selected ("action pause", "set cloth.ks", "shader Phong",
///            "scene FILE", "preset silk", "panel Wind"), count of what the query means
///   focus    name: the control that has the keyboard; empty: none
///   hover    name: the control that the pointer is over; empty: none
///   active   name: the control that is held down, edited, or takes what is typed; empty: none
///   hint     text: keys to begin with; empty: the user has found them all
///   tooltip  control, text: the explanation of a control is shown
///   preset   name: a preset is being applied
///   preset_saved file
///   widget   name, x, y, width, height [screen units of the window]: where a control is drawn;
///            again when it has moved, and with width 0 when it has gone. Names are those of --set:
///            "cloth.ks" and "cloth.1.ks" are sliders, "cloth.ks box" the box to type in beside it,
///            "look.shader" a drop-down, "look.shader/Phong" an entry of its list.
///   exit     code: the last line
/// Hashes are 16 hexadecimal digits. Numbers of commands count from 1 (see simulation.h). A command with
/// "undoable": true keeps the state before it, for `restore`.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/viewer/timeline.h"
#include "percale/diagnostic.h"
#include "percale/parameters.h"
#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale::viewer {

/// Of the format described here.
inline constexpr int kLogVersion = 2;

/// One line under construction.
class LogLine {
 public:
  explicit LogLine(std::string_view event);
  LogLine& Text(std::string_view key, std::string_view text);
  LogLine& Number(std::string_view key, double number);
  LogLine& Flag(std::string_view key, bool flag);
  LogLine& Hash(std::string_view key, std::uint64_t hash);
  LogLine& Vector(std::string_view key, const Vec3& v);
  LogLine& Config(const Scene& scene);  ///< All settings, as the text of a scene file.
  /// `json` as it is.
  LogLine& Json(std::string_view key, std::string_view json);

  const std::string& text() const { return text_; }  ///< `,"event":"EVENT","KEY":VALUE...`

 private:
  std::string text_;
};

/// The line of a command, without its number: all that a replay needs, but for the settings of Apply.
LogLine DescribeCommand(const Command& command);

/// "/cloth/0/ks"; with an index below 0, that of every object: "/cloth/ks".
std::string ValuePath(const Parameter& parameter, int index);
/// The line of all settings at once.
LogLine DescribeSettings(const Scene& scene);
/// A line for each value that differs.
std::vector<LogLine> DescribeValues(const Scene& before, const Scene& after);

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
