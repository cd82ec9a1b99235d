#pragma once
/// \file
/// The text of shaders: `#include`, and OpenGL ES for the web.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"

namespace percale {

/// The text of one shader as the compiler takes it, its #include lines replaced by the files that
/// they name, and where each line comes from.
///
///     #include "house_light.glsl"
///
/// names a file relative to the shader's folder, which it cannot leave. A file that was included
/// before is left out, so that two files may need the same third one. The first #version line counts
/// and others are blank, so that a whole shader can be included.
struct ShaderText {
  struct File {
    std::filesystem::path path;
    std::string text;  ///< Empty where the file cannot be read.
  };
  struct Line {
    int file = 0;  ///< Index in `files`.
    int number = 0;
  };

  std::string text;
  std::vector<File> files;  ///< The shader's own, then those that it includes, missing ones too.
  std::vector<Line> lines;  ///< Of `text`.
  Diagnostics problems;     ///< Errors: a missing file, a circle, a line that is not understood.

  /// Where the line of `text` with that number, from 1, was read, with that line as the excerpt.
  Diagnostic At(int line, int column = 0) const;
};

/// Reads a shader and what it includes.
ShaderText ReadShaderText(const std::filesystem::path& file);

/// A shader for OpenGL 3.3 core as one for OpenGL ES 3.0, that is for WebGL 2: with that version and
/// the precisions that are not implied there. Line numbers in messages stay those of `text`.
std::string ToEs300(std::string_view text);

/// Makes the shader `name` in `folder` from a commented template, which compiles as it is; returns
/// its file. A name is made of letters, digits, _ and -, and must be new.
Result<std::filesystem::path> CreateShader(const std::filesystem::path& folder, const std::string& name);

}  // namespace percale
