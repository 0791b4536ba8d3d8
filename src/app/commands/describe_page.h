// `limber describe --markdown`: the reference in the form of docs/osc.md.
#pragma once

#include <string>

namespace limber {

/// Returns Markdown tables of every class's properties and of the messages that belong to no property. [any]
std::string describe_page();

}  // namespace limber
