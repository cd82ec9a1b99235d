// Malformed scenes, several hundred, made from a valid one: whatever is done to it, the loader
// neither crashes nor accepts nonsense, and it points at what is wrong.

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "io/scene_text.h"
#include "math/splitmix64.h"
#include "percale/scene_file.h"

namespace percale {
namespace {

using test::Contains;
using test::OneOfEach;
using test::PlaceAt;
using test::SceneText;
using test::Write;

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// What holds for every text: an error names a place in it, and what loads is a good scene.
void CheckLaws(const std::string& text, const Result<Scene>& result) {
  for (const Diagnostic& d : result.diagnostics()) {
    CHECK_FALSE(d.message.empty());
    CHECK(d.place.file == "test");
    const bool nothingThere = text.empty() || text == "\xef\xbb\xbf";
    if (!nothingThere && d.severity != Severity::Note) {
      INFO(Format(d));
      CHECK(d.place.line > 0);
      // A byte-order mark and broken UTF-8 count as other tools count them, or not; a line is a line.
      CHECK(d.place.line <= std::count(text.begin(), text.end(), '\n') + 1);
      if (text.find_first_of("\xef\xff\xfe\xc0\xf5") == std::string::npos) CHECK(Contains(text, d.place));
      CHECK(d.caret >= 1);
      CHECK(d.excerpt.size() < 600);
    }
  }
  if (!result) {
    CHECK(HasErrors(result.diagnostics()));
    return;
  }
  CHECK_FALSE(HasErrors(result.diagnostics()));
  CHECK_FALSE(HasErrors(CheckScene(*result)));
  const Result<Scene> again = ParseScene(FormatScene(*result), "again");
  REQUIRE(again);
  CHECK(test::Same(*result, *again));
}

/// Requires that `text` is refused by an error about `path` at the offset.
void CheckRefused(const SceneText& written, const std::string& path, std::size_t offset) {
  const Result<Scene> result = ParseScene(written.text, "test");
  CheckLaws(written.text, result);
  INFO(Format(result.diagnostics()));
  REQUIRE_FALSE(result.ok());
  const Place expected = PlaceAt(written.text, offset);
  const auto fits = [&](const Diagnostic& d) {
    return d.severity == Severity::Error && StartsWith(d.message, path + ": ") && d.place.line == expected.line &&
           d.place.column == expected.column;
  };
  CHECK_MESSAGE(std::any_of(result.diagnostics().begin(), result.diagnostics().end(), fits),
                path << " at " << expected.line << ":" << expected.column);
}

TEST_CASE("The text that the corpus is made from is a good scene, with every place known") {
  const SceneText good = Write(OneOfEach());
  Origins origins;
  const Result<Scene> result = ParseScene(good.text, "test", &origins);
  REQUIRE_MESSAGE(result.ok(), Format(result.diagnostics()));
  // Its engine has no patches, no ropes, and no colliders but spheres and planes.
  for (const Diagnostic& d : result.diagnostics()) {
    CHECK((StartsWith(d.message, "/patch: only the engine") || StartsWith(d.message, "/tether: only the engine") ||
           StartsWith(d.message, "/collider: only the engine")));
  }
  CHECK(test::Same(*result, OneOfEach()));
  for (const Parameter& p : Parameters()) {
    if (!IsHeeded(p, OneOfEach())) continue;
    const std::string path = "/" + std::string(p.group) + "/" + std::string(p.name);
    const std::string canonical =
        FindGroup(p.group)->isArray ? "/" + std::string(p.group) + "/0/" + std::string(p.name) : path;
    REQUIRE_MESSAGE(origins.count(canonical) == 1, canonical);
    const Place expected = PlaceAt(good.text, good.at.at(path));
    CHECK(origins[canonical].line == expected.line);
    CHECK(origins[canonical].column == expected.column);
    CHECK(origins[canonical].file == "test");
  }
}

TEST_CASE("Every parameter with every wrong value is refused at that value, by name") {
  int refused = 0;
  const auto refuse = [&](const Parameter& p, const std::string& value, const std::string& element = "",
                          std::size_t inside = 0) {
    const std::string path = "/" + std::string(p.group) + "/" + std::string(p.name);
    CAPTURE(path);
    CAPTURE(value);
    const SceneText written = Write(OneOfEach(p.engine.value_or(Engine::Springs)), path, value);
    CheckRefused(written, path + element, written.at.at(path) + inside);
    ++refused;
  };
  for (const Parameter& p : Parameters()) {
    for (const char* value : {"null", "{}", "{\"a\": 1}", "1e308", "-1e308", "123456789012345678901234567890", "NaN",
                              "-Infinity", "1e999", "0x10", "5k", "undefined", ".5", "+1"}) {
      refuse(p, value);
    }
    if (p.kind != ValueKind::Boolean) refuse(p, "true");
    if (p.kind != ValueKind::Text) refuse(p, "\"no such thing\"");
    if (p.kind != ValueKind::GridPoints) refuse(p, "[]"), refuse(p, "[[0, 0]]");
    if (p.kind == ValueKind::Number || p.kind == ValueKind::Integer) {
      if (std::isfinite(p.min)) refuse(p, FormatValue(p.min - 1));
      if (std::isfinite(p.max)) refuse(p, FormatValue(p.max * 2 + 1));
      if (p.minExclusive) refuse(p, FormatValue(p.min));
      refuse(p, "[1]");
    }
    if (p.kind == ValueKind::Integer) refuse(p, "2.5"), refuse(p, "0.000001");
    if (p.kind == ValueKind::Vector) {
      refuse(p, "[1, 2]");
      refuse(p, "[1, 2, 3, 4]");
      refuse(p, "[1e308, 0, 0]");
      refuse(p, "[0, -1e308, 0]");
      refuse(p, "[0, \"x\", 0]", "/1", 4);
      refuse(p, "[0, 0, null]", "/2", 7);
      refuse(p, "[0, NaN, 0]", "/1", 4);
    }
    if (p.kind == ValueKind::GridPoints) {
      refuse(p, "[[0, 0], [1]]", "/1", 9);
      refuse(p, "[[0, 0], \"7\"]", "/1", 9);
      refuse(p, "[7.5, 0]", "/0", 1);
      refuse(p, "[[0.5, 0]]", "/0/0", 2);
      refuse(p, "[[0, 1e10]]", "/0/1", 5);
      refuse(p, "[[0, \"1\"]]", "/0/1", 5);
      const bool two = p.name == "rectangle";
      refuse(p, two ? "[[0, -1], 0]" : "[[0, -1]]", "/0", 1);
      refuse(p, two ? "[[50, 0], 0]" : "[[50, 0]]", "/0", 1);
      if (two) refuse(p, "[[0, 0]]");
    }
  }
  CHECK(refused >= 500);
  MESSAGE(refused << " wrong values refused");
}

TEST_CASE("A missing key is an error at its object if it is required, else its default") {
  for (const Parameter& p : Parameters()) {
    if (!IsHeeded(p, OneOfEach())) continue;
    const std::string object = "/" + std::string(p.group), path = object + "/" + std::string(p.name);
    CAPTURE(path);
    const SceneText written = Write(OneOfEach(), path);
    if (p.required) {
      CheckRefused(written, path, written.at.at(object));
    } else if (p.name != "pinned") {  // without pins the motion has nothing to move
      const Result<Scene> result = ParseScene(written.text, "test");
      REQUIRE_MESSAGE(result.ok(), Format(result.diagnostics()));
      if (p.name != "automatic" && p.name != "own_centre") CHECK(p.get(*result, 0) == DefaultValue(p));
    }
  }
}

TEST_CASE("A group that is no object is refused") {
  for (const ParameterGroup& group : ParameterGroups()) {
    const std::string path = "/" + std::string(group.name);
    CAPTURE(path);
    for (const char* value : {"null", "5", "true", "\"text\""}) {
      const SceneText written = Write(OneOfEach(), path, value);
      CheckRefused(written, path, written.at.at(path));
    }
    const SceneText array = Write(OneOfEach(), path, "[5]");
    CheckRefused(array, path + (group.isArray ? "/0" : ""), array.at.at(path) + (group.isArray ? 1 : 0));
  }
}

TEST_CASE("A text cut anywhere is refused inside itself") {
  const std::string text = Write(OneOfEach()).text;
  const std::size_t end = text.rfind('}');
  for (std::size_t length = 0; length <= end; ++length) {
    const std::string part = text.substr(0, length);
    const Result<Scene> result = ParseScene(part, "test");
    CAPTURE(length);
    REQUIRE_FALSE(result.ok());
    CheckLaws(part, result);
  }
}

TEST_CASE("Random damage is survived, and what still loads is a good scene") {
  SplitMix64 random(184);
  const std::string original = Write(OneOfEach()).text;
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random.Next() % n); };
  constexpr char kTokens[] = "{}[],:\"\\ \n0123456789.-+eEtfnu_/\x01\x7f";
  int failed = 0, loaded = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = original;
    for (std::size_t damage = 1 + below(3); damage > 0; --damage) {
      const std::size_t at = below(text.size());
      switch (below(6)) {
        case 0:
          text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
          break;
        case 1:
          text[at] = static_cast<char>(below(256));
          break;
        case 2:
          text.erase(at, 1 + below(8));
          break;
        case 3:
          text.insert(at, 1, kTokens[below(sizeof kTokens - 1)]);
          break;
        case 4:
          text.insert(at, text.substr(below(text.size()), below(40)));
          break;
        default:
          text[at] = kTokens[below(sizeof kTokens - 1)];
      }
    }
    CAPTURE(text);
    const Result<Scene> result = ParseScene(text, "test");
    CheckLaws(text, result);
    ++(result ? loaded : failed);
  }
  CHECK(failed > 2000);
  CHECK(loaded > 20);
}

