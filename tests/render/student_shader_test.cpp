// A pair of shaders as a student of the course would hand in: written against the documented names
// alone. The fragment shader checks everything that it is given, one bit per fact.

#include <cmath>

#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;

namespace {

const char* kVertex = R"(#version 330
uniform mat4 u_model;
uniform mat4 u_view_projection;
in vec4 in_position;
in vec4 in_normal;
in vec4 in_tangent;
in vec2 in_uv;
out vec4 v_position;
out vec4 v_normal;
out vec2 v_uv;
out vec4 v_tangent;
out vec4 v_raw_position;
out vec4 v_clip;
void main() {
  v_raw_position = in_position;
  v_position = u_model * in_position;
  v_normal = normalize(u_model * in_normal);
  v_tangent = normalize(u_model * in_tangent);
  v_uv = in_uv;
  v_clip = u_view_projection * u_model * in_position;
  gl_Position = v_clip;
}
)";

const char* kFragment = R"(#version 330
uniform mat4 u_model;
uniform vec4 u_color;
uniform vec3 u_cam_pos;
uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;
uniform sampler2D u_texture_1;
uniform sampler2D u_texture_2;
uniform sampler2D u_texture_3;
uniform sampler2D u_texture_4;
uniform vec2 u_texture_1_size;
uniform vec2 u_texture_2_size;
uniform vec2 u_texture_3_size;
uniform vec2 u_texture_4_size;
uniform samplerCube u_texture_cubemap;
uniform float u_normal_scaling;
uniform float u_height_scaling;
in vec4 v_position;
in vec4 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
in vec4 v_raw_position;
in vec4 v_clip;
out vec4 out_color;

bool near(float a, float b) { return abs(a - b) < 0.004; }
bool near(vec2 a, vec2 b) { return near(a.x, b.x) && near(a.y, b.y); }
bool near(vec3 a, vec3 b) { return near(a.xy, b.xy) && near(a.z, b.z); }
bool near(vec4 a, vec4 b) { return near(a.xyz, b.xyz) && near(a.w, b.w); }

void main() {
  int facts = 0, more = 0;
  if (near(v_raw_position.w, 1.0)) facts += 1;
  if (near(v_normal, vec4(0, 0, 1, 0))) facts += 2;
  if (near(v_tangent, vec4(1, 0, 0, 0))) facts += 4;
  if (near(v_uv, vec2(v_position.x, 1.0 - v_position.y))) facts += 8;
  if (u_model == mat4(1)) facts += 16;
  if (near(v_clip.xy / v_clip.w * 0.5 + 0.5, gl_FragCoord.xy / 64.0)) facts += 32;
  if (near(u_color, vec4(0.2, 0.4, 0.6, 1.0))) facts += 64;
  if (near(u_cam_pos, vec3(0.5, 0.5, 2.3))) facts += 128;

  if (near(u_light_pos, vec3(0.5, 2, 2))) more += 1;
  if (near(u_light_intensity, vec3(3))) more += 2;
  if (u_texture_1_size == vec2(2, 2) && u_texture_2_size == vec2(4, 2) && u_texture_3_size == vec2(8, 8) &&
      u_texture_4_size == vec2(16, 4)) more += 4;
  if (near(texture(u_texture_1, v_uv).rgb, vec3(0.2, 0, 0)) && near(texture(u_texture_2, v_uv).rgb, vec3(0, 0.4, 0)) &&
      near(texture(u_texture_3, v_uv).rgb, vec3(0, 0, 0.6)) && near(texture(u_texture_4, v_uv).rgb, vec3(0.8, 0, 0.8))) more += 8;
  if (near(texture(u_texture_1, v_uv + vec2(7, -3)), texture(u_texture_1, v_uv))) more += 16;
  if (near(texture(u_texture_cubemap, vec3(1, 0, 0)).r, 0.2) && near(texture(u_texture_cubemap, vec3(0, 0, -1)).r, 0.7)) more += 32;
  if (near(u_normal_scaling, 2.0)) more += 64;
  if (near(u_height_scaling, 0.1)) more += 128;
  out_color = vec4(float(facts) / 255.0, float(more) / 255.0, 1.0, 1.0);
}
)";

void WriteSolid(const std::filesystem::path& file, int width, int height, double r, double g, double b) {
  Image image = MakeImage(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    image.rgba[i] = std::uint8_t(std::lround(255 * r));
    image.rgba[i + 1] = std::uint8_t(std::lround(255 * g));
    image.rgba[i + 2] = std::uint8_t(std::lround(255 * b));
  }
  Must(WritePng(file, image));
}

}  // namespace

TEST_CASE("a student's own shaders get every attribute and uniform that the course documents") {
  const test::TemporaryFolder root;
  std::filesystem::create_directories(root / "textures/cube");
  test::WriteText(root / "shaders/Student.vert", kVertex);
  test::WriteText(root / "shaders/Student.frag", kFragment);
  WriteSolid(root / "textures/texture_1.png", 2, 2, 0.2, 0, 0);
  WriteSolid(root / "textures/texture_2.png", 4, 2, 0, 0.4, 0);
  WriteSolid(root / "textures/texture_3.png", 8, 8, 0, 0, 0.6);
  WriteSolid(root / "textures/texture_4.png", 16, 4, 0.8, 0, 0.8);
  double shade = 0.2;
  for (const char* face : {"posx", "negx", "posy", "negy", "posz", "negz"}) {
    WriteSolid(root / ("textures/cube/" + std::string(face) + ".png"), 4, 4, shade, 0, 0);
    shade += 0.1;
  }

  Scene scene;
  scene.cloths.resize(1);
  View view = View::ForScene(scene);
  view.look.shader = "Student";
  view.look.color = {0.2, 0.4, 0.6};
  const test::TestCloth cloth(test::Grid(6), test::Upright);
  Painter painter = Must(Painter::Open({.root = root.path(), .width = 64, .height = 64, .samples = 1}));
  const std::vector<ClothShape> cloths = {cloth.Shape()};
  const Result<Image> image = painter.Paint(scene, cloths, view);
  INFO(Format(image.diagnostics()));
  REQUIRE(image.ok());
  CHECK(image.diagnostics().empty());
  for (const auto& [x, y] : {std::pair{32, 32}, std::pair{25, 38}, std::pair{40, 24}}) {
    CHECK(int(image->At(x, y)[0]) == 255);
    CHECK(int(image->At(x, y)[1]) == 255);
    CHECK(int(image->At(x, y)[2]) == 255);
  }
}
