// Playing: the simulation's thread, the network's thread; signals, and the window or the status line on the main one.
#include "app/play.h"

#include <atomic>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "app/ending.h"
#include "app/exit_code.h"
#include "app/paths.h"
#include "app/query_doors.h"
#include "app/render.h"
#include "app/scene_watch.h"
#include "app/service_notifier.h"
#include "app/show.h"
#include "app/show_loop.h"
#include "app/window.h"
#include "base/build_info.h"
#include "base/log.h"
#include "base/log_file.h"
#include "base/output.h"
#include "base/system/resources.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "console/server.h"
#include "engine/engine.h"
#include "osc/network.h"

namespace limber {

namespace {

// "PATH=VALUE": numbers parted by blanks or commas, true, false, text
Result<Message> parse_set(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{fmt::format("--set '{}': write PATH=VALUE, such as /physics/sim/gravity=0,0,-1.6", text)};
  }
  Message message{text.substr(0, equals), {}};
  if (message.address.front() != '/') message.address = fmt::format("/{}", message.address);
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
  if (message.args.empty()) {
    return Error{fmt::format(
        "--set '{}': there is no value after the =; write PATH=VALUE, such as /physics/sim/gravity=0,0,-1.6", text)};
  }
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
  engine.threads = options.threads;
  engine.ticks = options.ticks;
  engine.duration = options.duration;
  engine.preset = options.preset;
  engine.record = options.record;
  engine.replay = options.replay;
  engine.current_scripts = options.current_scripts;
  // batches, replays and films leave nothing that a performer would miss
  const std::string state = state_dir();
  if (!state.empty()) engine.locks = state + "/locks";
  if (!options.fast && options.replay.empty() && !options.picture.offline() && !state.empty())
    engine.recovery = state + "/recovery";
  engine.recover = options.recover;
  for (const std::string& text : options.sets) {
    Result<Message> set = parse_set(text);
    if (!set) return Error{set.error()};
    engine.sets.push_back(std::move(*set));
  }
  return engine;
}

int finish(const PlayOptions& options, Engine& engine, bool interrupted) {
  if (interrupted) print_notice("ended at {:.2f} s", engine.world().time());
  if (options.hash) print_result("hash {:016x} tick {}\n", engine.state_hash(), engine.world().tick());
  if (!options.replay.empty()) {
    const TakeVerdict verdict = engine.verdict();
    print_notice("{}", text_of(verdict));
    if ((verdict.parted && !options.current_scripts) || !verdict.damage.empty()) return kInput;
  }
  if (options.strict && engine.faults() > 0)
    return fail(kInput, "--strict: there was a script error, a refused value or a health event, see above");
  return kFine;
}

// a show without a console is a show; batches have none, as they have no ports. `again`: a failure was said
void open_console(ConsoleServer& console, bool again = false) {
  if (!console.path().empty()) return;
  if (const Result<void> open = console.start(); !open) {
    if (!again) log_warning("there is no console, it is tried again: {}", open.error());
    return;
  }
  print_notice("console {}", console.path());
}

// a port that another program had
void open_query_again(const std::optional<ListenAddress>& at, QueryServer& query) {
  if (at && query.port() == 0 && query.start(*at)) print_notice("{}", query_line(at, query));
}

using QueryWish = std::optional<std::vector<ListenAddress>>;

// OSC's ports and OSCQuery's; the lines that say what is open
Result<void> open_ports(const OscOptions& osc, const std::optional<ListenAddress>& at, Network& network,
                        QueryServer& query) {
  if (Result<void> open = network.start(); !open) return open;
  Result<void> open = at ? query.start(*at) : Result<void>();
  if (!open && !osc.optional) return open;
  if (!open) log_warning("{}; it is tried again every second", open.error());
  for (const std::string& line : network.lines()) print_notice("{}", line);
  print_notice("{}", query_line(at, query));
  return {};
}

// SIGUSR2 is a panic, whatever the main thread is doing
class PanicSignal {
 public:
  explicit PanicSignal(EngineLink& link) {
    link_here.store(&link);
    system::on_user_signal([](int) {
      if (EngineLink* const here = link_here.load()) here->panic_signal.store(true);
    });
  }
  ~PanicSignal() { link_here.store(nullptr); }
  PanicSignal(const PanicSignal&) = delete;
  PanicSignal& operator=(const PanicSignal&) = delete;

