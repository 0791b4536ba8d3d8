// Declares the command line with CLI11 and runs the commands. Without a command it plays.
#include "app/cli/options.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/breed/variation_worker.h"
#include "app/cli/command_info.h"
#include "app/cli/experiment_options.h"
#include "app/cli/export_options.h"
#include "app/cli/inspect_options.h"
#include "app/cli/play_options.h"
#include "app/commands/commands.h"
#include "app/commands/describe.h"
#include "app/exit_code.h"
#include "app/experiments/evolve_play.h"
#include "app/experiments/worker.h"
#include "app/option_checks.h"
#include "app/paths.h"
#include "app/service/service.h"
#include "app/view/display_options.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::array<std::string_view, 20> kCommands = {
    "play",     "sweep", "evolve", "breed", "console", "monitor", "send",    "new",  "inspect",    "describe",
    "annotate", "bench", "preset", "take",  "export",  "doctor",  "service", "docs", "completion", "man"};

constexpr const char* kAbout =
    "Limber: a live simulator of actuated, articulated bodies, scripted in Lua and controlled over OSC.\n\n"
    "  limber                                       play scripts/arms.lua\n"
    "  limber my.lua --osc-in 0.0.0.0:9003          another scene, OSC open to the whole network\n"
    "  limber robot.urdf                            look at a robot: URDF, MJCF (.xml), or a folder with one\n"
    "  oscsend 127.0.0.1 9003 /physics/sim/gravity f -1.6\n"
    "  limber my.lua --fast --duration 10 --hash    ten simulated seconds at full speed, print the hash\n"
    "  limber console -e sim.time                   evaluate Lua in the running program\n"
    "  limber monitor                               print the messages it receives and sends\n"
    "  limber export evening.take --format gltf     export recorded motion for other programs\n"
    "  limber sweep my.lua --param rate=0.1:1:0.1   a table of results for ten values\n"
    "  limber breed my.lua                          nine variations side by side: select by eye\n"
    "  limber new show my_show                      create a folder with an example\n";

constexpr const char* kExitCodes =
    "Exit codes: 0 success; 1 invalid input (such as a scene); 2 wrong usage;\n"
    "3 a problem of the machine (such as a port in use).\n"
    "See `limber COMMAND --help` for each command.";

CLI::Validator whole_number() {
  return CLI::Validator([](std::string& text) { return whole_number_fault(text); }, "", "count");
}

// arguments for CLI11: `play` is inserted if there is no command
std::vector<std::string> with_command(int argc, char** argv) {
  std::vector<std::string> args(argv + std::min(argc, 1), argv + argc);
  const bool names_one = !args.empty() && (args[0] == "-h" || args[0] == "--help" || args[0] == "--version" ||
                                           std::find(kCommands.begin(), kCommands.end(), args[0]) != kCommands.end());
  if (!names_one) args.insert(args.begin(), "play");
  return args;
}

// suggests a command for a word that is no scene, model or folder, but similar to a command
std::optional<std::string> mistyped_command(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string_view word = argv[1];
  std::vector<std::string> searched;
  if (word.ends_with(".lua") || word.find('/') != std::string_view::npos ||
      !find_file_or_folder(word, searched).empty())
    return {};
  const std::string_view near = nearest_name(word, kCommands);
  if (near.empty() || near == word) return {};
  return fmt::format("unknown command '{}'; did you mean '{}'?", printable(word), near);
}

struct CommandLine {
  PlayOptions play;
  BenchOptions bench;
  InspectCommand inspect;
  std::string scene;        // describe
  std::string definitions;  // annotate
  std::string reference;    // annotate: folder of the Lua reference
  ConsoleCommand console;
  MonitorCommand monitor;
  SendCommand send;
  NewCommand create;
  PresetCommand preset;
  std::string take;
  ExportCommand exported;
  DoctorCommand doctor;
  DocsCommand docs;
  ServiceCommand service;
  struct {
    SweepCommand sweep;
    EvolveCommand evolve;
    BreedCommand breed;
    std::vector<std::string> play_words;  // evolve --play: options of play
  } experiments;
  std::string shell;  // completion
  bool json = false;
  bool markdown = false;
};

