#pragma once
/// \file
/// Runs a session log (session_log.h) again, without a window, and holds every state that it tells
/// against what comes out.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "percale/checkpoint_file.h"
#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale::viewer {

struct ReplayOptions {
  int threads = 0;  ///< 0: as many as the machine has cores. The result does not depend on it.
  /// Reads the state that a file holds, for `load`; by default a checkpoint.
  std::function<Result<WorldState>(const std::filesystem::path&)> loadState = LoadCheckpoint;
  /// Called after each frame and command with the World as it is. False: stop.
  std::function<bool(const World&)> onFrame = {};
};

struct ReplayResult {
  int commands = 0;        ///< Carried out.
  int states = 0;          ///< Compared.
  int frames = 0;          ///< Simulated.
  std::uint64_t hash = 0;  ///< Of the last state.
  bool complete = false;   ///< The log has its last line, and nobody has stopped.
  std::string difference;  ///< Where the log tells another state than came out; empty: nowhere.
};

/// Fails when the file cannot be read, is no session log or one of another version, or says what cannot
/// be, with the place. A log that breaks off is run as far as it goes, with a warning beside the result.
Result<ReplayResult> Replay(const std::filesystem::path& file, const ReplayOptions& options);

}  // namespace percale::viewer
