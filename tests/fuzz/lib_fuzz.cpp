// Fuzzes the C interface of liblimber: calls its functions in random order, with random arguments, on two simulations.
// Checks that a failed call has a text, that values read back are finite, and that a restored state has its hash.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "fuzz/target.h"
#include "lib/limber.h"
#include "lib/scenes.h"

namespace limber {
namespace {

constexpr std::array kAddresses{"/physics/body/arm/motor/*/target",
                                "/physics/body/arm/joint/*/value",
                                "/physics/body/arm/part/*/position",
                                "/physics/body/arm/part/lower/rotation",
                                "/physics/sim/gravity",
                                "/physics/body/arm",
                                "//mass",
                                "/physics/sim/paused",
                                "/scene/reset",
                                "/physics/["};

class Calls {
 public:
  Calls(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  ~Calls() {
    for (const Sim& sim : sims_) limber_destroy(sim.sim);
  }
  Calls(const Calls&) = delete;
  Calls& operator=(const Calls&) = delete;

  void run() {
    while (at_ < size_) {
      Sim& sim = sims_[byte() % sims_.size()];
      if (sim.sim == nullptr) create(sim);
      call(sim, byte() % 12);
    }
  }

 private:
  struct Sim {
    limber_sim* sim = nullptr;
    std::vector<limber_property*> properties;
    std::map<limber_state*, std::uint64_t> states;  // with their hashes
  };

  std::uint8_t byte() { return at_ < size_ ? bytes_[at_++] : std::uint8_t{0}; }
  double number() {
    constexpr std::array<double, 9> kNumbers{0.0, 1.0, -1.0, 1e9, -1e300, 1e-310, HUGE_VAL, -HUGE_VAL, NAN};
    const std::uint8_t choice = byte();
    return choice < kNumbers.size() ? kNumbers[choice] : (choice - 128) / 32.0;
  }
  static void check(limber_status status) { must(status == LIMBER_OK || limber_last_error()[0] != 0); }

  static void create(Sim& sim) {
    limber_options options = LIMBER_OPTIONS;
    options.text = lib::test::kArm;
    check(limber_create(&options, &sim.sim));
    must(sim.sim != nullptr);
  }

  void call(Sim& sim, unsigned which) {
    switch (which) {
      case 0:
        return check(limber_step(sim.sim, byte() % 8));
      case 1:
        return find(sim);
      case 2:
        return access(sim);
      case 3:
        return send(sim);
      case 4:
        return save(sim);
      case 5:
        return restore(sim);
      case 6:
        return reset(sim);
      case 7:
        return receive(sim);
      case 8:
        if (sim.properties.empty()) return;
        limber_release(sim.properties.back());
        return sim.properties.pop_back();
      case 9:
        if (sim.states.empty()) return;
        limber_discard(sim.states.begin()->first);
        sim.states.erase(sim.states.begin());
        return;
      case 10:
        limber_destroy(sim.sim);
        sim = {};
        return;
      default:
        must(limber_time(sim.sim) >= 0 && limber_timestep(sim.sim) > 0);
    }
  }
  void find(Sim& sim) {
    limber_property* property = nullptr;
    check(limber_find(sim.sim, kAddresses[byte() % kAddresses.size()], &property));
    if (property != nullptr) sim.properties.push_back(property);
  }
  void access(Sim& sim) {
    if (sim.properties.empty()) return;
    limber_property* const property = sim.properties[byte() % sim.properties.size()];
    const std::size_t size = limber_count(property) * limber_width(property);
    std::vector<double> values(size);
    for (double& value : values) value = number();
    check(limber_write(property, values.data(), size - byte() % 2));
    if (limber_read(property, values.data(), size) == LIMBER_OK) {
      for (const double value : values) must(std::isfinite(value));
    }
  }
  void send(Sim& sim) {
    std::vector<limber_value> values(byte() % 5);
    for (limber_value& value : values) value = {static_cast<limber_value_kind>(byte() % 5), number(), "text"};
    check(limber_send(sim.sim, kAddresses[byte() % kAddresses.size()], values.data(), values.size()));
  }
  static void save(Sim& sim) {
    limber_state* state = nullptr;
    check(limber_save(sim.sim, &state));
    check(limber_hash(sim.sim, &sim.states[state]));
  }
  void restore(Sim& sim) {
    Sim& owner = byte() % 8 == 0 ? sims_[byte() % sims_.size()] : sim;
    if (owner.states.empty()) return;
    const limber_status status = limber_restore(sim.sim, owner.states.begin()->first);
    check(status);
    std::uint64_t hash = 0;
    check(limber_hash(sim.sim, &hash));
    must(status != LIMBER_OK || hash == owner.states.begin()->second);
  }
  void reset(Sim& sim) {
    const std::uint64_t seed = byte() == 0 ? ~std::uint64_t{0} : byte();
    check(limber_reset(sim.sim, byte() % 2 == 0 ? nullptr : &seed));
  }
  static void receive(Sim& sim) {
    limber_event event{};
    while (limber_next_event(sim.sim, &event) == LIMBER_OK) must(event.address[0] == '/');
    std::array<limber_contact, 4> contacts{};
    std::size_t count = 0;
    check(limber_contacts(sim.sim, contacts.data(), contacts.size(), &count));
  }

  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t at_ = 0;
  std::array<Sim, 2> sims_;
};

}  // namespace
}  // namespace limber

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  limber::Calls(bytes, size).run();
  return 0;
}
