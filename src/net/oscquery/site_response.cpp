// A file is read as a whole: the largest of the documentation have a few megabytes.
#include "net/oscquery/site_response.h"

#include <array>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"

namespace limber::oscquery {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{64} << 20;
constexpr std::string_view kHtml = "text/html; charset=utf-8";
// the pages contain scripts and styles of their own, and load nothing from other hosts
constexpr std::string_view kPolicy =
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kTypes = {{
    {"html", kHtml},
    {"css", "text/css; charset=utf-8"},
    {"js", "text/javascript; charset=utf-8"},
    {"json", "application/json"},
    {"txt", "text/plain; charset=utf-8"},
    {"md", "text/plain; charset=utf-8"},
    {"lua", "text/plain; charset=utf-8"},
    {"py", "text/plain; charset=utf-8"},
    {"scd", "text/plain; charset=utf-8"},
    {"pd", "text/plain; charset=utf-8"},
    {"xml", "text/xml; charset=utf-8"},
    {"svg", "image/svg+xml"},
    {"png", "image/png"},
    {"jpg", "image/jpeg"},
    {"webp", "image/webp"},
    {"gif", "image/gif"},
    {"ico", "image/x-icon"},
    {"woff2", "font/woff2"},
}};

HttpResponse html_page(int status, std::string_view title, std::string_view text) {
  return {status, kHtml,
          fmt::format("<!doctype html><html lang=\"en\"><title>{0}</title><h1>{0}</h1><p>{1} <a "
                      "href=\"/\">Documentation</a></p></html>\n",
                      title, text),
          std::string(kPolicy)};
}

HttpResponse not_found() { return html_page(404, "Page not found", "There is no page of this name."); }

// True if `file`, an absolute path without links, is below the folder.
bool is_below(const std::string& folder, const std::string& file) {
  return file.size() > folder.size() + 1 && file.starts_with(folder) && file[folder.size()] == '/';
}

// The unescaped path of the target without its query; empty if it can't name a file.
std::string path_of(std::string_view target) {
  if (!target.starts_with('/')) return {};
  std::string path = unescape_name(target.substr(0, target.find_first_of("?#")));
  if (path.find('\0') != std::string::npos || path.find('\\') != std::string::npos) return {};
  for (const std::string_view part : split(path, '/')) {
    if (part.starts_with('.')) return {};  // "..", and hidden files
  }
  if (path.ends_with('/')) path += "index.html";
  return path;
}

}  // namespace

std::string_view content_type(std::string_view file) {
  const std::size_t dot = file.rfind('.');
  if (dot != std::string_view::npos) {
    for (const auto& [extension, type] : kTypes) {
      if (file.substr(dot + 1) == extension) return type;
    }
  }
  return "application/octet-stream";
}

HttpResponse respond_from_folder(const HttpRequest& request, const std::string& folder) {
  if (const std::optional<HttpResponse> rejection = reject_unknown_origin(request, {}))
    return html_page(rejection->status, "Not allowed", "Use the address that `limber docs` prints.");
  if (request.method != "GET" && request.method != "HEAD")
    return html_page(405, "Method not allowed", "Only GET and HEAD are supported.");
  const std::string path = path_of(request.target);
  if (path.empty()) return not_found();
  std::error_code error;
  const std::string file = fs::canonical(folder + path, error).string();
  if (error || !is_below(folder, file)) return not_found();
  Result<std::string> text = system::read_file(file, kMaxFileBytes);
  if (!text) return not_found();
  const std::string_view type = content_type(file);
  return {200, type, std::move(*text), type == kHtml ? std::string(kPolicy) : std::string()};
}

}  // namespace limber::oscquery
