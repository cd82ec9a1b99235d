// Child processes where there is POSIX.

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "io/atomic_file.h"
#include "render/child_process.h"

extern char** environ;

namespace percale {
namespace {

// While it lives, a write to a pipe that nobody reads fails with EPIPE instead of ending this
// program. Only this thread is concerned: the signal goes to the thread that wrote.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    wasPending_ = sigismember(&pending, SIGPIPE) == 1;
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    if (!wasPending_ && sigismember(&pending, SIGPIPE) == 1) {
      int signal = 0;
      sigwait(&pipe_, &signal);
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_, before_;
  bool wasPending_ = false;
};

}  // namespace

struct ChildProcess::Impl {
  pid_t pid = -1;
  int input = -1;
  std::FILE* errors = nullptr;

  ~Impl() {
    CloseInput();
    if (pid > 0) {
      kill(pid, SIGKILL);
      Wait();
    }
    if (errors) std::fclose(errors);
  }
  void CloseInput() {
    if (input >= 0) close(input);
    input = -1;
  }
  int Wait() {
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    pid = -1;
    return status;
  }
};

ChildProcess::ChildProcess(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ChildProcess::~ChildProcess() = default;
ChildProcess::ChildProcess(ChildProcess&&) noexcept = default;
ChildProcess& ChildProcess::operator=(ChildProcess&&) noexcept = default;

Result<ChildProcess> ChildProcess::Start(const std::filesystem::path& program,
                                         const std::vector<std::string>& arguments) {
  const auto fail = [&](int error) {
    return MakeError(PathText(program), std::string("cannot be started: ") + std::strerror(error));
  };
  auto impl = std::make_unique<Impl>();
  impl->errors = std::tmpfile();
  if (!impl->errors) return fail(errno);
  int ends[2];
  if (pipe(ends) != 0) return fail(errno);
  // Else another child, started meanwhile, would hold the pipe open.
  for (const int end : {ends[0], ends[1], fileno(impl->errors)}) fcntl(end, F_SETFD, FD_CLOEXEC);
  impl->input = ends[1];

  std::string name = program.string();
  std::vector<std::string> copies = arguments;
  std::vector<char*> argv{name.data()};
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(impl->errors), 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process group of its own: Ctrl + C reaches this program alone, which then closes the film
  // in good order.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  const int error = posix_spawn(&impl->pid, name.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (error != 0) {
    impl->pid = -1;
    return fail(error);
  }
  return ChildProcess(std::move(impl));
}

bool ChildProcess::Write(const void* data, std::size_t size) {
  if (impl_->input < 0) return false;
  const NoPipeSignal guard;
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(impl_->input, bytes, size);
    if (written < 0) {
      if (errno == EINTR) continue;
      impl_->CloseInput();
      return false;
    }
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool ChildProcess::Finish(std::string& reason) {
  impl_->CloseInput();
  const int status = impl_->Wait();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  // The last line says most: those before it are often about its consequences.
  reason.clear();
  std::rewind(impl_->errors);
  char block[4096];
  while (const std::size_t size = std::fread(block, 1, sizeof block, impl_->errors)) reason.append(block, size);
  if (reason.size() > 2000) reason = "..." + reason.substr(reason.size() - 2000);
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '\r')) reason.pop_back();
  std::replace(reason.begin(), reason.end(), '\n', ';');
  if (reason.empty()) {
    reason = WIFSIGNALED(status) ? "it was ended by signal " + std::to_string(WTERMSIG(status))
                                 : "it ended with code " + std::to_string(WEXITSTATUS(status));
  }
  return false;
}

std::filesystem::path FindProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code error;
    if (std::filesystem::is_regular_file(candidate, error) && access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

}  // namespace percale
