#pragma once
/// \file
/// Shaders, found by file name: a file shaders/NAME.frag is a shader called NAME; its vertex shader
/// is NAME.vert where there is one, else Default.vert. A new file is a new shader. Files
/// NAME.sphere.frag, NAME.plane.frag and NAME.background.frag, each optional and each with a vertex
/// shader by the same rule, are parts of it, for the other surfaces of a picture.
///
/// A uniform with a comment behind it is a parameter that the user can set:
///
///     uniform float u_shininess;  // @range 1 256 @default 32 @label Shininess
///     uniform vec3 u_upper;       // @color @default 0 0.34 0.72 @label Upper colour
///     uniform int u_axis;         // @choices Horizontal|Vertical @default 0
///     uniform bool u_lit;         // @default 1 @label Lit @help Shade the cloth
///
/// Types: float, int, bool, vec3. Without @default the initialiser counts, else the lower end.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"

namespace percale {

/// The value of a parameter; numbers and switches use the first component.
using UniformValue = std::array<float, 3>;
/// Values by the name of the uniform ("u_shininess"). A name that a shader lacks is ignored there.
using UniformValues = std::map<std::string, UniformValue, std::less<>>;

struct ShaderParameter {
  enum class Type { Float, Int, Bool, Vector };
  std::string name;   ///< Of the uniform.
  std::string label;  ///< For panels; the name without "u_" where the file gives none.
  std::string help;   ///< May be empty.
  Type type = Type::Float;
  bool color = false;  ///< A Vector that is a colour, 0..1 each.
  float min = 0;       ///< Of each component.
  float max = 1;
  std::vector<std::string> choices;  ///< Names of the values 0, 1, ...; empty: a plain number.
  UniformValue defaultValue{};
};

/// The parameters that the text of a shader declares. `file` stands for it in the messages about
/// annotations that cannot be understood, which are added to `diagnostics` as warnings.
std::vector<ShaderParameter> ParseShaderParameters(std::string_view text, const std::string& file,
                                                   Diagnostics& diagnostics);

/// What is drawn: a shader may have a part of its own for each.
enum class Surface { Cloth, Sphere, Plane, Background };

/// Names of the shaders in a folder: the course's in its order (Wireframe, Normal, Diffuse, Phong,
/// Texture, Bump, Displacement, Mirror, Flag), then the others by alphabet. Needs no graphics.
std::vector<std::string> ListShaders(const std::filesystem::path& folder);

/// A compiled shader; `program` is an OpenGL name.
struct ShaderProgram {
  unsigned program = 0;
  std::vector<ShaderParameter> parameters;
  std::map<std::string, int, std::less<>> locations;  ///< Of the active uniforms.

  /// Location of a uniform, -1 when the shader does not use it.
  int Location(std::string_view uniform) const {
    const auto found = locations.find(uniform);
    return found == locations.end() ? -1 : found->second;
  }
};

/// Compiles shaders when they are first asked for, and again when their files change. All but
/// names() need the OpenGL context current in which the library was made; so does destruction.
class ShaderLibrary {
 public:
  explicit ShaderLibrary(std::filesystem::path folder);
  ~ShaderLibrary();
  ShaderLibrary(ShaderLibrary&&) noexcept;
  ShaderLibrary& operator=(ShaderLibrary&&) noexcept;

  const std::vector<std::string>& names() const;
  const std::filesystem::path& folder() const;

  /// The program of a shader for a surface: of its part where it has one, else its own, but none for
  /// a background. When the files cannot be compiled: the last good one, or null when there never was
  /// one; Problems(name) says why. The pointer stays valid until the next ReloadChanged or Reload.
  const ShaderProgram* Find(std::string_view name, Surface surface = Surface::Cloth);

  /// Errors and warnings of the latest files of a shader, each with file, line and the driver's
  /// words; an unknown name gives one error with the nearest name. Empty: all is well.
  const Diagnostics& Problems(std::string_view name);

  /// Parameters of a shader and of its parts, without compiling it; empty for an unknown name. Valid until the next
  /// ReloadChanged or Reload.
  std::span<const ShaderParameter> Parameters(std::string_view name);

  /// Looks at the times of the files, included ones too, and compiles again what has changed since. New and removed
  /// files change names(). Cheap: call it a few times per second. Returns whether anything changed.
  bool ReloadChanged();
  /// Compiles everything that is in use again.
  void Reload();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
