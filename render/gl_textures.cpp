#include "render/gl_textures.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <iterator>
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

void UploadPixels(GLenum target, const Image& image) {
  // GL_RGBA8, not an sRGB format: the classic shaders compute with the numbers of the file.
  glTexImage2D(target, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

constexpr const char* kFaces[] = {"posx", "negx", "posy", "negy", "posz", "negz"};  // In the order of OpenGL's.
constexpr const char* kOldOneStays = "; the picture before it stays";

}  // namespace

GlTextures::~GlTextures() {
  for (const auto& [file, texture] : textures_) glDeleteTextures(1, &texture.name);
  if (cubeMap_) glDeleteTextures(1, &cubeMap_);
}

const GlTextures::Texture& GlTextures::Get(int number, const std::filesystem::path& file) {
  const std::filesystem::path path = file.empty() ? folder_ / ("texture_" + std::to_string(number + 1) + ".png") : file;
  if (const auto found = textures_.find(path); found != textures_.end()) return found->second;

  const auto image = Read(path, "; texture " + std::to_string(number + 1) + " is drawn as a checker");
  Texture texture;
  glGenTextures(1, &texture.name);
  Upload(texture, image ? *image : Checker());
  return textures_.emplace(path, texture).first->second;
}

unsigned GlTextures::CubeMap() {
  if (cubeMap_) return cubeMap_;
  auto faces = ReadFaces("; the surroundings are drawn as a checker");
  if (!faces) faces.emplace().fill(Checker());
  glGenTextures(1, &cubeMap_);
  UploadCubeMap(*faces);
  return cubeMap_;
}

std::optional<Image> GlTextures::Read(const std::filesystem::path& file, const std::string& consequence) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  Result<Image> read = ReadPng(file);
  if (read && (read->width > limit || read->height > limit)) {
    read = MakeError(PathText(file), "is " + std::to_string(read->width) + " x " + std::to_string(read->height) +
                                         " pixels; this graphics card takes " + std::to_string(limit));
  }
  if (read) return std::move(*read);
  Warn(read.diagnostics(), consequence);
  return std::nullopt;
}

std::filesystem::path GlTextures::FaceFile(std::size_t face) const {
  return folder_ / "cube" / (std::string(kFaces[face]) + ".png");
}

std::optional<GlTextures::Faces> GlTextures::ReadFaces(const std::string& consequence) {
  Faces faces;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    auto read = Read(FaceFile(i), consequence);
    if (!read) return std::nullopt;
    if (read->width != read->height || (i > 0 && read->width != faces[0].width)) {
      Warn({MakeError(PathText(FaceFile(i)), "expected a square picture of one size for all six faces, found " +
                                                 std::to_string(read->width) + " x " + std::to_string(read->height))},
           consequence);
      return std::nullopt;
    }
    faces[i] = std::move(*read);
  }
  return faces;
}

void GlTextures::Upload(Texture& texture, const Image& image) {
  texture.width = image.width;
  texture.height = image.height;
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.name);
  UploadPixels(GL_TEXTURE_2D, image);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void GlTextures::UploadCubeMap(const Faces& faces) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_CUBE_MAP, cubeMap_);
  for (GLenum i = 0; i < 6; ++i) UploadPixels(GL_TEXTURE_CUBE_MAP_POSITIVE_X + i, faces[i]);
  glGenerateMipmap(GL_TEXTURE_CUBE_MAP);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTexParameteri(GL_TEXTURE_CUBE_MAP, wrap, GL_CLAMP_TO_EDGE);
  }
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

void GlTextures::Warn(const Diagnostics& problems, const std::string& consequence) {
  for (Diagnostic warning : problems) {
    warning.severity = Severity::Warning;
    warning.message += consequence;
    warnings_.push_back(std::move(warning));
  }
}

std::vector<std::filesystem::path> GlTextures::Files() const {
  std::vector<std::filesystem::path> files;
  for (const auto& [file, texture] : textures_) files.push_back(file);
  for (std::size_t i = 0; cubeMap_ && i < std::size(kFaces); ++i) files.push_back(FaceFile(i));
  return files;
}

std::vector<std::filesystem::path> GlTextures::Reload(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> read;
  bool isFace = false;
  for (const std::filesystem::path& file : files) {
    for (std::size_t i = 0; i < std::size(kFaces); ++i) isFace |= cubeMap_ && file == FaceFile(i);
    const auto found = textures_.find(file);
    if (found == textures_.end()) continue;
    if (const auto image = Read(file, kOldOneStays)) Upload(found->second, *image);
    read.push_back(file);
  }
  if (!isFace) return read;
  if (const auto faces = ReadFaces(kOldOneStays)) UploadCubeMap(*faces);
  for (std::size_t i = 0; i < std::size(kFaces); ++i) read.push_back(FaceFile(i));
  return read;
}

Diagnostics GlTextures::TakeWarnings() {
  return std::exchange(warnings_, {});
}

}  // namespace percale
