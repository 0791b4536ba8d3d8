---@page index Lua reference: every function and property that scripts can use, with arguments, units, errors and examples.
---Each page begins with a list of its names; each name has an entry with its arguments and a scene that uses it. Save an
---example as `scripts/NAME.lua` and play it with `limber scripts/NAME.lua`. A comment `-->` shows the printed result.
---
---- Units are meters, kilograms, seconds, newtons and radians. Z points up. Coordinates are in the world frame unless an
---entry says otherwise.
---- Methods are called with a colon (`arm:copy("twin")`), properties are read and set with a dot (`arm.position`).
---- Square brackets in a signature mark arguments that may be omitted: `body:copy(name [, opts])`.
---- A table of options sets properties of the new object: `body:add_part("ball", shape, { mass = 2 })`.
---- A value outside the range of a property is clamped, and a warning reports it. A value of the wrong type, an unknown
---name, or an object that has been removed is an error; the message names the file, the line and the nearest known name.
---- Most functions that create objects belong to the top level of the scene, and those that act belong to callbacks, such
---as `sim:on_start(function() … end)`. The error of a call at the wrong place says so.
---- Each property is also an OSC address, which its entry names. `<body>` stands for the name of a body.
---- `limber console` evaluates any of these lines in a running scene, and `limber annotate` tells your editor all names.

---@page world The world: load robots, find bodies, and set gravity, time step and solver.
---The global `sim` is the world. It is also the place of the functions that create [shapes](shapes.md), attach
---[behaviors](behaviors.md) and register [callbacks](events.md).

---@page bodies Bodies: build, load, copy, find and remove bodies.
---A body is a named set of parts, with joints between them and motors on the joints. A single ball is a body of one part.

---@page parts Parts: mass, material, pose and velocity of rigid parts, and forces on them.

---@page shapes Shapes: plane, sphere, box, cylinder, capsule, cone, mesh and compound; colors.
---A shape is the geometry of parts. Several parts can use one shape; they have the same size and color then.

---@page joints Joints and gears: connect parts, limit their motion, couple joints.

---@page motors Motors: servo, spin and spring on each axis of a joint; read torques.
---The *own axis* of a joint is the one about or along which it moves. For most joints, `mode`, `target` and `speed` are all
---that you need. The other properties set each of the six axes.

---@page sensors Sensors: contact forces, accelerometers, range finders, zones, touch, and rays.
---A sensor belongs to a body and is mounted on one of its parts. Its readouts are properties: the panel shows and plots
---them, and they are OSC addresses. [Sensors](../../howto/sensors.md) shows how to use them.

---@page tendons Tendons: cables and springs through points on parts.
---A tendon pulls the parts that it goes through. Its tension is a property that can be played, for tentacles, puppets and
---tensegrities. [Tendons](../../howto/tendons.md) shows how to use them.

---@page fixtures Lighting fixtures: moving heads, lamps and their colors.
---A fixture aims at parts and points within the limits of its motors, and its values are sent to the lights.
---[Lighting](../../howto/lighting.md) shows how to use them.

---@page mocap Motion capture: dancers from BVH files and OSC, their joints, and bodies that follow them.
---A dancer is a node with joints, whose places, rotations and features are readouts. [Motion
---capture](../../howto/mocap.md) shows how to use them.

---@page policies Policies: let a trained network move a body.
---A policy computes actions from observations, with the same bits on every machine. [Policies](../../howto/policies.md)
---shows how to export and use them.

---@page clock Musical time: beats, bars and tempo, for motion in time with music.
---The beats pass by themselves, or another program leads them. [Musical time](../../howto/clock.md) shows how to use them.

---@page routes Routes: let readouts and settings set other properties, without code in each tick.
---A route reads a property and sets another one, in each tick. It is a node of the property tree: its settings are OSC
---addresses, and presets, undo and takes contain them. [Routes](../../howto/routes.md) shows how to use them.

---@page lists Lists and patterns: walk through bodies, parts, joints, motors, sensors, tendons, behaviors, gears, fixtures and routes.
---A list such as `body.parts` has numbers from 1 to `#body.parts`. Called like a function, with or without a pattern, it
---gives the objects one after the other: `for part in body:parts("leg*") do … end`. A pattern has `*` (any text), `?` (one
---character), `[1-3]`, `[!a]` and `{left,right}`. Instead of a pattern, it also accepts a list of names and objects.
---@example lists

---@page behaviors Behaviors: attach behaviors to a body or a group of bodies, and change their parameters.
---A behavior moves a body by itself. It is one of the [built-in behaviors](behavior_types.md) or a
---[file of behaviors_lua](behavior_files.md).

---@page behavior_types Built-in behaviors: each type with its parameters.
---The parameters are options of `body:add_behavior` and `sim:add_group_behavior`, properties of the behavior, and OSC
---addresses. All types also have the properties of [behavior](behaviors.md#behavior).
---@example behavior_types

---@page behavior_files Behaviors in Lua: write a behavior of your own as a file of behaviors_lua.
---The file `behaviors_lua/NAME.lua` returns `behavior { … }` and thereby defines the type `NAME`.

---@page events Events and timers: run functions at the start, in each tick, at contacts and at set times.
---Register functions at the top level of the scene; they are replaced when the file is saved. A function that fails is
---reported once and disabled until the next save.

---@page params Parameters and state: sliders for performers, and values that survive a save.

---@page results Results: numbers that a run returns, and columns that it records.
---`limber --out` writes them to files, `limber sweep` tabulates them for many parameters, and `limber evolve` searches for
---the best. [Experiments](../../howto/experiments.md) shows how to use them.

---@page osc OSC messages: receive, send and reply to messages, choose ports, stream poses.

---@page presets Presets and morphs: store, recall, morph and delete saved states of the show.

---@page visuals Camera and look: background, camera, light and ground.

---@page vectors Vectors, rotations and colors: vec3, quat, flags3 and rgb.

---@page math Numbers: clamp, interpolate, map, noise and random numbers.

---@page lua Lua's own functions: print, warn, require, and the libraries of Lua that scripts can use.
---Scripts are written in LuaJIT's Lua 5.1 with some functions of 5.2. They can't read or write files, start programs or
---load C libraries. `print` writes a line to the terminal, the console and the log. `require("steps")` loads
---`lib/steps.lua` beside the scene, or beside the behavior that requires it. `math.random` uses the generator of the scene, so
---each run with the same seed gives the same numbers. A call that runs longer than 50 ms is stopped and its effects are
---rolled back. The top level of a scene may take 5 s. All scripts of a scene together may use 64 MiB.
---@example libraries
