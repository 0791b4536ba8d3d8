// Text with addresses: of targets that messages add, of listen addresses and ranges, and addresses alone. Accepted
// addresses have a text that gives the same address again; errors have a text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "fuzz/target.h"
#include "net/osc/targets/target_edits.h"

namespace {

using limber::ListenAddress;
using limber::must;
using limber::Result;
using limber::StreamTarget;
using limber::osc::Cidr;

void check_address(std::string_view text) {
  const auto ip = limber::osc::parse_ip(text);
  must(!ip || limber::osc::parse_ip(limber::osc::ip_text(*ip)) == ip);
  must(!ip || limber::system::is_ip_address(text));
}

void check_listen(const ListenAddress& address) {
  check_address(address.address);
  const std::string text = limber::osc::host_port_text(address.address, address.port);
  const Result<std::vector<ListenAddress>> again = limber::osc::parse_osc_in(text);
  must(again && *again == std::vector<ListenAddress>{address});
}

void check_target(std::string_view text) {
  const Result<StreamTarget> target = limber::osc::parse_target(text, {});
  must(target || !target.error().empty());
  limber::osc::TargetEdits edits;
  const limber::Message message{"/osc/target/add", {limber::Arg::of(text)}};
  if (!edits.push(message, {}) || !edits.execute(message, {})) return;
  must(target && edits.applied_to({}) == std::vector<StreamTarget>{*target});
  must(target->port != 0 && !target->host.empty() && target->rate >= 0.1 && target->rate <= 1000);
  const std::string end = limber::osc::host_port_text(target->host, target->port);
  const limber::Message remove{"/osc/target/remove", {limber::Arg::of(end)}};
  must(edits.execute(remove, {*target}).ok() && edits.applied_to({}).empty());
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check_address(text);
  check_target(text);
  if (const auto listen = limber::osc::parse_osc_in(text)) {
    for (const ListenAddress& address : *listen) check_listen(address);
  }
  if (const auto ranges = limber::osc::parse_osc_allow(text)) {
    for (const Cidr& range : *ranges)
      must(range.contains(range.ip) && range.bits >= 0 && range.bits <= (range.ip.is_v6 ? 128 : 32));
  }
  return 0;
}
