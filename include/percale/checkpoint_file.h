#pragma once
/// \file
/// Checkpoints: the state of a World in a file, from which it goes on to the same bits.

#include <filesystem>

#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale {

/// Writes a state (NAME.percale by custom), under a temporary name that is renamed when finished. On failure
/// nothing is left behind.
Status SaveCheckpoint(const std::filesystem::path& file, const WorldState& state);

/// Reads a checkpoint. Fails, with what was expected and found, on a file that is none, is of another
/// version, was cut short or changed, or holds what no World can be in.
Result<WorldState> LoadCheckpoint(const std::filesystem::path& file);

}  // namespace percale
