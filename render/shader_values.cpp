#include "render/shader_values.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/json_document.h"

namespace percale {
namespace {

const ShaderParameter* Find(std::span<const ShaderParameter> parameters, std::string_view name) {
  for (const ShaderParameter& parameter : parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

/// What a file should say of a parameter. (Three numbers do for every kind: so are those of unknown ones kept.)
std::string Expected(const ShaderParameter* parameter) {
  if (!parameter) return "a number, true, false or an array of three numbers";
  const std::string range = FormatNumber(double(parameter->min)) + ".." + FormatNumber(double(parameter->max));
  switch (parameter->type) {
    case ShaderParameter::Type::Bool:
      return "true or false";
    case ShaderParameter::Type::Vector:
      return "an array of three numbers " + range;
    case ShaderParameter::Type::Int:
      return "a whole number " + range;
    case ShaderParameter::Type::Float:
      break;
  }
  return "a number " + range;
}

std::optional<UniformValue> Read(const JsonDocument& doc, JsonIndex value, const ShaderParameter* parameter) {
  using Type = ShaderParameter::Type;
  UniformValue read{};
  const bool isBoolean = doc.Kind(value) == JsonKind::Boolean, isNumber = doc.Kind(value) == JsonKind::Number;
  if (isBoolean || isNumber) {
    if (parameter && (parameter->type == Type::Vector || (parameter->type == Type::Bool) != isBoolean))
      return std::nullopt;
    read[0] = isBoolean ? (doc.Boolean(value) ? 1.0f : 0.0f) : static_cast<float>(doc.Number(value));
  } else {
    const std::vector<JsonIndex> three = doc.Children(value);
    if (doc.Kind(value) != JsonKind::Array || three.size() != 3) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      if (doc.Kind(three[i]) != JsonKind::Number) return std::nullopt;
      read[i] = static_cast<float>(doc.Number(three[i]));
    }
  }
  if (!parameter || parameter->type == Type::Bool) return read;
  for (std::size_t i = 0; i < (parameter->type == Type::Vector ? 3u : 1u); ++i) {
    if (!(read[i] >= parameter->min && read[i] <= parameter->max)) return std::nullopt;
    if (parameter->type == Type::Int && read[i] != std::floor(read[i])) return std::nullopt;
  }
  return read;
}

std::string Format(const UniformValue& value, const ShaderParameter* parameter) {
  if (parameter && parameter->type == ShaderParameter::Type::Bool) return value[0] != 0 ? "true" : "false";
  if (parameter && parameter->type != ShaderParameter::Type::Vector) return FormatNumber(double(value[0]));
  return "[" + FormatNumber(double(value[0])) + ", " + FormatNumber(double(value[1])) + ", " +
         FormatNumber(double(value[2])) + "]";
}

}  // namespace

std::filesystem::path ShaderValuesFile(const std::filesystem::path& folder, const std::string& shader) {
  return folder / (shader + ".json");
}

Result<UniformValues> LoadShaderValues(const std::filesystem::path& file, std::span<const ShaderParameter> parameters) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return UniformValues();
  const Result<JsonDocument> loaded = JsonDocument::Load(file);
  if (!loaded) return loaded.diagnostics();
  const JsonDocument& doc = *loaded;
  if (doc.Kind(0) != JsonKind::Object)
    return doc.About(0, Severity::Error, "expected an object of a shader's values, got " + doc.Source(0));
  std::vector<std::string_view> names;
  for (const ShaderParameter& parameter : parameters) names.push_back(parameter.name);
  UniformValues values;
  Diagnostics warnings;
  for (const JsonIndex member : doc.Children(0)) {
    const std::string& name = doc.Key(member);
    const ShaderParameter* parameter = Find(parameters, name);
    const std::optional<UniformValue> value = Read(doc, member, parameter);
    if (value)
      values[name] = *value;
    else
      warnings.push_back(doc.About(member, Severity::Warning,
                                   name + ": expected " + Expected(parameter) + ", got " + doc.Source(member)));
    if (!parameter && value && !DidYouMean(name, names).empty())
      warnings.push_back(
          doc.AboutKey(member, Severity::Warning, "the shader has no parameter " + name + DidYouMean(name, names)));
  }
  return {std::move(values), std::move(warnings)};
}

Status SaveShaderValues(const std::filesystem::path& file, const UniformValues& values,
                        std::span<const ShaderParameter> parameters) {
  if (values.empty()) {
    std::error_code error;
    std::filesystem::remove(file, error);
    if (error) return MakeError(PathText(file), "cannot be removed: " + error.message());
    return Ok();
  }
  std::string text = "{";
  for (const auto& [name, value] : values)
    text += (text.size() > 1 ? ",\n  " : "\n  ") + Quote(name) + ": " + Format(value, Find(parameters, name));
  return WriteFile(file, text + "\n}\n");
}

}  // namespace percale
