#pragma once
/// \file
/// What the command line says, as plain data; and the program's exit codes.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "render/heat_scale.h"
#include "render/overlays.h"

namespace percale::cli {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,        ///< A check or gate did not hold, or an output could not be written.
  kUsage = 2,         ///< The command line is wrong.
  kInvalid = 3,       ///< A scene or another input is wrong.
  kDiverged = 4,      ///< The numbers of the simulation grew out of bounds.
  kNoGraphics = 5,    ///< There is no OpenGL, or no display for a window.
  kInterrupted = 130  ///< Ctrl+C; what was done is kept.
};

enum class Verb { View, Simulate, Shot, Render, Figures, Replay, Check, Verify, Info, Doctor, Bench, Version };
enum class ProgressKind { Automatic, Bar, Json, None };

/// A parameter of a shader from the command line.
struct UniformOption {
  std::string name;            ///< With or without "u_".
  std::vector<float> numbers;  ///< One, or three of a vector.
};

struct Options {
  Verb verb = Verb::View;
  bool bare = false;  ///< Neither verb nor scene was named.

  std::string scene;                 ///< File as given; empty: the default scene.
  std::vector<std::string> files;    ///< Of check and info.
  std::string root;                  ///< -r; empty: search for it.
  std::vector<std::string> presets;  ///< --preset, in order: below the scene file.
  std::vector<std::string> set;      ///< "PATH=VALUE" or "preset=NAME", in order: above it.
  bool printConfig = false;
  int threads = 0;  ///< 0: as many as there are cores.
  ProgressKind progress = ProgressKind::Automatic;

  std::string output;  ///< -o with anything but a whole number; empty: none.
  std::optional<int> frames;
  std::optional<double> seconds;  ///< [s]
  bool untilRest = false;
  double limit = 60;  ///< Of untilRest, simulated [s].
  std::optional<int> every;
  std::string csv;           ///< simulate --csv; empty: none.
  std::optional<int> frame;  ///< Of shot.

  std::optional<int> latitudes, longitudes;  ///< -a, and -o with a whole number; none: 40, or the picture's.
  int width = 1024;                          ///< [pixel]
  int height = 800;                          ///< [pixel]
  bool sizeGiven = false;                    ///< --size
  std::optional<int> samples;                ///< Per pixel; none: 4, or for the viewer what the card does well.
  double framesPerSecond = 30;               ///< Of a video.
  std::string shader;                        ///< Empty: the scene's.
  std::vector<UniformOption> uniforms;
  bool shaderDefaults = false;                         ///< Leave alone what the viewer has kept beside the shaders.
  std::optional<Quantity> heatMap;                     ///< --heat-map; none: off, or the picture's.
  std::optional<ValueRange> heatRange;                 ///< --heat-range
  Overlays overlays;                                   ///< --overlay
  std::optional<double> azimuth, elevation, distance;  ///< --camera [degree, degree, m]
  std::optional<std::vector<double>> target;           ///< --target, three numbers [m]

  bool wireframe = false;  ///< --wireframe: the springs over the surface.

  std::string log;                ///< view --log
  double historyMegabytes = 256;  ///< view --history
  bool keys = false;              ///< view --keys
  bool fresh = false;             ///< view --fresh
  std::optional<double> uiScale;  ///< view --ui-scale

  std::vector<int> figures;  ///< figures --only, ascending; empty: all.

  std::vector<std::string> cases;  ///< verify --only, in the order of the list; empty: all.
  bool fine = false;               ///< verify --fine

  bool schema = false;         ///< check --schema
  bool intersections = false;  ///< check --intersections
  std::string benchmark;       ///< bench NAME; empty: springs.
  std::vector<int> sizes;      ///< bench --sizes
  bool json = false;           ///< bench --json, verify --json
};

/// Reads the command line, UTF-8, without the program's name. Help and version are printed to
/// stdout, errors to stderr; then the result is the exit code.
std::variant<Options, int> ParseCommandLine(const std::vector<std::string>& arguments);

/// The name of a verb as it is typed.
std::string_view VerbName(Verb verb);

}  // namespace percale::cli
