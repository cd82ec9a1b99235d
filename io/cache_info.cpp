// ReadCacheInfo: what a mesh or cache holds. Nothing in the file is believed before it is checked
// against the file's size.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/text.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"
#include "io/point_cache.h"
#include "percale/mesh_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestLine = std::size_t{1} << 20;

/// A file read front to back, by bytes or by lines.
class InfoReader {
 public:
  InfoReader(const fs::path& file, std::FILE* stream, std::uint64_t size) : file_(file), stream_(stream), size_(size) {}

  const fs::path& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  int line() const { return line_; }

  /// Fills `bytes`; false when the file ends before.
  bool Bytes(unsigned char* bytes, std::size_t count) {
    while (count > 0) {
      if (begin_ == end_ && !Fill()) return false;
      const std::size_t part = std::min(count, end_ - begin_);
      std::memcpy(bytes, buffer_.data() + begin_, part);
      begin_ += part;
      position_ += part;
      bytes += part;
      count -= part;
    }
    return true;
  }

  /// The next line without its end; nothing at the end of the file.
  std::optional<std::string_view> Line() {
    text_.clear();
    bool any = false, ended = false;
    while (begin_ < end_ || Fill()) {
      any = true;
      const char* start = buffer_.data() + begin_;
      const auto* newline = static_cast<const char*>(std::memchr(start, '\n', end_ - begin_));
      const std::size_t part = newline ? std::size_t(newline - start) : end_ - begin_;
      if (text_.size() + part > kLongestLine) {
        tooLong_ = true;
        return std::nullopt;
      }
      text_.append(start, part);
      begin_ += part + (newline ? 1 : 0);
      position_ += part + (newline ? 1 : 0);
      ended = newline != nullptr;
      if (ended) break;
    }
    if (!any) return std::nullopt;
    ended_ = ended;
    ++line_;
    if (!text_.empty() && text_.back() == '\r') text_.pop_back();
    return std::string_view(text_);
  }

  /// A text without a line break at its end is whole where other programs wrote it, and cut off within
  /// a number, perhaps, where ours did.
  Diagnostics EndWarnings() const {
    if (ended_) return {};
    Diagnostic warning = MakeWarning("the last line does not end in a line break; the file may have been cut short");
    warning.place = {PathText(file_), line_, 0};
    return {std::move(warning)};
  }

  bool tooLong() const { return tooLong_; }
  bool readFailed() const { return std::ferror(stream_) != 0; }

  Diagnostic Error(std::string message) const { return MakeError(PathText(file_), std::move(message)); }
  /// About the line that was read last.
  Diagnostic LineError(std::string message) const {
    Diagnostic diagnostic = Error(std::move(message));
    diagnostic.place.line = line_;
    if (text_.size() <= 120) diagnostic.excerpt = text_;
    return diagnostic;
  }
  /// Why Line() or Bytes() gave nothing.
  Diagnostic EndError(const std::string& expected) const {
    if (readFailed()) return Error("cannot be read to its end");
    if (tooLong_)
      return Error("line " + std::to_string(line_ + 1) + " is longer than a megabyte; this is no mesh file");
    return Error("ends after " + std::to_string(position_) + " bytes, expected " + expected + "; it was cut short");
  }

 private:
  bool Fill() {
    begin_ = 0;
    end_ = std::fread(buffer_.data(), 1, buffer_.size(), stream_);
    return end_ > 0;
  }

  fs::path file_;
  std::FILE* stream_;
  std::uint64_t size_, position_ = 0;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
  std::size_t begin_ = 0, end_ = 0;
  std::string text_;
  int line_ = 0;
  bool tooLong_ = false;
  bool ended_ = true;  // The line that was read last.
};

std::uint64_t Number(const unsigned char* bytes, int count, bool bigEndian = false) {
  std::uint64_t number = 0;
  for (int i = 0; i < count; ++i) number |= std::uint64_t(bytes[bigEndian ? count - 1 - i : i]) << (8 * i);
  return number;
}

