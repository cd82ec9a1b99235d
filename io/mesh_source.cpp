#include "io/mesh_source.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <system_error>

#include "core/text.h"
#include "io/atomic_file.h"
#include "mesh/mesh_problems.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestMesh = std::uint64_t{4} << 30;  // [byte]

bool IsLineBreak(char c) {
  return c == '\n' || c == '\r';
}
bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
/// Not the first byte of a character in UTF-8.
bool IsLaterByte(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

/// What a terminal can show of it in any encoding: one mark for each character that is not ASCII.
std::string Ascii(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x80)
      out += c;
    else if (!IsLaterByte(c))
      out += '?';
  }
  return out;
}

std::size_t Characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return !IsLaterByte(c); }));
}

/// 10^0 to 10^22, which are exact in double.
constexpr std::array<double, 23> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                            1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

}  // namespace

Result<MeshSource> MeshSource::Load(const fs::path& file) {
  MeshSource source;
  source.file_ = PathText(file);
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (!fs::exists(status)) return MakeError(source.file_, "there is no such file; check the name and the folder");
  if (fs::is_directory(status)) return MakeError(source.file_, "expected a mesh file, got a folder; name a file in it");
  if (!fs::is_regular_file(status)) return MakeError(source.file_, "expected a mesh file, got a device or pipe");
  const std::uint64_t size = fs::file_size(file, code);
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(OpenFile(file, "rb"), &std::fclose);
  if (!stream || code) {
    return MakeError(source.file_,
                     "cannot be read: " + std::generic_category().message(errno) + "; check its permissions");
  }
  if (size > kLargestMesh) {
    return MakeError(source.file_, "expected a mesh of at most 4 GB, got " + std::to_string(size >> 30) + " GB");
  }
  if (size == 0) return MakeError(source.file_, "the file is empty; expected a mesh");
  source.bytes_.resize(static_cast<std::size_t>(size));
  const std::size_t read = std::fread(source.bytes_.data(), 1, source.bytes_.size(), stream.get());
  if (read != source.bytes_.size()) {
    return MakeError(source.file_, "reading stopped after " + std::to_string(read) + " of " + std::to_string(size) +
                                       " bytes; the file changes or its disk fails");
  }
  return source;
}

Diagnostic MeshSource::At(std::size_t offset, Severity severity, std::string message) const {
  // Of a long line this many characters are shown, so many of them before the place.
  constexpr std::size_t kShown = 110, kBefore = 60;
  offset = std::min(offset, bytes_.size());
  const std::string_view text(bytes_);
  std::size_t line = bytes_.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;  // a byte-order mark is no character
  int number = 1;
  for (std::size_t i = line; i < offset; ++i) {
    if (text[i] != '\n' && (text[i] != '\r' || (i + 1 < text.size() && text[i + 1] == '\n'))) continue;
    ++number;
    line = i + 1;
  }
  const std::size_t end = std::min(text.find_first_of("\r\n", offset), text.size());
  const std::string_view before = text.substr(line, std::max(offset, line) - line);
  const std::size_t column = Characters(before) + 1;

  Diagnostic diagnostic{severity, {file_, number, static_cast<int>(column)}, std::move(message), {}, 0};
  const bool cutBegin = before.size() > kShown - 10;
  const std::string shown = cutBegin ? "..." + Ascii(before.substr(before.size() - kBefore)) : Ascii(before);
  const std::string_view after = text.substr(offset, end - offset);
  const std::size_t room = shown.size() < kShown ? kShown - shown.size() : 0;
  diagnostic.excerpt = shown + Ascii(after.substr(0, room)) + (after.size() > room ? "..." : "");
  diagnostic.caret = static_cast<int>(shown.size()) + 1;
  return diagnostic;
}

Diagnostic MeshSource::AtByte(std::size_t offset, Severity severity, std::string message) const {
  return {severity, {file_, 0, 0}, "byte " + std::to_string(offset) + ": " + std::move(message), {}, 0};
}

MeshWords::MeshWords(std::string_view text, bool continued) : text_(text), continued_(continued) {
  if (text_.substr(0, 3) == "\xef\xbb\xbf") cursor_ = 3;
}

bool MeshWords::IsContinuation(std::size_t i) const {
  return continued_ && text_[i] == '\\' && i + 1 < text_.size() && IsLineBreak(text_[i + 1]);
}

void MeshWords::SkipBlank() {
  while (cursor_ < text_.size()) {
    if (IsContinuation(cursor_)) {
      ++cursor_;
      NextLine();
    } else if (IsBlank(text_[cursor_])) {
      ++cursor_;
    } else {
      return;
    }
  }
}

std::size_t MeshWords::Position() {
  SkipBlank();
  return cursor_;
}

std::string_view MeshWords::Next(bool comments) {
  SkipBlank();
  const std::size_t begin = cursor_;
  if (comments && begin < text_.size() && text_[begin] == '#') return {};
  while (cursor_ < text_.size() && !IsBlank(text_[cursor_]) && !IsLineBreak(text_[cursor_]) && !IsContinuation(cursor_))
    ++cursor_;
  return text_.substr(begin, cursor_ - begin);
}

