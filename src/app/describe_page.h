// `limber describe --markdown`: the reference as it stands in docs/osc.md.
#pragma once

#include <string>

namespace limber {

/// Every class's rows and every message that comes from no row, as tables. [any]
std::string describe_page();

}  // namespace limber
