#pragma once
/// \file
/// Font, sizes and colours of the panels.

#include <imgui.h>

#include "percale/diagnostic.h"

namespace percale::viewer {

// Of the colours of Okabe and Ito, which people tell apart however they see colours.

/// Of keys, and of what is chosen.
ImVec4 AccentColor();
/// Of an error, a warning or a note. Its word stands beside it.
ImVec4 SeverityColor(Severity severity);

/// Sets up the current Dear ImGui context. `scale`: of sizes, in screen units, 1 on a display of
/// ordinary density; `fontScale`: of the font, in pixels; `pixelsPerUnit`: pixels of a screen unit.
void ApplyStyle(float scale, float fontScale, float pixelsPerUnit);

}  // namespace percale::viewer
