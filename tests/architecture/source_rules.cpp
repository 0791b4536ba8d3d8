// See source_rules.h. The tables at the top are the rules; what follows reads text.
#include "architecture/source_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace limber::rules {
namespace {

/// A room and the rooms it sees beside itself and base.
struct Room {
  std::string_view name;
  std::string_view sees;
};
constexpr std::array kRooms{
    Room{"base", ""},
    Room{"params", ""},
    Room{"model", ""},
    Room{"sim", "params model"},
    Room{"behaviors", "params model sim"},
    Room{"script", "params model sim"},
    Room{"engine", "params model sim behaviors script"},
    // the outside sees commands, snapshots and the catalog, nothing live
    Room{"osc", "params model engine"},
    Room{"console", "params model engine"},
    Room{"query", "params model engine"},
    Room{"view", "params model engine"},
    Room{"gui", "params model engine"},
    // files of motion: whoever fills them sees the rest
    Room{"motion", ""},
    Room{"app", "params model sim behaviors script engine osc console query view gui motion"},
};

/// An outside library, by how its headers begin, and the room that may include it ("" : every room).
struct Library {
  std::string_view header;
  std::string_view room;
};
constexpr std::array kLibraries{
    Library{"bt", "sim"},
    Library{"BulletCollision/", "sim"},
    Library{"BulletDynamics/", "sim"},
    Library{"BulletSoftBody/", "sim"},
    Library{"LinearMath/", "sim"},
    Library{"bullet/", "sim"},
    Library{"urdf_", "model"},
    Library{"tinyxml", "model"},
    Library{"console_bridge/", "model"},
    Library{"lua", "script"},
    Library{"lauxlib.h", "script"},
    Library{"luajit-2.1/", "script"},
    Library{"oscpack/", "osc"},
    Library{"boost/", "query"},
    Library{"epoxy/", "view"},
    Library{"GL/", "view"},
    Library{"EGL/", "view"},
    Library{"stb_", "view"},
    Library{"imgui", "gui"},
    Library{"tiny_gltf.h", "motion"},
    Library{"GLFW/", "app"},
    Library{"CLI/", "app"},
    Library{"histedit.h", "app"},
    Library{"spdlog/", "base"},
    Library{"sanitizer/", "base"},
    Library{"valgrind/", "base"},
    Library{"fmt/", ""},
    Library{"glm/", ""},
    Library{"nlohmann/", ""},
};

/// Headers of the operating system: for src/base/system alone.
constexpr std::array kSystem{"sys/",       "netinet/", "arpa/",     "net/",    "linux/",    "unistd.h",  "poll.h",
                             "fcntl.h",    "signal.h", "pthread.h", "sched.h", "netdb.h",   "ifaddrs.h", "dirent.h",
                             "execinfo.h", "dlfcn.h",  "glob.h",    "spawn.h", "termios.h", "malloc.h",  "alloca.h",
                             "ucontext.h", "pwd.h",    "grp.h",     "ftw.h",   "mach/",     "mach-o/",   "link.h"};
constexpr std::string_view kSystemFolder = "src/base/system/";
/// Its calls, which headers of C++ bring along too, and its files.
constexpr std::array kSystemCalls{
    "getpid(",     "getuid(",     "geteuid(",       "isatty(",      "ioctl(",     "fileno(",       "mmap(",
    "munmap(",     "mprotect(",   "madvise(",       "ppoll(",       "pselect(",   "eventfd(",      "epoll_",
    "inotify_",    "recvmmsg(",   "sendmmsg(",      "recvfrom(",    "recvmsg(",   "sendto(",       "sendmsg(",
    "setsockopt(", "getsockopt(", "sigaction(",     "pthread_",     "sigset_t",   "sigtimedwait(", "setitimer(",
    "dlopen(",     "dlsym(",      "clock_gettime(", "fsync(",       "fdatasync(", "flock(",        "fcntl(",
    "fork(",       "posix_spawn", "waitpid(",       "mkdir(",       "chmod(",     "readlink(",     "syscall(",
    "prctl(",      "sysconf(",    "setpriority(",   "gethostname(", "uname(",     "nanosleep(",    "usleep(",
    "ssize_t",     "pid_t",       "clockid_t",      "mallinfo",     "\"/proc/",   "\"/sys/",       "\"/dev/"};
/// Headers of the compiler and the processor.
constexpr std::array kCompiler{"immintrin.h", "emmintrin.h", "xmmintrin.h", "arm_neon.h", "cxxabi.h"};

bool has_word(std::string_view words, std::string_view word) {
  std::istringstream in{std::string(words)};
  return std::find(std::istream_iterator<std::string>(in), {}, word) != std::istream_iterator<std::string>();
}

/// "src/sim/world.cpp" is of sim; what lies in src/ itself belongs to app.
std::string room_of(std::string_view path) {
  path.remove_prefix(std::string_view("src/").size());
  const auto slash = path.find('/');
  return slash == std::string_view::npos ? "app" : std::string(path.substr(0, slash));
}

const Room* find_room(std::string_view name) {
  const auto* found = std::find_if(kRooms.begin(), kRooms.end(), [&](const Room& r) { return r.name == name; });
  return found == kRooms.end() ? nullptr : found;
}

/// What one line includes: the delimiter '<' or '"' and the name; delimiter 0 when it includes nothing.
struct Include {
  char delimiter = 0;
  std::string_view name;
};
Include include_of(std::string_view line) {
  const auto skip = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip();
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  skip();
  if (!line.starts_with("include")) return {};
  line.remove_prefix(std::string_view("include").size());
  skip();
  if (line.empty() || (line[0] != '<' && line[0] != '"')) return {};
  const char delimiter = line[0];
  line.remove_prefix(1);
  return {delimiter, line.substr(0, line.find(delimiter == '<' ? '>' : '"'))};
}

/// Why `room` may not include our own file `name`; empty: it may.
std::string own_complaint(const Room& room, std::string_view name) {
  const auto slash = name.find('/');
  if (slash == std::string_view::npos || name.starts_with('.')) return "is not written from src/, like \"base/vec.h\"";
  const std::string_view target = name.substr(0, slash);
  if (find_room(target) == nullptr) return "names no room of src/";
  if (target == room.name || target == "base" || has_word(room.sees, target)) return {};
  return "looks up or sideways: " + std::string(room.name) + " sees base " + std::string(room.sees);
}

/// The same for an outside header.
std::string library_complaint(const Room& room, std::string_view path, std::string_view name) {
  for (const char* system : kSystem) {
    if (!name.starts_with(system) || path.starts_with(kSystemFolder)) continue;
    return "is a header of the operating system: put what needs it into src/base/system/";
  }
  for (const Library& library : kLibraries) {
    if (!name.starts_with(library.header)) continue;
    if (library.room.empty() || library.room == room.name) return {};
    return "belongs to the room " + std::string(library.room) + " alone";
  }
  if (name.find_first_of("./") == std::string_view::npos) return {};
  const auto known = [name](const char* header) { return name.starts_with(header); };
  if (std::ranges::any_of(kSystem, known) || std::ranges::any_of(kCompiler, known)) return {};
  return "is of no known library: give it a room in tests/architecture/source_rules.cpp";
}

}  // namespace

