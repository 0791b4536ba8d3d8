// Bullet's profile zones as a handful of phases: the outermost zone that has a phase counts.
#include "sim/bullet_phases.h"

#include <string_view>

#include "base/system/clock.h"
#include "sim/bullet.h"

namespace limber {

namespace {

struct Zone {
  std::string_view name;
  double BulletPhases::*phase;
};

constexpr Zone kZones[] = {{"updateAabbs", &BulletPhases::broadphase},
                           {"calculateOverlappingPairs", &BulletPhases::broadphase},
                           {"dispatchAllCollisionPairs", &BulletPhases::narrowphase},
                           {"calculateSimulationIslands", &BulletPhases::islands},
                           {"solveConstraints", &BulletPhases::solver},
                           {"solveGroup", &BulletPhases::solver}};

// Bullet's hooks are bare functions
struct Counting {
  BulletPhases phases;
  int level = 0;
  int from = 0;  // level of the zone that counts; 0: none
  double BulletPhases::*phase = nullptr;
  double start = 0;
};
Counting counting;

void enter(const char* name) {
  counting.level++;
  if (counting.from != 0) return;
  for (const Zone& zone : kZones) {
    if (zone.name != name) continue;
    counting.from = counting.level;
    counting.phase = zone.phase;
    counting.start = system::clock_seconds();
    return;
  }
}

void leave() {
  if (counting.level == counting.from) {
    counting.phases.*counting.phase += system::clock_seconds() - counting.start;
    counting.from = 0;
  }
  counting.level--;
}

}  // namespace

BulletPhaseCounter::BulletPhaseCounter() {
  counting = {};
  btSetCustomEnterProfileZoneFunc(&enter);
  btSetCustomLeaveProfileZoneFunc(&leave);
}

BulletPhaseCounter::~BulletPhaseCounter() {
  btSetCustomEnterProfileZoneFunc([](const char*) {});
  btSetCustomLeaveProfileZoneFunc([] {});
}

const BulletPhases& BulletPhaseCounter::phases() const { return counting.phases; }

}  // namespace limber
