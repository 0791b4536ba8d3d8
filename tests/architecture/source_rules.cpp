// Implements the project rules. The tables at the top define them.
#include "architecture/source_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace limber::rules {
namespace {

/// A module, that is a folder of src/, and the modules that it may include besides itself and base.
struct Module {
  std::string_view name;
  std::string_view may_include;
};
constexpr std::array kModules{
    Module{"base", ""},
    Module{"properties", ""},
    Module{"model", ""},
    Module{"sim", "properties model"},
    Module{"script", "properties model sim"},
    Module{"engine", "properties model sim script"},
    // Modules outside the simulation thread see commands, snapshots and the catalog, but no simulation objects.
    Module{"net/osc", "properties model engine"},
    Module{"net/lighting", "properties model engine"},
    Module{"net/link", "properties model engine"},
    Module{"net/midi", "properties model engine"},
    Module{"net/console", "properties model engine"},
    Module{"net/oscquery", "properties model engine"},
    Module{"ui/render", "properties model engine"},
    Module{"ui/panel", "properties model engine"},
    // motion files, without access to the scene
    Module{"export", ""},
    // for other programs, like app for users: it connects the modules that its interface offers
    Module{"lib", "properties model sim script engine ui/render"},
    // designs, searches and the distribution of evaluations, without access to the scene
    Module{"experiments", ""},
    Module{
        "app",
        "properties model sim script engine net/osc net/lighting net/link net/midi net/console net/oscquery ui/render "
        "ui/panel export experiments"},
};

/// Folders that only files of their own module include.
constexpr std::array kInternalFolders{"sim/bullet/",     "sim/collision/",   "sim/solver/",      "script/api/",
                                      "engine/history/", "ui/panel/panels/", "net/oscquery/web/"};

/// The namespace of a folder's code, within `limber`. The first match counts. The vocabulary of all modules, which is
/// base and properties, is in `limber` itself.
struct Namespace {
  std::string_view folder;
  std::string_view name;
};
constexpr std::array kNamespaces{
    Namespace{"base/", ""},
    Namespace{"properties/", ""},
    Namespace{"model/", "model"},
    Namespace{"sim/bullet/", "sim::bullet"},
    Namespace{"sim/collision/", "sim::collision"},
    Namespace{"sim/solver/", "sim::solver"},
    Namespace{"sim/", "sim"},
    Namespace{"script/", "script"},
    Namespace{"engine/", "engine"},
    Namespace{"net/osc/", "osc"},
    Namespace{"net/lighting/", "lighting"},
    Namespace{"net/link/", "link"},
    Namespace{"net/midi/", "midi"},
    Namespace{"net/console/", "console"},
    Namespace{"net/oscquery/", "oscquery"},
    Namespace{"ui/render/", "render"},
    Namespace{"ui/panel/", "panel"},
    Namespace{"export/", "exporter"},
    Namespace{"experiments/", "experiments"},
    Namespace{"app/", "app"},
    Namespace{"lib/", "lib"},
};
/// A nested namespace that every module may extend: the constructors of property definitions.
constexpr std::string_view kSharedNamespace = "limber::properties";

/// The start of an external library's header names, and the module that may include it ("": all modules).
struct Library {
  std::string_view header;
  std::string_view module;
};
constexpr std::array kLibraries{
    Library{"bt", "sim"},
    Library{"BulletCollision/", "sim"},
    Library{"BulletDynamics/", "sim"},
    Library{"BulletSoftBody/", "sim"},
    Library{"LinearMath/", "sim"},
    Library{"bullet/", "sim"},
    Library{"tinyxml", "model"},
    Library{"lua", "script"},
    Library{"lauxlib.h", "script"},
    Library{"luajit-2.1/", "script"},
    Library{"RtMidi.h", "net/midi"},
    Library{"boost/", "net/oscquery"},
    Library{"epoxy/", "ui/render"},
    Library{"GL/", "ui/render"},
    Library{"EGL/", "ui/render"},
    Library{"png.h", "model"},
    Library{"jpeglib.h", "model"},
    Library{"stb_", "ui/render"},
    Library{"imgui", "ui/panel"},
    Library{"tiny_gltf.h", "export"},
    Library{"GLFW/", "app"},
    Library{"CLI/", "app"},
    Library{"histedit.h", "app"},
    Library{"stddef.h", "lib"},  // limber.h is for C
    Library{"stdint.h", "lib"},
    Library{"sanitizer/", "base"},
    Library{"valgrind/", "base"},
    Library{"fmt/", ""},
    Library{"glm/", ""},
    Library{"nlohmann/", ""},
};

/// Headers of the operating system, allowed in src/base/system only.
constexpr std::array kSystemHeaders{"sys/",      "netinet/", "arpa/",      "net/",       "linux/",  "unistd.h",
                                    "poll.h",    "fcntl.h",  "signal.h",   "pthread.h",  "sched.h", "netdb.h",
                                    "ifaddrs.h", "dirent.h", "execinfo.h", "dlfcn.h",    "glob.h",  "spawn.h",
                                    "termios.h", "malloc.h", "alloca.h",   "ucontext.h", "pwd.h",   "grp.h",
                                    "ftw.h",     "mach/",    "mach-o/",    "link.h"};
constexpr std::string_view kSystemFolder = "src/base/system/";
/// Calls and types of the operating system, which C++ headers also declare, and its files.
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
constexpr std::array kCompilerHeaders{"immintrin.h", "emmintrin.h", "xmmintrin.h", "arm_neon.h", "cxxabi.h"};

bool has_word(std::string_view words, std::string_view word) {
  std::istringstream in{std::string(words)};
  return std::find(std::istream_iterator<std::string>(in), {}, word) != std::istream_iterator<std::string>();
}

/// Returns the module of a path relative to src/; null if it is in none. Files in src/ itself belong to app.
const Module* module_of(std::string_view path) {
  if (path.find('/') == std::string_view::npos) return &kModules.back();
  const auto* found = std::find_if(kModules.begin(), kModules.end(), [&](const Module& module) {
    return path.starts_with(module.name) && path.substr(module.name.size()).starts_with('/');
  });
  return found == kModules.end() ? nullptr : found;
}

/// The include of a line: the delimiter '<' or '"' and the name; delimiter 0 if there is none.
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

/// Returns the reason why the module may not include the project's file `name`; empty if it may.
std::string project_complaint(const Module& module, std::string_view name) {
  if (name.find('/') == std::string_view::npos || name.starts_with('.'))
    return "must be relative to src/, like \"base/vec.h\"";
  const Module* target = module_of(name);
  if (target == nullptr) return "is in no module of src/";
  if (target == &module) return {};
  if (target->name != "base" && !has_word(module.may_include, target->name)) {
    return "is not in a lower module: " + std::string(module.name) + " may include base " +
           std::string(module.may_include);
  }
  const auto contains = [name](const char* folder) { return name.starts_with(folder); };
  if (std::ranges::any_of(kInternalFolders, contains)) return "is internal to " + std::string(target->name);
  return {};
}

/// Returns the reason why the file may not include an external header; empty if it may.
std::string library_complaint(const Module& module, std::string_view path, std::string_view name) {
  for (const char* system : kSystemHeaders) {
    if (!name.starts_with(system) || path.starts_with(kSystemFolder)) continue;
    return "is a header of the operating system: include it in src/base/system/ only";
  }
  for (const Library& library : kLibraries) {
    if (!name.starts_with(library.header)) continue;
    if (library.module.empty() || library.module == module.name) return {};
    return "may be included by the module " + std::string(library.module) + " only";
  }
  if (name.find_first_of("./") == std::string_view::npos) return {};
  const auto known = [name](const char* header) { return name.starts_with(header); };
  if (std::ranges::any_of(kSystemHeaders, known) || std::ranges::any_of(kCompilerHeaders, known)) return {};
  return "belongs to no known library: add it to tests/architecture/source_rules.cpp";
}

}  // namespace

