#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "apps/cli/figure_page.h"
#include "apps/cli/figure_studies.h"
#include "apps/cli/figure_table.h"
#include "apps/cli/measurements.h"
#include "apps/cli/pictures.h"
#include "apps/cli/platform.h"
#include "apps/cli/progress.h"
#include "apps/cli/verbs.h"
#include "apps/cli/workers.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "percale/parameters.h"
#include "render/shader_values.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyword = "percale:figure";  // of the text in a PNG file that holds its key
constexpr int kBruteWeight = 30;                    // a frame of brute force takes as long as so many others
constexpr auto kPatience = std::chrono::milliseconds(100);

/// FNV-1a: tells whether a text is the same as it was, in 16 digits.
std::string Fingerprint(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return Text("%016llx", static_cast<unsigned long long>(hash));
}

std::string FileBytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

/// Of the program itself: another build may measure and draw otherwise, whatever its version.
std::string ProgramFingerprint() {
  return Fingerprint(FileBytes(ExecutablePath()));
}

/// Of all shaders and textures: another one, and pictures are out of date. Values that the viewer keeps beside
/// the shaders do not count here.
std::string AssetsFingerprint(const fs::path& root) {
  std::vector<fs::path> files;
  for (const char* folder : {"shaders", "textures"}) {
    std::error_code error;  // What cannot be read has no part in the pictures either.
    constexpr auto kSkip = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator entry(root / folder, kSkip, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().extension() != ".json") files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  std::string all;
  for (const fs::path& file : files) all += PathText(file.filename()) + FileBytes(file);
  return Fingerprint(all);
}

/// "pinned2 cloth.ks=500" as the name of a file.
std::string FileName(const std::string& name) {
  std::string file;
  for (const char c : name) file += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' ? c : '_';
  return file;
}

/// "cloth.density=50" as people read it: the parameter, and its value with the unit.
std::pair<std::string, std::string> ParameterText(const std::string& assignment) {
  const std::string path = assignment.substr(0, assignment.find('=')), value = assignment.substr(path.size() + 1);
  std::string text = value;
  for (const Parameter& parameter : Parameters()) {
    if (path == std::string(parameter.group) + "." + std::string(parameter.name) && !parameter.unit.empty())
      text += " " + std::string(parameter.unit);
  }
  if (path == "cloth.density") text += Text(" (%.6g g/cm² in the course)", ParseNumber(value).value_or(0) / 10);
  return {path, text};
}

/// A figure with all that its picture takes.
struct Drawing {
  const Figure* figure = nullptr;
  Options shot;  // what `percale shot` would be told
  percale::View view;
  std::string key;
  bool wanted = false;
  bool current = false;  // the picture is in the folder, as it would be made now
};

/// A simulation that figures and studies share.
struct CourseNeed {
  int frames = 0;
  std::set<int> shapes;  // frames that are to be drawn
};

/// Makes the pictures and the measurements into a folder, where they are kept for the next time.
class Gallery {
 public:
  Gallery(const Options& options, fs::path root, fs::path folder, Painter painter)
      : options_(options),
        root_(std::move(root)),
        folder_(std::move(folder)),
        painter_(std::move(painter)),
        maker_(Text("percale %s (%s)", PERCALE_VERSION, ProgramFingerprint().c_str())) {}

  /// Loads the scenes, and looks at what is in the folder already. Returns the exit code, as do the others.
  int Prepare();
  /// Simulates, measures and draws what is missing.
  int Make();
  int WritePage();

 private:
  bool WantsAll() const { return options_.figures.empty(); }
  Result<Scene> LoadCourse(const std::string& name) const;
  std::string Key(const std::string& name) const;
  fs::path TableFile(const std::string& name) const { return folder_ / "measured" / (FileName(name) + ".csv"); }
  /// Whether the folder holds what was measured, up to that frame of a course; then it is in measured_.
  bool ReadMeasured(const std::string& name, int frames);
  int Keep(const std::string& name, Table table);

  int PrepareFigure(const Figure& figure, const std::string& assets);
  std::vector<Work> MissingWorks();
  int Take(const FinishedWork& work);
  int Draw(Drawing& drawing, const ClothShapes& shape);
  int StudyPictures();
  ShownFigure Show(const Drawing& drawing) const;
  void PrintSummary(const FigurePage& page) const;

  const Options& options_;
  fs::path root_, folder_;
  Painter painter_;
  const std::string maker_;              // which build of the program
  std::map<std::string, Scene> scenes_;  // by the course's name
  std::vector<Drawing> drawings_;        // by number
  Measured measured_;
  int made_ = 0;
};

Result<Scene> Gallery::LoadCourse(const std::string& name) const {
  std::vector<std::string> words = CourseArguments(name);
  auto scene = LoadScene(root_ / words[0]);
  if (!scene) return scene.diagnostics();
  for (std::size_t i = 2; i < words.size(); i += 2) {  // --set PATH=VALUE
    if (const auto paths = ApplyAssignment(*scene, words[i]); !paths) return paths.diagnostics();
  }
  return std::move(*scene);
}

/// What a course or study is measured from.
std::string Gallery::Key(const std::string& name) const {
  std::string from;
  if (const auto scene = scenes_.find(name); scene != scenes_.end()) {
    from = FormatScene(scene->second);
  } else {  // a study of several scenes, some of their pictures as well
    for (const auto& each : scenes_) from += FormatScene(each.second);
    if (name == kSphereStudy || name == kLightStudy) {
      for (const Drawing& drawing : drawings_) from += drawing.key;
    }
  }
  return maker_ + ", " + name + ", " + Fingerprint(from);
}

bool Gallery::ReadMeasured(const std::string& name, int frames) {
  auto table = ReadTable(TableFile(name), Key(name));
  if (!table || int(table->rows.size()) <= frames) return false;
  measured_[name] = std::move(*table);
  return true;
}

int Gallery::Keep(const std::string& name, Table table) {
  const auto known = measured_.find(name);
  const std::size_t rows = known != measured_.end() ? known->second.rows.size() : 0;
  if (table.rows.size() <= rows) return kDone;
  const Status status = WriteTable(TableFile(name), Key(name), table);
  PrintDiagnostics(status.diagnostics());
  measured_[name] = std::move(table);
  return status ? kDone : kFailed;
}

int Gallery::PrepareFigure(const Figure& figure, const std::string& assets) {
  std::vector<std::string> arguments = {"shot"};
  for (std::string& argument : ShotArguments(figure)) arguments.push_back(std::move(argument));
  const auto parsed = ParseCommandLine(arguments);
  if (std::holds_alternative<int>(parsed)) return std::get<int>(parsed);
  Drawing drawing;
  drawing.figure = &figure;
  drawing.shot = std::get<Options>(parsed);
  Scene scene = scenes_.at(figure.course());
  scene.look.shader = drawing.shot.shader;
  drawing.view = MakeView(drawing.shot, scene);
  if (const int code = ApplyUniforms(drawing.shot, painter_.shaders().Parameters(drawing.shot.shader), drawing.view);
      code != kDone)
    return code;
  std::string all = FormatScene(scene) + assets;
  for (const std::string& argument : arguments) all += " " + argument;
  drawing.key = maker_ + Text(", %d x %d, ", options_.width, options_.height) + Fingerprint(all);
  const std::vector<int>& only = options_.figures;
  drawing.wanted = WantsAll() || std::find(only.begin(), only.end(), figure.number) != only.end();

  std::vector<PngText> texts;
  std::error_code ignored;
  const fs::path file = folder_ / FigureFile(figure.number);
  drawing.current = fs::exists(file, ignored) && ReadPng(file, &texts).ok() &&
                    std::find(texts.begin(), texts.end(), PngText{kKeyword, drawing.key}) != texts.end();
  drawings_.push_back(std::move(drawing));
  return kDone;
}

int Gallery::Prepare() {
  std::set<std::string> names;
  for (const Figure& figure : AllFigures()) names.insert(figure.course());
  for (const StudyCourse& course : StudyCourses()) names.insert(course.name);
  for (const std::string& name : names) {
    auto scene = LoadCourse(name);
    if (!scene) {
      PrintDiagnostics(scene.diagnostics());
      return kInvalid;
    }
    scenes_[name] = std::move(*scene);
  }
  const std::string assets = AssetsFingerprint(root_);
  for (const Figure& figure : AllFigures()) {
    if (const int code = PrepareFigure(figure, assets); code != kDone) return code;
  }
  return kDone;
}

std::vector<Work> Gallery::MissingWorks() {
  std::map<std::string, CourseNeed> needs;
  for (const Drawing& drawing : drawings_) {
    if (!drawing.wanted) continue;
    CourseNeed& need = needs[drawing.figure->course()];
    need.frames = std::max(need.frames, drawing.figure->frame);
    if (!drawing.current) need.shapes.insert(drawing.figure->frame);
  }
  if (WantsAll()) {
    for (const StudyCourse& course : StudyCourses()) {
      CourseNeed& need = needs[course.name];
      need.frames = std::max(need.frames, course.frames);
    }
  }
  std::vector<Work> works;
  for (const auto& [name, need] : needs) {
    if (ReadMeasured(name, need.frames) && need.shapes.empty()) continue;
    const Scene& scene = scenes_.at(name);
    const CourseNeed& wanted = need;
    works.push_back({name, need.frames, 1, [&scene, wanted](const std::function<bool()>& goOn) {
                       return MeasureCourse(scene, wanted.frames, wanted.shapes, goOn);
                     }});
  }
  if (!WantsAll()) return works;

  const SceneLoader load = [this](const std::string& course) { return *LoadCourse(course); };
  const auto study = [&](const char* name, int frames, int weight, const auto& measure) {
    if (ReadMeasured(name, 0)) return;
    works.push_back({name, frames * weight, weight,
                     [measure, load](const std::function<bool()>& goOn) { return measure(load, goOn); }});
  };
  for (const char* name : kHashStudies) {
    study(
        name, HashStudyFrames(), name == std::string("hash brute") ? kBruteWeight : 1,
        [name](const SceneLoader& scenes, const std::function<bool()>& goOn) { return StudyHash(name, scenes, goOn); });
  }
  study(kRatioStudy, RatioStudyFrames(), 1, StudyRatio);
  return works;
}

int Gallery::Draw(Drawing& drawing, const ClothShapes& shape) {
  const World world(scenes_.at(drawing.figure->course()), {.threads = 1});  // for what is not its shape
  std::vector<ClothShape> cloths;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const ClothView cloth = world.Cloth(c);
    cloths.push_back({shape[std::size_t(c)], cloth.uv(), cloth.triangles(), cloth.springs()});
  }
  const auto image = painter_.Paint(world.scene(), cloths, drawing.view);
  PrintDiagnostics(image.diagnostics());
  if (!image) return kInvalid;
  const Status status = SavePicture(folder_ / FigureFile(drawing.figure->number), *image, root_, world.scene(),
                                    drawing.view, drawing.figure->frame, {{kKeyword, drawing.key}});
  PrintDiagnostics(status.diagnostics());
  if (!status) return kFailed;
  drawing.current = true;
  ++made_;
  return kDone;
}

