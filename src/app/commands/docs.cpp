// Runs the server of the documentation until a signal.
#include "app/commands/commands.h"

#include <chrono>
#include <cstdint>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/view/window.h"
#include "base/log/output.h"
#include "base/system/child_process.h"
#include "base/system/signals.h"
#include "net/oscquery/site_server.h"

namespace limber::app {

namespace {

constexpr std::uint16_t kDefaultPort = 9010;

// The shell returns at once, and the browser stays open when this program ends.
void open_browser(const std::string& address) {
  if (!Window::has_display() || find_in_path("xdg-open").empty()) return;
  system::ChildProcess shell;
  if (shell.start({"sh", "-c", "xdg-open \"$1\" >/dev/null 2>&1 </dev/null &", "sh", address}) == 0) shell.finish();
}

}  // namespace

int docs_command(const DocsCommand& command) {
  const std::string folder = site_dir();
  if (folder.empty())
    return fail(kMachineError,
                "docs: the pages of the documentation are not installed. In a checkout, run `mkdocs build` (Debian's "
                "package mkdocs), which writes build/site; the Debian package of limber contains them");
  system::block_signals();
  oscquery::SiteServer server;
  Result<void> started = server.start(folder, command.port ? static_cast<std::uint16_t>(*command.port) : kDefaultPort);
  if (!started && !command.port) started = server.start(folder, 0);
  if (!started)
    return fail(kMachineError,
                fmt::format("docs: {}. Choose another port with --port, or a free one with --port 0", started.error()));
  const std::string address = fmt::format("http://127.0.0.1:{}/", server.port());
  if (!print_result("{}\n", address)) return kSuccess;  // finish_command() reports it
  print_notice("serving {}; Ctrl+C ends", folder);
  if (!command.no_browser) open_browser(address);
  while (system::wait_for_signal(std::chrono::hours(1)) != system::Signal::terminate) {
  }
  return kSuccess;
}

}  // namespace limber::app
