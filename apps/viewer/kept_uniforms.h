#pragma once
/// \file
/// The values of shaders' parameters that the user has set, kept beside each shader (render/shader_values.h).

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "apps/viewer/file_watch.h"
#include "render/shader_values.h"

namespace percale::viewer {

class KeptUniforms {
 public:
  /// After the last change a file is written when so much time has passed [s].
  static constexpr double kDelay = 0.5;

  /// `folder` holds the shaders. Unless `enabled` nothing is read or written.
  KeptUniforms(std::filesystem::path folder, bool enabled) : folder_(std::move(folder)), enabled_(enabled) {}

  /// The values of a shader, which has these parameters.
  const UniformValues& Of(const std::string& shader, std::span<const ShaderParameter> parameters);
  /// What is wrong with its file.
  const Diagnostics& Problems(const std::string& shader) { return shaders_[shader].problems; }
  /// The user's choice; nothing: the default. `now` counts seconds.
  void Set(const std::string& shader, const std::string& uniform, const std::optional<UniformValue>& value, double now);

  /// Whether the user has edited the file of a shader; then Of reads it again.
  bool Changed(const std::string& shader);
  /// Writes what has been changed a while ago.
  void WriteDue(double now);
  /// Writes all that has been changed.
  void WriteAll();

 private:
  struct Shader {
    bool loaded = false, unreadable = false;
    double dirtySince = -1;  // [s]; below 0: nothing is to be written.
    UniformValues values;
    std::vector<ShaderParameter> parameters;
    Diagnostics problems;
    FileWatch watch;
  };
  void Write(const std::string& name, Shader& shader);

  std::filesystem::path folder_;
  bool enabled_;
  std::map<std::string, Shader> shaders_;
};

}  // namespace percale::viewer
