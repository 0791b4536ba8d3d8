// Maps Bullet's profile zones to phases: the outermost zone that has a phase counts.
#include "sim/bullet/bullet_phases.h"

#include <string_view>

#include "base/system/clock.h"
#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

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

// global, because Bullet's hooks are plain functions
struct PhaseMeasurement {
  BulletPhases phases;
  int level = 0;
  int zone_level = 0;  // level of the zone that is measured; 0: none
  double BulletPhases::*phase = nullptr;
  double start = 0;
};
PhaseMeasurement measurement;

void enter(const char* name) {
  measurement.level++;
  if (measurement.zone_level != 0) return;
  for (const Zone& zone : kZones) {
    if (zone.name != name) continue;
    measurement.zone_level = measurement.level;
    measurement.phase = zone.phase;
    measurement.start = system::clock_seconds();
    return;
  }
}

void leave() {
  if (measurement.level == measurement.zone_level) {
    measurement.phases.*measurement.phase += system::clock_seconds() - measurement.start;
    measurement.zone_level = 0;
  }
  measurement.level--;
}

}  // namespace

BulletPhaseCounter::BulletPhaseCounter() {
  measurement = {};
  btSetCustomEnterProfileZoneFunc(&enter);
  btSetCustomLeaveProfileZoneFunc(&leave);
}

BulletPhaseCounter::~BulletPhaseCounter() {
  btSetCustomEnterProfileZoneFunc([](const char*) {});
  btSetCustomLeaveProfileZoneFunc([] {});
}

const BulletPhases& BulletPhaseCounter::phases() const { return measurement.phases; }

}  // namespace limber::sim::bullet
