// Wavefront OBJ: vertices, texture coordinates, polygons and their groups. What else a file holds is skipped.

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>

#include "core/text.h"
#include "io/mesh_source.h"

namespace percale {
namespace {

/// Of a line "g a b c ...", so many names count.
constexpr std::size_t kMostNames = 16;
constexpr std::size_t kMostGroups = 100'000;

/// Words that begin a line and change nothing here.
constexpr std::array<std::string_view, 28> kSkipped = {
    "vn",   "vp",  "s",    "usemtl", "mtllib", "usemap", "maplib", "lod",      "bevel",      "c_interp",
    "mg",   "deg", "bmat", "step",   "cstype", "parm",   "trim",   "d_interp", "shadow_obj", "hole",
    "scrv", "sp",  "end",  "con",    "ctech",  "stech",  "call",   "trace_obj"};
/// Words that stand for geometry which is no polygon.
constexpr std::array<std::string_view, 5> kOtherElements = {"l", "p", "curv", "curv2", "surf"};
/// Words that are read.
constexpr std::array<std::string_view, 6> kRead = {"v", "vt", "f", "g", "o", "vn"};

bool Contains(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A whole number with or without a sign; nothing for anything else. Beyond 18 digits it is larger than any index.
std::optional<std::int64_t> Whole(std::string_view text) {
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  constexpr std::int64_t kHuge = 1'000'000'000'000'000'000;
  std::int64_t number = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    number = number >= kHuge / 10 ? kHuge : 10 * number + (c - '0');
  }
  return negative ? -number : number;
}

class ObjReader {
 public:
  ObjReader(const MeshSource& source, double scale, MeshMessages& messages)
      : source_(source), scale_(scale), messages_(messages), words_(source.bytes(), true) {}

  PolygonSoup Read() {
    if (!CheckIsText(source_, "a Wavefront OBJ file", messages_)) return {};
    while (!words_.AtEnd() && !messages_.full()) {
      const std::size_t at = words_.Position();
      const std::string_view word = words_.Next(true);
      if (word == "v")
        ReadPosition(at);
      else if (word == "vt")
        ReadTexture(at);
      else if (word == "f")
        ReadPolygon(at);
      else if (word == "g" || word == "o")
        ReadNames(word == "g");
      else if (Contains(kOtherElements, word))
        Count(others_, at, word);
      else if (!word.empty() && !Contains(kSkipped, word))
        Count(unknown_, at, word);
      words_.NextLine();
    }
    EndGroups();
    Report();
    return std::move(soup_);
  }

 private:
  struct Counted {
    std::size_t count = 0, place = 0;
    std::string_view first;
  };
  static void Count(Counted& counted, std::size_t at, std::string_view word) {
    if (counted.count++ == 0) counted.place = at, counted.first = word;
  }

  void Fail(std::size_t at, std::string message) {
    if (!messages_.full()) messages_.Add(source_.At(at, Severity::Error, std::move(message)));
  }

  /// The numbers of the line, at least `least` and at most `most` of them, the first `used` of which become
  /// coordinates; says what is wrong with them.
  void ReadNumbers(std::array<double, 7>& numbers, std::size_t least, std::size_t most, std::size_t used, double scale,
                   const char* names) {
    for (std::size_t count = 0;; ++count) {
      const std::size_t at = words_.Position();
      const std::string_view word = words_.Next(true);
      if (word.empty() && count >= least) return;
      if (count == most) return Fail(at, std::string("expected the end of ") + names + ", got " + Shown(word));
      const auto number = MeshNumber(word);
      if (!number) return Fail(at, NotANumber(word, std::string("a number of ") + names));
      if (count >= used) continue;
      if (const auto problem = CoordinateProblem(*number, scale)) return Fail(at, *problem);
      numbers[count] = scale * *number;
    }
  }

  void ReadPosition(std::size_t at) {
    // A weight or a colour may follow. What cannot be read still counts, or all faces would be wrong.
    std::array<double, 7> x{};
    ReadNumbers(x, 3, 7, 3, scale_, "\"v x y z\"");
    if (soup_.positions.size() == PolygonSoup::kMostVertices) return TooMany(at, "vertices", soup_.positions.size());
    soup_.positions.push_back({x[0], x[1], x[2]});
  }

  void ReadTexture(std::size_t at) {
    std::array<double, 7> x{};
    ReadNumbers(x, 1, 3, 2, 1, "\"vt u v\"");
    if (soup_.texture.size() == PolygonSoup::kMostCorners)
      return TooMany(at, "texture coordinates", soup_.texture.size());
    soup_.texture.push_back({x[0], x[1]});
  }

  void TooMany(std::size_t at, const char* what, std::size_t most) {
    Fail(at, "expected at most " + std::to_string(most) + " " + what + ", here is one more; reduce the mesh");
    messages_.Stop();
  }

  /// Index from 0 of number `index` from 1 or, negative, from the last, among `count`.
  std::optional<std::int32_t> Resolve(std::size_t at, std::string_view text, std::size_t count, const char* what) {
    const auto number = Whole(text);
    if (!number) {
      Fail(at, "expected a corner such as 3, 3/1 or 3/1/2 with the number of " + std::string(what) + ", got " +
                   Shown(text));
      return std::nullopt;
    }
    const auto most = static_cast<std::int64_t>(count);
    const std::int64_t index = *number > 0 ? *number - 1 : most + *number;
    if (*number != 0 && index >= 0 && index < most) return static_cast<std::int32_t>(index);
    const std::string range =
        most == 0   ? "there is none above this line"
        : most == 1 ? "there is 1 above this line"
                    : "there are " + std::to_string(most) + " above this line, 1.." + std::to_string(most);
    Fail(at, "expected the number of " + std::string(what) + ", got " + std::string(text.substr(0, 40)) + "; " + range);
    return std::nullopt;
  }

