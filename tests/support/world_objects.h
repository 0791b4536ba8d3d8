// Includes the classes of all objects of a world.
#pragma once

#include "sim/behavior/behavior_list.h"
#include "sim/gears/gear_list.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/state/body_trees.h"
#include "sim/state/rebuild.h"
#include "sim/state/state_hash.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"
