// Runs the checks and prints their results.
#include "app/commands/commands.h"

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/show/query_host.h"
#include "app/view/window.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/math/fixed_math.h"
#include "base/plural.h"
#include "base/system/file.h"
#include "base/system/net/udp_socket.h"
#include "base/system/process.h"
#include "base/text.h"
#include "engine/output/engine_link.h"
#include "net/osc/network.h"
#include "net/oscquery/server.h"
#include "ui/panel/imgui/fonts.h"
#include "ui/render/gl.h"
#include "ui/render/offscreen.h"

namespace limber::app {

namespace {

void print_check(std::string_view status, std::string_view topic, std::string_view text) {
  print_result("{:4} {:10} {}\n", status, topic, text);
}

std::string system_name() {
  std::ifstream file("/etc/os-release");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("PRETTY_NAME=")) return line.substr(13, line.size() - 14);
  }
  return "an unknown system";
}

bool check_ports(const std::vector<ListenAddress>& osc_in, const std::optional<ListenAddress>& query_at) {
  engine::EngineLink link;
  osc::Network network(link, osc::OscOptions{.in = osc_in, .out = std::vector<StreamTarget>(), .allow = {}},
                       engine::transient_offsets());
  const Result<void> open = network.start();
  network.stop();
  if (open) {
    for (const ListenAddress& at : osc_in)
      print_check("ok", "ports", fmt::format("OSC in {} is free", system::host_port_text(at.address, at.port)));
  } else {
    print_check("fail", "ports", open.error());
  }
  if (!query_at) return open.ok();
  oscquery::QueryServer query(link, {});
  const Result<void> panel = query.start(*query_at);
  query.stop();
  if (panel) {
    print_check("ok", "ports",
                fmt::format("OSCQuery and remote panel {} (TCP) is free",
                            system::host_port_text(query_at->address, query_at->port)));
  } else {
    print_check("fail", "ports", panel.error());
  }
  return open.ok() && panel.ok();
}

void check_drawing(const std::string& gl) {
  const auto context = render::OffscreenContext::make(gl);
  if (context) {
    print_check(
        render::gl_is_software() ? "warn" : "ok", "OpenGL",
        fmt::format(
            "{} with {}{}", render::gl_driver(), render::gl_api_info((*context)->api()).name,
            render::gl_is_software() ? ": software rendering, slow; windows use --quality low by default" : ""));
  } else {
    print_check("warn", "OpenGL", context.error());
  }
  const panel::FontFiles fonts = panel::find_fonts();
  for (const std::string& line : fonts.warnings) print_check("warn", "fonts", line);
  if (fonts.warnings.empty()) print_check("ok", "fonts", "Inter and JetBrains Mono, for the panel");
  const bool video = !find_in_path("ffmpeg").empty();
  print_check(video ? "ok" : "warn", "ffmpeg",
              video ? "installed, for --render film.mp4"
                    : "not installed: --render can only write images; apt-get install ffmpeg");
}

}  // namespace

int doctor_command(const DoctorCommand& command) {
  const Result<std::vector<ListenAddress>> osc_in = osc::parse_osc_in(command.osc_in);
  if (!osc_in) return fail(kUsageError, osc_in.error());
  const Result<std::optional<std::vector<ListenAddress>>> query = parse_query(command.query);
  if (!query) return fail(kUsageError, query.error());

  print_check("ok", "limber", fmt::format("{} ({})", version(), commit()));
  print_check("ok", "system",
              fmt::format("{}, {}, {}{}", system_name(), system::machine_name(),
                          counted(std::thread::hardware_concurrency(), "core"),
                          system::is_portable() ? "; built with POSIX calls only" : ""));

  const bool exact = fixed::is_arithmetic_exact() && fixed::is_libm_replaced();
  print_check(
      exact ? "ok" : "fail", "arithmetic",
      exact
          ? "deterministic: the same scene, seed and commands give the same hash on every machine of this architecture"
          : "hashes and takes of other machines do not match: the program was compiled with -ffast-math or "
            "-ffp-contract, or without exporting its mathematical functions");

  const std::string data = data_dir();
  if (data.empty()) {
    print_check("fail", "data",
                "scripts/ and urdf/ not found next to the program or installed; run ./run, or cmake --install build");
  } else {
    print_check("ok", "data", data);
  }
  const bool ports = check_ports(*osc_in, query_address(*query, OscConfig{.listen = *osc_in, .targets = {}}));

  const std::optional<long> buffer = system::max_receive_buffer();
  constexpr long kWanted = 4194304;
  if (!buffer) {
    print_check("warn", "buffer", "the limit of socket buffers is unknown; long bursts may be lost");
  } else if (*buffer >= kWanted) {
    print_check("ok", "buffer",
                fmt::format("socket buffers of up to {} bytes: enough for bursts of 10 000 messages", *buffer));
  } else {
    print_check(
        "warn", "buffer",
        fmt::format("socket buffers of only up to {} bytes: bursts of more than some hundred messages may be lost; "
                    "raise the limit with sysctl -w net.core.rmem_max={}",
                    *buffer, kWanted));
  }
  print_check("ok", "display", Window::has_display() ? "available for the window" : "none; Limber plays headless");
  check_drawing(command.gl);
  return data.empty() || !ports ? kMachineError : kSuccess;
}

}  // namespace limber::app
