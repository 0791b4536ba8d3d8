// `limber sweep`: the rows of the table, and the continuation of a table.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/experiments/experiment.h"
#include "app/experiments/mpi_job.h"
#include "app/progress.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "experiments/design.h"
#include "experiments/result_table.h"

namespace limber::app {

namespace {

using experiments::Cell;
using experiments::Design;
using experiments::DesignKind;
using experiments::Evaluation;
using experiments::Outcome;

constexpr std::size_t kListedFailures = 10;

DesignKind design_kind(const SweepCommand& command) {
  if (command.design.empty()) return command.samples > 0 ? DesignKind::sobol : DesignKind::grid;
  return command.design == "grid"     ? DesignKind::grid
         : command.design == "random" ? DesignKind::random
         : command.design == "latin"  ? DesignKind::latin
                                      : DesignKind::sobol;
}

class Sweep {
 public:
  Sweep(const SweepCommand& command, Experiment& experiment, Design design)
      : command_(command),
        experiment_(experiment),
        design_(std::move(design)),
        total_(design_.size() * experiment.seeds().size()) {}

  int run();

 private:
  Evaluation evaluation(std::uint64_t number) const;
  std::vector<std::string> columns() const;
  std::vector<Cell> cells(const Evaluation& evaluation, const Outcome& outcome) const;
  Result<void> open_table();
  Result<void> check_rows(const std::vector<std::vector<std::string>>& rows);
  Result<void> repeat_row(const std::vector<std::string>& row);
  Result<void> commit(const Evaluation& evaluation, const Outcome& outcome);
  int report(bool canceled) const;

