// Child processes on Windows, by the C library's pipes.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "render/child_process.h"

namespace percale {
namespace {

// Quoted for the command interpreter. Names with a quotation mark do not exist on Windows; a percent
// sign would be read as the start of a variable.
std::string Quoted(const std::string& argument) {
  return "\"" + argument + "\"";
}

}  // namespace

struct ChildProcess::Impl {
  std::FILE* pipe = nullptr;
  std::filesystem::path errors;

  ~Impl() {
    if (pipe) _pclose(pipe);
    std::error_code error;
    std::filesystem::remove(errors, error);
  }
};

ChildProcess::ChildProcess(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ChildProcess::~ChildProcess() = default;
ChildProcess::ChildProcess(ChildProcess&&) noexcept = default;
ChildProcess& ChildProcess::operator=(ChildProcess&&) noexcept = default;

Result<ChildProcess> ChildProcess::Start(const std::filesystem::path& program,
                                         const std::vector<std::string>& arguments) {
  auto impl = std::make_unique<Impl>();
  std::error_code error;
  impl->errors = std::filesystem::temp_directory_path(error) /
                 ("percale-" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + ".txt");
  std::string command = "\"" + Quoted(program.string());
  for (const std::string& argument : arguments) {
    if (argument.find_first_of("%\"") != std::string::npos) {
      return MakeError(argument,
                       "a name with % or \" cannot be handed to another program on Windows; choose another name");
    }
    command += " " + Quoted(argument);
  }
  command += " >NUL 2>" + Quoted(impl->errors.string()) + "\"";
  impl->pipe = _popen(command.c_str(), "wb");
  if (!impl->pipe) return MakeError(program.string(), "cannot be started");
  return ChildProcess(std::move(impl));
}

bool ChildProcess::Write(const void* data, std::size_t size) {
  return impl_->pipe && std::fwrite(data, 1, size, impl_->pipe) == size;
}

bool ChildProcess::Finish(std::string& reason) {
  if (!impl_->pipe) return false;
  const int code = _pclose(std::exchange(impl_->pipe, nullptr));
  if (code == 0) return true;
  std::ifstream in(impl_->errors);
  reason.assign(std::istreambuf_iterator<char>(in), {});
  if (reason.empty()) reason = "it ended with code " + std::to_string(code);
  return false;
}

std::filesystem::path FindProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ';');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / (name + ".exe");
    std::error_code error;
    if (std::filesystem::is_regular_file(candidate, error)) return candidate;
  }
  return {};
}

}  // namespace percale
