// Reads a model file (URDF, MJCF) and converts its bytes to text that is safe for an XML parser. Preserves line
// numbers, so that later messages refer to the lines of the user's file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/problems.h"

namespace limber::model {

inline constexpr std::size_t kMaxUrdfBytes = 32u << 20;
inline constexpr int kMaxUrdfDepth = 64;
inline constexpr int kMaxMjcfDepth = 96;  // tinyxml2 reads 100

/// What the sanitizer knows about a format: its limits, and texts for messages.
struct XmlFormat {
  const char* root;            ///< Name of the root element.
  int max_depth;               ///< Elements nested deeper are removed.
  const char* nesting_fix;     ///< Fix for elements that are nested too deep.
  const char* attributes_fix;  ///< Fix for an element with too many attributes.
};
inline constexpr XmlFormat kUrdfFormat{"robot", kMaxUrdfDepth, "A URDF needs at most six levels: reduce the nesting.",
                                       "URDF needs at most six: remove the others."};
inline constexpr XmlFormat kMjcfFormat{"mujoco", kMaxMjcfDepth, "Nest fewer bodies.",
                                       "MJCF needs at most fifty: remove the others."};

/// Reads a regular file of at most `max_bytes`; the error names the file and a fix. [any]
Result<std::string> read_whole_file(const std::string& path, std::size_t max_bytes);

/// The line (1-based) of the character at `at`. [any]
int line_of(std::string_view text, std::size_t at);

/// Blanks declarations, elements nested too deeply and surplus attributes, quotes unquoted attribute values, and
/// removes everything after the first element. Preserves line numbers. False if there is no element. Linear time. [any]
bool clean_markup(std::string& text, const XmlFormat& format, Problems& problems);

/// Returns valid UTF-8 without NUL, DOCTYPE, processing instructions, elements nested deeper than the format's limit,
/// and anything after the first element; reports removals and conversions in `problems`. Errors if there is no XML
/// element, or for UTF-16 and too large files. [any]
Result<std::string> clean_xml_text(std::string_view bytes, const XmlFormat& format, Problems& problems);
/// clean_xml_text() for a URDF. [any]
Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems);

/// The name of the root element, without reading the rest; empty if none is found. Linear time. [any]
std::string_view root_element_name(std::string_view bytes);

}  // namespace limber::model
