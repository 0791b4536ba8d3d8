// Names as files of other programs can take them, none twice.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace limber {

/// Gives each name once: a second "arm" becomes "arm-2", a third "arm-3".
class UniqueNames {
 public:
  std::string unique(std::string_view name);

 private:
  std::set<std::string, std::less<>> given_;
};

/// A word without blanks and braces, which end a name in a BVH file; empty: "_".
std::string word_name(std::string_view name);
/// A file's name without folders, such as any file system takes; at most 120 bytes.
std::string file_name(std::string_view name);
/// One part of a URI: everything but letters, digits and "-._~" as %20.
std::string uri_name(std::string_view name);

}  // namespace limber
