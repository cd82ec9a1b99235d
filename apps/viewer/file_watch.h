#pragma once
/// \file
/// Notices when a file has been saved.

#include <cstdint>
#include <filesystem>

namespace percale::viewer {

class FileWatch {
 public:
  FileWatch() = default;
  /// Watches `file` from its present state on.
  explicit FileWatch(std::filesystem::path file);

  /// Looks at the file; call it a few times per second. True once for each change, as soon as two
  /// looks on end have found the same, so that a file is not read while it is being written. A file
  /// that is away for a moment, as when an editor replaces it, is no change.
  bool Changed();
  /// From now on the present state counts as known.
  void Accept();

 private:
  struct Stamp {
    bool exists = false;
    std::filesystem::file_time_type time{};
    std::uintmax_t size = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  Stamp Look() const;

  std::filesystem::path file_;
  Stamp known_, last_;
};

}  // namespace percale::viewer