void add_describe(CLI::App& app, CommandLine& line) {
  CLI::App* describe =
      app.add_subcommand("describe", "List all OSC addresses with type, unit, range, default and meaning.");
  describe->footer(
      "  limber describe scripts/arms.lua             the addresses of this scene\n"
      "  limber describe --json                       all classes, for programs");
  describe->add_option("scene", line.scene, "List the addresses of this scene; default: those of all classes.")
      ->type_name("SCENE.lua");
  CLI::Option* json = describe->add_flag("--json", line.json, "Print JSON.");
  describe->add_flag("--markdown", line.markdown, "Print Markdown, as in docs/reference/osc_addresses.md.")
      ->excludes(json);
}

void add_bench(CLI::App& app, CommandLine& line) {
  CLI::App* bench = app.add_subcommand("bench", "Measure how many arms this machine plays in real time.");
  bench->footer("  limber bench --ticks 300                     a longer measurement");
  bench->add_flag("--json", line.bench.json, "Print JSON.");
  bench->add_option("--ticks", line.bench.ticks, "Number of timed ticks for each number of arms; default: 60.")
      ->type_name("N")
      ->check(whole_number());
}

void add_console(CLI::App& app, ConsoleCommand& command) {
  CLI::App* console =
      app.add_subcommand("console", "Open a Lua console of a scene that is running in another terminal.");
  console->footer(
      "In a terminal: Tab completes, the arrow keys recall earlier lines, Ctrl+D exits.\n"
      "  limber console -e 'sim.time'                 print one value\n"
      "  echo 'sim.gravity = vec3()' | limber console  evaluate lines from a pipe; exit code 1 on any error");
  console->add_option("pid", command.pid, "Process id, if several programs are running.")->type_name("PID");
  console->add_option("-e,--evaluate", command.expression, "Evaluate this expression and exit.")->type_name("LUA");
}

void add_monitor(CLI::App& app, MonitorCommand& command) {
  CLI::App* monitor =
      app.add_subcommand("monitor", "Print the messages that a running program receives (<) and sends (>).");
  monitor->footer(
      "  limber monitor --in                          received messages, with senders and times\n"
      "  limber monitor '/physics/part/*'             only these addresses\n"
      "  limber monitor --changes                     changed values: sender, property, old and new value\n"
      "  limber monitor --changes '/physics/body/arm1/motor/*/target'");
  monitor->add_option("pattern", command.pattern, "Pattern of addresses, or with --changes of paths; default: all.")
      ->type_name("PATTERN");
  monitor->add_flag("--changes", command.changes,
                    "Print changes of values: those set by clients, or all that match the pattern.");
  CLI::Option* in = monitor->add_flag("--in", command.only_in, "Only received messages.");
  monitor->add_flag("--out", command.only_out, "Only sent messages.")->excludes(in);
  monitor->add_option("--pid", command.pid, "Process id, if several programs are running.")->type_name("PID");
  monitor->add_option("--count", command.count, "Exit after this number of lines.")
      ->type_name("N")
      ->check(whole_number());
}

void add_doctor(CLI::App& app, DoctorCommand& command) {
  CLI::App* doctor = app.add_subcommand("doctor", "Check this machine: ports, buffers, data, OpenGL, display.");
  doctor->footer("  limber doctor --osc-in 0.0.0.0:9003          with the address of a show");
  add_gl_option(*doctor, command.gl);
  doctor->add_option("--osc-in", command.osc_in, "Address of OSC input to check; default 127.0.0.1:9003.")
      ->type_name("[ADDR:]PORT|off");
  doctor
      ->add_option("--query", command.query,
                   "Address of OSCQuery and the remote panel to check (TCP); default: as --osc-in.")
      ->type_name("[ADDR:]PORT|off");
}

void add_send(CLI::App& app, SendCommand& command) {
  CLI::App* send = app.add_subcommand("send", "Send one OSC message and print the replies.");
  send->footer(
      "Arguments are numbers, true and false, else text; \"'1'\" is the text 1.\n"
      "  limber send /physics/part/mass arm1 0.3\n"
      "  limber send '/physics/body/arm*/motor/*/target' 0.5\n"
      "  limber send /get /physics/sim/gravity\n"
      "  limber send --tags 'i[ff]T' /scene/shape -3 0.5 1\n"
      "Exit codes: 1 the message was rejected; 3 no reply.");
  send->add_option("address", command.address, "OSC address.")->type_name("ADDRESS")->required();
  send->add_option("args", command.words, "Arguments.")->type_name("ARGS");
  send->add_option("--tags", command.tags,
                   "OSC type tags of the arguments: i h f d s S c r m t b take one each (r m t b in hexadecimal "
                   "digits), T F N I and [ ] none; default: f for numbers, i for booleans, s for text.")
      ->type_name("TAGS");
  send->add_option("--to", command.to, "Receiver; default 127.0.0.1:9003.")->type_name("[HOST:]PORT");
  send->add_option("--wait", command.wait, "Seconds to wait for replies; 0: don't wait.")
      ->type_name("S")
      ->check(between(0.0, 60.0));
}

