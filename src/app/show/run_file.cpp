// Rows and metadata of a run.
#include "app/show/run_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/build_info.h"
#include "base/hash.h"
#include "base/log/log.h"
#include "base/plural.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/engine.h"
#include "export/atomic_file.h"
#include "script/scene/scene.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;
using MetadataJson = nlohmann::ordered_json;

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// values of the scene's parameters by name
MetadataJson parameters_json(engine::Engine& engine) {
  MetadataJson parameters = MetadataJson::object();
  const NodeId node = engine.scene()->params();
  if (!engine.store().alive(node)) return parameters;
  for (const Property& property : engine.store().table(node).properties()) {
    std::array<double, 4> values{};
    engine.store().get(node, property, values.data());
    if (property.type == PropertyType::choice)
      parameters[property.name] = property.choices[static_cast<std::size_t>(values[0])];
    else if (property.type == PropertyType::boolean)
      parameters[property.name] = values[0] != 0;
    else if (property.width == 1)
      parameters[property.name] = values[0];
    else
      parameters[property.name] = std::vector<double>(values.begin(), values.begin() + property.width);
  }
  return parameters;
}

// hash of the contents of all files that the scene has read
std::string scene_hash(engine::Engine& engine) {
  std::vector<script::SourceFile> files = engine.scene()->sources()->files();
  std::ranges::sort(files, {}, &script::SourceFile::path);
  std::uint64_t hash = hash_bytes("");
  for (const script::SourceFile& file : files) {
    if (file.content) hash = hash_bytes(hex(*file.content), hash);
  }
  return hex(hash);
}

Result<void> write_text(const std::string& path, std::string_view text) {
  exporter::AtomicFile file(path);
  Result<void> done = file.open();
  if (done) done = file.write(text);
  if (done) done = file.finish();
  return done;
}

}  // namespace

RunFile::RunFile(std::string out, std::string scene, bool waits)
    : out_(std::move(out)), scene_(std::move(scene)), waits_(waits) {
  const bool is_file = out_.ends_with(".csv") || out_.ends_with(".jsonl");
  if (!is_file) folder_ = out_;
  rows_path_ = is_file ? out_ : out_ + "/rows.csv";
}

Result<void> RunFile::open(engine::Engine& engine) {
  if (engine.scene() == nullptr) return Error{fmt::format("--out {}: there is no scene", printable(out_))};
  columns_ = engine.scene()->output().rows.columns();
  if (columns_.empty() && folder_.empty())
    return Error{
        fmt::format("--out {}: the scene records no columns. Add sim:record {{ {{ \"name\", function() return … "
                    "end }} }} to it, or name a folder, which also gets the results",
                    printable(out_))};
  if (!folder_.empty()) {
    std::error_code error;
    if (fs::exists(folder_ + "/metadata.json", error) || fs::is_regular_file(folder_, error))
      return Error{fmt::format("--out {}: there is a run already; choose another name", printable(out_))};
    fs::create_directories(folder_, error);
    if (error) return Error{fmt::format("--out {}: {}", printable(out_), error.message())};
    if (Result<void> written = write_text(folder_ + "/metadata.json", metadata(engine, {})); !written) return written;
  }
  if (columns_.empty()) return {};
  std::vector<std::string> names = {"tick", "time"};
  names.insert(names.end(), columns_.begin(), columns_.end());
  if (Result<void> created = table_.create(rows_path_, std::move(names), false, "choose another name"); !created)
    return Error{fmt::format("--out: {}", created.error())};
  pending_.reserve(kCapacity);
  block_.reserve(kCapacity);
  thread_ = std::thread([this] { write_rows(); });
  return {};
}

void RunFile::collect(engine::Engine& engine) {
  if (columns_.empty() || engine.scene() == nullptr) return;
  script::RecordedRows& rows = engine.scene()->output().rows;
  if (rows.columns() != columns_) {
    if (!std::exchange(changed_columns_, true))
      log_warning("--out: the scene has other columns now; its rows are not written (reported once)");
    return;
  }
  rows.enable();
  if (rows.rows().empty()) return;
  {
    std::unique_lock lock(mutex_);
    const auto fits = [&] { return failed_ || pending_.size() + rows.rows().size() <= kCapacity; };
    if (waits_) changed_.wait(lock, fits);
    if (!fits()) dropped_ += rows.rows().size() / rows.width();
    if (!failed_ && fits()) pending_.insert(pending_.end(), rows.rows().begin(), rows.rows().end());
  }
  changed_.notify_all();
  rows.clear_rows();
}

void RunFile::write_rows() {
  system::name_this_thread("limber-rows");
  while (true) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stopping_ || !pending_.empty(); });
      if (pending_.empty()) return;
      block_.swap(pending_);
    }
    changed_.notify_all();
    write_block();
    block_.clear();
  }
}

void RunFile::write_block() {
  const std::size_t width = columns_.size() + script::RecordedRows::kFixedColumns;
  std::vector<experiments::Cell> cells(width);
  for (std::size_t at = 0; at + width <= block_.size() && written_; at += width) {
    for (std::size_t i = 0; i < width; i++) cells[i] = experiments::Cell::of(block_[at + i]);
    written_ = table_.append(cells);
  }
  if (written_) return;
  const std::scoped_lock lock(mutex_);
  if (!std::exchange(failed_, true)) log_error("{}", written_.error());
}

void RunFile::stop() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Result<void> RunFile::finish(engine::Engine& engine, std::uint64_t hash) {
  collect(engine);
  stop();
  if (written_ && !columns_.empty()) written_ = table_.finish();
  if (dropped_ > 0)
    log_warning("--out: the disk was too slow; {} not written", counted(dropped_, "row was", "rows were"));
  if (folder_.empty() || engine.scene() == nullptr) return written_;
  Result<void> described = write_text(folder_ + "/metadata.json", metadata(engine, hash));
  return written_ ? described : written_;
}

std::string RunFile::metadata(engine::Engine& engine, std::optional<std::uint64_t> hash) const {
  MetadataJson json = {{"limber", std::string(version())},
                       {"commit", std::string(commit())},
                       {"scene", printable(scene_)},
                       {"scene_hash", scene_hash(engine)},
                       {"seed", engine.world().seed()},
                       {"parameters", parameters_json(engine)},
                       {"columns", columns_},
                       {"complete", hash.has_value()}};
  if (!hash) return json.dump(2) + "\n";
  json["tick"] = engine.world().tick();
  json["time"] = engine.world().time();
  json["state_hash"] = hex(*hash);
  json["rows_dropped"] = dropped_;
  MetadataJson results = MetadataJson::object();
  MetadataJson errors = MetadataJson::object();
  for (const script::SceneResult& result : engine.scene()->output().results) {
    results[result.name] = std::isfinite(result.value) ? MetadataJson(result.value) : MetadataJson();
    if (!result.error.empty()) errors[result.name] = printable(result.error);
  }
  json["results"] = results;
  json["errors"] = errors;
  return json.dump(2) + "\n";
}

void print_results(engine::Engine& engine) {
  if (engine.scene() == nullptr) return;
  for (const script::SceneResult& result : engine.scene()->output().results) {
    if (result.error.empty())
      print_result("result {} {}\n", result.name, number_text(result.value));
    else
      log_error("{}", result.error);
  }
}

}  // namespace limber::app
