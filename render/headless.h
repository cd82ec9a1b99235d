#pragma once
/// \file
/// OpenGL without a display.

#include <memory>

#include "percale/diagnostic.h"

namespace percale {

/// An OpenGL 3.3 core context that draws into no window: by EGL where there is EGL (no display
/// server is needed, the CPU driver serves), elsewhere by a window that is never shown.
class HeadlessContext {
 public:
  /// Makes a context and makes it current. Fails with what to install (exit code 5 of the program).
  static Result<HeadlessContext> Create();
  ~HeadlessContext();
  HeadlessContext(HeadlessContext&&) noexcept;
  HeadlessContext& operator=(HeadlessContext&&) noexcept;

  void MakeCurrent() const;

 private:
  struct Impl;
  explicit HeadlessContext(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
