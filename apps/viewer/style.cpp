#include "apps/viewer/style.h"

#include <imgui.h>

#include <cmath>
#include <filesystem>
#include <system_error>

namespace percale::viewer {
namespace {

constexpr float kFontSize = 15;         // [pixel]
constexpr float kBuiltInFontSize = 13;  // Of ImGui's own font, which is a bitmap.

/// Fonts that systems come with. Without any, ImGui's own serves.
constexpr const char* kFonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",                  // Debian, Ubuntu
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",                // Fedora
    "/usr/share/fonts/TTF/DejaVuSans.ttf",                              // Arch
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",              //
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",  //
    "/System/Library/Fonts/Supplemental/Arial.ttf",                     // macOS
    "C:\\Windows\\Fonts\\segoeui.ttf",                                  //
};

const ImVec4 kOrange{0.90f, 0.62f, 0.00f, 1}, kSkyBlue{0.34f, 0.71f, 0.91f, 1}, kYellow{0.94f, 0.89f, 0.26f, 1},
    kBlue{0.00f, 0.45f, 0.70f, 1}, kVermillion{1.00f, 0.49f, 0.20f, 1};  // The last one lighter, to be read on dark.

ImVec4 Grey(float value, float alpha = 1) {
  return {value, value, value, alpha};
}

void SetColors(ImGuiStyle& style) {
  ImGui::StyleColorsDark(&style);
  const ImVec4 accent = kBlue, accentBright = kSkyBlue, accentDim(0.0f, 0.36f, 0.57f, 1);
  ImVec4* colors = style.Colors;
  colors[ImGuiCol_Text] = Grey(0.94f);
  colors[ImGuiCol_TextDisabled] = Grey(0.64f);
  colors[ImGuiCol_WindowBg] = Grey(0.13f);
  colors[ImGuiCol_PopupBg] = Grey(0.11f);
  colors[ImGuiCol_Border] = Grey(0.32f, 0.8f);
  colors[ImGuiCol_FrameBg] = Grey(0.23f);
  colors[ImGuiCol_FrameBgHovered] = Grey(0.30f);
  colors[ImGuiCol_FrameBgActive] = Grey(0.34f);
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = Grey(0.19f);
  colors[ImGuiCol_CheckMark] = accentBright;
  colors[ImGuiCol_SliderGrab] = accent;
  colors[ImGuiCol_SliderGrabActive] = accentBright;
  colors[ImGuiCol_Button] = Grey(0.27f);
  colors[ImGuiCol_ButtonHovered] = accentDim;
  colors[ImGuiCol_ButtonActive] = accent;
  colors[ImGuiCol_Header] = Grey(0.21f);
  colors[ImGuiCol_HeaderHovered] = accentDim;
  colors[ImGuiCol_HeaderActive] = accent;
  colors[ImGuiCol_TextSelectedBg] = accentDim;
  colors[ImGuiCol_NavHighlight] = kOrange;
}

}  // namespace

ImVec4 AccentColor() {
  return kSkyBlue;
}

ImVec4 SeverityColor(Severity severity) {
  return severity == Severity::Error ? kVermillion : severity == Severity::Warning ? kYellow : Grey(0.94f);
}

void ApplyStyle(float scale, float fontScale, float pixelsPerUnit) {
  ImGuiStyle style;  // Anew: sizes are scaled from their defaults.
  SetColors(style);
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.PopupRounding = 3;
  style.ScrollbarSize = 11;
  style.WindowPadding = {8, 8};
  style.FramePadding = {5, 2};
  style.ItemSpacing = {6, 4};
  style.WindowBorderSize = 0;
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;

  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFont* font = nullptr;
  for (const char* file : kFonts) {
    std::error_code error;
    if (font || !std::filesystem::is_regular_file(file, error)) continue;
    font = io.Fonts->AddFontFromFileTTF(file, std::round(kFontSize * fontScale));
  }
  if (!font) {
    ImFontConfig config;
    config.SizePixels = std::round(kBuiltInFontSize * fontScale);
    io.Fonts->AddFontDefault(&config);
  }
  io.FontGlobalScale = 1 / pixelsPerUnit;
}

}  // namespace percale::viewer
