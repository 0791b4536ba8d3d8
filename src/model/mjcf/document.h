// MjcfDocument: the elements of an MJCF file with its includes in place. Internal to the module: only src/model
// includes it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "model/mesh/library.h"
#include "model/problems.h"

namespace limber::model {

inline constexpr int kMaxMjcfElements = 500'000;
inline constexpr int kMaxMjcfIncludes = 100;  ///< Files.

struct MjcfElement {
  std::string name;
  int line = 0;    ///< In its file.
  int source = 0;  ///< Index of its file in MjcfDocument::sources.
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<MjcfElement> children;

  /// The text of an attribute; null if it is absent.
  const std::string* attribute(std::string_view attribute_name) const;
};

/// A file that was read.
struct MjcfSource {
  std::string path;
  std::uint64_t hash = 0;  ///< hash_bytes() of its content; 0: it can't be read.
  int line = 0;            ///< Line in the model's file of the <include> that led to it.
};

struct MjcfDocument {
  MjcfElement root;
  std::vector<MjcfSource> sources;  ///< The model's file first.
};

/// Parses the text of the file `path`, and the files that it includes. Reports includes that can't be used. Errors only
/// if the text itself has no <mujoco> element; the error starts with a line number and a colon. [any]
Result<MjcfDocument> read_mjcf(std::string_view bytes, const std::string& path, const MeshLibrary& files,
                               Problems& problems);

}  // namespace limber::model