TEST_CASE("Texts that are no scenes are refused, each with the remedy") {
  const struct {
    std::string text;
    const char* expected;
  } cases[] = {
      {"", "the file is empty"},
      {"\xef\xbb\xbf", "the file is empty"},
      {" \n\t\r\n ", "only white space"},
      {std::string(1000, '['), "at most 32 levels"},
      {std::string("\0\0\0\0", 4), "binary"},
      {std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "binary"},
      {std::string("\xff\xfe{\0}\0", 6), "UTF-16"},
      {std::string("\xfe\xff\0{\0}", 6), "UTF-16"},
      {std::string("{\0}\0", 4), "UTF-16"},
      {std::string("\0{\0}", 4), "UTF-16"},
      {std::string("\0\0\0{\0\0\0}", 8), "UTF-16 or UTF-32"},
      {std::string("{\0\0\0}\0\0\0", 8), "UTF-16 or UTF-32"},
      {"{\"_\": \"caf\xe9\"}", "not UTF-8"},
      {"{\"_\": \"\xc0\xaf\"}", "not UTF-8"},
      {"{\"_\": \"\xed\xa0\x80\"}", "not UTF-8"},
      {"{\"_\": \"\xf5\x80\x80\x80\"}", "not UTF-8"},
      {"[]", "expected a scene"},
      {"5", "expected a scene"},
      {"\"text\"", "expected a scene"},
      {"null", "expected a scene"},
      {"NaN", "which JSON does not have"},
      {"cloth", "double quotes"},
      {"{}", "/cloth: expected at least one cloth"},
      {"{\"cloth\": []}", "/cloth: expected at least one cloth"},
      {"{\"cloth\": {},}", "trailing comma"},
      {"{\"_\": [1, 2, ]}", "trailing comma"},
      {"{,}", "expected a key in double quotes"},
      {"{\"_\": 1 // note\n}", "begins with '_'"},
      {"# note\n{}", "begins with '_'"},
      {"{\"_\": /* note */ 1}", "begins with '_'"},
      {"{'_': 1}", "double quotes"},
      {"{\"_\": 'a'}", "double quotes"},
      {"{_: 1}", "double quotes"},
      {"{\"_\" 1}", "':' after the key"},
      {"{\"_\" = 1}", "':' after the key"},
      {"{\"_\": 1 \"_b\": 2}", "',' or '}'"},
      {"{\"_\": [1 2]}", "',' or ']'"},
      {"{\"_\": [1}", "',' or ']'"},
      {"{\"_\": {]}", "expected a key"},
      {"{\"_\": }", "expected a value"},
      {"{\"_\": ,}", "expected a value"},
      {"{\"_\": 1}}", "end of the file"},
      {"{\"_\": 1}{\"_\": 1}", "end of the file"},
      {"{\"_\": 01}", "leading zeros"},
      {"{\"_\": -01}", "leading zeros"},
      {"{\"_\": +1}", "leading '+'"},
      {"{\"_\": .5}", "0 before the point"},
      {"{\"_\": 5.}", "write a number like"},
      {"{\"_\": 1e}", "write a number like"},
      {"{\"_\": 1e+}", "write a number like"},
      {"{\"_\": --1}", "write a number like"},
      {"{\"_\": -}", "write a number like"},
      {"{\"_\": 1.2.3}", "write a number like"},
      {"{\"_\": 0x1F}", "write a number like"},
      {"{\"_\": 1_000}", "write a number like"},
      {"{\"_\": 1e400}", "beyond the largest number"},
      {"{\"_\": -1e400}", "beyond the largest number"},
      {"{\"_\": True}", "small letters"},
      {"{\"_\": None}", "small letters"},
      {"{\"_\": trueish}", "double quotes"},
      {"{\"_\": \"a\nb\"}", "does not end in its line"},
      {"{\"_\": \"a\tb\"}", "bare byte 0x09"},
      {"{\"_\": \"\\q\"}", "no escape \\q"},
      {"{\"_\": \"\\u12g4\"}", "four hexadecimal digits"},
      {"{\"_\": \"\\ud800\"}", "half of a pair"},
      {"{\"_\": \"abc", "never ends"},
      {"{\"_\": \"abc\\", "never ends"},
      {"{\"a\": 1, \"b\": 2, \"a\": 3}", "the key \"a\" is stated already, at 1:2"},
      {"{\"_\": {\"\": 1, \"\": 3}}", "stated already"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const Result<Scene> result = ParseScene(c.text, "test");
    REQUIRE_FALSE(result.ok());
    CheckLaws(c.text, result);
    const auto fits = [&](const Diagnostic& d) { return d.message.find(c.expected) != std::string::npos; };
    CHECK_MESSAGE(std::any_of(result.diagnostics().begin(), result.diagnostics().end(), fits),
                  "expected \"" << std::string(c.expected) << "\" in\n"
                                << Format(result.diagnostics()));
  }
}

TEST_CASE("Large texts take no longer than reading them") {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t kSize = 10'000'000;
  std::string brackets = "{\"_\": [", pins = "{\"cloth\": {\"pinned\": [";
  // Good but for every pin being outside the grid, and but for every cloth having too large a ks.
  std::string outside = Write(OneOfEach(), "/cloth/pinned", "[").text, many;
  outside.resize(outside.rfind('[', outside.find("enable_structural")) + 1);
  while (outside.size() < kSize / 4) outside += "[90, 90], ";
  outside +=
      "[0, 0]], \"enable_structural\": true, \"enable_shearing\": true, \"enable_bending\": true, \"damping\": 0, "
      "\"density\": 150, \"ks\": 5000}}";
  const std::string cloth =
      "{\"width\": 1, \"height\": 1, \"num_width_points\": 2, \"num_height_points\": 2, \"thickness\": 0.1, "
      "\"orientation\": 0, \"enable_structural\": true, \"enable_shearing\": true, \"enable_bending\": true, "
      "\"damping\": 0.2, \"density\": 1, \"ks\": 1e12}";
  while (many.size() < kSize / 4) many += cloth + ", ";
  many = "{\"cloth\": [" + many + cloth + "], \"sphere\": 5}";
  while (brackets.size() < kSize / 4) brackets += "[], ";
  while (pins.size() < kSize / 4) pins += "[\"x\", 0], ";
  const std::string texts[] = {
      std::string(kSize, ' '),
      std::string(kSize, '['),
      std::string(kSize, '\n'),
      std::string(kSize, ','),
      "\"" + std::string(kSize, 'x'),
      "{\"" + std::string(kSize, 'k') + "\": 5}",
      std::string(kSize, '9'),
      brackets + "0]}",
      outside,
      many,
      pins + "0]}}",
      std::string(kSize, '{'),
      "{" + std::string(kSize, ' ') + "\"cloth\": 5}",
  };
  for (const std::string& text : texts) {
    CAPTURE(text.substr(0, 30));
    const Result<Scene> result = ParseScene(text, "test");
    REQUIRE_FALSE(result.ok());
    CHECK(result.diagnostics().size() <= 1001);
    for (const Diagnostic& d : result.diagnostics()) CHECK(d.message.size() + d.excerpt.size() < 2000);
  }
  CHECK(ParseScene(outside, "test").diagnostics()[0].message.find("expected a point of the grid") != std::string::npos);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  CHECK(seconds.count() < 60);  // about 2 s; a loop over the square of the size would take hours
}

}  // namespace
}  // namespace percale
