#pragma once
/// \file
/// Presets (io/preset_file.h) in a session: applying one, and saving what was changed as one.

#include <filesystem>
#include <string>
#include <vector>

namespace percale::viewer {

class Session;

/// Sets what the preset file states, or tells what is wrong with it.
void ApplyPreset(const std::filesystem::path& file, Session& session);

/// Writes the parameters that differ from the scene file as preset `name` into `folder`; without a name
/// it is called after the scene. Never replaces a file. Returns whether it was written; else a message
/// says why not.
bool SavePreset(const std::string& name, const std::filesystem::path& folder, Session& session);

}  // namespace percale::viewer