void add_new(CLI::App& app, NewCommand& command) {
  CLI::App* subcommand = app.add_subcommand("new", "Create a commented template of a show, a scene or a behavior.");
  subcommand->require_subcommand(1);
  subcommand->footer(
      "  limber new show my_show                      a folder with an example\n"
      "  limber new behavior wave                     behaviors_lua/wave.lua");
  const auto add = [&](const char* word, NewCommand::Kind value, const char* option, const char* about) {
    CLI::App* kind = subcommand->add_subcommand(word, about);
    kind->add_option(option, command.name, value == NewCommand::Kind::show ? "The folder." : "The name.")
        ->required()
        ->type_name("");
    kind->callback([&command, value] { command.kind = value; });
  };
  add("show", NewCommand::Kind::show, "DIR", "A folder with a scene, a robot and settings for editors.");
  add("scene", NewCommand::Kind::scene, "NAME", "scripts/NAME.lua in the show of the current folder.");
  add("behavior", NewCommand::Kind::behavior, "NAME", "behaviors_lua/NAME.lua in the show of the current folder.");
}

void add_preset(CLI::App& app, PresetCommand& command) {
  CLI::App* preset = app.add_subcommand("preset", "Import presets of other programs.");
  preset->require_subcommand(1);
  preset->footer("  limber preset import looks.json my.lua       append them to the presets of my.lua");
  CLI::App* import =
      preset->add_subcommand("import", "Append the presets of a Max pattrstorage (writejson) to those of a scene.");
  import->add_option("file", command.file, "The pattrstorage file.")->type_name("FILE.json")->required();
  import->add_option("scene", command.scene, "The scene; default scripts/arms.lua.")->type_name("SCENE.lua");
}

void add_take(CLI::App& app, std::string& file) {
  CLI::App* take = app.add_subcommand("take", "Inspect recorded takes.");
  take->require_subcommand(1);
  CLI::App* info = take->add_subcommand("info", "Print the contents of a take, and whether it is complete.");
  info->add_option("file", file, "The take.")->type_name("TAKE")->required();
  take->footer(
      "  limber my.lua --record evening.take\n"
      "  limber take info evening.take\n"
      "  limber --replay evening.take --fast\n"
      "  limber export evening.take --format gltf");
}

void add_service(CLI::App& app, ServiceCommand& command) {
  CLI::App* service =
      app.add_subcommand("service", "Install shows as services that systemd starts, monitors and restarts.");
  service->require_subcommand(1);
  service->footer(
      "  limber service install my.lua --fullscreen   write the user unit limber-my, and print it\n"
      "  systemctl --user enable --now limber-my      start it, now and with each session\n"
      "  limber service remove my                     delete the unit\n"
      "After install come the scene and options of `limber play`.\n"
      "The unit is described in docs/howto/installations.md.");
  CLI::App* install =
      service->add_subcommand("install", "Write a unit that plays a scene with options of play in the current folder.");
  install->add_option("--name", command.name, "Name of the service after limber-; default: the name of the scene.")
      ->type_name("NAME");
  install->add_flag("--print", command.print, "Print the unit, don't write it.");
  install->callback([&command] { command.action = ServiceCommand::Action::install; });
  CLI::App* remove = service->add_subcommand("remove", "Delete a unit that was written by install.");
  remove->add_option("name", command.name, "Name of the service; default: the only one.")->type_name("NAME");
  remove->callback([&command] { command.action = ServiceCommand::Action::remove; });
}

// moves the arguments after `service install`, except its own options, to `words`
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

// moves the arguments after `evolve --play DIR [ELITE]` to `words`
void split_elite_words(std::vector<std::string>& args, std::vector<std::string>& words) {
  if (args.size() < 4 || args[0] != "evolve" || args[1] != "--play") return;
  const std::size_t own = args[3].starts_with("-") ? 3 : 4;
  if (own < args.size() && (args[own] == "-h" || args[own] == "--help")) return;
  words.assign(args.begin() + static_cast<std::ptrdiff_t>(own), args.end());
  args.resize(own);
}

