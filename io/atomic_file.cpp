#include "io/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace percale {
namespace {

namespace fs = std::filesystem;

/// Names tried for the temporary file before giving up; each is taken only by a crashed or a
/// simultaneous run that writes the same file.
constexpr int kMaxTemporaryNames = 1000;
/// Bytes of the target's name in the temporary one, so that this is not too long for a file system.
constexpr std::size_t kMaxStem = 100;

std::string Reason(int error) {
  return error ? std::generic_category().message(error) : "unknown error";
}

std::string Remedy(int error) {
  switch (error) {
    case ENOSPC:
      return "; the disk is full: make room, or write elsewhere";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; write to a folder that is yours";
    case ENOENT:
      return "; make the folder first";
    case EFBIG:
      return "; the file would be larger than the system allows";
    default:
      return "";
  }
}

Diagnostic WriteError(const fs::path& file, int error) {
  return MakeError(PathText(file), "cannot be written: " + Reason(error) + Remedy(error));
}

/// Things that cannot be replaced by renaming another file onto them.
bool IsStraight(const fs::path& file, const fs::file_status& status) {
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return true;
  // /dev/stdout may lead to a regular file that the shell holds open.
  std::error_code ignored;
  const std::string absolute = PathText(fs::absolute(file, ignored).lexically_normal());
  return absolute.rfind("/dev/", 0) == 0 && absolute.rfind("/dev/shm/", 0) != 0;
}

}  // namespace

