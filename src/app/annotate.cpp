// A scene that never runs tells its names; the tables tell the rest.
#include "app/annotate.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/output.h"
#include "base/text.h"
#include "engine/engine.h"
#include "script/annotate.h"

namespace limber {

namespace {

// what scripts ask of the outside leads nowhere here
struct Nobody : ScriptHost {
  void send(Message) override {}
  void reply(const Origin&, Message) override {}
  void send_direct(const Origin&, Message) override {}
  void plan_osc(const OscPlan&) override {}
  void ask_reset() override {}
  void script_error(std::string_view, int, std::string_view) override {}
};

}  // namespace

std::string annotations_text() {
  Store store;
  World world(store);
  Nobody host;
  Scene scene(world, host, {});
  return annotations(scene.names());
}

int annotate_command(const std::string& file) {
  const std::string text = annotations_text();
  if (file.empty()) {
    print_result("{}", text);
    return kFine;
  }
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out) return kFine;
  return fail(kMachine, fmt::format("{} can't be written; look at the folder's permissions", file));
}

}  // namespace limber