double Float(const unsigned char* bytes, bool bigEndian = false) {
  const auto bits = static_cast<std::uint32_t>(Number(bytes, 4, bigEndian));
  float number;
  std::memcpy(&number, &bits, 4);
  return double(number);
}

double Double(const unsigned char* bytes, bool bigEndian = false) {
  const std::uint64_t bits = Number(bytes, 8, bigEndian);
  double number;
  std::memcpy(&number, &bits, 8);
  return number;
}

/// A coordinate, also in the spellings ("+1", ".5", "2.") that JSON does not have.
std::optional<double> Coordinate(std::string_view text) {
  if (auto number = ParseNumber(text)) return number;
  std::string_view digits = text;
  std::string plain;
  if (!digits.empty() && (digits[0] == '+' || digits[0] == '-')) {
    if (digits[0] == '-') plain = "-";
    digits.remove_prefix(1);
  }
  while (digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9') digits.remove_prefix(1);
  if (!digits.empty() && digits[0] == '.') plain += '0';
  for (std::size_t i = 0; i < digits.size(); ++i) {
    plain += digits[i];
    if (digits[i] == '.' && (i + 1 == digits.size() || digits[i + 1] < '0' || digits[i + 1] > '9')) plain += '0';
  }
  return ParseNumber(plain);
}

std::optional<std::int64_t> WholeNumber(std::string_view text, std::int64_t min, std::int64_t max) {
  const auto number = ParseNumber(text);
  if (!number || *number != std::floor(*number) || *number < double(min) || *number > double(max)) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && (line[i] == ' ' || line[i] == '\t')) ++i;
    const std::size_t begin = i;
    while (i < line.size() && line[i] != ' ' && line[i] != '\t') ++i;
    if (i > begin) words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

/// Grows the box of `info`; false when the point is not a number.
bool Include(CacheInfo& info, bool& first, const Vec3& x) {
  if (!IsFinite(x)) return false;
  if (first) info.boxMin = info.boxMax = x;
  first = false;
  info.boxMin = {std::min(info.boxMin.x, x.x), std::min(info.boxMin.y, x.y), std::min(info.boxMin.z, x.z)};
  info.boxMax = {std::max(info.boxMax.x, x.x), std::max(info.boxMax.y, x.y), std::max(info.boxMax.z, x.z)};
  return true;
}

Result<CacheInfo> ReadPc2(InfoReader& reader) {
  std::array<unsigned char, kPointCacheHeadBytes> bytes{};
  if (!reader.Bytes(bytes.data(), bytes.size())) return reader.EndError("a PointCache2 header of 32 bytes");
  const auto head = ParsePointCacheHead(bytes, reader.size(), PathText(reader.file()));
  if (!head) return head.diagnostics();

  CacheInfo info;
  info.format = "PointCache2";
  info.frames = head->frames;
  info.vertices = head->points;
  info.frameSeconds = head->frameSeconds;
  bool first = true;
  for (std::int32_t s = 0; s < head->frames; ++s) {
    for (std::int32_t p = 0; p < head->points; ++p) {
      std::array<unsigned char, kPointCachePointBytes> point{};
      if (!reader.Bytes(point.data(), point.size())) return reader.EndError("more frames");
      if (!Include(info, first, PointCachePoint(point.data()))) {
        return reader.Error("frame " + std::to_string(s) + ", point " + std::to_string(p) +
                            ": expected numbers, got NaN or infinity");
      }
    }
  }
  return info;
}

Result<CacheInfo> ReadObj(InfoReader& reader) {
  CacheInfo info;
  info.format = "Wavefront OBJ";
  info.frames = 1;
  bool first = true;
  while (const auto line = reader.Line()) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "v") {
      std::array<std::optional<double>, 3> x;
      for (std::size_t i = 0; i < 3; ++i) {
        if (words.size() > i + 1) x[i] = Coordinate(words[i + 1]);
      }
      if (!x[0] || !x[1] || !x[2] || !Include(info, first, {*x[0], *x[1], *x[2]})) {
        return reader.LineError("expected three coordinates after \"v\"");
      }
      if (info.vertices == std::numeric_limits<int>::max()) return reader.LineError("too many vertices");
      ++info.vertices;
    } else if (words[0] == "f") {
      if (words.size() < 4) return reader.LineError("expected at least three corners after \"f\"");
      for (std::size_t i = 1; i < words.size(); ++i) {
        const std::string_view index = words[i].substr(0, words[i].find('/'));
        const auto number = WholeNumber(index, -std::int64_t(info.vertices), info.vertices);
        if (!number || *number == 0) {
          return reader.LineError("expected the number of a vertex above, 1.." + std::to_string(info.vertices) +
                                  ", got " + Quote(index, 30));
        }
      }
      if (info.triangles > std::numeric_limits<int>::max() - int(words.size())) {
        return reader.LineError("too many triangles");
      }
      info.triangles += int(words.size()) - 3;
    } else if (std::any_of(words[0].begin(), words[0].end(), [](char c) { return c == 0; })) {
      return reader.Error("expected a text file, got a binary one");
    }
  }
  if (reader.tooLong() || reader.readFailed()) return reader.EndError("more lines");
  if (info.vertices == 0) return reader.Error("expected lines \"v x y z\", got none");
  return {info, reader.EndWarnings()};
}

