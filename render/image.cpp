#include "render/image.h"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

#include "io/atomic_file.h"

namespace percale {
namespace {

constexpr std::size_t kMaxReadText = 256u << 20;    // [bytes] of memory, once unpacked.
constexpr std::size_t kLongText = 16u << 10;        // Is compressed.
constexpr std::size_t kMaxReadPixels = 128u << 20;  // 512 MB of memory: a small file can claim any size.

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// libpng reports an error by a long jump, which must not skip a destructor. So the functions that
// call it hold plain pointers only, and what they work on lives in their caller.
struct Reader {
  std::vector<std::uint8_t> bytes;
  std::size_t position = 0;
  std::string error;
  Image image;
  std::vector<png_bytep> rows;
  std::vector<PngText> text;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  std::vector<std::uint8_t> bytes;
  std::string error;
  std::vector<std::uint8_t> row;
  std::vector<png_text> text;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

template <class Worker>
void OnError(png_structp png, png_const_charp message) {
  static_cast<Worker*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void OnWarning(png_structp, png_const_charp) {}

void ReadBytes(png_structp png, png_bytep out, std::size_t size) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (reader->bytes.size() - reader->position < size) png_error(png, "the file ends too early");
  std::memcpy(out, reader->bytes.data() + reader->position, size);
  reader->position += size;
}

void WriteBytes(png_structp png, png_bytep data, std::size_t size) {
  auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
  writer->bytes.insert(writer->bytes.end(), data, data + size);
}

std::string Utf8FromLatin1(const char* text, std::size_t size) {
  std::string utf8;
  for (std::size_t i = 0; i < size; ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) {
      utf8 += text[i];
    } else {
      utf8 += static_cast<char>(0xc0 | (c >> 6));
      utf8 += static_cast<char>(0x80 | (c & 0x3f));
    }
  }
  return utf8;
}

void KeepText(Reader& reader) {
  png_textp text = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &text, &count);
  for (int i = 0; i < count; ++i) {
    const bool isUtf8 = text[i].compression >= PNG_ITXT_COMPRESSION_NONE;
    const std::size_t size = isUtf8 ? text[i].itxt_length : text[i].text_length;
    reader.text.push_back({text[i].key, isUtf8 ? std::string(text[i].text, size) : Utf8FromLatin1(text[i].text, size)});
  }
}

// Width and height, or an error.
bool ReadHeader(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader, ReadBytes);
  png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);  // We say ourselves what is too large.
  png_set_chunk_malloc_max(reader.png, kMaxReadText);
  png_read_info(reader.png, reader.info);
  reader.image.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  reader.image.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  return true;
}

bool ReadRows(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  if (png_get_rowbytes(reader.png, reader.info) != std::size_t(reader.image.width) * 4) {
    png_error(reader.png, "its pixels are of an unknown kind");
  }
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, reader.info);
  return true;
}

bool WriteAll(Writer& writer, const Image& image, bool opaque, int level) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, WriteBytes, nullptr);
  png_set_compression_level(writer.png, level);
  // Trying all five filters costs more time than a fast compression itself.
  if (level <= 1) png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
               8, opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!writer.text.empty()) {
    png_set_text(writer.png, writer.info, writer.text.data(), static_cast<int>(writer.text.size()));
  }
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* from = image.At(0, y);
    std::uint8_t* to = writer.row.data();
    if (opaque) {
      for (int x = 0; x < image.width; ++x, from += 4, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
    } else {
      std::memcpy(to, from, std::size_t(image.width) * 4);
    }
    png_write_row(writer.png, writer.row.data());
  }
  png_write_end(writer.png, writer.info);
  return true;
}

bool IsAscii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

}  // namespace

Image MakeImage(int width, int height) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 4, 0)};
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

Result<Image> ReadPng(const std::filesystem::path& file, std::vector<PngText>* text) {
  const auto fail = [&](const std::string& why) { return MakeError(PathText(file), why); };
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return fail("expected a PNG picture, found a folder");
  const File stream(OpenFile(file, "rb"));
  if (!stream) return fail(std::string("cannot be read: ") + std::strerror(errno));
  Reader reader;
  std::vector<std::uint8_t> block(1 << 16);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), stream.get())) {
    reader.bytes.insert(reader.bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
    if (reader.bytes.size() > kMaxReadPixels * 4) return fail("is too large to be a picture of ours (over 512 MB)");
    if (reader.bytes.size() <= block.size() &&
        png_sig_cmp(reader.bytes.data(), 0, std::min<std::size_t>(8, reader.bytes.size())) != 0) {
      break;
    }
  }
  if (std::ferror(stream.get())) return fail(std::string("cannot be read: ") + std::strerror(errno));
  if (reader.bytes.size() < 8 || png_sig_cmp(reader.bytes.data(), 0, 8) != 0) {
    return fail("expected a PNG picture, found something else; convert it to PNG first");
  }

  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, OnError<Reader>, OnWarning);
  reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
  if (!reader.info) return fail("cannot be read: out of memory");
  if (!ReadHeader(reader)) return fail("is a damaged PNG picture: " + reader.error);
  Image& image = reader.image;
  if (image.width > kMaxImageSize || image.height > kMaxImageSize ||
      std::size_t(image.width) * std::size_t(image.height) > kMaxReadPixels) {
    return fail("is " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels; at most " +
                std::to_string(kMaxImageSize) + " each way and " + std::to_string(kMaxReadPixels) +
                " in all are read; make it smaller");
  }
  image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
  reader.rows.resize(std::size_t(image.height));
  for (int y = 0; y < image.height; ++y) reader.rows[std::size_t(y)] = image.At(0, y);
  if (!ReadRows(reader)) return fail("is a damaged PNG picture: " + reader.error);
  if (text) {
    KeepText(reader);
    *text = std::move(reader.text);
  }
  return std::move(image);
}

Status WritePng(const std::filesystem::path& file, const Image& image, const PngOptions& options) {
  assert(image.width > 0 && image.height > 0);
  assert(image.rgba.size() == std::size_t(image.width) * std::size_t(image.height) * 4);
  const auto fail = [&](const std::string& why) { return MakeError(PathText(file), why); };
  Result<AtomicFile> out = AtomicFile::Create(file);
  if (!out) return out.diagnostics();

  Writer writer;
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque &= image.rgba[i] == 255;
  writer.row.resize(std::size_t(image.width) * 4);
  for (const PngText& entry : options.text) {
    png_text text{};
    text.key = const_cast<char*>(entry.keyword.c_str());
    text.text = const_cast<char*>(entry.text.c_str());
    const bool isLong = entry.text.size() > kLongText;
    if (IsAscii(entry.text))
      text.compression = isLong ? PNG_TEXT_COMPRESSION_zTXt : PNG_TEXT_COMPRESSION_NONE;
    else
      text.compression = isLong ? PNG_ITXT_COMPRESSION_zTXt : PNG_ITXT_COMPRESSION_NONE;
    (IsAscii(entry.text) ? text.text_length : text.itxt_length) = entry.text.size();
    writer.text.push_back(text);
  }
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, OnError<Writer>, OnWarning);
  writer.info = writer.png ? png_create_info_struct(writer.png) : nullptr;
  if (!writer.info) return fail("cannot be written: out of memory");
  if (!WriteAll(writer, image, opaque, std::clamp(options.level, 0, 9))) {
    return fail("cannot be written: " + writer.error);
  }

  if (const Status written = out->Write(writer.bytes.data(), writer.bytes.size()); !written) return written;
  return out->Commit();
}

}  // namespace percale
