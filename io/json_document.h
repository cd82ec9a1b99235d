#pragma once
/// \file
/// A JSON text as a tree in which every value knows its place, for messages that point at it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "percale/diagnostic.h"

namespace percale {

enum class JsonKind : std::uint8_t { Null, Boolean, Number, Text, Array, Object };

/// An index into the document; the root is 0.
using JsonIndex = std::uint32_t;

class JsonDocument {
 public:
  /// Reads `text`; `file` stands for it in messages. On failure the errors say where and what to do.
  /// Beside what JSON forbids, these are errors: a key stated twice in an object (but for those that
  /// begin with '_', which are comments), more than 32 levels, text that is not UTF-8.
  /// A UTF-8 byte-order mark is skipped.
  static Result<JsonDocument> Parse(std::string text, std::string file);
  /// The same for a file of at most 64 MB.
  static Result<JsonDocument> Load(const std::filesystem::path& file);

  JsonKind Kind(JsonIndex value) const { return nodes_[value].kind; }
  bool Boolean(JsonIndex value) const { return nodes_[value].number != 0; }              ///< Of a Boolean.
  double Number(JsonIndex value) const { return nodes_[value].number; }                  ///< Of a Number.
  const std::string& Text(JsonIndex value) const { return texts_[nodes_[value].text]; }  ///< Of a Text.

  /// The values of an array or an object, in the order of the file; none of any other value.
  std::vector<JsonIndex> Children(JsonIndex value) const;
  /// The key of a value in an object.
  const std::string& Key(JsonIndex member) const { return texts_[nodes_[member].key]; }
  /// The member of an object with that key, or 0 (the root is nobody's member).
  JsonIndex Member(JsonIndex object, std::string_view key) const;

  /// The value as the file writes it, shortened if long: for "got ...".
  std::string Source(JsonIndex value) const;

  Place PlaceOf(JsonIndex value) const { return At(nodes_[value].begin); }
  Place PlaceOfKey(JsonIndex member) const { return At(nodes_[member].keyBegin); }
  /// A message about a value, or about the key of a member, with the line it stands in.
  Diagnostic About(JsonIndex value, Severity severity, std::string message) const;
  Diagnostic AboutKey(JsonIndex member, Severity severity, std::string message) const;

 private:
  friend class JsonReader;

  // Values lie in the order of the file, an array or object before what it holds.
  struct Node {
    double number = 0;
    std::uint32_t begin = 0;     ///< Offset of the value in the text.
    std::uint32_t keyBegin = 0;  ///< Offset of its key's quote.
    std::uint32_t key = 0;       ///< Index of the key in texts_; 0: none.
    std::uint32_t text = 0;      ///< Index of a Text's value in texts_.
    JsonIndex end = 0;           ///< The first value after this one and all that it holds.
    JsonKind kind = JsonKind::Null;
  };

  Place At(std::size_t offset) const;
  Diagnostic Message(std::size_t offset, Severity severity, std::string message) const;
  void IndexLines();

  std::string file_, text_;
  std::vector<Node> nodes_;
  std::vector<std::string> texts_{1};      ///< texts_[0] is empty.
  std::vector<std::uint32_t> lineBegins_;  ///< Offset of each line.
  std::vector<std::uint32_t> characters_;  ///< Characters before each block of the text.
};

}  // namespace percale
