#pragma once
/// \file
/// Some numbers side by side that compute as one, to stand for T in what is written for any kind of number: see
/// math/vector3.h. The compilers' own vectors, so any processor runs them; wide registers make them fast.

#include <cmath>
#include <cstring>

namespace percale {

/// How many doubles kernels compute with at a time: as many as the widest registers hold that this source file is
/// compiled for, but at least 4. Another file may have another number, hence not `inline`.
#if defined(__AVX512F__)
constexpr int kDoubleLanes = 8;
#else
constexpr int kDoubleLanes = 4;
#endif

/// `Level`: a type of the one source file that computes with it. Files compiled for different processors may not share
/// an instance of a template: the linker would keep one for all, which not every processor need run.
template <class T, int lanes, class Level>
struct Pack {
#if defined(__GNUC__)
  using Lanes __attribute__((vector_size(lanes * sizeof(T)))) = T;
#else
  struct Lanes {
    T lane[lanes];
    T& operator[](int i) { return lane[i]; }
    T operator[](int i) const { return lane[i]; }
  };
#endif
  static constexpr int kLanes = lanes;

  Lanes v;

  Pack() : v{} {}
  explicit Pack(Lanes l) : v(l) {}

  static Pack Load(const T* from) {
    Pack a;
    std::memcpy(&a.v, from, sizeof a.v);
    return a;
  }
  void Store(T* to) const {
    std::memcpy(to, &v, sizeof v);
  }
  T operator[](int i) const {
    return v[i];
  }

#if defined(__GNUC__)
  struct Mask {
    decltype(Lanes{} > Lanes{}) v;
  };

  /// The same in all lanes.
  explicit Pack(double s) : v(static_cast<T>(s) - Lanes{}) {}
  template <class Other>
  explicit Pack(const Pack<Other, lanes, Level>& o) : v(__builtin_convertvector(o.v, Lanes)) {}

  friend Pack operator+(Pack a, Pack b) {
    return Pack(a.v + b.v);
  }
  friend Pack operator-(Pack a, Pack b) {
    return Pack(a.v - b.v);
  }
  friend Pack operator*(Pack a, Pack b) {
    return Pack(a.v * b.v);
  }
  friend Pack operator/(Pack a, Pack b) {
    return Pack(a.v / b.v);
  }
  friend Pack operator-(Pack a) {
    return Pack(-a.v);
  }
  friend Mask operator>(Pack a, Pack b) {
    return {a.v > b.v};
  }
  friend Pack Select(Mask m, Pack a, Pack b) {
    return Pack(m.v ? a.v : b.v);
  }
#else
  struct Mask {
    bool v[lanes];
  };

  explicit Pack(double s) {
    for (int i = 0; i < lanes; ++i) v[i] = static_cast<T>(s);
  }
  template <class Other>
  explicit Pack(const Pack<Other, lanes, Level>& o) {
    for (int i = 0; i < lanes; ++i) v[i] = static_cast<T>(o.v[i]);
  }
  template <class F>
  static Pack Each(F f) {
    Pack a;
    for (int i = 0; i < lanes; ++i) a.v[i] = f(i);
    return a;
  }

  friend Pack operator+(Pack a, Pack b) {
    return Each([&](int i) { return a.v[i] + b.v[i]; });
  }
  friend Pack operator-(Pack a, Pack b) {
    return Each([&](int i) { return a.v[i] - b.v[i]; });
  }
  friend Pack operator*(Pack a, Pack b) {
    return Each([&](int i) { return a.v[i] * b.v[i]; });
  }
  friend Pack operator/(Pack a, Pack b) {
    return Each([&](int i) { return a.v[i] / b.v[i]; });
  }
  friend Pack operator-(Pack a) {
    return Each([&](int i) { return -a.v[i]; });
  }
  friend Mask operator>(Pack a, Pack b) {
    Mask m;
    for (int i = 0; i < lanes; ++i) m.v[i] = a.v[i] > b.v[i];
    return m;
  }
  friend Pack Select(Mask m, Pack a, Pack b) {
    return Each([&](int i) { return m.v[i] ? a.v[i] : b.v[i]; });
  }
#endif

  Pack& operator+=(Pack o) {
    return *this = *this + o;
  }
  Pack& operator-=(Pack o) {
    return *this = *this - o;
  }
  friend Pack Sqrt(Pack a) {
    for (int i = 0; i < lanes; ++i) {
#if defined(__GNUC__)
      // Not std::sqrt, an inline function that all files share.
      if constexpr (sizeof(T) == sizeof(float))
        a.v[i] = __builtin_sqrtf(a.v[i]);
      else
        a.v[i] = __builtin_sqrt(a.v[i]);
#else
      a.v[i] = std::sqrt(a.v[i]);
#endif
    }
    return a;
  }
};

}  // namespace percale
