#pragma once
/// \file
/// Why a simulation diverged, in words.

#include <cstdint>

#include "percale/world.h"

namespace percale {

/// The most likely cause and its remedy, from the settings of the cloth whose vertex was lost.
Divergence ExplainDivergence(const Scene& scene, std::int64_t step, int cloth, int vertex);

/// What is wrong with a force of the program's own [N].
Divergence ExplainForce(std::int64_t step, int cloth, int vertex, const Vec3& force);

}  // namespace percale
