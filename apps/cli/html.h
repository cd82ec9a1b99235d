#pragma once
/// \file
/// Small things of HTML.

#include <string>
#include <string_view>

namespace percale::cli {

/// Text as it stands between tags or inside a quoted attribute.
std::string EscapeHtml(std::string_view text);
/// The text, escaped, between <name> and </name>.
std::string Element(std::string_view name, std::string_view text);

/// The beginning of a page of ours, down to its heading, and its end.
std::string OpenPage(std::string_view title, std::string_view heading);
std::string_view ClosePage();

/// The style sheet of our pages, light and dark: of tables, figures, verdicts and of the plots of figure_plot.h.
std::string_view PageStyle();

}  // namespace percale::cli
