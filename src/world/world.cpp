#include "percale/world.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <vector>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "mesh/rest_mesh.h"
#include "mesh/topology.h"
#include "percale/parameters.h"
#include "world/divergence.h"
#include "world/engine.h"
#include "world/interaction.h"

namespace percale {
namespace {

// A cloth is at rest when no point moves more than this over a frame, for so many frames on end.
constexpr double kRestMove = 1e-3;  // m
constexpr int kRestFrames = 30;
// No cloth that anybody wants is stretched that much: the state is on its way to infinity.
constexpr double kDivergedStretch = 1000;

/// Adds wall-clock time to the stages of a report.
class StageClock {
 public:
  explicit StageClock(StepReport& report) : report_(report), last_(Clock::now()) {}
  /// Everything since the last call was `stage`.
  void Finished(Stage stage) {
    const Clock::time_point now = Clock::now();
    report_.stageSeconds[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  StepReport& report_;
  Clock::time_point last_;
};

/// Whether two scenes have the same cloths, apart from settings that act at once.
bool SameCloths(const Scene& a, const Scene& b) {
  return EffectOf(a, b) != Effect::Rebuild;
}

/// Engine::Fabric makes its own, and has no use for texture coordinates.
ClothModel MakeModel(const ClothSettings& settings, Engine engine) {
  if (engine == Engine::Springs) return MakeGrid(settings);
  ClothModel model;
  model.uv = MakeClothMesh(settings).uv;
  return model;
}

/// Of points that were at `previous` one step before; `velocities` may be the same as that.
void ComputeVelocities(std::span<const Vec3> positions, std::span<const Vec3> previous, double stepsPerSecond,
                       std::span<Vec3> velocities) {
  for (std::size_t v = 0; v < positions.size(); ++v) velocities[v] = (positions[v] - previous[v]) * stepsPerSecond;
}

}  // namespace

/// The springs of a cloth and their lengths at rest, made when any thread first asks for them: for drawing and for
/// statistics, no step needs them. Of a cloth without, the edges of its triangles as the flat fabric has them; where
/// the two sides of a seam differ, the first counts.
class ClothSprings {
 public:
  ClothSprings(std::shared_ptr<const Scene> scene, std::size_t cloth) : scene_(std::move(scene)), cloth_(cloth) {}

  std::span<const Edge> edges() const { return Made().edges_; }
  std::span<const double> lengths() const { return Made().lengths_; }

 private:
  const ClothSprings& Made() const {
    const std::lock_guard lock(mutex_);
    if (scene_) Make(scene_->cloths[cloth_], scene_->simulation.engine);
    scene_.reset();
    return *this;
  }
  void Make(const ClothSettings& settings, Engine engine) const {
    if (engine == Engine::Springs) {
      const ClothModel model = MakeGrid(settings);
      edges_ = EnabledSprings(model, settings);
      lengths_ = LengthsOf(edges_, model.start);
      return;
    }
    const RestMesh mesh = MakeClothMesh(settings);
    Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
    lengths_.assign(topology.edges.size(), 0);
    for (std::size_t side = 0; side < topology.sideEdges.size(); ++side) {
      double& length = lengths_[static_cast<std::size_t>(topology.sideEdges[side])];
      const Vec2 &from = mesh.material[side], &to = mesh.material[side % 3 == 2 ? side - 2 : side + 1];
      if (length == 0) length = std::hypot(to.x - from.x, to.y - from.y);
    }
    edges_ = std::move(topology.edges);
  }

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Scene> scene_;  // until they are made
  std::size_t cloth_;
  mutable std::vector<Edge> edges_;
  mutable std::vector<double> lengths_;
};

std::span<const Edge> ClothView::springs() const {
  return springs_->edges();
}
std::span<const double> ClothView::restLengths() const {
  return springs_->lengths();
}

struct World::Impl {
  Impl(Scene s, WorldOptions options) : executor(options.threads), scene(std::make_shared<const Scene>(std::move(s))) {
    Build();
  }

