#include "render/shader_library.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"

namespace percale {
namespace {

constexpr const char* kCourseOrder[] = {"Wireframe", "Normal",       "Diffuse", "Phong", "Texture",
                                        "Bump",      "Displacement", "Mirror",  "Flag"};
constexpr std::uintmax_t kMaxShaderBytes = 1 << 20;
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
    {"u_color", GL_FLOAT_VEC4, "vec4"},
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

Result<std::string> ReadText(const std::filesystem::path& file) {
  const FileStamp stamp = StampOf(file);
  if (stamp.size > kMaxShaderBytes) {
    std::error_code error;
    const bool exists = std::filesystem::exists(file, error);
    return MakeError(PathText(file),
                     exists ? "expected the text of a shader, found no file of at most 1 MB" : "does not exist");
  }
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return MakeError(PathText(file), "cannot be read");
  if (text.rfind("\xef\xbb\xbf", 0) == 0) text.erase(0, 3);  // A byte-order mark would confuse the compiler.
  return text;
}

std::string LineOf(const std::string& text, int line) {
  std::istringstream in(text);
  std::string found;
  for (int i = 0; i < line; ++i) {
    if (!std::getline(in, found)) return {};
  }
  while (!found.empty() && (found.back() == '\r' || found.back() == ' ')) found.pop_back();
  return found.substr(0, 200);
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
Diagnostic ParseLogLine(const std::string& line, const std::string& file, const std::string& source) {
  Diagnostic message;
  message.place.file = file;
  std::string lower = line;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (lower.find("warning") != std::string::npos && lower.find("error") == std::string::npos) {
    message.severity = Severity::Warning;
  }
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
    message.place.line = ReadInt(line, at);
    if (!isNvidia && at < line.size() && line[at] == '(') {
      ++at;
      message.place.column = ReadInt(line, at);
    }
    while (at < line.size() && (line[at] == ')' || line[at] == ':' || line[at] == ' ')) ++at;
    for (const char* prefix : {"error:", "warning:"}) {
      if (lower.compare(at, std::string(prefix).size(), prefix) == 0) at += std::string(prefix).size();
    }
    while (at < line.size() && line[at] == ' ') ++at;
  } else {
    at = start;
  }
  message.message = line.substr(at);
  if (message.place.line > 0) {
    message.excerpt = LineOf(source, message.place.line);
    if (message.place.column <= static_cast<int>(message.excerpt.size())) message.caret = message.place.column;
  }
  return message;
}

void AddLog(const std::string& log, const std::string& file, const std::string& source, bool failed,
            Diagnostics& problems) {
  std::istringstream in(log);
  Diagnostics found;
  for (std::string line; std::getline(in, line) && found.size() < kMaxMessages;) {
    while (!line.empty() && (std::isspace(static_cast<unsigned char>(line.back())) || line.back() == '\0'))
      line.pop_back();
    if (!line.empty()) found.push_back(ParseLogLine(line, file, source));
  }
  if (failed && !HasErrors(found)) {
    found.insert(found.begin(), MakeError(file, "the driver refuses the shader" +
                                                    std::string(log.empty() ? " and gives no reason" : "")));
  }
  // What a driver says about shaders that it accepts is chatter.
  if (failed) problems.insert(problems.end(), found.begin(), found.end());
}

/// A warning at the line that declares the uniform, in the first of the texts that does.
Diagnostic UniformWarning(std::string_view name, std::string message,
                          std::initializer_list<std::pair<std::filesystem::path, std::string_view>> texts) {
  Diagnostic warning = MakeWarning(std::move(message));
  const auto isName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (const auto& [file, text] : texts) {
    std::istringstream in{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      const std::size_t uniform = line.find("uniform"),
                        at = line.find(name, uniform == std::string::npos ? 0 : uniform);
      if (uniform == std::string::npos || at == std::string::npos) continue;
      if (isName(line[at - 1]) || (at + name.size() < line.size() && isName(line[at + name.size()]))) continue;
      warning.place = {PathText(file), number, static_cast<int>(at) + 1};
      warning.excerpt = LineOf(std::string(text), number);
      if (at < warning.excerpt.size()) warning.caret = warning.place.column;
      return warning;
    }
    if (warning.place.file.empty()) warning.place.file = PathText(file);
  }
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
  const bool isSampler = type == GL_SAMPLER_2D || type == GL_SAMPLER_CUBE;
  if (isSampler) {
    return "there is no texture " + std::string(name) + near +
           "; there are u_texture_1 to u_texture_4 and u_texture_cubemap";
  }
  return near.empty() ? "" : "nothing sets " + std::string(name) + near;
}

GLuint Compile(GLenum stage, const std::string& file, const std::string& source, Diagnostics& problems) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE, length = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
  AddLog(log, file, source, good != GL_TRUE, problems);
  if (good == GL_TRUE) return shader;
  glDeleteShader(shader);
  return 0;
}

}  // namespace

std::vector<std::string> ListShaders(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::filesystem::path& file = entry->path();
    // A name with a leading dot is an editor's scratch file.
    if (file.extension() == ".frag" && file.filename().string().front() != '.') names.push_back(file.stem().string());
  }
  const auto rank = [](const std::string& name) {
    return std::find(std::begin(kCourseOrder), std::end(kCourseOrder), name) - std::begin(kCourseOrder);
  };
  std::sort(names.begin(), names.end(),
            [&](const std::string& a, const std::string& b) { return rank(a) != rank(b) ? rank(a) < rank(b) : a < b; });
  return names;
}

