// Stanford PLY, as text and as binary numbers of either order: vertices and faces; other elements are skipped. No count
// is believed before the file is known to be long enough for it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/text.h"
#include "io/mesh_source.h"

namespace percale {
namespace {

struct Type {
  std::string_view name, alias;
  std::size_t bytes;
  bool real, isSigned;
};
constexpr std::array<Type, 8> kTypes = {{{"char", "int8", 1, false, true},
                                         {"uchar", "uint8", 1, false, false},
                                         {"short", "int16", 2, false, true},
                                         {"ushort", "uint16", 2, false, false},
                                         {"int", "int32", 4, false, true},
                                         {"uint", "uint32", 4, false, false},
                                         {"float", "float32", 4, true, true},
                                         {"double", "float64", 8, true, true}}};

const Type* FindType(std::string_view name) {
  for (const Type& type : kTypes) {
    if (name == type.name || name == type.alias) return &type;
  }
  return nullptr;
}

struct Property {
  std::string_view name;
  const Type* count = nullptr;  ///< Set for lists.
  const Type* type = nullptr;
};
struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::size_t place = 0;  ///< Of its line in the header.
  std::vector<Property> properties;

  std::size_t Find(std::string_view property) const {
    std::size_t i = 0;
    while (i < properties.size() && properties[i].name != property) ++i;
    return i;  // properties.size() where there is none
  }
};

enum class Format { Text, LittleEndian, BigEndian };

class PlyReader {
 public:
  PlyReader(const MeshSource& source, double scale, MeshMessages& messages)
      : source_(source), bytes_(source.bytes()), scale_(scale), messages_(messages), words_(bytes_, false) {}

  PolygonSoup Read() {
    if (ReadHeader() && CheckElements()) ReadBody();
    soup_.binary = format_ != Format::Text;
    return std::move(soup_);
  }

 private:
  bool Fail(std::size_t at, std::string message) {
    const bool binary = inBody_ && format_ != Format::Text;
    if (!messages_.full()) {
      messages_.Add(binary ? source_.AtByte(at, Severity::Error, std::move(message))
                           : source_.At(at, Severity::Error, std::move(message)));
    }
    return false;
  }

  // --- The header ---

  bool ReadHeader() {
    if (bytes_.substr(0, 2) == "\xff\xfe" || bytes_.substr(0, 2) == "\xfe\xff") {
      return CheckIsText(source_, "a PLY file", messages_);
    }
    const std::string_view magic = words_.Next(false);
    const std::size_t end = words_.cursor();
    if (magic != "ply" || end >= bytes_.size() || !(bytes_[end] == '\n' || bytes_[end] == '\r')) {
      return Fail(0, "expected a PLY file, whose first line is \"ply\", got " + Shown(bytes_.substr(0, 30)));
    }
    words_.NextLine();
    const std::string_view lineBreak = bytes_.substr(end, words_.cursor() - end);
    bool hasFormat = false;
    while (!words_.AtEnd()) {
      const std::size_t at = words_.Position();
      const std::string_view word = words_.Next(false);
      if (word == "end_header") {
        if (!hasFormat) return Fail(at, "expected a line \"format ascii 1.0\" or the like before end_header");
        // By the first line's break: a binary number may begin with the byte of a line feed.
        const std::size_t stop = words_.cursor();
        if (format_ != Format::Text && bytes_.substr(stop, lineBreak.size()) != lineBreak) {
          return Fail(
              stop, "expected the line to end like the first one; the file was damaged, perhaps by a transfer as text");
        }
        body_ = std::min(stop + lineBreak.size(), bytes_.size());
        return true;
      }
      if (word == "format") {
        if (!ReadFormat()) return false;
        hasFormat = true;
      } else if (word == "element") {
        if (!ReadElement(at)) return false;
      } else if (word == "property") {
        if (!ReadProperty(at)) return false;
      } else if (!word.empty() && word != "comment" && word != "obj_info") {
        return Fail(at, "expected format, element, property, comment or end_header, got " + Shown(word));
      }
      words_.NextLine();
    }
    return Fail(bytes_.size(), "expected \"end_header\", but the file ends; it was cut short");
  }

