#include "render/shader_library.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"
#include "render/shader_text.h"

namespace percale {
namespace {

constexpr const char* kCourseOrder[] = {"Wireframe", "Normal",       "Diffuse", "Phong", "Texture",
                                        "Bump",      "Displacement", "Mirror",  "Flag"};
// Endings of the names of a shader's parts, in the order of Surface.
constexpr const char* kParts[] = {"", ".sphere", ".plane", ".background"};
constexpr std::size_t kMaxMessages = 20;  // Of one shader: the first are the ones to read.

/// The uniforms that the program sets, which docs/shaders.md lists; u_lines is for Wireframe alone.
struct KnownUniform {
  std::string_view name;
  GLenum type;
  std::string_view typeName;
};
constexpr KnownUniform kUniforms[] = {
    {"u_model", GL_FLOAT_MAT4, "mat4"},
    {"u_view_projection", GL_FLOAT_MAT4, "mat4"},
    {"u_light_view_projection", GL_FLOAT_MAT4, "mat4"},
    {"u_color", GL_FLOAT_VEC4, "vec4"},
    {"u_back_color", GL_FLOAT_VEC4, "vec4"},
    {"u_cam_pos", GL_FLOAT_VEC3, "vec3"},
    {"u_light_pos", GL_FLOAT_VEC3, "vec3"},
    {"u_light_intensity", GL_FLOAT_VEC3, "vec3"},
    {"u_texture_1", GL_SAMPLER_2D, "sampler2D"},
    {"u_texture_2", GL_SAMPLER_2D, "sampler2D"},
    {"u_texture_3", GL_SAMPLER_2D, "sampler2D"},
    {"u_texture_4", GL_SAMPLER_2D, "sampler2D"},
    {"u_texture_1_size", GL_FLOAT_VEC2, "vec2"},
    {"u_texture_2_size", GL_FLOAT_VEC2, "vec2"},
    {"u_texture_3_size", GL_FLOAT_VEC2, "vec2"},
    {"u_texture_4_size", GL_FLOAT_VEC2, "vec2"},
    {"u_texture_cubemap", GL_SAMPLER_CUBE, "samplerCube"},
    {"u_shadow_map", GL_SAMPLER_2D_SHADOW, "sampler2DShadow"},
    {"u_normal_scaling", GL_FLOAT, "float"},
    {"u_height_scaling", GL_FLOAT, "float"},
    {"u_lines", GL_BOOL, "bool"},
};

// What tells one version of a file from another. A missing file has size -1.
struct FileStamp {
  std::filesystem::file_time_type time{};
  std::uintmax_t size = static_cast<std::uintmax_t>(-1);
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

FileStamp StampOf(const std::filesystem::path& file) {
  std::error_code error;
  FileStamp stamp;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return stamp;
  stamp.size = size;
  stamp.time = std::filesystem::last_write_time(file, error);
  return stamp;
}

int ReadInt(const std::string& text, std::size_t& at) {
  int value = 0;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) && value < 1000000) {
    value = 10 * value + (text[at++] - '0');
  }
  return value;
}

// One line of a driver's log. The forms in use are "0:12(5): error: ..." (Mesa),
// "0(12) : error C0000: ..." (NVIDIA) and "ERROR: 0:12: ..." (Apple, AMD, Intel, ANGLE).
Diagnostic ParseLogLine(const std::string& line, const ShaderText& source) {
  std::string lower = line;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  int number = 0, column = 0;
  std::size_t at = 0;
  for (const char* prefix : {"error:", "warning:"}) {
    if (lower.rfind(prefix, 0) == 0) at = std::string(prefix).size();
  }
  while (at < line.size() && line[at] == ' ') ++at;
  const std::size_t start = at;
  ReadInt(line, at);  // The number of the source string: always 0.
  if (at > start && at + 1 < line.size() && (line[at] == ':' || line[at] == '(')) {
    const bool isNvidia = line[at] == '(';
    ++at;
    number = ReadInt(line, at);
    if (!isNvidia && at < line.size() && line[at] == '(') {
      ++at;
      column = ReadInt(line, at);
    }
    while (at < line.size() && (line[at] == ')' || line[at] == ':' || line[at] == ' ')) ++at;
    for (const char* prefix : {"error:", "warning:"}) {
      if (lower.compare(at, std::string(prefix).size(), prefix) == 0) at += std::string(prefix).size();
    }
    while (at < line.size() && line[at] == ' ') ++at;
  } else {
    at = start;
  }
  Diagnostic message = source.At(number, column);
  message.message = line.substr(at);
  if (lower.find("warning") != std::string::npos && lower.find("error") == std::string::npos) {
    message.severity = Severity::Warning;
  }
  return message;
}

void AddLog(const std::string& log, const ShaderText& source, bool failed, Diagnostics& problems) {
  std::istringstream in(log);
  Diagnostics found;
  for (std::string line; std::getline(in, line) && found.size() < kMaxMessages;) {
    while (!line.empty() && (std::isspace(static_cast<unsigned char>(line.back())) || line.back() == '\0'))
      line.pop_back();
    if (!line.empty()) found.push_back(ParseLogLine(line, source));
  }
  if (failed && !HasErrors(found)) {
    found.insert(found.begin(),
                 MakeError(PathText(source.files.front().path),
                           "the driver refuses the shader" + std::string(log.empty() ? " and gives no reason" : "")));
  }
  // What a driver says about shaders that it accepts is chatter.
  if (failed) problems.insert(problems.end(), found.begin(), found.end());
}

/// A warning at the line that declares the uniform, in the first of the texts that does.
Diagnostic UniformWarning(std::string_view name, std::string message, std::initializer_list<const ShaderText*> texts) {
  const auto isName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  Diagnostic warning = (*texts.begin())->At(0);
  for (const ShaderText* text : texts) {
    std::istringstream in{text->text};
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      const std::size_t uniform = line.find("uniform"),
                        at = line.find(name, uniform == std::string::npos ? 0 : uniform);
      if (uniform == std::string::npos || at == std::string::npos) continue;
      if (isName(line[at - 1]) || (at + name.size() < line.size() && isName(line[at + name.size()]))) continue;
      warning = text->At(number, static_cast<int>(at) + 1);
      break;
    }
    if (warning.place.line > 0) break;
  }
  warning.severity = Severity::Warning;
  warning.message = std::move(message);
  return warning;
}

