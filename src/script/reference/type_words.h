// Types of the annotations in words.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace limber::script {

/// Returns a LuaCATS type in words: "string, [part](part.md#part) or nil". `link` returns the Markdown of a class.
/// [any]
std::string type_in_words(std::string_view type, const std::function<std::string(std::string_view)>& link);

}  // namespace limber::script
