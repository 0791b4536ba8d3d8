// Plays a scene: sets up the threads of the simulation and the network; signals and the window or status line use the
// main thread.
#include "app/show/play.h"

#include <atomic>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/service/announcer.h"
#include "app/show/engine_thread.h"
#include "app/show/query_host.h"
#include "app/show/run_file.h"
#include "app/show/scene_loader.h"
#include "app/show/service_notifier.h"
#include "app/show/show_loop.h"
#include "app/show/shutdown_guard.h"
#include "app/view/render.h"
#include "app/view/window.h"
#include "app/viewer/played_file.h"
#include "base/build_info.h"
#include "base/log/log.h"
#include "base/log/log_file.h"
#include "base/log/output.h"
#include "base/system/resources.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "engine/engine.h"
#include "net/console/server.h"
#include "net/lighting/output.h"
#include "net/link/link_session.h"
#include "net/midi/service.h"
#include "net/osc/network.h"
#include "script/scene/scene.h"

namespace limber::app {

namespace {

// an option whose text is NAME=VALUE
struct ValueOption {
  std::string_view name;
  std::string_view form;    // of its text, with an example
  std::string_view prefix;  // of the address
};
constexpr ValueOption kSetOption{"--set", "PATH=VALUE, such as /physics/sim/gravity=0,0,-1.6", "/"};
constexpr ValueOption kParamOption{"--param", "NAME=VALUE, such as rate=0.5", "/scene/"};

// parses "NAME=VALUE": numbers separated by spaces or commas, true, false, or text
Result<Message> parse_value(const std::string& text, const ValueOption& option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return Error{fmt::format("{} '{}': write {}", option.name, printable(text), option.form)};
  Message message{text.substr(0, equals), {}};
  if (message.address.front() != '/') message.address = fmt::format("{}{}", option.prefix, message.address);
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
    return Error{fmt::format("{} '{}': no value after the =; write {}", option.name, printable(text), option.form)};
  }
  return message;
}

Result<osc::OscOptions> parse_osc(const NetworkOptions& options, bool fast) {
  osc::OscOptions osc;
  osc.optional = options.osc_optional;
  osc.shared = options.osc_share;
  if (!options.osc_in.empty()) {
    auto in = osc::parse_osc_in(options.osc_in);
    if (!in) return Error{in.error()};
    osc.in = std::move(*in);
  } else if (fast) {
    osc.in.emplace();  // batch runs may run in parallel: no ports unless requested
  }
  auto tcp = osc::parse_listen("--osc-tcp", options.osc_tcp.empty() ? "off" : options.osc_tcp);
  if (!tcp) return Error{tcp.error()};
  osc.tcp = std::move(*tcp);
  for (const std::string& text : options.osc_out) {
    auto out = osc::parse_osc_out(text);
    if (!out) return Error{out.error()};
    if (!osc.out) osc.out.emplace();
    osc.out->insert(osc.out->end(), out->begin(), out->end());
  }
  if (fast && !osc.out) osc.out.emplace();
  if (!options.osc_allow.empty()) {
    auto allow = osc::parse_osc_allow(options.osc_allow);
    if (!allow) return Error{allow.error()};
    osc.allow = std::move(*allow);
  }
  return osc;
}

Result<lighting::LightingOptions> parse_lights(const PlayOptions& options) {
  lighting::LightingOptions lights;
  lights.lights = options.network.lights;
  lights.in_real_time = !options.fast;
  const std::vector<std::string> automatic = {"sacn"};
  for (const std::string& text : options.network.lights_out.empty() ? automatic : options.network.lights_out) {
    auto targets = lighting::parse_lights_out(text);
    if (!targets) return Error{targets.error()};
    lights.targets.insert(lights.targets.end(), targets->begin(), targets->end());
  }
  if (options.fast && !options.network.lights) lights.targets.clear();
  return lights;
}

// batch runs and replays use no devices unless requested
midi::MidiOptions parse_midi(const PlayOptions& options) {
  using Use = midi::MidiOptions::Use;
  const MidiChoices& chosen = options.network.midi;
  midi::MidiOptions midi;
  const bool asked = !chosen.use.empty() || !chosen.clock_from.empty() || !chosen.clock_to.empty();
  midi.use = asked ? Use::on : options.fast || !options.take.replay.empty() ? Use::off : Use::on_demand;
  if (chosen.use == "off") midi.use = Use::off;
  if (chosen.use != "all" && chosen.use != "off") midi.ports = chosen.use;
  midi.clock_from = chosen.clock_from;
  midi.clock_to = chosen.clock_to;
  return midi;
}

Result<engine::EngineOptions> parse_engine(const PlayOptions& options, const std::string& scene) {
  engine::EngineOptions engine;
  engine.scene = scene;
  engine.scene_options.data_dir = data_dir();
  engine.scene_options.package_paths = options.package_paths;
  engine.scene_options.seed = options.seed;
  engine.fast = options.fast;
  engine.lockstep = options.lockstep;
  engine.strict = options.strict;
  engine.threads = options.threads;
  engine.ticks = options.ticks;
  engine.duration = options.duration;
  engine.preset = options.preset;
  if (!options.run.cues.empty()) engine.files.cues = absolute_path(options.run.cues);
  if (!options.run.presets.empty()) engine.files.presets = absolute_path(options.run.presets);
  engine.record = options.take.record;
  engine.replay = options.take.replay;
  engine.current_scripts = options.take.current_scripts;
  // batch runs, runs in lockstep, replays and films save no recovery file
  const std::string state = state_dir();
  if (!state.empty()) engine.files.locks = state + "/locks";
  if (engine.in_real_time() && options.take.replay.empty() && !options.display.offline() && !state.empty())
    engine.recovery.folder = state + "/recovery";
  engine.recovery.restore = options.recover;
  if (options.network.lights && engine.replay.empty()) engine.sets.push_back({"/lighting/armed", {Arg::of(true)}});
  for (const std::string& text : options.run.params) {
    Result<Message> param = parse_value(text, kParamOption);
    if (!param) return Error{param.error()};
    engine.params.push_back(std::move(*param));
  }
  for (const std::string& text : options.run.sets) {
    Result<Message> set = parse_value(text, kSetOption);
    if (!set) return Error{set.error()};
    engine.sets.push_back(std::move(*set));
  }
  return engine;
}

// computes the results, after the state hash, and writes them to the output file, if there is one
Result<void> finish_results(const PlayOptions& options, engine::Engine& engine, RunFile* file) {
  if (engine.scene() == nullptr) return {};
  const std::uint64_t hash = engine.state_hash();
  (void)engine.scene()->compute_results();
  if (options.fast || file != nullptr) print_results(engine);
  return file == nullptr ? Result<void>() : file->finish(engine, hash);
}

int finish(const PlayOptions& options, engine::Engine& engine, bool interrupted, RunFile* file = nullptr) {
  if (interrupted) print_notice("ended at {:.2f} s", engine.world().time());
  if (options.hash) print_result("hash {:016x} tick {}\n", engine.state_hash(), engine.world().tick());
  if (const Result<void> written = finish_results(options, engine, file); !written)
    return fail(kMachineError, written.error());
  if (!options.take.replay.empty()) {
    const engine::ReplayResult result = engine.replay_result();
    print_notice("{}", engine::text_of(result));
    if ((result.diverged_at && !options.take.current_scripts) || !result.damage.empty()) return kInputError;
  }
  if (options.strict && engine.faults() > 0)
    return fail(kInputError, "--strict: there was a script error, a rejected value or a health event, see above");
  return kSuccess;
}

// a console that can't be opened doesn't stop the show; batch runs have none, like ports. `retry`: a failure was
// already reported
void open_console(console::ConsoleServer& console, bool retry = false) {
  if (!console.path().empty()) return;
  if (const Result<void> open = console.start(); !open) {
    if (!retry) log_warning("console not available, retrying: {}", open.error());
    return;
  }
  print_notice("console {}", console.path());
}

// retries a port that was in use
void retry_query(const std::optional<ListenAddress>& at, oscquery::QueryServer& query) {
  if (at && query.port() == 0 && query.start(*at)) print_notice("{}", query_line(at, query));
}

using QueryAddresses = std::optional<std::vector<ListenAddress>>;

// the parsed options of everything that the show is connected to
struct Outputs {
  osc::OscOptions osc;
  QueryAddresses query;
  lighting::LightingOptions lights;
  midi::MidiOptions midi;
};

// opens the ports of OSC and OSCQuery and prints them
Result<void> open_ports(const osc::OscOptions& osc, const std::optional<ListenAddress>& at, osc::Network& network,
                        oscquery::QueryServer& query) {
  if (Result<void> open = network.start(); !open) return open;
  Result<void> open = at ? query.start(*at) : Result<void>();
  if (!open && !osc.optional) return open;
  if (!open) log_warning("{}; retrying every second", open.error());
  for (const std::string& line : network.status_lines()) print_notice("{}", line);
  print_notice("{}", query_line(at, query));
  return {};
}

// SIGUSR2 triggers a panic, whatever the main thread is doing
class PanicSignal {
 public:
  explicit PanicSignal(engine::EngineLink& link) {
    active_link.store(&link);
    system::on_user_signal([](int) {
      if (engine::EngineLink* const here = active_link.load()) here->panic_signal.store(true);
    });
  }
  ~PanicSignal() { active_link.store(nullptr); }
  PanicSignal(const PanicSignal&) = delete;
  PanicSignal& operator=(const PanicSignal&) = delete;

