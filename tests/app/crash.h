// Kills a show with SIGKILL after a number of replies, while it receives random messages, stores presets and records a
// take; then checks the files on disk and the next start.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "app/program.h"
#include "base/random.h"
#include "engine/presets/file.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/encode.h"
#include "osc/osc_test_tools.h"

namespace limber::app::test {

inline constexpr const char* kCrashScene = R"(
params { { "mark", 0, max = 1000000 } }
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 6 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 0.5 * i) }) end
sim:every(0.2, function() sim:body("ball1").parts[1]:apply_impulse(rng:direction() * 0.01) end)
)";

class CrashRound {
 public:
  /// Maximal age of recovered values, in ticks: a copy is made every five seconds, and the previous one may still be
  /// being written.
  static constexpr double kMaxRecoveryAge = 600;

  /// Kills the show after about this many replies, each of which takes a tick; `take`: record a take meanwhile.
  CrashRound(std::uint64_t seed, int answers, bool take)
      : random_(seed, "crash"),
        replies_(answers),
        records_take_(take),
        scene_(folder_.file("scripts/s.lua", kCrashScene)) {}

  void run() {
    const std::string at = fmt::format("killed behind {} answers{}", replies_, records_take_ ? " with a take" : "");
    SCOPED_TRACE(at);
    play();
    check_presets();
    if (records_take_) check_take();
    check_recovery();
  }

 private:
  // values set by the n-th step: two properties in one tick, which reveals partial writes
  struct Step {
    int value = 0;
    double tick = 0;
  };

  std::vector<std::string> arguments(std::vector<std::string> more) const {
    std::vector<std::string> args = {scene_,      "--headless", "--osc-in", "127.0.0.1:0",
                                     "--osc-out", "off",        "--query",  "off"};
    args.insert(args.end(), more.begin(), more.end());
    return limber_command(std::move(args), {"env", "XDG_STATE_HOME=" + folder_.path() + "/state"});
  }
  // false: the program doesn't play
  bool wait_until_playing(Process& running) {
    if (!running.wait_for("playing headless")) return false;
    endpoint_ = {0x7f000001, static_cast<std::uint16_t>(std::stoi(running.text_after("OSC in 127.0.0.1:")))};
    return true;
  }
  void send(const Message& message) const {
    osc::PacketBuffer buffer;
    const std::span<const char> bytes = osc::encode_message(message, buffer);
    client_.send(endpoint_, {bytes.data(), bytes.size()});
  }
  // returns the first number of the next reply with that address
  double reply(const std::string& address) const {
    while (const auto bytes = client_.receive()) {
      const Result<osc::Decoded> decoded = osc::decode_packet(bytes->data(), bytes->size());
      for (const Message& message : decoded->messages) {
        if (message.address == address) return message.args.empty() ? 0 : message.args[0].number;
      }
    }
    ADD_FAILURE() << "no " << address;
    return -1;
  }
  double get(const std::string& path) const {
    send({"/get", {Arg::of(path)}});
    return reply(path);
  }

  void play() {
    Process running(arguments({}));
    ASSERT_TRUE(wait_until_playing(running)) << running.err();
    if (records_take_) {
      send({"/take/record", {Arg::of("crash")}});
      reply("/take/recording");
    }
    for (int n = 1; n <= replies_; n++) {
      steps_.push_back({n, tick_});
      send({"/scene/mark", {Arg::of(static_cast<double>(n))}});
      send({"/physics/sim/gravity", {Arg::of(-n / kGravity)}});
      if (random_.uniform() < 0.4) {
        const std::string name = fmt::format("p{}", static_cast<int>(random_.uniform(0, 8)));
        send({"/preset/store", {Arg::of(name)}});
        stored_[name] = n;
      }
      // the kill happens in the middle of writing a tick, or before it
      if (n == replies_ && random_.uniform() < 0.5) break;
      tick_ = get("/physics/sim/tick");
      if (random_.uniform() < 0.3 && get("/preset/saved") == 1) saved_ = stored_;
    }
    running.signal(SIGKILL);
    running.finish();
  }

  static constexpr double kGravity = 128;  // steps in 1 m/s²

