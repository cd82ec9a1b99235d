#pragma once
/// \file
/// What differs between operating systems: terminals, signals, programs and displays.

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace percale::cli {

/// The command line without the program's name, as UTF-8.
std::vector<std::string> Utf8Arguments(int argc, char** argv);

/// Where the running program lies; empty when the system does not tell.
std::filesystem::path ExecutablePath();

/// Whether a person watches the stream.
bool IsTerminal(std::FILE* stream);
/// Columns of the terminal behind stderr; 80 when unknown.
int TerminalWidth();

/// A write into a pipe that nobody reads any more, or beyond the file size that the system allows
/// (ulimit -f), fails like any other instead of ending the program.
void LetWritesFail();
/// From now on the first Ctrl+C (or request to end) only sets a mark, so that what was done can be
/// kept. The second ends the program.
void CatchInterrupts();
bool Interrupted();

/// Whether a window can be expected to open.
bool HasDisplay();

/// An environment variable; nothing when it is not set or empty.
std::optional<std::string> Environment(const char* name);

/// The folder of the user's own settings and presets: PERCALE_CONFIG_DIR, or where the system keeps such
/// things. It need not exist yet; empty when the system does not tell.
std::filesystem::path ConfigFolder();

/// "Linux x86-64", "macOS arm64", ...
std::string SystemName();

}  // namespace percale::cli
