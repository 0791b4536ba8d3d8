// A show with a MIDI service on fake ports and fake time.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/show.h"
#include "midi/fake_ports.h"
#include "net/midi/service.h"

namespace limber::midi::test {

inline constexpr const char* kMidiScene = R"(
params {
  { "wind", 0.5, min = 0, max = 1 },
  { "waves", 2, min = 0, max = 8 },
  { "mist", false },
}
osc:on("/note", function(...) osc:send("/heard", ...) end)
)";
inline constexpr const char* kNano = "nanoKONTROL2:nanoKONTROL2 MIDI 1";
inline constexpr std::int64_t kMilli = 1'000'000;  // ns

inline std::string map_of(const std::string& entries) { return "{\"limber midi\": 1, \"entries\": [" + entries + "]}"; }

class MidiRig {
 public:
  /// `map`: text of the map file; empty: none.
  /// `take`: name of a take to record; empty: none.
  explicit MidiRig(const std::string& map = "", MidiOptions options = {}, const std::string& take = "")
      : scene_(kMidiScene), show(engine_options(take)) {
    if (!map.empty()) write_map(map);
    devices.plug_in(kNano);
    service = std::make_unique<MidiService>(show.link, std::move(options), std::make_unique<FakePorts>(devices),
                                            [this] { return now; });
    service->set_scene(scene_.path());
    settle();
  }

  std::string take_path(const std::string& take) const {
    return (std::filesystem::path(scene_.path()).parent_path() / take).string();
  }
  std::string map_path() const { return MapFile::path_for(scene_.path()); }
  void write_map(const std::string& text) const { std::ofstream(map_path()) << text; }
  std::string map_text() const {
    std::ifstream in(map_path());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Lets time pass, in steps of at most 20 ms.
  void pass(std::int64_t milliseconds) {
    for (std::int64_t left = milliseconds; left > 0; left -= 20) {
      now += std::min<std::int64_t>(left, 20) * kMilli;
      service->update();
    }
  }
  /// Executes all messages, and passes their effect to the service.
  void settle() {
    service->update();
    const std::uint64_t request = show.link.request_value_snapshot();
    for (;;) {
      show.ticks(1);
      const auto snapshot = show.link.value_snapshots.read();
      if (snapshot != nullptr && snapshot->request >= request) break;
    }
    service->update();
  }
  /// The device sends bytes, which take effect.
  void move(const Bytes& bytes, const char* device = kNano) {
    EXPECT_TRUE(devices.send(device, bytes)) << device << " is not open";
    now += 2 * kMilli;
    settle();
  }
  /// Another controller sends a message, which takes effect.
  template <class... A>
  void send(std::string address, A&&... args) {
    show.send(std::move(address), std::forward<A>(args)...);
    settle();
  }
  double read(const std::string& path) { return show.read(path); }
  /// Returns what the devices have got in the time of feedback.
  Bytes feedback(const char* device = kNano) {
    devices.received(device);
    pass(400);
    return devices.received(device);
  }
  engine::MidiReport report() {
    pass(200);
    return show.link.midi.report();
  }

 private:
  engine::EngineOptions engine_options(const std::string& take) const {
    engine::EngineOptions options = engine::test::fast_options(scene_.path());
    if (!take.empty()) options.record = take_path(take);
    return options;
  }

  engine::test::SceneFile scene_;

 public:
  engine::test::Show show;
  FakeDevices devices;
  std::int64_t now = 1'000'000'000;  // ns
  std::unique_ptr<MidiService> service;
};

}  // namespace limber::midi::test