  bool ReadFormat() {
    const std::size_t at = words_.Position();
    const std::string_view word = words_.Next(false);
    if (word == "ascii")
      format_ = Format::Text;
    else if (word == "binary_little_endian")
      format_ = Format::LittleEndian;
    else if (word == "binary_big_endian")
      format_ = Format::BigEndian;
    else
      return Fail(at, "expected the format ascii, binary_little_endian or binary_big_endian, got " + Shown(word));
    const std::size_t versionAt = words_.Position();
    if (const std::string_view version = words_.Next(false); version != "1.0") {
      return Fail(versionAt, "expected the version 1.0, got " + Shown(version));
    }
    return EndLine();
  }

  bool ReadElement(std::size_t at) {
    Element element;
    element.place = at;
    element.name = words_.Next(false);
    if (element.name.empty()) return Fail(words_.Position(), "expected the name of an element, but the line ends");
    for (const Element& other : elements_) {
      if (other.name == element.name)
        return Fail(at, "the element " + Shown(element.name) + " stands here a second time");
    }
    const std::size_t countAt = words_.Position();
    const std::string_view count = words_.Next(false);
    const auto number = MeshNumber(count);
    if (!number || !(*number >= 0) || *number > 1e15 || *number != std::floor(*number)) {
      return Fail(countAt, "expected how many of " + Shown(element.name) + " there are, a whole number >= 0, got " +
                               Shown(count));
    }
    element.count = static_cast<std::size_t>(*number);
    elements_.push_back(std::move(element));
    return EndLine();
  }

  bool ReadProperty(std::size_t at) {
    if (elements_.empty()) return Fail(at, "expected a line \"element NAME COUNT\" before the first property");
    Property property;
    std::size_t typeAt = words_.Position();
    std::string_view type = words_.Next(false);
    if (type == "list") {
      const std::size_t countAt = words_.Position();
      const std::string_view count = words_.Next(false);
      property.count = FindType(count);
      if (!property.count || property.count->real) {
        return Fail(countAt,
                    "expected a type of whole numbers such as uchar for the length of the list, got " + Shown(count));
      }
      typeAt = words_.Position();
      type = words_.Next(false);
    }
    property.type = FindType(type);
    if (!property.type) {
      return Fail(typeAt,
                  "expected a type: char, uchar, short, ushort, int, uint, float or double, got " + Shown(type));
    }
    property.name = words_.Next(false);
    if (property.name.empty()) return Fail(words_.Position(), "expected the name of the property, but the line ends");
    std::vector<Property>& properties = elements_.back().properties;
    if (elements_.back().Find(property.name) != properties.size()) {
      return Fail(at, "the property " + Shown(property.name) + " stands here a second time");
    }
    if (properties.size() == kMostProperties) {
      return Fail(at, "expected at most " + std::to_string(kMostProperties) + " properties of an element");
    }
    properties.push_back(property);
    return EndLine();
  }

  bool EndLine() {
    const std::size_t at = words_.Position();
    const std::string_view word = words_.Next(false);
    return word.empty() || Fail(at, "expected the end of the line, got " + Shown(word));
  }

  /// The elements that are needed are there, and the file can be long enough for all.
  bool CheckElements() {
    const auto find = [&](std::string_view name) {
      return std::find_if(elements_.begin(), elements_.end(), [&](const Element& e) { return e.name == name; });
    };
    const auto vertex = find("vertex"), face = find("face");
    const auto missing = [&](const char* what) {
      messages_.Add(MakeError(source_.file(), std::string("expected ") + what));
      return false;
    };
    if (vertex == elements_.end()) return missing("an element \"vertex\" in the header, got none; this has no mesh");
    if (face == elements_.end()) {
      return missing(
          "an element \"face\" in the header, got none; points or strips do not make a cloth, export triangles");
    }
    for (const char* name : {"x", "y", "z"}) {
      const std::size_t i = vertex->Find(name);
      if (i == vertex->properties.size() || vertex->properties[i].count) {
        return Fail(vertex->place, std::string("expected a property ") + name + " of the element \"vertex\"");
      }
    }
    const std::size_t list = FaceList(*face);
    if (list == face->properties.size() || !face->properties[list].count) {
      return Fail(face->place, "expected a property \"list ... vertex_indices\" of the element \"face\"");
    }
    if (vertex->count == 0) return Fail(vertex->place, "expected vertices, got none");
    if (face->count == 0) return Fail(face->place, "expected faces, got none; export triangles");
    if (vertex->count > PolygonSoup::kMostVertices) {
      return Fail(vertex->place, "expected at most " + std::to_string(PolygonSoup::kMostVertices) + " vertices, got " +
                                     std::to_string(vertex->count) + "; reduce the mesh");
    }
    vertexCount_ = vertex->count;

    // At least: in binary the bytes of the numbers, in text a digit each.
    const std::size_t left = bytes_.size() - body_;
    std::size_t needed = 0;
    for (const Element& element : elements_) {
      std::size_t bytes = 0;
      for (const Property& property : element.properties) {
        const Type& first = property.count ? *property.count : *property.type;
        bytes += format_ == Format::Text ? 1 : first.bytes;
        if (&element == &*face && &property == &face->properties[list]) {
          bytes += 3 * (format_ == Format::Text ? 1 : property.type->bytes);
        }
      }
      if (bytes == 0) continue;
      if (element.count > (left - needed) / bytes) {
        return Fail(element.place, "expected " + std::to_string(element.count) + " of " + Shown(element.name) +
                                       ", at least " + std::to_string(bytes) + " bytes each, but only " +
                                       std::to_string(left - needed) +
                                       " bytes are left for them; the file was cut short");
      }
      needed += element.count * bytes;
    }
    return true;
  }

