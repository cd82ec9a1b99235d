#include "render/shader_values.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace percale;
namespace fs = std::filesystem;

namespace {

fs::path File() {
  const fs::path folder = fs::temp_directory_path() / "percale_shader_values_test";
  fs::create_directories(folder);
  return ShaderValuesFile(folder, "Some");
}
void Write(const std::string& text) {
  std::ofstream(File()) << text;
}
std::string Read() {
  std::ifstream stream(File());
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<ShaderParameter> Some() {
  Diagnostics ignored;
  return ParseShaderParameters(
      "uniform float u_shine;  // @range 1 256\n"
      "uniform vec3 u_upper;  // @color\n"
      "uniform int u_axis;  // @choices Horizontal|Vertical\n"
      "uniform bool u_lit;  // @default 1\n",
      "Some.frag", ignored);
}

}  // namespace

TEST_CASE("values come back as they were kept") {
  const UniformValues values = {
      {"u_shine", {12.1f, 0, 0}}, {"u_upper", {0, 0.34f, 0.72f}}, {"u_lit", {0, 0, 0}}, {"u_gone", {3, 0, 0}}};
  REQUIRE(SaveShaderValues(File(), values, Some()));
  CHECK(Read().find("\"u_lit\": false") != std::string::npos);
  const auto read = LoadShaderValues(File(), Some());
  REQUIRE(read);
  CHECK(read.diagnostics().empty());
  CHECK(*read == values);
  // Once its parameter is there again it is a number.
  std::vector<ShaderParameter> more = Some();
  more.push_back(more.front());
  more.back().name = "u_gone";
  CHECK(*LoadShaderValues(File(), more) == values);
  REQUIRE(SaveShaderValues(File(), {}, Some()));
  CHECK_FALSE(fs::exists(File()));
  CHECK(LoadShaderValues(File(), Some())->empty());
}

TEST_CASE("what does not fit is left out, with its place") {
  Write(
      "{\n  \"u_shine\": 500,\n  \"u_upper\": 1,\n  \"u_axis\": 0.5,\n  \"u_lit\": 1,\n  \"u_upperr\": [0, 0, 0]\n}\n");
  const auto read = LoadShaderValues(File(), Some());
  REQUIRE(read);
  CHECK(read->size() == 1);
  REQUIRE(read.diagnostics().size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(read.diagnostics()[i].severity == Severity::Warning);
    CHECK(read.diagnostics()[i].place.line == static_cast<int>(i) + 2);
  }
  CHECK(read.diagnostics()[0].message == "u_shine: expected a number 1..256, got 500");
  CHECK(read.diagnostics()[4].message.find("did you mean `u_upper`?") != std::string::npos);
  for (const char* text : {"", "{", "[1]", "{\"u_lit\": true, \"u_lit\": false}"}) {
    Write(text);
    const auto broken = LoadShaderValues(File(), Some());
    REQUIRE_FALSE(broken);
    CHECK_FALSE(broken.diagnostics().front().place.file.empty());
  }
}
