#pragma once
/// \file
/// Why a simulation diverged, in words.

#include <cstdint>

#include "percale/world.h"

namespace percale {

/// The most likely cause and its remedy, from the settings of the cloth whose vertex was lost.
Divergence ExplainDivergence(const Scene& scene, std::int64_t step, int cloth, int vertex);

}  // namespace percale
