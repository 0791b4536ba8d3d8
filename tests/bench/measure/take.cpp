// Alternates between playing, recording and replaying a show.
#include "bench/measure/measures.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/check.h"
#include "base/log/log.h"
#include "base/random.h"
#include "bench/measure/show_folder.h"
#include "bench/measure/times.h"
#include "engine/engine.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kArms = 16;
constexpr int kMessages = 17;  // per tick: 1000 a second

constexpr const char* kTakeScene = R"(
local arm = sim:load_urdf("{0}/urdf/arm17.urdf", {{ name = "arm1" }})
for i = 2, {1} do arm:copy("arm" .. i, {{ position = vec3(2 * (i % 8), 2 * math.floor(i / 8), 0) }}) end
)";

engine::EngineOptions show_options(const ShowFolder& folder) {
  engine::EngineOptions options;
  options.scene = folder.scene();
  options.fast = true;
  return options;
}

// messages of one number, as sent by sliders
void push_messages(engine::EngineLink& link, Random& random) {
  for (int i = 0; i < kMessages; i++) {
    const int arm = 1 + static_cast<int>(random.uniform() * kArms);
    const std::string address = fmt::format("/physics/body/arm{}/motor/joint_{}/angular_servo_position", arm, i + 1);
    const auto angle = static_cast<double>(static_cast<float>(random.uniform(-0.5, 0.5)));
    link.command_queue.push({{{address, {Arg::of(angle)}}}, {CommandSource::osc, 0x7f000001, 4000}});
  }
}

// a show or its replay, and the processor time of its ticks
struct Show {
  explicit Show(const engine::EngineOptions& options) : engine(link, options) { LIMBER_CHECK(engine.start().ok()); }
  void tick() {
    // from another thread, like messages from the network, so that they are not in this core's cache
    if (!engine.is_replaying()) std::thread([this] { push_messages(link, random); }).join();
    const double start = system::thread_seconds();
    engine.tick();
    seconds += system::thread_seconds() - start;
  }
  void end() {
    LIMBER_CHECK(link.counters.refused.load() == 0);
    LIMBER_CHECK(!engine.is_replaying() || (!engine.replay_result().diverged_at && engine.replay_result().ticks > 0));
    engine.end_take();
    engine.finish_saving();
  }
  engine::EngineLink link;
  engine::Engine engine;
  Random random{1, "sliders"};
  double seconds = 0;
};

struct RunTimes {
  double played = 0, recorded = 0, replayed = 0;
};

// alternates tick by tick, so that disturbances affect all three equally
RunTimes compare_runs(const ShowFolder& folder, int ticks) {
  engine::EngineOptions recorded = show_options(folder);
  recorded.record = folder.file("first.take");
  {
    Show first(recorded);
    for (int i = 0; i < ticks; i++) first.tick();
    first.end();
  }
  engine::EngineOptions replayed = show_options(folder);
  replayed.replay = std::exchange(recorded.record, folder.file("second.take"));
  std::array<Show, 3> shows{Show(show_options(folder)), Show(recorded), Show(replayed)};
  for (int i = 0; i < ticks; i++) {
    for (int k = 0; k < 3; k++) shows[static_cast<std::size_t>((i + k) % 3)].tick();
  }
  for (Show& show : shows) show.end();
  return {shows[0].seconds, shows[1].seconds, shows[2].seconds};
}

// overhead of one clock reading
double clock_overhead() {
  TimeSamples reads;
  for (int i = 0; i < 999; i++) {
    const double start = system::thread_seconds();
    reads.add(system::thread_seconds() - start);
  }
  return reads.quantile(0.5);
}

// processor time of the recorder in a tick, next to that of the tick
struct Recording {
  double tick = 0, recorder = 0, bytes = 0;
};

// also of a take that is still being written under a temporary name
double size_of(const std::string& file) {
  const std::filesystem::path path(file);
  double bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    if (entry.path().filename().string().starts_with(path.filename().string()))
      bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

Recording measure_recording(const ShowFolder& folder, int ticks) {
  engine::EngineLink link;
  engine::Engine engine(link, show_options(folder));
  LIMBER_CHECK(engine.start().ok());
  const std::string file = folder.file("beside.take");
  engine::BackgroundWriter writer;
  engine::TakeRecorder recorder(writer, {file, false}, {}, [](const std::string&) {});
  LIMBER_CHECK(recorder.wait_until_open().ok());
  const double head = size_of(file);
  Random random(1, "sliders");
  std::vector<engine::Command> commands;
  Recording sum;
  script::CallLog calls;
  const double overhead = clock_overhead();
  for (int i = 0; i < ticks; i++) {
    push_messages(link, random);
    link.command_queue.drain(commands);
    for (const engine::Command& command : commands) link.command_queue.push(command);
    const double begin = system::thread_seconds();
    for (const engine::Command& command : commands) recorder.record_message(command.messages[0], command.origin);
    const double taken = system::thread_seconds();
    engine.tick();
    const double ticked = system::thread_seconds();
    recorder.end_tick(true, engine.world(), calls, [&] { return engine.state_hash(); });
    sum.recorder += (system::thread_seconds() - ticked) + (taken - begin) - 2 * overhead;
    sum.tick += ticked - taken - overhead;
  }
  recorder.finish({}).reset();
  sum.bytes = size_of(file) - head;
  return sum;
}

}  // namespace

Json measure_take(const MeasureOptions& options) {
  const int ticks = options.ticks > 0 ? options.ticks : 600;
  const ShowFolder folder;
  std::ofstream(folder.scene()) << fmt::format(kTakeScene, app::data_dir(), kArms);
  const Recording recording = measure_recording(folder, ticks);
  const RunTimes times = compare_runs(folder, ticks);
  return {{"ticks", ticks},
          {"messages_per_tick", kMessages},
          {"tick_us", rounded(recording.tick / ticks * 1e6, 1)},
          {"recording_us", rounded(recording.recorder / ticks * 1e6, 2)},
          {"recording_percent_of_tick", rounded(100 * recording.recorder / recording.tick, 2)},
          {"mb_per_minute", rounded(recording.bytes / ticks * 3600 / 1e6, 3)},
          {"recorded_by_played", rounded(times.recorded / times.played, 3)},
          {"replayed_by_played", rounded(times.replayed / times.played, 3)}};
}

}  // namespace limber