/// What is wrong with an active uniform that is no parameter: it keeps its initial value, mostly 0,
/// and the picture is black without a word from OpenGL. Empty: nothing.
std::string UniformProblem(std::string_view name, GLenum type) {
  const auto known =
      std::find_if(std::begin(kUniforms), std::end(kUniforms), [&](const KnownUniform& k) { return k.name == name; });
  if (known != std::end(kUniforms)) {
    if (known->type == type) return {};
    return std::string(name) + " is a " + std::string(known->typeName) + "; declared as anything else it stays 0";
  }
  std::vector<std::string_view> names;
  for (const KnownUniform& uniform : kUniforms) names.push_back(uniform.name);
  const std::string near = DidYouMean(name, names);
  const bool isSampler = type == GL_SAMPLER_2D || type == GL_SAMPLER_CUBE || type == GL_SAMPLER_2D_SHADOW;
  if (isSampler) {
    return "there is no texture " + std::string(name) + near +
           "; there are u_texture_1 to u_texture_4, u_texture_cubemap and u_shadow_map";
  }
  return near.empty() ? "" : "nothing sets " + std::string(name) + near;
}

GLuint Compile(GLenum stage, const ShaderText& source, Diagnostics& problems) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE, length = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
  AddLog(log, source, good != GL_TRUE, problems);
  if (good == GL_TRUE) return shader;
  glDeleteShader(shader);
  return 0;
}

/// The program of two texts, or 0.
GLuint Link(const ShaderText& vertexText, const ShaderText& fragmentText, Diagnostics& problems) {
  // Both are compiled even if the first fails, so that all errors show at once.
  const GLuint vertex = Compile(GL_VERTEX_SHADER, vertexText, problems);
  const GLuint fragment = Compile(GL_FRAGMENT_SHADER, fragmentText, problems);
  GLuint program = 0;
  if (vertex && fragment) {
    program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    const char* attributes[] = {"in_position", "in_normal", "in_uv", "in_tangent"};
    for (GLuint i = 0; i < 4; ++i) glBindAttribLocation(program, i, attributes[i]);
    glLinkProgram(program);
    GLint good = GL_FALSE, length = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good != GL_TRUE) {
      glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
      std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
      glGetProgramInfoLog(program, length, nullptr, log.data());
      log.resize(std::min(log.find('\0'), log.size()));
      AddLog(log, fragmentText, true, problems);
      problems.back().message += " (linking with " + vertexText.files.front().path.filename().string() + ")";
      glDeleteProgram(program);
      program = 0;
    }
  }
  if (vertex) glDeleteShader(vertex);
  if (fragment) glDeleteShader(fragment);
  return program;
}

bool IsPart(const std::string& name) {
  return std::any_of(std::begin(kParts) + 1, std::end(kParts), [&](std::string_view ending) {
    return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  });
}

}  // namespace

