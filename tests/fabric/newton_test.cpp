#include "fabric/newton.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fabric/reference_solver.h"
#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"
#include "percale/world.h"
#include "tests/fabric/cotton_scene.h"
#include "tests/sanitized.h"

using namespace percale;
using namespace percale::fabric;

namespace {

constexpr double kStep = 1.0 / 60;

/// A square metre of cloth that hangs by two corners.
Scene HangingSheet(Fabric fabric, int side, BendingLaw bending = BendingLaw::Quadratic) {
  Scene scene = test::CottonScene();
  ClothSettings& cloth = scene.cloths[0];
  SetFabric(cloth, fabric);
  cloth.numWidthPoints = cloth.numHeightPoints = side;
  cloth.bendingLaw = bending;
  cloth.pinned = {{0, 0}, {side - 1, 0}};
  return scene;
}

/// The steps of a scene one by one, with both solvers at hand.
struct Stepper {
  explicit Stepper(const Scene& scene)
      : model(BuildModel(scene, std::vector<RestMesh>{MakeGridMesh(scene.cloths[0])})),
        fast(model, executor),
        reference(model),
        position(model.start),
        previous(model.start) {
    const auto count = static_cast<std::size_t>(model.vertexCount);
    free.assign(count, 1);
    for (const GridPoint& pin : scene.cloths[0].pinned) {
      free[static_cast<std::size_t>(pin.j * scene.cloths[0].numWidthPoints + pin.i)] = 0;
    }
    loads.resize(count);
    fast.SetUp(kStep, free);
  }

  /// Begins the next step; returns where inertia alone would lead.
  std::vector<Vec3> Begin() {
    std::vector<Vec3> ahead(position.size());
    for (std::size_t v = 0; v < position.size(); ++v) {
      ahead[v] = free[v] ? position[v] * 2 - previous[v] : position[v];
    }
    settings = {kStep, position, previous, Vec3{0, -9.8, 0} * (kStep * kStep), loads, free};
    fast.objective().Begin(settings);
    reference.Begin(settings);
    return ahead;
  }
  void Accept(const std::vector<Vec3>& y) {
    previous = position;
    position = y;
  }
  /// Root mean square, by mass, of how far a is from b [m].
  double Distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) const {
    double sum = 0, mass = 0;
    for (std::size_t v = 0; v < a.size(); ++v) {
      sum += model.mass[v] * Dot(a[v] - b[v], a[v] - b[v]);
      mass += model.mass[v];
    }
    return std::sqrt(sum / mass);
  }

  Executor executor{1};
  FabricModel model;
  NewtonSolver fast;
  ReferenceSolver reference;
  StepSettings settings;
  std::vector<Vec3> position, previous;
  std::vector<VertexLoad> loads;
  std::vector<std::uint8_t> free;
};

}  // namespace

TEST_CASE("the fast solver and the reference have the same energy and the same gradient") {
  for (const BendingLaw bending : {BendingLaw::Quadratic, BendingLaw::Hinges}) {
    Stepper s(HangingSheet(Fabric::Denim, 7, bending));
    s.Begin();
    SplitMix64 random(3);
    std::vector<Vec3> y = s.position, fast(y.size()), reference(y.size());
    for (Vec3& x : y) x += Vec3{random.NextUnit(), random.NextUnit(), random.NextUnit()} * 0.05;
    CHECK(s.fast.objective().Energy(y) == doctest::Approx(s.reference.Energy(y)).epsilon(1e-10));
    s.fast.objective().Gradient(y, fast);
    s.reference.Gradient(y, reference);
    double scale = 0;
    for (const Vec3& g : reference) scale = std::max(scale, Length(g));
    for (std::size_t v = 0; v < y.size(); ++v) CHECK(Length(fast[v] - reference[v]) < 1e-9 * scale);
  }
}

TEST_CASE("with enough iterations the fast solver ends where the reference does") {
  for (const Fabric fabric : {Fabric::Cotton, Fabric::Leather, Fabric::WoolLycra}) {
    for (const BendingLaw bending : {BendingLaw::Quadratic, BendingLaw::Hinges}) {
      CAPTURE(static_cast<int>(fabric));
      Stepper s(HangingSheet(fabric, 15, bending));
      for (int step = 0; step < 40; ++step) {
        std::vector<Vec3> y = s.Begin(), exact = y;
        const double start = s.Distance(y, s.position);
        const NewtonResult result = s.fast.Solve(y, s.fast.objective().Energy(y),
                                                 {.maxIterations = 60, .maxLinearIterations = 60, .tolerance = 1e-4});
        REQUIRE(result.converged);
        if (step % 8 == 7) {
          REQUIRE(s.reference.Solve(exact).converged);
          CHECK(s.Distance(y, exact) < 2e-3 * start + 1e-9);
          CHECK(s.reference.Energy(y) <= s.reference.Energy(exact) + 1e-6 * std::abs(s.reference.Energy(exact)));
        }
        s.Accept(y);
      }
    }
  }
}

