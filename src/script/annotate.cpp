// Converts properties to LuaCATS fields.
#include "script/annotate.h"

#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/embedded.h"
#include "base/text.h"
#include "properties/property_text.h"
#include "script/reference/annotation_reader.h"

namespace limber::script {

/// The files of src/script/annotations, embedded by the build.
std::span<const EmbeddedFile> annotation_files();

namespace {

constexpr std::size_t kMaxLineWidth = 116;  // of a line of names, characters

// the LuaCATS type: of the value on reading, plus the other types that may be assigned
std::string type_text(const Property& property) {
  switch (property.type) {
    case PropertyType::text:
      return "string";
    case PropertyType::integer:
      return "integer";
    case PropertyType::boolean:
      return "boolean";
    case PropertyType::choice:
      return fmt::format("\"{}\"", fmt::join(property.choices, "\"|\""));
    case PropertyType::vec3:
      return !property.writable() ? "vec3" : property.own_axis ? "vec3like|number" : "vec3like";
    case PropertyType::flags3:
      return property.writable() ? "flags3|boolean[]|boolean" : "flags3";
    case PropertyType::quat:
      return "quat";
    default:
      return "number";
  }
}

// for example "kg, 0.001 .. 1000000, default 1. Mass; …"
std::string description(const Property& property) {
  std::vector<std::string> details;
  const bool is_numeric = property.type == PropertyType::number || property.type == PropertyType::integer ||
                          property.type == PropertyType::vec3;
  const bool bounded = std::isfinite(property.min) || std::isfinite(property.max);
  if (!property.writable()) details.emplace_back("read-only");
  if (!property.unit.empty()) details.push_back(property.unit);
  if (property.writable() && is_numeric && bounded) details.push_back(range_or_choices_text(property));
  if (property.kind == PropertyKind::setting) details.push_back("default " + initial_text(property));
  return fmt::format("{}{}{}", fmt::join(details, ", "), details.empty() ? "" : ". ", property.doc);
}

std::string fields(const PropertyTable& table, bool as_options) {
  std::string text;
  for (const Property& property : table.properties()) {
    if (property.kind == PropertyKind::action || (as_options && !property.writable())) continue;
    text += fmt::format("---@field {}{} {} # {}\n", property.name, as_options ? "?" : "", type_text(property),
                        description(property));
  }
  return text;
}

// names of Lua's own libraries that `text` does not define; editors know them
std::string builtin_names(std::string_view names, std::string_view text) {
  std::string lines = "--";
  std::size_t width = lines.size();
  for (const std::string_view name : split(names, '\n')) {
    if (name.empty() || name.find(':') != std::string_view::npos) continue;
    const std::size_t dot = name.find('.');
    static const std::set<std::string_view, std::less<>> libraries = {"bit", "coroutine", "math", "string", "table"};
    if (dot != std::string_view::npos && !libraries.contains(name.substr(0, dot))) continue;
    const bool defined = text.find(fmt::format("\nfunction {}(", name)) != std::string_view::npos ||
                         text.find(fmt::format("\n{} = ", name)) != std::string_view::npos;
    if (defined) continue;
    if (width + name.size() + 1 > kMaxLineWidth) {
      lines += "\n--";
      width = 2;
    }
    lines += fmt::format(" {}", name);
    width += name.size() + 1;
  }
  return lines + "\n";
}

}  // namespace

std::string annotations(std::string_view names) {
  std::string text;
  for (const EmbeddedFile& file : annotation_files()) {
    if (!text.empty()) text += "\n";
    bool skips = false;  // the introduction of a page, and the empty line after it
    for (const std::string_view line : split(file.text.substr(0, file.text.find_last_not_of('\n') + 1), '\n')) {
      const std::vector<std::string_view> words = split(line, ' ');
      skips = skips || words[0] == "---@page";
      if (skips || is_reference_line(line)) {
        skips = skips && !line.empty();
      } else if (words[0] == "---@properties" || words[0] == "---@opts") {
        text += fields(annotated_class(words[1]), words[0] == "---@opts");
      } else if (words[0] == "---@action") {
        text += fmt::format("---{}\n", annotated_class(words[1]).at(words[2]).doc);
      } else if (words[0] == "---@names") {
        text += builtin_names(names, text);
      } else {
        text += fmt::format("{}\n", line);
      }
    }
  }
  return text;
}

}  // namespace limber::script
