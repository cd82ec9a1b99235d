#pragma once
/// \file
/// What the user has changed, in order, so that it can be taken back and done again.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "percale/scene.h"
#include "render/shader_library.h"

namespace percale::viewer {

/// Values of a shader's parameters, by the names of their uniforms; nothing stands for the default.
using ShaderValues = std::map<std::string, std::optional<UniformValue>>;

/// One thing that the user did. It changed the settings, or the state, or both.
struct Change {
  std::string label;              ///< "Spring constant", "Drag".
  std::string path = {};          ///< Of the parameter, where it is one.
  Scene before = {}, after = {};  ///< The settings.
  std::uint64_t command = 0;      ///< The command that was executed for it and whose state before it is kept, or 0.
  bool texture = false;           ///< Another file is the shaders' first texture; the settings do not differ.
  std::filesystem::path textureBefore = {}, textureAfter = {};
  std::string shader = {};  ///< Its parameters have other values; the settings do not differ. Empty: none's.
  ShaderValues valuesBefore = {}, valuesAfter = {};
};

/// A scene with what differs between `from` and `to` as it is in `to`, and all else as it was; or `to` itself where
/// that would not be a scene, as another grid under the same pins.
Scene WithChange(const Scene& scene, const Scene& from, const Scene& to);

class UndoStack {
 public:
  /// How many changes are remembered.
  static constexpr std::size_t kMost = 200;

  /// While the user holds something, changes of the same parameter count as one.
  void Hold(bool held);
  /// Whether a change of that parameter now is to be merged with the last.
  bool Merges(const std::string& path) const;
  /// Puts a change on top; what was undone cannot be done again any more.
  void Push(Change change);
  /// Extends the change on top.
  void Extend(const Scene& after);
  void Extend(const ShaderValues& after);

  /// The change to take back, or to do again; null where there is none. Call Undone or Redone when it is done.
  const Change* ToUndo() const { return done_.empty() ? nullptr : &done_.back(); }
  const Change* ToRedo() const { return undone_.empty() ? nullptr : &undone_.back(); }
  /// `command`: whose state before it is the one that the step has left, or 0.
  void Undone(std::uint64_t command);
  void Redone(std::uint64_t command);
  void Clear();

 private:
  std::vector<Change> done_, undone_;
  bool held_ = false;
  bool begun_ = false;  // What is held has changed something: the change on top.
};

}  // namespace percale::viewer
