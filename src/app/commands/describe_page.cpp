// Writes one table per class, with one line per property.
#include "app/commands/describe.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/commands/message_dispatcher.h"
#include "properties/property_text.h"

namespace limber::app {

namespace {

// escapes the characters that would end a table cell
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

// "vec3, m, 0 .. 10"; for an action the number of arguments
std::string value_cell(const Property& property) {
  if (property.kind == PropertyKind::action) {
    if (property.max_args == 0) return "no arguments";
    const std::string upper = property.max_args == property.min_args ? "" : fmt::format(" to {}", property.max_args);
    return fmt::format("{}{} numbers", property.min_args, upper);
  }
  std::string text(type_name(property.type));
  if (!property.unit.empty()) text += ", " + property.unit;
  const std::string values = range_or_choices_text(property);
  if (!values.empty() && values != "any") text += ", " + values;
  return text;
}

void add_class(std::string& out, const std::string& title, const PropertyTable& table) {
  const bool has_legacy = !table.legacy_prefix().empty();
  out += fmt::format("\n### {}\n\n| property | {}kind | value | default | meaning |\n|---|{}---|---|---|---|\n", title,
                     has_legacy ? "legacy address | " : "", has_legacy ? "---|" : "");
  for (const Property& property : table.properties()) {
    const std::string legacy = engine::MessageDispatcher::legacy_address(table, property);
    const std::string message = !has_legacy ? "" : legacy.empty() ? "| " : fmt::format("| `{}` ", legacy);
    out += fmt::format("| `{}` {}| {} | {} | {} | {} |\n", property.name, message, kind_name(property.kind),
                       cell(value_cell(property)), property.kind == PropertyKind::action ? "" : initial_text(property),
                       cell(property.doc));
  }
}

}  // namespace

std::string describe_page() {
  std::string out;
  for (const PropertyTable* table : described_classes()) {
    const bool group = table->path().starts_with("/physics/group/");
    if (group) continue;  // its properties are those of its members
    const bool behavior = table->path().find("/behavior/") != std::string::npos;
    if (!behavior) {
      add_class(out, fmt::format("`{}`", table->path()), *table);
      continue;
    }
    const std::size_t name = table->path().find_last_of('<');
    const std::string type = table->path().substr(name + 1, table->path().size() - name - 2);
    add_class(out, fmt::format("`/physics/body/<body>/behavior/<behavior>` of the type `{}`", type), *table);
  }
  out += "\n### Other messages\n\n| message | arguments | meaning |\n|---|---|---|\n";
  for (const engine::SpecialAddress& m : described_messages())
    out += fmt::format("| `{}` | {} | {} |\n", m.address, cell(std::string(m.args)), cell(std::string(m.doc)));
  return out;
}

}  // namespace limber::app
