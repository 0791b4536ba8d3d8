// What the targets of OSCQuery share: a live world behind the hall, and two clients. What comes back is JSON or OSC,
// and the second client is served whatever the first one does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "fuzz/target.h"
#include "osc/encode.h"
#include "osc/receiver.h"
#include "osc/validate.h"
#include "query/hall.h"

namespace limber {

/// What a client is sent; each frame is looked at.
struct QueryLine : ClientLine {
  std::size_t bytes = 0;
  std::uint64_t values = 0;

  void send(bool text, std::string frame) override {
    bytes += frame.size();
    if (text) must(nlohmann::json::accept(frame));
    if (!text) must(packet_fault(frame.data(), frame.size()) == nullptr);
    if (!text && frame.starts_with("/physics/sim/seed")) values++;
  }
  std::size_t waiting() const override { return bytes; }
};

/// A world and two clients of it: one sends what the target gives it, the other listens to one value.
class FuzzedQueryDesk {
 public:
  FuzzedQueryDesk() {
    hall_.enter(client_);
    hall_.enter(other_);
    (void)other_.text(R"({"COMMAND":"LISTEN","DATA":"/physics/sim/seed"})");
  }
  ~FuzzedQueryDesk() {
    hall_.leave(client_);
    hall_.leave(other_);
  }

  FuzzedQueryDesk(const FuzzedQueryDesk&) = delete;
  FuzzedQueryDesk& operator=(const FuzzedQueryDesk&) = delete;

  Client& client() { return client_; }
  /// What has come takes effect; the other client is told of a value that is set now.
  void look() {
    const double seed = static_cast<double>(++seed_);
    show_.link.inbox.push({{{"/physics/sim/seed", {Arg::of(seed)}}, {"/physics/sim/paused", {Arg::of(true)}}}, {}});
    hall_.hurry();
    (void)engine_test::image_of(show_);
    line_.bytes = other_line_.bytes = 0;
    const std::uint64_t before = other_line_.values;
    hall_.bell();
    must(other_line_.values == before + 1);
  }
  /// After each input.
  void done() {
    if (++inputs_ % 16 == 0) look();
  }
  bool worn() { return inputs_ >= kRenewEvery || show_.engine.world().bodies().size() < 4; }

 private:
  static constexpr std::uint64_t kRenewEvery = 2048;  // inputs that a world sees

  QueryDoors doors() {
    QueryDoors doors;
    doors.encode = [this](const Message& message, std::string_view tags) {
      const auto packet = tags.empty() ? encode_message(message, buffer_) : encode_tagged(message, tags, buffer_);
      return std::string(packet.begin(), packet.end());
    };
    doors.take = [this](const Origin& origin, const std::string& packet) {
      receiver_.take(packet.data(), packet.size(), origin);
      receiver_.release_due();
    };
    return doors;
  }

  engine_test::SceneFile file_{engine_test::kEverything};
  engine_test::Show show_{file_.path()};
  NetClock clock_{[] { return std::int64_t{0}; }, [] { return std::uint64_t{1} << 63; }};
  Receiver receiver_{show_.link, {}, {[this](const Outgoing& out) { show_.link.push_out(out); }}, clock_};
  PacketBuffer buffer_;
  Hall hall_{show_.link, doors(), {}};
  QueryLine line_;
  QueryLine other_line_;
  Client client_{{Hand::query, 1, 1}, line_, hall_.doors()};
  Client other_{{Hand::query, 1, 2}, other_line_, hall_.doors()};
  std::uint64_t inputs_ = 0;
  std::uint64_t seed_ = 1000;
};

}  // namespace limber
