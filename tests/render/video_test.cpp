#include <cstdlib>

#include "render/child_process.h"
#include "render/video.h"
#include "tests/render/render_fixture.h"

using namespace percale;
using percale::test::Must;
using percale::test::TemporaryFolder;

namespace {

Image Frame(int width, int height, int number) {
  Image image = MakeImage(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.At(x, y)[number % 3] = std::uint8_t(y < height / 2 ? 255 : 40);
  }
  return image;
}

/// Sets PATH, and puts it back.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : before_(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
  ~SearchPath() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

std::string OutputOf(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char block[256];
  while (const std::size_t size = std::fread(block, 1, sizeof block, pipe)) text.append(block, size);
  pclose(pipe);
  return text;
}

/// A program called ffmpeg that does what `script` says.
void MakeFakeEncoder(const TemporaryFolder& folder, const std::string& script) {
  test::WriteText(folder / "ffmpeg", "#!/bin/sh\n" + script + "\n");
  std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("a film holds every picture, right side up, whatever its name and size") {
  REQUIRE_MESSAGE(!FindProgram("ffmpeg").empty(), "these tests need ffmpeg");
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{64, 48}, std::pair{63, 47}, std::pair{1, 1}}) {
    const std::filesystem::path file = folder / "a 'b' $(c).mp4";
    VideoWriter writer = Must(VideoWriter::Open(file, {.width = width, .height = height, .framesPerSecond = 25}));
    for (int i = 0; i < 12; ++i) Must(writer.Add(Frame(width, height, 0)));
    CHECK_FALSE(std::filesystem::exists(file));
    const VideoSummary summary = Must(writer.Finish());
    CHECK(summary.path == file);
    CHECK(summary.frames == 12);
    CHECK_FALSE(summary.isFolder);
    CHECK(folder.EntryCount() == 1);

    std::filesystem::rename(file, folder / "plain.mp4");
    const std::string probe = OutputOf(
        "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
        "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
        (folder / "plain.mp4").string());
    const std::string even = std::to_string(width + width % 2) + "," + std::to_string(height + height % 2);
    CHECK(probe == "h264," + even + ",yuv420p,25/1,12\n");
    if (width > 1) {
      const std::string rgb = OutputOf("ffmpeg -v error -i " + (folder / "plain.mp4").string() +
                                       " -frames:v 1 -f rawvideo -pix_fmt rgb24 -");
      REQUIRE(rgb.size() == std::size_t(width + width % 2) * std::size_t(height + height % 2) * 3);
      CHECK(int(static_cast<unsigned char>(rgb.front())) > 235);         // Red: top left,
      CHECK(int(static_cast<unsigned char>(rgb[rgb.size() - 3])) < 60);  // and bottom right.
    }
    std::filesystem::remove(folder / "plain.mp4");
  }
}

TEST_CASE("without ffmpeg a film becomes numbered pictures, and says so") {
  const TemporaryFolder folder, empty;
  const SearchPath path(empty.path().string());
  Result<VideoWriter> writer = VideoWriter::Open(folder / "film.mp4", {.width = 8, .height = 6});
  REQUIRE(writer.ok());
  CHECK(test::Contains(writer.diagnostics(), "ffmpeg was not found"));
  for (int i = 0; i < 3; ++i) Must(writer->Add(Frame(8, 6, i)));
  CHECK_FALSE(std::filesystem::exists(folder / "film"));
  const VideoSummary summary = Must(writer->Finish());
  CHECK(summary.isFolder);
  CHECK(summary.path == folder / "film");
  CHECK(folder.EntryCount() == 1);
  CHECK(Must(ReadPng(folder / "film/0003.png")).rgba == Frame(8, 6, 2).rgba);
}

TEST_CASE("a folder for pictures can be asked for, and nothing in the way is overwritten") {
  const TemporaryFolder folder;
  VideoWriter writer = Must(VideoWriter::Open(folder / "frames/", {.width = 8, .height = 6}));
  Must(writer.Add(Frame(8, 6, 0)));
  CHECK(Must(writer.Finish()).isFolder);
  const Result<VideoWriter> again = VideoWriter::Open(folder / "frames", {.width = 8, .height = 6});
  CHECK(test::Contains(again.diagnostics(), "taken"));
  CHECK(std::filesystem::exists(folder / "frames/0001.png"));
}

TEST_CASE("places and settings that cannot be are refused at once") {
  const TemporaryFolder folder;
  const VideoSettings small{.width = 8, .height = 6};
  CHECK(test::Contains(VideoWriter::Open(folder / "no/film.mp4", small).diagnostics(), "does not exist"));
  CHECK(test::Contains(VideoWriter::Open(folder / "film.avi", small).diagnostics(), ".avi"));
  CHECK_FALSE(VideoWriter::Open(folder / "film.mp4", {.width = 0, .height = 6}).ok());
  CHECK_FALSE(VideoWriter::Open(folder / "film.mp4", {.width = 8, .height = 6, .framesPerSecond = 0}).ok());
  std::filesystem::create_directory(folder / "taken.mp4");
  CHECK_FALSE(VideoWriter::Open(folder / "taken.mp4", small).ok());
  CHECK(folder.EntryCount() == 1);
}

TEST_CASE("a film that is not finished, or has no picture, leaves nothing behind") {
  const TemporaryFolder folder;
  {
    VideoWriter writer = Must(VideoWriter::Open(folder / "film.mp4", {.width = 16, .height = 16}));
    Must(writer.Add(Frame(16, 16, 0)));
    VideoWriter pictures = Must(VideoWriter::Open(folder / "frames", {.width = 16, .height = 16}));
    Must(pictures.Add(Frame(16, 16, 0)));
    VideoWriter empty = Must(VideoWriter::Open(folder / "empty.mp4", {.width = 16, .height = 16}));
    CHECK_FALSE(empty.Finish().ok());
  }
  CHECK(folder.EntryCount() == 0);
}

TEST_CASE("what the encoder complains about reaches the user, and nothing is left behind") {
  const TemporaryFolder folder, programs;
  const std::string path = std::getenv("PATH");
  const SearchPath search(programs.path().string() + ":" + path);

  SUBCASE("it ends at once: the pipe breaks") {
    MakeFakeEncoder(programs, "echo 'No space left on device' >&2; exit 1");
  }
  SUBCASE("it reads all and then fails") {
    MakeFakeEncoder(programs, "cat >/dev/null; echo 'No space left on device' >&2; exit 1");
  }

  VideoWriter writer = Must(VideoWriter::Open(folder / "film.mp4", {.width = 256, .height = 256}));
  Status status = Ok();
  for (int i = 0; i < 20 && status.ok(); ++i) status = writer.Add(Frame(256, 256, i));
  const Result<VideoSummary> finished = writer.Finish();
  REQUIRE_FALSE(finished.ok());
  CHECK(test::Contains(finished.diagnostics(), "No space left on device"));
  CHECK(test::Contains(finished.diagnostics(), "film.mp4"));
  writer = Must(VideoWriter::Open(folder / "film.mp4", {.width = 8, .height = 8}));  // The failed one goes.
  CHECK_FALSE(std::filesystem::exists(folder / "film.mp4"));
  CHECK(folder.EntryCount() == 1);
}
