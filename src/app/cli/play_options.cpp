// Declares the options of `play` with CLI11.
#include "app/cli/play_options.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/option_checks.h"
#include "app/show/query_host.h"
#include "app/view/display_options.h"
#include "base/text.h"
#include "base/threads/thread_pool.h"

namespace limber::app {

std::string whole_number_fault(const std::string& text) {
  const bool digits = !text.empty() && text.size() <= 16 && text.find_first_not_of("0123456789") == text.npos;
  const std::optional<double> number = digits ? parse_number(text) : std::nullopt;
  return number && *number <= 9007199254740992.0
             ? std::string()
             : fmt::format("'{}' must be a whole number from 0 to 9007199254740992", text);
}

namespace {

constexpr const char* kPlayExamples =
    "  limber my.lua --fullscreen --monitor 2       a show on the second monitor\n"
    "  limber my.lua --headless --osc-in 0.0.0.0:9003  without a window, open to the network\n"
    "  limber my.lua --set /physics/sim/gravity=0,0,-1.6\n"
    "  limber robot.urdf                            look at a robot, in a window with the panel\n"
    "  limber robot.urdf --screenshot robot.png     an image of it\n"
    "  limber robot.urdf --save-scene robot.lua     a scene with the robot, to start from\n"
    "  limber my.lua --screenshot still.png --at 3  an image\n"
    "  limber my.lua --render film.mp4 --duration 10  a film\n"
    "  limber my.lua --record evening.take          record all input\n"
    "  limber --replay evening.take --fast --hash   the same motion again, as fast as possible";

// duration of a run in seconds
CLI::Validator positive_time() {
  return CLI::Validator(
      [](std::string& text) {
        const std::optional<double> seconds = parse_number(text);
        return seconds && *seconds > 0 ? std::string()
                                       : fmt::format("'{}' must be a time in seconds greater than 0", text);
      },
      "", "seconds");
}

CLI::Validator plain_count() {
  return CLI::Validator([](std::string& text) { return whole_number_fault(text); }, "", "count");
}

// options of OSC and OSCQuery
void add_network(CLI::App& play, NetworkOptions& o) {
  play.add_option("--osc-in", o.osc_in, "Address of OSC input; default 127.0.0.1:9003. IPv6: [::]:9003.")
      ->type_name("[ADDR:]PORT|off");
  play.add_option("--osc-tcp", o.osc_tcp, "Address of OSC input by TCP, with SLIP or with lengths; default: none.")
      ->type_name("[ADDR:]PORT|off");
  play.add_option("--osc-allow", o.osc_allow, "Accept only these senders, such as 192.168.1.0/24; may be repeated.")
      ->type_name("ADDRESS[/BITS],...")
      ->join(',');
  play.add_option("--osc-out", o.osc_out,
                  "Receiver of the streams of joint poses; default 127.0.0.1:9005. Settings after it: rate=60, "
                  "bundle=off|1472|8192|65504, "
                  "streams=pos+rot+relrot+relpos, bodies=arm*, errors=on.")
      ->type_name("HOST:PORT[,...]|off")
      ->allow_extra_args(false);
  play.add_option(
          "--query", o.query,
          "Address of OSCQuery and the remote panel (for a browser); default: 127.0.0.1 with the port number of "
          "--osc-in; 0.0.0.0:9003 opens it to phones and tablets.")
      ->type_name("[ADDR:]PORT|off");
  play.add_option("--query-name", o.query_names,
                  "Additional host name of this machine that browsers may use; may be repeated.")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->check(CLI::Validator([](std::string& text) { return host_name_fault(text); }, "", "host name"));
  play.add_flag("--lights", o.lights,
                "Arm the output to lights from the start. Replays and --fast send to lights only with this option.");
  play.add_option("--lights-out", o.lights_out,
                  "Where the values of lighting fixtures are sent while the output is armed; default sacn; may be "
                  "repeated. enttec:/dev/ttyUSB0 is an Enttec DMX USB Pro. Settings after it: rate=44, priority=100, "
                  "sync=1, interface=10.0.0.2, name=Limber, universe=1 (of enttec), exit=blackout|hold, "
                  "panic=hold|blackout.")
      ->type_name("artnet|sacn[:ADDR[:PORT]]|enttec:DEVICE[,...]|off")
      ->allow_extra_args(false);
  play.add_option("--zeroconf", o.zeroconf,
                  "Announce the ports of OSC and OSCQuery by zeroconf under this name, so that tablets find them.")
      ->type_name("NAME")
      ->check(CLI::Validator([](std::string& text) { return name_error(text).value_or(""); }, "", "name"));
  play.add_flag("--link", o.link,
                "Join an Ableton Link session: sim.clock follows its beat, and other programs follow /clock/tempo.");
  play.add_flag("--osc-optional", o.osc_optional, "Continue if a port is not available.");
  play.add_flag(
      "--osc-share", o.osc_share,
      "Let other programs open the UDP ports of --osc-in, too. All of them receive broadcasts and multicasts; "
      "anything else reaches one of them only.");
}

// a scene behind --midi would be taken for its value
std::string port_name_fault(const std::string& text) {
  std::error_code error;
  if (!std::filesystem::exists(text, error)) return {};
  return fmt::format("'{}' is a file, not a MIDI device; write it before --midi, or write --midi all", printable(text));
}

void add_midi(CLI::App& play, MidiChoices& o) {
  play.add_option_function<std::string>(
          "--midi", [&o](const std::string& text) { o.use = text.empty() ? "all" : text; },
          "MIDI devices to open: those with this text in their name; without a text, all. By default they are "
          "opened when the scene has a map, SCENE.midi.json, or a control is to be learned.")
      ->type_name("all|NAME|off")
      ->expected(0, 1)
      ->check(CLI::Validator([](std::string& text) { return port_name_fault(text); }, "", "name"));
  play.add_option("--midi-sync", o.clock_from,
                  "Follow the MIDI clock of the device with this text in its name: tempo, beat, start and stop.")
      ->type_name("NAME");
  play.add_option("--midi-clock", o.clock_to,
                  "Send a MIDI clock that follows /clock to the device with this text in its name.")
      ->type_name("NAME");
}

void add_log(CLI::App& play, LogOptions& o) {
  CLI::Option* const file =
      play.add_option("--log", o.file, "Also write the log to this file, with the time of each line.")
          ->type_name("FILE");
  play.add_option("--log-size", o.megabytes, "Start a new log file at this size; default 10.")
      ->type_name("MB")
      ->check(between(0.001, 1e6))
      ->needs(file);
  play.add_option("--log-keep", o.old_files, "Number of old log files to keep, FILE.1 is the latest; default 5.")
      ->type_name("N")
      ->check(between(0, 1000))
      ->needs(file);
  play.add_flag("--quiet", o.quiet, "Print only warnings and errors to standard error.");
}

// Adds the options of the length of a run and of its threads.
void add_run_options(CLI::App& play, PlayOptions& o) {
  play.add_option("--duration,--seconds", o.duration, "End at this simulated time.")
      ->type_name("S")
      ->check(positive_time());
  play.add_option("--ticks", o.ticks, "End after this number of ticks.")->type_name("N")->check(plain_count());
  play.add_option("--threads", o.threads,
                  "Number of threads for physics and readouts, default 1; the result is identical for any number.")
      ->type_name("N")
      ->check(between(1, ThreadPool::kMaxThreads));
}

// Adds the options of models. Returns --save-scene.
CLI::Option* add_model_options(CLI::App& play, PlayOptions& o) {
  play.add_option("--package-path", o.package_paths, "Folder for package:// paths in URDF files; may be repeated.")
      ->type_name("DIR")
      ->allow_extra_args(false);
  play.add_option("--root", o.root,
                  "With an MJCF model: the top-level body to play, or world; default: the first that moves.")
      ->type_name("BODY");
  CLI::Option* const save_scene =
      play.add_option("--save-scene", o.save_scene.file,
                      "Write the scene of the model to this file, with comments to start from, and exit.")
          ->type_name("FILE.lua");
  play.add_flag("--overwrite", o.save_scene.overwrite, "With --save-scene: replace an existing file.")
      ->needs(save_scene);
  return save_scene;
}

// Options of the values with which a run starts; a replay has its own.
struct StartOptions {
  CLI::Option *seed = nullptr, *params = nullptr, *sets = nullptr, *preset = nullptr, *presets = nullptr,
              *cues = nullptr;
};
StartOptions add_start_options(CLI::App& play, PlayOptions& o) {
  StartOptions start;
  start.seed = play.add_option("--seed", o.seed, "Seed of the random numbers; overrides sim.seed of the scene.")
                   ->type_name("N")
                   ->check(plain_count());
  start.params = play.add_option("--param", o.run.params,
                                 "Set a parameter of the scene (params { … }), applied before --set; may be repeated.")
                     ->type_name("NAME=VALUE")
                     ->allow_extra_args(false);
  start.sets =
      play.add_option(
              "--set", o.run.sets,
              "Set a value after the scene has run; a path or an OSC address of ofxDabPhysics; may be repeated.")
          ->type_name("PATH=VALUE")
          ->allow_extra_args(false);
  play.add_option("--out", o.run.out,
                  "Write the columns of sim:record to this file, .csv or .jsonl, or to a folder, together with the "
                  "results, the seed, the parameters and the state hash.")
      ->type_name("FILE|DIR");
  start.preset = play.add_option("--preset", o.preset, "Start with this preset of the scene, applied before --set.")
                     ->type_name("NAME");
  start.presets =
      play.add_option("--presets", o.run.presets, "File of the presets; default: SCENE.presets.json beside the scene.")
          ->type_name("FILE.presets.json");
  start.cues = play.add_option("--cues", o.run.cues,
                               "File of the cues; default: SCENE.cues.json beside the scene, if it exists.")
                   ->type_name("FILE.cues.json");
  return start;
}

}  // namespace

void add_play_options(CLI::App& command, PlayOptions& o) {
  CLI::App* const play = &command;
  play->footer(kPlayExamples);
  CLI::Option* scene =
      play->add_option(
              "scene", o.scene,
              "A scene, a URDF or MJCF model, or a folder with one model; default scripts/arms.lua. A model is "
              "put on a floor; its motors hold their positions.")
          ->type_name("SCENE.lua|MODEL.urdf|MODEL.xml|DIR");
  add_display_options(*play, o.display);
  CLI::Option* fast =
      play->add_flag("--fast", o.fast, "Run at full speed instead of real time; no OSC and OSCQuery unless requested.");
  CLI::Option* lockstep =
      play->add_flag("--lockstep", o.lockstep,
                     "Advance only by /transport/step, as fast as it is sent; each is answered by /transport/stepped.")
          ->excludes(fast);
  add_run_options(*play, o);
  const StartOptions start = add_start_options(*play, o);
  add_network(*play, o.network);
  add_midi(*play, o.network.midi);
  CLI::Option* const save_scene = add_model_options(*play, o);
  play->add_flag("--watch", o.watch,
                 "With --fast: reload the scene when one of its files is saved, as is done in real time.");
  CLI::Option* record =
      play->add_option("--record", o.take.record,
                       "Record the scene and all input to this file, so that it can be replayed bit for bit.")
          ->type_name("TAKE");
  CLI::Option* replay =
      play->add_option("--replay", o.take.replay, "Replay this take with the scene and files recorded in it.")
          ->type_name("TAKE")
          ->excludes(record)
          ->excludes(lockstep)
          ->excludes(scene)
          ->excludes(save_scene)
          ->excludes(start.seed)
          ->excludes(start.params)
          ->excludes(start.sets)
          ->excludes(start.preset)
          ->excludes(start.presets)
          ->excludes(start.cues);
  play->add_flag("--recover", o.recover,
                 "Restore the values that the scene had when its last run crashed; the program reports at start if "
                 "there are any.")
      ->excludes(replay)
      ->excludes(lockstep)
      ->excludes(fast);
  play->add_flag("--with-current-scripts", o.take.current_scripts,
                 "With --replay: use the current scene files; reports where the runs diverge.")
      ->needs(replay);
  play->add_flag("--strict", o.strict, "Exit with code 1 after any script error, rejected value or health event.");
  play->add_flag("--hash", o.hash, "Print the state hash at the end.");
  add_log(*play, o.log);
}

}  // namespace limber::app
