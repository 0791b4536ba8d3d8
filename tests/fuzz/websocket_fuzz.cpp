// Any frames of a WebSocket client into a live world: a kind (0 text, 1 binary, 2 an image) and a length of two bytes
// before each. What comes back is JSON or OSC, and a second client is served whatever the first one does.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "fuzz/target.h"
#include "osc/encode.h"
#include "osc/receiver.h"
#include "osc/validate.h"
#include "query/hall.h"

namespace {

using namespace limber;

constexpr std::uint64_t kRenewEvery = 2048;  // inputs that a world sees

// what a client is sent; each frame is looked at
struct Line : ClientLine {
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

class Desk {
 public:
  Desk() {
    hall_.enter(client_);
    hall_.enter(other_);
    (void)other_.text(R"({"COMMAND":"LISTEN","DATA":"/physics/sim/seed"})");
  }
  ~Desk() {
    hall_.leave(client_);
    hall_.leave(other_);
  }

  void input(std::string_view bytes) {
    while (bytes.size() >= 3) {
      const int kind = bytes[0] % 3;
      const std::size_t size = std::min<std::size_t>(
          static_cast<unsigned char>(bytes[1]) << 8 | static_cast<unsigned char>(bytes[2]), bytes.size() - 3);
      const std::string_view frame = bytes.substr(3, size);
      bytes.remove_prefix(3 + size);
      if (kind == 0) (void)client_.text(frame);
      if (kind == 1) client_.binary(frame);
      if (kind == 2) look();
    }
    if (++inputs_ % 16 == 0) look();
  }
  bool worn() { return inputs_ >= kRenewEvery || show_.engine.world().bodies().size() < 4; }

 private:
  // what has come takes effect; the other client is told of a value that is set now
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
  Line line_;
  Line other_line_;
  Client client_{{Hand::query, 1, 1}, line_, hall_.doors()};
  Client other_{{Hand::query, 1, 2}, other_line_, hall_.doors()};
  std::uint64_t inputs_ = 0;
  std::uint64_t seed_ = 1000;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return live_input<Desk>(bytes, size);
}
