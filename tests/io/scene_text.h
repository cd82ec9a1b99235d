#pragma once
/// \file
/// Scene texts whose values have known places, for the loader's tests.

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "percale/parameters.h"

namespace percale::test {

/// One object of each group, every value valid, the cloth with two pins.
inline Scene OneOfEach(Engine engine = Engine::Springs) {
  Scene scene;
  scene.simulation.engine = engine;
  for (const ParameterGroup& group : ParameterGroups()) group.resize(scene, 1);
  scene.cloths[0].pinned = {{0, 0}, {49, 0}};
  scene.tethers[0].points = {{2, 3}};
  return scene;
}

struct SceneText {
  std::string text;
  std::map<std::string, std::size_t> at;  ///< Offset of each value and object by path: "/cloth/ks", "/cloth".
};

/// `scene`, which holds one object of each group, as a text with one group per line, of what its engine heeds. The
/// value at `path` is written as `replacement`, or left out if that is empty. A comment of two-byte characters before
/// each object's values tells columns from bytes.
inline SceneText Write(const Scene& scene, const std::string& path = "",
                       const std::optional<std::string>& replacement = {}) {
  SceneText out;
  out.text = "{ \"_\": \"\xc3\xa9\"";
  for (const ParameterGroup& group : ParameterGroups()) {
    const std::string groupPath = "/" + std::string(group.name);
    out.text += ",\n  \"" + std::string(group.name) + "\": ";
    out.at[groupPath] = out.text.size();
    if (groupPath == path && replacement) {
      out.text += *replacement;
      continue;
    }
    out.text += "{ \"_\": \"\xc3\xa9\xc3\xa9\"";
    for (const Parameter& p : Parameters()) {
      if (p.group != group.name || !IsHeeded(p, scene)) continue;
      const std::string valuePath = groupPath + "/" + std::string(p.name);
      if (valuePath == path && !replacement) continue;
      out.text += ", \"" + std::string(p.name) + "\": ";
      out.at[valuePath] = out.text.size();
      out.text += valuePath == path ? *replacement : FormatValue(p.get(scene, 0));
    }
    out.text += " }";
  }
  out.text += "\n}\n";
  return out;
}

/// Line and column of an offset, counted the plain way.
inline Place PlaceAt(const std::string& text, std::size_t offset) {
  Place place{"", 1, 1};
  for (std::size_t k = 0; k < offset && k < text.size(); ++k) {
    if (text[k] == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((static_cast<unsigned char>(text[k]) & 0xc0) != 0x80) {
      ++place.column;
    }
  }
  return place;
}

/// Whether the text has that place: a character, or the end of a line.
inline bool Contains(const std::string& text, const Place& place) {
  Place at{"", 1, 1};
  for (std::size_t k = 0; k <= text.size(); ++k) {
    if (at.line == place.line && at.column == place.column) return true;
    if (k == text.size()) break;
    if (text[k] == '\n') {
      ++at.line;
      at.column = 1;
    } else if ((static_cast<unsigned char>(text[k]) & 0xc0) != 0x80) {
      ++at.column;
    }
  }
  return false;
}

/// Whether every parameter of every object has the same value in both.
inline bool Same(const Scene& a, const Scene& b) {
  for (const Parameter& p : Parameters()) {
    const ParameterGroup& group = *FindGroup(p.group);
    if (group.count(a) != group.count(b)) return false;
    for (std::size_t i = 0; i < group.count(a); ++i) {
      if (p.get(a, i) != p.get(b, i)) return false;
    }
  }
  return a.planesFirst == b.planesFirst;
}

}  // namespace percale::test
