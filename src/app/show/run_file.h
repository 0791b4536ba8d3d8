// RunFile: the output of `limber play --out`: the rows of the scene's sim:record, and in a folder also metadata with
// the results. A thread writes the rows, so that the simulation never waits for the disk, except in batch runs, which
// lose no row.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "experiments/result_table.h"

namespace limber::engine {
class Engine;
}  // namespace limber::engine

namespace limber::app {

class RunFile {
 public:
  /// `out`: a file, .csv or .jsonl, or the folder for rows.csv and metadata.json. `waits`: a full buffer delays the
  /// simulation; else rows are dropped and counted.
  RunFile(std::string out, std::string scene, bool waits);
  ~RunFile() { stop(); }
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  /// Creates the files. Call it after the scene has run, before its first tick. Errors name the file: it exists, or the
  /// scene has no columns. [main]
  Result<void> open(engine::Engine& engine);
  /// Moves the rows of the last ticks to the writer. [sim]
  void collect(engine::Engine& engine);
  /// Writes everything, with the results, which must have been computed, and the state hash from before. The show must
  /// have ended. Returns the first error. [main]
  Result<void> finish(engine::Engine& engine, std::uint64_t hash);

 private:
  static constexpr std::size_t kCapacity = std::size_t{1} << 18;  // numbers

  std::string metadata(engine::Engine& engine, std::optional<std::uint64_t> hash) const;
  void write_rows();
  void write_block();
  void stop();

  const std::string out_;
  const std::string scene_;
  const bool waits_;
  std::string folder_;  // empty: a file
  std::string rows_path_;
  std::vector<std::string> columns_;
  bool changed_columns_ = false;  // reported: another run of the scene has other columns
  std::uint64_t dropped_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<double> pending_;  // rows for the writer
  bool stopping_ = false;
  bool failed_ = false;

  // of the writer's thread
  experiments::ResultTable table_;
  std::vector<double> block_;
  Result<void> written_;
  std::thread thread_;
};

/// Prints the results of the scene, one per line: "result distance 1.25". Results that failed are errors on stderr. The
/// show must have ended. [main]
void print_results(engine::Engine& engine);

}  // namespace limber::app