  static std::size_t FaceList(const Element& face) {
    const std::size_t i = face.Find("vertex_indices");
    return i < face.properties.size() ? i : face.Find("vertex_index");
  }

  // --- The numbers ---

  void ReadBody() {
    inBody_ = true;
    at_ = body_;
    if (format_ == Format::Text) {
      if (!CheckIsText(source_, "a PLY file of the format ascii", messages_)) return;
      words_.NextLine();
    }
    for (const Element& element : elements_) {
      if (element.properties.empty()) continue;
      const bool good = element.name == "vertex" ? ReadVertices(element)
                        : element.name == "face" ? ReadFaces(element)
                                                 : SkipElement(element);
      if (!good) return;
    }
    if (soup_.texture.empty() && !texture_.empty()) {
      soup_.texture = std::move(texture_);
      soup_.cornerTexture = soup_.corners;
    }
    if (format_ == Format::Text) {
      while (!words_.AtEnd()) {
        const std::size_t at = words_.Position();
        if (!words_.Next(false).empty()) {
          messages_.Add(source_.At(at, Severity::Warning, "the header counts no lines from here on; they are skipped"));
          return;
        }
        words_.NextLine();
      }
      if (!words_.Ended()) {
        messages_.Add(source_.At(bytes_.size(), Severity::Warning,
                                 "the last line does not end in a line break; the file may have been cut short"));
      }
    } else if (const std::size_t end = body_ + next_; end < bytes_.size()) {
      messages_.Add(source_.AtByte(
          end, Severity::Warning,
          "the header counts none of the last " + std::to_string(bytes_.size() - end) + " bytes; they are skipped"));
    }
  }

  /// Goes to number `index` of `element`: in text, to the next line that is not empty.
  bool Begin(const Element& element, std::size_t index) {
    if (format_ != Format::Text) return true;
    while (!words_.AtEnd()) {
      at_ = words_.Position();
      if (at_ < bytes_.size() && bytes_[at_] != '\n' && bytes_[at_] != '\r') return true;
      words_.NextLine();
    }
    return Fail(bytes_.size(), "expected " + std::to_string(element.count) + " of " + Shown(element.name) +
                                   ", but the file ends after " + std::to_string(index) + "; it was cut short");
  }

  bool End(const Element& element) {
    if (format_ != Format::Text) return true;
    const std::size_t at = words_.Position();
    if (const std::string_view word = words_.Next(false); !word.empty()) {
      return Fail(
          at, "expected the end of the line after the properties of " + Shown(element.name) + ", got " + Shown(word));
    }
    words_.NextLine();
    return true;
  }

  /// The next number; at_ is its place then.
  bool Next(const Element& element, const Property& property, const Type& type, double& number) {
    if (format_ == Format::Text) {
      at_ = words_.Position();
      const std::string_view word = words_.Next(false);
      const auto found = MeshNumber(word);
      if (found) number = *found;
      return found || Fail(at_, NotANumber(word, "the number " + Shown(property.name) + " of " + Shown(element.name)));
    }
    if (bytes_.size() - body_ - next_ < type.bytes) return CutShort(element, property);
    number = Decode(bytes_.data() + body_ + next_, type);
    at_ = body_ + next_;
    next_ += type.bytes;
    return true;
  }