std::vector<std::string> rooms() {
  std::vector<std::string> names;
  names.reserve(kRooms.size());
  for (const Room& room : kRooms) names.emplace_back(room.name);
  return names;
}

std::vector<std::string> include_complaints(std::string_view path, std::string_view text) {
  const Room* room = find_room(room_of(path));
  if (room == nullptr) return {std::string(path) + ": src/ has no such room; give it a row in source_rules.cpp"};
  std::vector<std::string> complaints;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const Include include = include_of(line);
    if (include.delimiter == 0) continue;
    const bool own = include.delimiter == '"';
    const std::string why = own ? own_complaint(*room, include.name) : library_complaint(*room, path, include.name);
    if (!why.empty()) {
      complaints.push_back(std::string(path) + ":" + std::to_string(number) + ": '" + std::string(include.name) + "' " +
                           why);
    }
  }
  return complaints;
}

std::vector<std::string> system_complaints(std::string_view path, std::string_view text) {
  std::vector<std::string> complaints;
  if (path.starts_with(kSystemFolder)) return complaints;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string_view code = std::string_view(line).substr(0, line.find("//"));
    for (const std::string_view call : kSystemCalls) {
      const std::size_t at = code.find(call);
      if (at == std::string_view::npos) continue;
      // a longer name of our own
      if (at > 0 && (std::isalnum(static_cast<unsigned char>(code[at - 1])) != 0 || code[at - 1] == '_')) continue;
      complaints.push_back(std::string(path) + ":" + std::to_string(number) + ": '" + std::string(call) +
                           "' is the operating system's: call it in src/base/system/");
    }
  }
  return complaints;
}