/// Keeps a measurement, and draws the figures that show moments of it.
int Gallery::Take(const FinishedWork& work) {
  const Course& course = work.course;
  for (Drawing& drawing : drawings_) {
    const auto shape = course.shapes.find(drawing.figure->frame);
    if (drawing.figure->course() != work.name || !drawing.wanted || drawing.current || shape == course.shapes.end())
      continue;
    if (const int code = Draw(drawing, shape->second); code != kDone) return code;
  }
  if (const int code = Keep(work.name, course.table); code != kDone) return code;
  if (!course.divergence) return kDone;
  PrintError("the simulation of " + work.name + " diverged: " + course.divergence->cause + "; " +
             course.divergence->remedy);
  return kDiverged;
}

int Gallery::Make() {
  std::vector<Work> works = MissingWorks();
  const int threads = options_.threads > 0 ? options_.threads : int(std::thread::hardware_concurrency());
  Workers workers(std::move(works), threads);
  Progress progress(options_.progress, std::string(VerbName(Verb::Figures)), workers.cost());
  while (!workers.Done()) {
    if (Interrupted()) {
      std::fprintf(stderr, "percale: interrupted; what was done is kept, and the next start goes on from there\n");
      return kInterrupted;
    }
    progress.Update(workers.progress());
    const auto work = workers.Next(kPatience);
    if (!work) continue;
    if (const int code = Take(*work); code != kDone) return code;
  }
  progress.Finish(workers.progress());
  return WantsAll() ? StudyPictures() : int(kDone);
}

