// Shared by the OSCQuery fuzz targets: a live world with a QueryHub and two clients. Checks that all replies are valid
// JSON or OSC, and that the second client is served whatever the first one sends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "fuzz/target.h"
#include "net/osc/packets/encode.h"
#include "net/osc/packets/validate.h"
#include "net/osc/receiver.h"
#include "net/oscquery/hub.h"

namespace limber {

/// The connection to a client: checks that each frame is valid, and counts values of the seed.
struct CheckedSink : oscquery::ClientSink {
  std::size_t bytes = 0;
  std::uint64_t values = 0;

  void send(bool text, std::string frame) override {
    bytes += frame.size();
    if (text) must(nlohmann::json::accept(frame));
    if (!text) must(osc::packet_fault(frame.data(), frame.size()) == nullptr);
    if (!text && frame.starts_with("/physics/sim/seed")) values++;
  }
  std::size_t queued_bytes() const override { return bytes; }
};

/// A world with two clients: one sends the fuzzer's input, the other subscribes to one value.
class QueryFixture {
 public:
  QueryFixture() {
    hub_.add_client(client_);
    hub_.add_client(other_);
    (void)other_.on_text(R"({"COMMAND":"LISTEN","DATA":"/physics/sim/seed"})");
  }
  ~QueryFixture() {
    hub_.remove_client(client_);
    hub_.remove_client(other_);
  }

  QueryFixture(const QueryFixture&) = delete;
  QueryFixture& operator=(const QueryFixture&) = delete;

  oscquery::QueryClient& client() { return client_; }
  /// Executes pending commands; checks that the other client is notified of a changed value.
  void publish_snapshot() {
    const double seed = static_cast<double>(++seed_);
    show_.link.command_queue.push(
        {{{"/physics/sim/seed", {Arg::of(seed)}}, {"/physics/sim/paused", {Arg::of(true)}}}, {}});
    hub_.request_values();
    (void)engine::test::make_value_snapshot(show_);
    sink_.bytes = other_sink_.bytes = 0;
    const std::uint64_t before = other_sink_.values;
    hub_.on_link_event();
    must(other_sink_.values == before + 1);
  }
  /// Called after each input.
  void end_input() {
    if (++inputs_ % 16 == 0) publish_snapshot();
  }
  bool needs_renewal() { return inputs_ >= kRenewEvery || show_.engine.world().bodies().size() < 4; }

 private:
  static constexpr std::uint64_t kRenewEvery = 2048;  // inputs per world

  oscquery::QueryHost host() {
    oscquery::QueryHost host;
    host.encode = [this](const Message& message, std::string_view tags) {
      const auto packet =
          tags.empty() ? osc::encode_message(message, buffer_) : osc::encode_tagged(message, tags, buffer_);
      return std::string(packet.begin(), packet.end());
    };
    host.process = [this](const CommandOrigin& origin, const std::string& packet) {
      receiver_.process(packet.data(), packet.size(), origin);
      receiver_.process_pending();
    };
    return host;
  }

  engine::test::SceneFile file_{engine::test::kEverything};
  engine::test::Show show_{file_.path()};
  osc::NetClock clock_{[] { return std::int64_t{0}; }, [] { return std::uint64_t{1} << 63; }};
  osc::Receiver receiver_{show_.link, {}, {[this](const engine::Outgoing& out) { show_.link.push_out(out); }}, clock_};
  osc::PacketBuffer buffer_;
  oscquery::QueryHub hub_{show_.link, host(), {}};
  CheckedSink sink_;
  CheckedSink other_sink_;
  oscquery::QueryClient client_{{CommandSource::oscquery, 1, 1}, sink_, hub_.host()};
  oscquery::QueryClient other_{{CommandSource::oscquery, 1, 2}, other_sink_, hub_.host()};
  std::uint64_t inputs_ = 0;
  std::uint64_t seed_ = 1000;
};

}  // namespace limber
