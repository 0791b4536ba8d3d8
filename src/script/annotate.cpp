// Rows to fields.
#include "script/annotate.h"

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/embedded.h"
#include "base/text.h"
#include "params/row_text.h"
#include "sim/world.h"

namespace limber {

/// The files of src/script/annotations, which the build puts inside the program.
std::span<const EmbeddedFile> annotation_files();

namespace {

constexpr std::size_t kWidth = 116;  // of a line of names

const Table& table_named(std::string_view name) {
  const std::array<const Table*, 10> classes = {&World::table(), &Body::table(),  &Part::table(),    &Joint::table(),
                                                &Motor::table(), &Shape::table(), &Visuals::table(), &Camera::table(),
                                                &Look::table(),  &Gear::table()};
  for (const Table* table : classes) {
    if (table->name() == name) return *table;
  }
  LIMBER_CHECK(!"a class that scripts see");
  return World::table();
}

// what a script reads, and what else it may write
std::string type_text(const Row& row) {
  switch (row.type) {
    case RowType::integer:
      return "integer";
    case RowType::boolean:
      return "boolean";
    case RowType::choice:
      return fmt::format("\"{}\"", fmt::join(row.choices, "\"|\""));
    case RowType::vec3:
      return !row.writable() ? "vec3" : row.own_axis ? "vec3like|number" : "vec3like";
    case RowType::flags3:
      return row.writable() ? "flags3|boolean[]|boolean" : "flags3";
    case RowType::quat:
      return "quat";
    default:
      return "number";
  }
}

// "kg, 0.001 .. 1000000, default 1. Mass; …"
std::string about(const Row& row) {
  std::vector<std::string> facts;
  const bool counts = row.type == RowType::number || row.type == RowType::integer || row.type == RowType::vec3;
  const bool bounded = std::isfinite(row.min) || std::isfinite(row.max);
  if (!row.writable()) facts.emplace_back("read-only");
  if (!row.unit.empty()) facts.push_back(row.unit);
  if (row.writable() && counts && bounded) facts.push_back(values_text(row));
  if (row.kind == RowKind::property) facts.push_back("default " + initial_text(row));
  return fmt::format("{}{}{}", fmt::join(facts, ", "), facts.empty() ? "" : ". ", row.doc);
}

std::string fields(const Table& table, bool as_options) {
  std::string text;
  for (const Row& row : table.rows()) {
    if (row.kind == RowKind::action || (as_options && !row.writable())) continue;
    text += fmt::format("---@field {}{} {} # {}\n", row.name, as_options ? "?" : "", type_text(row), about(row));
  }
  return text;
}

// the names that no line so far has defined: those of Lua's own libraries, which editors know
std::string own_names(std::string_view names, std::string_view text) {
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
    if (width + name.size() + 1 > kWidth) {
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
    for (const std::string_view line : split(file.text.substr(0, file.text.find_last_not_of('\n') + 1), '\n')) {
      const std::vector<std::string_view> words = split(line, ' ');
      if (words[0] == "---@rows" || words[0] == "---@opts") {
        text += fields(table_named(words[1]), words[0] == "---@opts");
      } else if (words[0] == "---@action") {
        text += fmt::format("---{}\n", table_named(words[1]).at(words[2]).doc);
      } else if (words[0] == "---@names") {
        text += own_names(names, text);
      } else {
        text += fmt::format("{}\n", line);
      }
    }
  }
  return text;
}

}  // namespace limber