TEST_CASE("each iteration lowers the energy: more of them never end higher") {
  Stepper s(HangingSheet(Fabric::Cotton, 25));
  for (int step = 0; step < 50; ++step) {
    const std::vector<Vec3> ahead = s.Begin();
    double last = s.reference.Energy(ahead);
    std::vector<Vec3> y;
    if (step % 10 == 9) {
      for (int iterations = 1; iterations <= 12; ++iterations) {
        y = ahead;
        s.fast.Solve(y, s.fast.objective().Energy(y),
                     {.maxIterations = iterations, .maxLinearIterations = 8, .tolerance = 1e-12});
        const double energy = s.reference.Energy(y);
        CHECK(energy <= last + 1e-9 * std::abs(last));
        last = energy;
      }
    }
    y = ahead;
    s.fast.Solve(y, s.fast.objective().Energy(y), {});
    s.Accept(y);
  }
}

TEST_CASE("where corrections gain what was foretold, fewer of them make more linear iterations") {
  Stepper s(HangingSheet(Fabric::Cotton, 25));
  std::vector<Vec3> minimum = s.Begin();
  s.fast.Solve(minimum, s.fast.objective().Energy(minimum),
               {.maxIterations = 60, .maxLinearIterations = 60, .tolerance = 1e-4});
  for (const bool near : {true, false}) {
    CAPTURE(near);
    std::vector<Vec3> y = minimum;
    const double size = near ? 1e-6 : 0.02;  // m: the energy is a parabola there, or not at all
    SplitMix64 random(4);
    for (std::size_t v = 0; v < y.size(); ++v) {
      if (s.free[v]) y[v] += Vec3{random.NextUnit(), random.NextUnit(), random.NextUnit()} * size;
    }
    const NewtonResult result = s.fast.Solve(y, s.fast.objective().Energy(y),
                                             {.maxIterations = 3, .maxLinearIterations = 2, .tolerance = 1e-12});
    CHECK(result.linearIterations == 6);
    CHECK(result.iterations == (near ? 2 : 3));
  }
}

TEST_CASE("cloth does not become rubber: few iterations stretch a hanging sheet no more than a converged run" *
          doctest::skip(test::kSanitized)) {
  double stretch[3];
  const int newton[3] = {2, 4, 40}, linear[3] = {4, 8, 80};
  for (int run = 0; run < 3; ++run) {
    Scene scene = HangingSheet(Fabric::Cotton, 33);
    scene.simulation.newtonIterations = newton[run];
    scene.simulation.linearIterations = linear[run];
    scene.simulation.tolerance = 1e-6;
    World world(scene, {.threads = 1});
    for (int frame = 0; frame < 180; ++frame) world.Step();
    stretch[run] = world.report().greatestStretch;
  }
  CHECK(stretch[1] == doctest::Approx(stretch[2]).epsilon(0.01));
  CHECK(stretch[0] == doctest::Approx(stretch[2]).epsilon(0.05));
}