  struct Cloth;
  void Build();
  void Start();
  void Configure(std::shared_ptr<const Scene> changed);
  bool AskForces();
  void ReadState();
  void FinishStep();
  std::span<const Vec3> StartOf(std::size_t cloth) const {
    return engine->start(engineState.get(), static_cast<int>(cloth));
  }
  std::span<const Triangle> EngineTrianglesOf(std::size_t cloth) const {
    return engine->triangles(engineState.get(), static_cast<int>(cloth));
  }

  struct Cloth {
    std::vector<Vec2> uv;
    std::vector<Triangle> triangles;  // none where the engine's name vertices by the same numbers
    std::unique_ptr<const ClothSprings> springs;
    std::vector<std::int32_t> pinned;  // ascending
    std::vector<Vec3> positions, previous, velocities;
    std::vector<Vec3> forces;  // of this step, where the program has any
  };

  Executor executor;
  std::shared_ptr<const Scene> scene;
  std::vector<Cloth> cloths;
  const EngineTable* engine = nullptr;
  std::shared_ptr<void> engineState;
  StepReport report;
  int restFrames = 0;
  std::vector<Handle> handles;
  std::vector<Ball> balls;
  std::vector<Gust> gusts;
  ForceFunction forces;                             // empty: none
  std::vector<Vec3> stepPositions, stepVelocities;  // for those, of one cloth
};

void World::Impl::Build() {
  engineState.reset();
  std::vector<ClothModel> models;
  for (const ClothSettings& settings : scene->cloths) models.push_back(MakeModel(settings, scene->simulation.engine));
  cloths.clear();
  for (std::size_t c = 0; c < models.size(); ++c) {
    Cloth& cloth = cloths.emplace_back();
    cloth.springs = std::make_unique<const ClothSprings>(scene, c);
    cloth.pinned = PinnedVertices(scene->cloths[c]);
  }
  engine = &FindEngine(scene->simulation.engine);
  engineState = engine->create(*scene, models, executor);
  std::int32_t first = 0;
  for (std::size_t c = 0; c < models.size(); ++c) {
    cloths[c].uv = std::move(models[c].uv);
    cloths[c].triangles = std::move(models[c].triangles);
    if (first > 0) {
      const std::span<const Triangle> numbered = EngineTrianglesOf(c);
      cloths[c].triangles.reserve(numbered.size());
      for (const Triangle& t : numbered) cloths[c].triangles.push_back({t.a - first, t.b - first, t.c - first});
    }
    first += static_cast<std::int32_t>(StartOf(c).size());
  }
  Start();
}

/// Takes settings for the cloths that there are.
void World::Impl::Configure(std::shared_ptr<const Scene> changed) {
  scene = std::move(changed);
  engine->configure(engineState.get(), *scene);
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (scene->simulation.engine == Engine::Springs) cloths[c].springs = std::make_unique<const ClothSprings>(scene, c);
    cloths[c].pinned = PinnedVertices(scene->cloths[c]);
  }
}

/// What the reader sees before the first frame.
void World::Impl::Start() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Cloth& cloth = cloths[c];
    const std::span<const Vec3> start = StartOf(c);
    cloth.positions.assign(start.begin(), start.end());
    cloth.previous = cloth.positions;
    cloth.velocities.assign(cloth.positions.size(), Vec3{});
  }
  report = {};
  restFrames = 0;
  handles.clear();
  balls.clear();
  gusts.clear();
}

