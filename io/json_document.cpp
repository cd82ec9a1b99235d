#include "io/json_document.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/text.h"

namespace percale {
namespace {

constexpr std::size_t kLargestDocument = std::size_t{64} << 20;  // [byte]
constexpr std::size_t kDeepest = 32;
constexpr std::size_t kMostValues = 10'000'000;  // 32 bytes each
constexpr std::size_t kMostMessages = 1000;
constexpr std::size_t kCountBlock = 4096;  // of the character count [byte]
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool IsSpace(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool IsContinuation(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}
bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

std::string Hex(char c) {
  constexpr char kDigits[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return {'0', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

/// Offset of the first byte that is not part of well-formed UTF-8 (RFC 3629), or text.size().
std::size_t FindNotUtf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  std::size_t i = 0;
  while (i < text.size()) {
    const unsigned lead = byte(i);
    if (lead < 0x80) {
      ++i;
      continue;
    }
    const unsigned second = byte(i + 1);
    std::size_t length = 0;
    if (lead >= 0xc2 && lead <= 0xdf) length = 2;
    // Neither overlong forms nor halves of surrogate pairs nor anything beyond U+10FFFF.
    if (lead >= 0xe0 && lead <= 0xef && !(lead == 0xe0 && second < 0xa0) && !(lead == 0xed && second > 0x9f))
      length = 3;
    if (lead >= 0xf0 && lead <= 0xf4 && !(lead == 0xf0 && second < 0x90) && !(lead == 0xf4 && second > 0x8f))
      length = 4;
    if (length == 0) return i;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    }
    i += length;
  }
  return text.size();
}

/// Offset of the first byte that no text file has, or text.size().
std::size_t FindNotText(std::string_view text) {
  const auto found = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && !IsSpace(c) && c != '\f' && c != '\v';
  });
  return static_cast<std::size_t>(found - text.begin());
}

}  // namespace

Place JsonDocument::At(std::size_t offset) const {
  const auto after = std::upper_bound(lineBegins_.begin(), lineBegins_.end(), offset);
  const std::size_t line = static_cast<std::size_t>(after - lineBegins_.begin());
  const auto charactersBefore = [&](std::size_t end) {
    const std::size_t block = end / kCountBlock;
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(block * kCountBlock);
    const auto rest = std::count_if(begin, text_.begin() + static_cast<std::ptrdiff_t>(end),
                                    [](char c) { return !IsContinuation(c); });
    return characters_[block] + static_cast<std::uint32_t>(rest);
  };
  const std::uint32_t column = charactersBefore(offset) - charactersBefore(lineBegins_[line - 1]) + 1;
  return {file_, static_cast<int>(line), static_cast<int>(column)};
}

void JsonDocument::IndexLines() {
  // A byte-order mark is not a character of the first line.
  lineBegins_.push_back(text_.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0 ? 3 : 0);
  std::uint32_t characters = 0;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (i % kCountBlock == 0) characters_.push_back(characters);
    if (!IsContinuation(text_[i])) ++characters;
    if (text_[i] == '\n') lineBegins_.push_back(static_cast<std::uint32_t>(i + 1));
  }
  if (text_.size() % kCountBlock == 0) characters_.push_back(characters);
}

Diagnostic JsonDocument::Message(std::size_t offset, Severity severity, std::string message) const {
  // Of a long line this many characters are shown, so many of them before the place.
  constexpr int kShown = 110, kBefore = 60;
  Diagnostic diagnostic{severity, At(offset), std::move(message), {}, 0};
  const std::size_t line = lineBegins_[static_cast<std::size_t>(diagnostic.place.line - 1)];
  std::size_t begin = offset, end = offset;
  int before = 0;
  const int mostBefore = diagnostic.place.column <= kShown - 10 ? kShown : kBefore;
  while (begin > line && before < mostBefore) {
    if (!IsContinuation(text_[--begin])) ++before;
  }
  for (int shown = before; end < text_.size() && text_[end] != '\n'; ++end) {
    if (!IsContinuation(text_[end]) && ++shown > kShown) break;
  }
  const bool cutEnd = end < text_.size() && text_[end] != '\n';
  if (!cutEnd && end > begin && text_[end - 1] == '\r') --end;
  const std::string mark = begin > line ? "..." : "";
  diagnostic.excerpt = mark + text_.substr(begin, end - begin) + (cutEnd ? "..." : "");
  diagnostic.caret = static_cast<int>(mark.size()) + before + 1;
  // An excerpt of a file that is not UTF-8 must not spoil what the message is printed into.
  for (std::size_t bad = FindNotUtf8(diagnostic.excerpt); bad < diagnostic.excerpt.size();
       bad = FindNotUtf8(diagnostic.excerpt)) {
    diagnostic.excerpt[bad] = '?';
  }
  return diagnostic;
}

