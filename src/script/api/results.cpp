// C API: results and recorded columns of a run.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"
#include "script/vm/guard.h"

namespace limber::script::calls {

namespace {

constexpr std::size_t kMaxResults = 64;
constexpr std::size_t kMaxColumns = 256;

}  // namespace

std::int32_t result_declare(void* c, const char* name, std::int32_t length, double min, double max,
                            std::int32_t cells) {
  ScriptContext& context = context_of(c);
  std::vector<SceneResult>& results = context.output.results;
  const std::string_view wanted = text_of(name, length);
  if (results.size() >= kMaxResults) return context.reject(fmt::format("result: more than {} results", kMaxResults));
  if (std::ranges::find(results, wanted, &SceneResult::name) != results.end())
    return context.reject(fmt::format("result: there is a result '{}' already; names are unique", wanted));
  SceneResult& added = results.emplace_back();
  added.name = wanted;
  if (cells > 0) {
    added.min = min;
    added.max = max;
    added.cells = cells;
  }
  return kOk;
}

void result_value(void* c, std::int32_t index, double value) {
  SceneResult& result = context_of(c).output.results[static_cast<std::size_t>(index)];
  result.value = value;
  // the sign of NaN differs between machines
  result.error = std::isfinite(value)
                     ? ""
                     : fmt::format("result '{}' is {}", result.name, std::isnan(value) ? "nan" : number_text(value));
}

void result_fault(void* c, std::int32_t index) {
  ScriptContext& context = context_of(c);
  SceneResult& result = context.output.results[static_cast<std::size_t>(index)];
  result.value = std::numeric_limits<double>::quiet_NaN();
  const std::string& text = context.guard->fault().text;
  result.error = text.substr(0, text.find('\n'));
}

std::int32_t record_column(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  std::vector<std::string> columns = context.output.rows.columns();
  const std::string wanted(text_of(name, length));
  if (columns.size() >= kMaxColumns)
    return context.reject(fmt::format("sim:record: more than {} columns", kMaxColumns));
  if (wanted == "tick" || wanted == "time")
    return context.reject(fmt::format("sim:record: each row has the column '{}' already", wanted));
  if (std::ranges::find(columns, wanted) != columns.end())
    return context.reject(fmt::format("sim:record: there is a column '{}' already; names are unique", wanted));
  columns.push_back(wanted);
  context.output.rows.declare(std::move(columns));
  return kOk;
}

void record_row(void* c, const double* values) {
  ScriptContext& context = context_of(c);
  context.output.rows.add(context.world->tick(), context.world->time(), values);
}

}  // namespace limber::script::calls
