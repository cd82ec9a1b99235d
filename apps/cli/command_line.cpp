// The only file that includes CLI11, which takes seconds to compile.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <set>

#include "apps/cli/figure_table.h"
#include "apps/cli/options.h"
#include "apps/cli/session.h"
#include "apps/cli/verify_cases.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"

namespace percale::cli {
namespace {

constexpr std::string_view kVerbs[] = {"view",  "simulate", "shot", "render", "figures", "replay",
                                       "check", "verify",   "info", "doctor", "bench",   "version"};

constexpr int kMostFrames = 100'000'000;
constexpr double kLongestTime = 1e6;  // s
constexpr int kMostThreads = 1024;
constexpr int kFinestSphere = 4096;
constexpr int kLargestPicture = 16384;

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 failed, or an output cannot be written; 2 wrong command line; 3 invalid input;\n"
    "4 the simulation diverged; 5 no graphics; 130 interrupted (what was done is kept).";

/// Throws with the message that follows the option's name.
[[noreturn]] void Refuse(const std::string& option, const std::string& expected, const std::string& found) {
  throw CLI::ValidationError(option, "expected " + expected + ", got " + Quote(found, 60));
}

double Number(const std::string& option, const std::string& text, double min, double max, const std::string& expected) {
  const auto number = ParseTypedNumber(text);
  if (!number || *number < min || *number > max) Refuse(option, expected, text);
  return *number;
}

int Whole(const std::string& option, const std::string& text, int min, int max) {
  const std::string expected = "a whole number " + std::to_string(min) + ".." + std::to_string(max);
  const double number = Number(option, text, min, max, expected);
  if (number != std::floor(number)) Refuse(option, expected, text);
  return static_cast<int>(number);
}

bool LooksWhole(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "a, b and c"
std::string List(std::span<const std::string_view> names, const std::string& last) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list += i == 0 ? "" : i + 1 < names.size() ? ", " : " " + last + " ";
    list += names[i];
  }
  return list;
}

/// Where the name is among those there are.
std::size_t Find(const std::string& option, const std::string& what, const std::string& name,
                 std::span<const std::string_view> names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw CLI::ValidationError(option, "there is no " + what + " " + Quote(name, 60) + DidYouMean(name, names) +
                                         "; there are " + List(names, "and"));
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<std::string_view> CaseNames() {
  std::vector<std::string_view> names;
  for (const VerifyCase& each : VerifyCases()) names.push_back(each.name);
  return names;
}

/// The words after `lead`, in lines of at most 100 characters.
std::string Wrapped(const std::string& lead, const std::vector<std::string_view>& words) {
  std::string text, line = lead;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = std::string(words[i]) + (i + 1 < words.size() ? ", " : "\n");
    if (line.size() + word.size() > 100) {
      text += line + "\n";
      line.clear();
    }
    line += word;
  }
  return text + line;
}

/// Adds the options of each kind to a verb. All verbs write into the same Options.
class Builder {
 public:
  Builder(Options& options, std::string& positional, std::string& flag)
      : options_(options), positional_(positional), flag_(flag) {}

  void Scene(CLI::App& app, bool severalFiles) {
    if (severalFiles) {
      Add(app, "FILE", "Files; without any, scene/pinned2.json of the project", options_.files, "Scene");
    } else {
      app.add_option("SCENE", positional_, "Scene file; default: scene/pinned2.json of the project")->group("Scene");
    }
    app.add_option("-f", flag_, "The same, as in the course")->type_name("FILE")->group("Scene");
    app.add_option("-r", options_.root,
                   "The project's folder, which holds shaders/ and scene/; default: searched for, from . to ../../..")
        ->type_name("DIR")
        ->group("Scene");
    Add(app, "--set",
        "Sets a parameter, such as --set cloth.ks=500 or --set cloth.1.ks=500; may be repeated, the later wins",
        options_.set, "Scene")
        ->type_name("PATH=VALUE");
    Add(app, "--preset",
        "Values of presets/NAME.json, or of a file NAME.json, for what the scene file does not state; may be "
        "repeated, the later wins. --set preset=NAME wins over the scene file as well",
        options_.presets, "Scene")
        ->type_name("NAME");
    app.add_flag("--print-config", options_.printConfig,
                 "Prints every parameter, its value and where that comes from, and ends")
        ->group("Scene");
    Threads(app, "Scene");
  }

