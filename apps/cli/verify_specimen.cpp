#include "apps/cli/verify_specimen.h"

#include <algorithm>
#include <cmath>

#include "mesh/cloth_model.h"
#include "mesh/rest_mesh.h"

namespace percale::cli {
namespace {

/// A clothes' pins are grid points: all in one row where it is no grid.
Scene WithPins(Scene scene, const RestMesh& mesh, const std::vector<std::int32_t>& pinned) {
  ClothSettings& cloth = scene.cloths[0];
  cloth.numWidthPoints = static_cast<int>(mesh.positions.size());
  cloth.pinned.clear();
  for (const std::int32_t v : pinned) cloth.pinned.push_back({v, 0});
  return scene;
}

}  // namespace

Scene EmptyScene(int stepsPerSecond) {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = stepsPerSecond;
  scene.simulation.stepsPerFrame = 1;
  scene.simulation.gravity = {};
  scene.simulation.selfCollision = false;
  scene.simulation.newtonIterations = 60;
  scene.simulation.linearIterations = 200;
  scene.simulation.tolerance = 1e-9;
  scene.wind.airDensity = 0;
  return scene;
}

ClothSettings PlainSheet(double width, double height, int columns, int rows, double density, double stiffness,
                         double poisson, double rigidity) {
  ClothSettings cloth;
  cloth.width = width, cloth.height = height;
  cloth.numWidthPoints = columns + 1, cloth.numHeightPoints = rows + 1;
  cloth.orientation = Orientation::Horizontal;
  cloth.origin = {0, -1, 0};  // a horizontal sheet lies at y = 1
  cloth.density = density;
  cloth.stretchWarp = cloth.stretchWeft = stiffness;
  cloth.poissonRatio = poisson;
  cloth.shear = stiffness / (2 * (1 + poisson));
  cloth.bendWarp = cloth.bendWeft = rigidity;
  cloth.stretchDamping = cloth.bendDamping = 0;
  cloth.strainLimit = 10;
  return cloth;
}

ClothSettings Strip(const StripSettings& s) {
  const double clamps = 0.5 * ((s.left == End::Clamped ? 1 : 0) + (s.right == End::Clamped ? 1 : 0));
  const double spacing = s.length / (s.along - clamps);
  ClothSettings cloth = PlainSheet(spacing * s.along, s.width, s.along, s.across, s.density,
                                   s.slenderness * s.rigidity / (s.length * s.length), s.poisson, s.rigidity);
  if (s.left != End::Free) PinColumn(cloth, 0);
  if (s.left == End::Clamped) {
    PinColumn(cloth, 1);
    cloth.origin.x -= 0.5 * spacing;
  }
  if (s.right != End::Free) PinColumn(cloth, s.along);
  if (s.right == End::Clamped) PinColumn(cloth, s.along - 1);
  return cloth;
}

void PinColumn(ClothSettings& cloth, int column) {
  for (int j = 0; j < cloth.numHeightPoints; ++j) cloth.pinned.push_back({column, j});
}
void PinRow(ClothSettings& cloth, int row) {
  for (int i = 0; i < cloth.numWidthPoints; ++i) cloth.pinned.push_back({i, row});
}

int MiddleOf(const ClothSettings& cloth, int column) {
  return cloth.numHeightPoints / 2 * cloth.numWidthPoints + column;
}

int Elements(double count, int least) {
  return std::max(least, static_cast<int>(std::lround(count)));
}

bool Settle(World& world, double move, int most) {
  for (int k = 0; k < most; ++k) {
    const StepReport& report = world.Step();
    if (report.divergence) return false;
    if (report.greatestMove <= move) return report.converged;
  }
  return false;
}

void Put(World& world, const std::function<Vec3(int)>& place, const std::function<Vec3(int)>& velocity, int index) {
  WorldState state;
  world.Save(state);
  WorldState::Cloth& cloth = state.cloths[static_cast<std::size_t>(index)];
  const ClothView view = world.Cloth(index);
  for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
    const int vertex = static_cast<int>(v);
    cloth.positions[v] = place(vertex);
    cloth.previous[v] = cloth.positions[v] - velocity(vertex) * world.scene().TimeStep();
  }
  for (std::size_t k = 0; k < cloth.anchors.size(); ++k) {
    cloth.anchors[k] = cloth.positions[static_cast<std::size_t>(view.pinned()[k])];
  }
  world.Restore(state);
}

