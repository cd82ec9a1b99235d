#include "render/shader_text.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "io/atomic_file.h"

namespace percale {
namespace {

constexpr std::uintmax_t kMaxShaderBytes = 1 << 20;
constexpr std::size_t kLongestExcerpt = 200;
constexpr std::size_t kLongestName = 60;

// A shader of one's own to begin with: every line can be changed, and shows at once.
constexpr std::string_view kTemplate = R"(#version 330

// A shader of your own. The viewer draws it again as soon as this file is saved; docs/shaders.md
// lists everything that a shader is given.

uniform vec4 u_color;            // The base colour, as chosen in the viewer or in the scene.
uniform vec3 u_cam_pos;          // Where the eye is [m].
uniform vec3 u_light_pos;        // Where the light is [m].
uniform vec3 u_light_intensity;  // How bright it is: red, green, blue.

// Parameters: the comment behind a uniform makes it a control in the viewer.
uniform float u_ambient;  // @range 0 1 @default 0.2 @label Ambient @help Light that reaches every point alike
uniform vec3 u_rim;       // @color @default 0.3 0.4 0.6 @label Rim light @help Added where the surface turns away

in vec4 v_position;  // Of this point of the surface, in the world [m].
in vec4 v_normal;    // The direction in which the surface faces.
in vec2 v_uv;        // Where the point lies on the cloth, 0 to 1 along each side.
out vec4 out_color;  // The colour of the pixel: red, green, blue, and 1.

void main() {
  vec3 n = normalize(v_normal.xyz);
  vec3 toEye = normalize(u_cam_pos - v_position.xyz);
  vec3 toLight = u_light_pos - v_position.xyz;

  // Lambert's law: light falls off with the square of the distance and the cosine of the angle.
  vec3 light = u_light_intensity / dot(toLight, toLight);
  vec3 color = u_color.rgb * (u_ambient + light * max(0.0, dot(n, normalize(toLight))));

  // Squares of cloth, a little darker: a pattern made from v_uv.
  vec2 square = floor(8.0 * v_uv);
  if (mod(square.x + square.y, 2.0) < 0.5) color *= 0.85;

  color += u_rim * pow(1.0 - abs(dot(n, toEye)), 3.0);
  out_color = vec4(color, 1.0);
}
)";

Result<std::string> ReadText(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kMaxShaderBytes) {
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

/// Goes through a text line by line, each with its end of line.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool Next(std::string_view& line) {
    if (rest_.empty()) return false;
    line = rest_.substr(0, std::min(rest_.find('\n'), rest_.size() - 1) + 1);
    rest_.remove_prefix(line.size());
    return true;
  }

 private:
  std::string_view rest_;
};

std::string LineOf(std::string_view text, int number) {
  Lines lines(text);
  std::string_view line;
  for (int i = 0; i < number; ++i) {
    if (!lines.Next(line)) return {};
  }
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.remove_suffix(1);
  return std::string(line.substr(0, kLongestExcerpt));
}

/// The word and the rest of a preprocessor's line, "version" and "330" of "# version 330"; nothing
/// for any other line. `inComment` tells, and is told, whether the line starts within /* and */.
struct Directive {
  std::string_view word, rest;
};
std::optional<Directive> ReadDirective(std::string_view line, bool& inComment) {
  const bool startsInComment = inComment;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::string_view two = line.substr(i, 2);
    if (!inComment && two == "//") break;
    if (two != (inComment ? "*/" : "/*")) continue;
    inComment = !inComment;
    ++i;
  }
  if (startsInComment) return std::nullopt;
  const auto skip = [&](const char* characters) {
    line.remove_prefix(std::min(line.find_first_not_of(characters), line.size()));
  };
  skip(" \t");
  if (line.empty() || line.front() != '#') return std::nullopt;
  skip("# \t");
  Directive directive;
  directive.word = line.substr(0, std::min(line.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), line.size()));
  line.remove_prefix(directive.word.size());
  skip(" \t");
  directive.rest = line;
  return directive;
}

/// The name in `"NAME" // comment`, or nothing.
std::optional<std::string> QuotedName(std::string_view rest) {
  if (rest.empty() || rest.front() != '"') return std::nullopt;
  const std::size_t end = rest.find('"', 1);
  if (end == std::string_view::npos || end == 1) return std::nullopt;
  const std::string_view after = rest.substr(end + 1);
  const std::size_t next = after.find_first_not_of(" \t\r\n");
  if (next != std::string_view::npos && after.substr(next, 2) != "//" && after.substr(next, 2) != "/*")
    return std::nullopt;
  return std::string(rest.substr(1, end - 1));
}

bool StaysInFolder(const std::string& name) {
  if (name.find('\\') != std::string::npos || name.find(':') != std::string::npos) return false;
  const std::filesystem::path path = TextPath(name);
  return path.is_relative() && std::none_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
}

