#pragma once
/// \file
/// Films: mp4 files by the program ffmpeg, or numbered pictures.

#include <filesystem>
#include <memory>
#include <string>

#include "percale/diagnostic.h"
#include "render/image.h"

namespace percale {

struct VideoSettings {
  int width = 1024;               ///< Of every picture [pixel].
  int height = 800;               ///< [pixel]
  double framesPerSecond = 30;    ///< > 0.
  int quality = 18;               ///< H.264 constant rate factor: 0 lossless .. 51 worst.
  std::string preset = "medium";  ///< Of the encoder: "ultrafast" .. "veryslow".
};

/// What VideoWriter::Finish has put in place.
struct VideoSummary {
  std::filesystem::path path;  ///< The mp4 file, or the folder of pictures.
  int frames = 0;
  bool isFolder = false;  ///< Numbered pictures 0001.png, 0002.png, ... in a folder.
};

/// Takes the pictures of a film one by one. The file, or the folder, appears when all is done.
class VideoWriter {
 public:
  /// Writes to `path`: NAME.mp4, or a folder for numbered pictures when the name has no extension
  /// (it must not exist yet or be empty). Without ffmpeg, NAME.mp4 becomes the folder NAME, with a
  /// warning beside the value that says so and what to install. Fails on other extensions, a
  /// missing folder, or one that cannot be written to.
  static Result<VideoWriter> Open(const std::filesystem::path& path, const VideoSettings& settings);
  ~VideoWriter();  ///< Without Finish: removes what was begun.
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Appends a picture of the size in the settings. After a failure every call fails.
  Status Add(const Image& image);
  /// Closes the film and puts it in its place. Fails when no picture was added.
  Result<VideoSummary> Finish();

 private:
  struct Impl;
  explicit VideoWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
