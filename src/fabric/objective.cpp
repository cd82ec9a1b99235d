#include "fabric/objective.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "fabric/energy/air.h"
#include "fabric/energy/attachment.h"

namespace percale::fabric {
namespace {

/// Share of a plate's buckling stress on its own inertia, 2 sqrt(D rho) / h, down to which compression enters the
/// second derivative: so far wrinkles may form within one Newton step. See docs/solver.md.
constexpr double kCompressionShare = 1;

Vector3<double> At(std::span<const Vec3> y, std::int32_t v) {
  return From<double>(y[Index(v)]);
}

}  // namespace

Objective::Objective(const FabricModel& model, const BlockPattern& pattern, const Executor& executor,
                     const Kernels& kernels)
    : model_(model),
      pattern_(pattern),
      executor_(executor),
      kernels_(kernels),
      parts_(FindBlockParts(pattern, model.triangles, model.corners)),
      window_(model) {
  const std::size_t triangles = model.triangles.size();
  for (int c = 0; c < model.Cloths(); ++c) {
    const int end = model.firstTriangle[Index(c) + 1];
    for (int t = model.firstTriangle[Index(c)]; t < end; t += kRowsPerChunk) {
      batches_.push_back({c, t, std::min(t + kRowsPerChunk, end)});
    }
  }
  batchStretch_.resize(batches_.size());
  const std::size_t live = std::min(triangles, Index(window_.live()));
  triangleGradient_.resize(3 * live);
  triangleHessian_.assign(kHessianReals * live + 1, 0);
  scratch_.Fit(Index(model.vertexCount));
  const auto items = std::max(static_cast<std::size_t>(model.vertexCount), triangles);
  chunkSums_.resize(std::max(batches_.size(), items / kRowsPerChunk + 1));
  TakeMaterials();
}

void Objective::TakeMaterials() {
  const bool damped = std::any_of(model_.membranes.begin(), model_.membranes.end(),
                                  [](const Membrane& membrane) { return membrane.damping > 0; });
  for (std::vector<double>& padded : startStrain_) padded.resize(damped ? model_.triangles.size() + kTrianglePad : 0);
  const std::size_t hinges = model_.anyHinges ? model_.hinges.size() : 0;
  for (std::vector<double>* perHinge : {&startAngle_, &angle_, &moment_}) perHinge->resize(hinges);
  hinge_.resize(hinges);
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
  executor_.ForChunks(static_cast<int>(batches_.size()), [&](int batch) {
    const MembraneArgs arguments = Arguments(step.start, batches_[Index(batch)]);
    if (arguments.damping != 0) kernels_.membraneStrain(arguments);
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
      const Vec3 off = y[Index(v)] - step_.Predicted(Index(v));
      double cost = 0.5 * model_.mass[Index(v)] * perStep * Dot(off, off);
      if (!step_.loads.empty()) {
        const VertexLoad& load = step_.loads[Index(v)];
        const Vec3 way = y[Index(v)] - step_.start[Index(v)];
        const Vector3<double> w = From<double>(way);
        cost = cost + 0.5 * Dot(w, load.stiffness * w) - Dot(load.force, way);
      }
      sum += cost;
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
  for (const FabricTether& tether : model_.tethers) energy += Pull(tether, y).energy;
  if (contacts_) energy += contacts_->Energy(y);
  return energy;
}

/// What a rope costs and does to its vertex; nothing where that is a pin.
PointEnergy<double> Objective::Pull(const FabricTether& tether, std::span<const Vec3> y) const {
  if (!step_.free[Index(tether.vertex)]) return {};
  return TetherEnergy(tether.stiffness, From<double>(tether.anchor), tether.length, At(y, tether.vertex));
}

double Objective::ElasticEnergy(std::span<const Vec3> y) {
  const double h = std::exchange(step_.h, 0);  // without a step there is no damping
  const double energy = MembraneEnergy(y) + BendingEnergy(y);
  step_.h = h;
  return energy;
}

MembraneArgs Objective::Arguments(std::span<const Vec3> y, const Batch& of) {
  const Membrane& membrane = model_.membranes[Index(of.cloth)];
  const double perStep = step_.h > 0 ? 1 / step_.h : 0;
  return {.begin = of.begin,
          .end = of.end,
          .triangles = model_.triangles.data(),
          .x = y.data(),
          .chartTriangles = model_.ChartTriangles().data(),
          .chart = model_.chart.data(),
          .strength = model_.strength.empty() ? nullptr : model_.strength.data(),
          .law = membrane.kind,
          .orthotropic = membrane.orthotropic,
          .neoHookean = membrane.neoHookean,
          .damping = membrane.damping * perStep,
          .startStrain = {startStrain_[0].data(), startStrain_[1].data(), startStrain_[2].data()},
          .mass = model_.mass.data(),
          .bendStiffness = membrane.bendStiffness,
          .stiffening = model_.stiffening.empty() ? nullptr : model_.stiffening.data(),
          .compression = kCompressionShare * perStep,
          .outFirst = of.begin,
          .gradient = triangleGradient_.data() + 3 * Index(window_.Place(of.begin)),
          .hessian = triangleHessian_.data() + kHessianReals * Index(window_.Place(of.begin))};
}

double Objective::MembraneEnergy(std::span<const Vec3> y) {
  const int batches = static_cast<int>(batches_.size());
  executor_.ForChunks(batches, [&](int batch) {
    chunkSums_[Index(batch)] = kernels_.membraneEnergy(Arguments(y, batches_[Index(batch)]));
  });
  double sum = 0;
  for (int batch = 0; batch < batches; ++batch) sum += chunkSums_[Index(batch)];
  return sum;
}

MembraneStretch Objective::GreatestStretch(std::span<const Vec3> y) {
  executor_.ForChunks(static_cast<int>(batches_.size()), [&](int batch) {
    batchStretch_[Index(batch)] = kernels_.membraneStretch(Arguments(y, batches_[Index(batch)]));
  });
  MembraneStretch greatest;
  for (const MembraneStretch& stretch : batchStretch_) {
    if (stretch.square > greatest.square) greatest = stretch;
  }
  return greatest;
}

double Objective::BendingEnergy(std::span<const Vec3> y) {
  const double energy = PlateEnergy(y);
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

/// Also what pulls at each vertex: its row of the plates' matrix times the positions. Rows sum to zero, so positions
/// may count from the vertex itself, and the energy is -½ sum over pairs of q |yi - yj|²: only short ways cancel, and
/// small bends count far from the origin.
double Objective::PlateEnergy(std::span<const Vec3> y) {
  return -0.25 * Sum(model_.vertexCount, [&](int begin, int end) {
    return kernels_.plateForces({.begin = begin,
                                 .end = end,
                                 .rows = model_.plates.View(),
                                 .isPlate = model_.plate.data(),
                                 .x = y.data(),
                                 .force = scratch_.first.data()});
  });
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
  const double time = model_.bendDamping[model_.ClothOf(t)];
  EdgeAngles<double> angle, rest;
  BendingDamping<double> damping;
  damping.rate = step_.h > 0 ? time / step_.h : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t h = model_.hingeOf[Index(t)][k];
    if (h < 0) continue;
    angle.edge[k] = angle_[Index(h)];
    rest.edge[k] = folds_.empty() ? model_.hinges[Index(h)].restAngle : folds_[Index(h)].rest;
    damping.start.edge[k] = startAngle_[Index(h)];
  }
  return Moments(model_.bending[Index(t)], angle, rest, damping);
}

/// Of some triangles, whatever cloths they are of.
void Objective::EvaluateTriangles(std::span<const Vec3> y, bool withTangent, int begin, int end) {
  while (begin < end) {
    const auto cloth = static_cast<std::int32_t>(model_.ClothOf(begin));
    const Batch batch{cloth, begin, std::min(end, model_.firstTriangle[Index(cloth) + 1])};
    const MembraneArgs arguments = Arguments(y, batch);
    (withTangent ? kernels_.membraneTangent : kernels_.membraneGradient)(arguments);
    AddPressure(y, arguments, model_.pressure[Index(cloth)]);
    begin = batch.end;
  }
}

void Objective::AddPressure(std::span<const Vec3> y, const MembraneArgs& to, double pressure) {
  if (pressure == 0) return;
  Vec3* gradient = to.gradient;
  for (int t = to.begin; t < to.end; ++t) {
    const Triangle& tri = model_.triangles[Index(t)];
    const EnclosedVolume<double> volume = Volume(At(y, tri.a), At(y, tri.b), At(y, tri.c));
    for (int k = 0; k < 3; ++k) *gradient++ -= ToVec3(volume.gradient[k] * pressure);
  }
}

void Objective::Gradient(std::span<const Vec3> y, std::span<Vec3> gradient) {
  PlateEnergy(y);
  SumMoments(y);
  window_.ForRows(
      executor_, [&](int begin, int end) { EvaluateTriangles(y, false, begin, end); },
      [&](int begin, int end, const LiveTriangles& live) { Gather(y, gradient, begin, end, live); });
  AddTethers(y, gradient);
  if (contacts_) contacts_->AddGradient(y, gradient);
}

double Objective::GradientAndTangent(std::span<const Vec3> y, std::span<Vec3> gradient, SystemMatrix& matrix) {
  const auto addToDiagonal = [&](int v, const Matrix3<double>& stiffness) {
    Real* block = matrix.DiagonalBlock(v);
    for (int k = 0; k < 9; ++k) block[k] += static_cast<Real>(stiffness.m[k]);  // symmetric
  };
  SumMoments(y);
  const auto assemble = [&](int begin, int end, const LiveTriangles& live) {
    Gather(y, gradient, begin, end, live);
    kernels_.assemble({.begin = begin,
                       .end = end,
                       .columns = pattern_.columns.View(),
                       .storedFirst = pattern_.storedFirst.data(),
                       .diagonal = matrix.diagonal().data(),
                       .constant = matrix.constant().View(),
                       .cornerFirst = model_.corners.first.data(),
                       .corner = model_.corners.entry.data(),
                       .parts = parts_.narrow(),
                       .wideParts = parts_.wide(),
                       .cornersBegin = 3 * live.begin,
                       .corners = 3 * live.count,
                       .hessian = triangleHessian_.data(),
                       .blocks = matrix.Block(0)});
    for (int v = begin; v < end && !step_.loads.empty(); ++v) addToDiagonal(v, step_.loads[Index(v)].stiffness.Full());
  };
  window_.ForRows(
      executor_, [&](int begin, int end) { EvaluateTriangles(y, true, begin, end); }, assemble);
  AddTethers(y, gradient);
  for (const FabricTether& tether : model_.tethers) addToDiagonal(tether.vertex, Pull(tether, y).hessian);
  double change = 0;
  if (contacts_) {
    const double before = contacts_->Energy(y);
    change = contacts_->Update(y, matrix) - before;
    matrix.SetExtra(contacts_->Terms(), executor_);
    contacts_->AddGradient(y, gradient);
  }
  matrix.Finish(executor_);
  return change;
}

/// The moments on all hinges.
void Objective::SumMoments(std::span<const Vec3> y) {
  if (!model_.anyHinges) return;
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

/// What all terms but tethers and contacts come to at some vertices.
void Objective::Gather(std::span<const Vec3> y, std::span<Vec3> gradient, int begin, int end,
                       const LiveTriangles& live) {
  const double perStep = 1 / (step_.h * step_.h);
  for (int v = begin; v < end; ++v) {
    if (!step_.free[Index(v)]) {
      gradient[Index(v)] = {};
      continue;
    }
    const Vec3 off = y[Index(v)] - step_.Predicted(Index(v));
    Vec3 sum = off * (model_.mass[Index(v)] * perStep);
    if (!step_.loads.empty()) {
      const VertexLoad& load = step_.loads[Index(v)];
      sum -= load.force;
      sum += ToVec3(load.stiffness * From<double>(y[Index(v)] - step_.start[Index(v)]));
    }
    for (std::int32_t e = model_.corners.first[Index(v)]; e < model_.corners.first[Index(v) + 1]; ++e) {
      sum += triangleGradient_[Index(live.Place(model_.corners.entry[Index(e)]))];
    }
    if (model_.plate[Index(v)]) {
      sum += scratch_.first[Index(v)];
    } else {
      for (std::int32_t e = model_.hingeEnds.first[Index(v)]; e < model_.hingeEnds.first[Index(v) + 1]; ++e) {
        const std::int32_t place = model_.hingeEnds.entry[Index(e)];
        sum += ToVec3(hinge_[Index(place / 4)].gradient[place % 4] * moment_[Index(place / 4)]);
      }
    }
    gradient[Index(v)] = sum;
  }
}

void Objective::AddTethers(std::span<const Vec3> y, std::span<Vec3> gradient) const {
  for (const FabricTether& tether : model_.tethers) gradient[Index(tether.vertex)] += ToVec3(Pull(tether, y).gradient);
}

}  // namespace percale::fabric
