#pragma once
/// \file
/// Small things of HTML.

#include <string>
#include <string_view>

namespace percale::cli {

/// Text as it stands between tags or inside a quoted attribute.
std::string EscapeHtml(std::string_view text);

}  // namespace percale::cli
