#pragma once
/// \file
/// Sheets at rest and their matrices, for the tests of the linear solver.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/executor.h"
#include "fabric/prolongation.h"
#include "fabric/system_matrix.h"
#include "math/splitmix64.h"
#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale::test {

/// Vertices in a plane, cut into panels that may be sewn together.
struct Sheet {
  std::vector<Vec2> rest;  // per vertex [m]
  std::vector<Triangle> triangles;
  std::vector<Vec2> material;
  std::vector<Triangle> materialTriangles;
  std::vector<std::uint8_t> pinned;

  int vertices() const { return static_cast<int>(rest.size()); }
  fabric::MaterialMesh Mesh() const { return {triangles, materialTriangles, material}; }
  fabric::MaterialMesh NoMaterial() const { return {triangles, {}, {}}; }
};

/// A square of 1 m with n x n vertices, held at two corners.
inline Sheet Square(int n) {
  Sheet sheet;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) sheet.rest.push_back({i / (n - 1.0), j / (n - 1.0)});
  }
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i;
      sheet.triangles.push_back({a, a + 1, a + n});
      sheet.triangles.push_back({a + 1, a + n + 1, a + n});
    }
  }
  sheet.material = sheet.rest;
  sheet.materialTriangles = sheet.triangles;
  sheet.pinned.assign(sheet.rest.size(), 0);
  sheet.pinned[0] = sheet.pinned[n - 1] = 1;
  return sheet;
}

/// The same square cut in two along a line of vertices; the second panel lies elsewhere and askew.
inline Sheet TwoPanels(int n) {
  Sheet sheet = Square(n);
  const int seam = n / 2;
  const int points = sheet.vertices();
  const auto onSecond = [&](const Triangle& t) { return (t.a % n + t.b % n + t.c % n) > 3 * seam; };
  const double angle = .4;
  for (int p = 0; p < points; ++p) {
    const Vec2 m = sheet.rest[p];
    sheet.material.push_back(
        {std::cos(angle) * m.x - std::sin(angle) * m.y + .3, std::sin(angle) * m.x + std::cos(angle) * m.y});
  }
  for (Triangle& t : sheet.materialTriangles) {
    if (onSecond(t)) t = {t.a + points, t.b + points, t.c + points};
  }
  return sheet;
}

/// A disc of 1 m with `rings` rings of vertices at irregular places, held at two of them.
inline Sheet Disc(int rings) {
  Sheet sheet;
  SplitMix64 random(7);
  std::vector<std::vector<int>> index(2 * rings + 1, std::vector<int>(2 * rings + 1, -1));
  const double step = .5 / rings;
  for (int q = -rings; q <= rings; ++q) {
    for (int r = -rings; r <= rings; ++r) {
      if (std::abs(q + r) > rings) continue;
      index[q + rings][r + rings] = sheet.vertices();
      const double x = step * (q + .5 * r), y = step * std::sqrt(.75) * r;
      const double ring = step * std::max({std::abs(q), std::abs(r), std::abs(q + r)});
      const double length = std::hypot(x, y);
      const double scale = length > 0 ? ring / length : 0;
      const double jitter = ring > 0 && ring < .5 - step / 2 ? .25 * step : 0;
      sheet.rest.push_back(
          {scale * x + jitter * (2 * random.NextUnit() - 1), scale * y + jitter * (2 * random.NextUnit() - 1)});
    }
  }
  const auto at = [&](int q, int r) { return q < 0 || r < 0 || q > 2 * rings || r > 2 * rings ? -1 : index[q][r]; };
  for (int q = 0; q <= 2 * rings; ++q) {
    for (int r = 0; r <= 2 * rings; ++r) {
      const int a = at(q, r), b = at(q + 1, r), c = at(q, r + 1), d = at(q + 1, r - 1);
      if (a >= 0 && b >= 0 && c >= 0) sheet.triangles.push_back({a, b, c});
      if (a >= 0 && d >= 0 && b >= 0) sheet.triangles.push_back({a, d, b});
    }
  }
  sheet.material = sheet.rest;
  sheet.materialTriangles = sheet.triangles;
  sheet.pinned.assign(sheet.rest.size(), 0);
  sheet.pinned[at(0, rings)] = sheet.pinned[at(2 * rings, rings)] = 1;
  return sheet;
}

