#include "render/gl_textures.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

#include "io/atomic_file.h"
#include "render/image.h"

namespace percale {
namespace {

// Nothing that one would take for a picture.
Image Checker() {
  Image image = MakeImage(64, 64);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool bright = ((x / 8) + (y / 8)) % 2 == 0;
      const std::uint8_t color[3] = {std::uint8_t(bright ? 230 : 60), std::uint8_t(bright ? 60 : 60),
                                     std::uint8_t(bright ? 200 : 60)};
      std::copy(color, color + 3, image.At(x, y));
    }
  }
  return image;
}

void Upload(GLenum target, const Image& image) {
  // GL_RGBA8, not an sRGB format: the classic shaders compute with the numbers of the file.
  glTexImage2D(target, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

}  // namespace

GlTextures::~GlTextures() {
  for (const auto& [file, texture] : textures_) glDeleteTextures(1, &texture.name);
  if (cubeMap_) glDeleteTextures(1, &cubeMap_);
}

const GlTextures::Texture& GlTextures::Get(int number, const std::filesystem::path& file) {
  const std::filesystem::path path = file.empty() ? folder_ / ("texture_" + std::to_string(number + 1) + ".png") : file;
  if (const auto found = textures_.find(path); found != textures_.end()) return found->second;

  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  Result<Image> read = ReadPng(path);
  if (read && (read->width > limit || read->height > limit)) {
    read = MakeError(PathText(path), "is " + std::to_string(read->width) + " x " + std::to_string(read->height) +
                                         " pixels; this graphics card takes " + std::to_string(limit));
  }
  if (!read) {
    for (Diagnostic warning : read.diagnostics()) {
      warning.severity = Severity::Warning;
      warning.message += "; texture " + std::to_string(number + 1) + " is drawn as a checker";
      warnings_.push_back(std::move(warning));
    }
  }
  const Image image = read ? std::move(*read) : Checker();
  Texture texture{0, image.width, image.height};
  glGenTextures(1, &texture.name);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.name);
  Upload(GL_TEXTURE_2D, image);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
  return textures_.emplace(path, texture).first->second;
}

unsigned GlTextures::CubeMap() {
  if (cubeMap_) return cubeMap_;
  const char* names[] = {"posx", "negx", "posy", "negy", "posz", "negz"};  // In the order of OpenGL's faces.
  std::array<Image, 6> faces;
  bool good = true;
  for (std::size_t i = 0; i < 6 && good; ++i) {
    const std::filesystem::path path = folder_ / "cube" / (std::string(names[i]) + ".png");
    Result<Image> read = ReadPng(path);
    Diagnostics problems = read.diagnostics();
    if (read) {
      if (read->width != read->height || (i > 0 && read->width != faces[0].width)) {
        problems.push_back(MakeError(PathText(path), "expected a square picture of one size for all six faces, found " +
                                                         std::to_string(read->width) + " x " +
                                                         std::to_string(read->height)));
      } else {
        faces[i] = std::move(*read);
      }
    }
    for (Diagnostic& warning : problems) {
      warning.severity = Severity::Warning;
      warning.message += "; the surroundings are drawn as a checker";
      warnings_.push_back(std::move(warning));
      good = false;
    }
  }
  if (!good) faces.fill(Checker());
  glGenTextures(1, &cubeMap_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_CUBE_MAP, cubeMap_);
  for (GLenum i = 0; i < 6; ++i) Upload(GL_TEXTURE_CUBE_MAP_POSITIVE_X + i, faces[i]);
  glGenerateMipmap(GL_TEXTURE_CUBE_MAP);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTexParameteri(GL_TEXTURE_CUBE_MAP, wrap, GL_CLAMP_TO_EDGE);
  }
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
  return cubeMap_;
}

Diagnostics GlTextures::TakeWarnings() {
  return std::exchange(warnings_, {});
}

}  // namespace percale
