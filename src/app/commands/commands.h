// The commands of the program besides `play` and `service`: their arguments as typed, and the functions that run them.
// A function returns the exit code and is called on the main thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limber::model {
struct BodyModel;
}  // namespace limber::model

namespace limber::app {

/// `limber annotate`: writes the LuaCATS definitions of everything that scripts can use, for editors, to `file`, or to
/// stdout if its name is empty.
int annotate_command(const std::string& file);
/// Returns the definitions as text.
std::string annotations_text();
/// `limber annotate --markdown`: writes the pages of the Lua reference to the folder. Returns 3 if one can't be
/// written.
int lua_reference_command(const std::string& folder);

struct BenchOptions {
  bool json = false;
  int ticks = 0;  ///< Timed ticks for each number of arms; 0: 60.
};
/// `limber bench`: plays more and more arms with each solver, with one thread and with one per core, until they are
/// slower than real time, and prints the results.
int bench_command(const BenchOptions& options);

struct ConsoleCommand {
  int pid = 0;                            ///< Process id of the program; 0: the only one that runs.
  std::optional<std::string> expression;  ///< `-e`: evaluate this expression and exit.
};
/// `limber console`: a Lua console of the running scene, interactive, from a pipe, or for one expression. Returns 1 if
/// no program is running, or if any evaluation failed (except in an interactive terminal).
int console_command(const ConsoleCommand& command);

/// `limber describe`: prints every OSC address with type, unit, range, default and meaning: of all classes (with <name>
/// as a placeholder), or, if a scene is given, of all its objects.
int describe_command(const std::string& scene, bool json);

struct DocsCommand {
  std::optional<int> port;  ///< Empty: 9010, or a free one if it is in use; 0: a free one.
  bool no_browser = false;
};
/// `limber docs`: serves the documentation on 127.0.0.1, prints its address and opens it in a browser, until Ctrl+C.
/// Returns 3 if the pages are not installed or the port is in use.
int docs_command(const DocsCommand& command);

struct DoctorCommand {
  std::string osc_in = "9003";  ///< OSC input address, as in `play`.
  std::string query;            ///< OSCQuery address, as in `play`; empty: the port number of `osc_in`.
  std::string gl;               ///< Kind of OpenGL, as in `play`.
};
/// `limber doctor`: checks this machine, and prints one line for each check with the fix of its problem. Returns 3 if
/// something that `play` needs is missing.
int doctor_command(const DoctorCommand& command);

struct ExportCommand {
  std::string take;
  std::string format;               ///< csv, bvh, gltf; empty: by the extension of `output`.
  std::string output;               ///< Empty: next to the take, with the same name.
  double rate = 60;                 ///< Frames per simulated second.
  std::vector<std::string> bodies;  ///< Names or patterns; empty: all bodies.
  double from = 0;                  ///< Start, in simulated seconds since the beginning of the take.
  std::optional<double> to;         ///< End, in the same unit; nullopt: the end of the take.
  std::vector<std::string> extras;  ///< With CSV: velocities, torques, contacts.
  bool overwrite = false;
};
/// `limber export`: replays a take at full speed and exports its motion for other programs: CSV, BVH, glTF. Returns 1
/// if the file is not a take or the replay diverged from the recording (the output is written anyway); 3 if writing
/// failed. Ctrl+C leaves no file behind.
int export_command(const ExportCommand& command);
/// Like export_command(); `cancel` is called before each tick and returns true to stop.
int export_take(const ExportCommand& command, const std::function<bool()>& cancel);

struct InspectCommand {
  std::string file;
  bool json = false;
  std::vector<std::string> package_paths;
  std::string root;             ///< See ImportOptions.
  std::string screenshot = {};  ///< File of an image of the model; empty: none.
  std::string size = {};        ///< Its size, as in `play`.
};
/// `limber inspect`: prints links, joints and problems of a URDF or MJCF file to stdout; if the file contains no body,
/// an error to stderr. Returns 0 if there is a body, even with problems, else 1; 3 if the image can't be rendered.
int inspect_command(const InspectCommand& command);
/// Return the same as text: indented JSON, or a table for people.
std::string inspect_json(const model::BodyModel& model);
std::string inspect_table(const model::BodyModel& model);

struct MonitorCommand {
  std::string pattern;  ///< Pattern of addresses; empty: all.
  bool changes = false;
  bool only_in = false;
  bool only_out = false;
  int pid = 0;                         ///< Process id of the program; 0: the only one that runs.
  std::optional<std::uint64_t> count;  ///< Exit after this number of lines.
};
/// `limber monitor`: prints the messages that a running program receives and sends, or the values that change, until
/// the program ends or Ctrl+C.
int monitor_command(const MonitorCommand& command);

struct NewCommand {
  enum class Kind : unsigned char { show, scene, behavior };
  Kind kind = Kind::scene;
  std::string name;  ///< For a show: its folder.
};
/// `limber new`: creates a commented template of a show, a scene or a behavior. Never overwrites existing files.
/// Returns 1 if the file exists or the behavior's name is in use by another type, 2 if the name is invalid, 3 if a file
/// can't be written.
int new_command(const NewCommand& command);

struct PresetCommand {
  std::string file;
  std::string scene = "scripts/arms.lua";
};
/// `limber preset import`: converts presets of Max's pattrstorage, appends them to those of a scene, and reports values
/// that were skipped. Returns 1 if one of the files can't be read; 3 if the result can't be written.
int preset_command(const PresetCommand& command);

struct SendCommand {
  std::string address;
  std::vector<std::string> words;  ///< The arguments as typed.
  std::string tags;                ///< OSC type tags of the arguments; empty: numbers are f, booleans i, text s.
  std::string to = "127.0.0.1:9003";
  double wait = 1;  ///< Time to wait for replies, s; 0: don't wait.
};
/// `limber send ADDRESS ARGS…`: sends one OSC message, and prints replies to stdout and errors to stderr. Returns 1 if
/// the message was rejected, 3 without a reply.
int send_command(const SendCommand& command);

/// `limber take info`: prints the contents of a take. Returns 1 if the file is not a take or is damaged. A truncated
/// take is valid.
int take_command(const std::string& file);

}  // namespace limber::app