  void Threads(CLI::App& app, const char* group) {
    Call(app, "--threads", "Threads; default: as many as there are cores. The result does not depend on it", "N", group,
         [this](const std::string& text) { options_.threads = Whole("--threads", text, 1, kMostThreads); });
  }

  void Sphere(CLI::App& app, const char* outputHelp) {
    Call(app, "-a", "Latitudes of drawn spheres, as in the course; default 40", "N", "Picture",
         [this](const std::string& text) { options_.latitudes = Whole("-a", text, 2, kFinestSphere); });
    const std::string help = "A whole number: longitudes of drawn spheres, as in the course; default 40" +
                             (outputHelp ? std::string(". Anything else: ") + outputHelp : std::string());
    const bool writes = outputHelp != nullptr;
    app.add_option_function<std::vector<std::string>>(
           "-o",
           [this, writes](const std::vector<std::string>& values) {
             for (const std::string& value : values) {
               if (LooksWhole(value) || !writes)
                 options_.longitudes = Whole("-o", value, 3, kFinestSphere);
               else if (value.empty())
                 Refuse("-o", "a whole number or the name of a file", value);
               else
                 options_.output = value;
             }
           },
           help)
        ->take_all()
        ->allow_extra_args(false)
        ->type_name(writes ? "N|FILE" : "N")
        ->group(writes ? "Output" : "Picture");
  }

  void Log(CLI::App& app) {
    app.add_option("LOG", positional_, "A session log that percale view --log has written")->group("Log");
    Threads(app, "Log");
    Call(app, "-o", "Writes the state after each frame and each thing that was done: .pc2, .obj, .ply or .csv", "FILE",
         "Output", [this](const std::string& text) {
           if (!CacheKindOf(TextPath(text))) Refuse("-o", "a file name that ends in .pc2, .obj, .ply or .csv", text);
           options_.output = text;
         });
  }

  void Length(CLI::App& app, const char* defaultHelp) {
    Call(app, "--frames", std::string("Runs so many frames; ") + defaultHelp, "N", "Length",
         [this](const std::string& text) { options_.frames = Whole("--frames", text, 0, kMostFrames); });
    Seconds(app, "Runs so long, in simulated seconds, rounded up to a whole frame");
    Rest(app);
  }

  void OneFrame(CLI::App& app) {
    Call(app, "--frame", "Which frame to show; default 0, the start", "N", "Length",
         [this](const std::string& text) { options_.frame = Whole("--frame", text, 0, kMostFrames); });
    Seconds(app, "The same by simulated time in seconds, rounded up to a whole frame");
    Rest(app);
  }

  void Progress(CLI::App& app) {
    Call(app, "--progress", "On stderr: bar, json (one object per line), or none; default: a bar on a terminal", "KIND",
         "Output", [this](const std::string& text) {
           if (text == "bar")
             options_.progress = ProgressKind::Bar;
           else if (text == "json")
             options_.progress = ProgressKind::Json;
           else if (text == "none")
             options_.progress = ProgressKind::None;
           else
             Refuse("--progress", "bar, json or none", text);
         });
  }

