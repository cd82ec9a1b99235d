#include "core/base64.h"

#include <doctest/doctest.h>

#include <string>

#include "math/splitmix64.h"

namespace percale {
namespace {

TEST_CASE("Base64 is that of RFC 4648, section 10") {
  const char* const pairs[][2] = {{"", ""},
                                  {"f", "Zg=="},
                                  {"fo", "Zm8="},
                                  {"foo", "Zm9v"},
                                  {"foob", "Zm9vYg=="},
                                  {"fooba", "Zm9vYmE="},
                                  {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : pairs) {
    CHECK(ToBase64(bytes) == text);
    CHECK(FromBase64(text) == bytes);
  }
}

TEST_CASE("All bytes survive the way through base64") {
  SplitMix64 random(1);
  for (std::size_t size = 0; size < 300; ++size) {
    std::string bytes;
    while (bytes.size() < size) bytes += static_cast<char>(random.Next());
    CHECK(FromBase64(ToBase64(bytes)) == bytes);
  }
}

TEST_CASE("What is no base64 is refused") {
  for (const char* text :
       {"Z", "Zg", "Zg=", "Zg==\n", "Zm9v Zg=", "Zg==Zm9v", "Z===", "====", "Zm-_", "\xff\xff\xff\xff"})
    CHECK_FALSE(FromBase64(text));
}

}  // namespace
}  // namespace percale
