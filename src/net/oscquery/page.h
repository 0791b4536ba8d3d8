// The web page of the remote panel, assembled from the files of src/net/oscquery/web.
#pragma once

#include <string_view>

namespace limber::oscquery {

/// Returns the page; valid for the lifetime of the program. [any]
std::string_view panel_page();

}  // namespace limber::oscquery
