#include "percale/fabrics.h"

namespace percale {
namespace {

/// What an isotropic sheet resists shear with, from Young's modulus times thickness and Poisson's ratio.
constexpr double IsotropicShear(double stretch, double poissonRatio) {
  return stretch / (2 * (1 + poissonRatio));
}

constexpr std::string_view kTensile = "tensile tests of plain weaves, isotropic mean of warp and weft";
constexpr std::string_view kKesTensile =
    "KES-F tensile and shear tests, middle of the range for this kind: Kawabata 1980; Hu 2004, chapters 4 and 5";
constexpr std::string_view kKesBending =
    "KES-F pure bending tests, within the range for this kind: Kawabata 1980; Hu 2004, chapter 5";

constexpr FabricConstants kFabrics[] = {
    {.fabric = Fabric::Cotton,
     .name = "cotton",
     .density = 0.150,
     .stretchWarp = 261,
     .stretchWeft = 261,
     .shear = IsotropicShear(261, 0.243),
     .poissonRatio = 0.243,
     .bendWarp = 1.2e-5,
     .bendWeft = 1.2e-5,
     .stretchSource = kTensile,
     .bendSource = "KES-F pure bending tests, within the range for this kind (Kawabata 1980), so that a disc drapes as "
                   "cotton does: percale verify --only drape"},
    {.fabric = Fabric::Wool,
     .name = "wool",
     .density = 0.235,
     .stretchWarp = 96.6,
     .stretchWeft = 96.6,
     .shear = IsotropicShear(96.6, 0.277),
     .poissonRatio = 0.277,
     .bendWarp = 2.6e-5,
     .bendWeft = 2.6e-5,
     .stretchSource = kTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::WoolLycra,
     .name = "wool_lycra",
     .density = 0.178,
     .stretchWarp = 24.9,
     .stretchWeft = 24.9,
     .shear = IsotropicShear(24.9, 0.071),
     .poissonRatio = 0.071,
     .bendWarp = 1.2e-5,
     .bendWeft = 1.2e-5,
     .stretchSource = kTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::Polyester,
     .name = "polyester",
     .density = 0.165,
     .stretchWarp = 120,
     .stretchWeft = 120,
     .shear = IsotropicShear(120, 0.381),
     .poissonRatio = 0.381,
     .bendWarp = 1.4e-5,
     .bendWeft = 1.4e-5,
     .stretchSource = kTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::Silk,
     .name = "silk",
     .density = 0.060,
     .stretchWarp = 300,
     .stretchWeft = 200,
     .shear = 30,
     .poissonRatio = 0.2,
     .bendWarp = 4e-6,
     .bendWeft = 2.5e-6,
     .stretchSource = kKesTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::Denim,
     .name = "denim",
     .density = 0.400,
     .stretchWarp = 900,
     .stretchWeft = 600,
     .shear = 120,
     .poissonRatio = 0.2,
     .bendWarp = 2.2e-4,
     .bendWeft = 1.3e-4,
     .stretchSource = kKesTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::Leather,
     .name = "leather",
     .density = 0.700,
     .stretchWarp = 4000,
     .stretchWeft = 4000,
     .shear = IsotropicShear(4000, 0.35),
     .poissonRatio = 0.35,
     .bendWarp = 1e-3,
     .bendWeft = 1e-3,
     .stretchSource = kKesTensile,
     .bendSource = kKesBending},
    {.fabric = Fabric::Felt,
     .name = "felt",
     .density = 0.300,
     .stretchWarp = 400,
     .stretchWeft = 400,
     .shear = IsotropicShear(400, 0.3),
     .poissonRatio = 0.3,
     .bendWarp = 3e-4,
     .bendWeft = 3e-4,
     .stretchSource = kKesTensile,
     .bendSource = kKesBending},
};

}  // namespace

std::span<const FabricConstants> Fabrics() {
  return kFabrics;
}

void SetFabric(ClothSettings& cloth, Fabric fabric) {
  const FabricConstants& constants = kFabrics[static_cast<std::size_t>(fabric)];
  const ClothSettings defaults;
  cloth.fabric = fabric;
  cloth.density = constants.density;
  cloth.stretchWarp = constants.stretchWarp;
  cloth.stretchWeft = constants.stretchWeft;
  cloth.shear = constants.shear;
  cloth.poissonRatio = constants.poissonRatio;
  cloth.bendWarp = constants.bendWarp;
  cloth.bendWeft = constants.bendWeft;
  cloth.stretchDamping = defaults.stretchDamping;
  cloth.bendDamping = defaults.bendDamping;
  cloth.strainLimit = defaults.strainLimit;
}

}  // namespace percale
