#pragma once
/// \file
/// Asking for memory before it is needed.

namespace percale {

/// Has the processor read what is at `address` into its cache, if it can. The address need not be valid.
inline void Prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#endif
}

}  // namespace percale
