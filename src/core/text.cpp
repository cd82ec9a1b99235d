#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <locale>
#include <numeric>
#include <sstream>
#include <vector>

namespace percale {
namespace {

std::string WithPrecision(double number, int digits) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << number;
  return out.str();
}

double ReadClassic(std::string_view text, bool& ok) {
  std::istringstream in{std::string(text)};
  in.imbue(std::locale::classic());
  double number = 0;
  in >> number;
  ok = !in.fail() && in.peek() == std::istringstream::traits_type::eof() && std::isfinite(number);
  return number;
}

/// Whether `text` is a number by JSON's grammar: no leading '+', zeros or '.', no hexadecimal.
bool IsJsonNumber(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && IsDigit(text[i])) ++i;
    return i - begin;
  };
  if (i < text.size() && text[i] == '-') ++i;
  const std::size_t first = i, whole = digits();
  if (whole == 0 || (whole > 1 && text[first] == '0')) return false;
  if (i < text.size() && text[i] == '.') {
    ++i;
    if (digits() == 0) return false;
  }
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == text.size();
}

std::string Folded(std::string_view word) {
  std::string out;
  for (const char c : word) {
    if (c == '_' || c == '-' || c == ' ') continue;
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return out;
}

/// Edits that turn `a` into `b`: insert, delete, replace, or swap two neighbours (optimal string
/// alignment, Damerau 1964).
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string FormatNumber(double number) {
  if (std::isnan(number)) return "NaN";
  if (std::isinf(number)) return number > 0 ? "Infinity" : "-Infinity";
  if (number == 0) return std::signbit(number) ? "-0.0" : "0";
  // 15 digits always survive the way through a double; 17 always carry a double through text.
  std::string out;
  for (int digits = 15; digits <= 17; ++digits) {
    out = WithPrecision(number, digits);
    bool ok = false;
    if (ReadClassic(out, ok) == number) break;
  }
  // 1e+06 -> 1e6
  if (const std::size_t e = out.find('e'); e != std::string::npos) {
    std::size_t digits = e + 1;
    if (out[digits] == '+')
      out.erase(digits, 1);
    else
      ++digits;
    while (digits + 1 < out.size() && out[digits] == '0') out.erase(digits, 1);
  }
  return out;
}

double RoundDown(double number, int digits) {
  if (!(number > 0) || !std::isfinite(number)) return number;
  bool ok = false;
  double rounded = ReadClassic(WithPrecision(number, digits), ok);
  if (rounded <= number) return rounded;
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - (digits - 1));
  rounded = ReadClassic(WithPrecision(rounded - unit, digits), ok);
  return std::min(rounded, number);
}

std::optional<double> ParseNumber(std::string_view text) {
  if (!IsJsonNumber(text)) return std::nullopt;
  bool ok = false;
  const double number = ReadClassic(text, ok);
  // Streams fail on numbers too small for a double as on those too large; the small ones are 0.
  if (!ok && std::abs(number) < std::numeric_limits<double>::min()) return number;
  return ok ? std::optional(number) : std::nullopt;
}

std::optional<double> ParseTypedNumber(std::string_view text) {
  std::string number(text);
  if (number.size() > 1 && number[0] == '+' && number[1] != '-') number.erase(0, 1);
  const std::size_t point = number.find('.');
  if (point != std::string::npos) {
    const bool before = point > 0 && IsDigit(number[point - 1]);
    const bool behind = point + 1 < number.size() && IsDigit(number[point + 1]);
    if (before && !behind) number.insert(point + 1, "0");
    if (behind && !before) number.insert(point, "0");
  }
  return ParseNumber(number);
}

std::size_t CountCharacters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string Quote(std::string_view text, std::size_t limit) {
  std::string_view rest;
  if (limit > 0 && text.size() > limit) {
    while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xc0) == 0x80) --limit;
    rest = "...";
    text = text.substr(0, limit);
  }
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (byte < 0x20 || byte == 0x7f) {
          out += "\\u00";
          out += kHex[byte >> 4];
          out += kHex[byte & 15];
        } else {
          out += c;
        }
    }
  }
  return out + std::string(rest) + "\"";
}

std::string_view Nearest(std::string_view word, std::span<const std::string_view> known) {
  constexpr std::size_t kLongestWord = 64;  // beyond it nothing was mistyped
  if (word.empty() || word.size() > kLongestWord) return {};
  const std::string folded = Folded(word);
  std::string_view best;
  std::size_t bestDistance = std::numeric_limits<std::size_t>::max();
  for (const std::string_view candidate : known) {
    const std::string other = Folded(candidate);
    const std::size_t distance = EditDistance(folded, other);
    // One slip for short words, one in three letters for long ones; a beginning counts as near.
    const std::size_t longest = std::max(folded.size(), other.size());
    const bool begins = folded.size() >= 3 && other.compare(0, folded.size(), folded) == 0;
    const std::size_t allowed = longest <= 2 ? longest - 1 : std::max<std::size_t>(1, longest / 3);
    const std::size_t judged = begins ? std::min<std::size_t>(distance, 1) : distance;
    if (judged <= allowed && judged < bestDistance) {
      best = candidate;
      bestDistance = judged;
    }
  }
  return best;
}

std::string DidYouMean(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view nearest = Nearest(word, known);
  return nearest.empty() ? std::string() : " (did you mean `" + std::string(nearest) + "`?)";
}

std::string Text(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(length > 0 ? std::size_t(length) : 0, '\0');
  if (length > 0) std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

}  // namespace percale
