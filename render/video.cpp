#include "render/video.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "io/atomic_file.h"
#include "render/child_process.h"

namespace percale {
namespace {

constexpr int kMaxTemporaryNames = 1000;
constexpr int kPictureLevel = 3;  // Of compression: 4 times as fast as libpng's own choice, files a tenth larger.

// With a point, whatever the program's locale.
std::string FormatRate(double rate) {
  const auto millionths = static_cast<long long>(std::llround(rate * 1e6));
  return std::to_string(millionths) + "/1000000";
}

}  // namespace

struct VideoWriter::Impl {
  std::filesystem::path path;             // Where the result goes.
  std::filesystem::path temporaryFolder;  // Where numbered pictures are made.
  std::optional<AtomicFile> file;         // Where the film is made.
  VideoSettings settings;
  bool isFolder = false;
  std::optional<ChildProcess> encoder;
  Diagnostics failure;
  std::vector<std::uint8_t> padded;
  int frames = 0;

  ~Impl() {
    encoder.reset();
    std::error_code error;
    if (!temporaryFolder.empty()) std::filesystem::remove_all(temporaryFolder, error);
  }

  Diagnostics Fail(std::string why) {
    failure = {MakeError(PathText(path), std::move(why))};
    return failure;
  }

  Status OpenFolder() {
    isFolder = true;
    std::error_code error;
    if (std::filesystem::exists(path, error) &&
        !(std::filesystem::is_directory(path, error) && std::filesystem::is_empty(path, error))) {
      return Fail(
          "numbered pictures go into a new folder, and this name is taken; choose another name or remove it first");
    }
    const std::filesystem::path parent = path.parent_path();
    for (int i = 0; i < kMaxTemporaryNames; ++i) {
      const std::filesystem::path candidate =
          parent / TextPath("." + PathText(path.filename()) + ".part" + std::to_string(i));
      if (std::filesystem::create_directory(candidate, error)) {
        temporaryFolder = candidate;
        return Ok();
      }
      if (error) break;
    }
    return Fail("the folder cannot be made: " + (error ? error.message() : "its temporary names are taken"));
  }

  Status OpenEncoder(const std::filesystem::path& ffmpeg) {
    // A place that cannot be written to is noticed here: the encoder would tell late, and in its own words.
    Result<AtomicFile> created = AtomicFile::Create(path);
    if (!created) return failure = created.diagnostics();
    if (const Status closed = created->Close(); !closed) return failure = closed.diagnostics();
    file.emplace(std::move(*created));

    const int width = settings.width + settings.width % 2, height = settings.height + settings.height % 2;
    std::error_code error;
    // A bare name such as "a:b.mp4" or "-.mp4" would be read as a protocol or an option.
    const std::string output = "file:" + PathText(std::filesystem::absolute(file->path(), error));
    Result<ChildProcess> started = ChildProcess::Start(
        ffmpeg,
        {"-nostdin", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba",
         "-video_size", std::to_string(width) + "x" + std::to_string(height), "-framerate",
         FormatRate(settings.framesPerSecond), "-i", "pipe:0", "-an",
         // Players take untagged colours for this or that; say which they are.
         "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709", "-color_primaries",
         "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv", "-c:v", "libx264", "-preset", settings.preset,
         "-crf", std::to_string(settings.quality), "-movflags", "+faststart", "-f", "mp4", output});
    if (!started) {
      return failure = started.diagnostics();
    }
    encoder.emplace(std::move(*started));
    return Ok();
  }

  // Joins what the encoder said to our own words.
  Diagnostics EncoderFailure() {
    std::string reason;
    encoder->Finish(reason);
    encoder.reset();
    return Fail("the film cannot be written: ffmpeg says: " + (reason.empty() ? "nothing" : reason));
  }
};

VideoWriter::VideoWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

Result<VideoWriter> VideoWriter::Open(const std::filesystem::path& path, const VideoSettings& settings) {
  auto impl = std::make_unique<Impl>();
  impl->path = path.has_filename() ? path : path.parent_path();  // "frames/" is "frames".
  impl->settings = settings;
  if (!(settings.framesPerSecond > 0 && settings.framesPerSecond <= 10000)) {
    return impl->Fail("expected a number of pictures per second above 0 and at most 10000, found " +
                      std::to_string(settings.framesPerSecond));
  }
  if (settings.width < 1 || settings.height < 1 || settings.width > kMaxImageSize || settings.height > kMaxImageSize) {
    return impl->Fail("expected pictures of 1 to " + std::to_string(kMaxImageSize) + " pixels each way, found " +
                      std::to_string(settings.width) + " x " + std::to_string(settings.height));
  }
  const std::filesystem::path folder = impl->path.parent_path();
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    return impl->Fail("the folder \"" + PathText(folder) + "\" does not exist; create it first");
  }

