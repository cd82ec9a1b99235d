#pragma once
/// \file
/// Sanitizers look for other faults than the laws that tests state, and make everything ten times slower and more. What
/// proves the same of memory and threads with less is run with less under them.

namespace percale::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

/// So many, or so few under a sanitizer.
constexpr int Fewer(int count, int sanitized) {
  return kSanitized ? sanitized : count;
}
/// The same with a tenth.
constexpr int Fewer(int count) {
  return Fewer(count, (count + 9) / 10);
}
constexpr int Frames(int frames) {
  return Fewer(frames);
}

}  // namespace percale::test
