#include "mesh/cloth_model.h"

#include <algorithm>

#include "math/splitmix64.h"

namespace percale {

ClothModel MakeGrid(const ClothSettings& settings) {
  ClothModel model;
  const int nw = model.numWidth = settings.numWidthPoints;
  const int nh = model.numHeight = settings.numHeightPoints;
  const std::size_t count = static_cast<std::size_t>(nw) * static_cast<std::size_t>(nh);
  model.start.reserve(count);
  model.uv.reserve(count);

  const double spacingX = settings.width / (nw - 1);
  const double spacingY = settings.height / (nh - 1);
  SplitMix64 random(static_cast<std::uint64_t>(settings.seed));
  for (int j = 0; j < nh; ++j) {
    for (int i = 0; i < nw; ++i) {
      const Vec3 p = settings.orientation == Orientation::Horizontal
                         ? Vec3{i * spacingX, 1, j * spacingY}
                         : Vec3{i * spacingX, j * spacingY, (2 * random.NextUnit() - 1) / 1000};
      model.start.push_back(p + settings.origin);
      model.uv.push_back({static_cast<double>(i) / (nw - 1), static_cast<double>(j) / (nh - 1)});
    }
  }

  model.triangles.reserve(2 * static_cast<std::size_t>(nw - 1) * static_cast<std::size_t>(nh - 1));
  for (int j = 0; j + 1 < nh; ++j) {
    for (int i = 0; i + 1 < nw; ++i) {
      const std::int32_t a = j * nw + i, b = a + 1, c = a + nw, d = c + 1;
      model.triangles.push_back({a, c, b});
      model.triangles.push_back({b, c, d});
    }
  }
  return model;
}

std::vector<std::int32_t> PinnedVertices(const ClothSettings& settings) {
  std::vector<std::int32_t> vertices;
  for (const GridPoint& pin : settings.pinned) vertices.push_back(pin.j * settings.numWidthPoints + pin.i);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

double PointMass(const ClothSettings& cloth) {
  const double points = static_cast<double>(cloth.numWidthPoints) * static_cast<double>(cloth.numHeightPoints);
  return cloth.width * cloth.height * cloth.density / points;
}

bool Enabled(const ClothSettings& cloth, SpringKind kind) {
  switch (kind) {
    case SpringKind::Left:
    case SpringKind::Up:
      return cloth.enableStructural;
    case SpringKind::UpperLeft:
    case SpringKind::UpperRight:
      return cloth.enableShearing;
    case SpringKind::TwoLeft:
    case SpringKind::TwoUp:
      break;
  }
  return cloth.enableBending;
}

std::vector<Edge> EnabledSprings(const ClothModel& model, const ClothSettings& settings) {
  std::vector<Edge> springs;
  for (int j = 0; j < model.numHeight; ++j) {
    for (int i = 0; i < model.numWidth; ++i) {
      for (int kind = 0; kind < kSpringKinds; ++kind) {
        const auto [di, dj] = kSpringSteps[kind];
        if (!Enabled(settings, static_cast<SpringKind>(kind))) continue;
        if (i + di < 0 || i + di >= model.numWidth || j + dj < 0) continue;
        const std::int32_t p = j * model.numWidth + i;
        springs.push_back({p, p + dj * model.numWidth + di});
      }
    }
  }
  return springs;
}

}  // namespace percale
