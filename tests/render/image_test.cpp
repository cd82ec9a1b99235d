#include <cstdint>
#include <iterator>

#include "render/image.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;
using percale::test::TemporaryFolder;

namespace {

Image Gradient(int width, int height, bool transparent) {
  Image image = MakeImage(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* p = image.At(x, y);
      p[0] = std::uint8_t(x * 7), p[1] = std::uint8_t(y * 11), p[2] = std::uint8_t(x * y);
      if (transparent) p[3] = std::uint8_t(x + y);
    }
  }
  return image;
}

std::string ReadBytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint32_t Crc(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = (crc & 1) ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

std::string BigEndian(std::uint32_t n) {
  return {char(n >> 24), char(n >> 16), char(n >> 8), char(n)};
}

}  // namespace

TEST_CASE("a picture written as PNG reads back the same, at every level, with and without alpha") {
  const TemporaryFolder folder;
  for (const bool transparent : {false, true}) {
    for (const int level : {0, 1, 6, 9}) {
      const Image image = Gradient(37, 23, transparent);
      Must(WritePng(folder / "a.png", image, {.level = level, .text = {}}));
      const Image back = Must(ReadPng(folder / "a.png"));
      CHECK(back.width == 37);
      CHECK(back.height == 23);
      CHECK(back.rgba == image.rgba);
    }
  }
  CHECK(folder.EntryCount() == 1);
}

TEST_CASE("texts inside a PNG come back in order, whatever the language") {
  const TemporaryFolder folder;
  const std::vector<PngText> texts = {
      {"percale:scene", "{\"cloth\": {}}\n"}, {"Title", "Tücher, 布, ткань"}, {"percale:frame", ""}};
  Must(WritePng(folder / "a.png", Gradient(4, 4, false), {.level = 6, .text = texts}));
  std::vector<PngText> back;
  Must(ReadPng(folder / "a.png", &back));
  CHECK(back == texts);
}

TEST_CASE("a PNG that is cut short anywhere is refused") {
  const TemporaryFolder folder;
  Must(WritePng(folder / "a.png", Gradient(40, 30, false)));
  const std::string bytes = ReadBytes(folder / "a.png");
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 60) {
    test::WriteText(folder / "b.png", bytes.substr(0, size));
    const Result<Image> read = ReadPng(folder / "b.png");
    CHECK_FALSE(read.ok());
    CHECK(test::Contains(read.diagnostics(), "b.png"));
  }
}

TEST_CASE("a PNG that claims a huge size is refused before memory is taken") {
  const TemporaryFolder folder;
  Must(WritePng(folder / "a.png", Gradient(4, 4, false)));
  const std::string bytes = ReadBytes(folder / "a.png");
  for (const auto& [width, height] : {std::pair{100000u, 100000u}, std::pair{16385u, 1u}, std::pair{16384u, 16384u}}) {
    const std::string header = "IHDR" + BigEndian(width) + BigEndian(height) + bytes.substr(24, 5);
    test::WriteText(folder / "b.png", bytes.substr(0, 12) + header + BigEndian(Crc(header)) + bytes.substr(33));
    const Result<Image> read = ReadPng(folder / "b.png");
    REQUIRE_FALSE(read.ok());
    CHECK(test::Contains(read.diagnostics(), std::to_string(width) + " x " + std::to_string(height)));
  }
}

TEST_CASE("what is no PNG is named") {
  const TemporaryFolder folder;
  test::WriteText(folder / "text.png", "not a picture at all");
  CHECK(test::Contains(ReadPng(folder / "text.png").diagnostics(), "expected a PNG picture"));
  CHECK(test::Contains(ReadPng(folder / "missing.png").diagnostics(), "missing.png"));
  CHECK(test::Contains(ReadPng(folder.path()).diagnostics(), "found a folder"));
}

TEST_CASE("a picture that cannot be written leaves nothing behind") {
  const TemporaryFolder folder;
  const Image image = Gradient(4, 4, false);
  CHECK_FALSE(WritePng(folder.path() / "no" / "a.png", image).ok());
  std::filesystem::create_directory(folder / "a.png");
  CHECK_FALSE(WritePng(folder / "a.png", image).ok());
  CHECK(folder.EntryCount() == 1);
  if (std::filesystem::exists("/dev/full")) {
    const Status full = WritePng("/dev/full", image);
    CHECK_FALSE(full.ok());
    CHECK(test::Contains(full.diagnostics(), "full"));
  }
}