  void ReadPolygon(std::size_t at) {
    const std::size_t begin = soup_.corners.size();
    const auto undo = [&] {
      soup_.corners.resize(begin);
      soup_.cornerTexture.resize(begin);
    };
    for (;;) {
      const std::size_t place = words_.Position();
      const std::string_view word = words_.Next(true);
      if (word.empty()) break;
      const std::size_t slash = word.find('/');
      const auto vertex = Resolve(place, word.substr(0, slash), soup_.positions.size(), "a vertex");
      if (!vertex) return undo();
      std::int32_t texture = -1;
      if (slash != std::string_view::npos) {
        const std::string_view rest = word.substr(slash + 1);
        const std::size_t second = rest.find('/');
        if (const std::string_view index = rest.substr(0, second); !index.empty()) {
          const auto found = Resolve(place, index, soup_.texture.size(), "texture coordinates");
          if (!found) return undo();
          texture = *found;
        }
        const std::string_view normal = second == std::string_view::npos ? "" : rest.substr(second + 1);
        if (!normal.empty() && !Whole(normal)) {
          Fail(place, "expected the number of a normal behind the second '/', got " + Shown(normal));
          return undo();
        }
      }
      if (soup_.corners.size() == PolygonSoup::kMostCorners) {
        TooMany(place, "corners of polygons", soup_.corners.size());
        return undo();
      }
      soup_.corners.push_back(*vertex);
      soup_.cornerTexture.push_back(texture);
    }
    if (soup_.corners.size() - begin < 3) {
      Fail(at, "expected at least three corners after \"f\", got " + std::to_string(soup_.corners.size() - begin));
      return undo();
    }
    soup_.polygonEnds.push_back(soup_.corners.size());
    soup_.polygonPlaces.push_back(at);
  }

  void ReadNames(bool group) {
    EndGroups();
    std::vector<std::size_t>& current = group ? groups_ : object_;
    current.clear();
    if (!group) {
      AddName(current, words_.Rest());
      groups_.clear();  // those of the object before
      return;
    }
    for (std::size_t i = 0; i < kMostNames; ++i) {
      const std::string_view word = words_.Next(false);
      if (word.empty()) return;
      AddName(current, word);
    }
    const std::size_t at = words_.Position();
    if (const std::string_view word = words_.Next(false); !word.empty()) Count(manyNames_, at, word);
  }

  void AddName(std::vector<std::size_t>& current, std::string_view name) {
    if (name.empty()) return;
    auto found = known_.find(name);
    if (found == known_.end()) {
      if (soup_.groups.size() == kMostGroups) {
        Count(manyGroups_, words_.cursor(), name);
        return;
      }
      found = known_.emplace(std::string(name), soup_.groups.size()).first;
      soup_.groups.push_back({std::string(name), {}});
    }
    if (std::find(current.begin(), current.end(), found->second) == current.end()) current.push_back(found->second);
  }

  /// The polygons since the last change of names belong to what was named.
  void EndGroups() {
    const std::size_t end = soup_.polygonEnds.size();
    if (end > since_) {
      for (const auto* list : {&object_, &groups_}) {
        for (const std::size_t group : *list) soup_.groups[group].polygons.emplace_back(since_, end);
      }
    }
    since_ = end;
  }

  void Report() {
    const auto warn = [&](const Counted& counted, const std::string& message) {
      if (counted.count > 0) messages_.Add(source_.At(counted.place, Severity::Warning, message));
    };
    const auto lines = [](std::size_t count) { return std::to_string(count) + (count == 1 ? " line " : " lines "); };
    warn(unknown_, lines(unknown_.count) + "skipped: expected v, vt, vn, f, g, o or another word of OBJ, got " +
                       Shown(unknown_.first) + DidYouMean(unknown_.first.substr(0, 20), kRead));
    warn(others_, lines(others_.count) + "skipped: only polygons become cloth, not points, lines and curves");
    warn(manyNames_, lines(manyNames_.count) + "with more than " + std::to_string(kMostNames) +
                         " names of groups; the rest do not count");
    warn(manyGroups_, "expected at most " + std::to_string(kMostGroups) + " groups; the rest do not count");
    if (!words_.Ended() && !messages_.full()) {
      messages_.Add(source_.At(source_.bytes().size(), Severity::Warning,
                               "the last line does not end in a line break; the file may have been cut short"));
    }
    if (messages_.failed()) return;
    if (soup_.positions.empty()) {
      messages_.Add(
          MakeError(source_.file(), "expected lines \"v x y z\", got none; this is no OBJ file, or has no mesh"));
    } else if (soup_.polygonEnds.empty()) {
      messages_.Add(
          MakeError(source_.file(), "expected lines \"f a b c\", got none: " + std::to_string(soup_.positions.size()) +
                                        " vertices without triangles; export the faces"));
    }
  }

  const MeshSource& source_;
  double scale_;
  MeshMessages& messages_;
  MeshWords words_;
  PolygonSoup soup_;
  std::map<std::string, std::size_t, std::less<>> known_;  // names and their groups
  std::vector<std::size_t> object_, groups_;               // which polygons belong to now
  std::size_t since_ = 0;                                  // the first polygon of them
  Counted unknown_, others_, manyNames_, manyGroups_;
};

}  // namespace

PolygonSoup ReadObjPolygons(const MeshSource& source, double scale, MeshMessages& messages) {
  return ObjReader(source, scale, messages).Read();
}

}  // namespace percale
