// Declares the options of `play`, with CLI11.
#include "app/play_options.h"

#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/picture_options.h"
#include "app/query_doors.h"
#include "base/team.h"
#include "base/text.h"

namespace limber {

std::string whole_number_fault(const std::string& text) {
  const bool digits = !text.empty() && text.size() <= 16 && text.find_first_not_of("0123456789") == text.npos;
  const std::optional<double> number = digits ? parse_number(text) : std::nullopt;
  return number && *number <= 9007199254740992.0
             ? std::string()
             : fmt::format("'{}' is no whole number from 0 to 9007199254740992", text);
}

namespace {

// seconds that a run may last
CLI::Validator positive_time() {
  return CLI::Validator(
      [](std::string& text) {
        const std::optional<double> seconds = parse_number(text);
        return seconds && *seconds > 0 ? std::string() : fmt::format("'{}' is no time in seconds above 0", text);
      },
      "", "seconds");
}

CLI::Validator plain_count() {
  return CLI::Validator([](std::string& text) { return whole_number_fault(text); }, "", "count");
}

// who plays it and listens to it
void add_network(CLI::App& play, PlayOptions& o) {
  play.add_option("--osc-in", o.osc_in, "where OSC comes in; default 127.0.0.1:9003")->type_name("[ADDR:]PORT|off");
  play.add_option("--osc-allow", o.osc_allow, "only these senders, such as 192.168.1.0/24; may be repeated")
      ->type_name("ADDRESS[/BITS],...")
      ->join(',');
  play.add_option("--osc-out", o.osc_out,
                  "where joint poses stream to; default 127.0.0.1:9005. Options behind it: rate=60, "
                  "bundle=off|1472|8192|65504, "
                  "streams=pos+rot+relrot+relpos, bodies=arm*, errors=on")
      ->type_name("HOST:PORT[,...]|off")
      ->allow_extra_args(false);
  play.add_option("--query", o.query,
                  "where OSCQuery and the remote panel (for a browser) are; default 127.0.0.1 and the number of "
                  "--osc-in; 0.0.0.0:9003 opens it to phones and tablets")
      ->type_name("[ADDR:]PORT|off");
  play.add_option("--query-name", o.query_names,
                  "another host name by which browsers may ask for this machine; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->check(CLI::Validator([](std::string& text) { return host_name_fault(text); }, "", "host name"));
  play.add_flag("--osc-optional", o.osc_optional, "play on when a port can't be had");
}

void add_log(CLI::App& play, LogOptions& o) {
  CLI::Option* const file =
      play.add_option("--log", o.file, "write the log to this file, too, each line with its time")->type_name("FILE");
  play.add_option("--log-size", o.megabytes, "begin a new log file at this size; default 10")
      ->type_name("MB")
      ->check(CLI::Range(0.001, 1e6))
      ->needs(file);
  play.add_option("--log-keep", o.kept, "old log files that stay: FILE.1 is the newest; default 5")
      ->type_name("N")
      ->check(CLI::Range(0, 1000))
      ->needs(file);
  play.add_flag("--quiet", o.quiet, "only warnings and errors on standard error");
}

}  // namespace

void add_play_options(CLI::App& command, PlayOptions& o) {
  CLI::App* const play = &command;
  CLI::Option* scene =
      play->add_option("scene", o.scene, "the scene's file; left out: scripts/arms.lua")->type_name("SCENE.lua");
  add_picture_options(*play, o.picture);
  CLI::Option* fast = play->add_flag("--fast", o.fast,
                                     "as fast as it can instead of in real time; no OSC, no OSCQuery unless asked for");
  play->add_option("--duration,--seconds", o.duration, "end at that simulated time")
      ->type_name("S")
      ->check(positive_time());
  play->add_option("--ticks", o.ticks, "end after so many ticks")->type_name("N")->check(plain_count());
  CLI::Option* seed = play->add_option("--seed", o.seed, "seed of everything random; wins over sim.seed of the scene")
                          ->type_name("N")
                          ->check(plain_count());
  play->add_option("--threads", o.threads,
                   "so many threads share out each step of physics and its readouts; the result is the same")
      ->type_name("N")
      ->check(CLI::Range(1, Team::kMost));
  CLI::Option* sets = play->add_option("--set", o.sets, "set a value after the scene ran; a path or the seed's address")
                          ->type_name("PATH=VALUE")
                          ->allow_extra_args(false);
  CLI::Option* preset =
      play->add_option("--preset", o.preset, "begin with this preset of the scene's, before what --set says")
          ->type_name("NAME");
  add_network(*play, o);
  play->add_option("--package-path", o.package_paths, "a folder for package:// in URDF files")
      ->type_name("DIR")
      ->allow_extra_args(false);
  play->add_flag("--watch", o.watch,
                 "with --fast too, run the scene again when one of its files is saved; else it is done anyway");
  CLI::Option* record =
      play->add_option("--record", o.record,
                       "record all that comes in, and the scene, so that it can be replayed to the bit")
          ->type_name("TAKE");
  CLI::Option* replay =
      play->add_option("--replay", o.replay, "play that take again, with the scene and files that it holds")
          ->type_name("TAKE")
          ->excludes(record)
          ->excludes(scene)
          ->excludes(seed)
          ->excludes(sets)
          ->excludes(preset);
  play->add_flag(
          "--recover", o.recover,
          "begin with the values that the scene had when its last run crashed; a start tells when there are some")
      ->excludes(replay)
      ->excludes(fast);
  play->add_flag("--with-current-scripts", o.current_scripts,
                 "with --replay, the scene as it is on the disk now; tells where the runs part")
      ->needs(replay);
  play->add_flag("--strict", o.strict, "end with 1 at any script error, refused value or health event");
  play->add_flag("--hash", o.hash, "print the state hash at the end");
  add_log(*play, o.log);
}

}  // namespace limber
