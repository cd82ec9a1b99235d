#include "render/legend.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "render/ticks.h"

namespace percale {
namespace {

// Characters of 5 x 7 dots as on a character display: five columns each, the lowest bit on top.
constexpr int kColumns = 5, kRows = 8, kAdvance = 6;
struct Glyph {
  char character;
  std::uint8_t columns[kColumns];
};
// clang-format off
constexpr Glyph kGlyphs[] = {
    {'(', {0x00, 0x1c, 0x22, 0x41, 0x00}}, {')', {0x00, 0x41, 0x22, 0x1c, 0x00}}, {'+', {0x08, 0x08, 0x3e, 0x08, 0x08}},
    {'-', {0x08, 0x08, 0x08, 0x08, 0x08}}, {'.', {0x00, 0x60, 0x60, 0x00, 0x00}}, {'/', {0x20, 0x10, 0x08, 0x04, 0x02}},
    {'0', {0x3e, 0x51, 0x49, 0x45, 0x3e}}, {'1', {0x00, 0x42, 0x7f, 0x40, 0x00}}, {'2', {0x42, 0x61, 0x51, 0x49, 0x46}},
    {'3', {0x21, 0x41, 0x45, 0x4b, 0x31}}, {'4', {0x18, 0x14, 0x12, 0x7f, 0x10}}, {'5', {0x27, 0x45, 0x45, 0x45, 0x39}},
    {'6', {0x3c, 0x4a, 0x49, 0x49, 0x30}}, {'7', {0x01, 0x71, 0x09, 0x05, 0x03}}, {'8', {0x36, 0x49, 0x49, 0x49, 0x36}},
    {'9', {0x06, 0x49, 0x49, 0x29, 0x1e}}, {'a', {0x20, 0x54, 0x54, 0x54, 0x78}}, {'b', {0x7f, 0x48, 0x44, 0x44, 0x38}},
    {'c', {0x38, 0x44, 0x44, 0x44, 0x20}}, {'d', {0x38, 0x44, 0x44, 0x48, 0x7f}}, {'e', {0x38, 0x54, 0x54, 0x54, 0x18}},
    {'f', {0x08, 0x7e, 0x09, 0x01, 0x02}}, {'g', {0x0c, 0x52, 0x52, 0x52, 0x3e}}, {'h', {0x7f, 0x08, 0x04, 0x04, 0x78}},
    {'i', {0x00, 0x44, 0x7d, 0x40, 0x00}}, {'j', {0x20, 0x40, 0x44, 0x3d, 0x00}}, {'k', {0x7f, 0x10, 0x28, 0x44, 0x00}},
    {'l', {0x00, 0x41, 0x7f, 0x40, 0x00}}, {'m', {0x7c, 0x04, 0x18, 0x04, 0x78}}, {'n', {0x7c, 0x08, 0x04, 0x04, 0x78}},
    {'o', {0x38, 0x44, 0x44, 0x44, 0x38}}, {'p', {0x7c, 0x14, 0x14, 0x14, 0x08}}, {'q', {0x08, 0x14, 0x14, 0x18, 0x7c}},
    {'r', {0x7c, 0x08, 0x04, 0x04, 0x08}}, {'s', {0x48, 0x54, 0x54, 0x54, 0x20}}, {'t', {0x04, 0x3f, 0x44, 0x40, 0x20}},
    {'u', {0x3c, 0x40, 0x40, 0x20, 0x7c}}, {'v', {0x1c, 0x20, 0x40, 0x20, 0x1c}}, {'w', {0x3c, 0x40, 0x30, 0x40, 0x3c}},
    {'x', {0x44, 0x28, 0x10, 0x28, 0x44}}, {'y', {0x0c, 0x50, 0x50, 0x50, 0x3c}}, {'z', {0x44, 0x64, 0x54, 0x4c, 0x44}},
};
// clang-format on

constexpr Rgb kInk{0.95f, 0.95f, 0.95f};
constexpr float kDimming = 0.35f;  // of the picture behind the legend
constexpr int kTicks = 5;          // steps of the numbers, about; an automatic range ends with one

/// Dots are squares of so many pixels.
int DotSize(int height) {
  return std::max(1, static_cast<int>(std::lround(height / 400.0)));
}

void Fill(Image& image, int x, int y, int width, int height, const Rgb& color) {
  for (int row = std::max(y, 0); row < std::min(y + height, image.height); ++row) {
    for (int column = std::max(x, 0); column < std::min(x + width, image.width); ++column) {
      for (std::size_t k = 0; k < 3; ++k)
        image.At(column, row)[k] = static_cast<std::uint8_t>(std::lround(255 * color[k]));
    }
  }
}

void Dim(Image& image, int width, int height) {
  for (int y = 0; y < std::min(height, image.height); ++y) {
    for (int x = 0; x < std::min(width, image.width); ++x) {
      for (int k = 0; k < 3; ++k)
        image.At(x, y)[k] = static_cast<std::uint8_t>(std::lround(kDimming * float(image.At(x, y)[k])));
    }
  }
}

int TextWidth(std::string_view text, int dot) {
  return (static_cast<int>(text.size()) * kAdvance - 1) * dot;
}

void DrawText(Image& image, int x, int y, std::string_view text, int dot) {
  for (const char c : text) {
    const char small = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.character != small) continue;
      for (int column = 0; column < kColumns; ++column) {
        for (int row = 0; row < kRows; ++row) {
          if (glyph.columns[column] >> row & 1) Fill(image, x + column * dot, y + row * dot, dot, dot, kInk);
        }
      }
    }
    x += kAdvance * dot;
  }
}

}  // namespace

