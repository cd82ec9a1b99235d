#include "fabric/reference_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#define EIGEN_MPL2_ONLY
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "core/index.h"
#include "fabric/energy/attachment.h"

namespace percale::fabric {
namespace {

// The compression that the second derivative keeps, in shares of what objective.cpp keeps: as much as the matrix
// stands, for then Newton's method is quadratic.
constexpr double kFirstShare = 4, kMostShare = 64, kGrowth = 2, kRetreat = 4, kLeastShare = 1e-3;
constexpr double kReferenceSufficient = 1e-4;
constexpr int kReferenceHalvings = 40;

Vector3<double> PointOf(std::span<const Vec3> y, std::int32_t v) {
  return From<double>(y[Index(v)]);
}

}  // namespace

struct ReferenceSolver::Matrix {
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::SparseMatrix<double> values;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

ReferenceSolver::ReferenceSolver(const FabricModel& model) : model_(model), matrix_(std::make_unique<Matrix>()) {
  startStrain_.resize(model.triangles.size());
  startAngle_.resize(model.hinges.size());
}
ReferenceSolver::~ReferenceSolver() = default;

void ReferenceSolver::Begin(const StepSettings& step) {
  step_ = step;
  for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
    const Triangle& tri = model_.triangles[t];
    startStrain_[t] = GreenStrain(Deformation(model_.Rest(t), PointOf(step.start, tri.a), PointOf(step.start, tri.b),
                                              PointOf(step.start, tri.c)));
  }
  for (std::size_t h = 0; h < model_.hinges.size(); ++h) {
    const std::int32_t* v = model_.hinges[h].vertex;
    startAngle_[h] = HingeAngle(PointOf(step.start, v[0]), PointOf(step.start, v[1]), PointOf(step.start, v[2]),
                                PointOf(step.start, v[3]));
  }
}

/// Adds up what is asked for: the energy, the gradient, and by addBlock(i, j, block) the second derivative.
template <class Add>
void ReferenceSolver::Evaluate(std::span<const Vec3> y, double* energy, std::span<Vec3> gradient, double floorShare,
                               Add* addBlock) const {
  const double perStep = step_.h > 0 ? 1 / step_.h : 0;
  double sum = 0;
  const auto addGradient = [&](std::int32_t v, const Vector3<double>& g) {
    if (!gradient.empty()) gradient[Index(v)] += ToVec3(g);
  };
  const auto block = [&](std::int32_t i, std::int32_t j, const Matrix3<double>& m) {
    if (addBlock) (*addBlock)(i, j, m);
  };

  for (int v = 0; v < model_.vertexCount; ++v) {
    if (!step_.free[Index(v)]) continue;
    const Vector3<double> off = PointOf(y, v) - From<double>(step_.Predicted(Index(v))),
                          way = PointOf(y, v) - PointOf(step_.start, v);
    const VertexLoad load = step_.loads.empty() ? VertexLoad{} : step_.loads[Index(v)];
    const double inertia = model_.mass[Index(v)] * perStep * perStep;
    const Vector3<double> pulled = load.stiffness * way, force = From<double>(load.force);
    sum += 0.5 * inertia * Dot(off, off) + 0.5 * Dot(way, pulled) - Dot(force, way);
    addGradient(v, off * inertia + pulled - force);
    block(v, v, Diagonal(inertia) + load.stiffness.Full());
  }

  for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
    const Triangle& tri = model_.triangles[t];
    const std::int32_t corners[3] = {tri.a, tri.b, tri.c};
    const std::size_t cloth = model_.ClothOf(static_cast<std::int64_t>(t));
    // All of a membrane's terms are in proportion to its area, so that of a patch counts as so much more of it.
    RestTriangle<double> rest = model_.Rest(t);
    rest.area *= model_.Strength(t);
    const Membrane& membrane = model_.membranes[cloth];
    const DeformationGradient<double> f = Deformation(rest, PointOf(y, tri.a), PointOf(y, tri.b), PointOf(y, tri.c));
    const MembraneDamping<double> damping{membrane.damping * perStep, startStrain_[t]};
    const bool rubber = membrane.kind == MembraneLaw::NeoHookean;
    const MembraneStress<double> stress =
        rubber ? Stress(membrane.neoHookean, f) : Stress(membrane.orthotropic, f, damping);
    sum += rest.area * stress.energy;
    const TriangleGradient<double> g = CornerGradient(rest, stress);
    for (int k = 0; k < 3; ++k) addGradient(corners[k], g.corner[k]);
    if (addBlock) {
      const double floor = step_.h > 0 ? floorShare * model_.Buckling(t) * perStep : std::numeric_limits<double>::max();
      const TriangleHessian<double> h = CornerHessian(
          rest, rubber ? Tangent(membrane.neoHookean, f, floor) : Tangent(membrane.orthotropic, f, floor, damping));
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        block(corners[k], corners[k], h.diagonal[k]);
        block(corners[k], corners[next], h.next[k]);
        block(corners[next], corners[k], Transposed(h.next[k]));
      }
    }
    if (const double pressure = model_.pressure[cloth]; pressure != 0) {
      const EnclosedVolume<double> volume = Volume(PointOf(y, tri.a), PointOf(y, tri.b), PointOf(y, tri.c));
      sum -= pressure * volume.volume;
      for (int k = 0; k < 3; ++k) addGradient(corners[k], volume.gradient[k] * -pressure);
    }
    if (!model_.plate[Index(tri.a)]) {
      EdgeAngles<double> angle, atRest;
      BendingDamping<double> drag;
      drag.rate = model_.bendDamping[cloth] * perStep;
      Hinge<double> hinges[3];
      std::int32_t vertices[6] = {tri.a, tri.b, tri.c, -1, -1, -1};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t h = model_.hingeOf[t][k];
        if (h < 0) continue;
        const FabricHinge& hinge = model_.hinges[Index(h)];
        const bool first = hinge.triangle[0] == static_cast<std::int32_t>(t);
        const std::int32_t from = corners[(k + 1) % 3], to = corners[(k + 2) % 3];
        vertices[3 + k] = hinge.vertex[first ? 3 : 2];
        hinges[k] =
            HingeGradient(PointOf(y, from), PointOf(y, to), PointOf(y, corners[k]), PointOf(y, vertices[3 + k]));
        angle.edge[k] = hinges[k].angle;
        atRest.edge[k] = hinge.restAngle;
        drag.start.edge[k] = startAngle_[Index(h)];
      }
      const BendingMoments<double> moments = Moments(model_.bending[t], angle, atRest, drag);
      sum += moments.energy;
      for (int k = 0; k < 3; ++k) {
        if (vertices[3 + k] < 0) continue;
        const std::int32_t at[4] = {corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k], vertices[3 + k]};
        for (int i = 0; i < 4; ++i) addGradient(at[i], hinges[k].gradient[i] * moments.moment.edge[k]);
      }
      if (addBlock) {
        const BendingHessian<double> h = GaussNewton(model_.bending[t], hinges);
        for (int i = 0; i < 6; ++i) {
          for (int j = i; j < 6; ++j) {
            if (vertices[i] < 0 || vertices[j] < 0) continue;
            const Matrix3<double> m = h.block[Upper6(i, j)] * (1 + drag.rate);
            block(vertices[i], vertices[j], m);
            if (i != j) block(vertices[j], vertices[i], Transposed(m));
          }
        }
      }
    }
  }

  for (const FabricTether& tether : model_.tethers) {
    if (!step_.free[Index(tether.vertex)]) continue;
    const PointEnergy<double> pull =
        TetherEnergy(tether.stiffness, From<double>(tether.anchor), tether.length, PointOf(y, tether.vertex));
    sum += pull.energy;
    addGradient(tether.vertex, pull.gradient);
    block(tether.vertex, tether.vertex, pull.hessian);
  }

  for (int v = 0; v < model_.vertexCount; ++v) {
    if (!model_.plate[Index(v)]) continue;
    // Rows sum to zero: counted from v, only short ways cancel.
    Vector3<double> force;
    model_.plates.ForRow(v, [&](std::int32_t column, double value) {
      const Vector3<double> way = PointOf(y, column) - PointOf(y, v);
      force += way * value;
      sum -= 0.25 * value * Dot(way, way);
      block(v, column, Diagonal(value));
    });
    addGradient(v, force);
  }
  if (energy) *energy = sum;
}