// the usage error of CLI11; for an unknown option with a suggestion
std::string usage_text(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  const std::string help = fmt::format("See `limber {} --help`", command->get_name());
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with("-")) return fmt::format("unexpected argument '{}'. {}", printable(word), help);
    const std::string option = word.substr(0, word.find('='));
    std::vector<std::string> names;
    for (const CLI::Option* known : command->get_options()) names.push_back(known->get_name());
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string_view near = nearest_name(option, views);
    return fmt::format("unknown option '{}'{} {}", printable(option),
                       near.empty() ? "." : fmt::format("; did you mean '{}'?", near), help);
  }
  return fmt::format("{}. {}", printable(error.what()), help);
}

void add_shell_files(CLI::App& app, CommandLine& line) {
  CLI::App* completion = app.add_subcommand("completion", "Print a completion script for a shell.");
  completion->footer(
      "  source <(limber completion bash)             for ~/.bashrc\n"
      "  limber completion zsh >~/.zfunc/_limber      for a folder in fpath\n"
      "The Debian package installs both.");
  completion->add_option("shell", line.shell, "The shell.")
      ->type_name("SHELL")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  CLI::App* man = app.add_subcommand("man", "Print the manual page.");
  man->footer("  limber man | man -l -                        read it");
  man->add_flag("--markdown", line.markdown, "Print Markdown, as in docs/reference/command_line.md.");
}

void add_annotate(CLI::App& app, CommandLine& line) {
  CLI::App* annotate = app.add_subcommand("annotate", "Write the definitions of the Lua API for editors (LuaCATS).");
  annotate->footer(
      "An editor with lua-language-server completes and explains the names of Limber with these definitions.\n"
      "  limber annotate limber.d.lua                 write them to a file\n"
      "  limber annotate --markdown reference         write the Lua reference, one page per subject");
  CLI::Option* file =
      annotate->add_option("file", line.definitions, "Output file; default: stdout.")->type_name("FILE");
  annotate->add_option("--markdown", line.reference, "Write the pages of the Lua reference to this folder instead.")
      ->type_name("DIR")
      ->excludes(file);
}

void add_docs(CLI::App& app, DocsCommand& command) {
  CLI::App* docs = app.add_subcommand("docs", "Read the documentation in a browser, with a search, offline.");
  docs->footer(
      "Serves the pages to this machine only, prints their address, and opens a browser if there is a display.\n"
      "Ctrl+C ends it. The Debian package contains the pages; in a checkout, `mkdocs build` makes them.\n"
      "  limber docs                                  open them\n"
      "  limber docs --no-browser --port 0            print the address, at a free port\n"
      "Exit codes: 3 there are no pages, or the port is in use.");
  docs->add_option("--port", command.port,
                   "TCP port on 127.0.0.1; 0: a free one; default: 9010, or a free one if it is in use.")
      ->type_name("PORT")
      ->check(between(0, 65535));
  docs->add_flag("--no-browser", command.no_browser, "Don't open a browser.");
}

void add_commands(CLI::App& app, CommandLine& line) {
  app.footer(kExitCodes);
  app.set_version_flag("--version", fmt::format("limber {} ({})", version(), commit()));
  app.require_subcommand(1);
  add_play_options(*app.add_subcommand("play", "Play a scene (the default command)."), line.play);
  add_sweep(app, line.experiments.sweep);
  add_evolve(app, line.experiments.evolve);
  add_breed(app, line.experiments.breed);
  add_inspect(app, line.inspect);
  add_describe(app, line);
  add_bench(app, line);
  add_console(app, line.console);
  add_monitor(app, line.monitor);
  add_send(app, line.send);
  add_new(app, line.create);
  add_preset(app, line.preset);
  add_take(app, line.take);
  add_export(app, line.exported);
  add_annotate(app, line);
  add_doctor(app, line.doctor);
  add_service(app, line.service);
  add_docs(app, line.docs);
  add_shell_files(app, line);
}

int print_shell_file(const CLI::App& app, const std::string& command, const CommandLine& line) {
  const CommandInfo program = command_info(app);
  print_result("{}", command == "man" && line.markdown ? command_page(program)
                     : command == "man"                ? man_page(program)
                     : line.shell == "zsh"             ? zsh_completion(program)
                                                       : bash_completion(program));
  return 0;
}

