// Writes the definitions for editors and the Lua reference, with the names of a scene that never runs.
#include "app/commands/commands.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/text.h"
#include "engine/engine.h"
#include "script/annotate.h"
#include "script/reference/lua_reference.h"

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

// the names that scripts see
std::string script_names() {
  Store store;
  sim::World world(store);
  NullHost host;
  script::Scene scene(world, host, {});
  return scene.names();
}

// writes a file and creates its folder; an error ends the program with 3
int write_file(const std::filesystem::path& file, const std::string& text) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out) return kSuccess;
  return fail(kMachineError, fmt::format("{} can't be written; check the folder's permissions", file.string()));
}

}  // namespace

std::string annotations_text() { return script::annotations(script_names()); }

int annotate_command(const std::string& file) {
  const std::string text = annotations_text();
  if (!file.empty()) return write_file(file, text);
  print_result("{}", text);
  return kSuccess;
}

int lua_reference_command(const std::string& folder) {
  for (const script::ReferencePage& page : script::lua_reference(script_names()).pages) {
    if (const int code = write_file(std::filesystem::path(folder) / page.file, page.text); code != kSuccess)
      return code;
  }
  return kSuccess;
}

}  // namespace limber::app
