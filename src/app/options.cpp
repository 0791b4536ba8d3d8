// The command line, with CLI11. Without a command it plays.
#include "app/options.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/annotate.h"
#include "app/bench.h"
#include "app/command_info.h"
#include "app/completion.h"
#include "app/console.h"
#include "app/describe.h"
#include "app/describe_page.h"
#include "app/doctor.h"
#include "app/exit_code.h"
#include "app/export.h"
#include "app/inspect.h"
#include "app/man_page.h"
#include "app/monitor.h"
#include "app/new.h"
#include "app/paths.h"
#include "app/picture_options.h"
#include "app/play_options.h"
#include "app/preset.h"
#include "app/send.h"
#include "app/service.h"
#include "app/take.h"
#include "base/build_info.h"
#include "base/output.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 16> kCommands = {
    "play",  "console", "monitor", "send",   "new",    "inspect", "describe",   "annotate",
    "bench", "preset",  "take",    "export", "doctor", "service", "completion", "man"};

constexpr const char* kAbout =
    "Limber: a live simulator of actuated, articulated bodies, scripted in Lua, played over OSC.\n\n"
    "  limber                                       plays scripts/arms.lua\n"
    "  limber my.lua --osc-in 0.0.0.0:9003          another scene, answering the whole network\n"
    "  oscsend 127.0.0.1 9003 /physics/sim/gravity f -1.6\n"
    "  limber my.lua --fast --duration 10 --hash    ten simulated seconds, as fast as it can\n"
    "  limber console -e sim.time                   asks the one that plays, in Lua\n"
    "  limber monitor                               what it takes in and sends out\n"
    "  limber export evening.take --format gltf     a recorded show's motion for other programs\n"
    "  limber new show my_show                      a folder to begin with\n";

constexpr const char* kExitCodes =
    "Exit codes: 0 fine; 1 the input is at fault; 2 wrong usage; 3 the machine is at fault (a port taken, say).\n"
    "`limber COMMAND --help` tells more of each.";

CLI::Validator whole_number() {
  return CLI::Validator([](std::string& text) { return whole_number_fault(text); }, "", "count");
}

// argv as CLI11 is to see it: without a command in front, it is `play`
std::vector<std::string> with_command(int argc, char** argv) {
  std::vector<std::string> args(argv + std::min(argc, 1), argv + argc);
  const bool names_one = !args.empty() && (args[0] == "-h" || args[0] == "--help" || args[0] == "--version" ||
                                           std::find(kCommands.begin(), kCommands.end(), args[0]) != kCommands.end());
  if (!names_one) args.insert(args.begin(), "play");
  return args;
}

// a word that is no scene but nearly a command was meant as one
std::optional<std::string> mistyped_command(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string_view word = argv[1];
  std::vector<std::string> looked;
  if (word.ends_with(".lua") || word.find('/') != std::string_view::npos || !find_scene(word, looked).empty())
    return {};
  const std::string_view near = nearest_name(word, kCommands);
  if (near.empty() || near == word) return {};
  return fmt::format("there is no command '{}'; did you mean '{}'?", printable(word), near);
}

struct CommandLine {
  PlayOptions play;
  BenchOptions bench;
  std::string robot;        // inspect
  std::string scene;        // describe
  std::string definitions;  // annotate
  ConsoleCommand console;
  MonitorCommand monitor;
  SendCommand send;
  NewCommand fresh;
  PresetCommand preset;
  TakeCommand take;
  ExportCommand exported;
  DoctorCommand doctor;
  ServiceCommand service;
  std::string shell;  // completion
  bool json = false;
  bool markdown = false;
  std::vector<std::string> package_paths;
};

void add_inspect(CLI::App& app, CommandLine& line) {
  CLI::App* inspect =
      app.add_subcommand("inspect", "what the importer makes of a URDF file, and every problem with line and cure");
  inspect->add_option("file", line.robot, "the robot")->type_name("FILE.urdf")->required();
  inspect->add_flag("--json", line.json, "for machines");
  inspect->add_option("--package-path", line.package_paths, "a folder for package://")
      ->type_name("DIR")
      ->allow_extra_args(false);
}

