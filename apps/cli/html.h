#pragma once
/// \file
/// Small things of HTML.

#include <string>
#include <string_view>

namespace percale::cli {

/// Text as it stands between tags or inside a quoted attribute.
std::string EscapeHtml(std::string_view text);

/// Bytes for a data URI.
std::string Base64(std::string_view bytes);

}  // namespace percale::cli
