#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "apps/cli/figure_studies.h"
#include "apps/cli/figure_table.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kResolutions[] = {16, 32, 64, 128};
constexpr int kFinest = 512;  // a sphere whose triangles are smaller than pixels

/// A height map as the displacement shader reads it: the red channel, with linear interpolation, repeated.
class HeightMap {
 public:
  explicit HeightMap(const Image& image) : image_(image) {}

  double At(double u, double v) const {
    const double x = u * image_.width - 0.5, y = v * image_.height - 0.5;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double s = x - i, t = y - j;
    return (1 - t) * ((1 - s) * Texel(i, j) + s * Texel(i + 1, j)) +
           t * ((1 - s) * Texel(i, j + 1) + s * Texel(i + 1, j + 1));
  }

 private:
  double Texel(int i, int j) const {
    const auto wrapped = [](int k, int size) { return (k % size + size) % size; };
    return image_.At(wrapped(i, image_.width), wrapped(j, image_.height))[0] / 255.0;
  }
  const Image& image_;
};

/// Distances between the surface that is drawn and the exact one.
struct SurfaceError {
  double rms = 0, max = 0;  // m
};

/// The sphere's mesh with its corners moved out by `height` times the map, against the exact surface:
/// measured along rays from the centre, at points spread over all triangles.
SurfaceError MeasureSurface(int resolution, double radius, double height, const HeightMap& map) {
  const DrawMesh mesh = MakeSphereMesh(resolution, resolution);
  const auto unit = [&](std::uint32_t vertex) {
    const float* p = &mesh.positions[3 * vertex];
    return Vec3{p[0], p[1], p[2]};
  };
  const auto corner = [&](std::uint32_t vertex) {
    return (radius + height * map.At(mesh.uv[2 * vertex], mesh.uv[2 * vertex + 1])) * unit(vertex);
  };
  const int cuts = std::max(1, kFinest / resolution);
  SurfaceError error;
  double sum = 0, weights = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t* v = &mesh.triangles[t];
    const Vec3 a = corner(v[0]), b = corner(v[1]), c = corner(v[2]);
    const double weight = Length(Cross(unit(v[1]) - unit(v[0]), unit(v[2]) - unit(v[0])));
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; i + j < cuts; ++j) {
        const double s = (i + 1.0 / 3) / cuts, r = (j + 1.0 / 3) / cuts;
        const Vec3 p = (1 - s - r) * a + s * b + r * c;
        const Vec3 d = UnitOr(p, {0, 1, 0});
        // As MakeSphereMesh lays its texture.
        const double u = std::atan2(-d.x, -d.z) / (2 * std::numbers::pi), w = std::acos(d.y) / std::numbers::pi;
        const double apart = std::abs(Length(p) - (radius + height * map.At(u, w)));
        error.max = std::max(error.max, apart);
        sum += weight * apart * apart;
        weights += weight;
      }
    }
  }
  error.rms = std::sqrt(sum / weights);
  return error;
}

/// Mean difference per pixel where the sphere faces the camera, away from its outline.
double PictureChange(const Image& a, const Image& b, const Scene& scene, const OrbitCamera& camera) {
  const SphereSettings& sphere = scene.spheres[0];
  const Vec3 toEye = UnitOr(camera.position() - sphere.origin, {0, 0, 1});
  const double radius = kDrawnSphereRadius * sphere.radius;
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Vec3 ray = camera.Ray(x, y, a.width, a.height), from = camera.position() - sphere.origin;
      const double along = Dot(from, ray), inside = along * along - Dot(from, from) + radius * radius;
      if (inside < 0 || Dot(from + (-along - std::sqrt(inside)) * ray, toEye) < 0.5 * radius) continue;
      for (int k = 0; k < 3; ++k) sum += std::abs(int(a.At(x, y)[k]) - int(b.At(x, y)[k])) / 3.0;
      ++count;
    }
  }
  return count == 0 ? 0 : sum / count;
}

}  // namespace

Result<Table> StudySphere(Painter& painter, const fs::path& heightMap, const Scene& scene, percale::View view,
                          int width, int height) {
  const auto image = ReadPng(heightMap);
  if (!image) return image.diagnostics();
  const HeightMap map(*image);
  const double radius = kDrawnSphereRadius * scene.spheres[0].radius;
  view.cloths = false;
  Diagnostics problems;
  const auto paint = [&](const char* shader, int resolution) {
    view.look.shader = shader;
    view.sphereLatitudes = view.sphereLongitudes = resolution;
    auto picture = painter.Paint(scene, {}, view);
    if (picture) return std::move(*picture);
    problems = picture.diagnostics();
    return MakeImage(width, height);
  };
  const Image finestBump = paint("Bump", kFinest), finestDisplacement = paint("Displacement", kFinest);
  Table table;
  table.columns = {"resolution", "displaced_rms", "displaced_max", "smooth_rms", "bump_change", "displacement_change"};
  for (const int resolution : kResolutions) {
    const SurfaceError displaced = MeasureSurface(resolution, radius, view.look.heightScaling, map);
    const SurfaceError smooth = MeasureSurface(resolution, radius, 0, map);
    table.rows.push_back({double(resolution), displaced.rms, displaced.max, smooth.rms,
                          PictureChange(paint("Bump", resolution), finestBump, scene, view.camera),
                          PictureChange(paint("Displacement", resolution), finestDisplacement, scene, view.camera)});
  }
  if (!problems.empty()) return problems;
  return table;
}

Result<Table> StudyLight(const fs::path& folder) {
  std::vector<Image> images;
  for (const int number : {31, 32, 33, 34}) {
    auto image = ReadPng(folder / FigureFile(number));
    if (!image) return image.diagnostics();
    images.push_back(std::move(*image));
  }
  const Image& whole = images[3];
  const std::uint8_t* const background = whole.At(0, 0);
  const auto isBackground = [&](const std::uint8_t* pixel) { return std::equal(pixel, pixel + 3, background); };
  // Pixels on the outline mix with the background, which each picture adds once.
  const auto isInside = [&](int x, int y) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int i = x + dx, j = y + dy;
        if (i < 0 || j < 0 || i >= whole.width || j >= whole.height) return false;
        for (const Image& image : images) {
          if (isBackground(image.At(i, j))) return false;
        }
      }
    }
    return true;
  };
  std::set<std::array<int, 3>> ambient;
  int difference = 0;
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x) {
      if (!isInside(x, y)) continue;
      std::array<int, 3> color{};
      for (std::size_t k = 0; k < 3; ++k) {
        int sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += images[i].At(x, y)[k];
        difference = std::max(difference, std::abs(std::min(sum, 255) - whole.At(x, y)[k]));
        color[k] = images[0].At(x, y)[k];
      }
      ambient.insert(color);
    }
  }
  return Table{{"difference", "ambient_colors"}, {{double(difference), double(ambient.size())}}};
}

}  // namespace percale::cli
