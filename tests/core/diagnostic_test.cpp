#include "percale/diagnostic.h"

#include <doctest/doctest.h>

#include <string>

namespace percale {
namespace {

TEST_CASE("A message names the place, the severity and marks the column") {
  const Diagnostic error{Severity::Error,
                         {"scene/a.json", 7, 11},
                         "/cloth/ks: expected a number >= 0 N/m, got \"5k\"",
                         "    \"ks\": \"5k\",",
                         11};
  CHECK(Format(error) ==
        "scene/a.json:7:11: error: /cloth/ks: expected a number >= 0 N/m, got \"5k\"\n"
        "  7 |     \"ks\": \"5k\",\n"
        "    |           ^\n");
}

TEST_CASE("The caret stands below its column however many digits the line number has") {
  for (const int line : {1, 42, 12345}) {
    const std::string text = Format(Diagnostic{Severity::Warning, {"f", line, 3}, "m", "abcdef", 3});
    const std::size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
    const std::size_t marked = text.find('c', first) - first, caret = text.find('^', second) - second;
    CHECK(marked == caret);
  }
}

TEST_CASE("Parts of a place that are not known are left out") {
  CHECK(Format(MakeError("no file here")) == "error: no file here\n");
  CHECK(Format(MakeError("a.json", "empty")) == "a.json: error: empty\n");
  CHECK(Format(Diagnostic{Severity::Note, {"a.json", 3, 0}, "m", {}, 0}) == "a.json:3: note: m\n");
}

TEST_CASE("A quoted line cannot drive the terminal, and tabs keep the caret in place") {
  const std::string text = Format(Diagnostic{Severity::Error, {"f", 1, 3}, "m", "\t\x1b[31mred", 3});
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK(text.find('\t') == std::string::npos);
}

TEST_CASE("Only errors make a failure") {
  CHECK_FALSE(HasErrors({}));
  CHECK_FALSE(HasErrors({MakeWarning("w")}));
  CHECK(HasErrors({MakeWarning("w"), MakeError("e")}));
}

TEST_CASE("A result holds a value with warnings, or errors") {
  const Result<int> good(5, {MakeWarning("w")});
  REQUIRE(good);
  CHECK(*good == 5);
  CHECK(good.diagnostics().size() == 1);
  const Result<int> bad(MakeError("e"));
  CHECK_FALSE(bad.ok());
  CHECK(bad.diagnostics().front().message == "e");
}

}  // namespace
}  // namespace percale
