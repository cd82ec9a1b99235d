#include <epoxy/gl.h>

#include <algorithm>
#include <string>
#include <utility>

#include "render/gl_device.h"

namespace percale {

Image ReadFramebuffer(int width, int height) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 4)};
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());

  // OpenGL's first row is the lowest.
  const std::size_t rowSize = std::size_t(width) * 4;
  for (int y = 0; y < height / 2; ++y)
    std::swap_ranges(image.At(0, y), image.At(0, y) + rowSize, image.At(0, height - 1 - y));
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

struct RenderTarget::Impl {
  int width = 0, height = 0;
  bool isMultisampled = false;
  GLuint framebuffers[2] = {};   // Drawn into; read from, after the samples are joined.
  GLuint renderbuffers[3] = {};  // Colour and depth of the first, colour of the second.

  ~Impl() {
    glDeleteFramebuffers(2, framebuffers);
    glDeleteRenderbuffers(3, renderbuffers);
  }
};

RenderTarget::RenderTarget(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RenderTarget::~RenderTarget() = default;
RenderTarget::RenderTarget(RenderTarget&&) noexcept = default;
RenderTarget& RenderTarget::operator=(RenderTarget&&) noexcept = default;

Result<RenderTarget> RenderTarget::Create(int width, int height, int samples) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
  limit = std::min(limit, kMaxImageSize);
  if (width < 1 || height < 1 || width > limit || height > limit) {
    return MakeError("expected a picture of 1 to " + std::to_string(limit) + " pixels each way, found " +
                     std::to_string(width) + " x " + std::to_string(height));
  }
  samples = std::min(samples, DescribeGraphics().maxSamples);
  auto impl = std::make_unique<Impl>();
  impl->width = width;
  impl->height = height;
  impl->isMultisampled = samples > 1;
  while (glGetError() != GL_NO_ERROR) {
  }
  glGenFramebuffers(2, impl->framebuffers);
  glGenRenderbuffers(3, impl->renderbuffers);
  const auto store = [&](GLuint buffer, GLenum format, int count) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    if (count > 1) {
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, count, format, width, height);
    } else {
      glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    }
  };
  store(impl->renderbuffers[0], GL_RGBA8, samples);
  store(impl->renderbuffers[1], GL_DEPTH_COMPONENT24, samples);
  glBindFramebuffer(GL_FRAMEBUFFER, impl->framebuffers[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, impl->renderbuffers[0]);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, impl->renderbuffers[1]);
  bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (impl->isMultisampled) {
    store(impl->renderbuffers[2], GL_RGBA8, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, impl->framebuffers[1]);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, impl->renderbuffers[2]);
    complete = complete && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  glBindRenderbuffer(GL_RENDERBUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (!complete || glGetError() != GL_NO_ERROR) {
    return MakeError("the graphics card has no room for a picture of " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels with " + std::to_string(samples) +
                     " samples each; ask for a smaller one or fewer samples");
  }
  return RenderTarget(std::move(impl));
}

void RenderTarget::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffers[0]);
  glViewport(0, 0, impl_->width, impl_->height);
}

Image RenderTarget::Read() const {
  const int width = impl_->width, height = impl_->height;
  if (impl_->isMultisampled) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, impl_->framebuffers[0]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, impl_->framebuffers[1]);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffers[impl_->isMultisampled ? 1 : 0]);
  Image image = ReadFramebuffer(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return image;
}

int RenderTarget::width() const {
  return impl_->width;
}
int RenderTarget::height() const {
  return impl_->height;
}

}  // namespace percale
