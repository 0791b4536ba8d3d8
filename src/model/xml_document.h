// Parses the sanitized text of a model file. Internal to the module: only src/model includes it.
#pragma once

#include <string>

#include <tinyxml2.h>

#include "base/result.h"

namespace limber::model {

/// Parses text from clean_urdf_text() or clean_mjcf_text(). The error starts with a line number and a colon. [any]
Result<void> parse_xml(const std::string& text, tinyxml2::XMLDocument& document);

}  // namespace limber::model