std::vector<std::string> modules() {
  std::vector<std::string> names;
  names.reserve(kModules.size());
  for (const Module& module : kModules) names.emplace_back(module.name);
  return names;
}

std::vector<std::string> include_complaints(std::string_view path, std::string_view text) {
  const Module* module = module_of(path.substr(std::string_view("src/").size()));
  if (module == nullptr) return {std::string(path) + ": unknown module; add it to source_rules.cpp"};
  std::vector<std::string> complaints;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const Include include = include_of(line);
    if (include.delimiter == 0) continue;
    const bool own = include.delimiter == '"';
    const std::string why =
        own ? project_complaint(*module, include.name) : library_complaint(*module, path, include.name);
    if (!why.empty()) {
      complaints.push_back(std::string(path) + ":" + std::to_string(number) + ": '" + std::string(include.name) + "' " +
                           why);
    }
  }
  return complaints;
}

std::vector<std::string> indirect_include_complaints(const std::vector<SourceFile>& files) {
  struct Includes {
    std::vector<std::string> headers;    // of the project
    std::vector<std::string> libraries;  // headers that one module alone may include
  };
  std::map<std::string, Includes> includes;
  for (const SourceFile& file : files) {
    const std::string path = file.path.substr(std::string_view("src/").size());
    std::istringstream lines(file.text);
    for (std::string line; std::getline(lines, line);) {
      const Include include = include_of(line);
      if (include.delimiter == '"') includes[path].headers.emplace_back(include.name);
      if (include.delimiter == '<') includes[path].libraries.emplace_back(include.name);
    }
  }
  std::vector<std::string> complaints;
  for (const auto& [path, own] : includes) {
    const Module* module = module_of(path);
    if (module == nullptr) continue;
    std::set<std::string> seen{path};
    std::vector<std::string> open{own.headers};
    while (!open.empty()) {
      const std::string header = open.back();
      open.pop_back();
      if (!seen.insert(header).second || !includes.contains(header)) continue;
      const Includes& next = includes[header];
      open.insert(open.end(), next.headers.begin(), next.headers.end());
      for (const std::string& library : next.libraries) {
        const std::string why = library_complaint(*module, "src/" + header, library);
        if (why.empty()) continue;
        complaints.push_back("src/" + path + ": includes '" + library + "' through '" + header + "', which " + why);
      }
    }
  }
  return complaints;
}