  const SweepCommand& command_;
  Experiment& experiment_;
  Design design_;
  std::uint64_t total_;
  std::uint64_t kept_ = 0;  // rows of the table that is continued
  std::uint64_t done_ = 0;
  std::uint64_t failures_ = 0;
  std::vector<std::string> listed_;  // the first failures
  std::optional<std::vector<std::string>> repeated_;
  experiments::ResultTable table_;
  std::optional<Progress> progress_;
};

Evaluation Sweep::evaluation(std::uint64_t number) const {
  const std::vector<std::uint64_t>& seeds = experiment_.seeds();
  return {number, seeds[number % seeds.size()], design_.point(number / seeds.size())};
}

std::vector<std::string> Sweep::columns() const {
  std::vector<std::string> columns = {"number"};
  for (const experiments::Axis& axis : design_.axes()) columns.push_back(axis.name);
  columns.emplace_back("seed");
  // a result may have the name of a parameter
  for (const experiments::ResultInfo& result : experiment_.scene().results) {
    const bool used = std::ranges::find(columns, result.name) != columns.end();
    columns.push_back(used ? "result_" + result.name : result.name);
  }
  for (const char* name : {"hash", "error", "command"}) columns.emplace_back(name);
  return columns;
}

std::vector<Cell> Sweep::cells(const Evaluation& evaluation, const Outcome& outcome) const {
  std::vector<Cell> cells = {Cell::of(evaluation.number)};
  for (std::size_t i = 0; i < evaluation.values.size(); i++) {
    const experiments::Axis& axis = design_.axes()[i];
    cells.push_back({axis.text(evaluation.values[i]), axis.choices.empty()});
  }
  cells.push_back(Cell::of(evaluation.seed));
  for (std::size_t i = 0; i < experiment_.scene().results.size(); i++)
    cells.push_back(
        Cell::of(i < outcome.results.size() ? outcome.results[i] : std::numeric_limits<double>::quiet_NaN()));
  cells.push_back(Cell::of(outcome.hash == 0 ? std::string() : fmt::format("{:016x}", outcome.hash)));
  cells.push_back(Cell::of(printable(outcome.error)));
  cells.push_back(Cell::of(experiment_.play_command(evaluation.values, evaluation.seed)));
  return cells;
}

Result<void> Sweep::open_table() {
  const std::string& out = command_.common.out;
  if (out.empty()) {
    table_.write_to([](std::string_view text) { return write_result(text); }, columns());
    return {};
  }
  if (!command_.common.resume)
    return table_.create(out, columns(), command_.common.overwrite,
                         "continue it with --resume, overwrite it with --overwrite, or choose another name");
  const Result<std::vector<std::vector<std::string>>> rows = table_.resume(out, columns());
  if (!rows) return Error{rows.error()};
  return check_rows(*rows);
}

// The rows of a table that is continued must be those of this sweep: the same numbers, values and seeds.
Result<void> Sweep::check_rows(const std::vector<std::vector<std::string>>& rows) {
  const auto other = [&](std::size_t row) {
    return Error{
        fmt::format("{}: row {} belongs to another sweep; choose another name with --out, or use --overwrite "
                    "instead of --resume",
                    printable(command_.common.out), row + 1)};
  };
  if (rows.size() > total_) return other(total_);
  const std::size_t error_column = columns().size() - 2;
  const std::vector<std::string>* good = nullptr;
  for (std::size_t i = 0; i < rows.size(); i++) {
    const std::vector<Cell> expected = cells(evaluation(i), {});
    const std::size_t fixed = design_.axes().size() + 2;  // number, values, seed
    for (std::size_t k = 0; k < fixed; k++) {
      if (rows[i][k] != expected[k].text) return other(i);
    }
    if (rows[i][error_column].empty()) good = &rows[i];
    if (!rows[i][error_column].empty()) failures_++;
  }
  kept_ = done_ = rows.size();
  return good == nullptr ? Result<void>() : repeat_row(*good);
}

// Evaluates a row again. Another hash shows that the scene, its duration or the program is another one.
Result<void> Sweep::repeat_row(const std::vector<std::string>& row) {
  const auto number = static_cast<std::uint64_t>(parse_number(row.front()).value_or(0));
  const std::size_t hash_column = columns().size() - 3;
  std::optional<Evaluation> next = evaluation(number);
  std::string hash;
  const auto ran = experiment_.dispatcher().run([&] { return std::exchange(next, std::nullopt); },
                                                [&](const Evaluation&, const Outcome& outcome) -> Result<void> {
                                                  hash = fmt::format("{:016x}", outcome.hash);
                                                  return {};
                                                });
  if (!ran) return Error{ran.error()};
  if (hash.empty() || hash == row[hash_column]) return {};
  return Error{
      fmt::format("{}: row {} gives another hash now, so the scene, the duration or the program has changed; "
                  "choose another name with --out",
                  printable(command_.common.out), number + 1)};
}

Result<void> Sweep::commit(const Evaluation& evaluation, const Outcome& outcome) {
  done_++;
  if (!outcome.error.empty()) {
    failures_++;
    if (listed_.size() < kListedFailures)
      listed_.push_back(fmt::format("{}: {}", evaluation.number, printable(outcome.error)));
  }
  progress_->report(done_ - kept_);
  return table_.append(cells(evaluation, outcome));
}

int Sweep::report(bool canceled) const {
  for (const std::string& line : listed_) print_notice("evaluation {}", line);
  const std::string to = command_.common.out.empty() ? "" : fmt::format(" in {}", printable(command_.common.out));
  print_notice("{} of {}{}, {} failed{}", done_, counted(total_, "evaluation"), to, failures_,
               failures_ > listed_.size() && !listed_.empty() ? "; see the column error" : "");
  if (canceled && !command_.common.out.empty()) print_notice("stopped; continue with the same command and --resume");
  return canceled || failures_ == total_ ? kInputError : kSuccess;
}

int Sweep::run() {
  experiment_.begin();
  if (const Result<void> opened = open_table(); !opened)
    return fail(table_.failed() ? kMachineError : kInputError, opened.error());
  progress_.emplace("evaluation", total_ - kept_);
  std::uint64_t next = kept_;
  const auto ran = experiment_.dispatcher().run(
      [&]() -> std::optional<Evaluation> {
        if (next >= total_) return {};
        return evaluation(next++);
      },
      [&](const Evaluation& done, const Outcome& outcome) { return commit(done, outcome); });
  if (!ran && table_.failed())
    return fail(kMachineError,
                fmt::format("{}; the rows before it are kept: free disk space and use --resume", ran.error()));
  if (!ran) return fail(kMachineError, ran.error());
  if (const Result<void> finished = table_.finish(); !finished) return fail(kMachineError, finished.error());
  return report(*ran == experiments::Dispatcher::End::canceled);
}

int run_sweep(const SweepCommand& command, experiments::Workers* ranks) {
  if (command.common.resume && command.common.out.empty())
    return fail(kUsageError, "--resume continues the table of --out; name it");
  Experiment experiment(command.common, ranks);
  if (const std::optional<ExperimentFault> fault = experiment.open()) return fail(fault->code, fault->text);
  const DesignKind kind = design_kind(command);
  if (kind == DesignKind::grid && command.samples > 0)
    return fail(kUsageError, "--samples belongs to --design random, latin or sobol; a grid has the values of --param");
  Result<Design> design = Design::create(kind, experiment.axes(), command.samples, command.design_seed);
  if (!design) return fail(kUsageError, design.error());
  if (design->size() > Design::kMaxPoints / experiment.seeds().size())
    return fail(kUsageError,
                fmt::format("more than {} evaluations; use fewer values, samples or seeds", Design::kMaxPoints));
  return Sweep(command, experiment, std::move(*design)).run();
}

}  // namespace

int sweep_command(const SweepCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  return run_in_job(command.common, [&](experiments::Workers* ranks) { return run_sweep(command, ranks); });
}

}  // namespace limber::app