/// The studies that draw or look at pictures.
int Gallery::StudyPictures() {
  if (!ReadMeasured(kSphereStudy, 0)) {
    const Drawing& ball = drawings_[40];  // figure 41
    const auto table = StudySphere(painter_, root_ / "textures" / "texture_3.png", scenes_.at(ball.figure->course()),
                                   ball.view, options_.width, options_.height);
    PrintDiagnostics(table.diagnostics());
    if (!table) return kFailed;
    if (const int code = Keep(kSphereStudy, *table); code != kDone) return code;
  }
  if (!ReadMeasured(kLightStudy, 0)) {
    const auto table = StudyLight(folder_);
    PrintDiagnostics(table.diagnostics());
    if (!table) return kFailed;
    if (const int code = Keep(kLightStudy, *table); code != kDone) return code;
  }
  return kDone;
}

ShownFigure Gallery::Show(const Drawing& drawing) const {
  const Figure& figure = *drawing.figure;
  ShownFigure shown;
  shown.figure = &figure;
  shown.shader = drawing.shot.shader;
  shown.framesPerSecond = scenes_.at(figure.course()).simulation.framesPerSecond;
  shown.command = "percale shot";
  for (const std::string& argument : ShotArguments(figure)) shown.command += " " + ShellWord(argument);
  const Options standard;
  if (options_.width != standard.width || options_.height != standard.height)
    shown.command += Text(" --size %dx%d", options_.width, options_.height);
  // What the viewer has kept of the shader would make another picture.
  std::error_code ignored;
  if (fs::exists(ShaderValuesFile(root_ / "shaders", shown.shader), ignored)) shown.command += " --shader-defaults";
  shown.command += " -o " + FigureFile(figure.number);
  for (const std::string& assignment : drawing.shot.set) shown.parameters.push_back(ParameterText(assignment));
  for (const UniformOption& uniform : drawing.shot.uniforms)
    shown.parameters.emplace_back(uniform.name, Text("%g (shader)", double(uniform.numbers[0])));
  if (drawing.shot.longitudes)
    shown.parameters.emplace_back("sphere",
                                  Text("%d x %d", drawing.view.sphereLatitudes, drawing.view.sphereLongitudes));
  shown.course = measured_.at(figure.course());
  shown.course.rows.resize(std::size_t(figure.frame) + 1);
  shown.png = FileBytes(folder_ / FigureFile(figure.number));
  return shown;
}