void add_describe(CLI::App& app, CommandLine& line) {
  CLI::App* describe =
      app.add_subcommand("describe", "every address: path, the seed's message, type, unit, range, default, meaning");
  describe->add_option("scene", line.scene, "with a scene: every address that it has")->type_name("SCENE.lua");
  CLI::Option* json = describe->add_flag("--json", line.json, "for machines");
  describe->add_flag("--markdown", line.markdown, "as docs/osc.md has it")->excludes(json);
}

void add_bench(CLI::App& app, CommandLine& line) {
  CLI::App* bench = app.add_subcommand("bench", "how fast it is here");
  bench->add_option("scene", line.bench.scenes, "which ones; left out: all")
      ->type_name("SCENE:{" + bench_scene_list() + "}");
  bench->add_flag("--compare-raw", line.bench.compare_raw, "beside a bare Bullet loop, interleaved, with the ratio");
  bench->add_flag("--json", line.bench.json, "for machines");
  add_gl_option(*bench, line.bench.gl);
  bench->add_option("--ticks", line.bench.ticks, "ticks a round; left out: chosen for each scene")
      ->type_name("N")
      ->check(whole_number());
}

void add_console(CLI::App& app, ConsoleCommand& command) {
  CLI::App* console = app.add_subcommand("console", "a Lua console of the scene that plays in another terminal");
  console->footer(
      "At a terminal: Tab completes, the arrows find what was typed before, Ctrl+D leaves.\n"
      "  limber console -e 'sim.time'                 one value\n"
      "  echo 'sim.gravity = vec3()' | limber console  lines of a pipe; exit code 1 when any had an error");
  console->add_option("pid", command.pid, "which program, when several play")->type_name("PID");
  console->add_option("-e,--evaluate", command.expression, "evaluate this and end")->type_name("LUA");
}

void add_monitor(CLI::App& app, MonitorCommand& command) {
  CLI::App* monitor = app.add_subcommand("monitor", "prints what a running program takes in (<) and sends out (>)");
  monitor->footer(
      "  limber monitor --in                          what comes in, with senders and times\n"
      "  limber monitor '/physics/part/*'             of these addresses\n"
      "  limber monitor --changes                     who sets what, from what to what\n"
      "  limber monitor --changes '/physics/body/arm1/motor/*/target'");
  monitor->add_option("pattern", command.pattern, "of addresses, or with --changes of paths; left out: all")
      ->type_name("PATTERN");
  monitor->add_flag("--changes", command.changes,
                    "values that change: what hands set, or whatever the pattern reaches");
  CLI::Option* in = monitor->add_flag("--in", command.only_in, "only what comes in");
  monitor->add_flag("--out", command.only_out, "only what goes out")->excludes(in);
  monitor->add_option("--pid", command.pid, "which program, when several play")->type_name("PID");
  monitor->add_option("--count", command.count, "end after so many lines")->type_name("N")->check(whole_number());
}

void add_doctor(CLI::App& app, DoctorCommand& command) {
  CLI::App* doctor = app.add_subcommand("doctor", "what works on this machine: ports, buffers, data");
  add_gl_option(*doctor, command.gl);
  doctor->add_option("--osc-in", command.osc_in, "where OSC would come in; default 127.0.0.1:9003")
      ->type_name("[ADDR:]PORT|off");
  doctor
      ->add_option("--query", command.query, "where OSCQuery and the remote panel would be; default: as --osc-in, TCP")
      ->type_name("[ADDR:]PORT|off");
}