 private:
  static inline std::atomic<engine::EngineLink*> active_link{nullptr};
};

// Owns the engine, the network and the other services of a running show.
class Playing {
 public:
  Playing(const PlayOptions& options, engine::EngineOptions engine_options, const Outputs& outputs,
          const std::optional<ModelScene>& model)
      : options_(options),
        osc_(outputs.osc),
        query_addresses_(outputs.query),
        scene_file_(engine_options.scene),
        models_(model, options.package_paths),
        engine_(link_, with_notifier(std::move(engine_options))),
        network_(link_, osc_, engine::transient_offsets()),
        lights_(link_, outputs.lights),
        midi_(link_, outputs.midi),
        console_(link_, {.folder = "", .scene = printable(options.scene)}),
        query_(link_, query_host(network_, osc_.allow, options.network.query_names)) {
    if (!options.network.zeroconf.empty()) announcer_.emplace(options.network.zeroconf);
    if (!options.run.out.empty()) run_file_.emplace(options.run.out, options.scene, options.fast || options.lockstep);
    if ((!options.fast || options.watch) && options.take.replay.empty())
      scene_loader_.emplace(link_, engine_, scene_file_, &models_);
    if (scene_loader_) scene_loader_->on_scene([this](const std::string& scene) { midi_.set_scene(scene); });
    midi_.set_scene(scene_file_);
  }

