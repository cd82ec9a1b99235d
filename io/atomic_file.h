#pragma once
/// \file
/// Files that appear whole or not at all: written under a temporary name in the same folder, then
/// renamed. Devices and pipes (/dev/stdout, /dev/full) are written to straight.

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "percale/diagnostic.h"

namespace percale {

class AtomicFile {
 public:
  /// Opens a temporary file beside `file`, empty and ready to be written (binary). Fails, with
  /// place and remedy, when the folder is missing or not writable, or `file` is a folder or
  /// write-protected. A symbolic link is followed, so that the file it names is replaced.
  static Result<AtomicFile> Create(const std::filesystem::path& file);

  ~AtomicFile();  ///< Without Commit: removes the temporary file.
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;

  /// Where the data goes until Commit, with the extension of the target. A program that is to write
  /// the file itself is given this name, after Close.
  const std::filesystem::path& path() const { return temporary_; }
  /// Where the file will be, as asked for.
  const std::filesystem::path& target() const { return target_; }
  /// Whether the target is a device or pipe, which path() then names: nothing is renamed.
  bool straight() const { return straight_; }
  /// The open stream, for libraries that want one; null after Close. What they write unchecked is
  /// checked by Close.
  std::FILE* stream() { return stream_; }

  /// Appends bytes. After a failure every call fails.
  Status Write(const void* data, std::size_t bytes);
  Status Write(std::string_view text) { return Write(text.data(), text.size()); }
  /// Writes bytes at a position from the start, then returns to the end. Fails on pipes.
  Status WriteAt(long position, const void* data, std::size_t bytes);
  /// Flushes and closes the stream, keeping the temporary file. Fails when the disk is full.
  Status Close();
  /// Closes if need be, and puts the file in its place.
  Status Commit();
  /// The same under another name in the same folder.
  Status CommitAs(const std::filesystem::path& target);

 private:
  AtomicFile() = default;
  void Discard();
  Diagnostic Failure(int error) const;

  std::filesystem::path target_, final_, temporary_;  // final_: the target, symbolic links resolved
  std::FILE* stream_ = nullptr;
  int error_ = 0;  // errno of the first failed write
  bool failed_ = false;
  bool straight_ = false;
};

/// fopen for a path of any characters on any platform; errno says why it failed.
std::FILE* OpenFile(const std::filesystem::path& file, const char* mode);

/// The path as UTF-8 text, for messages.
std::string PathText(const std::filesystem::path& path);
/// The ending of the name, with its point, in small letters: ".csv" of "A.CSV".
std::string LowerExtension(const std::filesystem::path& path);

/// The file with that content, whole or not at all.
Status WriteFile(const std::filesystem::path& file, std::string_view content);

/// STEM-1.ENDING, STEM-2.ENDING, ...: the first that does not exist. Nor does STEM-N, which a film takes
/// that becomes a folder of pictures.
std::filesystem::path NumberedName(const std::filesystem::path& stem, const std::string& ending);

/// The path that UTF-8 text names.
std::filesystem::path TextPath(std::string_view text);

}  // namespace percale