TEST_CASE("the same bits for any number of threads") {
  std::uint64_t hashes[4];
  const int threads[4] = {1, 2, 3, 8};
  for (int run = 0; run < 4; ++run) {
    Scene scene = HangingSheet(Fabric::Silk, 40);
    scene.cloths[0].bendingLaw = BendingLaw::Hinges;
    scene.wind.velocity = {3, 0, 4};
    World world(scene, {.threads = threads[run]});
    for (int frame = 0; frame < 10; ++frame) world.Step();
    hashes[run] = world.StateHash();
  }
  for (const std::uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

TEST_CASE("a step that may not do enough says so") {
  Scene scene = HangingSheet(Fabric::Leather, 30);
  scene.simulation.newtonIterations = 1;
  scene.simulation.linearIterations = 1;
  World world(scene, {.threads = 1});
  for (int frame = 0; frame < 30; ++frame) world.Step();
  CHECK_FALSE(world.report().converged);
  CHECK(world.report().residual > scene.simulation.tolerance);
}

TEST_CASE("a state goes on to the same bits after it was saved and restored") {
  Scene scene = HangingSheet(Fabric::Wool, 20);
  World world(scene, {.threads = 1});
  for (int frame = 0; frame < 20; ++frame) world.Step();
  WorldState state;
  world.Save(state);
  for (int frame = 0; frame < 10; ++frame) world.Step();
  const std::uint64_t once = world.StateHash();
  world.Restore(state);
  for (int frame = 0; frame < 10; ++frame) world.Step();
  CHECK(world.StateHash() == once);
}

TEST_CASE("cloth that flies out of the world ends the simulation, with what to do about it") {
  Scene scene = HangingSheet(Fabric::Cotton, 5);
  scene.cloths[0].pinned.clear();
  scene.simulation.gravity = {0, -1e6, 0};
  scene.wind.airDensity = 0;
  World world(scene, {.threads = 1});
  for (int frame = 0; frame < 600 && !world.report().divergence; ++frame) world.Step();
  REQUIRE(world.report().divergence);
  CHECK(world.report().divergence->remedy.find("pin") != std::string::npos);
  for (const Vec3& x : world.Cloth(0).positions()) CHECK(std::abs(x.y) <= 1e6);
}

TEST_CASE("a folded sheet whose rest angles are those of the start stays as it is; one that is flat at rest opens") {
  for (const RestAngles rest : {RestAngles::Start, RestAngles::Flat}) {
    Scene scene = HangingSheet(Fabric::Leather, 9, BendingLaw::Hinges);
    ClothSettings& cloth = scene.cloths[0];
    cloth.width = cloth.height = 0.1;
    cloth.pinned.clear();
    cloth.restAngles = rest;
    scene.simulation.gravity = {};
    scene.wind.airDensity = 0;
    RestMesh mesh = MakeGridMesh(cloth);
    for (Vec3& x : mesh.positions) {  // upright beyond the middle
      const double over = x.x - 0.05;
      if (over > 0) x = {0.05, x.y + over, x.z};
    }
    const FabricModel model = BuildModel(scene, std::vector<RestMesh>{mesh});
    ReferenceSolver solver(model);
    const std::vector<VertexLoad> loads(mesh.positions.size());
    const std::vector<std::uint8_t> free(mesh.positions.size(), 1);
    solver.Begin({1, mesh.positions, mesh.positions, {}, loads, free});
    std::vector<Vec3> gradient(mesh.positions.size());
    solver.Gradient(mesh.positions, gradient);
    double greatest = 0;
    for (const Vec3& g : gradient) greatest = std::max(greatest, Length(g));
    if (rest == RestAngles::Start)
      CHECK(greatest < 1e-10);
    else
      CHECK(greatest > 1e-3);
  }
}

TEST_CASE("a step that can go no further says so") {
  // A chain of 128 links that weigh next to nothing beside their stiffness, far from balance: too much for a float.
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = scene.simulation.stepsPerFrame = 1;
  scene.simulation.newtonIterations = 60;
  scene.simulation.linearIterations = 200;
  scene.simulation.tolerance = 1e-9;
  ClothSettings& cloth = scene.cloths.emplace_back();
  cloth.numWidthPoints = 129, cloth.numHeightPoints = 2;
  cloth.width = 2, cloth.height = 0.05;
  cloth.density = 0.1, cloth.poissonRatio = 0;
  cloth.stretchWarp = cloth.stretchWeft = 1e5, cloth.shear = 5e4;
  cloth.bendWarp = cloth.bendWeft = 0;
  cloth.pinned = {{0, 0}, {0, 1}, {128, 0}, {128, 1}};
  World world(scene, {.threads = 1});
  WorldState state;
  world.Save(state);
  for (Vec3& x : state.cloths[0].positions) x = {x.x / 2, 1 - 2.4 * x.x / 2 * (1 - x.x / 2), x.z};
  state.cloths[0].previous = state.cloths[0].positions;
  state.cloths[0].anchors = {state.cloths[0].positions[0], state.cloths[0].positions[128],
                             state.cloths[0].positions[129], state.cloths[0].positions[257]};
  world.Restore(state);
  // Whatever it takes, it does not claim to be done where it moves on later.
  bool claimed = false;
  Vec3 there;
  for (int frame = 0; frame < 60; ++frame) {
    world.Step();
    const Vec3& middle = world.Cloth(0).positions()[64];
    if (claimed) CHECK(Length(middle - there) < 1e-3);
    claimed = world.report().converged && world.report().greatestMove < 1e-9;
    there = middle;
  }
  const bool atBottom = std::abs(1 - world.Cloth(0).positions()[64].y - 0.796388) < 0.01;
  CHECK((atBottom || !world.report().converged));
}

TEST_CASE("a chain of stiff links without bending falls like a chain, and does not stall") {
  Scene scene = test::CottonScene();
  scene.wind.airDensity = 0;
  ClothSettings& cloth = scene.cloths[0];
  cloth.width = 1, cloth.height = 0.01;
  cloth.numWidthPoints = 129, cloth.numHeightPoints = 2;
  cloth.stretchWarp = cloth.stretchWeft = 1e5, cloth.shear = 4e4;
  cloth.bendWarp = cloth.bendWeft = 0;
  cloth.pinned = {{0, 0}, {0, 1}};
  scene.simulation.newtonIterations = scene.simulation.linearIterations = 60;
  World world(scene, {.threads = 1});
  double lowest = 1;
  for (int frame = 0; frame < 60; ++frame) {
    world.Step();
    REQUIRE_FALSE(world.report().divergence);
    lowest = std::min(lowest, world.Cloth(0).positions()[128].y);
  }
  // Its end reaches almost its length below the pin in 0.55 s.
  CHECK(lowest < 0.1);
  CHECK(world.report().greatestStretch < 1.01);
}
