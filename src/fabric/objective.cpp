#include "fabric/objective.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percale::fabric {
namespace {

/// Share of a plate's buckling stress on its own inertia, 2 sqrt(D rho) / h, down to which compression enters the
/// second derivative: so far wrinkles may form within one Newton step. See docs/solver.md.
constexpr double kCompressionShare = 1;

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

Vector3<double> At(std::span<const Vec3> y, std::int32_t v) {
  return From<double>(y[Index(v)]);
}

}  // namespace

Objective::Objective(const FabricModel& model, const BlockPattern& pattern, const Executor& executor)
    : model_(model), executor_(executor), blocks_(TriangleBlocks(pattern, model.triangles)) {
  startStrain_.resize(model.triangles.size());
  triangleGradient_.resize(model.triangles.size());
  triangleHessian_.resize(model.triangles.size());
  startAngle_.resize(model.hinges.size());
  angle_.resize(model.hinges.size());
  moment_.resize(model.hinges.size());
  hinge_.resize(model.hinges.size());
  const auto items =
      std::max({static_cast<std::size_t>(model.vertexCount), model.triangles.size(), model.hinges.size()});
  chunkSums_.resize(items / kRowsPerChunk + 1);
}

/// Sums body(begin, end) over chunks of 0..count-1, in order.
template <class Body>
double Objective::Sum(int count, Body&& body) {
  const int chunks = Chunks(count, kRowsPerChunk);
  executor_.ForChunks(chunks, [&](int chunk) {
    const int begin = chunk * kRowsPerChunk;
    chunkSums_[Index(chunk)] = body(begin, std::min(begin + kRowsPerChunk, count));
  });
  double sum = 0;
  for (int chunk = 0; chunk < chunks; ++chunk) sum += chunkSums_[Index(chunk)];
  return sum;
}

void Objective::Begin(const StepSettings& step) {
  step_ = step;
  ForRange(executor_, model_.triangles.size(), [&](int t) {
    if (model_.membranes[Index(model_.clothOf[Index(t)])].damping == 0) return;
    const Triangle& tri = model_.triangles[Index(t)];
    startStrain_[Index(t)] = GreenStrain(
        Deformation(model_.rest[Index(t)], At(step.start, tri.a), At(step.start, tri.b), At(step.start, tri.c)));
  });
  if (model_.anyHinges) {
    EvaluateHinges(step.start, false);
    startAngle_ = angle_;
  }
}

double Objective::Energy(std::span<const Vec3> y) {
  const double perStep = 1 / (step_.h * step_.h);
  double energy = Sum(model_.vertexCount, [&](int begin, int end) {
    double sum = 0;
    for (int v = begin; v < end; ++v) {
      if (!step_.free[Index(v)]) continue;
      const Vec3 off = y[Index(v)] - step_.predicted[Index(v)], way = y[Index(v)] - step_.start[Index(v)];
      const VertexLoad& load = step_.loads[Index(v)];
      const Vector3<double> w = From<double>(way);
      sum += 0.5 * model_.mass[Index(v)] * perStep * Dot(off, off) + 0.5 * Dot(w, load.stiffness * w) -
             Dot(load.force, way);
    }
    return sum;
  });
  energy += MembraneEnergy(y) + BendingEnergy(y);
  for (int c = 0; c < model_.Cloths(); ++c) {
    if (model_.pressure[Index(c)] == 0) continue;
    double volume = 0;
    for (int t = model_.firstTriangle[Index(c)]; t < model_.firstTriangle[Index(c) + 1]; ++t) {
      const Triangle& tri = model_.triangles[Index(t)];
      volume += Dot(y[Index(tri.a)], Cross(y[Index(tri.b)], y[Index(tri.c)])) / 6;
    }
    energy -= model_.pressure[Index(c)] * volume;
  }
  return energy;
}

double Objective::ElasticEnergy(std::span<const Vec3> y) {
  const double h = std::exchange(step_.h, 0);  // without a step there is no damping
  const double energy = MembraneEnergy(y) + BendingEnergy(y);
  step_.h = h;
  return energy;
}

double Objective::MembraneEnergy(std::span<const Vec3> y) {
  return Sum(static_cast<int>(model_.triangles.size()), [&](int begin, int end) {
    double sum = 0;
    for (int t = begin; t < end; ++t) {
      const Triangle& tri = model_.triangles[Index(t)];
      const RestTriangle<double>& rest = model_.rest[Index(t)];
      const Membrane& membrane = model_.membranes[Index(model_.clothOf[Index(t)])];
      const DeformationGradient<double> f = Deformation(rest, At(y, tri.a), At(y, tri.b), At(y, tri.c));
      const double density = membrane.kind == MembraneLaw::NeoHookean
                                 ? Stress(membrane.neoHookean, f).energy
                                 : Stress(membrane.orthotropic, f, Damping(t)).energy;
      sum += rest.area * density;
    }
    return sum;
  });
}

