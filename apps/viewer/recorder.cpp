#include "apps/viewer/recorder.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "io/atomic_file.h"
#include "render/video.h"

namespace percale::viewer {
namespace {

/// Of the encoder: a third of the work of its own choice, files a quarter larger.
constexpr const char* kPreset = "veryfast";

}  // namespace

Recorder::Recorder(std::filesystem::path stem, double now, std::function<void()> wake)
    : stem_(std::move(stem)), start_(now), wake_(std::move(wake)), thread_([this] { Loop(); }) {}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Recorder::Add(Image image, double now) {
  width_ = image.width;
  height_ = image.height;
  const long slot = Slot(now);
  nextSlot_ = slot + 1;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++dropped_;
      return;
    }
    waiting_.push_back({std::move(image), slot});
  }
  changed_.notify_all();
}

void Recorder::Stop(double now) {
  if (stopped_) return;
  stopped_ = true;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    endSlot_ = Slot(now) + 1;
  }
  changed_.notify_all();
}

std::vector<JobReport> Recorder::TakeReports() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reports_, {});
}

void Recorder::Report(JobReport report) {
  {
    const std::lock_guard lock(mutex_);
    reports_.push_back(std::move(report));
  }
  if (wake_) wake_();
}

void Recorder::Loop() {
  JobReport report;
  try {
    report = Encode();
  } catch (const std::exception& error) {  // No memory.
    report = {"film", {}, {MakeError(std::string("the recording has failed: ") + error.what())}};
  }
  ended_ = true;
  Report(std::move(report));
}

JobReport Recorder::Encode() {
  std::optional<VideoWriter> video;
  Shown last;
  long written = 0;
  const auto failed = [](const Diagnostics& why) { return JobReport{"film", {}, why}; };
  // The last picture again, until it is time for the next.
  const auto fill = [&](long until) {
    Status added = Ok();
    for (; written < until && added; ++written) added = video->Add(last.image);
    return added;
  };
  for (;;) {
    Shown next;
    bool isEnd = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
      isEnd = waiting_.empty();
      if (!isEnd) {
        next = std::move(waiting_.front());
        waiting_.pop_front();
      }
    }
    if (isEnd) break;
    if (!video) {
      VideoSettings settings;
      settings.width = next.image.width;
      settings.height = next.image.height;
      settings.framesPerSecond = kPicturesPerSecond;
      settings.preset = kPreset;
      Result<VideoWriter> opened = VideoWriter::Open(NumberedName(stem_, ".mp4"), settings);
      if (!opened) return failed(opened.diagnostics());
      if (!opened.diagnostics().empty()) Report({"film", {}, opened.diagnostics()});
      video.emplace(std::move(*opened));
      written = next.slot;  // The film begins with its first picture.
    }
    if (const Status filled = fill(next.slot); !filled) return failed(filled.diagnostics());
    last = std::move(next);
  }
  if (!video) return failed({MakeError("the recording has ended before its first picture; nothing was saved")});
  long end = 0;
  int dropped = 0;
  {
    const std::lock_guard lock(mutex_);
    end = std::max(endSlot_, last.slot + 1);
    dropped = dropped_;
  }
  if (const Status filled = fill(end); !filled) return failed(filled.diagnostics());
  const Result<VideoSummary> film = video->Finish();
  if (!film) return failed(film.diagnostics());
  char text[160];
  std::snprintf(text, sizeof text, "%.1f s recorded, %d pictures%s", film->frames / kPicturesPerSecond, film->frames,
                film->isFolder ? ", numbered PNG files in a folder" : "");
  Diagnostic note = MakeNote(PathText(film->path), text);
  if (dropped > 0) {
    note.severity = Severity::Warning;
    note.message += "; " + std::to_string(dropped) + " came faster than they could be encoded and are missing";
  }
  return {"film", film->path, {note}};
}

}  // namespace percale::viewer
