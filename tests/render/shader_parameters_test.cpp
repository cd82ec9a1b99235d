#include "tests/render/render_fixture.h"

using namespace percale;

namespace {

std::vector<ShaderParameter> Parse(const std::string& text, Diagnostics& diagnostics) {
  return ParseShaderParameters(text, "a.frag", diagnostics);
}

}  // namespace

TEST_CASE("comments behind uniforms make parameters") {
  Diagnostics diagnostics;
  const auto parameters = Parse(
      "#version 330\n"
      "uniform vec4 u_color;\n"
      "uniform float u_shininess;  // @range 1 256 @default 32 @label Shininess\n"
      "  uniform highp vec3 u_upper ;//@color @default 0 0.25 0.75 @label Upper colour @help Of the flag\n"
      "uniform int u_axis; // @choices Horizontal | Vertical @default 1\n"
      "uniform bool u_lit; // @default true\n"
      "uniform vec3 u_wind = vec3(1, -2, 0.5); // @range -5 5\n"
      "// uniform float u_commented; // @range 0 1\n"
      "uniform float u_plain; // no annotation\r\n",
      diagnostics);
  INFO(Format(diagnostics));
  CHECK(diagnostics.empty());
  REQUIRE(parameters.size() == 5);
  CHECK(parameters[0].name == "u_shininess");
  CHECK(parameters[0].label == "Shininess");
  CHECK(parameters[0].min == 1);
  CHECK(parameters[0].max == 256);
  CHECK(parameters[0].defaultValue[0] == 32);
  CHECK(parameters[1].color);
  CHECK(parameters[1].type == ShaderParameter::Type::Vector);
  CHECK(parameters[1].defaultValue == UniformValue{0, 0.25f, 0.75f});
  CHECK(parameters[1].help == "Of the flag");
  CHECK(parameters[2].choices == std::vector<std::string>{"Horizontal", "Vertical"});
  CHECK(parameters[2].label == "axis");
  CHECK(parameters[2].defaultValue[0] == 1);
  CHECK(parameters[3].type == ShaderParameter::Type::Bool);
  CHECK(parameters[3].defaultValue[0] == 1);
  CHECK(parameters[4].defaultValue == UniformValue{1, -2, 0.5f});
}

TEST_CASE("numbers are read as GLSL writes them") {
  const std::pair<const char*, UniformValue> cases[] = {
      {"uniform float u_a = .5; // @range 0 1", {0.5f}},
      {"uniform float u_a = 1.; // @range 0. 4.", {1}},
      {"uniform float u_a = 0.25f; // @range .0 +1", {0.25f}},
      {"uniform float u_a; // @range 0 1 @default .5", {0.5f}},
      {"uniform vec3 u_a = vec3(.5); // @color", {0.5f, 0.5f, 0.5f}},
      {"uniform vec3 u_a = vec3 ( 1., .5, 0 ); // @color", {1, 0.5f, 0}},
      {"uniform bool u_a = true; // @label A", {1}},
      {"uniform float u_a = sqrt(2.0); // @range 0 2 @default 1.4142", {1.4142f}},
  };
  for (const auto& [source, value] : cases) {
    const std::string line = source;
    CAPTURE(line);
    Diagnostics diagnostics;
    const auto parameters = Parse(line, diagnostics);
    INFO(Format(diagnostics));
    CHECK(diagnostics.empty());
    REQUIRE(parameters.size() == 1);
    CHECK(parameters[0].defaultValue == value);
  }
}

TEST_CASE("annotations that make no sense are named with their line") {
  const std::pair<const char*, const char*> cases[] = {
      {"uniform float u_a; // @range 3 1", "two growing numbers"},
      {"uniform float u_a; // @range zero one", "two growing numbers"},
      {"uniform vec3 u_a; // @default 1 2", "3 numbers"},
      {"uniform float u_a; // @colour", "@colour is unknown"},
      {"uniform float u_a; // @color", "for a vec3"},
      {"uniform float u_a; // @choices a|b", "for an int"},
      {"uniform mat4 u_a; // @range 0 1", "found mat4"},
      {"uniform float u_a; // @range 0 1 @default 7", "outside of the range"},
      {"uniform float u_a; // @range 0 nan", "two growing numbers"},
      {"uniform float u_a = sqrt(2.0); // @range 0 2", "\"sqrt(2.0)\" is not read here"},
      {"uniform float u_a = 1.0 / 3.0; // @range 0 2", "state it as @default"},
  };
  for (const auto& [source, message] : cases) {
    const std::string line = source;
    CAPTURE(line);
    Diagnostics diagnostics;
    Parse("\n\n" + line + "\n", diagnostics);
    REQUIRE(diagnostics.size() == 1);
    CHECK(diagnostics[0].severity == Severity::Warning);
    CHECK(diagnostics[0].place.line == 3);
    CHECK(diagnostics[0].message.find(message) != std::string::npos);
  }
}

TEST_CASE("the project's own shaders have sound annotations, and come in the course's order") {
  const std::vector<std::string> names = ListShaders("shaders");
  const std::vector<std::string> course = {"Wireframe", "Normal",       "Diffuse", "Phong", "Texture",
                                           "Bump",      "Displacement", "Mirror",  "Flag"};
  REQUIRE(names.size() >= course.size());
  CHECK(std::vector<std::string>(names.begin(), names.begin() + 9) == course);
}
