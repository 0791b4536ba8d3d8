// Collects the Lua names from a scene that never runs and the properties from the tables.
#include "app/commands/commands.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/text.h"
#include "engine/engine.h"
#include "script/annotate.h"

namespace limber::app {

namespace {

// A host that discards all output; no script runs here.
struct NullHost : script::ScriptHost {
  void send(Message) override {}
  void reply(const CommandOrigin&, Message) override {}
  void send_direct(const CommandOrigin&, Message) override {}
  void configure_osc(const OscConfig&) override {}
  void request_reset() override {}
  void script_error(std::string_view, int, std::string_view) override {}
};

}  // namespace

std::string annotations_text() {
  Store store;
  sim::World world(store);
  NullHost host;
  script::Scene scene(world, host, {});
  return script::annotations(scene.names());
}

int annotate_command(const std::string& file) {
  const std::string text = annotations_text();
  if (file.empty()) {
    print_result("{}", text);
    return kSuccess;
  }
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out) return kSuccess;
  return fail(kMachineError, fmt::format("{} can't be written; check the folder's permissions", file));
}

}  // namespace limber::app
