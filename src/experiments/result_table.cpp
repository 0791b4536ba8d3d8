// Lines of CSV and JSON, and the file that they are appended to.
#include "experiments/result_table.h"

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber::experiments {

namespace {

using RowJson = nlohmann::ordered_json;
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;

// splits a line of CSV
std::vector<std::string> csv_cells(std::string_view line) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); i++) {
    const char c = line[i];
    if (inside && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

// the cells of a line of JSON, if it has these columns
std::optional<std::vector<std::string>> json_cells(std::string_view line, const std::vector<std::string>& columns) {
  const RowJson json = RowJson::parse(line, nullptr, false);
  if (!json.is_object() || json.size() != columns.size()) return {};
  std::vector<std::string> cells;
  for (const std::string& column : columns) {
    if (!json.contains(column)) return {};
    const RowJson& cell = json.at(column);
    cells.push_back(cell.is_null()              ? ""
                    : cell.is_number_unsigned() ? std::to_string(cell.get<std::uint64_t>())
                    : cell.is_number()          ? number_text(cell.get<double>())
                    : cell.is_string()          ? cell.get<std::string>()
                                                : cell.dump());
  }
  return cells;
}

}  // namespace

Cell Cell::of(double value) { return {std::isfinite(value) ? number_text(value) : "", true}; }
Cell Cell::of(std::uint64_t value) { return {std::to_string(value), true}; }

void ResultTable::set_file(const std::string& path, std::vector<std::string> columns) {
  path_ = path;
  json_ = path.ends_with(".jsonl");
  columns_ = std::move(columns);
}

Result<void> ResultTable::create(const std::string& path, std::vector<std::string> columns, bool overwrite,
                                 std::string_view advice) {
  set_file(path, std::move(columns));
  file_ = system::open_file(path, overwrite ? system::OpenMode::replace : system::OpenMode::create_new);
  if (!file_.is_open() && errno == EEXIST) return Error{fmt::format("{} already exists: {}", printable(path), advice)};
  if (!file_.is_open()) return Error{fmt::format("{} can't be created: {}", printable(path), system::error_reason())};
  return json_ ? Result<void>() : append(header());
}

Result<std::vector<std::vector<std::string>>> ResultTable::resume(const std::string& path,
                                                                  std::vector<std::string> columns) {
  set_file(path, std::move(columns));
  Result<std::string> read = system::read_file(path, kMaxBytes);
  if (!read) return Error{fmt::format("{}: {}", printable(path), read.error())};
  std::string& text = *read;
  const std::size_t last = text.rfind('\n');
  const std::size_t complete = last == std::string::npos ? 0 : last + 1;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string_view> lines = split(std::string_view(text).substr(0, complete), '\n');
  lines.pop_back();  // after the last line feed
  const auto other = [&] {
    return Error{
        fmt::format("{} has other columns than this experiment; choose another name with --out", printable(path))};
  };
  if (!json_ && (lines.empty() || csv_cells(lines.front()) != columns_)) return other();
  for (std::size_t i = json_ ? 0 : 1; i < lines.size(); i++) {
    std::optional<std::vector<std::string>> cells = json_ ? json_cells(lines[i], columns_) : csv_cells(lines[i]);
    if (!cells || cells->size() != columns_.size()) return other();
    rows.push_back(std::move(*cells));
  }
  std::error_code error;
  if (complete < text.size()) std::filesystem::resize_file(path, complete, error);
  if (error) return Error{fmt::format("{} can't be written: {}", printable(path), error.message())};
  file_ = system::open_file(path, system::OpenMode::append);
  if (!file_.is_open()) return write_error();
  return rows;
}

void ResultTable::write_to(std::function<bool(std::string_view)> write_function, std::vector<std::string> columns) {
  write_ = std::move(write_function);
  columns_ = std::move(columns);
  (void)append(header());  // if this fails, so do the rows
}

std::vector<Cell> ResultTable::header() const {
  std::vector<Cell> names;
  for (const std::string& column : columns_) names.push_back(Cell::of(column));
  return names;
}

std::string ResultTable::line_of(const std::vector<Cell>& cells) const {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); i++) {
    line += i == 0 ? (json_ ? "{" : "") : ",";
    if (!json_) {
      line += csv_cell(cells[i].text);
      continue;
    }
    line += RowJson(columns_[i]).dump() + ":";
    line += cells[i].number ? (cells[i].text.empty() ? "null" : cells[i].text)
                            : RowJson(cells[i].text).dump(-1, ' ', false, RowJson::error_handler_t::replace);
  }
  return line + (json_ ? "}\n" : "\n");
}

Result<void> ResultTable::append(const std::vector<Cell>& cells) { return write(line_of(cells)); }

Result<void> ResultTable::write(std::string_view text) {
  if (write_) return write_(text) ? Result<void>() : Error{"the standard output was closed"};
  if (system::write_all(file_.fd(), text)) return {};
  failed_ = true;
  return write_error();
}

Result<void> ResultTable::finish() {
  if (!file_.is_open() || system::sync_file(file_.fd()) || errno == EINVAL) return {};
  return write_error();
}

Error ResultTable::write_error() const {
  return Error{fmt::format("{} can't be written: {}", printable(path_), system::error_reason())};
}

}  // namespace limber::experiments