std::vector<std::string> ListShaders(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::filesystem::path& file = entry->path();
    // A name with a leading dot is an editor's scratch file.
    if (file.extension() != ".frag" || file.filename().string().front() == '.') continue;
    if (const std::string name = file.stem().string(); !IsPart(name)) names.push_back(name);
  }
  const auto rank = [](const std::string& name) {
    return std::find(std::begin(kCourseOrder), std::end(kCourseOrder), name) - std::begin(kCourseOrder);
  };
  std::sort(names.begin(), names.end(),
            [&](const std::string& a, const std::string& b) { return rank(a) != rank(b) ? rank(a) < rank(b) : a < b; });
  return names;
}

struct ShaderLibrary::Impl {
  /// A shader or one of its parts: two texts and their program.
  struct Part {
    std::filesystem::path fragmentFile;      // Empty: the shader has no such part.
    ShaderText vertex, fragment;             // As they were last read.
    std::unique_ptr<ShaderProgram> program;  // The last good one.
  };
  struct Entry {
    std::array<Part, std::size(kParts)> parts;
    std::vector<std::pair<std::filesystem::path, FileStamp>> files;  // Missing ones too: all that matter.
    Diagnostics problems;                                            // Of the latest files.
    std::vector<ShaderParameter> parameters;
    Diagnostics parameterProblems;
    bool isCompiled = false;  // The latest files have been tried.
    bool isParsed = false;
  };

  std::filesystem::path folder;
  std::vector<std::string> names;
  std::map<std::string, Entry, std::less<>> entries;
  Diagnostics unknown;  // For a name that is no shader.

  ~Impl() {
    for (auto& [name, entry] : entries) {
      for (Part& part : entry.parts) Drop(part);
    }
  }

  static void Drop(Part& part) {
    if (part.program) glDeleteProgram(part.program->program);
    part.program.reset();
  }

