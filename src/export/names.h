// Converts names to valid and unique names for exported files.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace limber::exporter {

/// Makes names unique: a second "arm" becomes "arm-2", a third "arm-3".
class UniqueNames {
 public:
  std::string unique(std::string_view name);

 private:
  std::set<std::string, std::less<>> used_;
};

/// Replaces blanks and braces, which end a name in a BVH file, by '_'; an empty name becomes "_".
std::string sanitize_bvh_name(std::string_view name);
/// Returns a file name (without folders) that is valid on any file system; at most 120 bytes.
std::string sanitize_file_name(std::string_view name);
/// Percent-encodes one segment of a URI: everything except letters, digits and "-._~".
std::string percent_encode(std::string_view name);

}  // namespace limber::exporter