std::vector<double> Masses(const ClothView& cloth, const ClothSettings& settings) {
  std::vector<double> masses(cloth.positions().size());
  const double triangle = settings.density * settings.width * settings.height / double(cloth.triangles().size());
  for (const Triangle& t : cloth.triangles()) {
    for (const std::int32_t v : {t.a, t.b, t.c}) masses[static_cast<std::size_t>(v)] += triangle / 3;
  }
  return masses;
}

MeshRun::MeshRun(Scene scene, RestMesh mesh, const std::vector<std::int32_t>& pinned)
    : scene_(WithPins(std::move(scene), mesh, pinned)),
      mesh_(std::move(mesh)),
      executor_(1),
      engine_(scene_, fabric::BuildModel(scene_, std::span(&mesh_, 1)), executor_),
      positions_(mesh_.positions),
      previous_(mesh_.positions) {}

void MeshRun::Step() {
  time_ += scene_.TimeStep();
  engine_.MoveColliders(time_);
  engine_.ApplyForces(time_, {}, {});
  engine_.Solve();
  engine_.Move();
  engine_.ReadState(0, positions_, previous_);
  greatestMove_ = 0;
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    greatestMove_ = std::max(greatestMove_, Length(positions_[v] - previous_[v]));
  }
}

bool MeshRun::Settle(double move, int most) {
  for (int k = 0; k < most; ++k) {
    Step();
    if (!(greatestMove_ < 1e6)) return false;
    if (greatestMove_ <= move) return true;
  }
  return false;
}

void MeshRun::Put(std::span<const Vec3> positions) {
  std::vector<Vec3> anchors;
  for (const GridPoint& pin : scene_.cloths[0].pinned) anchors.push_back(positions[static_cast<std::size_t>(pin.i)]);
  engine_.WriteState(0, positions, positions, anchors, time_);
  positions_.assign(positions.begin(), positions.end());
  previous_ = positions_;
}

void MeshRun::Configure(const Scene& scene) {
  std::vector<GridPoint> pinned = scene_.cloths[0].pinned;
  const int points = scene_.cloths[0].numWidthPoints;
  scene_ = scene;
  scene_.cloths[0].pinned = std::move(pinned);
  scene_.cloths[0].numWidthPoints = points;
  engine_.Configure(scene_);
}

StaticSheet::StaticSheet(const ClothSettings& cloth)
    : model_([&] {
        Scene scene;
        scene.cloths.push_back(cloth);
        const RestMesh mesh = MakeGridMesh(cloth);
        return fabric::BuildModel(scene, std::span(&mesh, 1));
      }()),
      solver_(model_),
      positions_(model_.start),
      loads_(positions_.size()),
      free_(positions_.size(), 1) {
  for (const std::int32_t v : PinnedVertices(cloth)) free_[static_cast<std::size_t>(v)] = 0;
}

bool StaticSheet::Solve(const Vec3& gravity) {
  for (std::size_t v = 0; v < loads_.size(); ++v) loads_[v].force = gravity * model_.mass[v];
  const std::vector<Vec3> start = positions_;
  solver_.Begin({.h = 0, .start = start, .before = start, .fall = {}, .loads = loads_, .free = free_});
  return solver_.Solve(positions_).converged;
}

bool StaticSheet::IsStable() {
  const std::vector<Vec3> start = positions_;
  solver_.Begin({.h = 0, .start = start, .before = start, .fall = {}, .loads = loads_, .free = free_});
  return solver_.IsStable(positions_);
}

double CriticalLoad(double guess, const std::function<bool(double)>& isStable) {
  constexpr int kMostDoublings = 20;
  double low = guess, high = guess;
  for (int k = 0; k < kMostDoublings && !isStable(low); ++k) low /= 2;
  for (int k = 0; k < kMostDoublings && isStable(high); ++k) high *= 2;
  while (high - low > 1e-6 * low) {
    const double middle = 0.5 * (low + high);
    (isStable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace percale::cli