  void Picture(CLI::App& app) {
    app.add_option("--shader", options_.shader, "Name of a file shaders/NAME.frag; default: the scene's")
        ->type_name("NAME")
        ->group("Picture");
    app.add_option_function<std::vector<std::string>>(
           "--uniform", [this](const std::vector<std::string>& values) { Uniforms(values); },
           "Sets a parameter of the shader, such as --uniform shininess=64 or --uniform upper=1,0,0; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE")
        ->group("Picture");
    app.add_flag("--shader-defaults", options_.shaderDefaults,
                 "Leaves alone the values that the viewer has kept beside shaders, in shaders/NAME.json")
        ->group("Picture");
    Call(app, "--heat-map", "Colours the cloths by " + List(QuantityNames(), "or") + ", with a legend", "NAME",
         "Picture", [this](const std::string& text) {
           const std::size_t at = Find("--heat-map", "heat map", text, QuantityNames());
           options_.heatMap = static_cast<Quantity>(at);
         });
    Call(app, "--heat-range", "The values of the first and the last colour, such as 1,1.1; default: follows the values",
         "LOW,HIGH", "Picture", [this](const std::string& text) {
           const char* const expected = "two numbers LOW,HIGH, the second larger";
           const std::vector<std::string> parts = Split(text, ',');
           if (parts.size() != 2) Refuse("--heat-range", expected, text);
           const double low = Number("--heat-range", parts[0], -1e30, 1e30, expected);
           const double high = Number("--heat-range", parts[1], -1e30, 1e30, expected);
           if (low >= high) Refuse("--heat-range", expected, text);
           options_.heatRange = ValueRange{low, high};
         });
    std::vector<std::string_view> overlays;
    for (const OverlayInfo& overlay : AllOverlays()) overlays.push_back(overlay.name);
    Call(app, "--overlay", "Draws over the cloths " + List(overlays, "and") + ": one or more of them", "NAME,NAME,...",
         "Picture", [this, overlays](const std::string& text) {
           for (const std::string& part : Split(text, ',')) {
             const std::size_t at = Find("--overlay", "overlay", part, overlays);
             options_.overlays.*AllOverlays()[at].shown = true;
           }
         });
    Call(app, "--camera", "AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,DISTANCE, in degrees and metres: --camera 30,20,2.5",
         "A,E[,D]", "Picture", [this](const std::string& text) { Camera(text); });
    Call(app, "--target", "The point looked at, in metres: --target 0.5,0.5,0.5", "X,Y,Z", "Picture",
         [this](const std::string& text) {
           std::vector<double> numbers;
           for (const std::string& part : Split(text, ','))
             numbers.push_back(Number("--target", part, -1e6, 1e6, "three numbers X,Y,Z"));
           if (numbers.size() != 3) Refuse("--target", "three numbers X,Y,Z", text);
           options_.target = numbers;
         });
    Size(app);
    Call(app, "--samples",
         "Samples per pixel, which smooth edges: 1, 2, 4, 8 or 16; default 4, in the viewer 1 where the CPU draws", "N",
         "Picture", [this](const std::string& text) {
           const auto number = ParseTypedNumber(text);
           if (!number || (*number != 1 && *number != 2 && *number != 4 && *number != 8 && *number != 16)) {
             Refuse("--samples", "1, 2, 4, 8 or 16", text);
           }
           options_.samples = static_cast<int>(*number);
         });
  }

  void Size(CLI::App& app) {
    Call(app, "--size", "Width and height in pixels; default 1024x800, or as the picture that shot is given", "WxH",
         "Picture", [this](const std::string& text) {
           const std::vector<std::string> parts = Split(text, 'x');
           if (parts.size() != 2) Refuse("--size", "WIDTHxHEIGHT such as 1024x800", text);
           options_.sizeGiven = true;
           options_.width = Whole("--size", parts[0], 1, kLargestPicture);
           options_.height = Whole("--size", parts[1], 1, kLargestPicture);
         });
  }

  void Wireframe(CLI::App& app) {
    app.add_flag("--wireframe", options_.wireframe, "Draws the springs over the surface as well")->group("Picture");
  }

  void Folder(CLI::App& app, const std::string& standard) {
    Call(app, "-o", "The folder to write into; default: " + standard, "DIR", "Output", [this](const std::string& text) {
      if (text.empty()) Refuse("-o", "the name of a folder", text);
      options_.output = text;
    });
  }

