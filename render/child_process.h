#pragma once
/// \file
/// Another program that is fed through its standard input. One source file per platform.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "percale/diagnostic.h"

namespace percale {

class ChildProcess {
 public:
  /// Starts `program` with `arguments`, which no shell sees. It reads what Write gives it; what it
  /// prints as errors is kept.
  static Result<ChildProcess> Start(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~ChildProcess();  ///< Without Finish: ends the program.
  ChildProcess(ChildProcess&&) noexcept;
  ChildProcess& operator=(ChildProcess&&) noexcept;

  /// Hands over all bytes. Returns false when the program no longer reads; Finish says why.
  bool Write(const void* data, std::size_t size);
  /// Closes its input and waits for its end. Returns true when it ended well, else puts what it said
  /// (or how it ended) into `reason`.
  bool Finish(std::string& reason);

 private:
  struct Impl;
  explicit ChildProcess(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The program of that name in the folders of PATH, or an empty path.
std::filesystem::path FindProgram(const std::string& name);

}  // namespace percale
