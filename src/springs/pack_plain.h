// Four doubles and eight floats at a time, in plain C++. Included by pack.h inside the namespace of an instruction set;
// never elsewhere. What the functions do is said in pack_avx512.h and floats_avx2.h.

constexpr int kLanes = 4;

struct Pack {
  double v[4];
};
struct Mask {
  bool v[4];
};
inline Pack Load(const double* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
inline void Store(double* p, Pack a) {
  for (int i = 0; i < 4; ++i) p[i] = a.v[i];
}
inline Pack All(double s) {
  return {{s, s, s, s}};
}
template <class F>
inline Pack Each(F f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Pack operator+(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] + b.v[i]; });
}
inline Pack operator-(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] - b.v[i]; });
}
inline Pack operator*(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] * b.v[i]; });
}
inline Pack operator/(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] / b.v[i]; });
}
inline Pack Sqrt(Pack a) {
  return Each([&](int i) { return Sqrt(a.v[i]); });
}
inline Mask operator>(Pack a, Pack b) {
  return {{a.v[0] > b.v[0], a.v[1] > b.v[1], a.v[2] > b.v[2], a.v[3] > b.v[3]}};
}
inline Mask operator<=(Pack a, Pack b) {
  return {{a.v[0] <= b.v[0], a.v[1] <= b.v[1], a.v[2] <= b.v[2], a.v[3] <= b.v[3]}};
}
inline Mask operator&(Mask a, Mask b) {
  return {{a.v[0] && b.v[0], a.v[1] && b.v[1], a.v[2] && b.v[2], a.v[3] && b.v[3]}};
}
inline Mask operator|(Mask a, Mask b) {
  return {{a.v[0] || b.v[0], a.v[1] || b.v[1], a.v[2] || b.v[2], a.v[3] || b.v[3]}};
}
inline Mask operator^(Mask a, Mask b) {
  return {{a.v[0] != b.v[0], a.v[1] != b.v[1], a.v[2] != b.v[2], a.v[3] != b.v[3]}};
}
inline Pack Select(Mask m, Pack a, Pack b) {
  return Each([&](int i) { return m.v[i] ? a.v[i] : b.v[i]; });
}
inline Pack Where(Mask m, Pack a) {
  return Each([&](int i) { return m.v[i] ? a.v[i] : 0.0; });
}
inline Pack Max(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline Mask Outside(Pack a, double bound) {
  const auto outside = [&](int i) { return !(a.v[i] <= bound && a.v[i] >= -bound); };
  return {{outside(0), outside(1), outside(2), outside(3)}};
}
inline Mask FirstLanes(int count) {
  return {{0 < count, 1 < count, 2 < count, 3 < count}};
}
inline unsigned Bits(Mask m) {
  return static_cast<unsigned>(m.v[0]) | static_cast<unsigned>(m.v[1]) << 1 | static_cast<unsigned>(m.v[2]) << 2 |
         static_cast<unsigned>(m.v[3]) << 3;
}

struct Words {
  std::uint64_t v[4];
};
inline Words LoadWords(const std::uint64_t* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
inline void StoreWords(std::uint64_t* p, Words a) {
  memcpy(p, a.v, sizeof a.v);
}
inline Words AllWords(std::uint64_t s) {
  return {{s, s, s, s}};
}
inline Words WordsOf(Pack a) {
  Words words;
  memcpy(words.v, a.v, sizeof words.v);
  return words;
}
template <class F>
inline Words EachWord(F f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Words operator+(Words a, Words b) {
  return EachWord([&](int i) { return a.v[i] + b.v[i]; });
}
inline Words operator&(Words a, Words b) {
  return EachWord([&](int i) { return a.v[i] & b.v[i]; });
}
inline Words operator^(Words a, Words b) {
  return EachWord([&](int i) { return a.v[i] ^ b.v[i]; });
}
inline Words operator|(Words a, Words b) {
  return EachWord([&](int i) { return a.v[i] | b.v[i]; });
}
template <int bits>
inline Words Down(Words a) {
  return EachWord([&](int i) { return a.v[i] >> bits; });
}
template <int bits>
inline Words Up(Words a) {
  return EachWord([&](int i) { return a.v[i] << bits; });
}
inline unsigned Differ(Words a, Words b) {
  return Bits(Mask{{a.v[0] != b.v[0], a.v[1] != b.v[1], a.v[2] != b.v[2], a.v[3] != b.v[3]}});
}
inline Mask Lack(Words a, Words bits) {
  const Words set = a & bits;
  return {{set.v[0] == 0, set.v[1] == 0, set.v[2] == 0, set.v[3] == 0}};
}
inline Pack Gather(const double* from, const std::int32_t* index) {
  return Each([&](int i) { return from[index[i]]; });
}
inline Pack MaybeFused(Pack a, Pack b, Pack c) {
  return a * b + c;
}
inline std::uint64_t NonzeroBytes(const std::uint8_t* p) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 64; ++i) bits |= std::uint64_t{p[i] != 0} << i;
  return bits;
}
constexpr bool kQuickRoots = false;
inline bool QuickSqrt(const Pack[6], Pack[6]) {
  return false;
}

struct FloatPack {
  float v[8];
};
template <class F>
inline FloatPack EachFloat(F f) {
  return {{f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)}};
}
inline FloatPack LoadFloats(const float* p) {
  return EachFloat([&](int i) { return p[i]; });
}
inline void StoreFloats(float* p, FloatPack a) {
  for (int i = 0; i < 8; ++i) p[i] = a.v[i];
}
inline FloatPack AllFloats(float s) {
  return EachFloat([&](int) { return s; });
}
inline FloatPack operator+(FloatPack a, FloatPack b) {
  return EachFloat([&](int i) { return a.v[i] + b.v[i]; });
}
inline FloatPack operator-(FloatPack a, FloatPack b) {
  return EachFloat([&](int i) { return a.v[i] - b.v[i]; });
}
inline FloatPack FloatsBefore(double origin, const double* x) {
  return EachFloat([&](int i) { return static_cast<float>(origin - x[i]); });
}
struct FloatMask {
  bool v[8];
};
inline FloatMask operator>(FloatPack a, FloatPack b) {
  FloatMask m;
  for (int i = 0; i < 8; ++i) m.v[i] = a.v[i] > b.v[i];
  return m;
}
inline FloatMask operator|(FloatMask a, FloatMask b) {
  for (int i = 0; i < 8; ++i) a.v[i] = a.v[i] || b.v[i];
  return a;
}
inline unsigned Bits(FloatMask m) {
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= (m.v[i] ? 1u : 0u) << i;
  return bits;
}
template <int turn>
inline FloatPack Turn(FloatPack a) {
  return EachFloat([&](int i) { return a.v[(i + turn) % 8]; });
}
inline FloatPack Least(FloatPack a, FloatPack b) {
  return EachFloat([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline FloatPack Greatest(FloatPack a, FloatPack b) {
  return EachFloat([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline FloatPack Size(FloatPack a) {
  return EachFloat([&](int i) { return a.v[i] < 0 ? -a.v[i] : a.v[i]; });
}
inline FloatPack SquaredLength(FloatPack x, FloatPack y, FloatPack z) {
  return EachFloat([&](int i) { return x.v[i] * x.v[i] + y.v[i] * y.v[i] + z.v[i] * z.v[i]; });
}
inline unsigned AtMost(FloatPack a, float bound) {
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= (a.v[i] <= bound ? 1u : 0u) << i;
  return bits;
}
inline FloatPack GatherFloats(const double* from, const std::int32_t* index, double origin) {
  return EachFloat([&](int i) { return static_cast<float>(from[index[i]] - origin); });
}
inline FloatPack FarAfter(int count, FloatPack a) {
  return EachFloat([&](int i) { return i < count ? a.v[i] : 1e15f * static_cast<float>(i + 1); });
}