  void Only(CLI::App& app) {
    Call(app, "--only", "Which figures to make, such as 19-22,31; default: all", "LIST", "Picture",
         [this](const std::string& text) {
           const std::string expected = Text("figures 1..%d such as 19-22,31", kFigureCount);
           std::set<int> figures;
           for (const std::string& part : Split(text, ',')) {
             const std::vector<std::string> ends = Split(part, '-');
             const auto number = [&](const std::string& end) {
               if (!LooksWhole(end)) Refuse("--only", expected, text);
               return static_cast<int>(Number("--only", end, 1, kFigureCount, expected));
             };
             const int first = number(ends.front()), last = number(ends.back());
             if (ends.size() > 2 || first > last) Refuse("--only", expected, text);
             for (int figure = first; figure <= last; ++figure) figures.insert(figure);
           }
           options_.figures.assign(figures.begin(), figures.end());
         });
  }

  void Cases(CLI::App& app) {
    Call(app, "--only", "Which cases to run, such as cantilever,catenary; default: all", "NAME,...", "Options",
         [this](const std::string& text) {
           const std::vector<std::string_view> names = CaseNames();
           std::set<std::size_t> wanted;
           for (const std::string& part : Split(text, ',')) wanted.insert(Find("--only", "case", part, names));
           options_.cases.clear();
           for (const std::size_t at : wanted) options_.cases.emplace_back(names[at]);
         });
  }

  void Viewer(CLI::App& app) {
    app.add_option("--log", options_.log, "Writes what happens in the viewer to a file, one line of JSON per event")
        ->type_name("FILE")
        ->group("Viewer");
    Call(app, "--history", "Memory for past frames, in MB; default 256, 0 keeps none", "MB", "Viewer",
         [this](const std::string& text) {
           options_.historyMegabytes = Number("--history", text, 0, 1e6, "a number of megabytes 0..1e6");
         });
    app.add_flag("--fresh", options_.fresh,
                 "Starts without what the viewer has kept from the last time, and keeps nothing")
        ->group("Viewer");
    Call(app, "--ui-scale", "Size of the viewer's text and controls, 0.5 to 4; default: as the display asks for", "S",
         "Viewer",
         [this](const std::string& text) { options_.uiScale = Number("--ui-scale", text, 0.5, 4, "a number 0.5..4"); });
    app.add_flag("--keys", options_.keys, "Prints the viewer's keys as a table, and ends")->group("Viewer");
  }

  template <class Function>
  CLI::Option* Call(CLI::App& app, const std::string& name, const std::string& help, const char* type,
                    const char* group, Function function) {
    return app.add_option_function<std::string>(name, function, help)->type_name(type)->group(group);
  }

  Options& options() { return options_; }

 private:
  CLI::Option* Add(CLI::App& app, const std::string& name, const std::string& help, std::vector<std::string>& values,
                   const char* group) {
    CLI::Option* option = app.add_option(name, values, help)->take_all()->group(group);
    if (name[0] == '-') option->allow_extra_args(false);
    return option;
  }

  void Seconds(CLI::App& app, const char* help) {
    Call(app, "--seconds", help, "S", "Length", [this](const std::string& text) {
      options_.seconds = Number("--seconds", text, 0, kLongestTime, "a number of seconds 0..1e6");
    });
  }

  void Rest(CLI::App& app) {
    app.add_flag("--until-rest", options_.untilRest,
                 "Runs until no point has moved more than 1 mm in a frame for 30 frames on end")
        ->group("Length");
    Call(app, "--limit", "The most that --until-rest runs, in simulated seconds; default 60", "S", "Length",
         [this](const std::string& text) {
           options_.limit = Number("--limit", text, 1e-9, kLongestTime, "a number of seconds above 0, at most 1e6");
         });
  }

  void Camera(const std::string& text) {
    const char* const expected =
        "AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,DISTANCE with an elevation -89..89 and a distance > 0";
    const std::vector<std::string> parts = Split(text, ',');
    if (parts.size() != 2 && parts.size() != 3) Refuse("--camera", expected, text);
    options_.azimuth = Number("--camera", parts[0], -1e6, 1e6, expected);
    options_.elevation = Number("--camera", parts[1], -89, 89, expected);
    if (parts.size() == 3) options_.distance = Number("--camera", parts[2], 1e-6, 1e6, expected);
  }

