#pragma once
/// \file
/// Font, sizes and colours of the panels.

namespace percale::viewer {

/// Sets up the current Dear ImGui context. `scale`: of sizes, in screen units, 1 on a display of
/// ordinary density; `fontScale`: of the font, in pixels; `pixelsPerUnit`: pixels of a screen unit.
void ApplyStyle(float scale, float fontScale, float pixelsPerUnit);

}  // namespace percale::viewer
