#include "render/headless.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;
using percale::test::TemporaryFolder;
using percale::test::WriteText;

namespace {

const std::string kVertex =
    "#version 330\nuniform mat4 u_view_projection;\nin vec4 in_position;\nout vec4 v_position;\n"
    "void main() { v_position = in_position; gl_Position = u_view_projection * in_position; }\n";
const std::string kGood =
    "#version 330\nin vec4 v_position;\nout vec4 out_color;\nvoid main() {\n  out_color = v_position;\n}\n";
const std::string kBad = "#version 330\nout vec4 out_color;\nvoid main() {\n  out_color = undefined_name;\n}\n";

}  // namespace

TEST_CASE("every shader of the project compiles without a word") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  ShaderLibrary library("shaders");
  for (const std::string& name : library.names()) {
    CAPTURE(name);
    INFO(Format(library.Problems(name)));
    CHECK(library.Problems(name).empty());
    CHECK(library.Find(name) != nullptr);
  }
}

TEST_CASE("a shader that does not compile is reported with file, line and the driver's words") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "Bad.frag", kBad);
  ShaderLibrary library(folder.path());
  CHECK(library.Find("Bad") == nullptr);
  const Diagnostics& problems = library.Problems("Bad");
  REQUIRE(HasErrors(problems));
  CHECK(problems.front().place.file == (folder / "Bad.frag").string());
  CHECK(problems.front().place.line == 4);
  CHECK(problems.front().message.find("undefined_name") != std::string::npos);
  CHECK(problems.front().excerpt.find("out_color = undefined_name") != std::string::npos);
}

TEST_CASE("the last good version stays in use while a file is broken, and the next good one replaces it") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "A.frag", kGood);
  ShaderLibrary library(folder.path());
  const ShaderProgram* good = library.Find("A");
  REQUIRE(good != nullptr);
  const unsigned program = good->program;
  CHECK_FALSE(library.ReloadChanged());

  WriteText(folder / "A.frag", kBad);
  CHECK(library.ReloadChanged());
  REQUIRE(library.Find("A") != nullptr);
  CHECK(library.Find("A")->program == program);
  CHECK(HasErrors(library.Problems("A")));
  CHECK_FALSE(library.ReloadChanged());

  WriteText(folder / "A.frag", kGood + "uniform float u_extra;  // @range 0 2 @default 1\n");
  CHECK(library.ReloadChanged());
  CHECK(library.Find("A") != nullptr);
  CHECK(library.Problems("A").empty());
  REQUIRE(library.Parameters("A").size() == 1);
  CHECK(library.Parameters("A")[0].name == "u_extra");
}

TEST_CASE("new files are new shaders, removed ones go, and a vertex shader of the same name is used") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "Zebra.frag", kGood);
  WriteText(folder / "Mirror.frag", kGood);
  ShaderLibrary library(folder.path());
  CHECK(library.names() == std::vector<std::string>{"Mirror", "Zebra"});
  REQUIRE(library.Find("Zebra") != nullptr);
  CHECK(library.Find("Zebra")->Location("u_own") < 0);

  WriteText(folder / "Apple.frag", kGood);
  CHECK(library.ReloadChanged());
  CHECK(library.names() == std::vector<std::string>{"Mirror", "Apple", "Zebra"});

  std::string own = kVertex;
  own.replace(own.find("in vec4"), 0, "uniform float u_own;\n");
  own.replace(own.find("u_view_projection * in"), 0, "u_own * ");
  WriteText(folder / "Zebra.vert", own);
  CHECK(library.ReloadChanged());
  CHECK(library.Find("Zebra")->Location("u_own") >= 0);

  std::filesystem::remove(folder / "Apple.frag");
  CHECK(library.ReloadChanged());
  CHECK(library.names() == std::vector<std::string>{"Mirror", "Zebra"});
}

TEST_CASE("uniforms that nothing sets are told, since what they do to the picture is silent") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  const std::pair<const char*, const char*> cases[] = {
      {"uniform vec3 u_color;", "u_color is a vec4"},
      {"uniform vec3 u_color ; // @color", ""},  // A parameter: the program sets it as one.
      {"uniform vec3 u_ligth_pos;", "did you mean `u_light_pos`?"},
      {"uniform sampler2D u_texture_5;", "there is no texture u_texture_5"},
      {"uniform sampler2D mine;", "u_texture_1 to u_texture_4"},
      {"uniform float u_exponent = 2.0;", ""},
      {"uniform vec4 u_color;", ""},
  };
  for (const auto& [declaration, expected] : cases) {
    const std::string text = declaration;
    CAPTURE(text);
    const std::string type = text.substr(8, text.find(' ', 8) - 8);
    const std::size_t at = 9 + type.size();
    const std::string name = text.substr(at, text.find_first_of("; ", at) - at);
    const std::string use = type == "sampler2D" ? "texture(" + name + ", vec2(0))" : "vec4(" + name + ".x)";
    const std::string value = type == "float" ? "vec4(" + name + ")" : use;
    WriteText(folder / "A.frag",
              "#version 330\nout vec4 out_color;\n" + text + "\nvoid main() { out_color = " + value + "; }\n");
    ShaderLibrary library(folder.path());
    REQUIRE(library.Find("A") != nullptr);
    const Diagnostics& problems = library.Problems("A");
    INFO(Format(problems));
    if (*expected == '\0') {
      CHECK(problems.empty());
      continue;
    }
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].severity == Severity::Warning);
    CHECK(problems[0].place.line == 3);
    CHECK(problems[0].place.column == int(at) + 1);
    CHECK(test::Contains(problems, expected));
  }
}