  // checks that both values of a preset are of the same step, and returns it
  static int step_of(const engine::Preset& preset) {
    double step = -1;
    double gravity = -1;
    for (std::uint32_t i = 0; i < preset.schema->nodes().size(); i++) {
      const engine::PresetSchema::Node& thing = preset.schema->nodes()[i];
      const engine::PresetLayout* const layout = preset.schema->layout(thing);
      if (layout == nullptr) continue;
      const auto number = [&](const char* name, std::uint32_t index) {
        const int at = layout->find(name);
        return at < 0 ? -1 : preset.values[thing.offset + layout->offsets[static_cast<std::size_t>(at)] + index];
      };
      if (preset.schema->path(i) == "/scene") step = number("mark", 0);
      if (preset.schema->path(i) == "/physics/sim") gravity = -kGravity * number("gravity", 2);
    }
    EXPECT_EQ(step, gravity) << preset.name;
    return static_cast<int>(step);
  }

  void check_presets() {
    engine::PresetFile file(engine::PresetFile::path_for(scene_));
    const Result<engine::ParsedPresets> read = file.load();
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_TRUE(read->problems.empty());
    std::map<std::string, int> found;
    for (const auto& preset : read->presets) found[preset->name] = step_of(*preset);
    for (const auto& [name, step] : saved_) EXPECT_GE(found[name], step) << name;
    for (const auto& [name, step] : found) EXPECT_LE(step, stored_[name]) << name;
  }

  void check_take() {
    const std::string beside = folder_.path() + "/scripts/takes/crash.take";
    const std::string take = std::filesystem::exists(beside) ? beside : folder_.path() + "/takes/crash.take";
    // a take that was killed before its first tick may be missing
    if (tick_ < 30 && !std::filesystem::exists(take)) return;
    const RunResult again = test::run({"--replay", take, "--fast"});
    EXPECT_EQ(again.code, 0) << again.err;
    const std::size_t at = again.err.find("replayed ");
    ASSERT_NE(at, std::string::npos) << again.err;
    EXPECT_NE(again.err.find("all hashes match the take; the take was cut off there\n"), std::string::npos)
        << again.err;
    EXPECT_GE(std::stod(again.err.substr(at + 9)), tick_ - 60)
        << "up to a tenth of a second may be lost; a second of tolerance";
  }

  void check_recovery() {
    Process running(arguments({"--recover"}));
    ASSERT_TRUE(wait_until_playing(running)) << running.err();
    const auto step = static_cast<int>(get("/scene/mark"));
    EXPECT_EQ(get("/physics/sim/gravity"), 0) << "its x";
    int oldest = 0;
    for (const Step& each : steps_) {
      if (each.tick <= tick_ - kMaxRecoveryAge) oldest = each.value;
    }
    EXPECT_GE(step, oldest);
    EXPECT_LE(step, steps_.back().value);
    const bool any = running.err().find("--recover: there is nothing to recover") == std::string::npos;
    EXPECT_EQ(any, step > 0) << running.err();
    EXPECT_EQ(any, running.err().find(" restored as of ") != std::string::npos) << running.err();
    running.signal(SIGTERM);
    EXPECT_EQ(running.finish().code, 0);
    // the run exited cleanly and has restored the lost values
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path() + "/state/limber/recovery"));
    // temporary files of the killed program are removed
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() + "/scripts"))
      EXPECT_NE(entry.path().extension(), ".new") << entry.path();
  }

  Random random_;
  int replies_;
  bool records_take_;
  TempFolder folder_;
  std::string scene_;
  osc::test::Client client_;
  system::Endpoint endpoint_{};
  double tick_ = 0;                    // last known
  std::vector<Step> steps_;            // with the last known tick before each
  std::map<std::string, int> stored_;  // sent
  std::map<std::string, int> saved_;   // of these, reported as saved
};

/// Runs a number of rounds, several at a time. One in three plays long enough to save values for recovery.
inline void crash(int rounds, int threads_count) {
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(threads_count));
  for (int i = 0; i < threads_count; i++) {
    threads.emplace_back([&] {
      for (int n = next.fetch_add(1); n < rounds; n = next.fetch_add(1)) {
        Random random(static_cast<std::uint64_t>(n + 1), "moments");
        const bool recovers = n % 3 == 0;
        const double answers = recovers ? random.uniform(340, 800) : random.uniform(2, 120);
        CrashRound(static_cast<std::uint64_t>(n + 1), static_cast<int>(answers), n % 2 == 0).run();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace limber::app::test
