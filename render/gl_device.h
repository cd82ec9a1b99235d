#pragma once
/// \file
/// Draws draw lists with OpenGL 3.3 core, into a window as well as without one.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "percale/diagnostic.h"
#include "render/draw_list.h"
#include "render/image.h"
#include "render/shader_library.h"

namespace percale {

/// What the current context runs on.
struct GraphicsInfo {
  std::string vendor, renderer, version;
  bool software = false;  ///< The CPU draws: shadows and multisampling are slow.
  int maxSamples = 0;     ///< Per pixel.
};

/// Describes the current OpenGL context.
GraphicsInfo DescribeGraphics();

/// All drawing of one OpenGL context, which must be current for every call and for destruction.
class GlDevice {
 public:
  /// `root` is the project folder that holds shaders/ and textures/. Fails when the context is older
  /// than OpenGL 3.3 or the folder holds no shaders. Textures are read when first needed; a missing
  /// one becomes a checker, with one warning.
  static Result<GlDevice> Create(const std::filesystem::path& root);
  ~GlDevice();
  GlDevice(GlDevice&&) noexcept;
  GlDevice& operator=(GlDevice&&) noexcept;

  /// Clears the bound framebuffer, of that size [pixel], and draws. The state that it leaves: depth
  /// test on, program and vertex array 0. Fails when a shader is not to be had, with its problems;
  /// what it should have drawn is then drawn in magenta. (A shader with an older good version does not fail.)
  Status Draw(const DrawList& list, int width, int height);

  ShaderLibrary& shaders();
  /// The files of all textures that were drawn with, those that are missing too.
  std::vector<std::filesystem::path> TextureFiles() const;
  /// Reads those textures again, and with one face of the cube map all six; returns what was read. A
  /// picture that cannot be had leaves the old one in use, with a warning.
  std::vector<std::filesystem::path> ReloadTextures(const std::vector<std::filesystem::path>& files);
  /// Warnings since the last call: missing textures, and the like.
  Diagnostics TakeWarnings();

 private:
  struct Impl;
  explicit GlDevice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The lower left part of the framebuffer that is bound, opaque [pixel].
Image ReadFramebuffer(int width, int height);

/// A multisampled picture on the card, to draw into and read back. Its context must be current.
class RenderTarget {
 public:
  /// `samples` per pixel, 1 for none; more than the card has are cut down. Width and height 1..kMaxImageSize.
  static Result<RenderTarget> Create(int width, int height, int samples);
  ~RenderTarget();
  RenderTarget(RenderTarget&&) noexcept;
  RenderTarget& operator=(RenderTarget&&) noexcept;

  void Bind() const;   ///< Drawing goes here from now on.
  Image Read() const;  ///< The picture, opaque; leaves framebuffer 0 bound.
  int width() const;
  int height() const;

 private:
  struct Impl;
  explicit RenderTarget(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
