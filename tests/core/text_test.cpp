#include "core/text.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "core/memory.h"
#include "math/splitmix64.h"

namespace percale {
namespace {

TEST_CASE("Numbers survive the way through text to the bit") {
  SplitMix64 random(1);
  for (int k = 0; k < 20000; ++k) {
    const std::uint64_t bits = random.Next();
    double number = 0;
    std::memcpy(&number, &bits, sizeof number);
    if (!std::isfinite(number) || std::abs(number) < std::numeric_limits<double>::min()) continue;
    const std::string text = FormatNumber(number);
    const auto read = ParseNumber(text);
    REQUIRE_MESSAGE(read.has_value(), text);
    CHECK_MESSAGE(*read == number, text);
  }
}

TEST_CASE("Numbers are written as people write them") {
  CHECK(FormatNumber(0.1) == "0.1");
  CHECK(FormatNumber(5000) == "5000");
  CHECK(FormatNumber(-9.8) == "-9.8");
  CHECK(FormatNumber(1e12) == "1000000000000");
  CHECK(FormatNumber(1e20) == "1e20");
  CHECK(FormatNumber(1e-7) == "1e-7");
  CHECK(FormatNumber(0) == "0");
  CHECK(std::signbit(*ParseNumber(FormatNumber(-0.0))));
  CHECK(FormatNumber(std::nan("")) == "NaN");
}

TEST_CASE("Numbers are read as people type them") {
  struct Case {
    const char* text;
    double number;
  };
  const Case cases[] = {{".5", 0.5}, {"-.5", -0.5},  {"+.5", 0.5},   {"1.", 1},
                        {"+5", 5},   {"1.e3", 1000}, {"-1.5", -1.5}, {"5e3", 5000}};
  for (const Case& typed : cases) {
    CAPTURE(typed.text);
    REQUIRE(ParseTypedNumber(typed.text).has_value());
    CHECK(*ParseTypedNumber(typed.text) == typed.number);
  }
  for (const char* bad : {"", ".", "-", "+", "+-1", "-+1", "-.", "1e", ".e3", "1..", "1,5", "nan", "5k", "0x1"}) {
    CHECK_MESSAGE(!ParseTypedNumber(bad).has_value(), bad);
  }
}

TEST_CASE("Only JSON's numbers are numbers") {
  for (const char* good : {"0", "-1", "2.5", "1e3", "1E+3", "-0.5e-2", "123456789012345678901234567890"}) {
    CHECK_MESSAGE(ParseNumber(good).has_value(), good);
  }
  for (const char* bad :
       {"", "-", "+1", ".5", "1.", "01", "0x10", "1e", "1e+", "nan", "inf", "1 ", " 1", "1,5", "1e400", "5k"}) {
    CHECK_MESSAGE(!ParseNumber(bad).has_value(), bad);
  }
}

TEST_CASE("Rounded advice never exceeds what it was rounded from, and is near it") {
  SplitMix64 random(2);
  for (int k = 0; k < 5000; ++k) {
    const double number = std::pow(10.0, 24 * random.NextUnit() - 12);
    for (const int digits : {1, 3, 4}) {
      const double rounded = RoundDown(number, digits);
      CHECK(rounded <= number);
      CHECK(rounded >= number * (1 - 1.0001 * std::pow(10.0, 1 - digits)));
    }
  }
  CHECK(RoundDown(0, 3) == 0);
}

TEST_CASE("Quoted text has no bare control characters and is cut between characters") {
  CHECK(Quote("a\"b\\\n\x01") == "\"a\\\"b\\\\\\n\\u0001\"");
  CHECK(Quote("abcdef", 3) == "\"abc...\"");
  CHECK(Quote("ab\xc3\xa9", 3) == "\"ab...\"");
}

TEST_CASE("The nearest word is the one that was mistyped") {
  constexpr std::array<std::string_view, 6> kKnown = {"density",          "damping",        "ks",
                                                      "num_width_points", "enable_bending", "width"};
  CHECK(Nearest("densty", kKnown) == "density");
  CHECK(Nearest("Density", kKnown) == "density");
  CHECK(Nearest("dampnig", kKnown) == "damping");
  CHECK(Nearest("numWidthPoints", kKnown) == "num_width_points");
  CHECK(Nearest("enable_bend", kKnown) == "enable_bending");
  CHECK(Nearest("kss", kKnown) == "ks");
  CHECK(Nearest("temperature", kKnown).empty());
  CHECK(Nearest("", kKnown).empty());
  CHECK(Nearest(std::string(100000, 'x'), kKnown).empty());
}

#if defined(__linux__)
TEST_CASE("The machine has some memory, and a scene of the course fits into it") {
  CHECK(AvailableMemory() > (64u << 20));
}
#endif

}  // namespace
}  // namespace percale
