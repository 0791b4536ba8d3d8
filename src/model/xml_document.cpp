// Error texts for XML that can't be parsed.
#include "model/xml_document.h"

#include <fmt/format.h>

namespace limber::model {

namespace {

const char* xml_error_fix(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "Close every element with its own end tag, in order.";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "Write each attribute once, as name=\"value\" with quotes.";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "Write <name …> and remove single '<' from texts.";
    default:
      return "Fix the XML; the file may be truncated.";
  }
}

const char* xml_error_text(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed, or closed by another's end tag";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute can't be read";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element can't be read";
    default:
      return "the XML can't be read";
  }
}

}  // namespace

Result<void> parse_xml(const std::string& text, tinyxml2::XMLDocument& document) {
  document.Parse(text.data(), text.size());
  if (!document.Error()) return {};
  const tinyxml2::XMLError error = document.ErrorID();
  return Error{fmt::format("{}: {}. {}", document.ErrorLineNum(), xml_error_text(error), xml_error_fix(error))};
}

}  // namespace limber::model
