// Labels that fit a width: shortened in the middle, so that names that differ at either end still do, or wrapped.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ui/panel/text/number_format.h"

namespace limber::panel {

/// Returns the text, shortened to the width: its beginning and its end with "…" between. Never splits a character.
std::string elided(std::string_view text, float width, const TextWidth& width_of);

/// Shortens each name like elided(), but different names to different texts: names that would read alike show the place
/// where they differ, and are numbered if there is no room for it.
std::vector<std::string> elided_apart(std::span<const std::string> names, float width, const TextWidth& width_of);

/// Splits the text into lines that fit the width, preferably after a slash, a blank, '_' or '-'. At least one line.
std::vector<std::string> wrapped(std::string_view text, float width, const TextWidth& width_of);

}  // namespace limber::panel