class Reader {
 public:
  explicit Reader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Adds the text of a file, which is listed already, and of what it includes.
  void Add(int file) {
    open_.push_back(file);
    const std::string text = result.files[std::size_t(file)].text;  // A copy: the list grows meanwhile.
    Lines lines(text);
    std::string_view line;
    bool inComment = false;
    for (int number = 1; lines.Next(line); ++number) {
      const std::optional<Directive> directive = ReadDirective(line, inComment);
      if (directive && directive->word == "include") {
        Include(*directive, file, number);
      } else {
        const bool isVersion = directive && directive->word == "version";
        result.text += isVersion && hasVersion_ ? "\n" : line;
        hasVersion_ |= isVersion;
        if (result.text.back() != '\n') result.text += '\n';
        result.lines.push_back({file, number});
      }
    }
    open_.pop_back();
  }

  ShaderText result;

 private:
  void Include(const Directive& directive, int from, int number) {
    const auto fail = [&](const std::string& message) {
      result.lines.push_back({from, number});  // For the excerpt.
      Diagnostic error = result.At(int(result.lines.size()));
      result.lines.pop_back();
      error.message = message;
      result.problems.push_back(std::move(error));
    };
    const std::optional<std::string> name = QuotedName(directive.rest);
    if (!name) return fail("expected #include \"file\"");
    if (!StaysInFolder(*name)) {
      return fail("expected a file in the shader's folder or below it, found " + Quote(*name, kLongestName));
    }
    const std::filesystem::path path = folder_ / TextPath(*name);
    const auto known = std::find_if(result.files.begin(), result.files.end(), [&](const ShaderText::File& f) {
      return f.path.lexically_normal() == path.lexically_normal();
    });
    if (known != result.files.end()) {
      const auto file = int(known - result.files.begin());
      if (std::find(open_.begin(), open_.end(), file) == open_.end()) return;
      return fail("includes go round in a circle: " + Quote(*name, kLongestName) + " is being read already");
    }
    Result<std::string> text = ReadText(path);
    result.files.push_back({path, text ? std::move(*text) : std::string()});
    if (!text) return fail(Quote(*name, kLongestName) + ": " + text.diagnostics().front().message);
    Add(int(result.files.size()) - 1);
  }

  std::filesystem::path folder_;
  bool hasVersion_ = false;
  std::vector<int> open_;  // The files that are being read, each included by the one before.
};

}  // namespace

Diagnostic ShaderText::At(int line, int column) const {
  Diagnostic message;
  if (line < 1 || line > int(lines.size())) {
    message.place.file = PathText(files.front().path);
    return message;
  }
  const Line& origin = lines[std::size_t(line) - 1];
  const File& file = files[std::size_t(origin.file)];
  message.place = {PathText(file.path), origin.number, column};
  message.excerpt = LineOf(file.text, origin.number);
  if (column <= int(message.excerpt.size())) message.caret = column;
  return message;
}

ShaderText ReadShaderText(const std::filesystem::path& file) {
  Reader reader(file.parent_path());
  Result<std::string> text = ReadText(file);
  reader.result.files.push_back({file, text ? std::move(*text) : std::string()});
  if (!text) {
    reader.result.problems = text.diagnostics();
    return std::move(reader.result);
  }
  reader.Add(0);
  return std::move(reader.result);
}

std::string ToEs300(std::string_view text) {
  // Highest precision throughout, which desktop OpenGL has anyway. A browser wants the version first
  // of all; #line gives the lines that follow their own numbers back.
  std::string es =
      "#version 300 es\n"
      "precision highp float;\n"
      "precision highp int;\n"
      "precision highp sampler2D;\n"
      "precision highp samplerCube;\n"
      "precision highp sampler2DShadow;\n"
      "#line 1\n";
  Lines lines(text);
  std::string_view line;
  bool inComment = false;
  while (lines.Next(line)) {
    const std::optional<Directive> directive = ReadDirective(line, inComment);
    es += directive && directive->word == "version" ? "\n" : line;
  }
  return es;
}

Result<std::filesystem::path> CreateShader(const std::filesystem::path& folder, const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (name.empty() || name.size() > kLongestName || !plain) {
    return MakeError("expected the name of a new shader, of at most " + std::to_string(kLongestName) +
                     " letters, digits, _ and -, found " + Quote(name, kLongestName));
  }
  for (const char* ending : {".frag", ".vert"}) {
    std::error_code error;
    const std::filesystem::path file = folder / (name + ending);
    if (std::filesystem::exists(file, error)) return MakeError(PathText(file), "exists already; choose another name");
  }
  const std::filesystem::path file = folder / (name + ".frag");
  if (Status written = WriteFile(file, kTemplate); !written) return written.diagnostics();
  return file;
}

}  // namespace percale
