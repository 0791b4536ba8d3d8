// The tree as OSCQuery's JSON, from an image. [any]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/image.h"

namespace limber {

/// A node with all below it: FULL_PATH, then CONTENTS, or a row's attributes and VALUE. What lies more than `depth`
/// levels below is left out, its container's CONTENTS being empty; so is, of a tree of more than kMostRows, what lies
/// deepest, whole levels at a time.
inline constexpr std::size_t kMostRows = 100000;
std::string node_json(const Image& image, const TreePlace& place, int depth = 64);

/// Rows whose paths hold every word, compared by the naming rule, as `{"FOUND":[{…},…],"MORE":false}`; no words, no
/// rows. At most `limit` of them; MORE says whether there are others.
std::string find_json(const Image& image, std::string_view words, std::size_t limit = 100);

/// The value of a row as JSON, or empty where it has none.
std::string place_value_json(const Image& image, const TreePlace& place);

}  // namespace limber
