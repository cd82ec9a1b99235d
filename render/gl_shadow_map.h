#pragma once
/// \file
/// The shadow map, on the card: how far the light reaches in each direction.

#include <string>

#include "percale/diagnostic.h"

namespace percale {

/// A square depth texture to draw into, and then to compare with. Needs its OpenGL context current.
class GlShadowMap {
 public:
  GlShadowMap() = default;
  ~GlShadowMap();
  GlShadowMap(const GlShadowMap&) = delete;
  GlShadowMap& operator=(const GlShadowMap&) = delete;

  /// Makes the next drawing go into the map, empty, of that size [pixel, >= 1]. Returns false where
  /// the card has no such map, with one warning per size; everything is then in the light.
  bool Begin(int size);
  /// Makes drawing go where it went before Begin.
  void End();
  /// The texture, to be bound for a sampler2DShadow; what was last drawn, or light everywhere.
  unsigned Texture();
  /// Light everywhere from now on.
  void Clear();

  /// Warnings since the last call.
  Diagnostics TakeWarnings();

 private:
  std::string Allocate(int size);  ///< Why that failed; empty: it did not.

  int size_ = 0;         ///< That was asked for last.
  bool isGood_ = false;  ///< There is a map of that size.
  bool isDrawn_ = false;
  unsigned texture_ = 0, framebuffer_ = 0, light_ = 0;
  int previous_ = 0;  ///< Framebuffer before Begin.
  Diagnostics warnings_;
};

}  // namespace percale
