#pragma once
/// \file
/// Base64 (RFC 4648): bytes as text of letters, digits, + and /, a third longer.

#include <optional>
#include <string>
#include <string_view>

namespace percale {

/// Any bytes as base64, filled up with = to a multiple of four characters.
std::string ToBase64(std::string_view bytes);

/// The bytes of such a text; nothing if it is anything else.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace percale
