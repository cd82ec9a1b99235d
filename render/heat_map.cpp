#include "render/heat_map.h"

#include <algorithm>
#include <cmath>

#include "render/scene_view.h"

namespace percale {

void HeatMap::Measure(const HeatMapSettings& settings, std::span<const ClothShape> cloths,
                      const ContactFinder& contacts) {
  const Quantity quantity = scale_.quantity = settings.quantity;
  values_.resize(cloths.size());
  if (quantity == Quantity::Contact) {
    scale_.range = {0, 2};
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      const std::span<const Contact> found = contacts.Of(static_cast<int>(c));
      values_[c].resize(found.size());
      std::transform(found.begin(), found.end(), values_[c].begin(),
                     [](Contact contact) { return static_cast<float>(contact); });
    }
    return;
  }
  const float nothing = quantity == Quantity::Stretch || quantity == Quantity::Compression ? 1 : 0;
  float greatest = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    MeasureCloth(quantity, cloths[c], values_[c]);
    for (const float value : values_[c]) greatest = std::max(greatest, std::abs(value - nothing));
  }
  const double span = spans_[static_cast<std::size_t>(quantity)].Update(static_cast<double>(greatest));
  scale_.range = settings.range                      ? *settings.range
                 : quantity == Quantity::Compression ? ValueRange{1 - span, 1}
                                                     : ValueRange{nothing, nothing + span};
}

void HeatMap::MeasureCloth(Quantity quantity, const ClothShape& cloth, std::vector<float>& values) {
  const std::size_t count = cloth.positions.size();
  measured_.resize(count);
  switch (quantity) {
    case Quantity::Stretch:
      second_.resize(count);
      MeasureStretch(cloth.positions, cloth.springs, cloth.restLengths, measured_, second_);
      break;
    case Quantity::Compression:
      // What is only stretched is not compressed.
      second_.resize(count);
      MeasureStretch(cloth.positions, cloth.springs, cloth.restLengths, second_, measured_);
      for (double& ratio : measured_) ratio = std::min(ratio, 1.0);
      break;
    case Quantity::Speed:
      MeasureSpeed(cloth.velocities, measured_);
      break;
    case Quantity::Curvature:
      // To which side does not matter: which is the front of a cloth?
      curvature_.Measure(cloth.positions, cloth.triangles, measured_);
      for (double& curvature : measured_) curvature = std::abs(curvature);
      break;
    case Quantity::None:
    case Quantity::Contact:
      return;
  }
  values.resize(count);
  std::transform(measured_.begin(), measured_.end(), values.begin(), [](double v) { return static_cast<float>(v); });
}

void FindContacts(const Scene& scene, std::span<const ClothShape> cloths, std::span<const Ball> balls, double time,
                  ContactFinder& finder) {
  std::vector<ContactCloth> all;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    all.push_back({cloths[c].positions, cloths[c].rest, scene.cloths[c].thickness});
  finder.Find(all, SolidsAt(scene, time, balls));
}

}  // namespace percale