  void Uniforms(const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      const char* const expected = "NAME=NUMBER or NAME=R,G,B";
      const std::size_t equals = value.find('=');
      if (equals == std::string::npos || equals == 0) Refuse("--uniform", expected, value);
      UniformOption uniform;
      uniform.name = value.substr(0, equals);
      const std::string numbers = value.substr(equals + 1);
      if (numbers == "true" || numbers == "false") {
        uniform.numbers.push_back(numbers == "true" ? 1.0f : 0.0f);
      } else {
        for (const std::string& part : Split(numbers, ',')) {
          uniform.numbers.push_back(static_cast<float>(Number("--uniform", part, -1e30, 1e30, expected)));
        }
      }
      if (uniform.numbers.size() != 1 && uniform.numbers.size() != 3) Refuse("--uniform", expected, value);
      options_.uniforms.push_back(std::move(uniform));
    }
  }

  Options& options_;
  std::string& positional_;
  std::string& flag_;
};

void AddVerbs(CLI::App& app, Builder& builder) {
  const auto verb = [&](Verb v, const char* summary, const std::string& examples) -> CLI::App& {
    CLI::App* sub = app.add_subcommand(std::string(VerbName(v)), summary);
    sub->footer("Examples:\n" + examples + "\n" + kExitCodes);
    sub->group("Verbs");
    sub->callback([&builder, v] { builder.options().verb = v; });
    return *sub;
  };

  CLI::App& view = verb(Verb::View, "Opens the interactive viewer",
                        "  percale view scene/sphere.json\n"
                        "  percale scene/sphere.json            the same\n"
                        "  percale -f scene/sphere.json -a 128 -o 128\n");
  builder.Scene(view, false);
  builder.Sphere(view, nullptr);
  builder.Picture(view);
  builder.Viewer(view);

  CLI::App& simulate =
      verb(Verb::Simulate, "Runs a scene without drawing, prints a summary, writes caches",
           "  percale simulate scene/pinned2.json --frames 300 --every 100 -o p.csv\n"
           "  percale simulate scene/sphere.json --until-rest -o sphere.obj\n"
           "  percale simulate scene/pinned4.json --seconds 5 -o film.pc2\n"
           "  percale simulate scene/pinned2.json --set cloth.ks=500 --progress json\n"
           "  percale simulate scene/sphere.json --seconds 3 --csv energies.csv\n"
           "Which frames are written: with --every K frame 0 (the start), each K-th and the last; without it\n"
           "the last one, but all from 0 on for .pc2. A .pc2 has evenly spaced frames only, so that with\n"
           "--every the last one is left out where it does not fall on a K-th; its mesh is beside it as\n"
           "FILE.obj. Several .obj or .ply are numbered by frame: name_0100.obj.\n"
           "Of --frames (or --seconds) and --until-rest, what comes first ends the run.\n");
  builder.Scene(simulate, false);
  builder.Length(simulate, "default 300");
  builder.Sphere(simulate, "the cache to write, by its ending: .csv, .obj, .ply or .pc2");
  builder.Call(
      simulate, "--every", "Writes each N-th frame, see below", "N", "Output",
      [&builder](const std::string& text) { builder.options().every = Whole("--every", text, 1, kMostFrames); });
  simulate
      .add_option("--csv", builder.options().csv,
                  "Writes what each frame did as a table: energies, stretch, contacts, times of the stages")
      ->type_name("FILE")
      ->group("Output");
  builder.Progress(simulate);

  CLI::App& shot = verb(Verb::Shot, "Makes one picture (PNG)",
                        "  percale shot scene/sphere.json --until-rest --shader Phong -o a.png\n"
                        "  percale shot scene/pinned2.json --frame 120 --camera 30,20,2.5 --size 1920x1080 -o b.png\n"
                        "  percale shot scene/sphere.json --frame 90 --shader Bump -a 128 -o 128 -o c.png\n"
                        "  percale shot scene/sphere.json --until-rest --heat-map stretch --overlay pins -o d.png\n");
  builder.Scene(shot, false);
  builder.OneFrame(shot);
  builder.Picture(shot);
  builder.Wireframe(shot);
  builder.Sphere(shot, "the picture to write; default: the scene's name with .png, in the current folder");
  builder.Progress(shot);

  CLI::App& render =
      verb(Verb::Render, "Makes a video (mp4), or numbered pictures",
           "  percale render scene/sphere.json --seconds 4 --shader Phong -o sphere.mp4\n"
           "  percale render scene/pinned2.json --frames 300 --fps 60 --size 1920x1080\n"
           "  percale render scene/plane.json -o pictures/                            numbered pictures\n"
           "The video plays in real time: at 90 frames per second of the scene and 30 of the video it shows each\n"
           "third frame. Without ffmpeg the video becomes a folder of numbered pictures.\n");
  builder.Scene(render, false);
  builder.Length(render, "default 300");
  builder.Picture(render);
  builder.Wireframe(render);
  builder.Sphere(render,
                 "NAME.mp4, or a new folder for pictures; default: the scene's name with .mp4, in the current folder");
  builder.Call(render, "--fps", "Pictures per second of video; default 30", "N", "Output",
               [&builder](const std::string& text) {
                 builder.options().framesPerSecond = Number("--fps", text, 0.1, 1000, "a number 0.1..1000");
               });
  builder.Progress(render);

  CLI::App& replay =
      verb(Verb::Replay, "Repeats a session of the viewer, and compares every state to the last bit",
           "  percale view --log session.log\n"
           "  percale replay session.log\n"
           "  percale replay session.log -o session.pc2         all that was seen, to be judged or rendered\n");
  builder.Log(replay);
  CLI::App& figures = verb(
      Verb::Figures, "Makes all 49 figures of the course's write-up, and a page that shows and measures them",
      "  percale figures\n"
      "  percale figures --only 19-22,31 --size 512x400 -o few\n"
      "Writes figure_01.png to figure_49.png, index.html (one page that holds all of it) and figures.json. What is\n"
      "in the folder already and would come out the same is kept. Claims are judged once all figures are there.\n");
  figures.add_option("-r", builder.options().root, "The project's folder")->type_name("DIR")->group("Output");
  builder.Folder(figures, "figures");
  builder.Only(figures);
  builder.Size(figures);
  builder.Threads(figures, "Output");
  builder.Progress(figures);

  CLI::App& check =
      verb(Verb::Check, "Reports every problem of scene files, or where cloth passes through cloth",
           "  percale check scene/*.json\n"
           "  percale check --schema > percale.schema.json      for editors\n"
           "  percale check --intersections film.pc2 mesh.obj scene/layers.json\n"
           "Intersections are looked for in the frames of .pc2 (with its mesh beside it), .obj and .ply;\n"
           "name.obj stands for name_0001.obj and so on as well. Of a scene the start is judged, of a\n"
           "checkpoint or picture the state in it. The test is exact: touching counts. The exit code is\n"
           "1 if there are any.\n");
  builder.Scene(check, true);
  check.add_flag("--intersections", builder.options().intersections,
                 "Counts, frame by frame, the edges that pass through triangles");
  check.add_flag("--schema", builder.options().schema, "Prints the JSON schema of scene files, and ends");

  CLI::App& verify = verb(Verb::Verify, "Measures the fabric engine against closed forms of mechanics",
                          "  percale verify\n"
                          "  percale verify --only cantilever,catenary -o report\n"
                          "  percale verify --fine                               how the errors shrink; minutes\n"
                          "  percale verify --json > physics.json\n"
                          "Prints case, measured, expected, error, gate and verdict, and writes verify.html, one page\n"
                          "with plots. A gate that does not hold makes the exit code 1.\n" +
                              Wrapped("The cases: ", CaseNames()));
  builder.Folder(verify, "verify");
  builder.Cases(verify);
  verify.add_flag("--fine", builder.options().fine, "Runs cases again with finer meshes and shorter steps")
      ->group("Options");
  verify.add_flag("--json", builder.options().json, "One JSON object instead of the table")->group("Options");
  builder.Threads(verify, "Options");
  builder.Progress(verify);

  CLI::App& info = verb(Verb::Info, "Tells what scenes or caches hold",
                        "  percale info scene/pinned2.json\n"
                        "  percale info film.pc2 p.csv mesh.obj\n");
  builder.Scene(info, true);

  CLI::App& doctor = verb(Verb::Doctor, "Tells what this machine offers, and what is missing", "  percale doctor\n");
  doctor.add_option("-r", builder.options().root, "The project's folder")->type_name("DIR");

  CLI::App& bench =
      verb(Verb::Bench, "Measures speed against the textbook program",
           "  percale bench springs\n"
           "  percale bench springs --sizes 50 --threads 2\n"
           "  percale bench springs --json > speed.json\n"
           "  percale bench fabric\n"
           "  percale bench fabric --sizes 32 -o report\n"
           "  percale bench contact --sizes 100\n"
           "  percale bench springs -o report\n"
           "-o DIR keeps what was measured as NAME.txt and NAME.json. fabric always does, in benchmarks/ by\n"
           "default, with fabric.html, one page with plots, and two of them as .svg.\n");
  bench.add_option("NAME", builder.options().benchmark, "Which: springs (default), fabric, contact");
  bench.add_option("-r", builder.options().root, "The project's folder")->type_name("DIR");
  builder.Call(
      bench, "--threads", "Threads of the many-threaded runs; default: as many as there are cores", "N", "Options",
      [&builder](const std::string& text) { builder.options().threads = Whole("--threads", text, 1, kMostThreads); });
  builder.Call(bench, "--sizes", "Points along a side of the sheet; default 50,100,200 (springs), 32 to 1000 (fabric)",
               "N,N,...", "Options", [&builder](const std::string& text) {
                 for (const std::string& part : Split(text, ','))
                   builder.options().sizes.push_back(Whole("--sizes", part, 3, 2000));
               });
  builder.Call(bench, "--frames", "Frames that are timed, from the start; default: fewer for larger sheets", "N",
               "Options",
               [&builder](const std::string& text) { builder.options().frames = Whole("--frames", text, 1, 100000); });
  bench.add_flag("--json", builder.options().json, "One JSON object instead of tables")->group("Options");
  builder.Folder(bench, "benchmarks (fabric), none (springs, contact)");

  verb(Verb::Version, "Prints the version", "  percale version\n");
}

