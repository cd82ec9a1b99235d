#include "apps/viewer/messages.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace percale;
using namespace percale::viewer;

TEST_CASE("messages hold until they are over, and the history keeps them after that") {
  std::vector<std::string> told;
  Messages messages(
      [&](const std::string& source, const Diagnostic* d) { told.push_back(source + (d ? ": " + d->message : "")); });
  messages.Set("scene", {MakeError("bad"), MakeWarning("odd")});
  CHECK(messages.list().size() == 2);
  CHECK(told == std::vector<std::string>{"scene: bad", "scene: odd"});

  messages.Set("scene", {MakeError("bad"), MakeWarning("odd")});  // The same again is no news.
  CHECK(told.size() == 2);
  messages.Set("scene", {MakeWarning("odd")});
  CHECK(messages.list().size() == 1);
  CHECK(messages.history().size() == 2);
  CHECK(told.size() == 2);

  messages.Set("shader", {});  // Of which nothing was said.
  CHECK(told.size() == 2);
  messages.Set("scene", {});
  CHECK(told.back() == "scene");
  CHECK_FALSE(messages.Holds("scene"));
  CHECK(messages.list().empty());

  messages.Set("scene", {MakeError("bad")});  // It comes back: that is news, but no new line of the history.
  CHECK(told.back() == "scene: bad");
  CHECK(messages.list().size() == 1);
  REQUIRE(messages.history().size() == 2);
  CHECK(messages.history().back().diagnostic.message == "bad");
  CHECK(messages.history().back().count == 2);
}

TEST_CASE("warnings that a slider leaves behind are one line of the history") {
  Messages messages;
  messages.Set("scene", {MakeError("bad")});
  for (int ks = 0; ks < 100; ++ks) messages.Set("settings", {MakeWarning("ks = " + std::to_string(ks))}, true);
  REQUIRE(messages.list().size() == 2);
  CHECK(messages.list()[1].diagnostic.message == "ks = 99");
  messages.Set("settings", {}, true);
  CHECK(messages.list().size() == 1);
  REQUIRE(messages.history().size() == 2);
  CHECK(messages.history()[1].diagnostic.message == "ks = 99");
  CHECK(messages.history()[1].count == 100);
}

TEST_CASE("a session's messages are never lost") {
  Messages messages;
  for (int i = 0; i < 1000; ++i) messages.Set("scene", {MakeError("error " + std::to_string(i))});
  CHECK(messages.list().size() == 1);
  CHECK(messages.history().size() == 1000);
}

TEST_CASE("a line of the console says when, what, of what, where and how often") {
  Message message{"scene", MakeError("a.json", "bad"), 12.34, 3};
  message.diagnostic.place.line = 3;
  message.diagnostic.place.column = 7;
  CHECK(ConsoleLine(message) == "12.3 s  error  scene  a.json:3:7: bad  (3 times)");
}