/// Asks for the forces of the program's own in the step that ends at report.time, from the state in which it begins.
/// False: one of them is none, and report.divergence says which.
bool World::Impl::AskForces() {
  const double dt = scene->TimeStep();
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const int cloth = static_cast<int>(c);
    const std::size_t count = cloths[c].positions.size();
    stepPositions.resize(count);
    stepVelocities.resize(count);
    engine->readState(engineState.get(), cloth, stepPositions, stepVelocities);
    ComputeVelocities(stepPositions, stepVelocities, 1 / dt, stepVelocities);
    cloths[c].forces.assign(count, Vec3{});
    forces({cloth, report.time - dt, stepPositions, stepVelocities, cloths[c].forces});
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3& force = cloths[c].forces[v];
      if (Length(force) <= kMostForce) continue;  // Not so where it is not a number.
      report.divergence = ExplainForce(report.step, cloth, static_cast<int>(v), force);
      return false;
    }
  }
  return true;
}

void World::Impl::ReadState() {
  double move = 0;  // squared
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Cloth& cloth = cloths[c];
    std::vector<Vec3>& now = cloth.velocities;  // for a moment
    engine->readState(engineState.get(), static_cast<int>(c), now, cloth.previous);
    const double stepsPerSecond = 1 / scene->TimeStep();
    for (std::size_t v = 0; v < now.size(); ++v) {  // once, since large cloths come from far away
      const Vec3 at = now[v], way = at - cloth.positions[v];
      move = std::max(move, Dot(way, way));
      cloth.positions[v] = at;
      cloth.velocities[v] = (at - cloth.previous[v]) * stepsPerSecond;
    }
  }
  report.greatestMove = std::sqrt(move);
}

/// Positions for the reader, and the statistics of the frame.
void World::Impl::FinishStep() {
  ReadState();
  report.kineticEnergy = report.potentialEnergy = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Cloth& cloth = cloths[c];
    const std::span<const double> masses = engine->masses(engineState.get(), static_cast<int>(c));
    double kinetic = 0;  // twice
    Vec3 weighted;
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
      kinetic += masses[v] * Dot(cloth.velocities[v], cloth.velocities[v]);
      weighted += cloth.positions[v] * masses[v];
    }
    report.kineticEnergy += 0.5 * kinetic;
    report.potentialEnergy -= Dot(scene->simulation.gravity, weighted);
  }
  report.elasticEnergy = engine->elasticEnergy(engineState.get());
  const EngineCounts counts = engine->takeCounts(engineState.get());
  report.selfContacts = counts.selfContacts;
  report.colliderContacts = counts.colliderContacts;
  report.limitedSprings = counts.limitedSprings;
  report.newtonIterations = counts.newtonIterations;
  report.intersections = counts.intersections;
  report.squeezed = counts.squeezed;
  report.jumps = counts.jumps;
  report.lostMotion = counts.wantedWay > 0 ? counts.lostWay / counts.wantedWay : 0;
  report.splits = counts.splits;
  report.contactBytes = counts.contactBytes;
  report.linearIterations = counts.linearIterations;
  report.residual = counts.residual;
  report.converged = counts.converged;
  restFrames = report.greatestMove <= kRestMove ? restFrames + 1 : 0;
  report.atRest = restFrames >= kRestFrames;
}

