// Syntax: systemd.syntax(7), systemd.service(5).
#include "app/service/service_unit.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::app {

namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-./:=,+@").find(c) != std::string_view::npos;
}

// a path that is not split into words: only specifiers (%) are expanded
Result<std::string> unit_path(std::string_view text) {
  const bool control = std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (control || text.ends_with(' ') || text.ends_with('\\'))
    return Error{
        fmt::format("the folder '{}' can't be used in a unit: it contains control characters, or ends with a space or "
                    "a backslash. Start the show from another folder",
                    printable(text))};
  std::string path;
  for (const char c : text) path += c == '%' ? "%%" : std::string(1, c);
  return path;
}

constexpr std::string_view kInstructions = R"(
# Changes of your own: systemctl --user edit {0}
# Start it, and with each session from now on: systemctl --user enable --now {0}
# Its log: journalctl --user -u {0} -f
# Panic: systemctl --user kill -s USR2 {0}
)";

}  // namespace

std::string unit_word(std::string_view text) {
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return std::string(text);
  std::string word = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      word += fmt::format("\\{}", c);
    } else if (c == '%' || c == '$') {
      word += fmt::format("{0}{0}", c);
    } else if (byte < 0x20 || byte == 0x7f) {
      word += fmt::format("\\x{:02x}", byte);
    } else {
      word += c;
    }
  }
  return word + "\"";
}

std::string service_name(std::string_view scene) {
  std::string name = std::filesystem::path(scene).stem().string();
  const auto usable = [](char c) {
    return is_plain(c) && std::string_view("./:=,+@").find(c) == std::string_view::npos;
  };
  std::ranges::replace_if(
      name, [&](char c) { return !usable(c); }, '-');
  return name.empty() ? "show" : name;
}

Result<std::string> service_unit_text(const ServiceUnit& unit) {
  const Result<std::string> folder = unit_path(unit.folder);
  if (!folder) return Error{folder.error()};
  std::string command = unit_word(unit.program) + " play";
  for (const std::string& word : unit.words) command += " " + unit_word(word);
  const Result<std::string> about = unit_path(printable(unit.scene));
  std::string text = fmt::format("{}{}", kServiceHeader, fmt::format(fmt::runtime(kInstructions), unit.name));
  text += fmt::format("\n[Unit]\nDescription=Limber: {}\n", about ? *about : unit.name);
  if (unit.window) text += "After=graphical-session.target\n";
  text += "StartLimitIntervalSec=0\n";
  text += fmt::format("\n[Service]\nType=notify\nWorkingDirectory={}\nExecStart={}\n", *folder, command);
  text += "Restart=on-failure\nRestartSec=2\nRestartPreventExitStatus=2\n";
  text += "WatchdogSec=30\nTimeoutStartSec=90\nTimeoutStopSec=30\nSyslogIdentifier=limber\n";
  text += fmt::format("\n[Install]\nWantedBy={}\n", unit.window ? "graphical-session.target" : "default.target");
  return text;
}

}  // namespace limber::app
