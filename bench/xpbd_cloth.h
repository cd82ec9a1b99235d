#pragma once
/// \file
/// The textbook's answer to stiff cloth in real time, to be measured against: extended position-based dynamics with
/// small steps (Macklin, Storey et al. 2019, "Small steps in physics simulation"), on the same membrane and bending
/// energies as the engine: one iteration per substep, triangle after triangle, hinge after hinge.

#include <cstdint>
#include <span>
#include <vector>

#include "fabric/fabric_model.h"

namespace percale::bench {

class XpbdCloth {
 public:
  /// The model must outlive it. Membranes must be St. Venant-Kirchhoff's; damping and the strain limit are left out.
  XpbdCloth(const fabric::FabricModel& model, std::span<const std::uint8_t> free);

  /// One frame of `seconds` in so many substeps.
  void Frame(double seconds, int substeps, const Vec3& gravity);

  std::span<const Vec3> positions() const { return position_; }

 private:
  void SolveTriangle(std::size_t triangle, double perStep);
  void SolveHinge(std::size_t hinge, double perStep);

  const fabric::FabricModel& model_;
  std::vector<double> inverseMass_;                 // per vertex [1/kg], 0 for pins
  std::vector<fabric::RestTriangle<double>> rest_;  // per triangle
  std::vector<Matrix3<double>> compliance_;         // per triangle: of its three strains [1/J]
  std::vector<double> hingeStiffness_;              // per hinge, of the jump of slope [J]
  std::vector<Vec3> position_, previous_, velocity_;
};

/// The 99th percentile of the triangles' greater principal stretch.
double Stretch99(const fabric::FabricModel& model, std::span<const Vec3> positions);

}  // namespace percale::bench