MembraneDamping<double> Objective::Damping(int t) const {
  const double time = model_.membranes[Index(model_.clothOf[Index(t)])].damping;
  if (time == 0 || step_.h == 0) return {};
  return {time / step_.h, startStrain_[Index(t)]};
}

double Objective::BendingEnergy(std::span<const Vec3> y) {
  double energy = 0.5 * Sum(model_.vertexCount, [&](int begin, int end) {
                    double sum = 0;
                    for (int v = begin; v < end; ++v) {
                      if (model_.plate[Index(v)]) sum += Dot(y[Index(v)], PlateForce(y, v));
                    }
                    return sum;
                  });
  if (!model_.anyHinges) return energy;
  EvaluateHinges(y, false);
  return energy + Sum(static_cast<int>(model_.triangles.size()), [&](int begin, int end) {
           double sum = 0;
           for (int t = begin; t < end; ++t) {
             if (model_.plate[Index(model_.triangles[Index(t)].a)]) continue;
             sum += Bend(t).energy;
           }
           return sum;
         });
}

/// Row v of the plates' matrix times the positions [N].
Vec3 Objective::PlateForce(std::span<const Vec3> y, int v) const {
  const ScalarMatrix& q = model_.plates;
  Vec3 force;
  for (std::int32_t k = q.first[Index(v)]; k < q.first[Index(v) + 1]; ++k) {
    force += q.value[Index(k)] * y[Index(q.column[Index(k)])];
  }
  return force;
}

/// The angles of all hinges, and how they change with the positions.
void Objective::EvaluateHinges(std::span<const Vec3> y, bool withGradient) {
  ForRange(executor_, model_.hinges.size(), [&](int h) {
    const FabricHinge& hinge = model_.hinges[Index(h)];
    const Vector3<double> x[4] = {At(y, hinge.vertex[0]), At(y, hinge.vertex[1]), At(y, hinge.vertex[2]),
                                  At(y, hinge.vertex[3])};
    if (withGradient) {
      hinge_[Index(h)] = HingeGradient(x[0], x[1], x[2], x[3]);
      angle_[Index(h)] = hinge_[Index(h)].angle;
    } else {
      angle_[Index(h)] = HingeAngle(x[0], x[1], x[2], x[3]);
    }
  });
}

/// What bending a triangle costs, and the moments on its hinges.
BendingMoments<double> Objective::Bend(int t) const {
  const double time = model_.bendDamping[Index(model_.clothOf[Index(t)])];
  EdgeAngles<double> angle, rest;
  BendingDamping<double> damping;
  damping.rate = step_.h > 0 ? time / step_.h : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t h = model_.hingeOf[Index(t)][k];
    if (h < 0) continue;
    angle.edge[k] = angle_[Index(h)];
    rest.edge[k] = model_.hinges[Index(h)].restAngle;
    damping.start.edge[k] = startAngle_[Index(h)];
  }
  return Moments(model_.bending[Index(t)], angle, rest, damping);
}

/// Compression that a second derivative may keep, for wrinkles to form [N/m].
double Objective::CompressionFloor(int t) const {
  const RestTriangle<double>& rest = model_.rest[Index(t)];
  const Triangle& tri = model_.triangles[Index(t)];
  const double density =
      (model_.mass[Index(tri.a)] + model_.mass[Index(tri.b)] + model_.mass[Index(tri.c)]) / (6 * rest.area);
  return kCompressionShare * 2 * std::sqrt(model_.plateStiffness[Index(model_.clothOf[Index(t)])] * density) / step_.h;
}

template <bool withTangent>
void Objective::EvaluateTriangles(std::span<const Vec3> y) {
  ForRange(executor_, model_.triangles.size(), [&](int t) {
    const Triangle& tri = model_.triangles[Index(t)];
    const RestTriangle<double>& rest = model_.rest[Index(t)];
    const Membrane& membrane = model_.membranes[Index(model_.clothOf[Index(t)])];
    const DeformationGradient<double> f = Deformation(rest, At(y, tri.a), At(y, tri.b), At(y, tri.c));
    const auto evaluate = [&](const auto& law, const auto&... damping) {
      triangleGradient_[Index(t)] = CornerGradient(rest, Stress(law, f, damping...));
      if constexpr (withTangent) {
        triangleHessian_[Index(t)] = CornerHessian(rest, Tangent(law, f, CompressionFloor(t), damping...));
      }
    };
    if (membrane.kind == MembraneLaw::NeoHookean)
      evaluate(membrane.neoHookean);
    else
      evaluate(membrane.orthotropic, Damping(t));
  });
}