std::vector<std::string> shape_complaints(std::string_view path, std::string_view text) {
  constexpr int kMostLines = 500;
  std::vector<std::string> complaints;
  const std::string_view mark = path.ends_with(".lua")                               ? "--"
                                : path.ends_with(".cmake") || path.ends_with(".txt") ? "#"
                                                                                     : "//";
  if (!text.starts_with(mark)) {
    complaints.push_back(std::string(path) + ": does not open with a comment that says what it is");
  }
  const auto lines = std::count(text.begin(), text.end(), '\n');
  if (lines > kMostLines) {
    complaints.push_back(std::string(path) + ": has " + std::to_string(lines) + " lines, 500 are allowed");
  }
  return complaints;
}

std::vector<std::string> math_complaints(std::string_view path, std::string_view text) {
  static const std::regex modules("src/(base|params|model|sim|behaviors|script|engine)/.*");
  static const std::regex call(
      R"((std::(a?(sin|cos|tan)h?|atan2|exp[2m]?1?|log(2|10|1p)?|pow|cbrt|hypot|[lt]gamma|erfc?)f?|)"
      R"(glm::(angleAxis|slerp|eulerAngles|pow|exp2?|log2?|a?(sin|cos|tan)h?|rotate|angle))\()");
  std::vector<std::string> complaints;
  if (!std::regex_match(path.begin(), path.end(), modules)) return complaints;
  for (std::cregex_iterator found(text.data(), text.data() + text.size(), call), end; found != end; ++found) {
    complaints.push_back(std::string(path) + ": calls " + found->str(1) + "; use limber::fixed (base/fixed_math.h)");
  }
  return complaints;
}

std::vector<std::string> output_complaints(std::string_view path, std::string_view text) {
  std::vector<std::string> complaints;
  if (path == "src/app/console_terminal.cpp") return complaints;  // libedit takes streams
  static const std::regex use(
      R"((fmt::print|std::(cout|cerr|clog|fflush|perror)|\b(stdout|stderr|f?printf|puts|putchar)\b))");
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    constexpr std::array kParts{"print", "cout", "cerr", "clog", "fflush", "perror", "stdout", "stderr", "put"};
    std::string code = line.substr(0, line.find("//"));
    if (std::ranges::none_of(kParts, [&](const char* part) { return code.find(part) != std::string::npos; })) continue;
    code = std::regex_replace(code, std::regex(R"("([^"\\]|\\.)*")"), "\"\"");
    std::smatch found;
    if (!std::regex_search(code, found, use)) continue;
    complaints.push_back(std::string(path) + ":" + std::to_string(number) + ": '" + found.str() +
                         "' throws or blocks: write by base/output.h");
  }
  return complaints;
}

std::vector<SourceFile> source_files(std::string_view folder, const std::vector<std::string>& endings) {
  namespace fs = std::filesystem;
  const fs::path root = LIMBER_SOURCE_DIR;
  std::vector<SourceFile> files;
  if (!fs::is_directory(root / folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string path = entry.path().lexically_relative(root).generic_string();
    if (std::none_of(endings.begin(), endings.end(), [&](const std::string& e) { return path.ends_with(e); })) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files.push_back({path, {std::istreambuf_iterator<char>(in), {}}});
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace limber::rules
