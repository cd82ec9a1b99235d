#include "render/shader_text.h"

#include <iterator>
#include <tuple>

#include "render/child_process.h"
#include "render/headless.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;
using percale::test::TemporaryFolder;
using percale::test::WriteText;

namespace {

/// Whether the reference compiler takes the text as a shader for the web.
bool CompilesForTheWeb(const std::filesystem::path& validator, const std::string& text, const std::string& stage) {
  ChildProcess compiler = Must(ChildProcess::Start(validator, {"--stdin", "-S", stage}));
  compiler.Write(text.data(), text.size());
  std::string reason;
  return compiler.Finish(reason);
}

}  // namespace

TEST_CASE("an included file stands where it is included, and each line knows where it was read") {
  const TemporaryFolder folder;
  WriteText(folder / "a.frag", "#version 330\n  # include \"sub/b.glsl\"  // shared\nlast\n");
  WriteText(folder / "sub/b.glsl", "#version 330\nfirst\n#include \"c.glsl\"\nthird");
  WriteText(folder / "c.glsl", "second\n");
  const ShaderText text = ReadShaderText(folder / "a.frag");
  INFO(Format(text.problems));
  CHECK(text.problems.empty());
  CHECK(text.text == "#version 330\n\nfirst\nsecond\nthird\nlast\n");
  REQUIRE(text.files.size() == 3);
  REQUIRE(text.lines.size() == 6);
  const std::tuple<int, const char*, int, const char*> places[] = {
      {1, "a.frag", 1, "#version 330"}, {3, "sub/b.glsl", 2, "first"}, {4, "c.glsl", 1, "second"},
      {5, "sub/b.glsl", 4, "third"},    {6, "a.frag", 3, "last"},
  };
  for (const auto& [line, file, number, excerpt] : places) {
    const Diagnostic at = text.At(line);
    CHECK(at.place.file == (folder / file).string());
    CHECK(at.place.line == number);
    CHECK(at.excerpt == excerpt);
  }
}

TEST_CASE("a text without includes stays as it is") {
  const TemporaryFolder folder;
  const std::string plain = "#version 330\r\n// #include \"a\"\n/* the line\n#include \"b\"\n*/ void main() {}\n";
  WriteText(folder / "a.frag", plain);
  const ShaderText text = ReadShaderText(folder / "a.frag");
  CHECK(text.problems.empty());
  CHECK(text.text == plain);
}

TEST_CASE("a file that two others need is included once") {
  const TemporaryFolder folder;
  WriteText(folder / "a.frag", "#include \"b\"\n#include \"c\"\n#include \"./b\"\n");
  WriteText(folder / "b", "#include \"d\"\nb\n");
  WriteText(folder / "c", "#include \"d\"\nc\n");
  WriteText(folder / "d", "d\n");
  const ShaderText text = ReadShaderText(folder / "a.frag");
  CHECK(text.problems.empty());
  CHECK(text.text == "d\nb\nc\n");
}

TEST_CASE("a shader may be made of another one whole: the first version line counts") {
  const TemporaryFolder folder;
  WriteText(folder / "a.frag", "#include \"b\"\n#include \"c\"\n");
  WriteText(folder / "b", "#version 330\nb\n");
  WriteText(folder / "c", "# version 330\nc\n");
  CHECK(ReadShaderText(folder / "a.frag").text == "#version 330\nb\n\nc\n");
}

TEST_CASE("an include that cannot be followed is an error with its place") {
  const TemporaryFolder folder;
  WriteText(folder / "loop", "\n#include \"loop\"\n");
  const std::pair<const char*, const char*> cases[] = {
      {"#include \"gone.glsl\"", "does not exist"},
      {"#include \"../a.frag\"", "in the shader's folder"},
      {"#include \"sub/../../a.frag\"", "in the shader's folder"},
      {"#include \"/etc/hostname\"", "in the shader's folder"},
      {"#include \"C:\\\\a\"", "in the shader's folder"},
      {"#include <a.glsl>", "expected #include \"file\""},
      {"#include \"a.glsl\" extra", "expected #include \"file\""},
      {"#include \"\"", "expected #include \"file\""},
      {"#include \"a.frag\"", "circle"},
  };
  for (const auto& [line, message] : cases) {
    const std::string source = line;
    CAPTURE(source);
    WriteText(folder / "a.frag", "#version 330\n\n" + source + "\nvoid main() {}\n");
    const ShaderText text = ReadShaderText(folder / "a.frag");
    REQUIRE(text.problems.size() == 1);
    CHECK(HasErrors(text.problems));
    CHECK(text.problems[0].place.file == (folder / "a.frag").string());
    CHECK(text.problems[0].place.line == 3);
    CHECK(text.problems[0].excerpt == source);
    CHECK(test::Contains(text.problems, message));
  }
  WriteText(folder / "a.frag", "#include \"loop\"\n");
  const ShaderText text = ReadShaderText(folder / "a.frag");
  REQUIRE(text.problems.size() == 1);
  CHECK(text.problems[0].place.file == (folder / "loop").string());
  CHECK(text.problems[0].place.line == 2);
}