struct ShaderLibrary::Impl {
  struct Entry {
    std::unique_ptr<ShaderProgram> program;  // The last good one.
    Diagnostics problems;                    // Of the latest files.
    std::vector<ShaderParameter> parameters;
    Diagnostics parameterProblems;
    bool isCompiled = false;  // The latest files have been tried.
    bool isParsed = false;
    FileStamp fragment, vertex, defaultVertex;  // Of the files when they were read.
  };

  std::filesystem::path folder;
  std::vector<std::string> names;
  std::map<std::string, Entry, std::less<>> entries;
  Diagnostics unknown;  // For a name that is no shader.

  ~Impl() {
    for (auto& [name, entry] : entries) Drop(entry);
  }

  static void Drop(Entry& entry) {
    if (entry.program) glDeleteProgram(entry.program->program);
    entry.program.reset();
  }

  std::filesystem::path FragmentFile(std::string_view name) const { return folder / (std::string(name) + ".frag"); }
  std::filesystem::path VertexFile(std::string_view name) const { return folder / (std::string(name) + ".vert"); }
  std::filesystem::path DefaultVertexFile() const { return folder / "Default.vert"; }

  bool IsKnown(std::string_view name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

  Entry& EntryOf(std::string_view name) {
    const auto found = entries.find(name);
    return found != entries.end() ? found->second : entries[std::string(name)];
  }

  void Stamp(std::string_view name, Entry& entry) const {
    entry.fragment = StampOf(FragmentFile(name));
    entry.vertex = StampOf(VertexFile(name));
    entry.defaultVertex = StampOf(DefaultVertexFile());
  }

  std::filesystem::path VertexFileInUse(std::string_view name, const Entry& entry) const {
    return entry.vertex == FileStamp{} ? DefaultVertexFile() : VertexFile(name);
  }

  void Parse(std::string_view name, Entry& entry) {
    if (entry.isParsed) return;
    entry.isParsed = true;
    entry.parameters.clear();
    entry.parameterProblems.clear();
    Stamp(name, entry);
    // A uniform may stand in both files: the fragment shader, which is the one people edit, wins.
    for (const std::filesystem::path& file : {FragmentFile(name), VertexFileInUse(name, entry)}) {
      const Result<std::string> text = ReadText(file);
      if (!text) continue;  // Reported when the shader is compiled.
      for (ShaderParameter& parameter : ParseShaderParameters(*text, PathText(file), entry.parameterProblems)) {
        const auto same = [&](const ShaderParameter& other) { return other.name == parameter.name; };
        if (std::none_of(entry.parameters.begin(), entry.parameters.end(), same)) {
          entry.parameters.push_back(std::move(parameter));
        }
      }
    }
  }

  void Build(std::string_view name, Entry& entry) {
    entry.isParsed = false;
    Parse(name, entry);
    entry.isCompiled = true;
    entry.problems = entry.parameterProblems;
    const std::filesystem::path vertexFile = VertexFileInUse(name, entry), fragmentFile = FragmentFile(name);
    const Result<std::string> vertexText = ReadText(vertexFile), fragmentText = ReadText(fragmentFile);
    for (const Result<std::string>* text : {&vertexText, &fragmentText}) {
      if (!*text) entry.problems.insert(entry.problems.end(), text->diagnostics().begin(), text->diagnostics().end());
    }
    if (!vertexText || !fragmentText) return;

    // Both are compiled even if the first fails, so that all errors show at once.
    const GLuint vertex = Compile(GL_VERTEX_SHADER, PathText(vertexFile), *vertexText, entry.problems);
    const GLuint fragment = Compile(GL_FRAGMENT_SHADER, PathText(fragmentFile), *fragmentText, entry.problems);
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
        AddLog(log, PathText(fragmentFile), *fragmentText, true, entry.problems);
        entry.problems.back().message += " (linking with " + vertexFile.filename().string() + ")";
        glDeleteProgram(program);
        program = 0;
      }
    }
    if (vertex) glDeleteShader(vertex);
    if (fragment) glDeleteShader(fragment);
    if (!program) return;

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
      if (problem.empty()) continue;
      entry.problems.push_back(
          UniformWarning(uniform, problem, {{fragmentFile, *fragmentText}, {vertexFile, *vertexText}}));
    }
    Drop(entry);
    entry.program = std::move(built);
  }

  bool HasChanged(std::string_view name, const Entry& entry) const {
    Entry now;
    Stamp(name, now);
    const bool usedDefault = entry.vertex == FileStamp{};
    return now.fragment != entry.fragment || now.vertex != entry.vertex ||
           (usedDefault && now.defaultVertex != entry.defaultVertex);
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

const ShaderProgram* ShaderLibrary::Find(std::string_view name) {
  const auto found = impl_->entries.find(name);
  if (found == impl_->entries.end() && !impl_->IsKnown(name)) return nullptr;
  Impl::Entry& entry = impl_->EntryOf(name);
  if (!entry.isCompiled) impl_->Build(name, entry);
  return entry.program.get();
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
    if (!(entry.isCompiled || entry.isParsed) || !impl_->HasChanged(name, entry)) continue;
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
