// The Enttec DMX USB Pro, on pseudo-terminals.
#include "net/lighting/serial_sender.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/program.h"
#include "base/log/log.h"
#include "base/system/devices/serial_port.h"
#include "base/system/wait.h"
#include "engine/show.h"
#include "net/lighting/output.h"

namespace limber::lighting::test {
namespace {

using app::test::TempFolder;

constexpr const char* kLamp = R"(
local lamp = sim:add_fixture("lamp", { profile = "rgb_par", address = 3, dimmer = 1, rgb = vec3(1, 0, 0.2) })
)";

// An independent decoder, written from Enttec's "DMX USB Pro Widget API". Removes the first packet from `bytes`.
// Returns nothing if it is incomplete; adds a failure if a byte is wrong.
std::optional<std::vector<int>> next_packet(std::string& bytes) {
  const auto octet = [&](std::size_t at) { return static_cast<int>(static_cast<unsigned char>(bytes[at])); };
  if (bytes.size() < 5) return std::nullopt;
  const std::size_t length = static_cast<std::size_t>(octet(2) + 256 * octet(3));
  if (bytes.size() < length + 5) return std::nullopt;
  EXPECT_EQ(octet(0), 0x7e);
  EXPECT_EQ(octet(1), 6);
  EXPECT_TRUE(length >= 25 && length <= 513) << length;
  EXPECT_EQ(octet(4), 0) << "start code";
  EXPECT_EQ(octet(length + 4), 0xe7);
  std::vector<int> values;
  for (std::size_t i = 5; i < length + 4; i++) values.push_back(octet(i));
  bytes.erase(0, length + 5);
  return values;
}

// A pseudo-terminal in the place of the device.
class Device {
 public:
  Device() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    EXPECT_GE(master_, 0);
    EXPECT_EQ(grantpt(master_), 0);
    EXPECT_EQ(unlockpt(master_), 0);
    path_ = ptsname(master_);
  }
  ~Device() { close(master_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  const std::string& path() const { return path_; }

  /// Returns the values of the next packet, within `limit`.
  std::optional<std::vector<int>> next(std::chrono::milliseconds limit = std::chrono::seconds(20)) {
    for (;;) {
      if (auto packet = next_packet(bytes_)) return packet;
      system::PollEntry entry{.fd = master_};
      if (!system::wait_ready({&entry, 1}, limit)) return std::nullopt;
      char block[4096];
      const auto count = read(master_, block, sizeof block);
      if (count > 0) bytes_.append(block, static_cast<std::size_t>(count));
      if (count < 0 && limit.count() == 0) return std::nullopt;
    }
  }

 private:
  int master_;
  std::string path_;
  std::string bytes_;
};

std::string packet_of(std::uint8_t first) {
  const std::vector<std::uint8_t> values(512, first);
  std::string packet;
  write_enttec(values, packet);
  return packet;
}

std::vector<int> values_of(std::vector<int> first) {
  first.resize(24, 0);
  return first;
}

LightingOptions options_to(const std::string& device, const char* settings = "") {
  LightingOptions options;
  options.targets = parse_lights_out(fmt::format("enttec:{}{}", device, settings)).value();
  return options;
}

TEST(SerialSender, KeepsTheNewestPacketWhileThePortIsBusy) {
  Device device;
  SerialSender sender;
  ASSERT_TRUE(sender.open(device.path()).ok());
  int sent = 0;
  while (!sender.has_unsent() && sent < 10000) ASSERT_EQ(sender.send(packet_of(static_cast<std::uint8_t>(sent++))), 0);
  ASSERT_TRUE(sender.has_unsent()) << "no reader, so the port becomes full";
  for (int i = 0; i < 100; i++) ASSERT_EQ(sender.send(packet_of(200)), 0);
  ASSERT_EQ(sender.send(packet_of(201)), 0);
  int received = 0;
  int last = -1;
  while (last != 201) {
    const auto values = device.next();
    ASSERT_TRUE(values.has_value());
    ASSERT_EQ(values->size(), 512u);
    for (const int value : *values) ASSERT_EQ(value, values->front()) << "packets are never mixed";
    last = values->front();
    received++;
    ASSERT_EQ(sender.flush(), 0);
  }
  EXPECT_FALSE(sender.has_unsent());
  // on a busy machine, the system makes room later: for eight packets
  EXPECT_LT(received, sent + 50) << "most of the hundred were replaced";
}

TEST(SerialSender, ErrorsNameTheFix) {
  const TempFolder folder;
  SerialSender sender;
  EXPECT_EQ(sender.open(folder.path() + "/none").error(),
            "No such file or directory. Connect the device, or check the name");
  const std::string file = folder.path() + "/file";
  close(open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600));
  EXPECT_EQ(sender.open(file).error(), "it is not a serial port. Check the name");
  const Device device;
  ASSERT_TRUE(sender.open(device.path()).ok());
  SerialSender second;
  EXPECT_NE(second.open(device.path()).error().find("End th"), std::string::npos) << "locked";
  sender.close();
  EXPECT_TRUE(second.open(device.path()).ok());
}

TEST(SerialOutput, SendsOneUniverseOnceItIsArmedAndDarkAtTheEnd) {
  engine::test::SceneFile scene(std::string(kLamp) +
                                "sim:add_fixture('other', { profile = 'rgb_par', universe = 2, dimmer = 1 })\n");
  engine::test::Show show(scene.path());
  Device device;
  LightingOutput output(show.link, options_to(device.path()));
  output.start();
  show.ticks(3);
  while (show.link.lighting.state() != engine::LightingStatus::State::off) show.ticks(1);
  EXPECT_EQ(show.link.lighting.packets.load(), 0u);
  show.send("/lighting/armed", 1);
  show.ticks(1);
  const std::optional<std::vector<int>> first = device.next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(*first, values_of({0, 0, 255, 0, 51}));
  output.stop();
  std::vector<int> last = *first;
  while (const auto more = device.next(std::chrono::milliseconds(0))) last = *more;
  EXPECT_EQ(last, values_of({}));
}

std::size_t lines_with(const std::string& text, std::uint64_t since) {
  std::size_t count = 0;
  for (const LogLine& line : log_since(since)) count += line.text.find(text) != std::string::npos ? 1 : 0;
  return count;
}

TEST(SerialOutput, ReturnsWithItsDeviceAndReportsEachLossOnce) {
  log_to_stderr(false);
  const std::uint64_t since = log_newest();
  engine::test::SceneFile scene(kLamp);
  engine::test::Show show(scene.path());
  const TempFolder folder;
  const std::string name = folder.path() + "/ttyUSB0";
  LightingOutput output(show.link, options_to(name));
  output.start();
  while (show.link.lighting.state() != engine::LightingStatus::State::off) show.ticks(1);
  show.send("/lighting/armed", 1);
  show.ticks(1);
  for (int round = 0; round < 2; round++) {
    Device device;
    ASSERT_EQ(symlink(device.path().c_str(), name.c_str()), 0);
    const auto values = device.next();
    ASSERT_TRUE(values.has_value()) << round;
    EXPECT_EQ((*values)[2], 255);
    while (lines_with("is sent again", since) == static_cast<std::size_t>(round)) (void)device.next();
    ASSERT_EQ(unlink(name.c_str()), 0);
  }
  while (lines_with("is gone", since) < 2) show.ticks(1);
  output.stop();
  EXPECT_EQ(lines_with("can't be opened: No such file or directory. Connect the device", since), 1u);
  EXPECT_EQ(lines_with("is gone: ", since), 2u);
  EXPECT_EQ(lines_with("is sent again", since), 2u);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::lighting::test
