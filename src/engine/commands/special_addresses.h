// The special addresses: those that are not derived from a property.
#pragma once

#include <string_view>

namespace limber::engine {

struct SpecialAddress {
  std::string_view address;
  std::string_view args;
  std::string_view doc;
};

inline constexpr SpecialAddress kSpecialAddresses[] = {
    {"/physics/part/force", "[body] [part] x y z [rx ry rz]",
     "Applies a force in N for one tick, world axes; rx ry rz: point of application relative to the center of mass."},
    {"/physics/part/hold", "body part x y z tx ty tz",
     "A spring pulls the point x y z (in the part's frame) to tx ty tz (in the world). It is removed half a second "
     "after the last message."},
    {"/physics/part/release", "body part", "Removes the spring of a part."},
    {"/physics/behavior/parameter", "[body] behavior parameter value",
     "Sets a parameter (or active) of the behavior of that name, in every body or in one."},
    {"/visuals/camera/projection", "fovy aspect near far",
     "Sets these properties of the camera; an aspect of 0: that of the window."},
    {"/get", "path", "Answers with address and value of each property that the path or pattern matches."},
    {"/list/bodies", "", "Answers with the names of all bodies, in stream order."},
    {"/list/parts", "body", "Answers with the body and the names of its parts."},
    {"/list/joints", "body", "Answers with the body and the names of its joints, in stream order."},
    {"/list/motors", "body", "Answers with the body and the names of its motors."},
    {"/list/sensors", "body", "Answers with the body and the names of its sensors."},
    {"/list/tendons", "body", "Answers with the body and the names of its tendons."},
    {"/list/behaviors", "body", "Answers with the body and the names of its behaviors, in execution order."},
    {"/list/gears", "", "Answers with the names of the gears."},
    {"/list/fixtures", "", "Answers with the names of the lighting fixtures."},
    {"/list/groups", "", "Answers with the names of the group behaviors."},
    {"/list/routes", "", "Answers with the names of the routes."},
    {"/list/shapes", "", "Answers with the names of the shapes."},
    {"/list/scenes", "", "Answers with the names of the scenes in the folder of the current scene."},
    {"/transport/scene", "scene", "Starts another scene of that folder and drops all overrides."},
    {"/list/health", "",
     "Answers with everything that was dropped, reduced, disabled or lost: name, count and age in seconds of each."},
    {"/list/presets", "", "Answers with the names of the presets, in their order."},
    {"/list/cues", "", "Answers with the names of the cues, in their order."},
    {"/preset/store", "name [pattern ...] [behaviors] [looks] [poses] [velocities] [except pattern ...]",
     "Stores the current values of all properties, or of the selected ones, under that name."},
    {"/preset/recall", "name [seconds [easing]]",
     "Recalls a preset, at once or over a time in seconds, with the easing smooth, linear, in or out."},
    {"/preset/morph", "preset preset amount", "Blends two presets; amount 0: the first, 1: the second."},
    {"/preset/delete", "name", "Deletes a preset."},
    {"/preset/rename", "name name", "Renames a preset, given by name or number. Its values and its position stay."},
    {"/route/add", "name from to", "Adds a route from one address or pattern to another."},
    {"/route/connect", "name from to", "Gives a route other addresses; its settings stay."},
    {"/route/remove", "name", "Removes a route."},
    {"/cue/jump", "cue", "Starts a cue, given by name or number."},
    {"/cue/add", "name [preset]", "Adds a cue to the cue file, after the one that has run last."},
    {"/cue/remove", "cue", "Removes a cue from the cue file."},
    {"/cue/move", "cue number", "Moves a cue, so that it has this number."},
    {"/cue/set", "cue field value", "Sets a field of a cue in the cue file; nil or an empty text removes it."},
    {"/midi/learn", "address [component] [mode]",
     "The next MIDI control that moves sets this address from now on; component: of a vector, from 1; mode: absolute, "
     "relative, relative_offset, relative_sign, toggle, momentary or trigger. Without arguments: stops learning."},
    {"/midi/forget", "address [component]", "Removes the MIDI controls of an address."},
    {"/list/targets", "", "Answers with the targets of OSC output and their settings, in their order."},
    {"/osc/target/add", "target [setting ...]",
     "Adds a target of OSC output, such as 192.168.1.5:9005, or changes the settings of one: rate=30, streams=pos+rot, "
     "bodies=arm*, bundle=1472, errors=on."},
    {"/osc/target/remove", "target", "Removes a target of OSC output, given by host and port."},
    {"/osc/target/reset", "", "Restores the targets of the command line or the scene."},
    {"/take/record", "[name]", "Resets the scene and records all input from its start, so that it can be replayed."},
    {"/take/stop", "", "Ends the recording of a take and completes its file, or ends the take that plays."},
    {"/take/play", "[name]",
     "Plays a take from the show's folder instead of the show; the latest one if no name is given."},
};

}  // namespace limber::engine