std::string PathText(const fs::path& path) {
  const auto text = path.u8string();
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

std::string LowerExtension(const fs::path& path) {
  std::string extension = PathText(path.extension());
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

fs::path TextPath(std::string_view text) {
#ifdef _WIN32
  return fs::path(std::u8string(reinterpret_cast<const char8_t*>(text.data()), text.size()));
#else
  return fs::path(std::string(text));  // any bytes are a name
#endif
}

std::FILE* OpenFile(const fs::path& file, const char* mode) {
#ifdef _WIN32
  return _wfopen(file.c_str(), std::wstring(mode, mode + std::strlen(mode)).c_str());
#else
  return std::fopen(file.c_str(), mode);
#endif
}

Result<AtomicFile> AtomicFile::Create(const fs::path& file) {
  if (file.empty()) return MakeError("expected the name of a file to write, got an empty one");
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (fs::is_directory(status) || file.filename().empty()) {
    return MakeError(PathText(file), "expected the name of a file to write, got a folder");
  }

  AtomicFile out;
  out.target_ = file;
  out.final_ = file;
  if (IsStraight(file, status)) {
    out.straight_ = true;
    out.temporary_ = file;
    errno = 0;
    out.stream_ = OpenFile(file, "wb");
    if (!out.stream_) return WriteError(file, errno);
    return out;
  }
  if (fs::is_symlink(fs::symlink_status(file, code))) {
    const fs::path real = fs::weakly_canonical(file, code);
    if (!code) out.final_ = real;
  }
  if (fs::exists(status)) {  // renaming would replace a write-protected file
    errno = 0;
    std::FILE* probe = OpenFile(file, "r+b");
    if (!probe) return WriteError(file, errno);
    std::fclose(probe);
  }

  const fs::path folder = out.final_.parent_path();
  const fs::file_status folderStatus = fs::status(folder.empty() ? fs::path(".") : folder, code);
  if (!folder.empty() && !fs::is_directory(folderStatus)) {
    return MakeError(PathText(file),
                     fs::exists(folderStatus)
                         ? "cannot be written: " + PathText(folder) + " is not a folder"
                         : "cannot be written: there is no folder " + PathText(folder) + "; make it first");
  }
  std::string stem = PathText(out.final_.stem());
  if (stem.size() > kMaxStem) {
    stem.resize(kMaxStem);
    while (!stem.empty() && (static_cast<unsigned char>(stem.back()) & 0x80) != 0) stem.pop_back();
  }
  for (int i = 0; i < kMaxTemporaryNames; ++i) {
    out.temporary_ = folder / TextPath("." + stem + ".part" + std::to_string(i));
    out.temporary_ += out.final_.extension();
    errno = 0;
    out.stream_ = OpenFile(out.temporary_, "wbx");
    if (out.stream_) break;
    if (errno != EEXIST) break;
  }
  if (!out.stream_) {
    const int error = errno;
    out.temporary_.clear();
    return WriteError(file, error);
  }
  if (fs::exists(status)) fs::permissions(out.temporary_, status.permissions(), code);
  return out;
}

AtomicFile::~AtomicFile() {
  Discard();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept {
  *this = std::move(other);
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  Discard();
  target_ = std::move(other.target_);
  final_ = std::move(other.final_);
  temporary_ = std::move(other.temporary_);
  stream_ = std::exchange(other.stream_, nullptr);
  error_ = other.error_;
  failed_ = other.failed_;
  straight_ = other.straight_;
  other.temporary_.clear();
  return *this;
}

void AtomicFile::Discard() {
  if (stream_) std::fclose(std::exchange(stream_, nullptr));
  if (!straight_ && !temporary_.empty()) {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  temporary_.clear();
}

Diagnostic AtomicFile::Failure(int error) const {
  return WriteError(target_, error);
}

Status AtomicFile::Write(const void* data, std::size_t bytes) {
  errno = 0;
  if (!failed_ && (!stream_ || (bytes > 0 && std::fwrite(data, 1, bytes, stream_) != bytes))) {
    failed_ = true;
    error_ = errno;
  }
  if (failed_) return Failure(error_);
  return Ok();
}

Status AtomicFile::WriteAt(long position, const void* data, std::size_t bytes) {
  errno = 0;
  if (!failed_ && (!stream_ || std::fseek(stream_, position, SEEK_SET) != 0)) {
    failed_ = true;
    error_ = errno;
  }
  if (auto status = Write(data, bytes); !status) return status;
  errno = 0;
  if (std::fseek(stream_, 0, SEEK_END) != 0) {
    failed_ = true;
    error_ = errno;
    return Failure(error_);
  }
  return Ok();
}

Status AtomicFile::Close() {
  if (stream_) {
    // Each of the three can be the first to notice that the disk is full.
    const bool marked = std::ferror(stream_) != 0;
    errno = 0;
    const bool flushed = std::fflush(stream_) == 0;
    if (!flushed && !failed_) error_ = errno;
    errno = 0;
    const bool closed = std::fclose(std::exchange(stream_, nullptr)) == 0;
    if (flushed && !closed && !failed_) error_ = errno;
    if (marked || !flushed || !closed) failed_ = true;
  }
  if (failed_) return Failure(error_);
  return Ok();
}

Status AtomicFile::Commit() {
  if (auto status = Close(); !status) {
    Discard();
    return status;
  }
  if (straight_) return Ok();
  std::error_code code;
  fs::rename(temporary_, final_, code);
  if (code) {
    Discard();
    return WriteError(target_, code.default_error_condition().value());
  }
  temporary_.clear();
  return Ok();
}

Status AtomicFile::CommitAs(const fs::path& target) {
  if (!straight_) target_ = final_ = target;
  return Commit();
}

std::filesystem::path NumberedName(const std::filesystem::path& stem, const std::string& ending) {
  for (int n = 1;; ++n) {
    std::filesystem::path plain = stem;
    plain += "-" + std::to_string(n);
    std::filesystem::path file = plain;
    file += ending;
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored)) &&
        !std::filesystem::exists(std::filesystem::symlink_status(plain, ignored)))
      return file;
  }
}

Status WriteFile(const fs::path& file, std::string_view content) {
  Result<AtomicFile> out = AtomicFile::Create(file);
  if (!out) return out.diagnostics();
  if (Status written = out->Write(content); !written) return written;
  return out->Commit();
}

}  // namespace percale
