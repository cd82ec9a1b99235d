// Spheres and planes. Included by kernels_impl.h inside the namespace of an instruction set, like
// everything there; never elsewhere.

std::int64_t CollideSphere(const ColliderArgs& a) {
  const Pack3 origin = {All(a.origin[0]), All(a.origin[1]), All(a.origin[2])};
  const Pack radius = All(a.radius), keep = All(1 - a.friction);
  const Pack nearSquared = All(a.radius * a.radius * (1 + 1e-12));  // squares round: rather look twice
  std::int64_t total = 0;
  for (std::int64_t p = a.begin; p < a.end; p += kLanes) {
    const int count = a.end - p < kLanes ? static_cast<int>(a.end - p) : kLanes;
    const Pack3 x = LoadFirst3(a.x, p, count), d = x - origin;
    const Pack squared = SquaredLength(d);
    if (Bits(FirstLanes(count) & (squared <= nearSquared)) == 0) continue;  // colliders touch few points
    const Pack length = Sqrt(squared);
    const Mask inside = FirstLanes(count) & (length <= radius);
    const Pack3 direction =
        Select(length > All(0), {d.x / length, d.y / length, d.z / length}, {All(0), All(1), All(0)});
    const Pack3 previous = LoadFirst3(a.previous, p, count);
    const Pack3 to = previous + (origin + direction * radius - previous) * keep;
    StoreFirst3(a.x, p, Select(inside, to, x), count);
    total += BitCount(Bits(inside));
  }
  return total;
}

/// A point that much above a plane is above it, however its height is rounded [m]: coordinates within bounds, of at
/// most 1e6 m, round by less than 1e-9 m.
constexpr double kSureHeight = 1e-6;
constexpr double kPlaneOffset = 1e-4;  // m above the plane, on the side that a point came from
enum { kInterpolate, kOffset, kHold };

/// Signed distance of points from a plane.
inline Pack Height(const ColliderArgs& a, const Pack3& x) {
  return (x.x - All(a.origin[0])) * All(a.normal[0]) + (x.y - All(a.origin[1])) * All(a.normal[1]) +
         (x.z - All(a.origin[2])) * All(a.normal[2]);
}

/// Height plus `start`, to within rounding, in fewer steps.
inline Pack RoughHeight(const Pack3& normal, const Pack3& x, Pack start) {
  return MaybeFused(x.x, normal.x, MaybeFused(x.y, normal.y, MaybeFused(x.z, normal.z, start)));
}

template <int response>
std::int64_t CollidePlaneBy(const ColliderArgs& a) {
  const Pack3 normal = {All(a.normal[0]), All(a.normal[1]), All(a.normal[2])};
  const Pack keep = All(1 - a.friction);
  double start = -kSureHeight;
  for (int axis = 0; axis < 3; ++axis) start -= a.normal[axis] * a.origin[axis] + kSureHeight * fabs(a.origin[axis]);
  std::int64_t total = 0;
  for (std::int64_t p = a.begin; p < a.end; p += kLanes) {
    const int count = a.end - p < kLanes ? static_cast<int>(a.end - p) : kLanes;
    const Pack3 previous = LoadFirst3(a.previous, p, count), x = LoadFirst3(a.x, p, count);
    const Mask surelyAbove =
        (RoughHeight(normal, previous, All(start)) > All(0)) & (RoughHeight(normal, x, All(start)) > All(0));
    if (Bits(surelyAbove) == (1u << kLanes) - 1) continue;
    const Pack before = Height(a, previous), after = Height(a, x);
    const Mask above = All(0) <= before, stays = All(0) <= after;
    const Mask crossed = FirstLanes(count) & (above ^ stays);
    if (Bits(crossed) == 0) continue;
    total += BitCount(Bits(crossed));
    Pack3 to = previous;  // with kHold
    if constexpr (response != kHold) {
      const Pack offset = Select(above, All(kPlaneOffset), All(-kPlaneOffset));
      const Pack3 target =
          response == kInterpolate ? previous + (x - previous) * (before / (before - after)) : x - normal * after;
      to = previous + (target + normal * offset - previous) * keep;
    }
    StoreFirst3(a.x, p, Select(crossed, to, x), count);
  }
  return total;
}

std::int64_t CollidePlane(const ColliderArgs& a) {
  switch (a.response) {
    case kInterpolate:
      return CollidePlaneBy<kInterpolate>(a);
    case kOffset:
      return CollidePlaneBy<kOffset>(a);
    default:
      return CollidePlaneBy<kHold>(a);
  }
}