Result<CacheInfo> ReadCsv(InfoReader& reader) {
  constexpr std::string_view kHeader = "frame,cloth,vertex,x,y,z";
  const auto header = reader.Line();
  if (!header) return reader.EndError("the line \"" + std::string(kHeader) + "\"");
  if (*header != kHeader) {
    return reader.LineError("expected the line \"" + std::string(kHeader) + "\", got " + Quote(*header, 60));
  }
  CacheInfo info;
  info.format = "Table of points (CSV)";
  bool first = true;
  std::int64_t lastFrame = -1, rows = 0;
  while (const auto line = reader.Line()) {
    std::array<std::string_view, 6> cells;
    std::size_t count = 0, begin = 0;
    while (count < cells.size()) {
      const std::size_t comma = line->find(',', begin);
      cells[count++] = line->substr(begin, comma == std::string_view::npos ? comma : comma - begin);
      begin = comma == std::string_view::npos ? line->size() + 1 : comma + 1;
      if (comma == std::string_view::npos) break;
    }
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    const auto frame = WholeNumber(cells[0], 0, kMost);
    const auto x = ParseNumber(cells[3]), y = ParseNumber(cells[4]), z = ParseNumber(cells[5]);
    if (count != cells.size() || begin <= line->size() || !frame || !WholeNumber(cells[1], 0, kMost) ||
        !WholeNumber(cells[2], 0, kMost) || !x || !y || !z || !Include(info, first, {*x, *y, *z})) {
      return reader.LineError("expected three whole numbers and three coordinates, separated by commas");
    }
    if (*frame < lastFrame)
      return reader.LineError("expected frames in ascending order, got " + std::to_string(*frame) + " after " +
                              std::to_string(lastFrame));
    if (*frame > lastFrame) {
      if (info.frames > 0) {
        if (info.frames == 1) info.vertices = int(rows);
        if (rows != info.vertices) {
          return reader.LineError("expected " + std::to_string(info.vertices) + " rows for frame " +
                                  std::to_string(lastFrame) + ", got " + std::to_string(rows));
        }
      }
      ++info.frames;
      lastFrame = *frame;
      rows = 0;
    }
    if (rows == kMost) return reader.LineError("too many vertices");
    ++rows;
  }
  if (reader.tooLong() || reader.readFailed()) return reader.EndError("more lines");
  if (info.frames == 0) return reader.Error("holds no rows");
  if (info.frames == 1) info.vertices = int(rows);
  if (rows != info.vertices) {
    return reader.Error("expected " + std::to_string(info.vertices) + " rows for frame " + std::to_string(lastFrame) +
                        ", got " + std::to_string(rows) + "; it was cut short");
  }
  return {info, reader.EndWarnings()};
}

