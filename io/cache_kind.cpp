#include "io/cache_kind.h"

#include <string>
#include <system_error>

#include "io/atomic_file.h"

namespace percale {

namespace fs = std::filesystem;

std::optional<CacheKind> CacheKindOf(const fs::path& file) {
  const std::string extension = LowerExtension(file);
  if (extension == ".csv") return CacheKind::Csv;
  if (extension == ".obj") return CacheKind::Obj;
  if (extension == ".ply") return CacheKind::Ply;
  if (extension == ".pc2") return CacheKind::Pc2;
  // A table can be piped on: /dev/stdout has no extension to go by.
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (extension.empty() && fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    return CacheKind::Csv;
  }
  if (extension.empty() && PathText(file).rfind("/dev/", 0) == 0) return CacheKind::Csv;
  return std::nullopt;
}

}  // namespace percale
