#pragma once
/// \file
/// Checkpoints: the state of a World in a file, from which it goes on to the same bits.

#include <filesystem>
#include <string>
#include <string_view>

#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale {

/// Writes a state (NAME.percale by custom), under a temporary name that is renamed when finished. On failure
/// nothing is left behind.
Status SaveCheckpoint(const std::filesystem::path& file, const WorldState& state);

/// Reads a checkpoint. Fails, with what was expected and found, on a file that is none, is of another
/// version, was cut short or changed, or holds what no World can be in.
Result<WorldState> LoadCheckpoint(const std::filesystem::path& file);

/// The same as bytes in memory; `name` stands for the file in messages.
std::string FormatCheckpoint(const WorldState& state);
/// The same with this text of its scene, which names the same files in another way.
std::string FormatCheckpoint(const WorldState& state, const std::string& sceneText);
Result<WorldState> ParseCheckpoint(std::string_view bytes, const std::string& name);

}  // namespace percale
