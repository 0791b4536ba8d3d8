// A show that is killed: messages, presets that are stored, a take, all by a seed, and SIGKILL behind so many answers.
// Then what is on the disk, and the next start.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "app/program.h"
#include "base/random.h"
#include "engine/preset_file.h"
#include "osc/decode.h"
#include "osc/encode.h"
#include "osc/osc_test_tools.h"

namespace limber::app_test {

inline constexpr const char* kCrashScene = R"(
params { { "mark", 0, max = 1000000 } }
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 6 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 0.5 * i) }) end
sim:every(0.2, function() sim:body("ball1").parts[1]:apply_impulse(rng:direction() * 0.01) end)
)";

class CrashRound {
 public:
  /// Greatest age of the values that a recovery restores, in ticks: a copy is made every five seconds, and the one
  /// before is still being written.
  static constexpr double kSpareTicks = 600;

  /// Killed behind about so many answers, each of which is a tick; with a `take` or without one.
  CrashRound(std::uint64_t seed, int answers, bool take)
      : random_(seed, "crash"), wanted_(answers), takes_(take), scene_(folder_.file("scripts/s.lua", kCrashScene)) {}

  void run() {
    const std::string at = fmt::format("killed behind {} answers{}", wanted_, takes_ ? " with a take" : "");
    SCOPED_TRACE(at);
    play();
    check_presets();
    if (takes_) check_take();
    check_recovery();
  }

 private:
  // what the n-th step sets: two rows in one tick, so that what is half-written would show
  struct Mark {
    int value = 0;
    double tick = 0;
  };

  std::vector<std::string> words(std::vector<std::string> more) const {
    std::vector<std::string> args = {scene_,      "--headless", "--osc-in", "127.0.0.1:0",
                                     "--osc-out", "off",        "--query",  "off"};
    args.insert(args.end(), more.begin(), more.end());
    return limber(std::move(args), {"env", "XDG_STATE_HOME=" + folder_.path() + "/state"});
  }
  // false: the program does not play
  bool begin(Running& running) {
    if (!running.wait_for("playing headless")) return false;
    end_ = {0x7f000001, static_cast<std::uint16_t>(std::stoi(running.behind("OSC in 127.0.0.1:")))};
    return true;
  }
  void send(const Message& message) const {
    PacketBuffer buffer;
    const std::span<const char> bytes = encode_message(message, buffer);
    client_.send(end_, {bytes.data(), bytes.size()});
  }
  // the first number of the next answer with that address
  double answer(const std::string& address) const {
    while (const auto bytes = client_.receive()) {
      const Result<Decoded> decoded = decode_packet(bytes->data(), bytes->size());
      for (const Message& message : decoded->messages) {
        if (message.address == address) return message.args.empty() ? 0 : message.args[0].number;
      }
    }
    ADD_FAILURE() << "no " << address;
    return -1;
  }
  double get(const std::string& path) const {
    send({"/get", {Arg::of(path)}});
    return answer(path);
  }

  void play() {
    Running running(words({}));
    ASSERT_TRUE(begin(running)) << running.err();
    if (takes_) {
      send({"/take/record", {Arg::of("crash")}});
      answer("/take/recording");
    }
    for (int n = 1; n <= wanted_; n++) {
      marks_.push_back({n, tick_});
      send({"/scene/mark", {Arg::of(static_cast<double>(n))}});
      send({"/physics/sim/gravity", {Arg::of(-n / kGravity)}});
      if (random_.uniform() < 0.4) {
        const std::string name = fmt::format("p{}", static_cast<int>(random_.uniform(0, 8)));
        send({"/preset/store", {Arg::of(name)}});
        stored_[name] = n;
      }
      // the last moment lies in the middle of a tick's writing, or before it
      if (n == wanted_ && random_.uniform() < 0.5) break;
      tick_ = get("/physics/sim/tick");
      if (random_.uniform() < 0.3 && get("/preset/saved") == 1) confirmed_ = stored_;
    }
    running.signal(SIGKILL);
    running.finish();
  }

  static constexpr double kGravity = 128;  // steps in 1 m/s²

