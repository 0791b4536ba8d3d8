// Plays golden scenes by their scores, and reads the table of their hashes. LIMBER_GOLDEN_LOG=1 shows their messages;
// LIMBER_GOLDEN_JIT=off turns off LuaJIT's compiler.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/log/log.h"
#include "engine/engine.h"
#include "golden/score.h"

namespace limber::golden {

namespace fs = std::filesystem;

inline const fs::path kFolder = fs::path(LIMBER_SOURCE_DIR) / "tests/golden";

/// The result of a run, as in a line of hashes.txt.
struct Outcome {
  std::uint64_t ticks = 0;
  std::uint64_t hash = 0;
  bool operator==(const Outcome&) const = default;
};

inline std::string text_of(const Outcome& outcome) { return fmt::format("{} {:016x}", outcome.ticks, outcome.hash); }

/// Names of the scenes, in alphabetical order.
inline std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kFolder / "scenes")) {
    if (entry.path().extension() == ".lua") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Lines "name ticks hash"; # begins a comment.
inline std::map<std::string, Outcome> golden_hashes() {
  std::map<std::string, Outcome> table;
  std::ifstream in(kFolder / "hashes.txt");
  EXPECT_TRUE(in.good()) << "tests/golden/hashes.txt is missing";
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string name;
    Outcome outcome;
    words >> name >> outcome.ticks >> std::hex >> outcome.hash;
    EXPECT_FALSE(words.fail()) << "hashes.txt: " << line;
    EXPECT_TRUE(table.emplace(name, outcome).second) << "hashes.txt: " << name << " has two lines";
  }
  return table;
}

/// A temporary folder with the scene file, so that files written by the show stay out of the sources.
class ScratchShow {
 public:
  /// The file keeps its name, because generators are seeded with it.
  ScratchShow(const std::string& name, int threads, const std::string& text)
      : folder_(fs::path(::testing::TempDir()) / fmt::format("limber_golden_{}_{}_{}", ::getpid(), name, threads)),
        scene_(folder_ / "scripts" / (name + ".lua")) {
    fs::create_directories(scene_.parent_path());
    write(text);
  }
  ~ScratchShow() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  ScratchShow(const ScratchShow&) = delete;
  ScratchShow& operator=(const ScratchShow&) = delete;

  void write(const std::string& text) const { std::ofstream(scene_, std::ios::binary) << text; }
  std::string scene() const { return scene_.string(); }
  std::string take_path() const { return (folder_ / "run.take").string(); }

 private:
  fs::path folder_;
  fs::path scene_;
};

inline engine::EngineOptions golden_options(int threads) {
  engine::EngineOptions options;
  options.scene_options.data_dir = LIMBER_SOURCE_DIR;
  // a time limit for calls would depend on the machine
  options.scene_options.limits.call_ms = 600000;
  const char* const compiler = std::getenv("LIMBER_GOLDEN_JIT");
  options.scene_options.limits.compiled = compiler == nullptr || std::string_view(compiler) != "off";
  options.fast = true;
  options.print = false;
  options.threads = threads;
  return options;
}

/// One scene from its start to the end of its score.
class ScenePlay {
 public:
  /// `file`: below tests/golden.
  ScenePlay(const fs::path& file, int threads)
      : text_(text_of_file(kFolder / file)),
        score_(score_of(text_)),
        show_(file.stem().string(), threads, text_),
        threads_(threads) {}

