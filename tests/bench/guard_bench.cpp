// Cost of a guarded call, CPU time until an endless one is stopped, and pauses of the garbage collector.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "base/log/log.h"
#include "script/scene/scene.h"
#include "sim/world/world.h"

namespace limber {
namespace {

struct SilentHost : script::ScriptHost {
  void send(Message) override {}
  void reply(const CommandOrigin&, Message) override {}
  void send_direct(const CommandOrigin&, Message) override {}
  void configure_osc(const OscConfig&) override {}
  void request_reset() override {}
  void script_error(std::string_view, int, std::string_view) override { faults++; }
  int faults = 0;
};

// runs and starts a scene from a string
struct Show {
  explicit Show(const std::string& text, script::ScriptLimits limits = {}) {
    log_to_stderr(false);
    script::SceneOptions options;
    options.limits = limits;
    scene = std::make_unique<script::Scene>(world, host, options);
    const auto file = std::filesystem::temp_directory_path() / ("limber_bench_" + std::to_string(::getpid()) + ".lua");
    std::ofstream(file) << text;
    if (const Result<void> loaded = scene->run(file.string()); !loaded) log_error("{}", loaded.error());
    std::filesystem::remove(file);
    world.flush();
    scene->start();
  }
  Store store;
  sim::World world{store};
  SilentHost host;
  std::unique_ptr<script::Scene> scene;
};

double cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) / 1e6;
}

void BM_GuardedCall(benchmark::State& state) {
  Show show("local n = 0 for i = 1, 1000 do sim:on_step(function() n = n + 1 end) end");
  for (auto _ : state) show.scene->tick(1.0 / 60);
  state.counters["ns_per_call"] = benchmark::Counter(static_cast<double>(state.iterations()) * 1000,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_GuardedCall);

void BM_GuardedCallThatWrites(benchmark::State& state) {
  Show show(R"(
local ball, parts = sim:add_sphere_shape("ball", 0.1), {}
for i = 1, 1000 do
  parts[i] = sim:add_body("b" .. i):add_part("p", ball, { position = { i, 0, 0 } })
end
sim:on_step(function()
  for i = 1, #parts do
    local part = parts[i]
    part:apply_force(vec3(0, 0, part.position.z))
  end
end))");
  for (auto _ : state) show.scene->tick(1.0 / 60);
  state.counters["ns_per_part"] = benchmark::Counter(static_cast<double>(state.iterations()) * 1000,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_GuardedCallThatWrites);

// CPU time from the start of an endless handler until it was stopped and rolled back
void stop_latency(benchmark::State& state, const std::string& body, int memory_mb = 64) {
  script::ScriptLimits limits;
  limits.memory = static_cast<std::size_t>(memory_mb) << 20u;
  Show show("local s = ('x'):rep(8e6) osc:on('/go', function() " + body + " end)", limits);
  std::vector<double> times;
  for (auto _ : state) {
    const double before = cpu_ms();
    show.scene->handle_message({"/go", {}}, {});
    times.push_back(cpu_ms() - before);
    for (int i = 0; i < 100; i++) show.scene->collect_garbage();
  }
  std::sort(times.begin(), times.end());
  state.counters["median_cpu_ms"] = times[times.size() / 2];
  state.counters["worst_cpu_ms"] = times.back();
  state.counters["stopped"] = show.host.faults;
}

const std::vector<std::pair<const char*, const char*>> kEndless = {
    {"loop", "while true do end"},
    {"pcall", "while true do pcall(function() while true do end end) end"},
    {"coroutine", "coroutine.wrap(function() while true do end end)()"},
    {"tables", "local t while true do t = { t } if #t > 5 then return end t = nil end"},
    {"sort", "local t = {} for i = 1, 3e5 do t[i] = (i * 7919) % 1000003 end while true do table.sort(t) end"},
    {"pattern", "while true do pcall(string.find, s, ('a*'):rep(50) .. 'b') end"},
    {"plain_find", "local w = ('x'):rep(250) .. 'y' while true do s:find(w, 1, true) end"},
    {"gsub", "while true do s:gsub('x', 'y') end"},
    {"upper", "local u = s:sub(1, 4e6) while true do u:upper() u:reverse() end"},
    {"rep", "while true do ('x'):rep(8e6) end"},
    {"coercion", "local d = ('1'):rep(8e6) while true do pcall(function() return d + 1 end) end"},
    {"concat", "local t = {} for i = 1, 5e5 do t[i] = 'a' end while true do table.concat(t) end"},
    {"rehash", "while true do local t = {} for i = 1, 4e5 do t[i * 1.5] = i end end"},
    {"insert", "local t = {} for i = 1, 9e5 do t[i] = i end while true do table.insert(t, 1, 0) end"},
    {"load",
     "local l = { 'local a while true do' } for i = 1, 1990 do l[#l + 1] = 'if a then break end' end "
     "l[#l + 1] = 'end' local t = table.concat(l, '\\n') while true do load(t) end"},
    {"words", "local t = 'local a x = ' .. ('a and '):rep(15000) .. 'a' while true do load(t) end"},
    {"hash", "while true do sim:state_hash() end"},
    {"bodies", "local n = 0 while true do n = n + 1 sim:add_body('b' .. n) end"},
};

// compiled garbage: the longest slice in 2000 ticks that each produce `range(0)` kB of garbage, with `range(1)` MB of
// live data
void BM_CollectorPause(benchmark::State& state) {
  Show show("kept = {} for i = 1, " + std::to_string(state.range(1)) +
            " * 10000 do kept[i] = { i, i + 1, i + 2 } end sim:on_step(function() for i = 1, " +
            std::to_string(state.range(0) * 1024 / 80) + " do local t = { i, i, kept } last = t end end)");
  double worst = 0;
  std::vector<double> times;
  for (auto _ : state) {
    show.scene->tick(1.0 / 60);
    const double before = cpu_ms();
    show.scene->collect_garbage();
    times.push_back((cpu_ms() - before) * 1000);
    worst = std::max(worst, times.back());
  }
  std::sort(times.begin(), times.end());
  state.counters["median_us"] = times[times.size() / 2];
  state.counters["p999_us"] = times[times.size() * 999 / 1000];
  state.counters["worst_us"] = worst;
  state.counters["faults"] = show.host.faults;
}
BENCHMARK(BM_CollectorPause)->ArgsProduct({{16, 160, 1024}, {0, 10, 30}})->Iterations(2000);

const int kRegistered = [] {
  for (const auto& [name, body] : kEndless) {
    const std::string text = body;
    benchmark::RegisterBenchmark(("BM_StopLatency/" + std::string(name)).c_str(), [text](benchmark::State& state) {
      stop_latency(state, text);
    })->Iterations(20);
  }
  return 0;
}();

}  // namespace
}  // namespace limber
