#pragma once
/// \file
/// Memory in which the parts of a step take turns.

#include <cstddef>
#include <vector>

#include "percale/vec3.h"

namespace percale::fabric {

/// Two vectors per vertex, of cloth first and then of obstacles, for whoever is at work:
///  - Objective leaves the plates' forces in `first` when it is asked for an energy, and GradientAndTangent at the same
///    place takes them from there. Nothing else may be called in between.
///  - NewtonSolver has its gradient in `first` and what it tries in `second`. Both are over when Solve returns.
///  - ContactStep has positions in `first` and ways in `second`. Both are over when any of its functions returns.
struct VertexScratch {
  std::vector<Vec3> first, second;

  /// Has room for so many vertices from now on. Nothing is kept.
  void Fit(std::size_t vertices) {
    for (std::vector<Vec3>* vectors : {&first, &second}) {
      if (vectors->size() == vertices) continue;
      *vectors = std::vector<Vec3>();
      vectors->resize(vertices);
    }
  }
};

}  // namespace percale::fabric
