#pragma once
/// \file
/// Pictures of a World without a display, in two lines:
///
///     auto painter = percale::Painter::Open({.root = root});
///     auto picture = painter->Paint(world, percale::View::ForScene(world.scene()));

#include <filesystem>
#include <memory>

#include "percale/diagnostic.h"
#include "percale/world.h"
#include "render/gl_device.h"
#include "render/image.h"
#include "render/scene_view.h"

namespace percale {

struct PainterSettings {
  std::filesystem::path root = ".";  ///< The project folder with shaders/ and textures/.
  int width = 1024;                  ///< [pixel], 1..kMaxImageSize.
  int height = 800;                  ///< [pixel], 1..kMaxImageSize.
  int samples = 4;                   ///< Per pixel; 1: no smoothing of edges.
};

class Painter {
 public:
  /// Fails when there is no graphics, with what to install (`noGraphics`, if given, is then set:
  /// exit code 5), when the folder holds no shaders, or when the size is out of range.
  static Result<Painter> Open(const PainterSettings& settings, bool* noGraphics = nullptr);
  ~Painter();
  Painter(Painter&&) noexcept;
  Painter& operator=(Painter&&) noexcept;

  /// The World as it stands. Fails when the shader is unknown or does not compile. Warnings (a
  /// missing texture) stand beside the first picture that they concern.
  Result<Image> Paint(const World& world, const View& view);
  /// The same from copies of the positions, the colliders where they are at `time` [s].
  Result<Image> Paint(const Scene& scene, std::span<const ClothShape> cloths, const View& view, double time = 0);

  ShaderLibrary& shaders();
  GlDevice& device();  ///< Its context is current until another painter draws.
  const GraphicsInfo& graphics() const;

 private:
  struct Impl;
  explicit Painter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
