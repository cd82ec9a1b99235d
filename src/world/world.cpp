#include "percale/world.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "percale/parameters.h"
#include "world/divergence.h"
#include "world/engine.h"

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
  if (a.simulation.engine != b.simulation.engine) return false;
  for (const Parameter& parameter : Parameters()) {
    if (parameter.effect != Effect::Rebuild) continue;
    const std::size_t count = FindGroup(parameter.group)->count(a);
    if (count != FindGroup(parameter.group)->count(b)) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (parameter.get(a, i) != parameter.get(b, i)) return false;
    }
  }
  return true;
}

}  // namespace

struct World::Impl {
  Impl(Scene s, WorldOptions options) : executor(options.threads), scene(std::move(s)) { Build(); }

  void Build();
  void Start();
  void ReadState();
  void FinishStep();

  struct Cloth {
    ClothModel model;
    std::vector<Edge> springs;  // of the enabled kinds
    std::vector<Vec3> positions, previous, velocities;
    std::vector<Vec3> lastFrame;
  };

  Executor executor;
  Scene scene;
  std::vector<Cloth> cloths;
  const EngineTable* engine = nullptr;
  std::shared_ptr<void> engineState;
  StepReport report;
  int restFrames = 0;
};

void World::Impl::Build() {
  std::vector<ClothModel> models;
  for (const ClothSettings& settings : scene.cloths) models.push_back(MakeGrid(settings));
  engine = &FindEngine(scene.simulation.engine);
  engineState = engine->create(scene, models, executor);
  cloths.clear();
  for (std::size_t c = 0; c < models.size(); ++c) {
    Cloth cloth;
    cloth.springs = EnabledSprings(models[c], scene.cloths[c]);
    cloth.model = std::move(models[c]);
    cloths.push_back(std::move(cloth));
  }
  Start();
}

/// What the reader sees before the first frame.
void World::Impl::Start() {
  for (Cloth& cloth : cloths) {
    cloth.positions = cloth.previous = cloth.lastFrame = cloth.model.start;
    cloth.velocities.assign(cloth.positions.size(), Vec3{});
  }
  report = {};
  restFrames = 0;
}

void World::Impl::ReadState() {
  const double dt = scene.TimeStep();
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Cloth& cloth = cloths[c];
    cloth.lastFrame.swap(cloth.positions);
    engine->readState(engineState.get(), static_cast<int>(c), cloth.positions, cloth.previous);
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
      cloth.velocities[v] = (cloth.positions[v] - cloth.previous[v]) / dt;
    }
  }
}

/// Positions for the reader, and the statistics of the frame.
void World::Impl::FinishStep() {
  ReadState();
  double move = 0;  // squared
  report.kineticEnergy = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Cloth& cloth = cloths[c];
    double squaredSpeeds = 0;
    for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
      const Vec3 way = cloth.positions[v] - cloth.lastFrame[v];
      move = std::max(move, Dot(way, way));
      squaredSpeeds += Dot(cloth.velocities[v], cloth.velocities[v]);
    }
    report.kineticEnergy += 0.5 * engine->mass(engineState.get(), static_cast<int>(c)) * squaredSpeeds;
  }
  report.greatestMove = std::sqrt(move);
  const EngineCounts counts = engine->takeCounts(engineState.get());
  report.selfContacts = counts.selfContacts;
  report.colliderContacts = counts.colliderContacts;
  report.limitedSprings = counts.limitedSprings;
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
  const double dt = w.scene.TimeStep();
  clock.Finished(Stage::CheckInput);

  for (int step = 0; step < w.scene.simulation.stepsPerFrame; ++step) {
    ++report.step;
    report.time += dt;
    engine.moveColliders(state, report.time);
    clock.Finished(Stage::MoveColliders);
    const bool inBounds = engine.applyForces(state, report.time);
    clock.Finished(Stage::ApplyForces);
    if (!inBounds) break;
    engine.findContacts(state);
    clock.Finished(Stage::FindContacts);
    engine.selfCollide(state);
    clock.Finished(Stage::SelfCollide);
    engine.collide(state);
    clock.Finished(Stage::Collide);
    engine.limitStrain(state);
    clock.Finished(Stage::LimitStrain);
  }

  VertexRef lost = engine.findOutOfBounds(state);
  const Stretch stretch = engine.greatestStretch(state);
  if (lost.cloth < 0 && stretch.ratio > kDivergedStretch) lost = stretch.at;
  if (lost.cloth >= 0) {
    // The reader keeps the state of the last good frame.
    report.divergence = ExplainDivergence(w.scene, report.step, lost.cloth, lost.vertex);
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
  const bool keep = SameCloths(w.scene, scene);
  w.scene = std::move(scene);
  if (!keep) {
    w.Build();
    return false;
  }
  w.engine->configure(w.engineState.get(), w.scene);
  for (std::size_t c = 0; c < w.cloths.size(); ++c) {
    w.cloths[c].springs = EnabledSprings(w.cloths[c].model, w.scene.cloths[c]);
  }
  w.restFrames = 0;
  w.report.atRest = false;
  return true;
}

const Scene& World::scene() const {
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
  const Impl::Cloth& cloth = impl_->cloths[static_cast<std::size_t>(index)];
  ClothView view;
  view.positions_ = cloth.positions;
  view.velocities_ = cloth.velocities;
  view.uv_ = cloth.model.uv;
  view.triangles_ = cloth.model.triangles;
  view.springs_ = cloth.springs;
  view.pinned_ = cloth.model.pinned;
  return view;
}

std::uint64_t World::StateHash() const {
  // FNV-1a over 64-bit words.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Impl::Cloth& cloth : impl_->cloths) {
    for (const Vec3& p : cloth.positions) {
      for (const double coordinate : {p.x, p.y, p.z}) {
        std::uint64_t bits;
        std::memcpy(&bits, &coordinate, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3u;
        hash ^= hash >> 32;
      }
    }
  }
  return hash;
}

std::string_view StageName(Stage stage) {
  constexpr std::string_view names[kStageCount] = {"CheckInput",  "MoveColliders", "ApplyForces", "FindContacts",
                                                   "SelfCollide", "Collide",       "LimitStrain", "FinishStep"};
  return names[static_cast<std::size_t>(stage)];
}

}  // namespace percale