  bool IsKnown(std::string_view name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

  Entry& EntryOf(std::string_view name) {
    const auto found = entries.find(name);
    return found != entries.end() ? found->second : entries[std::string(name)];
  }

  /// Reads the files of a part, and remembers each.
  void Read(Entry& entry, Part& part, const std::string& name, bool isOptional) {
    const auto stamp = [&](const std::filesystem::path& file) {
      const auto known = [&](const auto& each) { return each.first == file; };
      const auto found = std::find_if(entry.files.begin(), entry.files.end(), known);
      return found != entry.files.end() ? found->second : entry.files.emplace_back(file, StampOf(file)).second;
    };
    part.fragmentFile = folder / (name + ".frag");
    if (stamp(part.fragmentFile) == FileStamp{} && isOptional) {
      part.fragmentFile.clear();
      Drop(part);
      return;
    }
    std::filesystem::path vertexFile = folder / (name + ".vert");
    if (stamp(vertexFile) == FileStamp{}) vertexFile = folder / "Default.vert";
    part.fragment = ReadShaderText(part.fragmentFile);
    part.vertex = ReadShaderText(vertexFile);
    for (const ShaderText* text : {&part.fragment, &part.vertex}) {
      for (const ShaderText::File& file : text->files) stamp(file.path);
    }
  }

  void Parse(std::string_view name, Entry& entry) {
    if (entry.isParsed) return;
    entry.isParsed = true;
    entry.files.clear();
    entry.parameters.clear();
    entry.parameterProblems.clear();
    std::vector<std::filesystem::path> parsed;
    for (std::size_t i = 0; i < entry.parts.size(); ++i) {
      Part& part = entry.parts[i];
      Read(entry, part, std::string(name) + kParts[i], i > 0);
      if (part.fragmentFile.empty()) continue;
      // A uniform may stand in several files: the fragment shader, which is the one people edit, wins.
      for (const ShaderText* text : {&part.fragment, &part.vertex}) {
        for (const ShaderText::File& file : text->files) {
          if (std::find(parsed.begin(), parsed.end(), file.path) != parsed.end()) continue;
          parsed.push_back(file.path);
          AddParameters(entry, file);
        }
      }
    }
  }

  static void AddParameters(Entry& entry, const ShaderText::File& file) {
    for (ShaderParameter& parameter : ParseShaderParameters(file.text, PathText(file.path), entry.parameterProblems)) {
      const auto same = [&](const ShaderParameter& other) { return other.name == parameter.name; };
      if (std::none_of(entry.parameters.begin(), entry.parameters.end(), same)) {
        entry.parameters.push_back(std::move(parameter));
      }
    }
  }

  void Build(std::string_view name, Entry& entry) {
    entry.isParsed = false;
    Parse(name, entry);
    entry.isCompiled = true;
    entry.problems = entry.parameterProblems;
    for (Part& part : entry.parts) {
      if (!part.fragmentFile.empty()) Build(entry, part);
    }
  }

  static void Build(Entry& entry, Part& part) {
    for (const ShaderText* text : {&part.vertex, &part.fragment}) {
      for (const Diagnostic& problem : text->problems) AddNew(problem, entry.problems);
    }
    if (HasErrors(part.vertex.problems) || HasErrors(part.fragment.problems)) return;
    Diagnostics problems;
    const GLuint program = Link(part.vertex, part.fragment, problems);
    if (program) {
      auto built = std::make_unique<ShaderProgram>();
      built->program = program;
      built->parameters = entry.parameters;
      GLint count = 0;
      glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
      for (GLint i = 0; i < count; ++i) {
        char uniform[256];
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(program, static_cast<GLuint>(i), sizeof uniform, nullptr, &size, &type, uniform);
        built->locations[uniform] = glGetUniformLocation(program, uniform);
        const bool isParameter = std::any_of(entry.parameters.begin(), entry.parameters.end(),
                                             [&](const ShaderParameter& p) { return p.name == uniform; });
        const std::string problem = isParameter ? "" : UniformProblem(uniform, type);
        if (!problem.empty()) problems.push_back(UniformWarning(uniform, problem, {&part.fragment, &part.vertex}));
      }
      Drop(part);
      part.program = std::move(built);
    }
    for (const Diagnostic& problem : problems) AddNew(problem, entry.problems);
  }

  /// Parts that share a file have its problems in common: each is told once.
  static void AddNew(const Diagnostic& problem, Diagnostics& problems) {
    const auto same = [&](const Diagnostic& other) {
      return other.message == problem.message && other.place.file == problem.place.file &&
             other.place.line == problem.place.line && other.place.column == problem.place.column;
    };
    if (std::none_of(problems.begin(), problems.end(), same)) problems.push_back(problem);
  }

  static bool HasChanged(const Entry& entry) {
    return std::any_of(entry.files.begin(), entry.files.end(),
                       [](const auto& file) { return StampOf(file.first) != file.second; });
  }

  void Renew(std::string_view name, Entry& entry) {
    if (entry.isCompiled) {
      Build(name, entry);
    } else {
      entry.isParsed = false;
    }
  }
};

ShaderLibrary::ShaderLibrary(std::filesystem::path folder) : impl_(std::make_unique<Impl>()) {
  impl_->folder = std::move(folder);
  impl_->names = ListShaders(impl_->folder);
}
ShaderLibrary::~ShaderLibrary() = default;
ShaderLibrary::ShaderLibrary(ShaderLibrary&&) noexcept = default;
ShaderLibrary& ShaderLibrary::operator=(ShaderLibrary&&) noexcept = default;

const std::vector<std::string>& ShaderLibrary::names() const {
  return impl_->names;
}
const std::filesystem::path& ShaderLibrary::folder() const {
  return impl_->folder;
}

const ShaderProgram* ShaderLibrary::Find(std::string_view name, Surface surface) {
  const auto found = impl_->entries.find(name);
  if (found == impl_->entries.end() && !impl_->IsKnown(name)) return nullptr;
  Impl::Entry& entry = impl_->EntryOf(name);
  if (!entry.isCompiled) impl_->Build(name, entry);
  const Impl::Part& part = entry.parts[static_cast<std::size_t>(surface)];
  if (part.fragmentFile.empty() && surface != Surface::Background) return entry.parts[0].program.get();
  return part.program.get();
}

const Diagnostics& ShaderLibrary::Problems(std::string_view name) {
  if (impl_->IsKnown(name)) {
    Find(name);
    return impl_->EntryOf(name).problems;
  }
  const std::vector<std::string_view> known(impl_->names.begin(), impl_->names.end());
  std::string message = "there is no shader called " + Quote(name, 60) + DidYouMean(name, known) + "; there are ";
  for (const std::string_view each : known) message += (each == known.front() ? "" : ", ") + std::string(each);
  impl_->unknown = {MakeError(PathText(impl_->folder), message)};
  return impl_->unknown;
}

std::span<const ShaderParameter> ShaderLibrary::Parameters(std::string_view name) {
  if (!impl_->IsKnown(name)) return {};
  Impl::Entry& entry = impl_->EntryOf(name);
  impl_->Parse(name, entry);
  return entry.parameters;
}

bool ShaderLibrary::ReloadChanged() {
  bool changed = false;
  std::vector<std::string> names = ListShaders(impl_->folder);
  if (names != impl_->names) {
    impl_->names = std::move(names);
    changed = true;
  }
  for (auto& [name, entry] : impl_->entries) {
    if (!(entry.isCompiled || entry.isParsed) || !Impl::HasChanged(entry)) continue;
    impl_->Renew(name, entry);
    changed = true;
  }
  return changed;
}

void ShaderLibrary::Reload() {
  impl_->names = ListShaders(impl_->folder);
  for (auto& [name, entry] : impl_->entries) impl_->Renew(name, entry);
}

}  // namespace percale