struct Cloth {
  double stiffness = 261;  // [N/m]
  double poisson = .24;
  double bending = 1e-5;       // [N m]
  double density = .15;        // [kg/m^2]
  double timeStep = 1.0 / 60;  // [s]
};

inline double Area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return .5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}
/// Gradients of the three shape functions of a triangle [1/m].
inline std::array<Vec2, 3> ShapeGradients(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double s = .5 / Area(a, b, c);
  return {{{s * (b.y - c.y), s * (c.x - b.x)}, {s * (c.y - a.y), s * (a.x - c.x)}, {s * (a.y - b.y), s * (b.x - a.x)}}};
}

inline std::vector<double> VertexAreas(const Sheet& sheet) {
  std::vector<double> areas(sheet.vertices());
  for (const Triangle& t : sheet.triangles) {
    for (const int v : {t.a, t.b, t.c}) areas[v] += Area(sheet.rest[t.a], sheet.rest[t.b], sheet.rest[t.c]) / 3;
  }
  return areas;
}

/// For each triangle the stored ones of its nine blocks: of corners r and c at 3 r + c, the corners being a, b, c.
inline std::vector<std::array<std::int32_t, 9>> TriangleBlocks(const fabric::BlockPattern& pattern,
                                                               std::span<const Triangle> triangles) {
  std::vector<std::array<std::int32_t, 9>> blocks;
  for (const Triangle& t : triangles) {
    const std::int32_t corners[3] = {t.a, t.b, t.c};
    std::array<std::int32_t, 9>& of = blocks.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) of[k] = pattern.Find(corners[k / 3], corners[k % 3]);
  }
  return blocks;
}

/// Masses over h^2, and bending as the square of the Laplacian.
inline fabric::ScalarMatrix ConstantPart(const Sheet& sheet, const Cloth& cloth) {
  const std::vector<double> areas = VertexAreas(sheet);
  std::vector<fabric::ScalarEntry> laplacian;
  for (const Triangle& t : sheet.triangles) {
    const int corners[3] = {t.a, t.b, t.c};
    const auto g = ShapeGradients(sheet.rest[t.a], sheet.rest[t.b], sheet.rest[t.c]);
    const double area = Area(sheet.rest[t.a], sheet.rest[t.b], sheet.rest[t.c]);
    for (int k = 0; k < 9; ++k) {
      const Vec2 &a = g[k / 3], &b = g[k % 3];
      laplacian.push_back({corners[k / 3], corners[k % 3], area * (a.x * b.x + a.y * b.y)});
    }
  }
  const fabric::ScalarMatrix L = fabric::MakeScalarMatrix(sheet.vertices(), laplacian);
  std::vector<fabric::ScalarEntry> entries;
  for (int v = 0; v < sheet.vertices(); ++v) {
    entries.push_back({v, v, cloth.density * areas[v] / (cloth.timeStep * cloth.timeStep)});
    L.ForRow(v, [&](std::int32_t row, double a) {
      L.ForRow(v, [&](std::int32_t column, double b) {
        entries.push_back({row, column, cloth.bending * a * b / areas[v]});
      });
    });
  }
  return fabric::MakeScalarMatrix(sheet.vertices(), entries);
}

