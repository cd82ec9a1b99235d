#include "render/picture.h"

#include <optional>
#include <utility>

#include "render/headless.h"
#include "render/legend.h"

namespace percale {

struct Painter::Impl {
  // In this order: what is made later needs the context, and goes first.
  HeadlessContext context;
  GraphicsInfo graphics;
  std::optional<GlDevice> device;
  std::optional<RenderTarget> target;
  SceneView sceneView;

  explicit Impl(HeadlessContext opened) : context(std::move(opened)), graphics(DescribeGraphics()) {}
  ~Impl() { context.MakeCurrent(); }

  Result<Image> Paint(const DrawList& list) {
    target->Bind();
    if (const Status drawn = device->Draw(list, target->width(), target->height()); !drawn) return drawn.diagnostics();
    Image image = target->Read();
    DrawLegend(image, list.heatScale);
    return {std::move(image), device->TakeWarnings()};
  }
};

Painter::Painter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Painter::~Painter() = default;
Painter::Painter(Painter&&) noexcept = default;
Painter& Painter::operator=(Painter&&) noexcept = default;

Result<Painter> Painter::Open(const PainterSettings& settings, bool* noGraphics) {
  Result<HeadlessContext> context = HeadlessContext::Create();
  if (noGraphics) *noGraphics = !context.ok();
  if (!context) return context.diagnostics();
  auto impl = std::make_unique<Impl>(std::move(*context));

  Result<GlDevice> device = GlDevice::Create(settings.root);
  if (!device) return device.diagnostics();
  impl->device.emplace(std::move(*device));
  Result<RenderTarget> target = RenderTarget::Create(settings.width, settings.height, settings.samples);
  if (!target) return target.diagnostics();
  impl->target.emplace(std::move(*target));
  return Painter(std::move(impl));
}

Result<Image> Painter::Paint(const World& world, const View& view) {
  impl_->context.MakeCurrent();
  return impl_->Paint(impl_->sceneView.Update(world, view, impl_->target->width(), impl_->target->height()));
}

Result<Image> Painter::Paint(const Scene& scene, std::span<const ClothShape> cloths, const View& view, double time) {
  impl_->context.MakeCurrent();
  return impl_->Paint(
      impl_->sceneView.Update(scene, cloths, view, impl_->target->width(), impl_->target->height(), {}, time));
}

ShaderLibrary& Painter::shaders() {
  return device().shaders();
}
GlDevice& Painter::device() {
  impl_->context.MakeCurrent();
  return *impl_->device;
}
const GraphicsInfo& Painter::graphics() const {
  return impl_->graphics;
}

}  // namespace percale
