#pragma once
/// \file
/// With what force cloth is touched, and where:
///
///     world.Step();
///     for (const percale::ContactForce& contact : percale::ReadContacts(world)) total += contact.Total();
///
/// Nothing of it is worked out before it is asked for.

#include <vector>

#include "percale/vec3.h"
#include "percale/world.h"

namespace percale {

/// A contact of Engine::Fabric at the end of a step: of two places in cloth, or of cloth and a collider. All is said of
/// the side that the normal points to; the other has the opposite force. Where cloth lies on cloth, many contacts
/// share what presses.
struct ContactForce {
  int cloth = 0, vertex = 0;             ///< Of that side, the vertex that has most of it.
  int otherCloth = -1, otherVertex = 0;  ///< The same of the other side; -1: a collider.
  Vec3 point;                            ///< In the middle between the two [m].
  Vec3 normal;                           ///< Unit.
  double force = 0;                      ///< That presses, along the normal [N], > 0.
  Vec3 friction;                         ///< That holds or brakes, across it [N].
  double coefficient = 0;                ///< Coulomb's: friction is at most this times the force...
  bool slides = false;                   ///< ...and is as much as that where it slides. Else it sticks.

  Vec3 Total() const { return normal * force + friction; }  ///< [N]
};

/// Those of the last step, in an order that does not depend on the number of threads. None of Engine::Springs, whose
/// contacts move points and know no force, and none of balls, which push cloth once it has moved.
std::vector<ContactForce> ReadContacts(const World& world);
/// The same of a state that a World has saved.
std::vector<ContactForce> ReadContacts(const WorldState& state);

}  // namespace percale