int Gallery::WritePage() {
  FigurePage page;
  page.version = PERCALE_VERSION;
  page.width = options_.width;
  page.height = options_.height;
  // Beside what was asked for, what is there from before.
  for (const StudyCourse& course : StudyCourses()) ReadMeasured(course.name, course.frames);
  for (const char* study : kHashStudies) ReadMeasured(study, 0);
  for (const char* study : {kRatioStudy, kSphereStudy, kLightStudy}) ReadMeasured(study, 0);
  for (const Drawing& drawing : drawings_) {
    const std::string course = drawing.figure->course();
    const auto known = measured_.find(course);
    const bool measured = (known != measured_.end() && int(known->second.rows.size()) > drawing.figure->frame) ||
                          ReadMeasured(course, drawing.figure->frame);
    if (drawing.current && measured) page.figures.push_back(Show(drawing));
  }
  measured_[kSpringsStudy] = CountSprings([this](const std::string& course) { return *LoadCourse(course); });
  if (page.figures.size() == std::size_t(kFigureCount) && IsComplete(measured_)) page.findings = Judge(measured_);

  for (const auto& [name, text] : {std::pair{"figures.json", FormatPageData(page)}, {"index.html", FormatPage(page)}}) {
    const Status status = WriteFile(folder_ / name, text);
    PrintDiagnostics(status.diagnostics());
    if (!status) return kFailed;
  }
  PrintSummary(page);
  return kDone;
}

void Gallery::PrintSummary(const FigurePage& page) const {
  std::printf("%s: %zu of %d figures, %d of them drawn now\n", PathText(folder_ / "index.html").c_str(),
              page.figures.size(), kFigureCount, made_);
  if (!page.findings) return;
  int counts[3] = {};
  for (const Claim& claim : page.findings->claims) ++counts[std::size_t(claim.verdict)];
  std::printf("claims of the write-up: %d hold, %d hold partly, %d do not\n", counts[0], counts[1], counts[2]);
}

}  // namespace

int Figures(const Options& options) {
  const auto root = FindRoot(options.root);
  if (!root) {
    PrintDiagnostics(root.diagnostics());
    return options.root.empty() ? kFailed : kUsage;
  }
  bool noGraphics = false;
  auto painter = Painter::Open({.root = *root, .width = options.width, .height = options.height}, &noGraphics);
  PrintDiagnostics(painter.diagnostics());
  if (!painter) return noGraphics ? kNoGraphics : kFailed;

  const fs::path folder = options.output.empty() ? fs::path("figures") : TextPath(options.output);
  CatchInterrupts();
  Gallery gallery(options, *root, folder, std::move(*painter));
  if (const int prepared = gallery.Prepare(); prepared != kDone) return prepared;
  std::error_code code;
  fs::create_directories(folder / "measured", code);
  if (code) {
    PrintError("-o: the folder " + ShellWord(PathText(folder)) + " cannot be made: " + code.message());
    return kFailed;
  }
  if (const int writable = CheckWritable(folder / "index.html"); writable != kDone) return writable;
  const int made = gallery.Make();
  if (made != kDone && made != kInterrupted && made != kDiverged) return made;
  const int written = gallery.WritePage();
  return made != kDone ? made : written;
}

}  // namespace percale::cli