// --- Stanford PLY ---

struct PlyType {
  std::string_view name, alias;
  int bytes;
  bool real, isSigned;
};
constexpr PlyType kPlyTypes[] = {
    {"char", "int8", 1, false, true},      {"uchar", "uint8", 1, false, false},  {"short", "int16", 2, false, true},
    {"ushort", "uint16", 2, false, false}, {"int", "int32", 4, false, true},     {"uint", "uint32", 4, false, false},
    {"float", "float32", 4, true, true},   {"double", "float64", 8, true, true},
};

const PlyType* FindPlyType(std::string_view name) {
  for (const PlyType& type : kPlyTypes) {
    if (name == type.name || name == type.alias) return &type;
  }
  return nullptr;
}

struct PlyProperty {
  std::string name;
  const PlyType* count = nullptr;  // set for lists
  const PlyType* type = nullptr;
};
struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// The numbers of a PLY file, in text or binary, one after the other.
class PlyNumbers {
 public:
  PlyNumbers(InfoReader& reader, bool text, bool bigEndian) : reader_(reader), text_(text), bigEndian_(bigEndian) {}

  std::optional<double> Next(const PlyType& type) {
    if (text_) {
      while (next_ == words_.size()) {
        const auto line = reader_.Line();
        if (!line) return std::nullopt;
        words_ = Words(*line);
        next_ = 0;
      }
      return Coordinate(words_[next_++]);
    }
    std::array<unsigned char, 8> bytes{};
    if (!reader_.Bytes(bytes.data(), std::size_t(type.bytes))) return std::nullopt;
    if (type.real) return type.bytes == 4 ? Float(bytes.data(), bigEndian_) : Double(bytes.data(), bigEndian_);
    const std::uint64_t number = Number(bytes.data(), type.bytes, bigEndian_);
    const double span = std::ldexp(1.0, 8 * type.bytes);
    const double value = double(number);
    return type.isSigned && value >= span / 2 ? value - span : value;
  }

 private:
  InfoReader& reader_;
  bool text_, bigEndian_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

/// Reads the header up to "end_header"; `format` is its word after "format".
Result<std::vector<PlyElement>> ReadPlyHeader(InfoReader& reader, std::string& format) {
  std::vector<PlyElement> elements;
  while (const auto line = reader.Line()) {
    const auto words = Words(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (format.empty()) return reader.LineError("expected a line \"format ...\" before");
      return elements;
    }
    if (words[0] == "format" && words.size() == 3) {
      format = words[1];
      if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian") {
        return reader.LineError("expected the format ascii, binary_little_endian or binary_big_endian");
      }
    } else if (words[0] == "element" && words.size() == 3) {
      const auto count = WholeNumber(words[2], 0, std::numeric_limits<std::int32_t>::max());
      if (!count) return reader.LineError("expected a whole number 0..2147483647, got " + Quote(words[2], 30));
      elements.push_back({std::string(words[1]), *count, {}});
    } else if (words[0] == "property" && !elements.empty() &&
               (words.size() == 3 || (words.size() == 5 && words[1] == "list"))) {
      PlyProperty property;
      property.name = words.back();
      property.type = FindPlyType(words[words.size() - 2]);
      if (words.size() == 5) property.count = FindPlyType(words[2]);
      if (!property.type || (words.size() == 5 && !property.count))
        return reader.LineError("expected a type such as float or int");
      elements.back().properties.push_back(std::move(property));
    } else {
      return reader.LineError("expected a line of a PLY header, got " + Quote(*line, 60));
    }
  }
  return reader.EndError("\"end_header\"");
}

