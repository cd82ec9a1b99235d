#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/mesh_source.h"
#include "math/splitmix64.h"
#include "mesh/mesh_problems.h"
#include "mesh/rest_mesh.h"
#include "mesh/topology.h"
#include "percale/mesh_file.h"

using namespace percale;
namespace fs = std::filesystem;

namespace {

using Ids = std::vector<std::int32_t>;

/// An empty folder that goes away with the test.
class Folder {
 public:
  Folder() {
    for (int i = 0;; ++i) {
      path_ = fs::temp_directory_path() / ("percale mesh_import " + std::to_string(i));
      if (fs::create_directory(path_)) break;
    }
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }
  /// The file with that text in it.
  fs::path With(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

std::string Contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The mesh of a file that has nothing to be told of.
RestMesh Good(const fs::path& file, const MeshOptions& options = {}) {
  const auto mesh = LoadMesh(file, options);
  CHECK(Format(mesh.diagnostics()) == "");
  REQUIRE(mesh);
  return *mesh;
}

/// What is said about a text under that name, with the place: ":LINE:COLUMN: error: ...".
std::string Said(const Folder& folder, const std::string& name, const std::string& text,
                 const MeshOptions& options = {}) {
  const fs::path file = folder.With(name, text);
  const auto mesh = LoadMesh(file, options);
  CHECK(mesh.ok() == !HasErrors(mesh.diagnostics()));
  std::string out;
  for (Diagnostic diagnostic : mesh.diagnostics()) {
    CHECK(diagnostic.place.file == PathText(file));
    diagnostic.place.file = "FILE";
    diagnostic.excerpt.clear();
    out += Format(diagnostic);
  }
  return out;
}

std::vector<std::array<int, 3>> Indices(const RestMesh& mesh) {
  std::vector<std::array<int, 3>> out;
  for (const Triangle& t : mesh.triangles) out.push_back({t.a, t.b, t.c});
  return out;
}

double Area(const RestMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += MaterialArea(mesh.material, t);
  return area;
}

/// Everything that LoadMesh promises of what it returns.
void CheckSound(const RestMesh& mesh) {
  CHECK(!mesh.triangles.empty());
  CHECK(mesh.material.size() == 3 * mesh.triangles.size());
  CHECK(mesh.uv.size() == mesh.positions.size());
  CHECK(mesh.source.size() == mesh.positions.size());
  const MeshProblems problems = FindMeshProblems(mesh);
  CHECK_FALSE(problems.HasErrors());
  CHECK(problems.duplicates.empty());
  CHECK(problems.unreferenced.empty());
  CHECK(problems.turned.empty());
  CHECK(problems.mirrored.empty());
  for (const VertexGroup& group : mesh.groups) {
    CHECK(std::is_sorted(group.vertices.begin(), group.vertices.end()));
    CHECK((group.vertices.empty() ||
           (group.vertices.front() >= 0 && std::size_t(group.vertices.back()) < mesh.positions.size())));
  }
}

Scene SmallScene() {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = 5;
  cloth.numHeightPoints = 4;
  cloth.orientation = Orientation::Vertical;
  cloth.pinned = {{0, 0}, {4, 0}};
  scene.cloths = {cloth, cloth};
  scene.cloths[1].origin = {3, 0, 0.1};
  return scene;
}

/// A file of a moved cloth, written by the program's own writer.
fs::path Written(const Folder& folder, const World& world, const std::string& name) {
  auto writer = CacheWriter::Open(folder / name, 0.1);
  REQUIRE(writer);
  REQUIRE(writer->Add(world, 3));
  REQUIRE(writer->Finish());
  return folder / name;
}

/// Numbers in the order of bytes of a binary PLY.
class Bytes {
 public:
  explicit Bytes(bool bigEndian) : bigEndian_(bigEndian) {}
  template <class T>
  Bytes& Add(T number) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &number, sizeof(T));
    if (bigEndian_) std::reverse(bytes, bytes + sizeof(T));
    text_.append(bytes, sizeof(T));
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool bigEndian_;
  std::string text_;
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("What the writers write is read as the same mesh") {
  const Folder folder;
  World world(SmallScene(), {.threads = 1});
  for (int i = 0; i < 40; ++i) world.Step();
  for (const char* name : {"a.obj", "a.ply"}) {
    const RestMesh mesh = Good(Written(folder, world, name));
    CheckSound(mesh);
    CHECK(mesh.name == "a");
    const bool exact = std::string(name) == "a.ply";
    std::size_t v = 0, t = 0;
    for (int c = 0; c < world.ClothCount(); ++c) {
      const ClothView cloth = world.Cloth(c);
      const auto first = std::int32_t(v);
      for (std::size_t i = 0; i < cloth.positions().size(); ++i, ++v) {
        CHECK(Length(mesh.positions[v] - cloth.positions()[i]) <= (exact ? 0 : 1e-8));
        CHECK(mesh.uv[v].x == doctest::Approx(cloth.uv()[i].x));
        CHECK(mesh.uv[v].y == doctest::Approx(cloth.uv()[i].y));
        CHECK(mesh.source[v] == std::int32_t(v));
      }
      for (std::size_t i = 0; i < cloth.triangles().size(); ++i, ++t) {
        CHECK(mesh.triangles[t].a == first + cloth.triangles()[i].a);
        CHECK(mesh.triangles[t].b == first + cloth.triangles()[i].b);
        CHECK(mesh.triangles[t].c == first + cloth.triangles()[i].c);
      }
    }
    CHECK(mesh.positions.size() == v);
    CHECK(mesh.triangles.size() == t);
    if (exact) continue;
    REQUIRE(mesh.groups.size() == 2);
    CHECK(mesh.groups[0].name == "cloth0");
    CHECK(mesh.groups[1].vertices.front() == 20);
    CHECK(mesh.groups[1].vertices.size() == 20);
  }
}

TEST_CASE("OBJ in its many spellings is one mesh") {
  const Folder folder;
  const std::vector<std::array<int, 3>> expected{{0, 1, 2}, {0, 2, 3}};
  const std::string uv = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n", normal = "vn 0 0 1\n";
  for (const std::string& text : {
           kSquare + "f 1 2 3\nf 1 3 4\n",
           kSquare + "f 1 2 3 4\n",
           kSquare + "f -4 -3 -2 -1\n",
           kSquare + uv + "f 1/1 2/2 3/3 4/4\n",
           kSquare + uv + normal + "f 1/1/1 2/2/1 3/3/1 4/4/1\n",
           kSquare + uv + normal + "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n",
           kSquare + normal + "f 1//1 2//1 3//1 4//1\n",
           kSquare + "f 1/ 2// 3/ 4\n",
           kSquare + "f 1 2 \\\n 3 \\\r\n4\n",
           kSquare + "f 1 2 3 4 # a square\n# done \\\n",
           "# heading /\\_/\\\n" + kSquare + "\n\n  \t\nf\t1  2\t3 4  \n",
           std::string("\xef\xbb\xbf") + kSquare + "f 1 2 3 4\n",
           std::string("v 0.0 -0 0e0\r\nv +1 0. .0\r\nv 1.0e0 1E+0 0 1.0\r\nv 0 10e-1 0 0.5 0.5 0.5\r\nf 1 2 3 4\r\n"),
           std::string("v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r"),
           "mtllib a b.mtl\no square\n" + kSquare + "usemtl red#1\ns off\ng\nf 1 2 3 4\n",
       }) {
    CAPTURE(text);
    const RestMesh mesh = Good(folder.With("a.obj", text));
    CHECK(Indices(mesh) == expected);
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(mesh.uv == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CHECK(Area(mesh) == doctest::Approx(1));
    CheckSound(mesh);
  }
}

TEST_CASE("PLY in its many spellings is one mesh") {
  const Folder folder;
  const auto check = [&](const std::string& text) {
    CAPTURE(text);
    const RestMesh mesh = Good(folder.With("a.ply", text));
    CHECK(Indices(mesh) == std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(mesh.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(mesh.uv == std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CheckSound(mesh);
  };
  check(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  check(
      "ply\r\ncomment what\r\nformat ascii 1.0\r\nobj_info x\r\nelement vertex 4\r\nproperty double z\r\n"
      "property uchar red\r\nproperty double y\r\nproperty float64 x\r\nproperty float texture_u\r\n"
      "property float texture_v\r\nelement note 2\r\nproperty list uint8 float32 numbers\r\nproperty int kind\r\n"
      "element face 1\r\nproperty uchar flags\r\nproperty list int uint vertex_index\r\nend_header\r\n"
      "0 7 0 0 0 0\r\n0 7 0 1 1 0\r\n\r\n0 7 1 1 1 1\r\n0 7 1 0 0 1\r\n3 nan nan 1 4\r\n0 4\r\n9 4 0 1 2 3\r\n");
  for (const bool bigEndian : {false, true}) {
    const std::string format = std::string("ply\nformat binary_") + (bigEndian ? "big" : "little") + "_endian 1.0\n";
    Bytes plain(bigEndian);
    plain.Add(std::uint8_t{4}).Add(std::uint16_t{0}).Add(std::uint16_t{1}).Add(std::uint16_t{2}).Add(std::uint16_t{3});
    const Vec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const Vec2& c : corners) plain.Add(c.x).Add(c.y).Add(std::int8_t{0}).Add(float(c.x)).Add(float(c.y));
    check(format +
          "element face 1\nproperty list uchar ushort vertex_indices\n"
          "element vertex 4\nproperty double x\nproperty double y\nproperty char z\nproperty float s\n"
          "property float t\nend_header\n" +
          plain.text());

    // Texture coordinates of the corners; floats as numbers of vertices; an element between.
    Bytes wedges(bigEndian);
    for (const Vec2& c : corners) wedges.Add(std::int16_t(c.x)).Add(std::int32_t(c.y)).Add(std::uint32_t{0});
    wedges.Add(std::int16_t{2}).Add(1.0).Add(2.0).Add(std::int16_t{0});
    wedges.Add(std::uint32_t{4}).Add(0.f).Add(1.f).Add(2.f).Add(3.f).Add(std::uint8_t{8});
    for (const Vec2& c : corners) wedges.Add(float(c.x)).Add(float(c.y));
    check(format +
          "element vertex 4\nproperty short x\nproperty int y\nproperty uint z\n"
          "element other 2\nproperty list short double values\n"
          "element face 1\nproperty list uint float vertex_indices\nproperty list uchar float texcoord\nend_header\n" +
          wedges.text());
  }
}

TEST_CASE("A number is read to the bit, as the C library reads it") {
  SplitMix64 random(11);
  for (int i = 0; i < 20000; ++i) {
    char text[64];
    const std::uint64_t bits = random.Next();
    double number;
    std::memcpy(&number, &bits, 8);
    if (!std::isfinite(number)) continue;
    if (i % 2 == 0) number = (random.NextUnit() - 0.5) * std::pow(10.0, double(random.Next() % 12));
    std::snprintf(text, sizeof text, i % 3 == 0 ? "%.9g" : i % 3 == 1 ? "%.17g" : "%.25e", number);
    const auto read = MeshNumber(text);
    REQUIRE(read);
    const double expected = std::strtod(text, nullptr);
    if (std::abs(expected) < 1e-300) continue;  // too small for the fallback, and for a mesh
    CHECK(*read == expected);
  }
  for (const char* text : {"", "-", "+", ".", "e5", "1e", "1e+", "1.2.3", "0x10", "1_000", "nan", "inf", "1 ", "--1"})
    CHECK_FALSE(MeshNumber(text));
  CHECK(std::isinf(*MeshNumber("1e400")));
  CHECK(*MeshNumber("-1e99999999999999999999") < 0);
  CHECK(*MeshNumber("0e99999999999") == 0);
  CHECK(*MeshNumber("1e-99999999999") == 0);
  CHECK(*MeshNumber(std::string(300, '0') + "1." + std::string(300, '0')) == 1);
}

TEST_CASE("A polygon becomes triangles that cover it, also where it is concave") {
  const Folder folder;
  // An arrow head: from the corner at its notch, or from its tip.
  for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
    const RestMesh mesh =
        Good(folder.With("a.obj", std::string("v 0 0 0\nv 2 -1 0\nv 0 3 0\nv -2 -1 0\n") + face + "\n"));
    CHECK(mesh.triangles.size() == 2);
    CHECK(Area(mesh) == doctest::Approx(6));
  }
  // An L, which one fan covers; and an E, which none does.
  const std::string l = "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 3 4 5 6 1 2\n";
  CHECK(Area(Good(folder.With("a.obj", l))) == doctest::Approx(5));
  const std::string e =
      "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 2 0\nv 3 2 0\nv 3 3 0\nv 1 3 0\nv 1 4 0\nv 3 4 0\nv 3 5 0\nv 0 5 0\n"
      "f 1 2 3 4 5 6 7 8 9 10 11 12\n";
  CHECK(Has(Said(folder, "a.obj", e), "FILE:13:1: warning: 1 polygon is so concave"));
}

TEST_CASE("Corners twice in a row, and on a line, do no harm") {
  const Folder folder;
  for (const char* face : {"f 1 2 3 3", "f 1 1 2 3", "f 3 1 2 3", "f 1 1 2 2 3 3 1"}) {
    const RestMesh mesh = Good(folder.With("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n" + std::string(face) + "\n"));
    CHECK(mesh.triangles.size() == 1);
  }
  CHECK(Area(Good(folder.With("a.obj", kSquare + "v 0.5 0 0\nf 1 5 2 3 4\n"))) == doctest::Approx(1));
  CHECK(Area(Good(folder.With("a.obj", kSquare + "f 1 2 3\nv 0.5 0.5 0\nf 1 5 3 4\n"))) == doctest::Approx(1));
  for (const char* face : {"f 1 1 1 1 1", "f 1 1 2 2", "f 1 2 1 2", "f 1 2 1"}) {
    const std::string said = Said(folder, "a.obj", kSquare + "f 1 2 3\n" + face + "\n");
    CHECK_MESSAGE(Has(said, "FILE:6:1: error"), said);
    CHECK(Has(said, "the same vertex twice"));
  }
}

TEST_CASE("Objects and groups become groups of vertices") {
  const Folder folder;
  const RestMesh mesh =
      Good(folder.With("a.obj",
                       "o left sleeve\nv 0 0 0\nv 1 0 0\nv 1 1 0\ng cuff hem\nf 1 2 3\ng\nv 0 1 0\nf 1 3 4\no body\n"
                       "v 5 0 0\nv 6 0 0\nv 6 1 0\nf 5 6 7\ng cuff\nv 7 1 0\nf 7 6 8\n"));
  REQUIRE(mesh.groups.size() == 4);
  CHECK(mesh.groups[0].name == "left sleeve");
  CHECK(mesh.groups[0].vertices == Ids{0, 1, 2, 3});
  CHECK(mesh.groups[1].name == "cuff");
  CHECK(mesh.groups[1].vertices == Ids{0, 1, 2, 5, 6, 7});
  CHECK(mesh.groups[2].name == "hem");
  CHECK(mesh.groups[2].vertices == Ids{0, 1, 2});
  CHECK(mesh.groups[3].name == "body");
  CHECK(mesh.groups[3].vertices == Ids{4, 5, 6, 7});
}

TEST_CASE("Scale, and the rest shape from the texture") {
  const Folder folder;
  const fs::path file = folder.With("a.obj",
                                    "v 0 0 0\nv 100 0 0\nv 100 0 50\nv 0 0 50\nvt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\n"
                                    "f 1/1 2/2 3/3 4/4\n");
  CHECK(Area(Good(file, {.scale = 0.01})) == doctest::Approx(0.5));
  const RestMesh twice = Good(file, {.scale = 0.01, .rest = RestShape::Texture, .metresPerUv = 1.2});
  CHECK(Area(twice) == doctest::Approx(0.5 * 1.44));
  CHECK(twice.positions[2] == Vec3{1, 0, 0.5});
  CheckSound(twice);
  // The warning's advice, followed.
  const auto far = LoadMesh(file, {.rest = RestShape::Texture});
  REQUIRE(far);
  CHECK(Has(Format(far.diagnostics()), "; 100 m per unit of the texture"));
  Good(file, {.rest = RestShape::Texture, .metresPerUv = 100});

  // The warp where there is no texture.
  const RestMesh plain = Good(folder.With("b.obj", kSquare + "f 1 2 3 4\n"), {.warp = Vec3{0, 2, 0}});
  CHECK(plain.material[1] == Vec2{0, -1});
}

TEST_CASE("A texture that lies over itself is told, mirrored panels are not") {
  const Folder folder;
  const auto said = [&](const std::string& uv) {
    return Said(folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + uv + "f 1/1 2/2 3/3\nf 2/4 4/5 3/6\n",
                {.rest = RestShape::Texture});
  };
  CHECK(said("vt 0 0\nvt 1 0\nvt 0 1\nvt 1 0\nvt 1 1\nvt 0 1\n").empty());
  const std::string folded = said("vt 0 0\nvt 1 0\nvt 0 1\nvt 1 0\nvt 0.2 0.2\nvt 0 1\n");
  CHECK_MESSAGE(
      Has(folded, "FILE:12:1: warning: 1 triangle lies over its neighbour in the texture (1, counted from 0)"), folded);
  // All of it turned over, and the second triangle as a panel of its own that is mirrored.
  CHECK(said("vt 0 0\nvt 0 1\nvt 1 0\nvt 0 1\nvt 1 1\nvt 1 0\n").empty());
  CHECK(said("vt 0 0\nvt 1 0\nvt 0 1\nvt 3 1\nvt 3 0\nvt 4 1\n").empty());
}

TEST_CASE("A seam: two panels of one texture are sewn, and each keeps its place in the fabric") {
  const Folder folder;
  // Two squares side by side whose common vertices are there twice, almost at the same place.
  const auto text = [](const std::string& x) {
    return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv " + x + " 0 0\nv 2 0 0\nv 2 1 0\nv " + x +
           " 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 0\nvt 6 0\nvt 6 1\nvt 5 1\n"
           "f 1/1 2/2 3/3 4/4\ng right\nf 5/5 6/6 7/7 8/8\n";
  };
  const fs::path same = folder.With("a.obj", text("1")), near = folder.With("b.obj", text("1.0001"));
  const MeshOptions sew{.rest = RestShape::Texture, .weld = true};
  CHECK(Good(same, {.rest = RestShape::Texture}).positions.size() == 8);
  CHECK(Good(near, sew).positions.size() == 8);
  MeshOptions loosely = sew;
  loosely.weldDistance = 0.001;
  for (const RestMesh& mesh : {Good(same, sew), Good(near, loosely), Good(same, loosely)}) {
    CHECK(mesh.positions.size() == 6);
    CHECK(mesh.source == Ids{0, 1, 2, 3, 5, 6});
    CHECK(Indices(mesh) == std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
    CHECK(mesh.groups[0].vertices == Ids{1, 2, 4, 5});
    CHECK(mesh.material[1] == Vec2{1, 0});
    CHECK(mesh.material[6] == Vec2{5, 0});  // the same vertex in the other panel
    CHECK(BuildTopology(mesh.positions.size(), mesh.triangles).boundaryEdges.size() == 6);
    CheckSound(mesh);
  }
}

TEST_CASE("Welding takes what is near, no chains, and what it flattens goes") {
  const Folder folder;
  SplitMix64 random(9);
  std::string text;
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    points.push_back({random.NextUnit(), random.NextUnit(), random.NextUnit() - 0.5});
    text += "v " + FormatNumber(points.back().x) + " " + FormatNumber(points.back().y) + " " +
            FormatNumber(points.back().z) + "\n";
  }
  for (int i = 1; i + 1 < 300; i += 2) text += "f 1 " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  for (const double distance : {0.05, 0.2}) {
    // By looking at all: each vertex becomes the first one before it that stayed and is near.
    Ids kept;
    for (std::int32_t v = 0; v < 300; ++v) {
      const auto near = std::find_if(kept.begin(), kept.end(), [&](std::int32_t o) {
        return Length(points[std::size_t(o)] - points[std::size_t(v)]) <= distance;
      });
      if (near == kept.end()) kept.push_back(v);
    }
    const auto mesh = LoadMesh(folder.With("a.obj", text), {.weld = true, .weldDistance = distance});
    REQUIRE(mesh);
    CheckSound(*mesh);
    for (const std::int32_t v : mesh->source) CHECK(std::binary_search(kept.begin(), kept.end(), v));
    if (distance == 0.2) CHECK(Has(Format(mesh.diagnostics()), "dropped, whose corners became one by welding"));
  }
  CHECK(Has(Said(folder, "a.obj", text, {.weld = true, .weldDistance = 100}), "no triangle is left after welding"));
}

TEST_CASE("Problems of a mesh are told with the place of the first") {
  const Folder folder;
  CHECK(Said(folder, "a.obj", kSquare + "v 9 9 9\nf 1 2 3\nf 1 4 3\nf 1 2 3\n") ==
        "FILE:8:1: warning: 1 triangle has the vertices of another (2, counted from 0); the later ones are dropped\n"
        "FILE: warning: 1 vertex belongs to no triangle (4, counted from 0); dropped\n"
        "FILE:7:1: warning: 1 triangle faces the other way than its neighbours (1, counted from 0); turned over\n");
  CHECK(Has(Said(folder, "a.obj", kSquare + "f 1 2 3\nf 1 2 2\n"), "FILE:6:1: error: 1 triangle has the same vertex"));
  CHECK(Has(Said(folder, "a.obj", kSquare + "v 2 0 0\nf 1 2 3\nf 1 2 5\n"), "FILE:7:1: error: 1 triangle has no area"));
  const auto repaired = LoadMesh(folder.With("a.obj", "v 9 9 9\n" + kSquare + "f 2 3 4\nf 2 5 4\n"));
  REQUIRE(repaired);
  CheckSound(*repaired);
  CHECK(repaired->source == Ids{1, 2, 3, 4});
}

TEST_CASE("What is wrong in an OBJ file is told with its line and column, what was expected, and the remedy") {
  const Folder folder;
  const auto check = [&](const std::string& text, const std::string& message, const MeshOptions& options = {}) {
    CAPTURE(text);
    const std::string said = Said(folder, "a.obj", text, options);
    CHECK_MESSAGE(Has(said, message), said);
  };
  const std::string f = "f 1 2 3\n";
  check("v 0 0\n", "FILE:1:6: error: expected a number of \"v x y z\", but the line ends");
  check("v 0 0 a\n", "FILE:1:7: error: expected a number of \"v x y z\", got \"a\"; write numbers like");
  check("v 0,5 0 0\n", "FILE:1:3: error: expected a number of \"v x y z\", got \"0,5\"; write decimals with a point");
  check("v 0 nan 0\n", "FILE:1:5: error: expected a number of \"v x y z\", got \"nan\"; state a finite number");
  check("v 0 -inf 0\n", "state a finite number");
  check("v 0 1e400 0\n", "FILE:1:5: error: expected a coordinate within 1000 km of the origin, got Infinity; state");
  check("v 0 0 1e9\n", "FILE:1:7: error: expected a coordinate within 1000 km of the origin, got 1000000000 m; is the");
  check("v 0 0 1e5\n", "got 100000 times the scale 1000 m; lower the scale", {.scale = 1000});
  check("v 0 0 0 1 1 1 1 1\n", "FILE:1:17: error: expected the end of \"v x y z\", got \"1\"");
  check("vt\n", "FILE:1:3: error: expected a number of \"vt u v\", but the line ends");
  check("vt 0 0 0 0\n", "FILE:1:10: error: expected the end of \"vt u v\"");
  check("vt 1e7 0\n", "FILE:1:4: error: expected a coordinate");
  check(kSquare + "f 1 2 5\n",
        "FILE:5:7: error: expected the number of a vertex, got 5; there are 4 above this line, 1..4");
  check(kSquare + "f 0 1 2\n", "FILE:5:3: error: expected the number of a vertex, got 0");
  check(kSquare + "f -5 1 2\n", "FILE:5:3: error: expected the number of a vertex, got -5");
  check(kSquare + "f 1 2 99999999999999999999999\n", "FILE:5:7: error: expected the number of a vertex, got 9999");
  check(kSquare + "f 1/1 2/1 3/1\n", "got 1; there is none above this line");
  check(kSquare + "f 1 2 x\n",
        "FILE:5:7: error: expected a corner such as 3, 3/1 or 3/1/2 with the number of a vertex");
  check(kSquare + "f 1 2 3//x\n", "FILE:5:7: error: expected the number of a normal");
  check(kSquare + "f 1.0 2 3\n", "got \"1.0\"");
  check(kSquare + "f 1 2\n", "FILE:5:1: error: expected at least three corners after \"f\", got 2");
  check(kSquare + "f\n", "got 0");
  check("f 1 2 3\n" + kSquare, "FILE:1:3: error: expected the number of a vertex, got 1; there is none above");
  check("# \xc3\xa4\xc3\xb6 \xe2\x82\xac\nv \xc3\xa4 0 0\n", "FILE:2:3: error");
  check("vn 0 0 \xe2\x82\xac\nv 0 0 \\\n 0.1 \xc3\xa4 x\n", "FILE:3:6: error");
  check("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "FILE: error: expected lines \"f a b c\", got none: 3 vertices");
  check("# nothing\n", "FILE: error: expected lines \"v x y z\", got none");
  check("<html>\n", "expected lines \"v x y z\", got none");
  check(std::string("v 0 0 0\n\0\n", 10),
        "FILE:2:1: error: expected a Wavefront OBJ file, which is a text, got the byte 0x00");
  check("\xff\xfev\0", "the text is in UTF-16");
  check("", "FILE: error: the file is empty; expected a mesh");
  check(kSquare + f + "fa 1 2 4\n",
        "FILE:6:1: warning: 1 line skipped: expected v, vt, vn, f, g, o or another word of OBJ, got \"fa\" (did you "
        "mean");
  check(kSquare + f + "l 1 2\np 1\n", "FILE:6:1: warning: 2 lines skipped: only polygons become cloth");
  check(kSquare + "f 1 2 3", "FILE:5:8: warning: the last line does not end in a line break");
  check(kSquare + f, "FILE: error: expected texture coordinates for the rest shape, got none",
        {.rest = RestShape::Texture});
  check(kSquare + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1 3 4\n",
        "FILE:9:1: error: expected texture coordinates at each corner for the rest shape, this face lacks some",
        {.rest = RestShape::Texture});
  check(kSquare + f, "expected a scale > 0 m, got 0", {.scale = 0});
  check(kSquare + f, "expected a scale > 0 m, got NaN", {.scale = std::nan("")});
  check(kSquare + f, "expected a size of the texture > 0 m, got -1", {.metresPerUv = -1});
  check(kSquare + f, "expected a direction of the warp with a length, got (0, 0, 0)", {.warp = Vec3{}});
  check(kSquare + f, "expected a distance for welding of 0 or at least 1e-9 m", {.weldDistance = 1e-12});
}

TEST_CASE("Many errors are cut off") {
  const Folder folder;
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "v x\n";
  const auto mesh = LoadMesh(folder.With("a.obj", text));
  CHECK_FALSE(mesh);
  CHECK(mesh.diagnostics().size() == 21);
  CHECK(mesh.diagnostics().back().severity == Severity::Note);
}

TEST_CASE("The excerpt shows the place, also in a long line") {
  const Folder folder;
  const auto mesh =
      LoadMesh(folder.With("a.obj", kSquare + "f" + std::string(500, ' ') + "1 2 9" + std::string(500, ' ') + "\n"));
  REQUIRE(mesh.diagnostics().size() == 1);
  const Diagnostic& diagnostic = mesh.diagnostics()[0];
  CHECK(diagnostic.place.column == 506);
  CHECK(diagnostic.excerpt.size() < 130);
  CHECK(diagnostic.excerpt[std::size_t(diagnostic.caret) - 1] == '9');
}

TEST_CASE("What is wrong in a PLY file is told with its line and column, or its byte") {
  const Folder folder;
  const auto check = [&](const std::string& text, const std::string& message) {
    CAPTURE(text);
    const std::string said = Said(folder, "a.ply", text);
    CHECK_MESSAGE(Has(said, message), said);
  };
  const std::string start = "ply\nformat ascii 1.0\n", xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uchar int vertex_indices\nend_header\n";
  const std::string vertex = "element vertex 3\n" + xyz, face = "element face 1\n" + list;
  const std::string good = start + vertex + face, points = "0 0 0\n1 0 0\n0 1 0\n";
  Good(folder.With("good.ply", good + points + "3 0 1 2\n"));
  check("plx\n", "FILE:1:1: error: expected a PLY file, whose first line is \"ply\", got \"plx\\n\"");
  check("ply", "FILE:1:1: error: expected a PLY file");
  check("ply\n", "expected \"end_header\", but the file ends; it was cut short");
  check("ply\nformat asci 1.0\n", "FILE:2:8: error: expected the format ascii, binary_little_endian or binary_big");
  check("ply\nformat ascii 2.0\n", "FILE:2:14: error: expected the version 1.0, got \"2.0\"");
  check("ply\n" + vertex + face, "FILE:8:1: error: expected a line \"format ascii 1.0\"");
  check(start + "elment vertex 3\n", "FILE:3:1: error: expected format, element, property, comment or end_header");
  check(start + "element vertex -3\n", "FILE:3:16: error: expected how many of \"vertex\" there are");
  check(start + "element vertex 3 4\n", "FILE:3:18: error: expected the end of the line, got \"4\"");
  check(start + "property float x\n", "FILE:3:1: error: expected a line \"element NAME COUNT\" before");
  check(start + vertex + "property float x\n", "FILE:7:1: error: the property \"x\" stands here a second time");
  check(start + vertex + vertex, "FILE:7:1: error: the element \"vertex\" stands here a second time");
  check(start + "element vertex 3\nproperty real x\n", "FILE:4:10: error: expected a type: char, uchar");
  check(start + "element face 3\nproperty list float int vertex_index\n", "FILE:4:15: error: expected a type of whole");
  check(start + "element vertex 3\nproperty float x\nproperty float y\n" + face,
        "FILE:3:1: error: expected a property z");
  check(start + face, "expected an element \"vertex\" in the header");
  check(start + vertex + "end_header\n" + points, "expected an element \"face\" in the header");
  check(start + vertex + "element face 1\nproperty int vertex_indices\nend_header\n",
        "FILE:7:1: error: expected a property \"list");
  check(start + "element vertex 0\n" + xyz + face, "FILE:3:1: error: expected vertices, got none");
  check(start + vertex + "element face 0\n" + list + points, "FILE:7:1: error: expected faces, got none");
  check(start + "element vertex 999999999999\n" + xyz + face + points,
        "FILE:3:1: error: expected at most 50000000 vertices");
  check(start + "element vertex 40000000\n" + xyz + face + points,
        "FILE:3:1: error: expected 40000000 of \"vertex\", at least 3");
  check(start + vertex + "element face 900000000000\n" + list + points,
        "FILE:7:1: error: expected 900000000000 of \"face\"");
  check(good + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n",
        "FILE:11:4: error: expected the number \"z\" of \"vertex\", but the line ends");
  check(good + "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n",
        "FILE:11:7: error: expected the end of the line after the properties");
  check(good + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n",
        "FILE:11:3: error: expected the number \"y\" of \"vertex\", got \"x\"");
  check(good + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "FILE:11:3: error");
  check(good + "0 0 0\n1 1e7 0\n0 1 0\n3 0 1 2\n", "FILE:11:3: error: vertex 1: expected a coordinate within 1000 km");
  check(good + points + "3 0 1 3\n", "FILE:13:7: error: face 0: expected the number of a vertex, 0..2, got 3");
  check(good + points + "3 0 1 -1\n", "FILE:13:7: error");
  check(good + points + "3 0 1 1.5\n", "FILE:13:7: error");
  check(good + points + "2 0 1     \n", "FILE:13:1: error: face 0: expected at least three corners, got 2");
  check(good + points + "-3 0 1 2\n", "FILE:13:1: error: expected the length of the list");
  check(good + points + "3 0 1     \n", "FILE:13:11: error: expected the number \"vertex_indices\" of \"face\", but");
  check(good + points + "\n         \n", "expected 1 of \"face\", but the file ends after 0; it was cut short");
  check(good + points + "3 0 1 2\n3 0 1 2\n", "FILE:14:1: warning: the header counts no lines from here on");
  check(good + points + "3 0 1 2", "warning: the last line does not end in a line break");

  const std::string header = "ply\nformat binary_little_endian 1.0\n" + vertex + face;
  const auto body = [](float x, std::uint8_t length, std::int32_t index) {
    Bytes bytes(false);
    for (const float c : {x, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes.Add(c);
    bytes.Add(length).Add(std::int32_t{0}).Add(std::int32_t{1}).Add(index);
    return bytes.text();
  };
  const std::size_t at = header.size();
  Good(folder.With("good.ply", header + body(0, 3, 2)));
  check(header + body(NAN, 3, 2), "FILE: error: byte " + std::to_string(at) + ": vertex 0: expected a coordinate");
  check(header + body(1e9f, 3, 2), "FILE: error: byte " + std::to_string(at) + ": vertex 0: expected a coordinate");
  check(header + body(0, 3, 3), "FILE: error: byte " + std::to_string(at + 45) + ": face 0: expected the number of a");
  check(header + body(0, 2, 2), "FILE: error: byte " + std::to_string(at + 36) + ": face 0: expected at least three");
  check(header + body(0, 200, 2),
        "FILE: error: byte " + std::to_string(at + 36) + ": expected a list \"vertex_indices\"");
  check(header + body(0, 3, 1),
        "FILE: error: byte " + std::to_string(at + 36) + ": 1 triangle has the same vertex twice");
  check(header + body(0, 3, 2) + "x", "FILE: warning: byte " + std::to_string(at + 49) + ": the header counts none");
  std::string damaged = header;
  damaged.replace(header.size() - 1, 1, "\r\n");
  check(damaged + body(0, 3, 2), "expected the line to end like the first one");
}

TEST_CASE("What is no mesh file") {
  const Folder folder;
  const auto said = [](const fs::path& file) {
    const auto mesh = LoadMesh(file);
    CHECK_FALSE(mesh);
    return Format(mesh.diagnostics());
  };
  CHECK(Has(said(folder / "none.obj"), "none.obj: error: there is no such file"));
  fs::create_directory(folder / "folder.obj");
  CHECK(Has(said(folder / "folder.obj"), "got a folder"));
  CHECK(Has(said(folder.With("a.stl", "solid\n")), "expected a mesh that ends in .obj or .ply, got \".stl\""));
  CHECK(Has(said(folder.With("a", "v 0 0 0\n")), "got no extension"));
  CHECK(Has(said(folder.With("a.PLY", "v 0 0 0\n")), "expected a PLY file"));
#ifndef _WIN32
  CHECK(Has(said("/dev/null"), "got a device or pipe"));
#endif
}

TEST_CASE("A file that was cut short is refused, or told") {
  const Folder folder;
  World world(SmallScene(), {.threads = 1});
  const std::string ply = Contents(Written(folder, world, "a.ply"));
  for (std::size_t size = 0; size < ply.size(); size += size < 600 ? 1 : 7)
    CHECK_FALSE(LoadMesh(folder.With("cut.ply", ply.substr(0, size))));
  const std::string obj = Contents(Written(folder, world, "a.obj"));
  for (std::size_t size = 0; size < obj.size(); size += size < 600 ? 1 : 7) {
    const auto mesh = LoadMesh(folder.With("cut.obj", obj.substr(0, size)));
    if (size == 0 || obj[size - 1] != '\n') CHECK(!mesh.diagnostics().empty());
    if (mesh) CheckSound(*mesh);
  }
}

TEST_CASE("A damaged file is refused, or gives a mesh that is sound") {
  const Folder folder;
  World world(SmallScene(), {.threads = 1});
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element other 1\nproperty list uchar int numbers\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 5 6\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n";
  Good(folder.With("t.ply", text));
  std::vector<std::pair<std::string, std::string>> files = {
      {"a.obj", Contents(Written(folder, world, "a.obj"))},
      {"b.obj", "o a b\n" + kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng c d\nf 1/1 2/2/1 3/3// \\\n 4/4\nl 1 2\n"},
      {"a.ply", Contents(Written(folder, world, "a.ply"))},
      {"t.ply", text}};
  SplitMix64 random(7);
  for (const auto& [name, good] : files) {
    CAPTURE(name);
    int refused = 0;
    for (int i = 0; i < 1500; ++i) {
      std::string bad = good;
      if (i % 4 == 0) bad.resize(random.Next() % good.size());
      const std::size_t reach = i % 8 < 4 ? 300 : bad.size();
      for (int k = i % 5; k > 0 && !bad.empty(); --k) {
        const std::size_t at = random.Next() % std::min(reach, bad.size());
        switch (random.Next() % 4) {
          case 0:
            bad[at] = char(random.Next());
            break;
          case 1:  // likely to be read as something else
            bad[at] = "0123456789-. \nefvgo/\\#"[random.Next() % 22];
            break;
          case 2:
            bad.erase(at, random.Next() % 4);
            break;
          default:
            bad.insert(at, good, random.Next() % good.size(), random.Next() % 20);
        }
      }
      const MeshOptions options{.rest = i % 3 == 0 ? RestShape::Texture : RestShape::Space,
                                .weld = i % 2 == 0,
                                .weldDistance = i % 4 == 2 ? 0.01 : 0};
      const fs::path file = folder.With("bad" + name, bad);
      const auto mesh = LoadMesh(file, options);
      if (mesh) {
        CheckSound(*mesh);
        CHECK_FALSE(HasErrors(mesh.diagnostics()));
      } else {
        ++refused;
        CHECK(HasErrors(mesh.diagnostics()));
      }
      for (const Diagnostic& d : mesh.diagnostics()) {
        CHECK(d.place.file == PathText(file));
        CHECK(std::size_t(d.caret) <= d.excerpt.size() + 1);
      }
    }
    CHECK(refused > 300);
    CHECK(refused < 1500);
  }
}