  bool CutShort(const Element& element, const Property& property) {
    return Fail(bytes_.size(), "expected the number " + Shown(property.name) + " of " + Shown(element.name) +
                                   ", but the file ends; it was cut short");
  }

  double Decode(const char* from, const Type& type) const {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      const std::size_t shift = 8 * (format_ == Format::BigEndian ? type.bytes - 1 - i : i);
      bits |= std::uint64_t(static_cast<unsigned char>(from[i])) << shift;
    }
    if (type.real && type.bytes == 8) {
      double number;
      std::memcpy(&number, &bits, 8);
      return number;
    }
    if (type.real) {
      const auto half = static_cast<std::uint32_t>(bits);
      float number;
      std::memcpy(&number, &half, 4);
      return double(number);
    }
    const auto value = static_cast<std::int64_t>(bits);
    const std::int64_t span = std::int64_t{1} << (8 * type.bytes);
    return double(type.isSigned && value >= span / 2 ? value - span : value);
  }

  /// The length of a list.
  bool NextLength(const Element& element, const Property& property, std::size_t& length) {
    double number = 0;
    if (!Next(element, property, *property.count, number)) return false;
    if (!(number >= 0) || number != std::floor(number) || number > 1e10) {
      return Fail(at_, "expected the length of the list " + Shown(property.name) + ", a whole number >= 0, got " +
                           FormatNumber(number));
    }
    length = static_cast<std::size_t>(number);
    if (format_ != Format::Text && length > (bytes_.size() - body_ - next_) / property.type->bytes) {
      return Fail(at_, "expected a list " + Shown(property.name) + " that ends within the file, got a length of " +
                           std::to_string(length) + "; the file was cut short or damaged");
    }
    return true;
  }

  /// Passes over one property, whatever is in it.
  bool Skip(const Element& element, const Property& property) {
    std::size_t length = 1;
    if (property.count && !NextLength(element, property, length)) return false;
    if (format_ != Format::Text) {
      if (length > (bytes_.size() - body_ - next_) / property.type->bytes) return CutShort(element, property);
      next_ += length * property.type->bytes;
      return true;
    }
    for (std::size_t i = 0; i < length; ++i) {
      at_ = words_.Position();
      if (words_.Next(false).empty())
        return Fail(at_, NotANumber("", "the number " + Shown(property.name) + " of " + Shown(element.name)));
    }
    return true;
  }

