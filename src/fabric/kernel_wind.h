// The load of the wind, kLanes triangles at a time. Included by kernels_impl.h inside the namespace of an instruction
// set; never elsewhere.

[[gnu::flatten]] void WindLoads(const WindArgs& a) {
  const Air<Doubles> air{Doubles(a.air.density), Doubles(a.air.normal), Doubles(a.air.tangential), Doubles(a.air.lift)};
  const Vector3<Doubles> wind{Doubles(a.wind.x), Doubles(a.wind.y), Doubles(a.wind.z)};
  const Doubles third(1.0 / 3), perStep(1 / (3 * a.h));
  ForTriangles(a.begin, a.end, [&](int first, int count) {
    const Edges edges = LoadEdges(a.triangles, a.x, first, count);
    double ways[3][kLanes];  // of the three corners together
    for (int i = 0; i < kLanes; ++i) {
      const Triangle& t = a.triangles[first + (i < count ? i : count - 1)];
      const Vec3 &x0 = a.x[t.a], &x1 = a.x[t.b], &x2 = a.x[t.c];
      const Vec3 &p0 = a.previous[t.a], &p1 = a.previous[t.b], &p2 = a.previous[t.c];
      ways[0][i] = (x0.x - p0.x) + (x1.x - p1.x) + (x2.x - p2.x);
      ways[1][i] = (x0.y - p0.y) + (x1.y - p1.y) + (x2.y - p2.y);
      ways[2][i] = (x0.z - p0.z) + (x1.z - p1.z) + (x2.z - p2.z);
    }
    const Vector3<Doubles> way{Doubles::Load(ways[0]), Doubles::Load(ways[1]), Doubles::Load(ways[2])};
    const WindLoad<Doubles> load =
        MakeWindLoad(air, wind, Vector3<Doubles>{}, edges.first, edges.second, way * perStep);
    const Matrix3<Doubles> stiffness = load.drag * perStep;
    const Vector3<Doubles> force = (load.drag * load.wind + load.lift) * third;
    double lanes[9][kLanes];
    for (int k = 0; k < 3; ++k) stiffness.m[4 * k].Store(lanes[k]);
    stiffness.m[1].Store(lanes[3]), stiffness.m[2].Store(lanes[4]), stiffness.m[5].Store(lanes[5]);
    force.x.Store(lanes[6]), force.y.Store(lanes[7]), force.z.Store(lanes[8]);
    for (int i = 0; i < count; ++i) {
      VertexLoad& to = a.load[first + i - a.outFirst];
      to.stiffness.xx = lanes[0][i], to.stiffness.yy = lanes[1][i], to.stiffness.zz = lanes[2][i];
      to.stiffness.xy = lanes[3][i], to.stiffness.xz = lanes[4][i], to.stiffness.yz = lanes[5][i];
      to.force.x = lanes[6][i], to.force.y = lanes[7][i], to.force.z = lanes[8][i];
    }
  });
}
