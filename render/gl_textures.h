#pragma once
/// \file
/// The textures of the classic shaders, on the card.

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "percale/diagnostic.h"
#include "render/image.h"

namespace percale {

/// Reads textures when they are first asked for. Needs its OpenGL context current.
class GlTextures {
 public:
  struct Texture {
    unsigned name = 0;  ///< OpenGL's.
    int width = 0, height = 0;
  };

  /// `folder` holds texture_1.png .. texture_4.png and cube/posx.png .. cube/negz.png.
  explicit GlTextures(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~GlTextures();
  GlTextures(const GlTextures&) = delete;
  GlTextures& operator=(const GlTextures&) = delete;

  /// Texture 0..3: from `file`, or where that is empty the project's own. A checker with a warning
  /// where the file cannot be had.
  const Texture& Get(int number, const std::filesystem::path& file);
  /// The cube map, or a checker with a warning.
  unsigned CubeMap();

  /// The files of all textures that were asked for, those that are missing too.
  std::vector<std::filesystem::path> Files() const;
  /// Reads those of `files` again that belong to textures, and with one face of the cube map all six;
  /// returns what was read. Where that fails, what is on the card stays, with a warning.
  std::vector<std::filesystem::path> Reload(const std::vector<std::filesystem::path>& files);

  /// Warnings since the last call.
  Diagnostics TakeWarnings();

 private:
  using Faces = std::array<Image, 6>;  // In the order of OpenGL's.

  /// Nothing, with a warning that ends in `consequence`, where the file is no picture that the card takes.
  std::optional<Image> Read(const std::filesystem::path& file, const std::string& consequence);
  std::optional<Faces> ReadFaces(const std::string& consequence);
  std::filesystem::path FaceFile(std::size_t face) const;
  static void Upload(Texture& texture, const Image& image);
  void UploadCubeMap(const Faces& faces) const;
  void Warn(const Diagnostics& problems, const std::string& consequence);

  std::filesystem::path folder_;
  std::map<std::filesystem::path, Texture> textures_;
  unsigned cubeMap_ = 0;
  Diagnostics warnings_;
};

}  // namespace percale