  /// Returns the exit code.
  int play() {
    bool interrupted = false;
    {
      EngineThread engine_thread(engine_);
      DisplayWatchdog display_watchdog;
      ShowLoop loop(engine_thread, engine_, link_, notifier_, display_watchdog, options_, models_);
      if (const std::optional<int> failed = start(engine_thread, loop)) return *failed;
      const auto end_without_window = [&](const char* reason) {
        log_error("{}", reason);
        const bool ended = interrupted || loop.run_headless();
        engine_thread.end();
        end_program(close(ended));
      };
      display_watchdog.start([&] { end_without_window("the display does not answer"); });
      const bool waits = loop.open_window();
      if (!engine_thread.result() && !waits)
        return fail_start(engine_thread.exit_code(), engine_thread.result().error());
      engine_thread.allow_ticks(waits);
      if (scene_loader_) scene_loader_->start();
      if (!engine_thread.result())
        log_error("{}\nthe world stays empty until the file is fixed", engine_thread.result().error());
      // Xlib ends the program when the display is lost: the callback plays on headless instead and ends the program
      // itself
      Window::on_display_lost([&] { end_without_window("the display is lost; playing on headless"); });
      interrupted = loop.run();
      Window::on_display_lost({});
      display_watchdog.ending();
      loop.close_window();
    }
    return close(interrupted);
  }