double ReferenceSolver::Energy(std::span<const Vec3> y) const {
  double energy = 0;
  Evaluate(y, &energy, {}, 0, static_cast<void (*)(std::int32_t, std::int32_t, const Matrix3<double>&)>(nullptr));
  return energy;
}

void ReferenceSolver::Gradient(std::span<const Vec3> y, std::span<Vec3> gradient) const {
  std::fill(gradient.begin(), gradient.end(), Vec3{});
  Evaluate(y, nullptr, gradient, 0, static_cast<void (*)(std::int32_t, std::int32_t, const Matrix3<double>&)>(nullptr));
  for (std::size_t v = 0; v < gradient.size(); ++v) {
    if (!step_.free[v]) gradient[v] = {};
  }
}

/// Factors the second derivative at y. Returns whether it is positive definite.
bool ReferenceSolver::Factor(std::span<const Vec3> y, double floorShare) {
  std::vector<Eigen::Triplet<double>>& triplets = matrix_->triplets;
  triplets.clear();
  const auto add = [&](std::int32_t i, std::int32_t j, const Matrix3<double>& m) {
    if (!step_.free[Index(i)] || !step_.free[Index(j)]) return;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) triplets.emplace_back(3 * i + r, 3 * j + c, m(r, c));
    }
  };
  Evaluate(y, nullptr, {}, floorShare, &add);
  for (int v = 0; v < model_.vertexCount; ++v) {
    for (int r = 0; r < 3 && !step_.free[Index(v)]; ++r) triplets.emplace_back(3 * v + r, 3 * v + r, 1);
  }
  const bool first = matrix_->values.nonZeros() == 0;
  matrix_->values.resize(3 * model_.vertexCount, 3 * model_.vertexCount);
  matrix_->values.setFromTriplets(triplets.begin(), triplets.end());
  if (first) matrix_->factor.analyzePattern(matrix_->values);
  matrix_->factor.factorize(matrix_->values);
  return matrix_->factor.info() == Eigen::Success && matrix_->factor.vectorD().minCoeff() > 0;
}

