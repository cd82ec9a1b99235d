#include "collide/untangle.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "collide/contact_meshes.h"
#include "collide/intersections.h"
#include "core/executor.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr int kSide = 12;
constexpr double kSpacing = 0.02, kWidth = (kSide - 1) * kSpacing;

std::vector<Intersection> Judged(const MovingMesh& m, std::span<const Vec3> x) {
  IntersectionJudge judge(m.mesh.vertices(), m.mesh.triangles, m.mesh.clothVertices);
  return judge.Count(x, Executor(1), 1 << 20).first;
}

/// Two sheets that cross along a line that is askew, at x = `at` in its middle, each tilted by `slope` against the
/// plane z = 0. The second is `shift` aside, so that it may cut the first in no two parts.
MovingMesh Crossed(double at, double slope, double shift) {
  MovingMesh m;
  AddSheet(m, kSide, kSpacing, 0.01);
  AddSheet(m, kSide, kSpacing, 0.01);
  for (std::size_t v = 0; v < m.start.size(); ++v) {
    Vec3& x = m.start[v];
    const bool second = m.mesh.body[v] == 1;
    if (second) x += {0.0031, 0.0017 + shift, 0};
    x.z = (second ? -slope : slope) * (x.x - at + 0.1 * (x.y - kWidth / 2));
  }
  return m;
}

}  // namespace

TEST_CASE("of two sheets that cross the smallest part that is not pinned goes back, and is through then") {
  for (const double slope : {0.01, 0.1, 0.8}) {
    for (const double at : {0.3 * kWidth, 0.65 * kWidth}) {
      for (const double shift : {0.0, 0.3 * kWidth}) {
        for (const bool pinned : {false, true}) {
          CAPTURE(slope);
          CAPTURE(at);
          CAPTURE(shift);
          CAPTURE(pinned);
          MovingMesh m = Crossed(at, slope, shift);
          const bool low = at < kWidth / 2;  // where the smaller parts are
          std::vector<std::uint8_t> free(m.start.size(), 1);
          if (pinned) {
            for (std::size_t v = 0; v < free.size(); ++v)
              free[v] = m.mesh.place[v].x == (low ? 0 : (kSide - 1) * kSpacing) ? 0 : 1;
          }
          const std::vector<Intersection> met = Judged(m, m.start);
          REQUIRE(met.size() > 10);
          Untangler untangler(m.mesh);
          untangler.Take(met);
          std::vector<Tangle> tangles;
          untangler.Find(m.start, free, tangles);
          REQUIRE(tangles.size() == met.size());

          // All that is pulled is pulled off one side of the line, and what pulls one sheet up pulls the other down.
          Vec3 up;
          const auto side = [&](const Vec3& x) { return x.x - at + 0.1 * (x.y - kWidth / 2); };
          for (const Tangle& tangle : tangles) {
            const auto v = Index(tangle.vertex);
            CHECK((side(m.start[v]) < 0) == (low != pinned));
            const Vec3 way = ToVec3(tangle.direction);
            CHECK(Length(way) == doctest::Approx(1));
            up += m.mesh.body[v] == 0 ? way : -way;
          }
          CHECK(Length(up) > 0.7 * double(tangles.size()));
          std::vector<Vec3> moved = m.start;
          for (std::size_t v = 0; v < moved.size(); ++v) {
            if (m.mesh.body[v] == 0 && (side(moved[v]) < 0) == (low != pinned)) moved[v] += up * (0.5 / Length(up));
            if (m.mesh.body[v] == 0 && std::abs(side(moved[v])) < 2 * kSpacing) moved[v] += up * (0.1 / Length(up));
          }
          CHECK(Judged(m, moved).empty());
        }
      }
    }
  }
}

TEST_CASE("what is let be is near a curve, on its two sheets, and no neighbour") {
  const MovingMesh m = Crossed(0.4 * kWidth, 0.1, 0);
  Untangler untangler(m.mesh);
  const Triangle& first = m.mesh.triangles[0];
  const VertexQuad far = {kSide * kSide, first.a, first.b, first.c};
  CHECK(!untangler.LetsPass(PairKind::VertexTriangle, far));
  const std::vector<Intersection> met = Judged(m, m.start);
  untangler.Take(met);
  CHECK(!untangler.LetsPass(PairKind::VertexTriangle, far));
  for (const Intersection& one : met) {
    const Triangle& t = m.mesh.triangles[Index(one.triangle)];
    for (const std::int32_t end : one.edge) CHECK(untangler.LetsPass(PairKind::VertexTriangle, {end, t.a, t.b, t.c}));
    CHECK(untangler.LetsPass(PairKind::EdgeEdge, {one.edge[0], one.edge[1], t.a, t.b}));
    // Of the same cloth, and so on the same sheet.
    const std::int32_t other = one.edge[0] < kSide * kSide ? 0 : kSide * kSide;
    CHECK(!untangler.LetsPass(PairKind::EdgeEdge, {one.edge[0], one.edge[1], other, other + 1}));
  }
  untangler.Take({});
  CHECK(!untangler.LetsPass(PairKind::EdgeEdge, {met[0].edge[0], met[0].edge[1], 0, 1}));
}

TEST_CASE("cloth leaves a solid on the side that is nearer, with all of its edges") {
  for (const double height : {-0.03, -0.001, 0.0, 0.04}) {
    CAPTURE(height);
    MovingMesh m;
    AddSheet(m, kSide, kSpacing, 0.01);
    m.AddBody(0.01, true);
    // Four posts of a box whose middle is at z = 0, two of them upside down.
    for (const double x : {0.051, 0.133}) {
      for (const double y : {0.047, 0.139}) {
        const double end = x < y ? 0.1 : -0.1;
        const std::int32_t a = m.AddVertex({x, y, -end}), b = m.AddVertex({x, y, end});
        m.AddEdge(a, b);
      }
    }
    for (std::int32_t v = 0; v < m.mesh.clothVertices; ++v) m.start[Index(v)].z = height + 0.001 * m.start[Index(v)].x;
    std::vector<Intersection> met;
    for (std::int32_t post = 0; post < 4; ++post) {
      const std::int32_t a = m.mesh.clothVertices + 2 * post;
      const Vec3& at = m.start[Index(a)];
      for (std::size_t t = 0; t < m.mesh.triangles.size(); ++t) {
        const auto [p, q, r] = m.mesh.triangles[t];
        const auto in = [&](const Vec3& from, const Vec3& to) {
          return (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x) > 0;
        };
        const Vec3 &u = m.start[Index(p)], &v = m.start[Index(q)], &w = m.start[Index(r)];
        if (in(u, v) && in(v, w) && in(w, u)) met.push_back({{a, a + 1}, static_cast<std::int32_t>(t)});
      }
    }
    REQUIRE(met.size() == 4);
    Untangler untangler(m.mesh);
    untangler.Take(met);
    std::vector<Tangle> tangles;
    const std::vector<std::uint8_t> free(Index(m.mesh.clothVertices), 1);
    untangler.Find(m.start, free, tangles);
    REQUIRE(tangles.size() == 4);
    for (const Tangle& tangle : tangles) {
      // The cloth goes against the edges.
      CHECK(std::abs(tangle.direction.z) == doctest::Approx(1));
      CHECK(tangle.direction.z == doctest::Approx(tangles[0].direction.z));
      if (std::abs(height) > 0.01) CHECK((tangle.direction.z < 0) == (height > 0));
    }
  }
}
