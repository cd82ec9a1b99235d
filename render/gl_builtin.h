#pragma once
/// \file
/// Drawing with shaders of the program's own, which are no files: heat maps, marks. OpenGL names are
/// plain numbers here.

#include "render/draw_list.h"

namespace percale {

class GlBuiltin {
 public:
  GlBuiltin() = default;
  ~GlBuiltin();
  GlBuiltin(const GlBuiltin&) = delete;
  GlBuiltin& operator=(const GlBuiltin&) = delete;

  /// Makes the heat map's program the one in use, for meshes with values. Their positions, normals and
  /// values are attributes 0, 1 and kValueAttribute.
  void UseHeatMap(const DrawList& list, const Mat4& model);
  /// Draws the marks of a list into a picture of that height [pixel].
  void DrawMarks(const DrawList& list, int height);

  static constexpr unsigned kValueAttribute = 4;

 private:
  unsigned heatMap_ = 0, marks_ = 0;
  unsigned vertexArray_ = 0, buffer_ = 0;
};

}  // namespace percale