std::string_view MeshWords::Rest() {
  SkipBlank();
  const std::size_t begin = cursor_;
  while (cursor_ < text_.size() && !IsLineBreak(text_[cursor_])) ++cursor_;
  std::size_t end = cursor_;
  while (end > begin && IsBlank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

void MeshWords::NextLine() {
  bool comment = false;  // these are not continued: "# /\_/\" is a cat
  while (cursor_ < text_.size() && !IsLineBreak(text_[cursor_])) {
    if (text_[cursor_] == '#')
      comment = comment || cursor_ == 0 || IsBlank(text_[cursor_ - 1]) || IsLineBreak(text_[cursor_ - 1]);
    if (!comment && IsContinuation(cursor_)) {  // the next line is a part of this one
      cursor_ += text_.substr(cursor_ + 1, 2) == "\r\n" ? 3 : 2;
      continue;
    }
    ++cursor_;
  }
  if (cursor_ < text_.size()) cursor_ += text_.substr(cursor_, 2) == "\r\n" ? 2 : 1;
}

std::optional<double> MeshNumber(std::string_view word) {
  constexpr std::size_t kLongest = 1000;
  if (word.size() > kLongest) return std::nullopt;
  std::size_t i = 0;
  const bool negative = i < word.size() && word[i] == '-';
  if (i < word.size() && (word[i] == '-' || word[i] == '+')) ++i;

  std::uint64_t mantissa = 0;  // of the first digits that count
  int digits = 0, counted = 0, exponent = 0;
  const auto readDigits = [&](int step) {
    const std::size_t begin = i;
    for (; i < word.size() && IsDigit(word[i]); ++i) {
      ++digits;
      if (counted < 19) {
        mantissa = 10 * mantissa + static_cast<std::uint64_t>(word[i] - '0');
        counted += mantissa > 0 ? 1 : 0;
        exponent += step;
      } else {
        counted = 20;  // more than fit
      }
    }
    return word.substr(begin, i - begin);
  };
  std::string_view whole = readDigits(0), fraction;
  if (i < word.size() && word[i] == '.') {
    ++i;
    fraction = readDigits(-1);
  }
  if (digits == 0) return std::nullopt;
  int power = 0;
  if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
    ++i;
    const bool down = i < word.size() && word[i] == '-';
    if (i < word.size() && (word[i] == '-' || word[i] == '+')) ++i;
    const std::size_t begin = i;
    for (; i < word.size() && IsDigit(word[i]); ++i) power = std::min(10 * power + (word[i] - '0'), 99999);
    if (i == begin) return std::nullopt;
    power = down ? -power : power;
  }
  if (i != word.size()) return std::nullopt;

  // Both factors are exact, so that their product or quotient is rounded once (Clinger 1990, "How to read floating
  // point numbers accurately").
  const int all = exponent + power;
  if (counted <= 19 && mantissa <= (std::uint64_t{1} << 53) && all >= -22 && all <= 22) {
    const double number = static_cast<double>(mantissa);
    const double scaled = all < 0 ? number / kPowers[std::size_t(-all)] : number * kPowers[std::size_t(all)];
    return negative ? -scaled : scaled;
  }
  while (whole.size() > 1 && whole[0] == '0') whole.remove_prefix(1);
  std::string plain = negative ? "-" : "";
  plain += whole.empty() ? "0" : whole;
  if (!fraction.empty()) plain += "." + std::string(fraction);
  plain += "e" + std::to_string(power);
  if (const auto number = ParseNumber(plain)) return number;
  return negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

std::string Shown(std::string_view word) {
  return Quote(Ascii(word.substr(0, 200)), 40);
}

std::string NotANumber(std::string_view word, const std::string& what) {
  if (word.empty()) return "expected " + what + ", but the line ends";
  const std::string got = "expected " + what + ", got " + Shown(word);
  std::string small;
  for (const char c : word.substr(0, 10)) {
    if (c != '-' && c != '+') small += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  if (small.substr(0, 3) == "nan" || small.substr(0, 3) == "inf" || small.substr(0, 3) == "1.#") {
    return got + "; state a finite number, or remove what refers to it";
  }
  if (word.find(',') != std::string_view::npos)
    return got + "; write decimals with a point, and spaces between numbers";
  return got + "; write numbers like 0.5 or -1e-3";
}

std::optional<std::string> CoordinateProblem(double value, double scale) {
  if (std::abs(value * scale) <= kFarthestVertex) return std::nullopt;  // false for NaN
  const std::string got = "expected a coordinate within 1000 km of the origin, got " + FormatNumber(value);
  if (!std::isfinite(value)) return got + "; state a finite number";
  return got + (scale == 1 ? " m; is the file in another unit? set its scale"
                           : " times the scale " + FormatNumber(scale) + " m; lower the scale");
}

bool CheckIsText(const MeshSource& source, const char* format, MeshMessages& messages) {
  const std::string_view bytes = source.bytes();
  const std::string_view head = bytes.substr(0, 2);
  if (head == "\xff\xfe" || head == "\xfe\xff") {
    messages.Add(MakeError(source.file(), "the text is in UTF-16, expected UTF-8; save it in that encoding"));
    return false;
  }
  const auto odd = std::find_if(bytes.begin(), bytes.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && !IsBlank(c) && !IsLineBreak(c)) || c == 0x7f;
  });
  if (odd == bytes.end()) return true;
  constexpr char kHex[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(*odd);
  messages.Add(source.At(static_cast<std::size_t>(odd - bytes.begin()), Severity::Error,
                         std::string("expected ") + format + ", which is a text, got the byte 0x" + kHex[byte >> 4] +
                             kHex[byte & 15] + "; this looks like a binary or damaged file"));
  return false;
}

}  // namespace percale
