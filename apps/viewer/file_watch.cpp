#include "apps/viewer/file_watch.h"

#include <system_error>
#include <utility>

namespace percale::viewer {

FileWatch::FileWatch(std::filesystem::path file) : file_(std::move(file)) {
  Accept();
}

void FileWatch::Accept() {
  known_ = last_ = Look();
}

bool FileWatch::Changed() {
  if (file_.empty()) return false;
  const Stamp now = Look();
  const bool settled = now == last_;
  last_ = now;
  if (!settled || !now.exists || now == known_) return false;
  known_ = now;
  return true;
}

FileWatch::Stamp FileWatch::Look() const {
  Stamp stamp;
  std::error_code error;
  stamp.size = std::filesystem::file_size(file_, error);
  if (error) return {};
  stamp.time = std::filesystem::last_write_time(file_, error);
  stamp.exists = !error;
  return stamp;
}

}  // namespace percale::viewer
