#pragma once
// What the tests of the inner loops share: arrays with the padding that kernels.h asks for, and comparisons.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "mesh/cloth_model.h"
#include "springs/kernels.h"

namespace percale::test {

inline std::size_t At(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// One array per axis, with room before and behind for what the kernels read there, the axes one behind the other.
struct Axes {
  Axes(int numWidth, int count)
      : front(springs::GridPadding(numWidth)), size(count), stride(front + count + springs::kGridPad) {
    store.assign(At(3 * stride), 0);
  }
  double* axis(int a) { return store.data() + a * stride + front; }
  const double* axis(int a) const { return store.data() + a * stride + front; }
  double& operator()(int a, std::int64_t point) { return axis(a)[point]; }
  double operator()(int a, std::int64_t point) const { return axis(a)[point]; }

  int front, size, stride;
  std::vector<double> store;
};

/// Whether two numbers are the same; all that are none count as the same, and so do the zeros.
inline bool Same(double a, double b) {
  return a == b || (a != a && b != b);
}
/// The same to the last bit, the signs of zeros too.
inline bool SameBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b);
}

/// The first point of begin <= p < end in which two sets of positions differ, or nothing.
template <class Equal>
std::string Difference(const Axes& a, const Axes& b, std::int64_t begin, std::int64_t end, Equal equal) {
  for (std::int64_t p = begin; p < end; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      if (equal(a(axis, p), b(axis, p))) continue;
      char text[96];
      std::snprintf(text, sizeof text, "point %d, axis %d: %a and %a", static_cast<int>(p), axis, a(axis, p),
                    b(axis, p));
      return text;
    }
  }
  return "";
}

/// Whether a point creates a spring of a kind.
inline bool Creates(int numWidth, std::int64_t point, int kind) {
  const auto [di, dj] = kSpringSteps[kind];
  const auto i = static_cast<int>(point % numWidth);
  return i + di >= 0 && i + di < numWidth && point / numWidth + dj >= 0;
}
/// From the creator of a spring to its other end.
inline std::int64_t Step(int numWidth, int kind) {
  return std::int64_t{kSpringSteps[kind].dj} * numWidth + kSpringSteps[kind].di;
}

/// Rest lengths, one array per kind, with room before and behind, the kinds one behind the other.
struct RestLengths {
  explicit RestLengths(int count)
      : stride(2 * springs::kGridPad + count), store(At(kSpringKinds * stride), springs::kNoSpringRest) {}
  double* operator[](int kind) { return store.data() + kind * stride + springs::kGridPad; }
  const double* operator[](int kind) const { return store.data() + kind * stride + springs::kGridPad; }

  int stride;
  std::vector<double> store;
};

}  // namespace percale::test
