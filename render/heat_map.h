#pragma once
/// \file
/// Measures cloths for their heat map.

#include <span>
#include <vector>

#include "percale/interaction.h"
#include "percale/scene.h"
#include "render/heat_scale.h"
#include "world/measure.h"

namespace percale {

struct ClothShape;

class HeatMap {
 public:
  /// Measures one value per vertex of each cloth. `contacts` has found those of the same cloths; it is
  /// only looked at for Quantity::Contact.
  void Measure(const HeatMapSettings& settings, std::span<const ClothShape> cloths, const ContactFinder& contacts);

  const HeatScale& scale() const { return scale_; }
  /// Of a cloth, one per vertex, for the card.
  std::span<const float> Values(std::size_t cloth) const { return values_[cloth]; }

 private:
  void MeasureCloth(Quantity quantity, const ClothShape& cloth, std::vector<float>& values);

  HeatScale scale_;
  std::vector<std::vector<float>> values_;
  std::vector<double> measured_, second_;
  CurvatureMeter curvature_;
  // Of the automatic range: how far the values go from the one that is nothing. What is less is noise.
  SteadySpan spans_[kQuantities] = {SteadySpan(1),    SteadySpan(1e-3), SteadySpan(1e-3),
                                    SteadySpan(0.01), SteadySpan(0.1),  SteadySpan(1)};
};

/// The contacts of cloths that are drawn, with each other, with the colliders as they are at `time` [s], and with
/// balls.
void FindContacts(const Scene& scene, std::span<const ClothShape> cloths, std::span<const Ball> balls, double time,
                  ContactFinder& finder);

}  // namespace percale