Result<CacheInfo> ReadPly(InfoReader& reader) {
  const auto magic = reader.Line();
  if (!magic || *magic != "ply") return reader.Error("expected a PLY file, whose first line is \"ply\"");
  std::string format;
  const auto elements = ReadPlyHeader(reader, format);
  if (!elements) return elements.diagnostics();

  CacheInfo info;
  info.format = format == "ascii" ? "Stanford PLY, text" : "Stanford PLY, binary";
  info.frames = 1;
  bool first = true;
  PlyNumbers numbers(reader, format == "ascii", format == "binary_big_endian");
  for (const PlyElement& element : *elements) {
    // Each element takes at least a byte per property: a count beyond the file's size is a lie.
    const std::uint64_t least = std::uint64_t(element.count) * std::max<std::size_t>(1, element.properties.size());
    if (!element.properties.empty() && least > reader.size()) {
      return reader.Error("expected " + std::to_string(element.count) + " of " + Quote(element.name, 30) +
                          ", but the file has only " + std::to_string(reader.size()) + " bytes");
    }
    if (element.properties.empty()) continue;
    const bool isVertex = element.name == "vertex";
    if (isVertex) info.vertices = int(element.count);
    for (std::int64_t i = 0; i < element.count; ++i) {
      Vec3 x;
      for (const PlyProperty& property : element.properties) {
        double repeat = 1;
        if (property.count) {
          const auto length = numbers.Next(*property.count);
          if (!length) return reader.EndError("more of " + Quote(element.name, 30));
          if (*length < 0 || *length != std::floor(*length))
            return reader.Error("expected the length of a list, got " + FormatNumber(*length));
          repeat = *length;
          if (element.name == "face" && repeat >= 3 && info.triangles < std::numeric_limits<int>::max() - repeat) {
            info.triangles += int(repeat) - 2;
          }
        }
        for (double k = 0; k < repeat; ++k) {
          const auto number = numbers.Next(*property.type);
          if (!number) return reader.EndError("more of " + Quote(element.name, 30));
          if (property.count) continue;
          if (property.name == "x") x.x = *number;
          if (property.name == "y") x.y = *number;
          if (property.name == "z") x.z = *number;
        }
      }
      if (isVertex && !Include(info, first, x)) {
        return reader.Error("vertex " + std::to_string(i) + ": expected numbers, got NaN or infinity");
      }
    }
  }
  if (info.vertices == 0) return reader.Error("expected an element \"vertex\", got none");
  return info;
}

}  // namespace

Result<CacheInfo> ReadCacheInfo(const fs::path& file) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (!fs::exists(status)) return MakeError(PathText(file), "there is no such file; check the name and the folder");
  if (!fs::is_regular_file(status))
    return MakeError(PathText(file), fs::is_directory(status) ? "expected a file, got a folder"
                                                              : "expected a file, got a device or pipe");
  const std::uint64_t size = fs::file_size(file, code);
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(OpenFile(file, "rb"), &std::fclose);
  if (!stream || code) return MakeError(PathText(file), "cannot be read: " + std::generic_category().message(errno));

  InfoReader reader(file, stream.get(), size);
  if (const auto kind = CacheKindOf(file)) {
    switch (*kind) {
      case CacheKind::Csv:
        return ReadCsv(reader);
      case CacheKind::Obj:
        return ReadObj(reader);
      case CacheKind::Ply:
        return ReadPly(reader);
      case CacheKind::Pc2:
        return ReadPc2(reader);
    }
  }
  const std::string extension = PathText(file.extension());
  return MakeError(PathText(file), "expected a file that ends in .csv, .obj, .ply or .pc2, got " +
                                       (extension.empty() ? "no extension" : Quote(extension, 20)));
}

}  // namespace percale