World::World(Scene scene, WorldOptions options) : impl_(std::make_unique<Impl>(std::move(scene), options)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const StepReport& World::Step() {
  Impl& w = *impl_;
  StepReport& report = w.report;
  if (report.divergence) return report;
  report.stageSeconds = {};
  StageClock clock(report);
  const EngineTable& engine = *w.engine;
  void* const state = w.engineState.get();
  const double dt = w.scene->TimeStep();
  std::erase_if(w.gusts, [&](const Gust& gust) { return gust.start + gust.duration < report.time; });
  clock.Finished(Stage::CheckInput);

  for (int step = 0; step < w.scene->simulation.stepsPerFrame; ++step) {
    ++report.step;
    report.time += dt;
    engine.moveColliders(state, report.time);
    MoveBalls(*w.scene, report.time, dt, w.balls);
    clock.Finished(Stage::MoveColliders);
    if (w.forces && !w.AskForces()) break;
    const bool inBounds = engine.applyForces(state, report.time, w.gusts, w.handles);
    for (int c = 0; w.forces && c < ClothCount(); ++c)
      engine.addForces(state, c, w.cloths[static_cast<std::size_t>(c)].forces);
    clock.Finished(Stage::ApplyForces);
    if (!inBounds) break;
    engine.solve(state);
    clock.Finished(Stage::Solve);
    engine.findContacts(state);
    clock.Finished(Stage::FindContacts);
    engine.selfCollide(state);
    clock.Finished(Stage::SelfCollide);
    engine.collide(state);
    for (Ball& ball : w.balls) engine.collideBall(state, ball);
    clock.Finished(Stage::Collide);
    engine.limitStrain(state);
    clock.Finished(Stage::LimitStrain);
  }

  VertexRef lost = engine.findOutOfBounds(state);
  const Stretch stretch = engine.greatestStretch(state);
  if (lost.cloth < 0 && stretch.ratio > kDivergedStretch) lost = stretch.at;
  if (!report.divergence && lost.cloth >= 0)
    report.divergence = ExplainDivergence(*w.scene, report.step, lost.cloth, lost.vertex);
  if (report.divergence) {
    // The reader keeps the state of the last good frame.
    engine.takeCounts(state);
  } else {
    ++report.frame;
    report.greatestStretch = stretch.ratio;
    w.FinishStep();
  }
  clock.Finished(Stage::FinishStep);
  return report;
}

void World::Reset() {
  Impl& w = *impl_;
  w.engine->reset(w.engineState.get());
  w.engine->takeCounts(w.engineState.get());
  w.Start();
}

bool World::Apply(Scene scene) {
  Impl& w = *impl_;
  const bool keep = SameCloths(*w.scene, scene);
  auto changed = std::make_shared<const Scene>(std::move(scene));
  if (!keep) {
    w.scene = std::move(changed);
    w.Build();
    return false;
  }
  w.Configure(std::move(changed));
  w.restFrames = 0;
  w.report.atRest = false;
  return true;
}

void World::SetHandles(std::vector<Handle> handles) {
  for ([[maybe_unused]] const Handle& handle : handles) {
    assert(handle.cloth >= 0 && handle.cloth < ClothCount() && handle.vertex >= 0);
    assert(static_cast<std::size_t>(handle.vertex) <
           impl_->cloths[static_cast<std::size_t>(handle.cloth)].positions.size());
    assert(!Check(handle));
  }
  impl_->handles = std::move(handles);
}

void World::Place(const Handle& handle) {
  Impl& w = *impl_;
  w.engine->place(w.engineState.get(), handle);
  Impl::Cloth& cloth = w.cloths[static_cast<std::size_t>(handle.cloth)];
  w.engine->readState(w.engineState.get(), handle.cloth, cloth.positions, cloth.previous);
  w.restFrames = 0;
  w.report.atRest = false;
}

void World::AddBall(const Ball& ball) {
  assert(!Check(ball));
  std::vector<Ball>& balls = impl_->balls;
  if (balls.size() == kMostBalls) balls.erase(balls.begin());
  balls.push_back(ball);
}

void World::AddGust(const Gust& gust) {
  assert(!Check(gust));
  impl_->gusts.push_back(gust);
}

void World::SetForces(ForceFunction forces) {
  impl_->forces = std::move(forces);
}

std::span<const Handle> World::handles() const {
  return impl_->handles;
}
std::span<const Ball> World::balls() const {
  return impl_->balls;
}

void World::Save(WorldState& state) const {
  const Impl& w = *impl_;
  state.scene = w.scene;
  state.report = w.report;
  state.restFrames = w.restFrames;
  state.cloths.resize(w.cloths.size());
  for (std::size_t c = 0; c < w.cloths.size(); ++c) {
    state.cloths[c].positions = w.cloths[c].positions;
    state.cloths[c].previous = w.cloths[c].previous;
    w.engine->readAnchors(w.engineState.get(), static_cast<int>(c), state.cloths[c].anchors);
    w.engine->readFolds(w.engineState.get(), static_cast<int>(c), state.cloths[c].folds);
  }
  w.engine->readContact(w.engineState.get(), state.touches, state.obstacles);
  state.handles = w.handles;
  state.balls = w.balls;
  state.gusts = w.gusts;
}

void World::Restore(const WorldState& state) {
  Impl& w = *impl_;
  if (w.scene != state.scene) {
    if (SameCloths(*w.scene, *state.scene)) {
      w.Configure(state.scene);
    } else {
      w.scene = state.scene;
      w.Build();
    }
  }
  assert(state.cloths.size() == w.cloths.size());
  for (std::size_t c = 0; c < w.cloths.size(); ++c) {
    Impl::Cloth& cloth = w.cloths[c];
    assert(state.cloths[c].positions.size() == cloth.positions.size());
    cloth.positions = state.cloths[c].positions;
    cloth.previous = state.cloths[c].previous;
    w.engine->writeState(w.engineState.get(), static_cast<int>(c), state.cloths[c], state.report.time);
    ComputeVelocities(cloth.positions, cloth.previous, 1 / w.scene->TimeStep(), cloth.velocities);
  }
  w.engine->writeContact(w.engineState.get(), state.touches, state.obstacles);
  w.engine->takeCounts(w.engineState.get());
  w.report = state.report;
  w.restFrames = state.restFrames;
  w.handles = state.handles;
  w.balls = state.balls;
  w.gusts = state.gusts;
}

std::size_t WorldState::Bytes() const {
  std::size_t bytes = sizeof *this;
  for (const Cloth& cloth : cloths) {
    bytes += sizeof cloth;
    bytes += (cloth.positions.capacity() + cloth.previous.capacity() + cloth.anchors.capacity()) * sizeof(Vec3);
    bytes += cloth.folds.capacity() * sizeof(Fold);
  }
  bytes += touches.capacity() * sizeof(Touch) + obstacles.capacity() * sizeof(Vec3);
  return bytes + handles.capacity() * sizeof(Handle) + balls.capacity() * sizeof(Ball) +
         gusts.capacity() * sizeof(Gust);
}

const Scene& World::scene() const {
  return *impl_->scene;
}
std::shared_ptr<const Scene> World::sharedScene() const {
  return impl_->scene;
}
const StepReport& World::report() const {
  return impl_->report;
}
int World::ClothCount() const {
  return static_cast<int>(impl_->cloths.size());
}

ClothView World::Cloth(int index) const {
  assert(index >= 0 && index < ClothCount());
  const auto c = static_cast<std::size_t>(index);
  const Impl::Cloth& cloth = impl_->cloths[c];
  ClothView view;
  view.positions_ = cloth.positions;
  view.rest_ = impl_->StartOf(c);
  view.velocities_ = cloth.velocities;
  view.uv_ = cloth.uv;
  view.triangles_ = cloth.triangles.empty() ? impl_->EngineTrianglesOf(c) : cloth.triangles;
  view.springs_ = cloth.springs.get();
  view.pinned_ = cloth.pinned;
  return view;
}

std::uint64_t World::StateHash() const {
  // FNV-1a over 64-bit words.
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](const Vec3& v) {
    for (const double coordinate : {v.x, v.y, v.z}) {
      std::uint64_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3u;
      hash ^= hash >> 32;
    }
  };
  for (const Impl::Cloth& cloth : impl_->cloths) {
    for (const Vec3& position : cloth.positions) add(position);
  }
  for (const Ball& ball : impl_->balls) {
    add(ball.position);
    add(ball.velocity);
  }
  return hash;
}

std::string_view StageName(Stage stage) {
  constexpr std::string_view names[kStageCount] = {"CheckInput", "MoveColliders", "ApplyForces",
                                                   "Solve",      "FindContacts",  "SelfCollide",
                                                   "Collide",    "LimitStrain",   "FinishStep"};
  return names[static_cast<std::size_t>(stage)];
}

}  // namespace percale
