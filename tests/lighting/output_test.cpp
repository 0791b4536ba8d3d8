// The output thread, received on loopback.
#include "net/lighting/output.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>

#include "base/system/net/udp_socket.h"
#include "base/system/wait.h"
#include "engine/show.h"
#include "lighting/decoder.h"

namespace limber::lighting::test {
namespace {

constexpr const char* kLitScene = R"(
local lamp = sim:add_fixture("lamp", { profile = "rgb_par", address = 3, dimmer = 1, rgb = vec3(1, 0, 0.2) })
)";

// A UDP socket on loopback.
struct Listener {
  Listener() : socket(std::move(*system::open_udp({0x7f000001, 0}))) {}
  std::string target(const char* protocol, const char* settings = "") const {
    return fmt::format("{}:127.0.0.1:{}{}", protocol, socket.local().port, settings);
  }
  /// Waits for the next packet.
  std::optional<std::string> next(std::chrono::seconds limit = std::chrono::seconds(20)) {
    system::PollEntry entry{.fd = socket.fd()};
    if (!system::wait_ready({&entry, 1}, limit)) return std::nullopt;
    char bytes[2048];
    const std::ptrdiff_t size = system::receive_bytes(socket.fd(), bytes, sizeof bytes);
    if (size <= 0) return std::nullopt;
    return std::string(bytes, static_cast<std::size_t>(size));
  }
  system::UdpSocket socket;
};

LightingOptions options_to(const Listener& listener, const char* protocol, bool lights = false) {
  LightingOptions options;
  options.targets = parse_lights_out(listener.target(protocol)).value();
  options.lights = lights;
  return options;
}

TEST(LightingOutput, SendsOnceItIsArmed) {
  engine::test::SceneFile scene(kLitScene);
  engine::test::Show show(scene.path());
  Listener listener;
  LightingOutput output(show.link, options_to(listener, "artnet"));
  output.start();
  show.ticks(3);
  while (show.link.lighting.state() != engine::LightingStatus::State::off) show.ticks(1);
  EXPECT_EQ(show.link.lighting.packets.load(), 0u);
  show.send("/lighting/armed", 1);
  show.ticks(1);
  const std::optional<std::string> packet = listener.next();
  ASSERT_TRUE(packet.has_value());
  const auto decoded = decode_art_dmx(*packet);
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->universe, 1);
  EXPECT_EQ(decoded->values, (std::vector<int>{0, 0, 255, 0, 51, 0}));
  EXPECT_EQ(show.link.lighting.state(), engine::LightingStatus::State::sending);
  output.stop();
  // the last packet is dark
  std::optional<std::string> last = packet;
  for (std::optional<std::string> more = listener.next(std::chrono::seconds(0)); more;
       more = listener.next(std::chrono::seconds(0)))
    last = more;
  EXPECT_EQ(decode_art_dmx(*last)->values, (std::vector<int>{0, 0, 0, 0, 0, 0}));
}

TEST(LightingOutput, WithoutArmingNothingIsSent) {
  engine::test::SceneFile scene(kLitScene);
  engine::test::Show show(scene.path());
  Listener listener;
  {
    LightingOutput output(show.link, options_to(listener, "sacn"));
    output.start();
    while (show.link.lighting.state() != engine::LightingStatus::State::off) show.ticks(1);
    show.ticks(60);
  }
  EXPECT_FALSE(listener.next(std::chrono::seconds(0)).has_value());
}

TEST(LightingOutput, SacnIsArmedFromTheStartWithTheOption) {
  engine::test::SceneFile scene(kLitScene);
  engine::EngineOptions engine_options = engine::test::fast_options(scene.path());
  engine_options.sets.push_back({"/lighting/armed", {Arg::of(true)}});
  engine::test::Show show(std::move(engine_options));
  show.ticks(1);
  Listener listener;
  LightingOutput output(show.link, options_to(listener, "sacn", true));
  output.start();
  const std::optional<std::string> packet = listener.next();
  ASSERT_TRUE(packet.has_value());
  const auto decoded = decode_sacn(*packet);
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->source, "Limber");
  EXPECT_EQ(decoded->values, padded({0, 0, 255, 0, 51}));
}

}  // namespace
}  // namespace limber::lighting::test