bool ReferenceSolver::IsStable(std::span<const Vec3> y) {
  return Factor(y, kMostShare);
}

ReferenceResult ReferenceSolver::Solve(std::span<Vec3> y, const ReferenceSettings& settings) {
  ReferenceResult result;
  const std::size_t count = y.size();
  std::vector<Vec3> gradient(count), trial(count);
  double energy = Energy(y), share = kFirstShare;
  while (result.iterations < settings.maxIterations) {
    Gradient(y, gradient);
    while (!Factor(y, share) && share > 0) share = share > kLeastShare ? share / kRetreat : 0;
    Eigen::VectorXd right(static_cast<Eigen::Index>(3 * count));
    for (std::size_t v = 0; v < count; ++v) {
      right.segment<3>(static_cast<Eigen::Index>(3 * v)) << -gradient[v].x, -gradient[v].y, -gradient[v].z;
    }
    const Eigen::VectorXd way = matrix_->factor.solve(right);
    const double slope = -right.dot(way);
    double alpha = 1, moved = 0;
    int halvings = 0;
    for (; halvings <= kReferenceHalvings; ++halvings, alpha /= 2) {
      moved = 0;
      for (std::size_t v = 0; v < count; ++v) {
        const Eigen::Vector3d d = alpha * way.segment<3>(static_cast<Eigen::Index>(3 * v));
        trial[v] = y[v] + Vec3{d.x(), d.y(), d.z()};
        moved = std::max(moved, d.norm());
      }
      const double there = Energy(trial);
      if (there <= energy + kReferenceSufficient * alpha * slope || moved <= settings.tolerance) {
        energy = there;
        break;
      }
    }
    if (halvings > kReferenceHalvings) {  // rounding, or a direction that the floor spoiled
      if (share == 0) break;
      share = 0;
      continue;
    }
    std::copy(trial.begin(), trial.end(), y.begin());
    ++result.iterations;
    result.residual = moved;
    if (moved <= settings.tolerance) break;
    if (halvings == 0)
      share = std::min(kGrowth * std::max(share, kLeastShare), kMostShare);
    else if (halvings >= 2)
      share /= kRetreat;
  }
  result.converged = result.residual <= settings.tolerance && result.iterations > 0;
  return result;
}

}  // namespace percale::fabric