 private:
  engine::EngineOptions with_notifier(engine::EngineOptions options) {
    options.on_iteration = [this] {
      notifier_.on_iteration();
      lights_.notify();
      if (run_file_) run_file_->collect(engine_);
    };
    return options;
  }
  // runs the scene, then opens the ports; returns the exit code if the show can't be played
  std::optional<int> start(const EngineThread& engine_thread, ShowLoop& loop) {
    loop.wait_for_scene();
    if (!engine_thread.result() && !loop.may_wait_for_fix())
      return fail_start(engine_thread.exit_code(), engine_thread.result().error());
    if (run_file_ && engine_thread.result()) {
      if (const Result<void> open = run_file_->open(engine_); !open) return fail_start(kInputError, open.error());
    }
    const std::optional<ListenAddress> at =
        query_address(query_addresses_, osc::effective_config(osc_, link_.osc_config.read().get()));
    if (const Result<void> open = open_ports(osc_, at, network_, query_); !open)
      return fail_start(kMachineError, open.error());
    lights_.start();
    midi_.start();
    if (options_.network.lights) {
      for (const std::string& line : lights_.status_lines()) print_notice("{}", line);
    }
    if (options_.network.link && !options_.fast && options_.take.replay.empty()) link_session_.start();
    if (!options_.fast) open_console(console_);
    update_announcer();
    loop.set_retry([this, at] {
      update_announcer();
      retry_query(at, query_);
      if (!options_.fast) open_console(console_, true);
    });
    return std::nullopt;
  }
  void update_announcer() {
    if (!announcer_) return;
    std::vector<AnnouncedPort> ports;
    for (const osc::Endpoint& end : network_.bound()) ports.push_back({"_osc._udp", end.port});
    for (const osc::Endpoint& end : network_.bound_tcp()) ports.push_back({"_osc._tcp", end.port});
    if (query_.port() != 0) ports.push_back({"_oscjson._tcp", query_.port()});
    announcer_->update(ports);
  }
  int fail_start(int code, const std::string& reason) {
    engine_.end_recovery();
    return fail(code, reason);
  }
  int close(bool ended) {
    notifier_.stopping();
    {
      ShutdownGuard guard([&] { end_program(finish(options_, engine_, ended)); });
      engine_.finish_saving();
      engine_.end_recovery();
      guard.files_written();
      scene_loader_.reset();
      announcer_.reset();
      lights_.stop();
      link_session_.stop();
      midi_.stop();
      query_.stop();
      network_.stop();
      console_.stop();
    }
    return finish(options_, engine_, ended, run_file_ ? &*run_file_ : nullptr);
  }

