#include "apps/viewer/messages.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace percale;
using namespace percale::viewer;

TEST_CASE("messages hold until they are over, and are kept after that") {
  std::vector<std::string> told;
  Messages messages(
      [&](const std::string& source, const Diagnostic* d) { told.push_back(source + (d ? ": " + d->message : "")); });
  messages.Set("scene", {MakeError("bad"), MakeWarning("odd")});
  CHECK(messages.HoldingCount() == 2);
  CHECK(told == std::vector<std::string>{"scene: bad", "scene: odd"});

  messages.Set("scene", {MakeError("bad"), MakeWarning("odd")});  // The same again is no news.
  CHECK(told.size() == 2);
  messages.Set("scene", {MakeWarning("odd")});
  CHECK(messages.HoldingCount() == 1);
  CHECK(messages.list().size() == 2);
  CHECK(told.size() == 2);

  messages.Set("shader", {});  // Of which nothing was said.
  CHECK(told.size() == 2);
  messages.Set("scene", {});
  CHECK(told.back() == "scene");
  CHECK_FALSE(messages.Holds("scene"));
  CHECK(messages.list().size() == 2);

  messages.Set("scene", {MakeError("bad")});  // It comes back: that is news.
  CHECK(told.back() == "scene: bad");
  CHECK(messages.HoldingCount() == 1);
  messages.ClearOver();
  REQUIRE(messages.list().size() == 1);
  CHECK_FALSE(messages.list()[0].over);
}

TEST_CASE("warnings that a slider leaves behind are not kept") {
  Messages messages;
  for (int ks = 0; ks < 100; ++ks) messages.Set("settings", {MakeWarning("ks = " + std::to_string(ks))}, true);
  REQUIRE(messages.list().size() == 1);
  CHECK(messages.list()[0].diagnostic.message == "ks = 99");
  messages.Set("settings", {}, true);
  CHECK(messages.list().empty());
}

TEST_CASE("what is over does not grow without end") {
  Messages messages;
  for (int i = 0; i < 1000; ++i) messages.Set("scene", {MakeError("error " + std::to_string(i))});
  CHECK(messages.HoldingCount() == 1);
  CHECK(messages.list().back().diagnostic.message == "error 999");
  CHECK(messages.list().size() < 300);
}
