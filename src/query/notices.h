// Notices: what came, went or changed between two trees, as OSCQuery tells it. [any]
#pragma once

#include <string>
#include <vector>

#include "params/tree.h"

namespace limber {

/// Frames such as `{"COMMAND":"PATH_ADDED","DATA":"/physics/body/arm"}`: the topmost path of each thing or row that
/// came or went; PATH_CHANGED of a row that is of another kind now. More than kMostNotices of them are told as one
/// PATH_CHANGED of what they all lie in.
inline constexpr std::size_t kMostNotices = 64;
std::vector<std::string> notices_between(const Tree& before, const Tree& after);

}  // namespace limber