TEST_CASE("shaders that do not fit together, missing and empty files, are errors and no crash") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Needs.frag",
            "#version 330\nin vec2 v_position;\nout vec4 out_color;\nvoid main() { out_color = vec4(v_position, 0.0, "
            "1.0); }\n");
  WriteText(folder / "Empty.frag", "");
  WriteText(folder / "Binary.frag", std::string("\x7f"
                                                "ELF\0\0\xff",
                                                7));
  ShaderLibrary library(folder.path());
  CHECK(test::Contains(library.Problems("Needs"), "Default.vert"));  // There is none.
  WriteText(folder / "Default.vert", kVertex);
  library.ReloadChanged();
  for (const char* name : {"Needs", "Empty", "Binary"}) {
    CAPTURE(name);
    CHECK(library.Find(name) == nullptr);
    CHECK(HasErrors(library.Problems(name)));
  }
  CHECK(test::Contains(library.Problems("Needs"), "Needs.frag"));
  CHECK_FALSE(test::Contains(library.Problems("Needs"), "error: error:"));
  CHECK(test::Contains(library.Problems("Neds"), "did you mean `Needs`"));
}

TEST_CASE("an error in an included file is reported with that file and line") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "A.frag",
            "#version 330\n#include \"light.glsl\"\nout vec4 out_color;\nvoid main() { out_color = light(); }\n");
  WriteText(folder / "light.glsl", "// Two lines\n// of comment.\nvec4 light() { return missing; }\n");
  ShaderLibrary library(folder.path());
  CHECK(library.Find("A") == nullptr);
  const Diagnostics inside = library.Problems("A");
  REQUIRE(HasErrors(inside));
  CHECK(inside.front().place.file == (folder / "light.glsl").string());
  CHECK(inside.front().place.line == 3);
  CHECK(inside.front().excerpt.find("return missing") != std::string::npos);

  // Behind an include, the lines are still those of the file.
  WriteText(folder / "light.glsl", "// One line, and more.\n\n\n\nvec4 light() { return vec4(1.0); }\n");
  WriteText(folder / "A.frag",
            "#version 330\n#include \"light.glsl\"\nout vec4 out_color;\nvoid main() { out_color = gone; }\n");
  CHECK(library.ReloadChanged());
  const Diagnostics behind = library.Problems("A");
  REQUIRE(HasErrors(behind));
  CHECK(behind.front().place.file == (folder / "A.frag").string());
  CHECK(behind.front().place.line == 4);
}

TEST_CASE("saving an included file brings the shaders that use it up to date, and no others") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "A.frag", "#include \"light.glsl\"\n" + kGood);
  WriteText(folder / "B.frag", kGood);
  ShaderLibrary library(folder.path());
  CHECK(library.Find("A") == nullptr);
  CHECK(test::Contains(library.Problems("A"), "light.glsl"));
  REQUIRE(library.Find("B") != nullptr);
  const unsigned other = library.Find("B")->program;

  WriteText(folder / "light.glsl", "#version 330\nuniform float u_warmth;  // @range 1 3 @default 2 @label Warmth\n");
  WriteText(folder / "A.frag", "#version 330\n#include \"light.glsl\"\n" + kGood.substr(kGood.find('\n') + 1));
  CHECK(library.ReloadChanged());
  INFO(Format(library.Problems("A")));
  REQUIRE(library.Find("A") != nullptr);
  REQUIRE(library.Parameters("A").size() == 1);
  CHECK(library.Parameters("A")[0].label == "Warmth");
  CHECK_FALSE(library.ReloadChanged());

  WriteText(folder / "light.glsl", "uniform float u_warmth;  // @range 1 9 @default 2 @label Warmth\n#include \"x\"\n");
  CHECK(library.ReloadChanged());
  CHECK(library.Parameters("A")[0].max == 9);
  CHECK(library.Find("A") != nullptr);  // The last good one.
  CHECK(test::Contains(library.Problems("A"), "\"x\""));
  WriteText(folder / "x", "\n");
  CHECK(library.ReloadChanged());
  CHECK(library.Problems("A").empty());
  CHECK(library.Find("B")->program == other);
}

TEST_CASE("parts of a shader draw other surfaces, share its parameters and are no shaders of their own") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  WriteText(folder / "Default.vert", kVertex);
  WriteText(folder / "A.frag", kGood);
  const std::string part = kGood + "uniform float u_own;  // @range 0 2\n";
  WriteText(folder / "A.plane.frag", part);
  ShaderLibrary library(folder.path());
  CHECK(library.names() == std::vector<std::string>{"A"});
  const ShaderProgram* own = library.Find("A");
  REQUIRE(own != nullptr);
  CHECK(library.Find("A", Surface::Sphere) == own);
  CHECK(library.Find("A", Surface::Background) == nullptr);
  CHECK(library.Problems("A").empty());
  REQUIRE(library.Find("A", Surface::Plane) != nullptr);
  CHECK(library.Find("A", Surface::Plane) != own);
  CHECK(library.Parameters("A").size() == 1);

  WriteText(folder / "A.background.frag", kBad);
  CHECK(library.ReloadChanged());
  CHECK(library.Find("A", Surface::Background) == nullptr);
  CHECK(test::Contains(library.Problems("A"), "A.background.frag"));
  WriteText(folder / "A.background.frag", kGood);
  std::filesystem::remove(folder / "A.plane.frag");
  CHECK(library.ReloadChanged());
  CHECK(library.Problems("A").empty());
  CHECK(library.Find("A", Surface::Background) != nullptr);
  CHECK(library.Find("A", Surface::Plane) == library.Find("A"));
  CHECK(library.Parameters("A").empty());
}