TEST_CASE("every shader of the project compiles for the web, and a broken one does not") {
  const std::filesystem::path validator = FindProgram("glslangValidator");
  if (validator.empty()) {
    MESSAGE("glslangValidator is not installed: shaders for the web are not compiled");
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("shaders")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".frag" && extension != ".vert") continue;
    CAPTURE(entry.path().string());
    const ShaderText text = ReadShaderText(entry.path());
    CHECK(text.problems.empty());
    CHECK(CompilesForTheWeb(validator, ToEs300(text.text), extension.substr(1)));
    ++count;
  }
  CHECK(count >= 11);
  const TemporaryFolder folder;
  const ShaderText fresh = ReadShaderText(Must(CreateShader(folder.path(), "Fresh")));
  CHECK(CompilesForTheWeb(validator, ToEs300(fresh.text), "frag"));

  // What desktop OpenGL takes, and the web does not: a whole number where a float is due.
  const std::string good =
      "// First a comment.\n#version 330\nout vec4 out_color;\nvoid main() {\n"
      "  float x = 1.0;\n  out_color = vec4(x);\n}\n";
  std::string broken = good;
  broken.replace(broken.find("1.0"), 3, "1");
  CHECK(CompilesForTheWeb(validator, ToEs300(good), "frag"));
  CHECK_FALSE(CompilesForTheWeb(validator, ToEs300(broken), "frag"));
}

TEST_CASE("the text for the web begins with its version, and keeps the numbers of its lines") {
  const std::string text = "// A shader.\n#version 330 core\nvoid main() {}\n";
  const std::string es = ToEs300(text);
  CHECK(es.rfind("#version 300 es\n", 0) == 0);
  CHECK(es.find("330") == std::string::npos);
  const std::size_t body = es.find("#line 1\n");
  REQUIRE(body != std::string::npos);
  CHECK(es.substr(body + 8) == "// A shader.\n\nvoid main() {}\n");
}

TEST_CASE("a new shader is made from a template that compiles and has parameters") {
  const HeadlessContext context = Must(HeadlessContext::Create());
  const TemporaryFolder folder;
  std::filesystem::copy("shaders/Default.vert", folder / "Default.vert");
  CHECK(Must(CreateShader(folder.path(), "My_shader-2")) == folder / "My_shader-2.frag");
  ShaderLibrary library(folder.path());
  CHECK(library.names() == std::vector<std::string>{"My_shader-2"});
  INFO(Format(library.Problems("My_shader-2")));
  CHECK(library.Problems("My_shader-2").empty());
  CHECK(library.Find("My_shader-2") != nullptr);
  CHECK(library.Parameters("My_shader-2").size() == 2);
}

TEST_CASE("a new shader needs a plain name that is new, and a folder") {
  const TemporaryFolder folder;
  WriteText(folder / "Taken.frag", "mine");
  WriteText(folder / "Moved.vert", "mine");
  const std::string tooLong(200, 'a');
  for (const std::string& name :
       {std::string(), std::string("a b"), std::string("../a"), std::string("a/b"), std::string("a.plane"),
        std::string("ä"), std::string("Taken"), std::string("Moved"), tooLong}) {
    CAPTURE(name);
    const auto made = CreateShader(folder.path(), name);
    CHECK_FALSE(made.ok());
    CHECK_FALSE(made.diagnostics().front().message.empty());
  }
  CHECK(folder.EntryCount() == 2);
  std::ifstream kept(folder / "Taken.frag");
  CHECK(std::string{std::istreambuf_iterator<char>(kept), {}} == "mine");
  CHECK_FALSE(CreateShader(folder / "nowhere", "A").ok());
}
