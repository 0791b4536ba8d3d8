// The remote panel's page, put together from the files of src/query/panel.
#pragma once

#include <string_view>

namespace limber {

/// For the life of the program. [any]
std::string_view panel_page();

}  // namespace limber
