// Playing headless: the simulation's thread, the network's thread, signals and the status line on the main one.
#include "app/play.h"

#include <csignal>
#include <cstdio>
#include <future>
#include <thread>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/build_info.h"
#include "base/log.h"
#include "base/text.h"
#include "engine/engine.h"
#include "osc/network.h"

namespace limber {

namespace {

constexpr int kFine = 0;
constexpr int kInput = 1;
constexpr int kUsage = 2;
constexpr int kMachine = 3;

int fail(int code, std::string_view text) {
  fmt::print(stderr, "limber: {}\n", printable(text));
  return code;
}

// "PATH=VALUE": numbers parted by blanks or commas, true, false, text
Result<Message> parse_set(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{fmt::format("--set '{}': write PATH=VALUE, such as /physics/sim/gravity=0,0,-1.6", text)};
  }
  Message message{text.substr(0, equals), {}};
  if (message.address.front() != '/') message.address.insert(0, "/");
  std::string values = text.substr(equals + 1);
  for (char& c : values) {
    if (c == ',' || c == '\t') c = ' ';
  }
  for (const std::string_view word : split(values, ' ')) {
    if (word.empty()) continue;
    if (const auto number = parse_number(word)) {
      message.args.push_back(Arg::of(*number));
    } else if (word == "true" || word == "false") {
      message.args.push_back(Arg::of(word == "true"));
    } else {
      message.args.push_back(Arg::of(word));
    }
  }
  if (message.args.empty()) return Error{fmt::format("--set '{}': there is no value after the =", text)};
  return message;
}

Result<OscOptions> parse_osc(const PlayOptions& options) {
  OscOptions osc;
  osc.optional = options.osc_optional;
  if (!options.osc_in.empty()) {
    auto in = parse_osc_in(options.osc_in);
    if (!in) return Error{in.error()};
    osc.in = std::move(*in);
  } else if (options.fast) {
    osc.in.emplace();  // batches run side by side: no ports unless asked for
  }
  for (const std::string& text : options.osc_out) {
    auto out = parse_osc_out(text);
    if (!out) return Error{out.error()};
    if (!osc.out) osc.out.emplace();
    osc.out->insert(osc.out->end(), out->begin(), out->end());
  }
  if (options.fast && !osc.out) osc.out.emplace();
  if (!options.osc_allow.empty()) {
    auto allow = parse_osc_allow(options.osc_allow);
    if (!allow) return Error{allow.error()};
    osc.allow = std::move(*allow);
  }
  return osc;
}

Result<EngineOptions> parse_engine(const PlayOptions& options, const std::string& scene) {
  EngineOptions engine;
  engine.scene = scene;
  engine.scene_options.data_dir = data_dir();
  engine.scene_options.package_paths = options.package_paths;
  engine.scene_options.seed = options.seed;
  engine.fast = options.fast;
  engine.strict = options.strict;
  engine.ticks = options.ticks;
  engine.duration = options.duration;
  for (const std::string& text : options.sets) {
    Result<Message> set = parse_set(text);
    if (!set) return Error{set.error()};
    engine.sets.push_back(std::move(*set));
  }
  return engine;
}

// Ctrl+C and kill reach the main thread only, when it waits for them
sigset_t block_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return set;
}

void print_status(const EngineLink& link) {
  const std::shared_ptr<const Snapshot> now = link.snapshots.read();
  if (now == nullptr) return;
  std::size_t joints = 0;
  for (const RosterBody& body : now->roster->bodies) joints += body.joints.size();
  fmt::print(stderr, "limber: {:8.1f} s  tick {}  {}  {} bodies, {} joints  OSC in {} out {}{}\n", now->time, now->tick,
             now->paused ? std::string("paused") : fmt::format("{:.2f} × real time", now->speed),
             now->roster->bodies.size(), joints, link.counters.received.load(), link.counters.sent.load(),
             link.counters.dropped.load() + link.counters.dropped_kernel.load() > 0 ? "  (some were lost)" : "");
}

// the engine on its thread: first whether it could start, then how it went
struct Show {
  explicit Show(Engine& e) : engine(e), thread([this] { play(); }) {}
  ~Show() {
    engine.stop();
    go.set_value_if_unset();
    thread.join();
  }

  struct Gate {
    std::promise<void> promise;
    bool set = false;
    void set_value_if_unset() {
      if (!std::exchange(set, true)) promise.set_value();
    }
  };

  void play() {
    const Result<void> result = engine.start();
    const bool ok = result.ok();
    started.set_value(result);
    if (!ok) return;
    go.promise.get_future().wait();  // the ports are open before the first tick
    engine.run();
    done.set_value();
  }

  Engine& engine;
  std::promise<Result<void>> started;
  std::promise<void> done;
  Gate go;
  std::thread thread;
};

}  // namespace

int play_command(const PlayOptions& options) {
  fmt::print(stderr, "limber {} ({}): {}\n", version(), commit(), options.scene);
  std::vector<std::string> looked;
  const std::string scene = find_scene(options.scene, looked);
  if (scene.empty()) {
    const std::string hint =
        options.scene.ends_with(".lua") ? "" : "; a scene is a .lua file, `limber --help` lists the commands";
    return fail(kInput, fmt::format("there is no scene '{}'; looked for {}{}", options.scene,
                                    fmt::join(looked, " and "), hint));
  }
  Result<OscOptions> osc = parse_osc(options);
  if (!osc) return fail(kUsage, osc.error());
  Result<EngineOptions> engine_options = parse_engine(options, scene);
  if (!engine_options) return fail(kUsage, engine_options.error());

  const sigset_t signals = block_signals();
  EngineLink link;
  Engine engine(link, std::move(*engine_options));
  Network network(link, *osc, live_offsets());
  bool interrupted = false;
  {
    Show show(engine);
    const Result<void> started = show.started.get_future().get();
    if (!started) return fail(kInput, started.error());
    if (const Result<void> open = network.start(); !open) return fail(kMachine, open.error());
    for (const std::string& line : network.lines()) fmt::print(stderr, "limber: {}\n", line);
    if (!options.fast) fmt::print(stderr, "limber: playing headless; Ctrl+C ends it\n");
    std::future<void> done = show.done.get_future();
    show.go.set_value_if_unset();
    while (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      // a second, or a signal; a fast run is looked after more often, since it may end at any time
      const timespec wait = {options.fast || options.ticks || options.duration ? 0 : 1,
                             options.fast                        ? 2000000
                             : options.ticks || options.duration ? 20000000
                                                                 : 0};
      if (sigtimedwait(&signals, nullptr, &wait) > 0) {
        interrupted = true;
        break;
      }
      static auto last = std::chrono::steady_clock::now();
      if (std::chrono::steady_clock::now() - last < std::chrono::seconds(1) &&
          (options.fast || options.ticks || options.duration))
        continue;
      last = std::chrono::steady_clock::now();
      print_status(link);
    }
  }
  network.stop();
  std::fflush(stdout);
  if (interrupted) fmt::print(stderr, "limber: ended at {:.2f} s\n", engine.world().time());
  if (options.hash) {
    fmt::print("hash {:016x} tick {}\n", engine.state_hash(), engine.world().tick());
    std::fflush(stdout);
  }
  if (options.strict && engine.faults() > 0)
    return fail(kInput, "--strict: there was a script error, a refused value or a health event, see above");
  return kFine;
}

}  // namespace limber