void add_send(CLI::App& app, SendCommand& command) {
  CLI::App* send = app.add_subcommand("send", "sends one OSC message and prints what is answered");
  send->footer(
      "Words are numbers, true and false, else text; \"'1'\" is the text 1.\n"
      "  limber send /physics/part/mass arm1 0.3\n"
      "  limber send '/physics/body/arm*/motor/*/target' 0.5\n"
      "  limber send /get /physics/sim/gravity\n"
      "  limber send --tags 'i[ff]T' /scene/shape -3 0.5 1\n"
      "Exit codes: 1 it was refused; 3 nobody answers.");
  send->add_option("address", command.address, "where to")->type_name("ADDRESS")->required();
  send->add_option("args", command.words, "what")->type_name("ARGS");
  send->add_option("--tags", command.tags,
                   "OSC type tags of the arguments: i h f d s S c r m t b take one each (r m t b in hexadecimal "
                   "digits), T F N I and [ ] none; default: f for numbers, i for booleans, s for text")
      ->type_name("TAGS");
  send->add_option("--to", command.to, "another program or machine; default 127.0.0.1:9003")->type_name("[HOST:]PORT");
  send->add_option("--wait", command.wait, "how long to wait for answers; 0: not at all")
      ->type_name("S")
      ->check(CLI::Range(0.0, 60.0));
}

void add_new(CLI::App& app, NewCommand& command) {
  CLI::App* fresh = app.add_subcommand("new", "a commented start of a show, a scene or a behavior");
  fresh->require_subcommand(1);
  const auto add = [&](const char* word, NewCommand::What what, const char* option, const char* about) {
    CLI::App* kind = fresh->add_subcommand(word, about);
    kind->add_option(option, command.name)->required()->type_name("");
    kind->callback([&command, what] { command.what = what; });
  };
  add("show", NewCommand::What::show, "DIR", "a folder of its own: a scene, a robot, settings for editors");
  add("scene", NewCommand::What::scene, "NAME", "scripts/NAME.lua in the show around this folder");
  add("behavior", NewCommand::What::behavior, "NAME", "behaviors_lua/NAME.lua in the show around this folder");
}

void add_preset(CLI::App& app, PresetCommand& command) {
  CLI::App* preset = app.add_subcommand("preset", "presets from elsewhere");
  preset->require_subcommand(1);
  CLI::App* import = preset->add_subcommand("import", "those of a Max pattrstorage (writejson) into a scene's");
  import->add_option("file", command.file, "the pattrstorage")->type_name("FILE.json")->required();
  import->add_option("scene", command.scene, "the scene that they are for; left out: scripts/arms.lua")
      ->type_name("SCENE.lua");
}

void add_take(CLI::App& app, TakeCommand& command) {
  CLI::App* take = app.add_subcommand("take", "takes that were recorded");
  take->require_subcommand(1);
  CLI::App* info = take->add_subcommand("info", "what a take holds, and whether it is whole");
  info->add_option("file", command.file, "the take")->type_name("TAKE")->required();
  take->footer(
      "  limber my.lua --record evening.take\n"
      "  limber --replay evening.take --fast\n"
      "  limber export evening.take --format gltf");
}

// times and rates that are numbers of a range
CLI::Validator number_between(double least, double most) {
  return CLI::Validator(
      [least, most](std::string& text) {
        const std::optional<double> number = parse_number(text);
        return number && *number >= least && *number <= most
                   ? std::string()
                   : fmt::format("'{}' is no number from {} to {}", text, number_text(least), number_text(most));
      },
      "", "number");
}

