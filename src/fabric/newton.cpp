#include "fabric/newton.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace percale::fabric {
namespace {

/// A step must gain this share of what the slope promises (Nocedal, Wright 2006, "Numerical Optimization", eq. 3.4).
constexpr double kSufficient = 1e-4;
constexpr int kMostHalvings = 12;
/// Corrections shorter than this are rounding: there is nothing left to do [m, root mean square].
constexpr double kNoMove = 1e-9;
/// A correction that gains nothing though it is longer than this was spoiled in the linear system, not by the rounding
/// of energies near the minimum, which was seen to hide up to 4e-8 [m, root mean square].
constexpr double kRounding = 1e-6;
/// What r'z falls to in a linear system: a Newton step of little curvature is worth no more.
constexpr double kLinearTolerance = 0.01;
/// The share that the last iteration of a linear system may gain; it makes r'z fall about as far.
constexpr double kLinearGain = 0.04;
/// The same in contact, where the sides that push each other are most of r'z, and what they carry along is least.
constexpr double kTouchingTolerance = 1e-3, kTouchingGain = 0.01;
/// A correction gained what was foretold if it gained that within this share. What is left then is the error of linear
/// systems, which are better solved longer than anew.
constexpr double kForetold = 0.2;

}  // namespace

NewtonSolver::NewtonSolver(const FabricModel& model, const Executor& executor)
    : model_(model),
      executor_(executor),
      matrix_(MakePattern(model.vertexCount, model.triangles)),
      objective_(model, matrix_.pattern(), executor) {
  right_.assign(VectorLength(model.vertexCount), 0);
  direction_.assign(VectorLength(model.vertexCount), 0);
  chunkSums_.resize(Index(Chunks(model.vertexCount)));
}

void NewtonSolver::SetUp(double h, std::span<const std::uint8_t> free) {
  std::vector<std::uint8_t> pinned(free.size());
  for (std::size_t v = 0; v < free.size(); ++v) pinned[v] = free[v] ? 0 : 1;
  objective_.TakeMaterials();
  matrix_.SetUp(model_.plates, pinned);
  SetStep(h);
  MaterialMesh material{.triangles = model_.triangles, .materialTriangles = {}, .material = {}};
  if (model_.hasPanels) {
    material.materialTriangles = model_.ChartTriangles();
    material.material = model_.chart;
  }
  multigrid_.SetUp(matrix_, MakeHierarchy(matrix_.pattern(), material, pinned));
  conjugateGradient_.SetUp(model_.vertexCount);
}

/// Inertia is all that the length of a step changes in the constant part: masses over h^2 on the diagonal.
void NewtonSolver::SetStep(double h) {
  ForRange(executor_, Index(model_.vertexCount), [&](int row) {
    double bending = 0;
    model_.plates.ForRow(row, [&](std::int32_t column, double value) { bending = column == row ? value : bending; });
    matrix_.SetDiagonal(row, static_cast<Real>(bending + model_.mass[Index(row)] / (h * h)));
  });
}

NewtonResult NewtonSolver::Solve(std::span<Vec3> y, double energy, const NewtonSettings& settings) {
  NewtonResult result;
  gradient_ = std::span(objective_.scratch().first).first(y.size());
  trial_ = std::span(objective_.scratch().second).first(y.size());
  double first = 0;
  bool foretold = false;
  int linearLeft = settings.maxIterations * settings.maxLinearIterations;
  while (result.iterations < settings.maxIterations && linearLeft >= settings.maxLinearIterations) {
    const bool touched = matrix_.extra().any;
    energy += objective_.GradientAndTangent(y, gradient_, matrix_);
    const bool touches = matrix_.extra().any;
    if (result.iterations == 0)
      multigrid_.Refill(matrix_, executor_);
    else if (touched || touches)
      multigrid_.RefillExtra(matrix_, executor_);
    ForRange(executor_, y.size(), [&](int v) {
      Real* r = &right_[3 * Index(v)];
      const Vec3& g = gradient_[Index(v)];
      r[0] = static_cast<Real>(-g.x), r[1] = static_cast<Real>(-g.y), r[2] = static_cast<Real>(-g.z);
    });
    const SolveResult linear =
        conjugateGradient_.Solve(matrix_, multigrid_, right_.data(), direction_.data(),
                                 {.maxIterations = foretold ? linearLeft : settings.maxLinearIterations,
                                  .tolerance = touches ? kTouchingTolerance : kLinearTolerance,
                                  .leastGain = touches ? kTouchingGain : kLinearGain},
                                 executor_);
    result.linearIterations += linear.iterations;
    linearLeft -= linear.iterations;
    const auto [slope, square] = MeasureDirection();
    const double alpha = slope < 0 ? SearchLine(y, energy, slope) : 0;
    if (alpha == 0) {
      const double left = std::sqrt(square / model_.vertexCount);
      result.residual = left <= kRounding ? 0 : first > 0 ? std::max(left / first, result.residual) : 1;
      break;
    }
    ForRange(executor_, y.size(), [&](int v) { y[Index(v)] = trial_[Index(v)]; });
    const double promised = -0.5 * slope;  // by the parabola, at its minimum along the direction
    foretold = alpha == 1 && std::abs(energy - trialEnergy_ - promised) <= kForetold * promised;
    energy = trialEnergy_;
    ++result.iterations;
    const double length = alpha * std::sqrt(square / model_.vertexCount);
    if (result.iterations == 1) first = length;
    result.residual = first > 0 ? length / first : 0;
    if (length < kNoMove) result.residual = 0;
    if (result.iterations > 1 || length < kNoMove) {
      if (result.residual <= settings.tolerance) break;
    }
  }
  result.converged = result.residual <= settings.tolerance;
  return result;
}

/// The slope of the energy along the direction, and the square of its length.
std::array<double, 2> NewtonSolver::MeasureDirection() {
  executor_.ForChunks(static_cast<int>(chunkSums_.size()), [&](int chunk) {
    std::array<double, 2> sums{};
    for (int v = chunk * kRowsPerChunk; v < std::min((chunk + 1) * kRowsPerChunk, model_.vertexCount); ++v) {
      const Real* d = &direction_[3 * Index(v)];
      const Vec3 way{d[0], d[1], d[2]};
      sums[0] += Dot(gradient_[Index(v)], way);
      sums[1] += Dot(way, way);
    }
    chunkSums_[Index(chunk)] = sums;
  });
  std::array<double, 2> sums{};
  for (const std::array<double, 2>& part : chunkSums_) sums[0] += part[0], sums[1] += part[1];
  return sums;
}

/// Halves the step from 1 on until it gains enough; leaves where it leads in trial_. Returns 0 where nothing gains.
double NewtonSolver::SearchLine(std::span<const Vec3> y, double energy, double slope) {
  double alpha = 1;
  for (int halving = 0; halving <= kMostHalvings; ++halving, alpha /= 2) {
    ForRange(executor_, y.size(), [&](int v) {
      const Real* d = &direction_[3 * Index(v)];
      trial_[Index(v)] = y[Index(v)] + Vec3{d[0], d[1], d[2]} * alpha;
    });
    trialEnergy_ = objective_.Energy(trial_);
    if (trialEnergy_ <= energy + kSufficient * alpha * slope) return alpha;
  }
  return 0;
}

}  // namespace percale::fabric
