#include "apps/cli/platform.h"

#include <csignal>
#include <cstdlib>
#include <system_error>

#include "io/atomic_file.h"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <io.h>
#include <windows.h>
// after windows.h
#include <shellapi.h>
#else
#include <sys/ioctl.h>
#include <unistd.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t interrupted = 0;  // written by the handler

void OnInterrupt(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

std::vector<std::string> Utf8Arguments(int argc, char** argv) {
  std::vector<std::string> arguments;
#ifdef _WIN32
  (void)argv;
  int count = 0;
  wchar_t** wide = CommandLineToArgvW(GetCommandLineW(), &count);
  for (int i = 1; wide && i < count; ++i) arguments.push_back(PathText(fs::path(wide[i])));
  if (wide) LocalFree(wide);
  (void)argc;
#else
  for (int i = 1; i < argc; ++i) arguments.emplace_back(argv[i]);
#endif
  return arguments;
}

fs::path ExecutablePath() {
  std::error_code code;
#ifdef _WIN32
  std::wstring name(32768, L'\0');
  name.resize(GetModuleFileNameW(nullptr, name.data(), DWORD(name.size())));
  return fs::path(name);
#elif defined(__APPLE__)
  std::uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::string name(size, '\0');
  if (_NSGetExecutablePath(name.data(), &size) != 0) return {};
  return fs::weakly_canonical(name.c_str(), code);
#else
  const fs::path path = fs::read_symlink("/proc/self/exe", code);
  return code ? fs::path() : path;
#endif
}

bool IsTerminal(std::FILE* stream) {
#ifdef _WIN32
  return _isatty(_fileno(stream)) != 0;
#else
  return isatty(fileno(stream)) != 0;
#endif
}

int TerminalWidth() {
#ifndef _WIN32
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
#endif
  return 80;
}

void LetWritesFail() {
#ifdef SIGPIPE
  std::signal(SIGPIPE, SIG_IGN);
#endif
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

void CatchInterrupts() {
  // A program started in the background with interrupts ignored leaves them so.
  if (std::signal(SIGINT, OnInterrupt) == SIG_IGN) std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, OnInterrupt);
#ifdef SIGHUP
  if (std::signal(SIGHUP, OnInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
#endif
}

bool Interrupted() {
  return interrupted != 0;
}

bool HasDisplay() {
#if defined(_WIN32) || defined(__APPLE__)
  return true;
#else
  return Environment("DISPLAY") || Environment("WAYLAND_DISPLAY");
#endif
}

std::optional<std::string> Environment(const char* name) {
  const char* value = std::getenv(name);
  return value && *value ? std::optional<std::string>(value) : std::nullopt;
}

fs::path ConfigFolder() {
  if (const auto folder = Environment("PERCALE_CONFIG_DIR")) return TextPath(*folder);
#if defined(_WIN32)
  if (const wchar_t* folder = _wgetenv(L"APPDATA")) return fs::path(folder) / "percale";
#elif defined(__APPLE__)
  if (const auto home = Environment("HOME")) return TextPath(*home) / "Library" / "Application Support" / "percale";
#else
  // A relative path is to be ignored, says the specification.
  if (const auto folder = Environment("XDG_CONFIG_HOME"); folder && TextPath(*folder).is_absolute())
    return TextPath(*folder) / "percale";
  if (const auto home = Environment("HOME")) return TextPath(*home) / ".config" / "percale";
#endif
  return {};
}

std::string SystemName() {
  std::string name =
#if defined(_WIN32)
      "Windows";
#elif defined(__APPLE__)
      "macOS";
#elif defined(__linux__)
      "Linux";
#else
      "an unknown system";
#endif
#if defined(__x86_64__) || defined(_M_X64)
  name += " x86-64";
#elif defined(__aarch64__) || defined(_M_ARM64)
  name += " arm64";
#endif
  return name;
}

}  // namespace percale::cli