  const PlayOptions& options_;
  const osc::OscOptions& osc_;
  const QueryAddresses& query_addresses_;
  const std::string scene_file_;
  ShownModels models_;
  engine::EngineLink link_;
  const PanicSignal panic_signal_{link_};
  ServiceNotifier notifier_;
  engine::Engine engine_;
  osc::Network network_;
  lighting::LightingOutput lights_;
  link::LinkSession link_session_{link_, link_program()};
  std::optional<Announcer> announcer_;
  midi::MidiService midi_;
  console::ConsoleServer console_;
  std::optional<SceneLoader> scene_loader_;
  std::optional<RunFile> run_file_;
  oscquery::QueryServer query_;
};

// the given options that have no meaning for still images and films
std::string ignored_options(const PlayOptions& options) {
  std::string names;
  const auto add = [&](bool given, const char* name) {
    if (given) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  };
  add(!options.network.osc_in.empty() && options.network.osc_in != "off", "--osc-in");
  add(!options.network.osc_out.empty() && options.network.osc_out.front() != "off", "--osc-out");
  add(!options.network.query.empty() && options.network.query != "off", "--query");
  add(options.network.lights, "--lights");
  add(options.watch, "--watch");
  return names;
}

// renders a still image or a film offline, without network
int render_scene(const PlayOptions& options, engine::EngineOptions engine_options) {
  engine::EngineLink link;
  if (const std::string ignored = ignored_options(options); !ignored.empty())
    print_notice("rendering doesn't use the network: {} {} ignored", ignored,
                 ignored.find(',') == std::string::npos ? "is" : "are");
  const std::optional<double> duration = engine_options.duration;
  engine::Engine engine(link, std::move(engine_options));
  if (const Result<void> started = engine.start(); !started) return fail(kInputError, started.error());
  const RenderResult rendered = render(options.display, engine, link, duration, system::signal_arrived);
  return rendered.code != kSuccess ? rendered.code : finish(options, engine, rendered.canceled);
}

Result<void> open_output(const PlayOptions& options) {
  OutputSetup setup;
  setup.mode = options.fast || options.display.offline() ? OutputMode::batch : OutputMode::live;
  setup.quiet = options.log.quiet;
  if (!options.log.file.empty()) {
    LogRotation rotation;
    rotation.bytes = static_cast<std::uintmax_t>(options.log.megabytes * 1e6);
    rotation.old_files = options.log.old_files;
    Result<std::unique_ptr<LogFile>> log = LogFile::open(options.log.file, rotation);
    if (!log) return Error{log.error()};
    setup.log = std::move(*log);
    setup.log_name = printable(options.log.file);
  }
  start_output(std::move(setup));
  return {};
}

// writes the scene of the model
int save_scene(const PlayOptions& options, const std::optional<ModelScene>& model) {
  if (!model) return fail(kUsageError, "--save-scene writes the scene of a model; name a .urdf or .xml file");
  if (const Result<void> saved = save_model_scene(*model, options.save_scene.file, options.save_scene.overwrite);
      !saved)
    return fail(kInputError, saved.error());
  print_notice("written: {}", printable(options.save_scene.file));
  print_notice("{} {}", program_command(), shell_word(options.save_scene.file));
  return kSuccess;
}

Result<void> check_options(const PlayOptions& options) {
  if (Result<void> display = check_display_options(options.display, options.duration); !display) return display;
  if (options.recover && options.display.offline())
    return Error{"--recover can't be combined with --render and --screenshot; leave them out"};
  if (!options.run.out.empty() && options.display.offline())
    return Error{"--out can't be combined with --render and --screenshot; leave them out"};
  return {};
}

// finds the scene or model, then plays it, renders it or writes its scene
int play_file(const PlayOptions& options, const Outputs& outputs) {
  const Result<PlayedFile> played = options.take.replay.empty()
                                        ? find_played(options.scene, options.package_paths, options.root)
                                        : PlayedFile{options.scene, std::nullopt};
  const std::string scene = played ? played->scene : std::string();
  // absolute, because the current folder may be replaced while the show plays
  Result<engine::EngineOptions> engine_options = parse_engine(options, absolute_path(scene));
  if (!engine_options) return fail(kUsageError, engine_options.error());
  if (!played) return fail(kInputError, played.error());
  if (!options.save_scene.file.empty()) return save_scene(options, played->model);
  if (options.display.offline()) return render_scene(options, std::move(*engine_options));
  return std::make_unique<Playing>(options, std::move(*engine_options), outputs, played->model)->play();
}

}  // namespace

int play_command(const PlayOptions& options) {
  const Result<void> resources = system::check_resources({24, 13 + options.threads, std::size_t{512} * 1024});
  if (!resources) return fail(kMachineError, resources.error());
  system::block_signals();
  if (const Result<void> open = open_output(options); !open) return fail(kMachineError, open.error());
  const bool replays = !options.take.replay.empty();
  write_message(
      MessageLevel::info,
      fmt::format("limber {} ({}): {}", version(), commit(), printable(replays ? options.take.replay : options.scene)),
      "");
  if (const Result<void> fits = check_options(options); !fits) return fail(kUsageError, fits.error());
  Result<osc::OscOptions> osc = parse_osc(options.network, options.fast);
  if (!osc) return fail(kUsageError, osc.error());
  Result<QueryAddresses> query = parse_query(options.network.query);
  if (!query) return fail(kUsageError, query.error());
  if (options.fast && !*query) query->emplace();  // no port either
  Result<lighting::LightingOptions> lights = parse_lights(options);
  if (!lights) return fail(kUsageError, lights.error());
  return play_file(options, {std::move(*osc), std::move(*query), std::move(*lights), parse_midi(options)});
}

}  // namespace limber::app