Diagnostic JsonDocument::About(JsonIndex value, Severity severity, std::string message) const {
  return Message(nodes_[value].begin, severity, std::move(message));
}

Diagnostic JsonDocument::AboutKey(JsonIndex member, Severity severity, std::string message) const {
  return Message(nodes_[member].keyBegin, severity, std::move(message));
}

std::vector<JsonIndex> JsonDocument::Children(JsonIndex value) const {
  std::vector<JsonIndex> children;
  for (JsonIndex child = value + 1; child < nodes_[value].end; child = nodes_[child].end) children.push_back(child);
  return children;
}

JsonIndex JsonDocument::Member(JsonIndex object, std::string_view key) const {
  for (JsonIndex child = object + 1; child < nodes_[object].end; child = nodes_[child].end) {
    if (nodes_[child].key != 0 && Key(child) == key) return child;
  }
  return 0;
}

std::string JsonDocument::Source(JsonIndex value) const {
  constexpr std::size_t kLongest = 40;
  const Node& node = nodes_[value];
  switch (node.kind) {
    case JsonKind::Null:
      return "null";
    case JsonKind::Boolean:
      return Boolean(value) ? "true" : "false";
    case JsonKind::Text:
      return Quote(Text(value), kLongest);
    case JsonKind::Array:
      return node.end == value + 1 ? "an empty array" : "an array of " + std::to_string(Children(value).size());
    case JsonKind::Object:
      return "an object";
    case JsonKind::Number:
      break;
  }
  std::size_t end = node.begin;
  while (end < text_.size() &&
         (IsDigit(text_[end]) || IsLetter(text_[end]) || text_[end] == '+' || text_[end] == '-' || text_[end] == '.'))
    ++end;
  const std::string number = text_.substr(node.begin, end - node.begin);
  return number.size() > kLongest ? number.substr(0, kLongest) + "..." : number;
}

/// Takes the parser's events. The parser does not say where it is, so a cursor walks the text in
/// step with it: before an event only white space, ',' and ':' can stand between the cursor and the
/// token that the event is about.
class JsonReader {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  explicit JsonReader(JsonDocument& document) : document_(document), text_(document.text_) {
    if (text_.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0) cursor_ = kByteOrderMark.size();
  }

  Diagnostics Read() {
    if (!CheckText()) return std::move(errors_);
    const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(cursor_);
    const bool read = nlohmann::json::sax_parse(begin, text_.end(), this);
    if (!read && errors_.empty()) Fail(cursor_, "the text is not JSON from here on");
    return std::move(errors_);
  }

