#include "io/json_document.h"

#include <doctest/doctest.h>

#include <string>

#include "io/scene_text.h"
#include "math/splitmix64.h"

namespace percale {
namespace {

TEST_CASE("A document holds what its text says") {
  const auto read = JsonDocument::Parse(
      "{\"number\": -1.5e2, \"yes\": true, \"no\": false, \"nothing\": null,\n \"text\": \"a\\\"\\u00e9\", \"list\": "
      "[1, [2, 3], {}], "
      "\"object\": {\"inner\": 7}}",
      "f");
  REQUIRE(read);
  const JsonDocument& d = *read;
  CHECK(d.Kind(0) == JsonKind::Object);
  CHECK(d.Children(0).size() == 7);
  CHECK(d.Number(d.Member(0, "number")) == -150);
  CHECK(d.Boolean(d.Member(0, "yes")));
  CHECK_FALSE(d.Boolean(d.Member(0, "no")));
  CHECK(d.Kind(d.Member(0, "nothing")) == JsonKind::Null);
  CHECK(d.Text(d.Member(0, "text")) == "a\"\xc3\xa9");
  const auto list = d.Children(d.Member(0, "list"));
  REQUIRE(list.size() == 3);
  CHECK(d.Children(list[1]).size() == 2);
  CHECK(d.Number(d.Children(list[1])[1]) == 3);
  CHECK(d.Kind(list[2]) == JsonKind::Object);
  CHECK(d.Children(list[2]).empty());
  CHECK(d.Number(d.Member(d.Member(0, "object"), "inner")) == 7);
  CHECK(d.Member(0, "inner") == 0);
  CHECK(d.Key(d.Member(0, "list")) == "list");
  CHECK(d.PlaceOf(d.Member(0, "text")).line == 2);
  CHECK(d.PlaceOf(d.Member(0, "text")).column == 10);
  CHECK(d.PlaceOfKey(d.Member(0, "text")).column == 2);
}

/// A random value as text, with random white space; the offsets of all values, in order.
void AppendRandom(SplitMix64& random, int depth, std::string& text, std::vector<std::size_t>& offsets) {
  const auto below = [&](std::uint64_t n) { return random.Next() % n; };
  const auto space = [&] {
    for (std::uint64_t k = below(3); k > 0; --k) text += " \n\t\r"[below(4)];
  };
  constexpr const char* kScalars[] = {"0",
                                      "-0.5",
                                      "12",
                                      "1e5",
                                      "-3.25E-2",
                                      "0.1e+1",
                                      "true",
                                      "false",
                                      "null",
                                      "\"\"",
                                      "\"a,b:[c]{}\"",
                                      "\"\\\"\\\\\"",
                                      "\"\xc3\xa9\xe2\x82\xac\\u00e9\""};
  space();
  offsets.push_back(text.size());
  const std::uint64_t kind = depth > 0 ? below(3) : 0;
  if (kind == 0) {
    text += kScalars[below(std::size(kScalars))];
  } else {
    text += kind == 1 ? '[' : '{';
    const std::uint64_t count = below(5);
    for (std::uint64_t k = 0; k < count; ++k) {
      if (k > 0) text += ',';
      space();
      if (kind == 2) {
        text += "\"k\\\\\xc3\xbc" + std::to_string(k) + "\"";
        space();
        text += ':';
      }
      AppendRandom(random, depth - 1, text, offsets);
    }
    space();
    text += kind == 1 ? ']' : '}';
  }
  space();
}

TEST_CASE("Every value of any text knows its place") {
  SplitMix64 random(7);
  for (int round = 0; round < 300; ++round) {
    std::string text;
    std::vector<std::size_t> offsets;
    AppendRandom(random, 5, text, offsets);
    CAPTURE(text);
    const auto read = JsonDocument::Parse(text, "f");
    REQUIRE_MESSAGE(read.ok(), Format(read.diagnostics()));
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const Place expected = test::PlaceAt(text, offsets[k]), found = read->PlaceOf(static_cast<JsonIndex>(k));
      CHECK(found.line == expected.line);
      CHECK(found.column == expected.column);
    }
  }
}

TEST_CASE("Places in long lines are right, and their excerpts short with the caret on the value") {
  std::string text = "{\"_\": \"";
  while (text.size() < 20000) text += "\xc3\xa9";
  text += "\", \"key\": 12345, \"_after\": \"" + std::string(20000, 'x') + "\"}";
  const auto read = JsonDocument::Parse(text, "f");
  REQUIRE(read);
  const Diagnostic d = read->About(read->Member(0, "key"), Severity::Error, "m");
  const Place expected = test::PlaceAt(text, text.find("12345"));
  CHECK(d.place.line == 1);
  CHECK(d.place.column == expected.column);
  CHECK(d.excerpt.size() < 300);
  const Place caret = test::PlaceAt(d.excerpt, d.excerpt.find("12345"));
  CHECK(d.caret == caret.column);
}

TEST_CASE("The 32nd level is read and the 33rd refused") {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  CHECK(JsonDocument::Parse(nested(32), "f").ok());
  const auto tooDeep = JsonDocument::Parse(nested(33), "f");
  REQUIRE_FALSE(tooDeep.ok());
  CHECK(tooDeep.diagnostics()[0].place.column == 33);
}

TEST_CASE("Every key stated twice is reported, at the second, but for comments") {
  CHECK(JsonDocument::Parse("{\"_\": 1, \"_\": 2, \"a\": {\"_c\": 1, \"_c\": 1}}", "f").ok());
  const auto read = JsonDocument::Parse("{\"a\": 1,\n\"a\": 2,\n\"b\": {\"a\": 1},\n\"a\": 3}", "f");
  REQUIRE_FALSE(read.ok());
  REQUIRE(read.diagnostics().size() == 2);
  CHECK(read.diagnostics()[0].place.line == 2);
  CHECK(read.diagnostics()[1].place.line == 4);
  CHECK(read.diagnostics()[1].message.find("at 1:2") != std::string::npos);
}

}  // namespace
}  // namespace percale
