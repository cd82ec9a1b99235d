#pragma once
/// \file
/// Pictures in memory, and PNG files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "percale/diagnostic.h"

namespace percale {

/// A picture of 8 bits per channel, without colour management: numbers go in and out as they are.
struct Image {
  int width = 0;                   ///< [pixel]
  int height = 0;                  ///< [pixel]
  std::vector<std::uint8_t> rgba;  ///< width * height * 4 values, top row first.

  const std::uint8_t* At(int x, int y) const {
    return &rgba[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4];
  }
  std::uint8_t* At(int x, int y) { return &rgba[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 4]; }
};

/// A black, opaque picture.
Image MakeImage(int width, int height);

/// A named text inside a PNG file.
struct PngText {
  std::string keyword;  ///< 1..79 printable Latin-1 characters: "Title", "percale:scene".
  std::string text;     ///< UTF-8, any length; a long one is compressed.
  friend bool operator==(const PngText&, const PngText&) = default;
};

struct PngOptions {
  int level = 6;              ///< Of compression, 0 (none) .. 9; 1 suits sequences: nearly all time is spent here.
  std::vector<PngText> text;  ///< Stored in this order.
};

/// The largest width and height that is read or drawn [pixel].
inline constexpr int kMaxImageSize = 16384;

/// Reads a PNG file of any colour type. `text`, if given, receives its texts. Fails with a message
/// when the file cannot be read, is no PNG, is cut short or damaged, or is larger than kMaxImageSize.
Result<Image> ReadPng(const std::filesystem::path& file, std::vector<PngText>* text = nullptr);

/// Writes a PNG file, under a temporary name that is renamed when finished. Pictures that are
/// opaque throughout are stored without alpha. On failure nothing is left behind.
Status WritePng(const std::filesystem::path& file, const Image& image, const PngOptions& options = {});

}  // namespace percale
