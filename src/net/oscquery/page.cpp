// Inlines the style sheet and scripts into the page, so that browsers load nothing else.
#include "net/oscquery/page.h"

#include <string>

#include "base/check.h"
#include "base/embedded.h"

namespace limber::oscquery {

std::span<const EmbeddedFile> panel_files();

namespace {

constexpr std::string_view kIncludeMark = "@file:";

// index.html includes the other files by "@file:style.css@".
std::string assemble() {
  const EmbeddedFile* const index = find_embedded(panel_files(), "index.html");
  LIMBER_CHECK(index != nullptr);
  std::string page;
  std::string_view left = index->text;
  for (std::size_t at = left.find(kIncludeMark); at != std::string_view::npos; at = left.find(kIncludeMark)) {
    page += left.substr(0, at);
    left.remove_prefix(at + kIncludeMark.size());
    const std::string_view name = left.substr(0, left.find('@'));
    const EmbeddedFile* const file = find_embedded(panel_files(), name);
    LIMBER_CHECK(file != nullptr);
    if (file != nullptr) page += file->text;
    left.remove_prefix(name.size() + 1);
  }
  page += left;
  return page;
}

}  // namespace

std::string_view panel_page() {
  static const std::string page = assemble();
  return page;
}

}  // namespace limber::oscquery
