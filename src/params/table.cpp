// Tables: layout of the rows, look-up by name.
#include "params/table.h"

#include <bit>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/hash.h"
#include "base/text.h"
#include "params/units.h"

namespace limber {

std::uint32_t width_of(RowType type) {
  switch (type) {
    case RowType::vec3:
    case RowType::flags3:
      return 3;
    case RowType::quat:
      return 4;
    case RowType::none:
    case RowType::text:
      return 0;
    default:
      return 1;
  }
}

std::string_view type_name(RowType type) {
  constexpr std::string_view kNames[] = {"number", "integer", "boolean", "choice", "vec3",
                                         "flags3", "quat",    "action",  "text"};
  return kNames[static_cast<std::size_t>(type)];
}

std::string_view kind_name(RowKind kind) {
  constexpr std::string_view kNames[] = {"property", "state", "readout", "action"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string range_text(const Row& row) {
  if (row.axis_min.empty() || row.axis_max.empty()) return fmt::format("{} .. {}", row.min, row.max);
  return fmt::format("{} .. {}", fmt::join(row.axis_min, " "), fmt::join(row.axis_max, " "));
}

Table::Table(std::string name, std::string path, std::string seed, std::vector<Row> rows,
             void (*fetch)(const void* thing))
    : name_(std::move(name)), path_(std::move(path)), seed_(std::move(seed)), rows_(std::move(rows)), fetch_(fetch) {
  LIMBER_CHECK(rows_.size() <= 64);
  for (std::uint32_t i = 0; i < rows_.size(); i++) {
    Row& row = rows_[i];
    row.index = i;
    row.width = width_of(row.type);
    plain_.push_back(plain_name(row.name));
    LIMBER_CHECK(known_unit(row.unit));
    LIMBER_CHECK(row.axis_min.empty() || row.axis_min.size() == row.width);
    LIMBER_CHECK(row.axis_max.empty() || row.axis_max.size() == row.width);
    if (!row.stored()) continue;
    std::uint32_t& width = row.live ? live_width_ : kept_width_;
    row.offset = width;
    width += row.width;
    row.hashed = row.hashed || row.writable();
    std::uint64_t key = hash_bytes(row.name);
    for (std::uint32_t number = 0; number < row.width; number++) {
      const std::uint64_t next = splitmix64(key);
      (row.live ? hashed_live_ : hashed_kept_)
          .push_back({row.hashed ? next : 0, std::bit_cast<std::uint64_t>(row.initial[number])});
    }
  }
}

const Row* Table::find(std::string_view name) const {
  for (std::size_t i = 0; i < rows_.size(); i++) {
    if (rows_[i].name == name || same_name(plain_[i], name)) return &rows_[i];
  }
  return nullptr;
}

const Row& Table::at(std::string_view name) const {
  for (const Row& row : rows_) {
    if (row.name == name) return row;
  }
  LIMBER_CHECK(!"a row that its class has");
  return rows_.front();
}

std::vector<std::string_view> Table::row_names() const {
  std::vector<std::string_view> names;
  for (const Row& row : rows_) names.push_back(row.name);
  return names;
}

namespace rows {

namespace {
Row make(std::string name, RowType type, std::string unit, double min, double max, std::string doc) {
  Row row;
  row.name = std::move(name);
  row.type = type;
  row.unit = std::move(unit);
  row.min = min;
  row.max = max;
  row.doc = std::move(doc);
  return row;
}
}  // namespace

Row number(std::string name, std::string unit, double initial, double min, double max, std::string doc) {
  Row row = make(std::move(name), RowType::number, std::move(unit), min, max, std::move(doc));
  row.initial[0] = initial;
  return row;
}

Row integer(std::string name, double initial, double min, double max, std::string doc) {
  Row row = make(std::move(name), RowType::integer, "", min, max, std::move(doc));
  row.initial[0] = initial;
  return row;
}

Row boolean(std::string name, bool initial, std::string doc) {
  Row row = make(std::move(name), RowType::boolean, "", 0, 1, std::move(doc));
  row.initial[0] = initial ? 1 : 0;
  return row;
}

Row choice(std::string name, std::vector<std::string> labels, std::uint32_t initial, std::string doc) {
  Row row = make(std::move(name), RowType::choice, "", 0, static_cast<double>(labels.size()) - 1, std::move(doc));
  row.initial[0] = initial;
  row.choices = std::move(labels);
  return row;
}

Row vec3(std::string name, std::string unit, std::array<double, 3> initial, double min, double max, std::string doc) {
  Row row = make(std::move(name), RowType::vec3, std::move(unit), min, max, std::move(doc));
  row.initial = {initial[0], initial[1], initial[2], 0};
  return row;
}

Row flags3(std::string name, std::array<bool, 3> initial, std::string doc) {
  Row row = make(std::move(name), RowType::flags3, "", 0, 1, std::move(doc));
  for (std::size_t i = 0; i < 3; i++) row.initial[i] = initial[i] ? 1 : 0;
  return row;
}

Row quat(std::string name, std::string doc) {
  Row row = make(std::move(name), RowType::quat, "", -1, 1, std::move(doc));
  row.initial = {0, 0, 0, 1};
  return row;
}

Row text(std::string name, std::string doc) {
  Row row = make(std::move(name), RowType::text, "", 0, 0, std::move(doc));
  row.kind = RowKind::readout;
  return row;
}

Row action(std::string name, std::uint32_t min_args, std::uint32_t max_args, std::string doc) {
  Row row = make(std::move(name), RowType::none, "", 0, 0, std::move(doc));
  row.kind = RowKind::action;
  row.min_args = min_args;
  row.max_args = max_args;
  return row;
}

Row state(Row row) {
  row.kind = RowKind::state;
  return row;
}

Row readout(Row row) {
  row.kind = RowKind::readout;
  return row;
}

Row live(Row row) {
  row.live = true;
  return row;
}

Row axes(Row row) {
  row.own_axis = true;
  return row;
}

Row hashed(Row row) {
  row.hashed = true;
  return row;
}

Row turns(Row row) {
  row.turns = true;
  return row;
}

Row apart(Row row) {
  row.apart = true;
  return row;
}

}  // namespace rows
}  // namespace limber
