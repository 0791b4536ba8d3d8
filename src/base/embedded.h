// Files that are embedded in the executable: the prelude, the annotations, the templates, the web panel.
#pragma once

#include <span>
#include <string_view>

namespace limber {

struct EmbeddedFile {
  std::string_view name;  ///< Path relative to the embedded folder.
  std::string_view text;  ///< Contents; valid until the program exits.
};

/// Returns the file of that name, or null. [any]
inline const EmbeddedFile* find_embedded(std::span<const EmbeddedFile> files, std::string_view name) {
  for (const EmbeddedFile& file : files) {
    if (file.name == name) return &file;
  }
  return nullptr;
}

}  // namespace limber
