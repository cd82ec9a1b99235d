#include "apps/cli/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <system_error>

#include "apps/cli/run.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "percale/scene_file.h"
#include "render/shader_values.h"
#include "render/video.h"
#include "render/view_file.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

/// Compression of single pictures: nearly as small as 9, much faster.
constexpr int kPngLevel = 6;

}  // namespace

percale::View MakeView(const Options& options, const Scene& scene, const std::optional<percale::View>& picture) {
  const percale::View plain = percale::View::ForScene(SeenScene(options, scene));
  percale::View view = picture.value_or(plain);
  view.look = plain.look;
  view.camera = plain.camera;
  if (options.latitudes) view.sphereLatitudes = *options.latitudes;
  if (options.longitudes) view.sphereLongitudes = *options.longitudes;
  if (options.heatMap) view.heatMap = {*options.heatMap, {}};  // another quantity has another range
  if (options.heatRange) view.heatMap.range = options.heatRange;
  for (const OverlayInfo& overlay : AllOverlays()) view.overlays.*overlay.shown |= options.overlays.*overlay.shown;
  view.wireframe |= options.wireframe;
  return view;
}

int ApplyUniforms(const Options& options, std::span<const ShaderParameter> parameters, percale::View& view) {
  std::vector<std::string_view> names;
  for (const ShaderParameter& parameter : parameters) names.push_back(parameter.name);
  for (const UniformOption& uniform : options.uniforms) {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const ShaderParameter& p) {
      return p.name == uniform.name || p.name == "u_" + uniform.name;
    });
    if (found == parameters.end()) {
      std::string list;
      for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
      std::string near = DidYouMean(uniform.name, names);
      if (near.empty()) near = DidYouMean("u_" + uniform.name, names);
      PrintError("--uniform: the shader " + view.look.shader + " has no parameter " + Quote(uniform.name, 60) + near +
                 (list.empty() ? "; it has none" : "; it has " + list));
      return kUsage;
    }
    const bool vector = found->type == ShaderParameter::Type::Vector;
    if (uniform.numbers.size() != (vector ? 3u : 1u)) {
      PrintError("--uniform: " + found->name + " takes " + (vector ? "three numbers R,G,B" : "one number") + ", got " +
                 std::to_string(uniform.numbers.size()));
      return kUsage;
    }
    const bool whole = found->type == ShaderParameter::Type::Int || found->type == ShaderParameter::Type::Bool;
    for (const float number : uniform.numbers) {
      if (number < found->min || number > found->max || (whole && number != std::floor(number))) {
        PrintError("--uniform: " + found->name + ": expected a " + (whole ? "whole " : "") + "number " +
                   FormatNumber(double(found->min)) + ".." + FormatNumber(double(found->max)) + ", got " +
                   FormatNumber(double(number)));
        return kUsage;
      }
    }
    UniformValue value{};
    std::copy(uniform.numbers.begin(), uniform.numbers.end(), value.begin());
    view.uniforms[found->name] = value;
  }
  return kDone;
}

Diagnostics ApplyKeptUniforms(const Options& options, const Session& session, const fs::path& root,
                              std::span<const ShaderParameter> parameters, percale::View& view) {
  if (options.shaderDefaults || session.view) return {};
  const auto kept = LoadShaderValues(ShaderValuesFile(root / "shaders", view.look.shader), parameters);
  if (kept) view.uniforms = *kept;
  return kept.diagnostics();
}

std::variant<Studio, int> OpenStudio(const Options& options, const Session& session) {
  const auto root = FindRoot(options.root);
  if (!root) {
    PrintDiagnostics(root.diagnostics());
    return kFailed;
  }
  percale::View view = MakeView(options, session.scene, session.view);
  const std::vector<std::string> shaders = ListShaders(*root / "shaders");
  if (std::find(shaders.begin(), shaders.end(), view.look.shader) == shaders.end()) {
    const std::vector<std::string_view> names(shaders.begin(), shaders.end());
    std::string list;
    for (const std::string& name : shaders) list += (list.empty() ? "" : ", ") + name;
    PrintError((options.shader.empty() ? PathText(session.file) + ": /look/shader" : std::string("--shader")) +
               ": there is no shader " + Quote(view.look.shader, 60) + DidYouMean(view.look.shader, names) +
               "; the shaders are " + list);
    return options.shader.empty() ? kInvalid : kUsage;
  }
  bool noGraphics = false;
  auto painter = Painter::Open(
      {.root = *root, .width = options.width, .height = options.height, .samples = options.samples.value_or(4)},
      &noGraphics);
  if (!painter) {
    PrintDiagnostics(painter.diagnostics());
    return noGraphics ? kNoGraphics : kFailed;
  }
  PrintDiagnostics(painter.diagnostics());
  const Diagnostics kept =
      ApplyKeptUniforms(options, session, *root, painter->shaders().Parameters(view.look.shader), view);
  PrintDiagnostics(kept);
  if (HasErrors(kept)) return kInvalid;
  if (const int code = ApplyUniforms(options, painter->shaders().Parameters(view.look.shader), view); code != kDone)
    return code;
  // Errors are told with the first picture, which they prevent.
  const Diagnostics& problems = painter->shaders().Problems(view.look.shader);
  if (!HasErrors(problems)) PrintDiagnostics(problems);
  return Studio{std::move(*painter), std::move(view), *root};
}

