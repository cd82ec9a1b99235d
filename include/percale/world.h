#pragma once
/// \file
/// `World` runs a scene. It is the only class that a user of the library needs:
///
///     auto scene = percale::LoadScene("scene/pinned2.json");
///     percale::World world(*scene);
///     world.Step();
///     std::span<const percale::Vec3> x = world.Cloth(0).positions();

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "percale/interaction.h"
#include "percale/mesh.h"
#include "percale/scene.h"

namespace percale {

/// The stages of a frame, in order. The same names stand in the code, in reports and in the viewer.
enum class Stage {
  CheckInput,     ///< Once per frame: what changed, and what has to be prepared anew.
  MoveColliders,  ///< Pins that move; then, once per step:
  ApplyForces,    ///< springs, gravity, wind, and the integration of positions,
  Solve,          ///< Engine::Fabric: the positions at which all forces balance at the end of the step,
  FindContacts,   ///< points of cloth that share a box,
  SelfCollide,    ///< those closer than their thickness pushed apart,
  Collide,        ///< points put out of spheres and planes,
  LimitStrain,    ///< springs that are too long shortened;
  FinishStep,     ///< once per frame: statistics, and positions handed to the reader.
};
inline constexpr int kStageCount = 9;
std::string_view StageName(Stage stage);

/// Why a simulation had to stop.
struct Divergence {
  /// The first step after which a position was out of bounds or not a number; or the last step of
  /// the frame in which a spring became a thousand times too long.
  std::int64_t step = 0;
  int cloth = 0;
  int vertex = 0;
  std::string cause;   ///< "ks = 1e5 N/m is above the stable limit of 1459 N/m at this density and step"
  std::string remedy;  ///< "lower ks below ..., or raise simulation.steps_per_frame to ..."
};

/// What one frame did.
struct StepReport {
  int frame = 0;                                   ///< Frames since the start, this one included.
  std::int64_t step = 0;                           ///< Steps since the start.
  double time = 0;                                 ///< Simulated time [s].
  std::array<double, kStageCount> stageSeconds{};  ///< Wall-clock time spent, by Stage [s].
  double kineticEnergy = 0;                        ///< [J]
  double potentialEnergy = 0;                      ///< Of gravity; 0 where all points are at the origin [J].
  double elasticEnergy = 0;                        ///< Of what is stretched and compressed [J].
  double greatestStretch = 0;                      ///< Greatest length over rest length of all springs.
  double greatestMove = 0;                         ///< Farthest way of a point over this frame [m].
  std::int64_t selfContacts = 0;                   ///< Pairs of cloth points pushed apart, summed over the steps.
  std::int64_t colliderContacts = 0;               ///< Points put back by a collider, summed over the steps.
  std::int64_t limitedSprings = 0;                 ///< Springs shortened by the strain limit, summed over the steps.
  std::int64_t intersections = 0;                  ///< Engine::Fabric: edges of cloth that pass through triangles, left
                                                   ///< of a start that was tangled or of a jump; else none can be.
  std::int64_t squeezed = 0;                       ///< Engine::Fabric: vertices of cloth inside of solids, and of mesh
                                                   ///< colliders that cloth holds up.
  int jumps = 0;                         ///< Engine::Fabric: colliders that jumped in this frame, as motions say; cloth
                                         ///< that was there then counts in `intersections` and `squeezed`.
  double lostMotion = 0;                 ///< Engine::Fabric: share of the way of all vertices that was cut off
                                         ///< so that nothing passes through anything, of all steps.
  int splits = 0;                        ///< Engine::Fabric: steps, and parts of steps, that were done over in parts
                                         ///< since much was stopped on its way.
  std::int64_t contactBytes = 0;         ///< Engine::Fabric: memory of what may touch, of the lists of what is near and
                                         ///< of contacts. It grows where more is near than ever before; no pair is
                                         ///< dropped.
  int newtonIterations = 0;              ///< Engine::Fabric: corrections, summed over the steps.
  int linearIterations = 0;              ///< Engine::Fabric: of the linear solver, summed over the steps.
  double residual = 0;                   ///< Engine::Fabric: last correction over the first, worst step.
  bool converged = true;                 ///< Engine::Fabric: all steps reached simulation.tolerance.
  bool atRest = false;                   ///< No point moved more than 1 mm over a frame, for 30 frames on end.
  std::optional<Divergence> divergence;  ///< Set: the state is the last good frame, stepping is over.
};

class ClothSprings;

/// One cloth of a World. The spans stay valid until the World is changed or destroyed; their
/// contents change with each Step.
class ClothView {
 public:
  std::span<const Vec3> positions() const { return positions_; }      ///< [m], one per vertex.
  std::span<const Vec3> velocities() const { return velocities_; }    ///< [m/s], one per vertex.
  std::span<const Vec3> rest() const { return rest_; }                ///< Where it started [m].
  std::span<const Vec2> uv() const { return uv_; }                    ///< 0..1, one per vertex.
  std::span<const Triangle> triangles() const { return triangles_; }  ///< Vertex indices.
  /// Of the enabled kinds, in creation order; Engine::Fabric: edges of triangles. Made when first asked for.
  std::span<const Edge> springs() const;
  std::span<const double> restLengths() const;                      ///< Of the springs [m].
  std::span<const std::int32_t> pinned() const { return pinned_; }  ///< Vertex indices, ascending.

