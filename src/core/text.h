#pragma once
/// \file
/// Small things about text that several rooms need: numbers as text and back whatever the locale,
/// quoting, and the nearest known word for "did you mean".

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace percale {

/// Whether it is one of 0 to 9, whatever the locale.
inline bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

/// The number with the fewest digits that read back the same, as JSON writes it: "0.1", "5000",
/// "1e12". NaN and infinities give "NaN", "Infinity", "-Infinity", which are not JSON.
std::string FormatNumber(double number);

/// The largest number of `digits` significant digits that is at most `number`, which must be >= 0:
/// for advice such as "at most 0.0102", which must hold when followed to the letter.
double RoundDown(double number, int digits);

/// Reads a number as JSON writes them, the whole of `text`; nothing if it is anything else, or
/// beyond the range of double.
std::optional<double> ParseNumber(std::string_view text);

/// Reads a number as people type it: as in JSON, or with a plus, without the zero before the point,
/// or without digits behind it.
std::optional<double> ParseTypedNumber(std::string_view text);

/// The text in double quotes as JSON writes it, control characters escaped. With `limit` > 0 at
/// most that many bytes of the text (whole characters), then "...".
std::string Quote(std::string_view text, std::size_t limit = 0);

/// Characters of UTF-8 text: the columns that it takes where each is one wide.
std::size_t CountCharacters(std::string_view text);

/// The word of `known` that is so near to `word` that it was probably meant, or empty. Capitals,
/// '-' and '_' make no difference.
std::string_view Nearest(std::string_view word, std::span<const std::string_view> known);

/// " (did you mean `NEAREST`?)", or nothing where no word is near.
std::string DidYouMean(std::string_view word, std::span<const std::string_view> known);

/// printf into a string.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
Text(const char* format, ...);

}  // namespace percale
