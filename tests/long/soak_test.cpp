// An hour of simulation time in minutes: many messages, added and removed bodies, constant memory.
#include <malloc.h>

#include <fstream>
#include <string>

#include "base/system/virtual_memory.h"
#include "engine/show.h"

namespace limber {
namespace {

using engine::test::Show;

constexpr int kMinute = 3600;  // ticks
constexpr int kHour = 60 * kMinute;

const char* const kBusyScene = R"lua(
local arm = sim:load_urdf(ARM, { name = "arm" })
local n, living = 0, {}
sim:on_step(function(dt)
  for i, motor in ipairs(arm.motors) do motor.target = 0.3 * math.sin(sim.time + i) end
  if sim.tick % 30 == 0 then
    n = n + 1
    living[#living + 1] = arm:copy("copy" .. n, { position = vec3(n % 7, 2 + n % 5, 0) })
    if #living > 4 then table.remove(living, 1):remove() end
  end
end)
osc:on("/hit", function(x) state.last = { x, tostring(x) } end)
)lua";

std::string busy_scene() { return fmt::format("local ARM = '{}/urdf/arm6.urdf'\n{}", LIMBER_SOURCE_DIR, kBusyScene); }

// twenty messages per tick: values, invalid ones, queries, handlers; determined by the tick number
void flood(Show& show, int tick) {
  for (int i = 0; i < 4; i++) {
    show.send("/physics/motor/angularservoposition", "arm", i + 1, 0.01 * (tick % 50));
    show.send("/physics/motor/angularservopositoin", "arm", i + 1, 1);
    show.send("/physics/body/copy*/part/*/friction", 0.1 + 0.001 * (tick % 300));
    show.send("/list/joints", "arm");
    show.send("/hit", tick);
  }
}

double heap() { return static_cast<double>(mallinfo2().uordblks); }

double resident() {
  std::ifstream statm("/proc/self/statm");
  double all = 0;
  double pages = 0;
  statm >> all >> pages;
  return pages * static_cast<double>(system::page_size());
}

TEST(Soak, MemoryIsFlatFromTheTenthMinuteOfAnHour) {
  const engine::test::SceneFile scene(busy_scene());
  Show show(scene.path());
  double heap_then = 0;
  double resident_then = 0;
  for (int tick = 0; tick < kHour; tick++) {
    flood(show, tick);
    show.ticks(1);
    show.sent_texts();
    if (tick == 10 * kMinute) {
      heap_then = heap();
      resident_then = resident();
    }
  }
  EXPECT_LT(heap(), 1.01 * heap_then);
  EXPECT_LT(resident(), 1.01 * resident_then);
  EXPECT_EQ(show.link.command_queue.dropped(), 0U);
  fmt::print("heap {:.3f} MB at minute 10, {:.3f} at the end; resident {:.1f} and {:.1f} MB\n", heap_then / 1e6,
             heap() / 1e6, resident_then / 1e6, resident() / 1e6);
}

TEST(Soak, QueriesAndErrorsDoNotChangeTheMotion) {
  const engine::test::SceneFile scene(busy_scene());
  Show quiet(scene.path());
  Show loud(scene.path());
  for (int tick = 0; tick < 10 * kMinute; tick++) {
    for (int i = 0; i < 20; i++) {
      loud.send("/physics/motor/angularservopositoin", "arm", i, 1);
      loud.send("/physics/part/mass", "missing", "tip", 1);
      loud.send("/list/parts", "arm");
    }
    loud.ticks(1);
    quiet.ticks(1);
    loud.sent_texts();
  }
  EXPECT_EQ(loud.engine.state_hash(), quiet.engine.state_hash());
}

}  // namespace
}  // namespace limber
