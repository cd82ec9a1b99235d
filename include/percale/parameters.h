#pragma once
/// \file
/// Every parameter of a scene, described once. From this table come the loader's checks, `--set`,
/// the JSON schema, the viewer's sliders and tooltips, and the reference page.

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/scene.h"

namespace percale {

enum class ValueKind {
  Number,      ///< double
  Integer,     ///< double holding a whole number; `choices`, if any, name 0, 1, ...
  Boolean,     ///< bool
  Choice,      ///< string, one of `choices`
  Text,        ///< string
  Vector,      ///< Vec3, in JSON an array of three numbers; `min` and `max` hold for each component
  GridPoints,  ///< vector<GridPoint>, in JSON an array of [i, j]
};

using Value = std::variant<double, bool, std::string, Vec3, std::vector<GridPoint>>;

/// What a change of the parameter does to a running World, from the least to the most.
enum class Effect {
  View,     ///< Nothing: only pictures of it change.
  Live,     ///< Acts at once, the state is kept.
  Rebuild,  ///< The cloth is another one: it starts anew.
};

struct Parameter {
  std::string_view group;  ///< "cloth", "sphere", ...: the key of the object that holds it.
  std::string_view name;   ///< "ks": its key there.
  std::string_view label;  ///< "Spring constant": for panels.
  ValueKind kind;
  std::string_view unit;  ///< "N/m"; empty for a pure number.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool minExclusive = false;  ///< `min` itself is out of range.
  bool required = false;      ///< A scene file must state it; see IsRequired.
  double typicalMin = 0;      ///< Range of a slider; equal ends: no typical range.
  double typicalMax = 0;
  bool logarithmic = false;  ///< The slider's scale.
  std::string_view help;     ///< One sentence with typical values.
  std::span<const std::string_view> choices = {};
  Effect effect = Effect::Live;
  std::optional<Engine> engine = {};  ///< The only engine that heeds it.
  /// Reads and writes it in object `index` of its group; the index is ignored where the group is a
  /// single object. `set` takes a value that `CheckValue` accepts.
  Value (*get)(const Scene&, std::size_t index) = nullptr;
  void (*set)(Scene&, std::size_t index, const Value&) = nullptr;
  /// Sets it, and others to what belongs to the new value, as a user's choice does: another fabric brings its
  /// constants. Null where no other depends on it.
  void (*choose)(Scene&, std::size_t index, const Value&) = nullptr;
};

/// Sets a parameter as a user's choice does. The value must be one that `CheckValue` accepts.
void Choose(const Parameter& parameter, Scene& scene, std::size_t index, const Value& value);

/// A kind of object in a scene file.
struct ParameterGroup {
  std::string_view name;
  bool isArray;   ///< A file may hold several, and `get`/`set` take an index.
  bool required;  ///< A file must hold at least one.
  std::string_view help;
  std::size_t (*count)(const Scene&);
  void (*resize)(Scene&, std::size_t);  ///< Appends default objects or drops the last ones.
};

/// All parameters, group by group, in the order of the reference page.
std::span<const Parameter> Parameters();
std::span<const ParameterGroup> ParameterGroups();

/// The group or parameter of that name, or null.
const ParameterGroup* FindGroup(std::string_view name);
const Parameter* FindParameter(std::string_view group, std::string_view name);

/// A value in which two scenes differ.
struct Difference {
  const Parameter* parameter = nullptr;
  std::size_t index = 0;  ///< Of the object in its group.
};

/// Every value in which two scenes differ, in the order of Parameters(). Of an object that only one of them has, all.
std::vector<Difference> Differences(const Scene& a, const Scene& b);

/// The greatest effect of a change of settings; nothing where there is none.
std::optional<Effect> EffectOf(const Scene& before, const Scene& after);

/// The value that an object of the group has when nothing is said, in a scene for the engine that heeds it.
Value DefaultValue(const Parameter& parameter);

/// Whether the scene's engine heeds it.
bool IsHeeded(const Parameter& parameter, const Scene& scene);
/// Whether the scene's file must state it: cloths of the course must state everything, those of fabric nothing.
bool IsRequired(const Parameter& parameter, const Scene& scene);

/// What is wrong with `value` for `parameter` ("expected a number >= 0 N/m, got -5"), or nothing.
std::optional<std::string> CheckValue(const Parameter& parameter, const Value& value);

/// "a number >= 0 N/m", "one of exact, linear, powers, brute", ...
std::string DescribeExpected(const Parameter& parameter);

/// The value as JSON text, numbers with the fewest digits that read back the same.
std::string FormatValue(const Value& value);

/// Applies one assignment "PATH=VALUE" of a command line, VALUE in JSON or a bare word:
/// "cloth.ks=500" (every cloth), "cloth.1.ks=500" (the second), "wind.velocity=[2,0,0]".
/// The result says which file-style paths ("/cloth/0/ks") were set.
Result<std::vector<std::string>> ApplyAssignment(Scene& scene, std::string_view assignment);

/// Everything wrong with a scene as a whole: each value against its range, and what concerns
/// several values (pins outside the grid, a grid beyond memory, motions of unknown cloths).
/// Warnings name settings that cannot go well: ks above the stable limit, thickness above the
/// spacing, density 0, each with the largest sensible value.
Diagnostics CheckScene(const Scene& scene);

}  // namespace percale