std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// `verb` is the one that was given, or null.
std::string UnknownArgument(const CLI::App& app, const CLI::App* verb, const std::string& argument) {
  if (argument.empty() || argument[0] != '-') {
    return "unexpected argument " + Quote(argument, 60) + "; a file name with spaces needs quotes";
  }
  const std::string name = argument.substr(0, argument.find('='));
  std::string owners;
  for (const CLI::App* other : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::vector<std::string> theirs = OptionNames(*other);
    if (std::find(theirs.begin(), theirs.end(), name) == theirs.end()) continue;
    owners += (owners.empty() ? "" : ", ") + other->get_name();
  }
  if (!owners.empty()) {
    return name + (verb ? " is no option of " + verb->get_name() + "; it belongs to " + owners
                        : " needs a verb before it: " + owners);
  }
  const std::vector<std::string> names = OptionNames(verb ? *verb : app);
  const std::vector<std::string_view> views(names.begin(), names.end());
  return "unknown option " + name + DidYouMean(name, views);
}

int UsageError(const std::string& message, const std::string& verb) {
  std::fprintf(stderr, "percale: error: %s\nTry: percale %s%s--help\n", message.c_str(), verb.c_str(),
               verb.empty() ? "" : " ");
  return kUsage;
}

std::string VerbList() {
  std::string list;
  for (const std::string_view verb : kVerbs) list += (list.empty() ? "" : ", ") + std::string(verb);
  return list;
}