/// Adds the membrane's blocks, of St. Venant and Kirchhoff, without stress, on a sheet that is turned in space.
inline void AddMembrane(const Sheet& sheet, const Cloth& cloth, fabric::SystemMatrix& matrix) {
  const double axes[2][3] = {{.6, .64, .48}, {-.8, .48, .36}};
  const double C[3][3] = {{cloth.stiffness, cloth.stiffness * cloth.poisson, 0},
                          {cloth.stiffness * cloth.poisson, cloth.stiffness, 0},
                          {0, 0, cloth.stiffness * (1 - cloth.poisson) / 2}};
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Triangle& of = sheet.triangles[t];
    const auto g = ShapeGradients(sheet.rest[of.a], sheet.rest[of.b], sheet.rest[of.c]);
    const double area = Area(sheet.rest[of.a], sheet.rest[of.b], sheet.rest[of.c]);
    double B[3][3][3];  // corner, strain, component
    for (int v = 0; v < 3; ++v) {
      for (int c = 0; c < 3; ++c) {
        B[v][0][c] = g[v].x * axes[0][c];
        B[v][1][c] = g[v].y * axes[1][c];
        B[v][2][c] = g[v].y * axes[0][c] + g[v].x * axes[1][c];
      }
    }
    for (int pair = 0; pair < 9; ++pair) {
      const std::int32_t corners[3] = {of.a, of.b, of.c};
      const std::int32_t row = corners[pair / 3], column = corners[pair % 3];
      if (column < row) continue;  // not stored
      fabric::Real* block = matrix.Block(matrix.pattern().Find(row, column));
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          double sum = 0;
          for (int k = 0; k < 3; ++k) {
            for (int l = 0; l < 3; ++l) sum += B[pair / 3][k][r] * C[k][l] * B[pair % 3][l][c];
          }
          block[3 * c + r] += static_cast<fabric::Real>(area * sum);
        }
      }
    }
  }
}

/// A filled matrix, with what there is of contacts.
struct System {
  fabric::SystemMatrix matrix;

  explicit System(const Sheet& sheet, const Executor& executor, const Cloth& cloth = {},
                  std::span<const fabric::ExtraTerm> extra = {}) {
    matrix.SetUp(fabric::MakePattern(sheet.vertices(), sheet.triangles), ConstantPart(sheet, cloth), sheet.pinned);
    Fill(sheet, executor, cloth, extra);
  }
  void Fill(const Sheet& sheet, const Executor& executor, const Cloth& cloth,
            std::span<const fabric::ExtraTerm> extra) {
    matrix.Reset(executor);
    AddMembrane(sheet, cloth, matrix);
    matrix.SetExtra(extra, executor);
    matrix.Finish(executor);
  }
};

/// Numbers at random in [-1, 1], and nothing at pinned vertices if those are given.
inline fabric::RealVector RandomVector(int rows, std::uint64_t seed, std::span<const std::uint8_t> pinned = {}) {
  SplitMix64 random(seed);
  fabric::RealVector x(fabric::VectorLength(rows), 0);
  for (int k = 0; k < 3 * rows; ++k) {
    const double number = 2 * random.NextUnit() - 1;
    x[k] = pinned.empty() || !pinned[k / 3] ? static_cast<fabric::Real>(number) : 0;
  }
  return x;
}

/// The weight of each vertex.
inline fabric::RealVector Weight(const Sheet& sheet, const Cloth& cloth = {}) {
  const std::vector<double> areas = VertexAreas(sheet);
  fabric::RealVector b(fabric::VectorLength(sheet.vertices()), 0);
  for (int v = 0; v < sheet.vertices(); ++v) {
    if (!sheet.pinned[v]) b[3 * v + 1] = static_cast<fabric::Real>(-9.81 * cloth.density * areas[v]);
  }
  return b;
}

/// Springs of that stiffness [N/m] between remote vertices, along directions that differ.
inline std::vector<fabric::ExtraTerm> RemotePairs(const Sheet& sheet, int pairs, double stiffness) {
  SplitMix64 random(99);
  std::vector<fabric::ExtraTerm> terms;
  for (int k = 0; k < pairs; ++k) {
    // Folded along a line askew: the vertex that lies over another is far away in the mesh.
    const auto a = static_cast<std::int32_t>(random.Next() % sheet.vertices());
    const auto b = sheet.vertices() - 1 - a;
    if (a == b) continue;
    double n[3], length = 0;
    for (double& c : n) c = 2 * random.NextUnit() - 1, length += c * c;
    fabric::ExtraTerm& term = terms.emplace_back();
    term.vertex = {a, b, -1, -1};
    term.weight = {1, -1, 0, 0};
    for (int c = 0; c < 9; ++c) term.block[c] = static_cast<fabric::Real>(stiffness * n[c / 3] * n[c % 3] / length);
  }
  return terms;
}

}  // namespace percale::test
