#include "render/gl_shadow_map.h"

#include <epoxy/gl.h>

#include <utility>

namespace percale {
namespace {

// A depth texture that is compared with: 1 in the light, 0 in the shadow, mixed between four texels.
unsigned MakeDepthTexture(int size, const void* depths) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, depths);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

}  // namespace

GlShadowMap::~GlShadowMap() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
  glDeleteTextures(1, &light_);
}

std::string GlShadowMap::Allocate(int size) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (size > limit) return "this graphics card has textures of at most " + std::to_string(limit) + " pixels";
  while (glGetError() != GL_NO_ERROR) {
  }
  texture_ = MakeDepthTexture(size, nullptr);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return complete && glGetError() == GL_NO_ERROR ? "" : "this graphics card cannot draw into a texture of depths";
}

bool GlShadowMap::Begin(int size) {
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &previous_);
  if (size_ != size) {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteTextures(1, &texture_);
    texture_ = framebuffer_ = 0;
    size_ = size;
    const std::string problem = Allocate(size);
    isGood_ = problem.empty();
    if (!isGood_) {
      warnings_.push_back(MakeWarning("shadows are not drawn: a shadow map of " + std::to_string(size) + " x " +
                                      std::to_string(size) + " pixels is not to be had: " + problem));
    }
  }
  isDrawn_ = isGood_;
  if (!isGood_) {
    End();
    return false;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size, size);
  glClear(GL_DEPTH_BUFFER_BIT);
  return true;
}

void GlShadowMap::End() {
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(previous_));
}

void GlShadowMap::Clear() {
  isDrawn_ = false;
}

unsigned GlShadowMap::Texture() {
  if (isDrawn_) return texture_;
  const GLuint farthest = 0xffffffff;
  if (!light_) light_ = MakeDepthTexture(1, &farthest);
  return light_;
}

Diagnostics GlShadowMap::TakeWarnings() {
  return std::exchange(warnings_, {});
}

}  // namespace percale