LegendBar PlaceLegend(int width, int height) {
  const int dot = DotSize(height), margin = 8 * dot;
  const int title = margin + (kRows + 3) * dot;
  return {2 * margin, title, std::min(180 * dot, width - 4 * margin), 8 * dot};
}

void DrawLegend(Image& image, const HeatScale& scale) {
  const LegendBar bar = PlaceLegend(image.width, image.height);
  if (scale.quantity == Quantity::None || bar.width < 40) return;
  const int dot = DotSize(image.height), below = bar.y + bar.height + 2 * dot;
  const QuantityInfo& info = Describe(scale.quantity);
  Dim(image, bar.x + bar.width + 16 * dot, below + (kRows + 4) * dot);
  std::string title(info.label);
  if (!info.unit.empty()) title += " (" + std::string(info.unit) + ")";
  DrawText(image, bar.x, 8 * dot, title, dot);

  if (scale.quantity == Quantity::Contact) {
    const int part = bar.width / 3;
    for (int k = 0; k < 3; ++k) {
      Fill(image, bar.x + k * part, bar.y, part, bar.height, kContactColors[k]);
      const std::string_view label = kContactLabels[k];
      DrawText(image, bar.x + k * part + (part - TextWidth(label, dot)) / 2, below, label, dot);
    }
    return;
  }
  for (int x = 0; x < bar.width; ++x)
    Fill(image, bar.x + x, bar.y, 1, bar.height, HeatColor(double(x) / (bar.width - 1)));
  const double span = scale.range.high - scale.range.low;
  const std::vector<double> ticks = Ticks(scale.range.low, scale.range.high, kTicks);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : span;
  int taken = 0;  // columns that have text
  for (const double tick : ticks) {
    const int x = bar.x + static_cast<int>(std::lround((tick - scale.range.low) / span * (bar.width - 1)));
    Fill(image, x, bar.y + bar.height, dot, dot, kInk);
    const std::string text = TickText(tick, step);
    const int left = x - TextWidth(text, dot) / 2;
    if (left < taken) continue;
    DrawText(image, left, below, text, dot);
    taken = left + TextWidth(text, dot) + kAdvance * dot;
  }
}

}  // namespace percale
