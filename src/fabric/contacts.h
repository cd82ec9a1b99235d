#pragma once
/// \file
/// Contact and friction in the potential of one step. Each contact is a plane, found before the step and kept through
/// it: the gap between its two sides is linear in the positions, and costs energy where it is small. docs/contact.md
/// says what follows from that and why nothing passes through anything nevertheless.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/safe_move.h"
#include "collide/solid_path.h"
#include "collide/untangle.h"
#include "fabric/contact_memory.h"
#include "fabric/system_matrix.h"
#include "math/vector3.h"
#include "percale/vec3.h"

namespace percale::fabric {

/// What the surface of a body is like.
struct ContactSurface {
  double friction = 0;               ///< Coulomb's coefficient.
  bool rulesFriction = false;        ///< Whether its coefficient counts alone; else that of two is their mean.
  double core = 0;                   ///< So far all is solid around its vertices and edges [m].
  const SolidStep* solid = nullptr;  ///< Where that is more than 0: of which they are the middle.
};

/// How deep in a solid counts at most, over the distance of contact: what is deeper comes out in some steps.
inline constexpr double kDeepest = 0.5;

/// One plane between two sides.
struct Contact {
  ContactKey key;                        ///< What touches.
  std::array<std::int32_t, 4> vertex{};  ///< Of cloth; -1: none.
  std::array<double, 4> weight{};        ///< gap = normal · (sum of weights times positions) + offset
  Vector3<double> normal;                ///< A unit vector.
  double offset = 0;                     ///< [m]
  double gap = 0;                        ///< As the step begins [m].
  double reach = 0;                      ///< Gap below which there is contact [m].
  double counts = 1;                     ///< For so much of a contact.
  double base = 0;                       ///< Stiffness at half of `reach` and above [N/m].
  double stiffness = 0;                  ///< Of the parabola [N/m].
  double distance = 0;                   ///< Gap below which the sides push each other [m].
  double friction = 0;                   ///< Coulomb's coefficient.
  Vector3<double> hold;                  ///< Of friction, as the step begins [N].
  Vector3<double> slideFrom;  ///< slide = what is tangential of sum of weights times positions - slideFrom [m]
  // As of the last Update:
  bool active = true;
  bool held = false;  ///< Whether it pulls as well, as in a step's first iteration what pressed at the end of the last.
  bool seen = true;   ///< Whether it was active in any Update of the step.
  double force = 0;   ///< With which the sides push each other [N].
  double drag = 0;    ///< Force over slide of friction, one of a spring or less [N/m].
};

class Contacts {
 public:
  /// Both must outlive it.
  Contacts(const ContactMesh& mesh, const Executor& executor);

  struct Step {
    std::span<const Vec3> begin;               ///< Per vertex of cloth: where the step begins and it slides from [m].
    std::span<const Vec3> start;               ///< Per vertex of the mesh: where it is now [m].
    std::span<const Vec3> way;                 ///< Of obstacles to the end of the step, of cloth where it is led [m].
    std::span<const std::uint8_t> free;        ///< Per vertex of cloth: 0 for pins.
    std::span<const double> mass;              ///< Per vertex of cloth [kg].
    double h = 0;                              ///< Length of the step [s].
    bool firm = false;                         ///< Contacts are as stiff as the tension in cloth asks for.
    std::span<const ContactSurface> surfaces;  ///< Per body.
  };
  /// Forgets all planes; those of the step before are remembered for friction.
  void Begin(const Step& step);
  /// Planes between what is near, or meets on the way. The spans of the step must stay until all are added.
  void AddPairs(PairKind kind, const NearPairs& pairs);
  /// Pulls at what is tangled.
  void AddTangles(std::span<const Tangle> tangles, const ContactDistances& distances);
  /// A plane through `point`, which is where the surface will be at the end of the step and was at `pointBefore` at
  /// its start, off which a vertex of cloth keeps. `gap`: at the start [m].
  void AddPlane(const ContactKey& key, std::int32_t vertex, double gap, double distance, const Vector3<double>& normal,
                const Vector3<double>& point, const Vector3<double>& pointBefore, const ContactSurface& surface);

  /// What the planes cost at y [J]: of those that were active at the last Update.
  double Energy(std::span<const Vec3> y);
  /// Takes as active what costs energy at y, and friction as the forces there have it; in the first call of a step, as
  /// those at the end of the last step. Returns the energy. `matrix`: the second derivative of all else, from which
  /// follows how stiff contacts have to be.
  double Update(std::span<const Vec3> y, const SystemMatrix& matrix);
  /// Of what is active.
  void AddGradient(std::span<const Vec3> y, std::span<Vec3> gradient) const;
  /// What they add to the second derivative.
  std::span<const ExtraTerm> Terms();
  /// Remembers what sticks where the step has ended.
  void End(std::span<const Vec3> y);
  /// Forgets what stuck.
  void Clear();
  /// What is remembered, ascending by what touches; and the same, set.
  void ReadMemory(std::vector<Touch>& touches) const;
  void WriteMemory(std::span<const Touch> touches);

  std::span<const Contact> all() const { return contacts_; }
  /// Of all that it holds.
  std::size_t MemoryBytes() const;

 private:
  double ShareOf(PairKind kind, const VertexQuad& vertex, const std::array<double, 4>& weight) const;
  template <class OfVertex>
  double Resistance(const Contact& contact, OfVertex&& ofVertex) const;
  void Start(double gap, double reach, double approach, double counts, Contact& contact) const;
  static void Fit(double k, Contact& contact);
  double FrictionOf(const ContactSurface& a, const ContactSurface& b) const;
  void Remember(Contact& contact) const;
  template <class Body>
  double SumEnergies(Body&& energyOf);
  void AddPairs(PairKind kind, const NearPairs& pairs, std::size_t first, std::size_t last);

  const ContactMesh& mesh_;
  const Executor& executor_;
  std::vector<std::uint8_t> triangles_;  // per vertex: how many it has
  std::vector<std::uint8_t> border_;     // per vertex: 1 at a border
  Step step_;
  std::vector<Contact> contacts_;
  // While pairs are added, some at a time:
  std::vector<PairState> states_;
  std::vector<Contact> found_;         // of each chunk's pairs, from where the chunk begins
  std::vector<std::size_t> foundEnd_;  // per chunk
  std::vector<ExtraTerm> terms_;
  std::vector<double> chunkSums_;
  ContactMemory memory_, nextMemory_;
  bool first_ = true;  // no Update yet in this step
};

}  // namespace percale::fabric
