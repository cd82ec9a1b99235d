#include "apps/viewer/file_watch.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

using namespace percale::viewer;
namespace fs = std::filesystem;

namespace {

struct TemporaryFile {
  fs::path path = fs::temp_directory_path() / ("percale-watch-" + std::to_string(std::random_device{}()));
  ~TemporaryFile() {
    std::error_code error;
    fs::remove(path, error);
  }
  void Write(const std::string& text) const { std::ofstream(path) << text; }
};

}  // namespace

TEST_CASE("a change is told once, when the file has settled") {
  const TemporaryFile file;
  file.Write("a");
  FileWatch watch(file.path);
  CHECK_FALSE(watch.Changed());
  file.Write("ab");
  CHECK_FALSE(watch.Changed());  // It may still be being written.
  CHECK(watch.Changed());
  CHECK_FALSE(watch.Changed());

  file.Write("abc");
  CHECK_FALSE(watch.Changed());
  file.Write("abcd");
  CHECK_FALSE(watch.Changed());
  CHECK(watch.Changed());
}

TEST_CASE("a file that is away for a moment has not changed") {
  const TemporaryFile file;
  file.Write("a");
  const auto time = fs::last_write_time(file.path);
  FileWatch watch(file.path);
  fs::remove(file.path);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(watch.Changed());
  file.Write("a");
  fs::last_write_time(file.path, time);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(watch.Changed());

  fs::remove(file.path);
  CHECK_FALSE(watch.Changed());
  file.Write("other");
  CHECK_FALSE(watch.Changed());
  CHECK(watch.Changed());
}

TEST_CASE("what was accepted is known, and no file never changes") {
  const TemporaryFile file;
  file.Write("a");
  FileWatch watch(file.path);
  file.Write("ab");
  watch.Accept();
  CHECK_FALSE(watch.Changed());
  CHECK_FALSE(watch.Changed());
  FileWatch none;
  CHECK_FALSE(none.Changed());
}
