#pragma once
/// \file
/// A mesh file on its way to a mesh: its bytes with messages about places in them, and the polygons that the readers of
/// the formats find.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

/// A file, read whole.
class MeshSource {
 public:
  /// Reads the file, or says why not: missing, a folder, a device, not readable, empty, beyond 4 GB.
  static Result<MeshSource> Load(const std::filesystem::path& file);

  std::string_view bytes() const { return bytes_; }
  const std::string& file() const { return file_; }

  /// About a place in a text: line, column, and the line itself.
  Diagnostic At(std::size_t offset, Severity severity, std::string message) const;
  /// About a place in a binary file: "byte 1234: MESSAGE".
  Diagnostic AtByte(std::size_t offset, Severity severity, std::string message) const;

 private:
  std::string file_, bytes_;
};

/// Walks through a text by lines and words. Words end at white space; a backslash at the end of a line continues it.
class MeshWords {
 public:
  explicit MeshWords(std::string_view text, bool continued);

  bool AtEnd() const { return cursor_ >= text_.size(); }
  /// Where the next word begins, or the line ends.
  std::size_t Position();
  /// The next word of the line, or empty at its end. With `comments`, one that begins with # ends the line.
  std::string_view Next(bool comments);
  /// The rest of the line without the white space around it.
  std::string_view Rest();
  /// Goes to the beginning of the next line.
  void NextLine();
  /// Whether the last line had its line break.
  bool Ended() const { return text_.empty() || text_.back() == '\n' || text_.back() == '\r'; }
  std::size_t cursor() const { return cursor_; }

 private:
  bool IsContinuation(std::size_t i) const;
  void SkipBlank();

  std::string_view text_;
  bool continued_;
  std::size_t cursor_ = 0;
};

/// The polygons of a file and what belongs to them, all indices checked.
struct PolygonSoup {
  static constexpr std::size_t kMostVertices = 50'000'000;
  static constexpr std::size_t kMostCorners = 150'000'000;

  struct Group {
    std::string name;
    std::vector<std::pair<std::size_t, std::size_t>> polygons;  ///< Ranges: first, end.
  };

  std::vector<Vec3> positions;              ///< [m]
  std::vector<Vec2> texture;                ///< Texture coordinates that corners refer to.
  std::vector<std::int32_t> corners;        ///< Vertices of the polygons, one polygon after the other.
  std::vector<std::int32_t> cornerTexture;  ///< Index in `texture` of each corner, or -1.
  std::vector<std::size_t> polygonEnds;     ///< Where the corners of each end.
  std::vector<std::size_t> polygonPlaces;   ///< Offset of each in the file.
  std::vector<Group> groups;
  bool binary = false;  ///< Places are bytes, not lines.

  std::size_t PolygonBegin(std::size_t polygon) const { return polygon == 0 ? 0 : polygonEnds[polygon - 1]; }
};

/// Messages about one file. After kMost errors there is no use in more.
class MeshMessages {
 public:
  static constexpr int kMost = 20;

  void Add(Diagnostic diagnostic) {
    errors_ += diagnostic.severity == Severity::Error ? 1 : 0;
    list_.push_back(std::move(diagnostic));
  }
  /// Makes it full.
  void Stop() { errors_ = kMost; }
  bool failed() const { return errors_ > 0; }
  bool full() const { return errors_ >= kMost; }
  Diagnostics Take() { return std::move(list_); }

 private:
  Diagnostics list_;
  int errors_ = 0;
};

/// Read the formats; `scale` is in metres per unit of the file. Errors and warnings go to `messages`.
PolygonSoup ReadObjPolygons(const MeshSource& source, double scale, MeshMessages& messages);
PolygonSoup ReadPlyPolygons(const MeshSource& source, double scale, MeshMessages& messages);

/// The polygons as triangles, in order; those of a convex one lie side by side. Warns of polygons of which they do not.
std::vector<Triangle> TrianglesOf(const PolygonSoup& soup, const MeshSource& source, MeshMessages& messages);

/// The number that a word is in whole, as C writes them ("1", "-.5", "2.", "1e-3", "+4"), to the bit and whatever the
/// locale; infinity when it is too large.
std::optional<double> MeshNumber(std::string_view word);

/// Why a word is no number for a mesh: "expected WHAT, got WORD; remedy".
std::string NotANumber(std::string_view word, const std::string& what);

/// A word in quotes as a message can show it: short, and ASCII.
std::string Shown(std::string_view word);

/// Says what is not within 1000 km, or nothing.
std::optional<std::string> CoordinateProblem(double value, double scale);

/// Whether `bytes` are a text; otherwise the message says at once what they are.
bool CheckIsText(const MeshSource& source, const char* format, MeshMessages& messages);

}  // namespace percale
