#pragma once
/// \file
/// Presets: named sets of parameters, each a JSON file of its own (presets/NAME.json):
///
///     {"description": "Silk: light and supple", "set": {"cloth.density": 60, "simulation.gravity": [0, -9.8, 0]}}
///
/// Paths and values are those of ApplyAssignment; a path without an index concerns every object.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"

namespace percale {

struct PresetValue {
  std::string path;   ///< "cloth.ks"
  std::string value;  ///< As JSON.
  Place place;        ///< Of the value.
};

struct Preset {
  std::string name;  ///< Of the file, without its ending.
  std::string description;
  std::vector<PresetValue> values;
};

/// Reads a preset and checks every value of it; on failure all that is wrong, each with its place.
Result<Preset> LoadPreset(const std::filesystem::path& file);
Result<Preset> ParsePreset(const std::string& text, const std::filesystem::path& file);

/// The preset files (*.json) of some folders by name, those of an earlier folder first where a later one
/// has the same name. A folder that cannot be read has none.
std::map<std::string, std::filesystem::path> ListPresets(const std::vector<std::filesystem::path>& folders);

/// The preset that `name` means: one of those folders, or a file that exists where the name ends in
/// ".json". Fails, with the names there are, when there is none.
Result<Preset> FindPreset(std::string_view name, const std::vector<std::filesystem::path>& folders);

/// What a preset sets in one object of a scene.
struct PresetAssignment {
  std::string path;  ///< "/cloth/0/ks"
  const Parameter* parameter;
  int index;  ///< Of the object.
  Value value;
  Place place;  ///< In the preset's file.
};

/// All that a preset sets in a scene, in order; not what concerns objects that the scene has not.
std::vector<PresetAssignment> Assignments(const Preset& preset, const Scene& scene);

/// Sets what the scene's file does not state itself (`stated`), since the file wins over a preset.
/// Returns what was set; what was not goes into `givesWay`, if given.
std::vector<PresetAssignment> ApplyBelow(const Preset& preset, const Origins& stated, Scene& scene,
                                         std::vector<PresetAssignment>* givesWay = nullptr);

/// A preset file that turns `from` into `to`, as far as parameters go; the camera is left out, and so
/// are objects that only one of them has.
std::string FormatPreset(std::string_view description, const Scene& from, const Scene& to);

}  // namespace percale
