// Fuzzes the reader of fixture profiles. Input: a .fixture file. A valid profile is put into a world and moved.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/visuals/visuals.h"
#include "support/world_objects.h"

namespace {

void move(const std::shared_ptr<const limber::sim::FixtureProfile>& profile) {
  limber::Store store;
  limber::sim::World world(store);
  limber::sim::FixtureList& fixtures = world.visuals().fixtures();
  const auto fixture = fixtures.add("fixture", profile, {}, {});
  limber::must(fixture.ok());
  for (const char* property : {"pan_target", "tilt_target", "dimmer", "zoom", "strobe"}) {
    const double value = 77;
    (void)store.set((*fixture)->id(), property, {&value, 1});
  }
  for (int i = 0; i < 20; i++) fixtures.step(0.05);
  limber::must(fixtures.frame().universes.size() == 1);
  limber::must(fixtures.frame().universes[0].length == profile->channels.size());
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto profile = limber::sim::parse_fixture_profile("fuzz", {reinterpret_cast<const char*>(data), size});
  if (!profile) return 0;
  limber::must(!(*profile)->channels.empty() && (*profile)->channels.size() <= 512);
  for (const auto& axis : {(*profile)->pan, (*profile)->tilt})
    limber::must(axis.range == 0 || (axis.range >= 1 && axis.speed > 0 && axis.acceleration > 0));
  limber::must((*profile)->beam_low > 0 && (*profile)->beam_low <= (*profile)->beam_high);
  move(*profile);
  return 0;
}
