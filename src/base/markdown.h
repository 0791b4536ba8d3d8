// Markdown for generated pages: wrapped lines, escaped text, anchors.
#pragma once

#include <string>
#include <string_view>

namespace limber {

/// Returns the text as lines of at most 120 columns; the first has the prefix, the others as many blanks. [any]
std::string wrapped(std::string_view text, std::string_view prefix = "");

/// Escapes `<` outside of code spans, and joins the lines of each paragraph. [any]
std::string markdown_text(std::string_view text);

/// Returns the first sentence. [any]
std::string first_sentence(std::string_view text);

/// Returns the text with a capital first letter. [any]
std::string capitalized(std::string text);

/// Returns the anchor of a heading, as GitHub and Python-Markdown make it. [any]
std::string heading_anchor(std::string_view heading);

}  // namespace limber
