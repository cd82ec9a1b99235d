#include "bench/xpbd_cloth.h"

#include <algorithm>
#include <cmath>

namespace percale::bench {
namespace {

using fabric::DeformationGradient;
using fabric::FabricHinge;

Vector3<double> At(std::span<const Vec3> x, std::int32_t v) {
  return From<double>(x[static_cast<std::size_t>(v)]);
}

/// The inverse of a symmetric matrix.
Matrix3<double> Inverse(const Matrix3<double>& a) {
  const Vector3<double> r0{a.m[0], a.m[1], a.m[2]}, r1{a.m[3], a.m[4], a.m[5]}, r2{a.m[6], a.m[7], a.m[8]};
  const Vector3<double> c0 = Cross(r1, r2), c1 = Cross(r2, r0), c2 = Cross(r0, r1);
  const double d = 1 / Dot(r0, c0);
  return {{c0.x * d, c1.x * d, c2.x * d, c0.y * d, c1.y * d, c2.y * d, c0.z * d, c1.z * d, c2.z * d}};
}

}  // namespace

XpbdCloth::XpbdCloth(const fabric::FabricModel& model, std::span<const std::uint8_t> free)
    : model_(model), position_(model.start), previous_(model.start), velocity_(model.start.size()) {
  for (std::size_t v = 0; v < free.size(); ++v) inverseMass_.push_back(free[v] ? 1 / model.mass[v] : 0);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& law = model.membranes[model.ClothOf(static_cast<std::int64_t>(t))].orthotropic;
    Matrix3<double> stiffness{{law.c11, law.c12, 0, law.c12, law.c22, 0, 0, 0, law.c33}};
    rest_.push_back(model.Rest(t));
    compliance_.push_back(Inverse(stiffness * rest_[t].area));
  }
  hingeStiffness_.assign(model.hinges.size(), 0);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t h = model.hingeOf[t][k];
      if (h >= 0) hingeStiffness_[static_cast<std::size_t>(h)] += model.bending[t].diagonal[k];
    }
  }
}

void XpbdCloth::Frame(double seconds, int substeps, const Vec3& gravity) {
  const double h = seconds / substeps, perStep = 1 / (h * h);
  for (int step = 0; step < substeps; ++step) {
    previous_ = position_;
    for (std::size_t v = 0; v < position_.size(); ++v) {
      if (inverseMass_[v] == 0) continue;
      velocity_[v] += gravity * h;
      position_[v] += velocity_[v] * h;
    }
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) SolveTriangle(t, perStep);
    for (std::size_t k = 0; k < model_.hinges.size(); ++k) SolveHinge(k, perStep);
    for (std::size_t v = 0; v < position_.size(); ++v) velocity_[v] = (position_[v] - previous_[v]) / h;
  }
}

/// The three strains of a triangle at once: (J M^-1 J' + compliance / h^2) lambda = -strain.
void XpbdCloth::SolveTriangle(std::size_t t, double perStep) {
  const Triangle& tri = model_.triangles[t];
  const std::int32_t v[3] = {tri.a, tri.b, tri.c};
  const auto& rest = rest_[t];
  const DeformationGradient<double> f =
      Deformation(rest, At(position_, tri.a), At(position_, tri.b), At(position_, tri.c));
  const fabric::MembraneStrain<double> strain = GreenStrain(f);
  const fabric::CornerWeights<double> w = WeightsOfCorners(rest);
  Vector3<double> gradient[3][3];  // of each strain by each corner
  Matrix3<double> system = compliance_[t] * perStep;
  for (int k = 0; k < 3; ++k) {
    gradient[0][k] = f.u * w.u[k];
    gradient[1][k] = f.v * w.v[k];
    gradient[2][k] = f.u * w.v[k] + f.v * w.u[k];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        system(i, j) += inverseMass_[static_cast<std::size_t>(v[k])] * Dot(gradient[i][k], gradient[j][k]);
      }
    }
  }
  const Vector3<double> lambda = Inverse(system) * -Vector3<double>{strain.e11, strain.e22, strain.shear};
  for (int k = 0; k < 3; ++k) {
    const Vector3<double> way = gradient[0][k] * lambda.x + gradient[1][k] * lambda.y + gradient[2][k] * lambda.z;
    position_[static_cast<std::size_t>(v[k])] += ToVec3(way * inverseMass_[static_cast<std::size_t>(v[k])]);
  }
}

/// The jump of slope across an edge, a vector that is linear in the positions.
void XpbdCloth::SolveHinge(std::size_t h, double perStep) {
  if (hingeStiffness_[h] == 0) return;
  const FabricHinge& hinge = model_.hinges[h];
  Vector3<double> jump;
  double mobility = perStep / hingeStiffness_[h];
  for (int k = 0; k < 4; ++k) {
    const double c = hinge.weights.vertex[k];
    jump += At(position_, hinge.vertex[k]) * c;
    mobility += c * c * inverseMass_[static_cast<std::size_t>(hinge.vertex[k])];
  }
  const Vector3<double> lambda = jump * (-1 / mobility);
  for (int k = 0; k < 4; ++k) {
    const auto v = static_cast<std::size_t>(hinge.vertex[k]);
    position_[v] += ToVec3(lambda * (hinge.weights.vertex[k] * inverseMass_[v]));
  }
}

double Stretch99(const fabric::FabricModel& model, std::span<const Vec3> positions) {
  std::vector<double> stretch;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const Triangle& tri = model.triangles[t];
    const DeformationGradient<double> f =
        Deformation(model.Rest(t), At(positions, tri.a), At(positions, tri.b), At(positions, tri.c));
    const double uu = Dot(f.u, f.u), vv = Dot(f.v, f.v), uv = Dot(f.u, f.v);
    stretch.push_back(std::sqrt(0.5 * (uu + vv) + std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv)));
  }
  const auto at = stretch.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(stretch.size()));
  std::nth_element(stretch.begin(), at, stretch.end());
  return *at;
}

}  // namespace percale::bench
