// A reproducible flood of valid, invalid and mutated datagrams from several senders, and a scene that counts those it
// receives.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/random.h"
#include "engine/commands/command.h"
#include "net/osc/packets/decode.h"
#include "osc/bad_packets.h"
#include "osc/osc_test_tools.h"

namespace limber::app::test {

inline constexpr const char* kFloodScene = R"(
params { { "wind", 0, min = 0, max = 1000000 } }
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", shape, { mass = 0, position = vec3(0, 0, 2) })
arm:add_part("tip", shape, { position = vec3(0, 0, 1) })
arm:add_motor(arm:add_joint("elbow", "base", "tip", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) }))
local hits, mutants = 0, 0
osc:on("/hit", function() hits = hits + 1 end)
osc:on("/mut", function() mutants = mutants + 1 end)
osc:on("/count", function() osc:reply("/count", hits, mutants) end)
)";

/// Generates datagrams; the n-th one is always the same. Of ten, one is a value, one a value by pattern, two are for a
/// handler of the scene, one has an unknown address, one is rejected, two are invalid OSC and two are mutants. Each
/// valid datagram contains one message. [one thread]
class Flood {
 public:
  enum class Kind { hit, value, unknown, rejected, malformed, mutant };
  static constexpr std::array<Kind, 10> kKinds = {Kind::hit,      Kind::value,    Kind::mutant, Kind::malformed,
                                                  Kind::rejected, Kind::hit,      Kind::value,  Kind::unknown,
                                                  Kind::mutant,   Kind::malformed};

  explicit Flood(std::uint64_t seed) : random_(seed) {
    for (const osc::test::BadPacket& bad : osc::test::bad_packets()) {
      // large ones fill the kernel's buffer, which another test covers
      if (bad.bytes.size() < 2048) bad_.push_back(bad.bytes);
    }
  }

  static Kind kind(std::size_t n) { return kKinds[n % kKinds.size()]; }
  /// Returns the number of datagrams of that kind among the first `count`.
  static std::size_t count_of(Kind kind, std::size_t count) {
    std::size_t found = 0;
    for (std::size_t n = 0; n < count; n++) found += Flood::kind(n) == kind ? 1 : 0;
    return found;
  }

  std::string next() {
    using osc::test::Bytes;
    const std::size_t n = n_++;
    const auto number = static_cast<float>(n % 100) / 100;
    switch (kind(n)) {
      case Kind::hit:
        return Bytes().text("/hit").text(",if").u32(static_cast<std::uint32_t>(n)).f(number).str();
      case Kind::value:
        if (n % 2 == 0) return osc::test::one_float("/physics/body/*/part/*/friction", number);
        return Bytes()
            .text("/physics/motor/angularservoposition")
            .text(",ssf")
            .text("arm")
            .text("elbow")
            .f(number)
            .str();
      case Kind::unknown:
        return osc::test::one_float("/physics/motor/angularservopositoin", number);
      case Kind::rejected:
        return Bytes().text("/physics/part/mass").text(",ssf").text("missing").text("tip").f(number).str();
      case Kind::malformed:
        return bad_[n / 5 % bad_.size()];
      case Kind::mutant:
        return mutant();
    }
    return {};
  }

 private:
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_.next() % limit); }

  // a message for the handler with some bytes changed, removed or added; its address never matches a property
  std::string mutant() {
    std::string bytes = osc::test::Bytes().text("/mut").text(",ifsT").u32(7).f(0.5F).text("word").str();
    for (std::size_t i = below(4); i > 0; i--) {
      const std::size_t at = below(bytes.size());
      // letters only, also in the padding, so that the address is no pattern
      const bool in_address = at >= 1 && at <= 6;
      bytes[at] = static_cast<char>(in_address ? 'k' + below(16) : below(256));
    }
    if (below(4) == 0) bytes.resize(below(bytes.size() + 1));
    if (below(8) == 0) bytes.append(1 + below(8), static_cast<char>(below(256)));
    return bytes;
  }

  Random random_;
  std::vector<std::string> bad_;
  std::size_t n_ = 0;
};

/// Where the datagrams went; `hits` and `mutants` are counted by the scene's handlers.
struct FloodSum {
  std::uint64_t sent = 0;
  std::uint64_t values = 0;
  std::uint64_t hits = 0;
  std::uint64_t mutants = 0;
  std::uint64_t unknown = 0;
  std::uint64_t rejected = 0;
  std::uint64_t malformed = 0;
  std::uint64_t dropped = 0;
  std::uint64_t dropped_kernel = 0;

  std::uint64_t total() const {
    return values + hits + mutants + unknown + rejected + malformed + dropped + dropped_kernel;
  }
};

}  // namespace limber::app::test