/// What is wrong between options, or nothing.
std::string Conflict(const Options& o) {
  if (o.frames && o.seconds) return "--frames and --seconds both say how long to run; give one";
  if (o.frame && (o.seconds || o.untilRest)) return "--frame, --seconds and --until-rest each name a moment; give one";
  if (o.verb == Verb::Shot && o.seconds && o.untilRest)
    return "--seconds and --until-rest each name a moment; give one";
  if (o.every && o.output.empty()) return "--every says which frames go into a file; name it with -o FILE";
  return {};
}

}  // namespace

std::string_view VerbName(Verb verb) {
  return kVerbs[static_cast<std::size_t>(verb)];
}

std::variant<Options, int> ParseCommandLine(const std::vector<std::string>& arguments) {
  std::vector<std::string> rest = arguments;
  if (!rest.empty() && rest[0] == "help") {  // percale help [VERB]
    rest.erase(rest.begin());
    if (!rest.empty() && std::find(std::begin(kVerbs), std::end(kVerbs), rest[0]) == std::end(kVerbs)) {
      return UsageError(
          "there is no verb " + Quote(rest[0], 60) + DidYouMean(rest[0], kVerbs) + "; the verbs are " + VerbList(), {});
    }
    rest.insert(rest.begin() + (rest.empty() ? 0 : 1), "--help");
  }

  Options options;
  std::string positional, flag;
  CLI::App app("Percale, a cloth simulator. Without a verb: the viewer; percale SCENE = percale view SCENE.",
               "percale");
  app.option_defaults()->take_last();
  app.set_help_flag("-h,--help", "Prints this, or with a verb what it takes, and ends");
  bool version = false;
  app.add_flag("--version", version, "Prints the version, and ends");
  app.get_formatter()->column_width(28);
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.require_subcommand(0, 1);
  app.footer(std::string("\npercale VERB --help tells what a verb takes, with examples.\n") + kExitCodes);

  Builder builder(options, positional, flag);
  builder.Scene(app, false);
  builder.Sphere(app, nullptr);
  builder.Picture(app);
  builder.Viewer(app);
  AddVerbs(app, builder);

  std::string verb;
  try {
    std::vector<std::string> reversed(rest.rbegin(), rest.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    const std::string help = app.help();
    std::fwrite(help.data(), 1, help.size(), stdout);
    return kDone;
  } catch (const CLI::ParseError& error) {
    const auto subs = app.get_subcommands();
    if (!subs.empty()) verb = subs[0]->get_name();
    const std::vector<std::string> extras = app.remaining(true);
    if (!positional.empty() && subs.empty() && !extras.empty() && !Nearest(positional, kVerbs).empty()) {
      return UsageError("there is no verb " + Quote(positional, 60) + DidYouMean(positional, kVerbs), {});
    }
    if (dynamic_cast<const CLI::ExtrasError*>(&error) && !extras.empty())
      return UsageError(UnknownArgument(app, subs.empty() ? nullptr : subs[0], extras[0]), verb);
    return UsageError(error.what(), verb);
  }

  if (version) options.verb = Verb::Version;
  const bool verbGiven = !app.get_subcommands().empty();
  if (verbGiven) verb = VerbName(options.verb);
  if (!flag.empty() && !positional.empty() && flag != positional) {
    return UsageError("two scenes are given, " + Quote(positional, 60) + " and -f " + Quote(flag, 60) + "; give one",
                      verb);
  }
  options.scene = flag.empty() ? positional : flag;
  options.bare = !verbGiven && options.scene.empty() && !version;
  if (options.verb == Verb::Check || options.verb == Verb::Info) {
    if (!options.scene.empty()) options.files.push_back(options.scene);
  }
  // A word that is neither a verb nor a file.
  if (!verbGiven && !options.scene.empty() && flag.empty() &&
      options.scene.find_first_of("./\\") == std::string::npos) {
    std::error_code ignored;
    if (!std::filesystem::exists(TextPath(options.scene), ignored)) {
      return UsageError("there is no verb and no scene file " + Quote(options.scene, 60) +
                            DidYouMean(options.scene, kVerbs) + "; the verbs are " + VerbList(),
                        {});
    }
  }
  if (const std::string conflict = Conflict(options); !conflict.empty()) return UsageError(conflict, verb);
  return options;
}

}  // namespace percale::cli