std::optional<Image> Paint(Studio& studio, const World& world) {
  auto image = studio.painter.Paint(world, studio.view);
  PrintDiagnostics(image.diagnostics());
  if (!image) return std::nullopt;
  return std::move(*image);
}

Status SavePicture(const fs::path& file, const Image& image, const fs::path& root, const Scene& scene,
                   const percale::View& view, int frame, std::vector<PngText> more, const WorldState* state) {
  PngOptions png;
  png.level = kPngLevel;
  png.text = DescribePicture(scene, view, frame, state, root);
  png.text.insert(png.text.begin(), {"Software", std::string("Percale ") + PERCALE_VERSION});
  png.text.insert(png.text.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return WritePng(file, image, png);
}

int WritePicture(Studio& studio, const World& world, const Session& session, const fs::path& file) {
  const auto image = Paint(studio, world);
  if (!image) return kInvalid;
  // From the start there is a way to the frame; from a state there is none without it.
  WorldState state;
  if (session.state) world.Save(state);
  const Status status = SavePicture(file, *image, studio.root, world.scene(), studio.view, world.report().frame, {},
                                    session.state ? &state : nullptr);
  PrintDiagnostics(status.diagnostics());
  return status ? kDone : kFailed;
}

fs::path DefaultOutput(const Session& session, const char* extension) {
  fs::path name = session.file.stem();
  name += extension;
  return name;
}

int CheckWritable(const fs::path& file) {
  const auto probe = AtomicFile::Create(file);
  if (probe) return kDone;
  PrintDiagnostics(probe.diagnostics());
  return kFailed;
}

int MakeWritable(const fs::path& folder, const std::string& name) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (!code) return CheckWritable(folder / name);
  PrintError("-o: the folder " + ShellWord(PathText(folder)) + " cannot be made: " + code.message());
  return kFailed;
}

int Film(Studio& studio, World& world, const Options& options, const Session& session, const fs::path& file,
         int defaultFrames) {
  VideoSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.framesPerSecond = options.framesPerSecond;
  auto video = VideoWriter::Open(file, settings);
  PrintDiagnostics(video.diagnostics());
  if (!video) return kFailed;

  // Picture k shows the frame of its time, so that the film plays in real time. The state at the very
  // end of a run of stated length would be the first picture of what comes after it.
  const double framesPerPicture = world.scene().simulation.framesPerSecond / options.framesPerSecond;
  double pictures = 0;
  int code = kDone;
  const RunPlan plan = PlanRun(options, world, defaultFrames);
  const RunEnd end = Run(world, plan, options, session, [&] {
    const int frame = world.report().frame - plan.firstFrame;
    if (frame > 0 && world.report().frame == plan.frames && !plan.untilRest) return int(kDone);
    std::optional<Image> image;
    while (std::floor(pictures * framesPerPicture + 1e-9) <= frame) {
      if (!image) image = Paint(studio, world);
      if (!image) return code = kInvalid;
      if (Status status = video->Add(*image); !status) {
        PrintDiagnostics(status.diagnostics());
        return code = kFailed;
      }
      ++pictures;
    }
    return int(kDone);
  });
  if (end == RunEnd::Failed) return code;
  const auto summary = video->Finish();
  PrintDiagnostics(summary.diagnostics());
  if (!summary) return kFailed;
  std::printf("%s: %d pictures, %.3g s at %.4g per second%s\n", PathText(summary->path).c_str(), summary->frames,
              summary->frames / options.framesPerSecond, options.framesPerSecond,
              summary->isFolder ? ", numbered PNG files in a folder" : "");
  return CodeOf(end);
}

}  // namespace percale::cli