 private:
  friend class World;
  std::span<const Vec3> positions_, velocities_, rest_;
  std::span<const Vec2> uv_;
  std::span<const Triangle> triangles_;
  const ClothSprings* springs_ = nullptr;
  std::span<const std::int32_t> pinned_;
};

/// Everything that the future of a World depends on, at the end of a frame. From it the same World goes
/// on to the same bits.
struct WorldState {
  struct Cloth {
    std::vector<Vec3> positions;  ///< [m], one per vertex.
    std::vector<Vec3> previous;   ///< One step before [m].
    std::vector<Vec3> anchors;    ///< Where each pin is held, apart from its motions [m]; in the order of pinned().
    std::vector<Fold> folds;  ///< Engine::Fabric, where folds set: one per edge of two triangles, ascending; else none.
  };
  std::shared_ptr<const Scene> scene;  ///< The settings of that moment.
  StepReport report;
  int restFrames = 0;  ///< For how many frames on end no point has moved more than 1 mm.
  std::vector<Cloth> cloths;
  std::vector<Touch> touches;   ///< Engine::Fabric: what touches.
  std::vector<Vec3> obstacles;  ///< Engine::Fabric: where the vertices of colliders were a step before, then where they
                                ///< are [m]: cloth that is in the way may hold them up.
  std::vector<Handle> handles;
  std::vector<Ball> balls;
  std::vector<Gust> gusts;

  std::size_t Bytes() const;  ///< Of memory, without the scene.
};

struct WorldOptions {
  int threads = 0;  ///< 0: as many as the machine has cores. The result does not depend on it.
};

class World {
 public:
  /// `scene` must be one in which `CheckScene` finds no error (LoadScene returns no other).
  explicit World(Scene scene, WorldOptions options = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Runs one frame: simulation.stepsPerFrame steps. After a divergence it does nothing more.
  const StepReport& Step();
  /// Back to the start, with the settings as they are now: without handles, balls and gusts.
  void Reset();
  /// Takes changed settings. The state is kept where the cloths stay the same grids with the same
  /// rest shape (everything but parameters of Effect::Rebuild); otherwise it starts anew. Points that
  /// are pinned now are held where they are, those that are not any more go free.
  /// Returns whether the state was kept. `scene` must pass CheckScene.
  bool Apply(Scene scene);

  /// Grips from now on, in place of those there were. The numbers of cloth and vertex must exist, and
  /// Check find nothing.
  void SetHandles(std::vector<Handle> handles);
  /// Puts the vertex of a handle at its target at once, and the cloth around it along, their velocities kept.
  void Place(const Handle& handle);
  /// One more ball; of more than kMostBalls the oldest goes. Check must find nothing.
  void AddBall(const Ball& ball);
  /// One more gust, from its start on. Check must find nothing.
  void AddGust(const Gust& gust);
  /// Forces that act in each step from now on, constant over the step, beside all others; none: an empty function.
  /// They are no part of the state: Reset, Apply and Restore leave them, Save does not keep them.
  void SetForces(ForceFunction forces);
  std::span<const Handle> handles() const;
  std::span<const Ball> balls() const;  ///< Those more than 100 m away are gone.

  /// Copies the state, into memory that is used again.
  void Save(WorldState& state) const;
  /// Goes back to a state that a World of the same cloths has saved, its settings included.
  void Restore(const WorldState& state);

  const Scene& scene() const;
  std::shared_ptr<const Scene> sharedScene() const;  ///< The same, for who needs it longer.
  const StepReport& report() const;                  ///< Of the last frame; zeros before the first.
  int ClothCount() const;
  ClothView Cloth(int index) const;  ///< 0 <= index < ClothCount().
  /// A fingerprint of all positions and balls, to the bit: equal runs have equal hashes.
  std::uint64_t StateHash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
