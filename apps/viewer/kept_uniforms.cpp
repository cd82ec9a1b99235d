#include "apps/viewer/kept_uniforms.h"

#include <utility>

namespace percale::viewer {

const UniformValues& KeptUniforms::Of(const std::string& name, std::span<const ShaderParameter> parameters) {
  Shader& shader = shaders_[name];
  shader.parameters.assign(parameters.begin(), parameters.end());
  if (!enabled_ || std::exchange(shader.loaded, true)) return shader.values;
  const std::filesystem::path file = ShaderValuesFile(folder_, name);
  shader.watch = FileWatch(file);
  Result<UniformValues> read = LoadShaderValues(file, parameters);
  shader.problems = read.diagnostics();
  shader.unreadable = !read;
  if (read) shader.values = std::move(*read);
  return shader.values;
}

void KeptUniforms::Set(const std::string& shader, const std::string& uniform, const std::optional<UniformValue>& value,
                       double now) {
  Shader& kept = shaders_[shader];
  if (value)
    kept.values[uniform] = *value;
  else
    kept.values.erase(uniform);
  kept.dirtySince = now;
}

bool KeptUniforms::Changed(const std::string& name) {
  Shader& shader = shaders_[name];
  if (!shader.loaded || shader.dirtySince >= 0 || !shader.watch.Changed()) return false;
  shader.loaded = false;
  return true;
}

void KeptUniforms::WriteDue(double now) {
  for (auto& [name, shader] : shaders_) {
    if (shader.dirtySince >= 0 && now >= shader.dirtySince + kDelay) Write(name, shader);
  }
}

void KeptUniforms::WriteAll() {
  for (auto& [name, shader] : shaders_) {
    if (shader.dirtySince >= 0) Write(name, shader);
  }
}

void KeptUniforms::Write(const std::string& name, Shader& shader) {
  shader.dirtySince = -1;
  // What the user has written, and the program cannot read, is not to be lost.
  if (!enabled_ || shader.unreadable) return;
  const Status saved = SaveShaderValues(ShaderValuesFile(folder_, name), shader.values, shader.parameters);
  shader.watch.Accept();
  shader.problems = saved ? Diagnostics{} : saved.diagnostics();
  for (Diagnostic& problem : shader.problems) {
    problem.severity = Severity::Warning;
    problem.message += "; the shader's values are lost when the viewer ends";
  }
}

}  // namespace percale::viewer
