// A table a class, a line a row.
#include "app/describe_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/describe.h"
#include "base/text.h"
#include "engine/dispatch.h"
#include "params/row_text.h"

namespace limber {

namespace {

// a cell of a table: what would end it is escaped
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

// "vec3, m, 0 .. 10"; what an action takes
std::string value_cell(const Row& row) {
  if (row.kind == RowKind::action) {
    if (row.max_args == 0) return "to be pressed";
    const std::string most = row.max_args == row.min_args ? "" : fmt::format(" to {}", row.max_args);
    return fmt::format("{}{} numbers", row.min_args, most);
  }
  std::string text(type_name(row.type));
  if (!row.unit.empty()) text += ", " + row.unit;
  const std::string values = values_text(row);
  if (!values.empty() && values != "any") text += ", " + values;
  return text;
}

void add_class(std::string& out, const std::string& title, const Table& table) {
  const bool named = !table.seed().empty();
  out += fmt::format("\n### {}\n\n| row | {}kind | value | default | meaning |\n|---|{}---|---|---|---|\n", title,
                     named ? "message | " : "", named ? "---|" : "");
  for (const Row& row : table.rows()) {
    const std::string seed = Dispatch::seed_address(table, row);
    const std::string message = !named ? "" : seed.empty() ? "| " : fmt::format("| `{}` ", seed);
    out += fmt::format("| `{}` {}| {} | {} | {} | {} |\n", row.name, message, kind_name(row.kind),
                       cell(value_cell(row)), row.kind == RowKind::action ? "" : initial_text(row), cell(row.doc));
  }
}

}  // namespace

std::string describe_page() {
  std::string out;
  for (const Table* table : described_classes()) {
    const bool group = table->path().starts_with("/physics/group/");
    if (group) continue;  // its rows are those of its members
    const bool behavior = table->path().find("/behavior/") != std::string::npos;
    if (!behavior) {
      add_class(out, fmt::format("`{}`", table->path()), *table);
      continue;
    }
    const std::size_t name = table->path().find_last_of('<');
    const std::string type = table->path().substr(name + 1, table->path().size() - name - 2);
    add_class(out, fmt::format("`/physics/body/<body>/behavior/<behavior>` of the type `{}`", type), *table);
  }
  out += "\n### Messages that come from no row\n\n| message | takes | meaning |\n|---|---|---|\n";
  for (const Irregular& m : described_messages())
    out += fmt::format("| `{}` | {} | {} |\n", m.address, cell(std::string(m.takes)), cell(std::string(m.doc)));
  return out;
}

}  // namespace limber