void Objective::Gradient(std::span<const Vec3> y, std::span<Vec3> gradient) {
  EvaluateTriangles<false>(y);
  Gather(y, gradient);
}

void Objective::GradientAndTangent(std::span<const Vec3> y, std::span<Vec3> gradient, SystemMatrix& matrix) {
  EvaluateTriangles<true>(y);
  Gather(y, gradient);
  matrix.Reset(executor_);
  ForRange(executor_, Index(model_.vertexCount), [&](int v) {
    const auto add = [](Real* block, const Matrix3<double>& m, bool transposed) {
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) block[3 * c + r] += static_cast<Real>(transposed ? m(c, r) : m(r, c));
      }
    };
    for (std::int32_t e = model_.corners.first[Index(v)]; e < model_.corners.first[Index(v) + 1]; ++e) {
      const std::int32_t corner = model_.corners.entry[Index(e)], t = corner / 3, k = corner % 3;
      const TriangleHessian<double>& hessian = triangleHessian_[Index(t)];
      const std::array<std::int32_t, 9>& at = blocks_[Index(t)];
      const std::int32_t next = (k + 1) % 3, previous = (k + 2) % 3;
      add(matrix.Block(at[Index(3 * k + k)]), hessian.diagonal[k], false);
      add(matrix.Block(at[Index(3 * k + next)]), hessian.next[k], false);
      add(matrix.Block(at[Index(3 * k + previous)]), hessian.next[previous], true);
      if (e == model_.corners.first[Index(v)])
        add(matrix.Block(at[Index(3 * k + k)]), step_.loads[Index(v)].stiffness, false);
    }
  });
  matrix.Finish(executor_);
}

/// What all terms come to at each vertex.
void Objective::Gather(std::span<const Vec3> y, std::span<Vec3> gradient) {
  if (model_.anyHinges) {
    EvaluateHinges(y, true);
    ForRange(executor_, model_.hinges.size(), [&](int h) {
      double moment = 0;
      for (const std::int32_t t : model_.hinges[Index(h)].triangle) {
        const std::array<std::int32_t, 3>& hinges = model_.hingeOf[Index(t)];
        const std::size_t k = hinges[0] == h ? 0 : hinges[1] == h ? 1 : 2;
        moment += Bend(t).moment.edge[k];
      }
      moment_[Index(h)] = moment;
    });
  }
  const double perStep = 1 / (step_.h * step_.h);
  ForRange(executor_, Index(model_.vertexCount), [&](int v) {
    if (!step_.free[Index(v)]) {
      gradient[Index(v)] = {};
      return;
    }
    const Vec3 off = y[Index(v)] - step_.predicted[Index(v)];
    const VertexLoad& load = step_.loads[Index(v)];
    Vec3 sum = off * (model_.mass[Index(v)] * perStep) - load.force +
               ToVec3(load.stiffness * From<double>(y[Index(v)] - step_.start[Index(v)]));
    for (std::int32_t e = model_.corners.first[Index(v)]; e < model_.corners.first[Index(v) + 1]; ++e) {
      const std::int32_t corner = model_.corners.entry[Index(e)], t = corner / 3;
      sum += ToVec3(triangleGradient_[Index(t)].corner[corner % 3]);
      const double pressure = model_.pressure[Index(model_.clothOf[Index(t)])];
      if (pressure == 0) continue;
      const Triangle& tri = model_.triangles[Index(t)];
      const std::int32_t at[3] = {tri.a, tri.b, tri.c};
      sum -= Cross(y[Index(at[(corner + 1) % 3])], y[Index(at[(corner + 2) % 3])]) * (pressure / 6);
    }
    if (model_.plate[Index(v)]) {
      sum += PlateForce(y, v);
    } else {
      for (std::int32_t e = model_.hingeEnds.first[Index(v)]; e < model_.hingeEnds.first[Index(v) + 1]; ++e) {
        const std::int32_t end = model_.hingeEnds.entry[Index(e)];
        sum += ToVec3(hinge_[Index(end / 4)].gradient[end % 4] * moment_[Index(end / 4)]);
      }
    }
    gradient[Index(v)] = sum;
  });
}

}  // namespace percale::fabric
