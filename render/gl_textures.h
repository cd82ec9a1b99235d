#pragma once
/// \file
/// The textures of the classic shaders, on the card.

#include <array>
#include <filesystem>
#include <map>

#include "percale/diagnostic.h"

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

  /// Warnings since the last call.
  Diagnostics TakeWarnings();

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, Texture> textures_;
  unsigned cubeMap_ = 0;
  Diagnostics warnings_;
};

}  // namespace percale