void add_export(CLI::App& app, ExportCommand& command) {
  CLI::App* made = app.add_subcommand("export", "a take as motion for other programs: CSV, BVH, glTF");
  made->footer(
      "The take is replayed as fast as it goes, and looked at so many times a simulated second, between ticks too.\n"
      "  csv   a table: a row a frame; where each part is, how it is turned, what each joint stands at\n"
      "  bvh   a skeleton a body; Y up, metres; with -o NAME.bvh one body in one file, else a folder\n"
      "  gltf  bodies with their meshes and one animation; Y up, metres; .glb, or .gltf beside a .bin\n"
      "  limber export evening.take --format gltf                    evening.glb\n"
      "  limber export evening.take -o arm1.bvh --body arm1 --rate 30\n"
      "  limber export evening.take -o arms.csv --body 'arm*' --from 60 --to 90\n"
      "What each format holds: docs/export.md.");
  made->add_option("take", command.take, "the take")->type_name("TAKE")->required();
  made->add_option("--format", command.format, "left out: what -o ends with")
      ->type_name("csv|bvh|gltf")
      ->check(CLI::IsMember({"csv", "bvh", "gltf"}));
  made->add_option("-o,--output", command.output, "where it goes; left out: beside the take, under its name")
      ->type_name("FILE");
  made->add_option("--rate", command.rate, "frames a simulated second; default 60")
      ->type_name("N")
      ->check(number_between(0.01, 10000));
  made->add_option("--body", command.bodies, "only this body, or those of a pattern; may be given several times")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  made->add_option("--from", command.from, "begin there, in simulated seconds of the take")
      ->type_name("S")
      ->check(number_between(0, 1e9));
  made->add_option("--to", command.to, "end there")->type_name("S")->check(number_between(0, 1e9));
  made->add_flag("--overwrite", command.overwrite, "write over a file that is there");
}

void add_service(CLI::App& app, ServiceCommand& command) {
  CLI::App* service = app.add_subcommand("service", "shows that systemd starts, watches and restarts");
  service->require_subcommand(1);
  service->footer(
      "  limber service install my.lua --fullscreen   writes the unit limber-my of this user, and prints it\n"
      "  systemctl --user enable --now limber-my      starts it, now and with each session\n"
      "  limber service remove my                     deletes the unit\n"
      "Behind install come the scene and options of `limber play`. What the unit does: docs/installations.md.");
  CLI::App* install =
      service->add_subcommand("install", "writes a unit that plays a scene with options of play, from this folder");
  install->add_option("--name", command.name, "of the service, behind limber-; left out: that of the scene")
      ->type_name("NAME");
  install->add_flag("--print", command.print, "prints the unit, writes nothing");
  install->callback([&command] { command.what = ServiceCommand::What::install; });
  CLI::App* remove = service->add_subcommand("remove", "deletes a unit that install has written");
  remove->add_option("name", command.name, "which; left out: the only one")->type_name("NAME");
  remove->callback([&command] { command.what = ServiceCommand::What::remove; });
}

// moves what is behind `service install` and is not its own to `words`
void split_service_words(std::vector<std::string>& args, std::vector<std::string>& words) {
  if (args.size() < 2 || args[0] != "service" || args[1] != "install") return;
  std::vector<std::string> own(args.begin(), args.begin() + 2);
  for (std::size_t i = 2; i < args.size(); i++) {
    const std::string& word = args[i];
    const bool named = word == "--name";
    const bool help = word == "-h" || word == "--help";
    (named || help || word == "--print" || word.starts_with("--name=") ? own : words).push_back(word);
    if (named && i + 1 < args.size()) own.push_back(args[++i]);
  }
  args = std::move(own);
}

// what was wrong, as CLI11 tells it; for an option that there is not, the near one
std::string usage_text(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  const std::string help = fmt::format("`limber {} --help` tells what there is", command->get_name());
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("-")) return fmt::format("'{}' is one argument too many; {}", printable(word), help);
    const std::string option = word.substr(0, word.find('='));
    std::vector<std::string> names;
    for (const CLI::Option* known : command->get_options()) names.push_back(known->get_name());
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string_view near = nearest_name(option, views);
    return fmt::format("there is no option '{}'; {}{}", printable(option),
                       near.empty() ? "" : fmt::format("did you mean '{}'? ", near), help);
  }
  return fmt::format("{}; {}", printable(error.what()), help);
}