  bool SkipElement(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!Begin(element, i)) return false;
      for (const Property& property : element.properties) {
        if (!Skip(element, property)) return false;
      }
      if (!End(element)) return false;
    }
    return true;
  }

  bool ReadVertices(const Element& element) {
    // Where x, y, z, u, v stand among the properties.
    std::array<std::size_t, 5> slots{element.Find("x"), element.Find("y"), element.Find("z"), std::string::npos,
                                     std::string::npos};
    constexpr std::array<std::array<const char*, 2>, 4> kNames = {
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};
    for (const auto& names : kNames) {
      const std::size_t u = element.Find(names[0]), v = element.Find(names[1]), none = element.properties.size();
      if (u == none || v == none || element.properties[u].count || element.properties[v].count) continue;
      slots[3] = u;
      slots[4] = v;
      break;
    }
    const bool hasTexture = slots[3] != std::string::npos;
    soup_.positions.reserve(element.count);
    if (hasTexture) texture_.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!Begin(element, i)) return false;
      std::array<double, 5> values{};
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        const auto slot = static_cast<std::size_t>(std::find(slots.begin(), slots.end(), p) - slots.begin());
        if (slot == slots.size()) {
          if (!Skip(element, property)) return false;
          continue;
        }
        if (!Next(element, property, *property.type, values[slot])) return false;
        if (const auto problem = CoordinateProblem(values[slot], slot < 3 ? scale_ : 1)) {
          return Fail(at_, "vertex " + std::to_string(i) + ": " + *problem);
        }
      }
      if (!End(element)) return false;
      soup_.positions.push_back({scale_ * values[0], scale_ * values[1], scale_ * values[2]});
      if (hasTexture) texture_.push_back({values[3], values[4]});
    }
    return true;
  }

  bool ReadFaces(const Element& element) {
    const std::size_t list = FaceList(element);
    std::size_t wedges = element.Find("texcoord");  // texture coordinates of the corners, as MeshLab writes them
    if (wedges < element.properties.size() && !element.properties[wedges].count) wedges = element.properties.size();
    const std::size_t most = std::min(element.count, PolygonSoup::kMostCorners / 3);
    soup_.polygonEnds.reserve(most);
    soup_.polygonPlaces.reserve(most);
    soup_.corners.reserve(3 * most);
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!Begin(element, i)) return false;
      const std::size_t place = format_ == Format::Text ? at_ : body_ + next_, begin = soup_.corners.size();
      coordinates.clear();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (p == list) {
          if (!ReadCorners(element, property, i)) return false;
        } else if (p == wedges) {
          if (!ReadWedges(element, property, coordinates)) return false;
        } else if (!Skip(element, property)) {
          return false;
        }
      }
      if (!End(element)) return false;
      const std::size_t corners = soup_.corners.size() - begin;
      if (!coordinates.empty() && coordinates.size() != 2 * corners) {
        return Fail(place, "face " + std::to_string(i) + ": expected two numbers of \"texcoord\" for each of " +
                               std::to_string(corners) + " corners, got " + std::to_string(coordinates.size()));
      }
      for (std::size_t k = 0; k < corners; ++k) {
        if (coordinates.empty()) {
          soup_.cornerTexture.push_back(-1);
        } else {
          soup_.cornerTexture.push_back(static_cast<std::int32_t>(soup_.texture.size()));
          soup_.texture.push_back({coordinates[2 * k], coordinates[2 * k + 1]});
        }
      }
      soup_.polygonEnds.push_back(soup_.corners.size());
      soup_.polygonPlaces.push_back(place);
    }
    return true;
  }

  bool ReadCorners(const Element& element, const Property& property, std::size_t face) {
    std::size_t length = 0;
    if (!NextLength(element, property, length)) return false;
    const std::string name = "face " + std::to_string(face) + ": ";
    if (length < 3) return Fail(at_, name + "expected at least three corners, got " + std::to_string(length));
    if (length > PolygonSoup::kMostCorners - soup_.corners.size()) {
      return Fail(at_, name + "expected at most " + std::to_string(PolygonSoup::kMostCorners) +
                           " corners in all; reduce the mesh");
    }
    for (std::size_t k = 0; k < length; ++k) {
      double index = 0;
      if (!Next(element, property, *property.type, index)) return false;
      if (!(index >= 0) || index != std::floor(index) || index >= double(vertexCount_)) {
        return Fail(at_, name + "expected the number of a vertex, 0.." + std::to_string(vertexCount_ - 1) + ", got " +
                             FormatNumber(index));
      }
      soup_.corners.push_back(static_cast<std::int32_t>(index));
    }
    return true;
  }

  bool ReadWedges(const Element& element, const Property& property, std::vector<double>& coordinates) {
    std::size_t length = 0;
    if (!NextLength(element, property, length)) return false;
    for (std::size_t k = 0; k < length; ++k) {
      double number = 0;
      if (!Next(element, property, *property.type, number)) return false;
      if (const auto problem = CoordinateProblem(number, 1)) return Fail(at_, *problem);
      coordinates.push_back(number);
    }
    return true;
  }

  static constexpr std::size_t kMostProperties = 1000;

  const MeshSource& source_;
  std::string_view bytes_;
  double scale_;
  MeshMessages& messages_;
  MeshWords words_;
  PolygonSoup soup_;
  Format format_ = Format::Text;
  std::vector<Element> elements_;
  std::size_t vertexCount_ = 0;
  std::size_t body_ = 0;  ///< Where the numbers begin.
  std::size_t next_ = 0;  ///< In binary, of the next number from there.
  std::size_t at_ = 0;    ///< Of the number that was read last, in the file.
  bool inBody_ = false;
  std::vector<Vec2> texture_;  ///< Of the vertices, which counts where the faces have none.
};

}  // namespace

PolygonSoup ReadPlyPolygons(const MeshSource& source, double scale, MeshMessages& messages) {
  return PlyReader(source, scale, messages).Read();
}

}  // namespace percale
