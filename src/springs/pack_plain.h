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
template <class F>
inline Words EachQuarter(F f) {
  return EachWord([&](int i) { return f(i, 0) | f(i, 16) << 16 | f(i, 32) << 32 | f(i, 48) << 48; });
}
inline Words Quarters(Words x, Words y, Words z) {
  return EachWord([&](int i) {
    return (x.v[i] >> 14 & 0xffff) | (y.v[i] >> 14 & 0xffff) << 16 | (z.v[i] >> 14 & 0xffff) << 32 | x.v[i] >> 62 << 48;
  });
}
inline Words TimesQuarters(Words a, Words b) {
  return EachQuarter([&](int i, int at) { return (a.v[i] >> at & 0xffff) * (b.v[i] >> at & 0xffff) >> 16; });
}
inline Words ExtremeQuarters(Words a) {
  return EachQuarter([&](int i, int at) {
    const std::uint64_t quarter = a.v[i] >> at & 0xffff;
    return quarter == 0 || quarter == 0xffff ? std::uint64_t{0xffff} : std::uint64_t{0};
  });
}
inline unsigned Differ(Words a, Words b) {
  return Bits(Mask{{a.v[0] != b.v[0], a.v[1] != b.v[1], a.v[2] != b.v[2], a.v[3] != b.v[3]}});
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

struct Places {
  std::int32_t xy[8], z[8];
};
struct Ints {
  std::int32_t v[8];
};
inline Places GatherPlaces(const std::uint64_t* from, const std::int32_t* index) {
  Places a;
  for (int i = 0; i < 8; ++i) {
    a.xy[i] = static_cast<std::int32_t>(from[index[i]]);
    a.z[i] = static_cast<std::int32_t>(from[index[i]] >> 32);
  }
  return a;
}
inline Places AllPlaces(const std::int32_t* xy, const std::int32_t* z) {
  Places a;
  for (int i = 0; i < 8; ++i) a.xy[i] = *xy, a.z[i] = *z;
  return a;
}
inline Places AllPlaces(std::uint64_t place) {
  const auto xy = static_cast<std::int32_t>(place), z = static_cast<std::int32_t>(place >> 32);
  return AllPlaces(&xy, &z);
}
inline void StorePlaces(std::int32_t* xy, std::int32_t* z, Places a) {
  for (int i = 0; i < 8; ++i) xy[i] = a.xy[i], z[i] = a.z[i];
}
inline Places LoadPlaces(const std::int32_t* xy, const std::int32_t* z) {
  Places a;
  for (int i = 0; i < 8; ++i) a.xy[i] = xy[i], a.z[i] = z[i];
  return a;
}
inline Places FirstPlaces(int count, Places a) {
  constexpr std::int32_t kApart = 1 << 29;
  constexpr std::int32_t kBeyond[8] = {kApart,     kApart,      kApart,      2 * kApart,
                                       3 * kApart, -4 * kApart, -3 * kApart, -2 * kApart};
  for (int i = 0; i < 8; ++i) a.z[i] |= i < count ? 0 : kBeyond[i];
  return a;
}
template <int turn>
inline Places Turn(Places a) {
  Places turned;
  for (int i = 0; i < 8; ++i) turned.xy[i] = a.xy[(i + turn) % 8], turned.z[i] = a.z[(i + turn) % 8];
  return turned;
}
/// The sum of the squares of the differences of both halves, which come round.
inline std::int32_t SquaredHalves(std::int32_t a, std::int32_t b) {
  const auto low = static_cast<std::int16_t>((a & 0xffff) - (b & 0xffff));
  const auto high = static_cast<std::int16_t>((a >> 16) - (b >> 16));
  return low * low + high * high;
}
inline Ints SquaredDistance(Places a, Places b) {
  Ints squares;
  for (int i = 0; i < 8; ++i) squares.v[i] = SquaredHalves(a.xy[i], b.xy[i]) + SquaredHalves(a.z[i], b.z[i]);
  return squares;
}
inline Ints AllInts(std::int32_t s) {
  return {{s, s, s, s, s, s, s, s}};
}
inline Ints Least(Ints a, Ints b) {
  for (int i = 0; i < 8; ++i) a.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
  return a;
}
inline unsigned Below(Ints a, std::int32_t bound) {
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= (a.v[i] < bound ? 1u : 0u) << i;
  return bits;
}