  const std::string extension = LowerExtension(impl->path);
  Diagnostics warnings;
  Status opened = Ok();
  if (extension == ".mp4") {
    if (const std::filesystem::path ffmpeg = FindProgram("ffmpeg"); !ffmpeg.empty()) {
      opened = impl->OpenEncoder(ffmpeg);
    } else {
      impl->path.replace_extension();
      Diagnostic warning = MakeWarning(
          "the program ffmpeg was not found, so the film becomes numbered pictures in this folder; "
          "install it to get an mp4 file (Debian: apt-get install ffmpeg)");
      warning.place.file = PathText(impl->path);
      warnings.push_back(std::move(warning));
      opened = impl->OpenFolder();
    }
  } else if (extension.empty()) {
    opened = impl->OpenFolder();
  } else {
    return impl->Fail(
        "expected the name of an .mp4 file, or of a folder for numbered pictures, found the extension \"" + extension +
        "\"");
  }
  if (!opened) return opened.diagnostics();
  return {VideoWriter(std::move(impl)), std::move(warnings)};
}

Status VideoWriter::Add(const Image& image) {
  Impl& impl = *impl_;
  if (!impl.failure.empty()) return impl.failure;
  const int width = impl.settings.width, height = impl.settings.height;
  assert(image.width == width && image.height == height);
  if (impl.isFolder) {
    char name[32];
    std::snprintf(name, sizeof name, "%04d.png", impl.frames + 1);
    if (const Status written = WritePng(impl.temporaryFolder / name, image, {.level = kPictureLevel, .text = {}});
        !written) {
      // The reader knows the folder by its final name.
      return impl.Fail(std::string(name) + " " + written.diagnostics().front().message);
    }
    ++impl.frames;
    return Ok();
  }

  const std::vector<std::uint8_t>* bytes = &image.rgba;
  if (width % 2 != 0 || height % 2 != 0) {
    // The pixel format halves the size of its colour planes, so that sizes must be even: repeat the last column and
    // row.
    const std::size_t rowSize = std::size_t(width + width % 2) * 4;
    impl.padded.resize(rowSize * std::size_t(height + height % 2));
    for (int y = 0; y < height + height % 2; ++y) {
      const std::uint8_t* from = image.At(0, std::min(y, height - 1));
      std::uint8_t* to = &impl.padded[std::size_t(y) * rowSize];
      std::copy(from, from + std::size_t(width) * 4, to);
      if (width % 2 != 0)
        std::copy(from + std::size_t(width - 1) * 4, from + std::size_t(width) * 4, to + std::size_t(width) * 4);
    }
    bytes = &impl.padded;
  }
  if (!impl.encoder->Write(bytes->data(), bytes->size())) return impl.EncoderFailure();
  ++impl.frames;
  return Ok();
}

Result<VideoSummary> VideoWriter::Finish() {
  Impl& impl = *impl_;
  if (!impl.failure.empty()) return impl.failure;
  if (impl.frames == 0) return impl.Fail("a film needs at least one picture, and got none");
  if (impl.encoder) {
    std::string reason;
    if (!impl.encoder->Finish(reason)) {
      impl.encoder.reset();
      return impl.Fail("the film cannot be written: ffmpeg says: " + reason);
    }
    impl.encoder.reset();
  }
  std::error_code error;
  if (impl.isFolder && std::filesystem::is_directory(impl.path, error))
    std::filesystem::remove(impl.path, error);  // Empty.
  if (impl.isFolder) {
    std::filesystem::rename(impl.temporaryFolder, impl.path, error);
    if (error) return impl.Fail("cannot be put in its place: " + error.message());
    impl.temporaryFolder.clear();
  } else if (const Status placed = impl.file->Commit(); !placed) {
    return impl.failure = placed.diagnostics();
  }
  return VideoSummary{impl.path, impl.frames, impl.isFolder};
}

}  // namespace percale
