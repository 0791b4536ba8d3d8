// The doctor's findings.
#include "app/doctor.h"

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
#include "app/query_doors.h"
#include "app/window.h"
#include "base/build_info.h"
#include "base/fixed_math.h"
#include "base/output.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/udp_socket.h"
#include "base/text.h"
#include "engine/link.h"
#include "gui/fonts.h"
#include "osc/network.h"
#include "query/server.h"
#include "view/gl.h"
#include "view/offscreen.h"

namespace limber {

namespace {

void finding(std::string_view mark, std::string_view what, std::string_view text) {
  print_result("{:4} {:10} {}\n", mark, what, text);
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
  EngineLink link;
  Network network(link, OscOptions{.in = osc_in, .out = std::vector<StreamTarget>(), .allow = {}}, live_offsets());
  const Result<void> open = network.start();
  network.stop();
  if (open) {
    for (const ListenAddress& at : osc_in)
      finding("ok", "ports", fmt::format("OSC in {}:{} is free", at.address, at.port));
  } else {
    finding("no", "ports", open.error());
  }
  if (!query_at) return open.ok();
  QueryServer query(link, {});
  const Result<void> panel = query.start(*query_at);
  query.stop();
  if (panel) {
    finding("ok", "ports",
            fmt::format("OSCQuery and remote panel {}:{} (TCP) is free", query_at->address, query_at->port));
  } else {
    finding("no", "ports", panel.error());
  }
  return open.ok() && panel.ok();
}

void check_drawing(const std::string& gl) {
  const auto context = Offscreen::make(gl);
  if (context) {
    finding(gl_is_software() ? "mind" : "ok", "OpenGL",
            fmt::format("{} with {}{}", gl_driver(), gl_api_info((*context)->api()).name,
                        gl_is_software() ? ": software, slow; windows begin with --quality low" : ""));
  } else {
    finding("mind", "OpenGL", context.error());
  }
  const FontFiles fonts = find_fonts();
  for (const std::string& line : fonts.said) finding("mind", "fonts", line);
  if (fonts.said.empty()) finding("ok", "fonts", "Inter and JetBrains Mono, for the panel");
  const bool video = !find_in_path("ffmpeg").empty();
  finding(video ? "ok" : "mind", "ffmpeg",
          video ? "there, for --render film.mp4" : "not there: --render makes stills only; apt-get install ffmpeg");
}

}  // namespace

int doctor_command(const DoctorCommand& command) {
  const Result<std::vector<ListenAddress>> osc_in = parse_osc_in(command.osc_in);
  if (!osc_in) return fail(kUsage, osc_in.error());
  const Result<std::optional<std::vector<ListenAddress>>> query = parse_query(command.query);
  if (!query) return fail(kUsage, query.error());

  finding("ok", "limber", fmt::format("{} ({})", version(), commit()));
  finding("ok", "system",
          fmt::format("{}, {}, {} cores{}", system_name(), system::machine_name(), std::thread::hardware_concurrency(),
                      system::is_portable() ? "; built with POSIX calls only" : ""));

  const bool exact = fixed::is_arithmetic_exact() && fixed::is_libm_replaced();
  finding(exact ? "ok" : "no", "arithmetic",
          exact ? "as on every machine of this architecture: a scene, a seed and its commands give the same hash"
                : "hashes and takes of other machines do not match: the program was compiled with -ffast-math or "
                  "-ffp-contract, or without exporting its mathematical functions");

  const std::string data = data_dir();
  if (data.empty()) {
    finding("no", "data",
            "scripts/ and urdf/ are not beside the program nor installed; call ./run, or cmake --install build");
  } else {
    finding("ok", "data", data);
  }
  const bool ports = check_ports(*osc_in, query_address(*query, OscPlan{.listen = *osc_in, .targets = {}}));

  const std::optional<long> buffer = system::max_receive_buffer();
  constexpr long kWanted = 4194304;
  if (!buffer) {
    finding("mind", "buffer", "this system does not tell how large a socket's buffer may be; long bursts may be lost");
  } else if (*buffer >= kWanted) {
    finding("ok", "buffer",
            fmt::format("the kernel grants {} bytes to a socket: bursts of 10 000 messages come through", *buffer));
  } else {
    finding("mind", "buffer",
            fmt::format("the kernel grants {} bytes to a socket, bursts over some hundred messages may be lost; "
                        "sysctl -w net.core.rmem_max={} lifts that",
                        *buffer, kWanted));
  }
  finding("ok", "display", Window::has_display() ? "there is one, for the window" : "none; Limber plays headless");
  check_drawing(command.gl);
  return data.empty() || !ports ? kMachine : kFine;
}

}  // namespace limber
