#include "fabric/objective.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "fabric/system_matrix.h"
#include "fabric/triangle_window.h"
#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"

using namespace percale;
using namespace percale::fabric;

namespace {

/// A small sheet with all terms, in a state far from rest.
struct Sheet {
  explicit Sheet(BendingLaw bending, MembraneLaw membrane = MembraneLaw::StVenantKirchhoff) {
    scene.simulation.engine = Engine::Fabric;
    ClothSettings& cloth = scene.cloths.emplace_back();
    SetFabric(cloth, Fabric::Silk);
    cloth.numWidthPoints = 5, cloth.numHeightPoints = 4;
    cloth.width = 0.2, cloth.height = 0.15;
    cloth.bendWarp = 0.02, cloth.bendWeft = 0.01;  // enough to matter beside the membrane
    cloth.warpAngle = 20;
    cloth.pressure = 50;
    cloth.bendingLaw = bending;
    cloth.membraneLaw = membrane;
    cloth.stretchDamping = cloth.bendDamping = 0.01;
    const std::vector<RestMesh> meshes = {MakeGridMesh(cloth)};
    model = BuildModel(scene, meshes);
    const auto count = static_cast<std::size_t>(model.vertexCount);
    const auto noise = [&] { return Vec3{random.NextUnit() - 0.5, random.NextUnit() - 0.5, random.NextUnit() - 0.5}; };
    for (const Vec3& x : model.start) {
      y.push_back(x + noise() * 0.02);
      start.push_back(x + noise() * 0.02);
      before.push_back(x + noise() * 0.02);
      VertexLoad load;
      const double stiffness = 1.0 + random.NextUnit();
      load.stiffness = {.xx = stiffness, .yy = stiffness, .zz = stiffness};
      load.force = noise();
      loads.push_back(load);
    }
    free.assign(count, 1);
    free[3] = free[7] = 0;
    pattern = MakePattern(model.vertexCount, model.triangles);
    matrix.SetUp(pattern, model.plates);
  }

  SplitMix64 random{7};
  Scene scene;
  FabricModel model;
  std::vector<Vec3> y, start, before;
  std::vector<VertexLoad> loads;
  std::vector<std::uint8_t> free;
  Executor executor{1};
  BlockPattern pattern;
  SystemMatrix matrix;
};

double& Component(Vec3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

TEST_CASE("the gradient is the derivative of the energy, term by term and all together") {
  for (const BendingLaw bending : {BendingLaw::Quadratic, BendingLaw::Hinges}) {
    for (const MembraneLaw membrane : {MembraneLaw::StVenantKirchhoff, MembraneLaw::NeoHookean}) {
      Sheet s(bending, membrane);
      Objective objective(s.model, s.pattern, s.executor);
      objective.Begin({1.0 / 60, s.start, s.before, {0, -0.003, 0}, s.loads, s.free});
      std::vector<Vec3> gradient(s.y.size()), again(s.y.size());
      objective.Gradient(s.y, gradient);
      objective.GradientAndTangent(s.y, again, s.matrix);
      for (std::size_t v = 0; v < s.y.size(); ++v) {
        CHECK(gradient[v] == again[v]);
        for (int axis = 0; axis < 3; ++axis) {
          if (!s.free[v]) {
            CHECK(Component(gradient[v], axis) == 0);
            continue;
          }
          constexpr double kStep = 1e-6;
          double& x = Component(s.y[v], axis);
          const double at = x;
          x = at + kStep;
          const double above = objective.Energy(s.y);
          x = at - kStep;
          const double below = objective.Energy(s.y);
          x = at;
          CHECK(Component(gradient[v], axis) == doctest::Approx((above - below) / (2 * kStep)).epsilon(1e-5));
        }
      }
    }
  }
}

TEST_CASE("a small bend costs the same far from the origin") {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  ClothSettings& cloth = scene.cloths.emplace_back();
  SetFabric(cloth, Fabric::Denim);
  cloth.numWidthPoints = 101, cloth.numHeightPoints = 3;
  cloth.width = 1, cloth.height = 0.02;
  cloth.poissonRatio = 0;
  const std::vector<RestMesh> meshes = {MakeGridMesh(cloth)};
  const FabricModel model = BuildModel(scene, meshes);
  const BlockPattern pattern = MakePattern(model.vertexCount, model.triangles);
  const Executor executor(1);
  Objective objective(model, pattern, executor);
  // A sag of 0.1 mm: ½ B κ² times the area.
  constexpr double kCurvature = 8e-4;  // 1/m
  std::vector<Vec3> y;
  for (const Vec3& x : model.start) y.push_back(x + Vec3{0, 0.5 * kCurvature * x.x * x.x, 0});
  const double near = objective.ElasticEnergy(y);
  for (Vec3& x : y) x += Vec3{1000, -300, 50};
  CHECK(objective.ElasticEnergy(y) == doctest::Approx(near).epsilon(1e-3));
  CHECK(near ==
        doctest::Approx(0.5 * cloth.bendWarp * kCurvature * kCurvature * cloth.width * cloth.height).epsilon(0.05));
}

TEST_CASE("vertices find all that is evaluated of their triangles, in less room than all take") {
  Scene scene;
  ClothSettings& cloth = scene.cloths.emplace_back();
  cloth.numWidthPoints = 150, cloth.numHeightPoints = 300;
  const std::vector<RestMesh> meshes = {MakeGridMesh(cloth)};
  const FabricModel model = BuildModel(scene, meshes);
  const TriangleWindow window(model);
  REQUIRE(2 * window.live() < static_cast<int>(model.triangles.size()));
  std::vector<int> evaluated(static_cast<std::size_t>(window.live()), -1);  // which triangle lies there
  int next = 0, wrong = 0;
  window.ForRows(
      Executor(1),
      [&](int begin, int end) {
        for (int t = begin; t < end; ++t) evaluated[static_cast<std::size_t>(window.Place(begin) + t - begin)] = t;
      },
      [&](int begin, int end, const LiveTriangles& live) {
        CHECK(begin == std::exchange(next, end));
        for (int v = begin; v < end; ++v) {
          for (int e = model.corners.first[static_cast<std::size_t>(v)];
               e < model.corners.first[static_cast<std::size_t>(v) + 1]; ++e) {
            const std::int32_t corner = model.corners.entry[static_cast<std::size_t>(e)], place = live.Place(corner);
            if (place % 3 != corner % 3 || evaluated[static_cast<std::size_t>(place / 3)] != corner / 3) ++wrong;
          }
        }
      });
  CHECK(next == model.vertexCount);
  CHECK(wrong == 0);
}
