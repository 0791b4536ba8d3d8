// Answers requests for the files of a folder, such as the documentation. Does no network I/O. [any]
#pragma once

#include <string>
#include <string_view>

#include "net/oscquery/request.h"

namespace limber::oscquery {

/// Returns the file of the request's path below `folder` (an absolute path without links); a path that ends with / is
/// that of its index.html. Responds 404 to everything that is no regular file in the folder, also by links, 405 to
/// other methods than GET and HEAD, and 403 to names of other hosts and to pages of other sites.
HttpResponse respond_from_folder(const HttpRequest& request, const std::string& folder);

/// Returns the content type for the file's extension: "text/html; charset=utf-8". [any]
std::string_view content_type(std::string_view file);

}  // namespace limber::oscquery
