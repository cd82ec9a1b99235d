#pragma once
/// \file
/// Constants of real fabrics, each with where it was measured.

#include <span>
#include <string_view>

#include "percale/scene.h"

namespace percale {

struct FabricConstants {
  Fabric fabric;
  std::string_view name;                   ///< As in a scene file: "wool_lycra".
  double density;                          ///< [kg/m^2]
  double stretchWarp, stretchWeft, shear;  ///< [N/m]
  double poissonRatio;
  double bendWarp, bendWeft;       ///< [N m]
  std::string_view stretchSource;  ///< Where the density and the constants of stretching come from.
  std::string_view bendSource;     ///< Where those of bending come from.
};

/// All, in the enumeration's order.
std::span<const FabricConstants> Fabrics();

/// Makes the cloth one of that fabric: sets all of its constants, and those of damping and locking to their defaults.
void SetFabric(ClothSettings& cloth, Fabric fabric);

}  // namespace percale