  // Events.
  bool null() { return AddWord(JsonKind::Null, 0, 4); }
  bool boolean(bool value) { return AddWord(JsonKind::Boolean, value ? 1 : 0, value ? 4 : 5); }
  bool number_integer(number_integer_t value) { return AddNumber(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) { return AddNumber(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) { return AddNumber(value); }
  bool string(string_t& value) {
    if (!Add(JsonKind::Text, 0)) return false;
    document_.nodes_.back().text = AddText(std::move(value));
    SkipText();
    return true;
  }
  bool binary(binary_t&) { return false; }  // JSON text has none
  bool key(string_t& value) {
    FindToken();
    keyBegin_ = static_cast<std::uint32_t>(cursor_);
    key_ = AddText(std::move(value));
    SkipText();
    afterKey_ = true;
    return true;
  }
  bool start_object(std::size_t) { return Open(JsonKind::Object); }
  bool start_array(std::size_t) { return Open(JsonKind::Array); }
  bool end_object() {
    CheckKeys(open_.back());
    return Close();
  }
  bool end_array() { return Close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) {
    Explain();
    return false;
  }

 private:
  void Fail(std::size_t offset, std::string message) {
    errors_.push_back(document_.Message(offset, Severity::Error, std::move(message)));
  }

  /// What can be said before parsing: not a text, another encoding, nothing in it.
  bool CheckText() {
    const auto failWhole = [&](std::string message) {
      errors_.push_back(MakeError(document_.file_, std::move(message)));
      return false;
    };
    if (text_.size() == cursor_) {
      return failWhole("the file is empty; expected a scene, a JSON object such as {\"cloth\": {...}}");
    }
    const std::string_view head(text_.data(), std::min<std::size_t>(text_.size(), 4));
    const bool marked = head.substr(0, 2) == "\xff\xfe" || head.substr(0, 2) == "\xfe\xff";
    const auto zeros = std::count(head.begin(), head.end(), '\0');
    if (marked || (zeros >= 2 && zeros < 4)) {
      Fail(0, "the text is in UTF-16 or UTF-32, expected UTF-8; save it in that encoding");
      return false;
    }
    const std::size_t odd = FindNotText(text_), wrong = FindNotUtf8(text_);
    if (odd < wrong || text_.find('\0') != std::string::npos) {
      Fail(odd, "byte " + Hex(text_[odd]) +
                    " never stands in a text; expected a scene in JSON, this looks like a binary file");
      return false;
    }
    if (wrong < text_.size()) {
      Fail(wrong, "byte " + Hex(text_[wrong]) + " is not UTF-8 here; save the file in the encoding UTF-8");
      return false;
    }
    if (SkipSpace(cursor_) == text_.size()) {
      Fail(cursor_, "the file holds only white space; expected a scene, a JSON object such as {\"cloth\": {...}}");
      return false;
    }
    return true;
  }

  std::size_t SkipSpace(std::size_t i) const {
    while (i < text_.size() && IsSpace(text_[i])) ++i;
    return i;
  }
  void FindToken() {
    while (cursor_ < text_.size() && (IsSpace(text_[cursor_]) || text_[cursor_] == ',' || text_[cursor_] == ':'))
      ++cursor_;
  }
  void SkipText() {
    for (++cursor_; cursor_ < text_.size() && text_[cursor_] != '"'; ++cursor_) {
      if (text_[cursor_] == '\\') ++cursor_;
    }
    ++cursor_;
  }
  std::uint32_t AddText(std::string&& text) {
    document_.texts_.push_back(std::move(text));
    return static_cast<std::uint32_t>(document_.texts_.size() - 1);
  }

  bool Add(JsonKind kind, double number) {
    FindToken();
    if (document_.nodes_.size() >= kMostValues) {
      Fail(cursor_, "expected at most " + std::to_string(kMostValues) + " values in a file, here is one more");
      return false;
    }
    JsonDocument::Node node;
    node.number = number;
    node.begin = static_cast<std::uint32_t>(cursor_);
    if (afterKey_) node.keyBegin = keyBegin_, node.key = key_;
    node.end = static_cast<JsonIndex>(document_.nodes_.size() + 1);
    node.kind = kind;
    document_.nodes_.push_back(node);
    afterKey_ = false;
    return true;
  }
  bool AddWord(JsonKind kind, double number, std::size_t length) {
    if (!Add(kind, number)) return false;
    cursor_ += length;
    return true;
  }
  bool AddNumber(double number) {
    if (!Add(JsonKind::Number, number)) return false;
    const auto here = [&] { return cursor_ < text_.size() ? text_[cursor_] : '\0'; };
    const auto digits = [&] {
      while (IsDigit(here())) ++cursor_;
    };
    if (here() == '-') ++cursor_;
    if (here() == '0') {
      ++cursor_;  // nothing but a point or an exponent continues it
    } else {
      digits();
    }
    if (here() == '.') ++cursor_, digits();
    if (here() == 'e' || here() == 'E') {
      ++cursor_;
      if (here() == '+' || here() == '-') ++cursor_;
      digits();
    }
    return true;
  }
  bool Open(JsonKind kind) {
    if (!AddWord(kind, 0, 1)) return false;
    if (open_.size() == kDeepest) {
      Fail(cursor_ - 1, "expected at most " + std::to_string(kDeepest) + " levels of brackets, here begins one more");
      return false;
    }
    open_.push_back(static_cast<JsonIndex>(document_.nodes_.size() - 1));
    return true;
  }
  bool Close() {
    FindToken();
    ++cursor_;
    document_.nodes_[open_.back()].end = static_cast<JsonIndex>(document_.nodes_.size());
    open_.pop_back();
    return true;
  }

  /// Reports every key that an object, whose members are all read, states again.
  void CheckKeys(JsonIndex object) {
    document_.nodes_[object].end = static_cast<JsonIndex>(document_.nodes_.size());
    std::vector<JsonIndex> members = document_.Children(object);
    std::stable_sort(members.begin(), members.end(),
                     [&](JsonIndex a, JsonIndex b) { return document_.Key(a) < document_.Key(b); });
    std::size_t first = 0;
    for (std::size_t k = 1; k < members.size() && errors_.size() < kMostMessages; ++k) {
      const std::string& key = document_.Key(members[k]);
      if (key != document_.Key(members[first])) {
        first = k;
      } else if (key.empty() || key[0] != '_') {
        const Place place = document_.PlaceOfKey(members[first]);
        errors_.push_back(document_.AboutKey(members[k], Severity::Error,
                                             "the key " + Quote(key, 40) + " is stated already, at " +
                                                 std::to_string(place.line) + ":" + std::to_string(place.column) +
                                                 "; keep one of the two"));
      }
    }
  }

  /// Says what is wrong where the parser gave up: walks from the last good token to the first
  /// thing that may not stand there.
  void Explain() {
    const bool inObject = !open_.empty() && document_.Kind(open_.back()) == JsonKind::Object;
    std::size_t at = SkipSpace(cursor_);
    const auto here = [&] { return at < text_.size() ? text_[at] : '\0'; };

    if (!document_.nodes_.empty() && at == cursor_ && IsWordPart(here())) {
      // What the parser took for a value goes on: 5k, 007, nullptr.
      const JsonDocument::Node& last = document_.nodes_.back();
      const bool word = last.kind == JsonKind::Number || last.kind == JsonKind::Boolean || last.kind == JsonKind::Null;
      if (word && !afterKey_ && IsWordPart(text_[at - 1]))
        return BadValue(last.begin, PathOfLast() + "expected a value");
    }
    if (open_.empty()) {
      if (document_.nodes_.empty()) return BadValue(at, "expected a scene, a JSON object such as {\"cloth\": {...}}");
      return BadMark(at, "expected the end of the file after the scene");
    }
    if (afterKey_) {
      if (here() != ':') return BadMark(at, "expected ':' after the key");
      return BadValue(SkipSpace(at + 1), PathOfNext() + "expected a value");
    }
    if (document_.nodes_.size() > open_.back() + 1) {  // after a value
      const char close = inObject ? '}' : ']';
      if (here() != ',') return BadMark(at, std::string("expected ',' or '") + close + "' after the value");
      const std::size_t comma = at;
      at = SkipSpace(at + 1);
      if (here() == close) {
        return Fail(comma, std::string("the comma before '") + close +
                               "' has nothing after it; JSON has no trailing commas: take it out");
      }
    }
    if (!inObject) return BadValue(at, PathOfNext() + "expected a value");
    if (here() == '"') return BadText(at);
    BadMark(at, "expected a key in double quotes");
  }

  /// "/cloth/0/ks: " for the value that would come next, or "" for the root.
  std::string PathOfNext() const {
    std::string path = PathOfOpen();
    if (open_.empty()) return path;
    const bool inObject = document_.Kind(open_.back()) == JsonKind::Object;
    path += "/" + (inObject ? document_.texts_[key_] : std::to_string(ChildrenSoFar(open_.back())));
    return path + ": ";
  }
  /// The same for the value that came last, which is no array or object.
  std::string PathOfLast() const {
    if (open_.empty()) return {};
    const auto last = static_cast<JsonIndex>(document_.nodes_.size() - 1);
    const bool inObject = document_.Kind(open_.back()) == JsonKind::Object;
    return PathOfOpen() + "/" + (inObject ? document_.Key(last) : std::to_string(ChildrenSoFar(open_.back()) - 1)) +
           ": ";
  }
  std::string PathOfOpen() const {
    std::string path;
    for (std::size_t k = 1; k < open_.size(); ++k) {
      const bool inObject = document_.Kind(open_[k - 1]) == JsonKind::Object;
      path += "/" + (inObject ? document_.Key(open_[k]) : std::to_string(ChildrenSoFar(open_[k - 1], open_[k])));
    }
    return path;
  }
  /// How many values an open array holds before `end`.
  std::size_t ChildrenSoFar(JsonIndex array, JsonIndex end = std::numeric_limits<JsonIndex>::max()) const {
    std::size_t count = 0;
    const auto stop = std::min(end, static_cast<JsonIndex>(document_.nodes_.size()));
    for (JsonIndex child = array + 1; child < stop; child = document_.nodes_[child].end) ++count;
    return count;
  }

  /// What a reader takes for one word or number.
  static bool IsWordPart(char c) { return IsLetter(c) || IsDigit(c) || c == '.' || c == '-' || c == '+'; }
  std::string WordAt(std::size_t at) const {
    constexpr std::size_t kLongest = 40;
    std::size_t end = at;
    while (end < text_.size() && IsWordPart(text_[end])) ++end;
    return end - at > kLongest ? text_.substr(at, kLongest) + "..." : text_.substr(at, end - at);
  }

  /// `at` is where a value should begin, and none that JSON knows does.
  void BadValue(std::size_t at, const std::string& expected) {
    if (at < text_.size() && text_[at] == '"') return BadText(at);
    const std::string word = WordAt(at);
    if (word.empty()) return BadMark(at, expected);
    const std::string got = expected + ", got " + word;
    const std::size_t sign = word[0] == '-' || word[0] == '+' ? 1 : 0;
    const std::string bare = Lower(word.substr(sign));
    if (bare == "nan" || bare == "infinity" || bare == "inf") {
      return Fail(at, got + ", which JSON does not have; state a finite number");
    }
    if (bare == "true" || bare == "false" || bare == "null" || bare == "none") {
      return Fail(at, got + "; JSON writes true, false and null in small letters");
    }
    if (!bare.empty() && IsLetter(bare[0])) return Fail(at, got + "; JSON writes texts in double quotes");

    const bool onlyNumberParts = bare.find_first_not_of("0123456789.e+-") == std::string::npos;
    if (word[0] == '+') return Fail(at, got + "; JSON numbers have no leading '+'");
    if (!bare.empty() && bare[0] == '.') return Fail(at, got + "; write a 0 before the point");
    if (bare.size() > 1 && bare[0] == '0' && IsDigit(bare[1]))
      return Fail(at, got + "; JSON numbers have no leading zeros");
    if (onlyNumberParts && bare.find('e') != std::string::npos && IsDigit(bare.back())) {
      return Fail(at, got + ", which is beyond the largest number, about 1.8e308");
    }
    Fail(at, got + "; write a number like 5000, -9.8 or 1e-3, and a text in double quotes");
  }

  static std::string Lower(std::string word) {
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
  }

  /// `at` is where something else than what stands there is expected.
  void BadMark(std::size_t at, const std::string& expected) {
    if (at >= text_.size()) return Truncated(expected);
    const char c = text_[at];
    if (c == '/' || c == '#') {
      return Fail(at, "JSON has no comments; use a key that begins with '_', such as \"_comment\": \"...\"");
    }
    if (c == '"') return Fail(at, expected + ", got a text");
    if (c == '\'') return Fail(at, expected + ", got '; JSON writes keys and texts in double quotes");
    if (IsWordPart(c)) return Fail(at, expected + ", got " + WordAt(at));
    std::size_t length = 1;
    while (at + length < text_.size() && IsContinuation(text_[at + length])) ++length;
    const bool printable = static_cast<unsigned char>(c) >= 0x20;
    Fail(at, expected + ", got " + (printable ? "'" + text_.substr(at, length) + "'" : "byte " + Hex(c)));
  }

  /// The text that begins at `at` is no JSON text.
  void BadText(std::size_t at) {
    std::size_t i = at + 1;
    for (; i < text_.size() && text_[i] != '"'; ++i) {
      if (static_cast<unsigned char>(text_[i]) < 0x20) {
        if (text_[i] == '\n' || text_[i] == '\r')
          return Fail(at, "the text that begins here does not end in its line; close it with a double quote");
        return Fail(i, "expected \\t or another escape in a text, got the bare byte " + Hex(text_[i]));
      }
      if (text_[i] != '\\') continue;
      const char escaped = i + 1 < text_.size() ? text_[i + 1] : '\0';
      if (escaped == 'u') {
        const std::string_view digits = std::string_view(text_).substr(i + 2, 4);
        if (digits.size() < 4 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos) {
          return Fail(i, "expected four hexadecimal digits after \\u");
        }
      } else if (escaped != '\0' && std::string_view("\"\\/bfnrt").find(escaped) == std::string_view::npos) {
        return Fail(i, "JSON knows no escape \\" +
                           std::string(1, static_cast<unsigned char>(escaped) < 0x80 ? escaped : '?') +
                           "; write \\\\ for a backslash");
      }
      ++i;
    }
    if (i >= text_.size()) return Fail(at, "the text that begins here never ends; close it with a double quote");
    Fail(at, "a \\u escape in this text is half of a pair; write the character itself");
  }

  void Truncated(const std::string& expected) {
    std::string where;
    if (!open_.empty()) {
      const Place place = document_.PlaceOf(open_.back());
      const bool object = document_.Kind(open_.back()) == JsonKind::Object;
      where = std::string(" inside the ") + (object ? "object" : "array") + " that begins at " +
              std::to_string(place.line) + ":" + std::to_string(place.column);
    }
    std::size_t end = text_.size();  // of what is there: a last line break would point below it
    while (end > 0 && IsSpace(text_[end - 1])) --end;
    Fail(end, expected + ", but the file ends" + where + " (was it cut short?)");
  }

  JsonDocument& document_;
  const std::string& text_;
  std::size_t cursor_ = 0;       ///< After the last token that the parser told of.
  std::vector<JsonIndex> open_;  ///< Arrays and objects that have not ended.
  std::uint32_t keyBegin_ = 0, key_ = 0;
  bool afterKey_ = false;
  Diagnostics errors_;
};

Result<JsonDocument> JsonDocument::Parse(std::string text, std::string file) {
  JsonDocument document;
  document.file_ = std::move(file);
  document.text_ = std::move(text);
  if (document.text_.size() > kLargestDocument) {
    return MakeError(document.file_,
                     "expected a scene of at most 64 MB, got " + std::to_string(document.text_.size() >> 20) + " MB");
  }
  document.IndexLines();
  Diagnostics errors = JsonReader(document).Read();
  if (!errors.empty()) return errors;
  return document;
}

Result<JsonDocument> JsonDocument::Load(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  const std::string name = file.string();
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    if (const fs::path end = fs::read_symlink(file, error); !error) {
      return MakeError(name, "this is a link to " + end.string() + ", and there is no such file");
    }
    // The nearest name beside it, for slips of the finger.
    std::vector<std::string> names;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    fs::directory_iterator entries(folder, error);
    if (error) return MakeError(name, "there is no such file, nor a folder " + Quote(folder.string()));
    for (; !error && entries != fs::directory_iterator() && names.size() < 1000; entries.increment(error)) {
      if (entries->path().extension() == ".json") names.push_back(entries->path().stem().string());
    }
    std::sort(names.begin(), names.end());
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string_view nearest = Nearest(file.stem().string(), known);
    const std::string hint =
        nearest.empty()
            ? ""
            : " (did you mean " + (folder / (std::string(nearest) + ".json")).lexically_normal().string() + "?)";
    return MakeError(name, "there is no such file" + hint);
  }
  if (status.type() == fs::file_type::directory) return MakeError(name, "this is a folder; expected a scene file");

  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    const std::string why = errno != 0 ? ": " + std::generic_category().message(errno) : "";
    return MakeError(name, "the file cannot be opened" + why + "; check its permissions");
  }
  std::string text;
  std::vector<char> buffer(1 << 16);
  while (in && text.size() <= kLargestDocument) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    text.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) return MakeError(name, "reading the file failed after " + std::to_string(text.size()) + " bytes");
  if (text.size() > kLargestDocument) return MakeError(name, "expected a scene of at most 64 MB, this file is larger");
  return Parse(std::move(text), name);
}

}  // namespace percale
