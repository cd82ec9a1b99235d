#include "apps/viewer/ui_settings.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

using namespace percale;
using namespace percale::viewer;

namespace {

namespace fs = std::filesystem;

/// A folder that is gone after the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("percale-settings-" + std::to_string(std::rand()));
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

TEST_CASE("settings come back as they were saved") {
  const Folder folder;
  UiSettings settings;
  settings.window = {-3, 40, 900, 700};
  settings.panelsVisible = false;
  settings.consoleVisible = true;
  settings.panelsOpen = {{"Gravity", false}, {"Wind", true}};
  Remember(settings.recentScenes, "/a \"quoted\".json");
  Remember(settings.recentScenes, "/b.json");
  Remember(settings.recentCommands, "action pause");
  settings.usedHints = {"help", "pause"};
  const fs::path file = folder.path / "new" / "viewer.json";
  REQUIRE(SaveUiSettings(file, settings));
  Diagnostics problems;
  const UiSettings read = LoadUiSettings(file, problems);
  CHECK(problems.empty());
  REQUIRE(read.window);
  CHECK(read.window->x == -3);
  CHECK(read.window->height == 700);
  CHECK_FALSE(read.panelsVisible);
  CHECK(read.consoleVisible);
  CHECK(read.panelsOpen == settings.panelsOpen);
  CHECK(read.recentScenes == std::vector<std::string>{"/b.json", "/a \"quoted\".json"});
  CHECK(read.recentCommands == settings.recentCommands);
  CHECK(read.usedHints == settings.usedHints);
}

TEST_CASE("settings that cannot be read are warned of, and are the defaults") {
  const Folder folder;
  fs::create_directories(folder.path);
  const fs::path file = folder.path / "viewer.json";
  Diagnostics problems;
  CHECK(LoadUiSettings(file, problems).panelsVisible);  // There is none.
  CHECK(problems.empty());
  for (const char* text : {"", "{", "[1]", "{\"panels_visible\": 1}", "{\"window\": {\"x\": 1e99}}", "\xff"}) {
    CAPTURE(text);
    std::ofstream(file, std::ios::binary) << text;
    problems.clear();
    CHECK(LoadUiSettings(file, problems).panelsVisible);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].severity == Severity::Warning);
    CHECK_FALSE(problems[0].place.file.empty());
  }
  problems.clear();
  CHECK(LoadUiSettings(folder.path, problems).panelsVisible);
  CHECK(problems.size() == 1);
}

TEST_CASE("what is recent is remembered once, the latest first, and not without end") {
  std::vector<std::string> recent;
  for (int i = 0; i < 100; ++i) Remember(recent, std::to_string(i % 50));
  CHECK(recent.front() == "49");
  CHECK(recent.size() < 20);
  Remember(recent, "45");
  CHECK(recent[0] == "45");
  CHECK(recent[1] == "49");
}