std::vector<std::string> namespace_complaints(std::string_view path, std::string_view text) {
  std::vector<std::string> complaints;
  const std::string_view inside = path.substr(std::string_view("src/").size());
  const auto* found = std::ranges::find_if(
      kNamespaces, [&](const Namespace& candidate) { return inside.starts_with(candidate.folder); });
  if (found == kNamespaces.end()) return complaints;
  const std::string expected = "limber" + std::string(found->name.empty() ? "" : "::") + std::string(found->name);
  static const std::regex opening(R"(namespace (limber[\w:]*) \{)");
  static const std::regex declaration(R"((template <.*> )?(class|struct|enum class|std::span<).*;.*)");
  std::istringstream lines{std::string(text)};
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (!std::regex_match(line, match, opening)) continue;
    const std::string name = match.str(1);
    const auto belongs_to = [&](const Namespace& module) {
      const std::string other = "limber::" + std::string(module.name);
      return !module.name.empty() && (name == other || name.starts_with(other + "::"));
    };
    if (name == expected || name == kSharedNamespace) continue;
    // a nested namespace of the module
    if (name.starts_with(expected + "::") && (expected != "limber" || std::ranges::none_of(kNamespaces, belongs_to)))
      continue;
    while (std::getline(lines, line) && !line.starts_with("}")) {
      if (line.empty() || line.starts_with("//") || std::regex_match(line, declaration)) continue;
      complaints.push_back(std::string(path) + ": '" + line + "' is in the namespace " + name + "; expected " +
                           expected);
      break;
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
      // part of a longer name
      if (at > 0 && (std::isalnum(static_cast<unsigned char>(code[at - 1])) != 0 || code[at - 1] == '_')) continue;
      complaints.push_back(std::string(path) + ":" + std::to_string(number) + ": '" + std::string(call) +
                           "' belongs to the operating system: call it in src/base/system/");
    }
  }
  return complaints;
}

std::vector<std::string> shape_complaints(std::string_view path, std::string_view text) {
  constexpr int kMaxLines = 500;
  std::vector<std::string> complaints;
  const std::string_view comment = path.ends_with(".lua")                               ? "--"
                                   : path.ends_with(".cmake") || path.ends_with(".txt") ? "#"
                                                                                        : "//";
  if (!text.starts_with(comment)) {
    complaints.push_back(std::string(path) + ": must begin with a comment that describes the file");
  }
  const auto lines = std::count(text.begin(), text.end(), '\n');
  if (lines > kMaxLines) {
    complaints.push_back(std::string(path) + ": has " + std::to_string(lines) + " lines; at most 500 are allowed");
  }
  return complaints;
}

std::vector<std::string> math_complaints(std::string_view path, std::string_view text) {
  static const std::regex modules("src/(base|properties|model|sim|script|engine)/.*");
  static const std::regex call(
      R"((std::(a?(sin|cos|tan)h?|atan2|exp[2m]?1?|log(2|10|1p)?|pow|cbrt|hypot|[lt]gamma|erfc?)f?|)"
      R"(glm::(angleAxis|slerp|eulerAngles|pow|exp2?|log2?|a?(sin|cos|tan)h?|rotate|angle))\()");
  std::vector<std::string> complaints;
  if (!std::regex_match(path.begin(), path.end(), modules)) return complaints;
  for (std::cregex_iterator found(text.data(), text.data() + text.size(), call), end; found != end; ++found) {
    complaints.push_back(std::string(path) + ": calls " + found->str(1) +
                         "; use limber::fixed (base/math/fixed_math.h)");
  }
  return complaints;
}

std::vector<std::string> output_complaints(std::string_view path, std::string_view text) {
  std::vector<std::string> complaints;
  if (path == "src/app/console/terminal.cpp") return complaints;  // libedit takes streams
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
                         "' may throw or block: use base/log/output.h");
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
    if (path.starts_with("src/link/")) continue;                                   // limber-link, a program of its own
    if (path.starts_with("src/mpi/") || path.starts_with("src/pagmo/")) continue;  // modules, loaded at run time
    if (std::none_of(endings.begin(), endings.end(), [&](const std::string& e) { return path.ends_with(e); })) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files.push_back({path, {std::istreambuf_iterator<char>(in), {}}});
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace limber::rules