 private:
  static inline std::atomic<EngineLink*> link_here{nullptr};
};

// a show with all that surrounds it, from its scene's run to its end
class Playing {
 public:
  Playing(const PlayOptions& options, EngineOptions engine_options, const OscOptions& osc, const QueryWish& query_wish)
      : options_(options),
        osc_(osc),
        query_wish_(query_wish),
        scene_file_(engine_options.scene),
        engine_(link_, with_notifier(std::move(engine_options))),
        network_(link_, osc, live_offsets()),
        console_(link_, {.folder = "", .scene = printable(options.scene)}),
        query_(link_, query_doors(network_, osc.allow, options.query_names)) {
    if ((!options.fast || options.watch) && options.replay.empty()) scene_watch_.emplace(link_, engine_, scene_file_);
  }

  /// The exit code.
  int play() {
    bool interrupted = false;
    {
      Show show(engine_);
      FrameWatch frames;
      ShowLoop loop(show, engine_, link_, notifier_, frames, options_);
      if (const std::optional<int> failed = start(show, loop)) return *failed;
      const auto end_without_window = [&](const char* why) {
        log_error("{}", why);
        const bool ended = interrupted || loop.run_headless();
        show.end();
        end_program(close(ended));
      };
      frames.start([&] { end_without_window("the display does not answer"); });
      const bool waits = loop.open_window();
      if (!show.result() && !waits) return give_up(show.fault(), show.result().error());
      show.go(waits);
      if (scene_watch_) scene_watch_->start();
      if (!show.result()) log_error("{}\nthe stage is empty and waits for the mended file", show.result().error());
      // where Xlib ends the program when the display goes, the show goes on in its place, and the program ends with it
      Window::on_display_lost([&] { end_without_window("the display is lost; playing on headless"); });
      interrupted = loop.run();
      Window::on_display_lost({});
      frames.ending();
      loop.close_window();
    }
    return close(interrupted);
  }

 private:
  EngineOptions with_notifier(EngineOptions options) {
    options.on_turn = [this] { notifier_.turn(); };
    return options;
  }
  // the scene's run, then the ports; the exit code when the show can't be played
  std::optional<int> start(const Show& show, ShowLoop& loop) {
    loop.wait_for_scene();
    if (!show.result() && !loop.may_wait_for_mending()) return give_up(show.fault(), show.result().error());
    const std::optional<ListenAddress> at =
        query_address(query_wish_, effective_plan(osc_, link_.osc_plan.read().get()));
    if (const Result<void> open = open_ports(osc_, at, network_, query_); !open) return give_up(kMachine, open.error());
    if (!options_.fast) open_console(console_);
    loop.each_second([this, at] {
      open_query_again(at, query_);
      if (!options_.fast) open_console(console_, true);
    });
    return std::nullopt;
  }
  int give_up(int code, const std::string& why) {
    engine_.end_recovery();
    return fail(code, why);
  }
  int close(bool ended) {
    notifier_.stopping();
    {
      Ending ending([&] { end_program(finish(options_, engine_, ended)); });
      engine_.finish_saving();
      engine_.end_recovery();
      ending.files_are_whole();
      scene_watch_.reset();
      query_.stop();
      network_.stop();
      console_.stop();
    }
    return finish(options_, engine_, ended);
  }

