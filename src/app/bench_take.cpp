// A show that is played, recorded and replayed by turns.
#include "app/bench_take.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/bench_folder.h"
#include "app/bench_times.h"
#include "app/paths.h"
#include "base/check.h"
#include "base/log.h"
#include "base/random.h"
#include "engine/engine.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kArms = 16;
constexpr int kMessages = 17;  // a tick: 1000 a second

constexpr const char* kTakenArms = R"(
local arm = sim:load_urdf("{0}/urdf/arm17.urdf", {{ name = "arm1" }})
for i = 2, {1} do arm:copy("arm" .. i, {{ position = vec3(2 * (i % 8), 2 * math.floor(i / 8), 0) }}) end
)";

EngineOptions taken_show(const BenchFolder& folder) {
  EngineOptions options;
  options.scene = folder.scene();
  options.fast = true;
  return options;
}

// messages of one number, as a performer's sliders send them
void push_messages(EngineLink& link, Random& random) {
  for (int i = 0; i < kMessages; i++) {
    const int arm = 1 + static_cast<int>(random.uniform() * kArms);
    const std::string address = fmt::format("/physics/body/arm{}/motor/joint_{}/angular_servo_position", arm, i + 1);
    const auto angle = static_cast<double>(static_cast<float>(random.uniform(-0.5, 0.5)));
    link.inbox.push({{{address, {Arg::of(angle)}}}, {Hand::osc, 0x7f000001, 4000}});
  }
}

// a show, or its replay, and the processor's seconds of its ticks
struct Show {
  explicit Show(const EngineOptions& options) : engine(link, options) { LIMBER_CHECK(engine.start().ok()); }
  void tick() {
    // from another thread, as the network's come: not from memory that is near
    if (!engine.replays()) std::thread([this] { push_messages(link, random); }).join();
    const double start = system::thread_seconds();
    engine.tick();
    seconds += system::thread_seconds() - start;
  }
  void end() {
    LIMBER_CHECK(link.counters.refused.load() == 0);
    LIMBER_CHECK(!engine.replays() || (!engine.verdict().parted && engine.verdict().ticks > 0));
    engine.end_take();
    engine.finish_saving();
  }
  EngineLink link;
  Engine engine;
  Random random{1, "sliders"};
  double seconds = 0;
};

struct Beside {
  double played = 0, recorded = 0, replayed = 0;
};

// tick by tick, so that whatever else goes on here meets all three
Beside play_beside(const BenchFolder& folder, int ticks) {
  EngineOptions recorded = taken_show(folder);
  recorded.record = folder.file("first.take");
  {
    Show first(recorded);
    for (int i = 0; i < ticks; i++) first.tick();
    first.end();
  }
  EngineOptions replayed = taken_show(folder);
  replayed.replay = std::exchange(recorded.record, folder.file("second.take"));
  std::array<Show, 3> shows{Show(taken_show(folder)), Show(recorded), Show(replayed)};
  for (int i = 0; i < ticks; i++) {
    for (int turn = 0; turn < 3; turn++) shows[static_cast<std::size_t>((i + turn) % 3)].tick();
  }
  for (Show& show : shows) show.end();
  return {shows[0].seconds, shows[1].seconds, shows[2].seconds};
}

// what a look at the processor's seconds takes of them
double seconds_of_a_look() {
  Samples looks;
  for (int i = 0; i < 999; i++) {
    const double start = system::thread_seconds();
    looks.add(system::thread_seconds() - start);
  }
  return looks.at(0.5);
}

// what the recorder does in a tick, by itself, beside the tick of the same show
struct Recording {
  double tick = 0, recorder = 0, bytes = 0;
};

// of a take that may not have its name yet
double size_of(const std::string& file) {
  const std::filesystem::path path(file);
  double bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    if (entry.path().filename().string().starts_with(path.filename().string()))
      bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

Recording record_beside(const BenchFolder& folder, int ticks) {
  EngineLink link;
  Engine engine(link, taken_show(folder));
  LIMBER_CHECK(engine.start().ok());
  const std::string file = folder.file("beside.take");
  TakeRecorder recorder({file, false}, {}, [](const std::string&) {});
  LIMBER_CHECK(recorder.opened().ok());
  const double head = size_of(file);
  Random random(1, "sliders");
  std::vector<Command> commands;
  Recording sum;
  CallLedger calls;
  const double look = seconds_of_a_look();
  for (int i = 0; i < ticks; i++) {
    push_messages(link, random);
    link.inbox.drain(commands);
    for (const Command& command : commands) link.inbox.push(command);
    const double begin = system::thread_seconds();
    for (const Command& command : commands) recorder.message(command.messages[0], command.origin);
    const double taken = system::thread_seconds();
    engine.tick();
    const double ticked = system::thread_seconds();
    recorder.end_tick(true, engine.world(), calls, [&] { return engine.state_hash(); });
    sum.recorder += (system::thread_seconds() - ticked) + (taken - begin) - 2 * look;
    sum.tick += ticked - taken - look;
  }
  recorder.finish({}).reset();
  sum.bytes = size_of(file) - head;
  return sum;
}

}  // namespace

Json bench_take(const BenchOptions& options) {
  const int ticks = options.ticks > 0 ? options.ticks : 600;
  const BenchFolder folder;
  std::ofstream(folder.scene()) << fmt::format(kTakenArms, data_dir(), kArms);
  const Recording recording = record_beside(folder, ticks);
  const Beside beside = play_beside(folder, ticks);
  return {{"ticks", ticks},
          {"messages_per_tick", kMessages},
          {"tick_us", rounded(recording.tick / ticks * 1e6, 1)},
          {"recording_us", rounded(recording.recorder / ticks * 1e6, 2)},
          {"recording_percent_of_tick", rounded(100 * recording.recorder / recording.tick, 2)},
          {"mb_per_minute", rounded(recording.bytes / ticks * 3600 / 1e6, 3)},
          {"recorded_by_played", rounded(beside.recorded / beside.played, 3)},
          {"replayed_by_played", rounded(beside.replayed / beside.played, 3)}};
}

}  // namespace limber
