#pragma once
/// \file
/// What the tests of moving colliders share: a sheet to meet them, and a closed tube along x whose vertices a cache
/// moves.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>

#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"
#include "percale/scene.h"
#include "percale/world.h"

namespace percale::test {

/// One sheet of so many cells, led by the fabric engine in 60 steps per second.
inline Scene SheetScene(Fabric fabric, double width, double height, int columns, int rows) {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  ClothSettings& sheet = scene.cloths.emplace_back();
  SetFabric(sheet, fabric);
  sheet.width = width, sheet.height = height;
  sheet.numWidthPoints = columns + 1, sheet.numHeightPoints = rows + 1;
  return scene;
}

/// The fingerprint of the state so many frames on.
inline std::uint64_t HashAfter(World& world, int frames) {
  for (int frame = 0; frame < frames; ++frame) world.Step();
  return world.StateHash();
}

/// 0.7 m long, radius 0.1 m, rounded off at both ends, in 1024ths of a metre.
inline RestMesh MakeTube() {
  constexpr int kRings = 21, kRound = 16;
  RestMesh mesh;
  for (int i = 0; i < kRings; ++i) {
    const double s = 2.0 * i / (kRings - 1) - 1, radius = 0.1 * std::sqrt(1.02 - s * s * s * s);
    for (int k = 0; k < kRound; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRound;
      const auto rounded = [](double x) { return std::round(x * 1024) / 1024; };
      mesh.positions.push_back(
          {rounded(0.35 * s), rounded(radius * std::cos(angle)), rounded(radius * std::sin(angle))});
    }
  }
  const auto at = [](int i, int k) { return static_cast<std::int32_t>(i * kRound + (k + kRound) % kRound); };
  for (int i = 0; i + 1 < kRings; ++i) {
    for (int k = 0; k < kRound; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      mesh.triangles.push_back({at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)});
    }
  }
  const auto left = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.push_back({-0.375, 0, 0});
  mesh.positions.push_back({0.375, 0, 0});
  for (int k = 0; k < kRound; ++k) {
    mesh.triangles.push_back({left, at(0, k + 1), at(0, k)});
    mesh.triangles.push_back({left + 1, at(kRings - 1, k), at(kRings - 1, k + 1)});
  }
  mesh.uv.resize(mesh.positions.size());
  return mesh;
}

/// The tube, its vertices led by `motion` for so many seconds.
inline ColliderSettings Body(const std::function<Vec3(const Vec3&, double time)>& motion, double seconds, double rate) {
  ColliderSettings body;
  body.shape = ColliderShape::Mesh;
  body.mesh = "body.obj", body.cache = "body.pc2";
  body.cacheRate = rate;
  LoadedMesh loaded{body.mesh, {}, MakeTube(), 0};
  loaded.options.weld = true;
  VertexCache cache{body.cache, 1, static_cast<std::int32_t>(std::lround(seconds * rate)) + 1, 0, {}};
  for (std::int32_t s = 0; s < cache.samples; ++s) {
    for (const Vec3& x : loaded.mesh.positions) {
      const Vec3 p = motion(x, s / rate);
      cache.positions.insert(cache.positions.end(),
                             {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
  }
  body.loaded = std::make_shared<const LoadedMesh>(std::move(loaded));
  body.loadedCache = std::make_shared<const VertexCache>(std::move(cache));
  return body;
}

/// Writes both files into the folder; the collider names them there and holds them no more.
inline void WriteBody(ColliderSettings& body, const std::filesystem::path& folder) {
  const RestMesh& mesh = body.loaded->mesh;
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  for (const Vec3& x : mesh.positions) text << "v " << x.x << " " << x.y << " " << x.z << "\n";
  for (const Triangle& t : mesh.triangles) text << "f " << t.a + 1 << " " << t.b + 1 << " " << t.c + 1 << "\n";
  std::ofstream(folder / "body.obj") << text.str();
  std::string bytes("POINTCACHE2\0", 12);
  const auto add = [&](const auto& number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); };
  add(std::int32_t{1});
  add(static_cast<std::int32_t>(mesh.positions.size()));
  add(0.0f);
  add(1.0f);
  add(body.loadedCache->samples);
  for (const float x : body.loadedCache->positions) add(x);
  std::ofstream(folder / "body.pc2", std::ios::binary) << bytes;
  body.mesh = (folder / "body.obj").string();
  body.cache = (folder / "body.pc2").string();
  body.loaded.reset();
  body.loadedCache.reset();
}

}  // namespace percale::test
