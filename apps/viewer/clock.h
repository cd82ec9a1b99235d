#pragma once
/// \file
/// The clock of the viewer.

#include <chrono>

namespace percale::viewer {

/// Seconds since some moment; it never goes back.
inline double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace percale::viewer
