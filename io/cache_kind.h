#pragma once
/// \file
/// The formats of caches and meshes, by the ending of a file's name.

#include <filesystem>
#include <optional>

namespace percale {

enum class CacheKind { Csv, Obj, Ply, Pc2 };

/// The format that the name ends in (.csv, .obj, .ply, .pc2; capitals make no difference), or
/// nothing. A device or pipe without an ending, such as /dev/stdout, takes a table (csv).
std::optional<CacheKind> CacheKindOf(const std::filesystem::path& file);

}  // namespace percale