  Outcome play() {
    log_to_stderr(std::getenv("LIMBER_GOLDEN_LOG") != nullptr);
    engine::EngineOptions options = golden_options(threads_);
    options.scene = show_.scene();
    if (score_.records_take) options.record = show_.take_path();
    engine::Engine engine(link_, options);
    engine_ = &engine;
    const Result<void> started = engine.start();
    EXPECT_TRUE(started.ok()) << started.error();
    if (!started) return {};
    std::size_t next = 0;
    for (pass_ = 0; pass_ < score_.ticks; pass_++) {
      if (expected_hash_ && expected_hash_->first == pass_) check_repeated_hash();
      for (; next < score_.lines.size() && score_.lines[next].pass == pass_; next++) apply_input(score_.lines[next]);
      engine.tick();
    }
    if (expected_hash_) check_repeated_hash();
    EXPECT_EQ(next, score_.lines.size()) << "the score has lines after its last pass";
    EXPECT_EQ(engine.faults(), score_.faults) << "script errors, rejected values, health events" << rejections();
    const Outcome outcome{engine.world().tick(), engine.state_hash()};
    if (score_.records_take) {
      engine.end_take();
      engine.finish_saving();
    }
    return outcome;
  }

  bool records_take() const { return score_.records_take; }
  std::string take_path() const { return show_.take_path(); }

 private:
  /// Texts of the /error messages, which answer rejected messages.
  std::string rejections() {
    std::string text;
    std::vector<engine::Outgoing> out;
    link_.output_queue.drain(out);
    for (const engine::Outgoing& each : out) {
      if (each.message.address != "/error") continue;
      for (const Arg& arg : each.message.args) text += "\n" + arg.text;
    }
    return text;
  }

  void send(Message message) {
    link_.command_queue.push({{std::move(message)}, {CommandSource::osc, 0x7f000001, 4000}});
  }

  void apply_input(const ScoreLine& line) {
    if (line.verb == "send" || line.verb == "flood") {
      for (int i = 0; i < line.count; i++) send(line.message);
    } else if (line.verb == "eval") {
      auto request = std::make_shared<engine::EvaluationRequest>();
      request->text = line.text;
      request->on_result = [](const Evaluation&) {};
      link_.command_queue.push({{}, {CommandSource::console}, std::move(request)});
    } else if (line.verb == "replace" || line.verb == "reload") {
      reload(line);
    } else {
      if (line.verb == "again") expected_hash_ = {pass_ + line.count, engine_->state_hash()};
      send({"/transport/rewind_ticks", {Arg::of(static_cast<double>(line.count))}});
    }
  }

  void reload(const ScoreLine& line) {
    if (line.verb == "replace") {
      const std::size_t at = text_.rfind(line.text);
      ASSERT_FALSE(at == std::string::npos || text_.rfind("--@ ") > at) << line.text << " is not in the scene";
      text_.replace(at, line.text.size(), line.replacement);
    }
    show_.write(text_);
    EXPECT_EQ(engine_->reload_now(), engine::SceneReloader::ApplyResult::applied);
  }

  void check_repeated_hash() {
    EXPECT_EQ(engine_->state_hash(), expected_hash_->second) << "pass " << pass_ << ", played again after a rewind";
    expected_hash_.reset();
  }

  std::string text_;
  Score score_;
  ScratchShow show_;
  int threads_;
  engine::EngineLink link_;
  engine::Engine* engine_ = nullptr;
  int pass_ = 0;
  std::optional<std::pair<int, std::uint64_t>> expected_hash_;  // a pass and the hash that is expected in it
};

/// Replays a take to its end and compares all its hashes.
inline Outcome replay(const std::string& take, int threads) {
  log_to_stderr(std::getenv("LIMBER_GOLDEN_LOG") != nullptr);
  engine::EngineLink link;
  engine::EngineOptions options = golden_options(threads);
  options.replay = take;
  engine::Engine engine(link, options);
  const Result<void> started = engine.start();
  EXPECT_TRUE(started.ok()) << started.error();
  if (!started) return {};
  engine.run();
  const engine::ReplayResult result = engine.replay_result();
  EXPECT_FALSE(result.diverged_at.has_value()) << limber::engine::text_of(result);
  EXPECT_TRUE(result.compared && !result.truncated && result.damage.empty()) << limber::engine::text_of(result);
  return {engine.world().tick(), engine.state_hash()};
}

}  // namespace limber::golden
