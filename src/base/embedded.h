// Files that the build puts inside the program: the prelude, the annotations, the templates, the panel.
#pragma once

#include <span>
#include <string_view>

namespace limber {

struct EmbeddedFile {
  std::string_view name;  ///< Its path below the folder that was embedded.
  std::string_view text;  ///< Its whole text, for the life of the program.
};

/// The file of that name, else null. [any]
inline const EmbeddedFile* find_embedded(std::span<const EmbeddedFile> files, std::string_view name) {
  for (const EmbeddedFile& file : files) {
    if (file.name == name) return &file;
  }
  return nullptr;
}

}  // namespace limber