// Parses options of play. Returns false after an error, which is printed.
bool parse_play(std::vector<std::string> words, PlayOptions& options) {
  CLI::App play("", "play");
  add_play_options(play, options);
  std::reverse(words.begin(), words.end());
  try {
    play.parse(words);
  } catch (const CLI::ParseError& error) {
    print_notice("{}", usage_text(play, error));
    return false;
  }
  return true;
}

int run_service(ServiceCommand& command) {
  return parse_play(command.words, command.play) ? service_command(command) : kUsageError;
}

int run_evolve(const EvolveCommand& command, const std::vector<std::string>& words) {
  if (command.play.empty()) return evolve_command(command);
  PlayEliteCommand play{command.play, command.common.scene, {}};
  return parse_play(words, play.play) ? play_elite_command(play) : kUsageError;
}

struct CommandRunner {
  std::string_view name;
  int (*run)(CommandLine& line);
};
// all but those that need the command line's description: completion and man
constexpr CommandRunner kRunners[] = {
    {"play", [](CommandLine& l) { return play_command(l.play); }},
    {"sweep", [](CommandLine& l) { return sweep_command(l.experiments.sweep); }},
    {"evolve", [](CommandLine& l) { return run_evolve(l.experiments.evolve, l.experiments.play_words); }},
    {"breed", [](CommandLine& l) { return breed_command(l.experiments.breed); }},
    {"inspect", [](CommandLine& l) { return inspect_command(l.inspect); }},
    {"describe",
     [](CommandLine& l) {
       if (!l.markdown) return describe_command(l.scene, l.json);
       print_result("{}", describe_page());
       return kSuccess;
     }},
    {"console", [](CommandLine& l) { return console_command(l.console); }},
    {"monitor", [](CommandLine& l) { return monitor_command(l.monitor); }},
    {"send", [](CommandLine& l) { return send_command(l.send); }},
    {"new", [](CommandLine& l) { return new_command(l.create); }},
    {"preset", [](CommandLine& l) { return preset_command(l.preset); }},
    {"take", [](CommandLine& l) { return take_command(l.take); }},
    {"export", [](CommandLine& l) { return export_command(l.exported); }},
    {"annotate",
     [](CommandLine& l) {
       return l.reference.empty() ? annotate_command(l.definitions) : lua_reference_command(l.reference);
     }},
    {"bench", [](CommandLine& l) { return bench_command(l.bench); }},
    {"doctor", [](CommandLine& l) { return doctor_command(l.doctor); }},
    {"service", [](CommandLine& l) { return run_service(l.service); }},
    {"docs", [](CommandLine& l) { return docs_command(l.docs); }},
};

int run_command(int argc, char** argv) {
  if (argc == 2 && argv[1] == kWorkerArgument) return run_worker();
  if (argc == 4 && argv[1] == kVariationArgument) {
    DisplayOptions display;
    display.gl = argv[2];
    display.quality = argv[3];
    return run_variation_worker(display);
  }
  CLI::App app{kAbout, "limber"};
  CommandLine line;
  add_commands(app, line);
  if (const auto mistyped = mistyped_command(argc, argv)) {
    print_notice("{}", *mistyped);
    return kUsageError;
  }
  std::vector<std::string> args = with_command(argc, argv);
  split_service_words(args, line.service.words);
  split_elite_words(args, line.experiments.play_words);
  std::reverse(args.begin(), args.end());  // CLI11 reads them from the back
  try {
    app.parse(args);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // help, version
      std::ostringstream text;
      (void)app.exit(error, text, text);
      write_result(text.str());
      return kSuccess;
    }
    print_notice("{}", usage_text(app, error));
    return kUsageError;
  }
  const std::string command = app.get_subcommands().front()->get_name();
  const auto* const runner = std::ranges::find(kRunners, command, &CommandRunner::name);
  return runner != std::end(kRunners) ? runner->run(line) : print_shell_file(app, command, line);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    return finish_command(run_command(argc, argv));
  } catch (const std::bad_alloc&) {
    print_notice("not enough memory; end other programs, or raise ulimit -v");
  } catch (const std::system_error& error) {  // a thread could not be started
    print_notice("{}; end other programs, or raise ulimit -u and ulimit -v", error.code().message());
  }
  return kMachineError;
}

}  // namespace limber::app
