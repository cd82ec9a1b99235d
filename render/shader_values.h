#pragma once
/// \file
/// Values of a shader's parameters that the user prefers to its defaults: shaders/NAME.json beside
/// shaders/NAME.frag.
///
///     {
///       "u_shininess": 12,
///       "u_lit": true,
///       "u_upper": [0, 0.34, 0.72]
///     }

#include <filesystem>
#include <span>
#include <string>

#include "percale/diagnostic.h"
#include "render/shader_library.h"

namespace percale {

/// Where the values of a shader in that folder are kept.
std::filesystem::path ShaderValuesFile(const std::filesystem::path& folder, const std::string& shader);

/// Reads such a file; none gives no values. Fails on what is no such file, with the place. A value that does
/// not fit its parameter is left out, with a warning; one whose parameter the shader lacks (now) stays.
Result<UniformValues> LoadShaderValues(const std::filesystem::path& file, std::span<const ShaderParameter> parameters);

/// Writes it, under a temporary name that is renamed. Without values the file is removed.
Status SaveShaderValues(const std::filesystem::path& file, const UniformValues& values,
                        std::span<const ShaderParameter> parameters);

}  // namespace percale