void add_shell_files(CLI::App& app, CommandLine& line) {
  CLI::App* completion = app.add_subcommand("completion", "prints the script that completes limber in a shell");
  completion->footer(
      "  source <(limber completion bash)             in ~/.bashrc\n"
      "  limber completion zsh >~/.zfunc/_limber      a folder of fpath\n"
      "Debian's package installs both.");
  completion->add_option("shell", line.shell, "the shell")
      ->type_name("SHELL")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  app.add_subcommand("man", "prints the manual page")->footer("  limber man | man -l -                        read it");
}

void add_commands(CLI::App& app, CommandLine& line) {
  app.footer(kExitCodes);
  app.set_version_flag("--version", fmt::format("limber {} ({})", version(), commit()));
  app.require_subcommand(1);
  add_play_options(*app.add_subcommand("play", "play a scene (the default command)"), line.play);
  add_inspect(app, line);
  add_describe(app, line);
  add_bench(app, line);
  add_console(app, line.console);
  add_monitor(app, line.monitor);
  add_send(app, line.send);
  add_new(app, line.fresh);
  add_preset(app, line.preset);
  add_take(app, line.take);
  add_export(app, line.exported);
  CLI::App* annotate = app.add_subcommand("annotate", "definitions of all that scripts see, for editors (LuaCATS)");
  annotate->add_option("file", line.definitions, "where they go; left out: stdout")->type_name("FILE");
  add_doctor(app, line.doctor);
  add_service(app, line.service);
  add_shell_files(app, line);
}

int print_shell_file(const CLI::App& app, const std::string& command, const std::string& shell) {
  const CommandInfo program = command_info(app);
  print_result("{}", command == "man" ? man_page(program)
                     : shell == "zsh" ? zsh_completion(program)
                                      : bash_completion(program));
  return 0;
}

int run_service(ServiceCommand& command) {
  CLI::App play("", "play");
  add_play_options(play, command.play);
  std::vector<std::string> words = command.words;
  std::reverse(words.begin(), words.end());
  try {
    play.parse(words);
  } catch (const CLI::ParseError& error) {
    print_notice("{}", usage_text(play, error));
    return kUsage;
  }
  return service_command(command);
}

int run_command(int argc, char** argv) {
  CLI::App app{kAbout, "limber"};
  CommandLine line;
  add_commands(app, line);
  if (const auto mistyped = mistyped_command(argc, argv)) {
    print_notice("{}", *mistyped);
    return kUsage;
  }
  std::vector<std::string> args = with_command(argc, argv);
  split_service_words(args, line.service.words);
  std::reverse(args.begin(), args.end());  // CLI11 takes them from the back
  try {
    app.parse(args);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help, version
      std::ostringstream text;
      (void)app.exit(error, text, text);
      write_result(text.str());
      return kFine;
    }
    print_notice("{}", usage_text(app, error));
    return kUsage;
  }
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "inspect") return inspect_command(line.robot, line.json, line.package_paths);
  if (command == "describe" && line.markdown) {
    print_result("{}", describe_page());
    return 0;
  }
  if (command == "describe") return describe_command(line.scene, line.json);
  if (command == "console") return console_command(line.console);
  if (command == "monitor") return monitor_command(line.monitor);
  if (command == "send") return send_command(line.send);
  if (command == "new") return new_command(line.fresh);
  if (command == "preset") return preset_command(line.preset);
  if (command == "take") return take_command(line.take);
  if (command == "export") return export_command(line.exported);
  if (command == "annotate") return annotate_command(line.definitions);
  if (command == "bench") return bench_command(line.bench);
  if (command == "doctor") return doctor_command(line.doctor);
  if (command == "service") return run_service(line.service);
  if (command == "completion" || command == "man") return print_shell_file(app, command, line.shell);
  return play_command(line.play);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    return finish_command(run_command(argc, argv));
  } catch (const std::bad_alloc&) {
    print_notice("there is not enough memory; end other programs, or raise ulimit -v");
  } catch (const std::system_error& error) {  // of a thread that could not be started
    print_notice("{}; end other programs, or raise ulimit -u and ulimit -v", error.code().message());
  }
  return kMachine;
}

}  // namespace limber
