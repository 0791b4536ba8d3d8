// The cache key of import options.
#include "model/import_options.h"

#include <fmt/format.h>

namespace limber::model {

std::string options_key(const ImportOptions& options) {
  std::string key =
      fmt::format("|{}|{}", options.fixed_base ? (*options.fixed_base ? "fixed" : "free") : "", options.keep_fixed);
  for (const auto& [name, value] : options.pose) key += fmt::format("|{}:{}={:a}", name.size(), name, value);
  for (const std::string& folder : options.package_paths) key += fmt::format("|{}:{}", folder.size(), folder);
  if (!options.root.empty()) key += fmt::format("|root={}", options.root);
  return key;
}

}  // namespace limber::model