  const PlayOptions& options_;
  const OscOptions& osc_;
  const QueryWish& query_wish_;
  const std::string scene_file_;
  EngineLink link_;
  const PanicSignal panic_signal_{link_};
  ServiceNotifier notifier_;
  Engine engine_;
  Network network_;
  ConsoleServer console_;
  std::optional<SceneWatch> scene_watch_;
  QueryServer query_;
};

// what was asked for and has no meaning for stills and films
std::string left_aside(const PlayOptions& options) {
  std::string names;
  const auto add = [&](bool given, const char* name) {
    if (given) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  };
  add(!options.osc_in.empty() && options.osc_in != "off", "--osc-in");
  add(!options.osc_out.empty() && options.osc_out.front() != "off", "--osc-out");
  add(!options.query.empty() && options.query != "off", "--query");
  add(options.watch, "--watch");
  return names;
}

// a still or a film: time goes as fast as it is drawn, and nobody comes in from outside
int render_scene(const PlayOptions& options, EngineOptions engine_options) {
  EngineLink link;
  if (const std::string aside = left_aside(options); !aside.empty())
    print_notice("stills and films hear and send nothing: {} {} left aside", aside,
                 aside.find(',') == std::string::npos ? "is" : "are");
  const std::optional<double> duration = engine_options.duration;
  Engine engine(link, std::move(engine_options));
  if (const Result<void> started = engine.start(); !started) return fail(kInput, started.error());
  const Rendered rendered = render(options.picture, engine, link, duration, system::signal_came);
  return rendered.code != kFine ? rendered.code : finish(options, engine, rendered.cancelled);
}

Result<void> open_output(const PlayOptions& options) {
  OutputSetup setup;
  setup.mode = options.fast || options.picture.offline() ? OutputMode::batch : OutputMode::live;
  setup.quiet = options.log.quiet;
  if (!options.log.file.empty()) {
    LogRotation rotation;
    rotation.bytes = static_cast<std::uintmax_t>(options.log.megabytes * 1e6);
    rotation.kept = options.log.kept;
    Result<std::unique_ptr<LogFile>> log = LogFile::open(options.log.file, rotation);
    if (!log) return Error{log.error()};
    setup.log = std::move(*log);
    setup.log_name = printable(options.log.file);
  }
  start_output(std::move(setup));
  return {};
}

}  // namespace

int play_command(const PlayOptions& options) {
  const Result<void> enough = system::check_resources({24, 11 + options.threads, std::size_t{512} * 1024});
  if (!enough) return fail(kMachine, enough.error());
  system::block_signals();
  if (const Result<void> open = open_output(options); !open) return fail(kMachine, open.error());
  const bool replays = !options.replay.empty();
  write_message(
      MessageLevel::info,
      fmt::format("limber {} ({}): {}", version(), commit(), printable(replays ? options.replay : options.scene)), "");
  if (Result<void> picture = check_picture(options.picture, options.duration); !picture)
    return fail(kUsage, picture.error());
  if (options.recover && options.picture.offline())
    return fail(kUsage, "--recover is for a show that plays; leave out --render and --screenshot");
  Result<OscOptions> osc = parse_osc(options);
  if (!osc) return fail(kUsage, osc.error());
  Result<QueryWish> query = parse_query(options.query);
  if (!query) return fail(kUsage, query.error());
  if (options.fast && !*query) query->emplace();  // no port either
  std::vector<std::string> looked;
  const std::string scene = replays ? options.scene : find_scene(options.scene, looked);
  // the current folder may be replaced while the show plays
  std::error_code fault;
  const std::filesystem::path place = std::filesystem::absolute(scene, fault);
  Result<EngineOptions> engine_options = parse_engine(options, fault || scene.empty() ? scene : place.string());
  if (!engine_options) return fail(kUsage, engine_options.error());
  if (scene.empty()) return fail(kInput, no_scene(options.scene, looked));
  if (options.picture.offline()) return render_scene(options, std::move(*engine_options));
  return std::make_unique<Playing>(options, std::move(*engine_options), *osc, *query)->play();
}

}  // namespace limber