  // the two rows of a preset: both are of one step
  static int mark_of(const Preset& preset) {
    double mark = -1;
    double gravity = -1;
    for (std::uint32_t i = 0; i < preset.shape->things().size(); i++) {
      const PresetShape::Thing& thing = preset.shape->things()[i];
      const PresetClass* const rows = preset.shape->rows(thing);
      if (rows == nullptr) continue;
      const auto number = [&](const char* name, std::uint32_t index) {
        const int at = rows->find(name);
        return at < 0 ? -1 : preset.values[thing.at + rows->offsets[static_cast<std::size_t>(at)] + index];
      };
      if (preset.shape->path(i) == "/scene") mark = number("mark", 0);
      if (preset.shape->path(i) == "/physics/sim") gravity = -kGravity * number("gravity", 2);
    }
    EXPECT_EQ(mark, gravity) << preset.name;
    return static_cast<int>(mark);
  }

  void check_presets() {
    PresetFile file(PresetFile::beside(scene_));
    const Result<PresetsRead> read = file.load();
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_TRUE(read->problems.empty());
    std::map<std::string, int> found;
    for (const auto& preset : read->presets) found[preset->name] = mark_of(*preset);
    for (const auto& [name, mark] : confirmed_) EXPECT_GE(found[name], mark) << name;
    for (const auto& [name, mark] : found) EXPECT_LE(mark, stored_[name]) << name;
  }

  void check_take() {
    const std::string beside = folder_.path() + "/scripts/takes/crash.take";
    const std::string take = std::filesystem::exists(beside) ? beside : folder_.path() + "/takes/crash.take";
    // one that was killed before its first tick is none
    if (tick_ < 30 && !std::filesystem::exists(take)) return;
    const Ran again = app_test::run({"--replay", take, "--fast"});
    EXPECT_EQ(again.code, 0) << again.err;
    const std::size_t at = again.err.find("replayed ");
    ASSERT_NE(at, std::string::npos) << again.err;
    EXPECT_NE(again.err.find("every hash is the take's; the take was cut off there\n"), std::string::npos) << again.err;
    EXPECT_GE(std::stod(again.err.substr(at + 9)), tick_ - 60) << "a tenth of a second may be lost, here a whole one";
  }

  void check_recovery() {
    Running running(words({"--recover"}));
    ASSERT_TRUE(begin(running)) << running.err();
    const auto mark = static_cast<int>(get("/scene/mark"));
    EXPECT_EQ(get("/physics/sim/gravity"), 0) << "its x";
    int oldest = 0;
    for (const Mark& each : marks_) {
      if (each.tick <= tick_ - kSpareTicks) oldest = each.value;
    }
    EXPECT_GE(mark, oldest);
    EXPECT_LE(mark, marks_.back().value);
    const bool any = running.err().find("--recover: there is nothing to recover") == std::string::npos;
    EXPECT_EQ(any, mark > 0) << running.err();
    EXPECT_EQ(any, running.err().find(" back as they were at ") != std::string::npos) << running.err();
    running.signal(SIGTERM);
    EXPECT_EQ(running.finish().code, 0);
    // that run has ended well, and has brought back what was lost
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path() + "/state/limber/recovery"));
    // what the killed one had begun to write is gone
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() + "/scripts"))
      EXPECT_NE(entry.path().extension(), ".new") << entry.path();
  }

  Random random_;
  int wanted_;
  bool takes_;
  Folder folder_;
  std::string scene_;
  osc_test::Client client_;
  Endpoint end_{};
  double tick_ = 0;                       // seen last
  std::vector<Mark> marks_;               // by the tick that was seen before each
  std::map<std::string, int> stored_;     // sent
  std::map<std::string, int> confirmed_;  // of these, told to be on the disk
};

/// So many rounds, a number of them at a time. One in three lives long enough for its values to be kept.
inline void crash(int rounds, int at_once) {
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(at_once));
  for (int i = 0; i < at_once; i++) {
    threads.emplace_back([&] {
      for (int n = next.fetch_add(1); n < rounds; n = next.fetch_add(1)) {
        Random random(static_cast<std::uint64_t>(n + 1), "moments");
        const bool kept = n % 3 == 0;
        const double answers = kept ? random.uniform(340, 800) : random.uniform(2, 120);
        CrashRound(static_cast<std::uint64_t>(n + 1), static_cast<int>(answers), n % 2 == 0).run();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace limber::app_test
