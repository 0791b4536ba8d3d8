-- Motion capture.

---@page mocap

---Adds a dancer: a source of motion capture with its joints. At the top level of the scene only.
---@param name string # A name of your choice, unique among the sources.
---@param opts mocap_opts # `source`, and properties such as `offset`.
---@return mocap
---@error sim:add_mocap("dancer", { source = "absent.bvh" }) --> mocap 'dancer': there is no file 'absent.bvh'; looked for …
---@error sim:add_mocap("dancer", { source = "midi" }) --> mocap 'dancer': there is no dialect 'midi'; there are: osc, psn, vmc
---@error sim:add_mocap("dancer", { source = "osc", unit = "feet" }) --> add_mocap: unit is 'm', 'cm', 'mm', 'in', 'ft', or a number of meters, not 'feet'
---@error sim:add_mocap("dancer", { messages = { ["/a"] = "x y" } }) --> mocap 'dancer': /a: 'x' needs all 3 words of its vector
---@see mocap, sim:mocap
---@example mocap
function sim:add_mocap(name, opts) end

---Returns a source of motion capture by name or number (-1: the last).
---@param key string|integer|mocap # Its name, its number from 1, or -1 for the last.
---@return mocap
---@error sim:mocap("dancer") --> there is no mocap source 'dancer'; none exist
---@see sim.mocaps
---@example mocap
function sim:mocap(key) end

---A dancer, whose joints follow received messages or a BVH file.
---@class mocap
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field joints mocap_joint_list # read-only. Its joints, in the order in which they were found.
---@properties mocap
---@see sim:add_mocap
---@example mocap
local mocap_ = {}

---Returns a joint by name or number (-1: the last). If a source of messages has no joint of that name yet, it is expected
---from now on, and reported when it does not arrive.
---@param key string|integer|mocap_joint # Its name, its number from 1, or -1 for the last.
---@return mocap_joint
---@error sim:add_mocap("film", { source = "osc" }):joint(3) --> mocap 'film' has 0 joints; there is no 3
---@see mocap.joints
---@example mocap
function mocap_:joint(key) end

---Adds a body of kinematic parts that moves as the dancer: a capsule for each bone, with the name of the joint at its
---end, and a ball for a joint without a parent. Other parts collide with it.
---@param name string # A name of your choice, unique in the world.
---@param opts? mocap_body_opts # Such as `radius`.
---@return body
---@error sim:add_mocap("film", { source = "osc" }):add_body("film") --> add_body: mocap 'film' has no joints yet; list them with joints or bones
---@see mocap_joint
---@example mocap
function mocap_:add_body(name, opts) end

---@class mocap_body_opts: body_opts
---@field radius? number # default 0.04. Radius of the capsules, m.

---@class mocap_opts
---@field source? string # A BVH file (`"dance.bvh"`), `"osc"` for `/mocap/joint/pos_world` and similar addresses, `"vmc"`, or `"psn"` for PosiStageNet; `"psn:ADDR:PORT"` receives it there instead of at 236.10.10.10:56565.
---@field dancer? integer|string # For `"osc"`: N receives `/mocap/N/joint/…`; without it, `/mocap/joint/…`.
---@field messages? table<string, string> # For any other format: each address and the words that name its arguments.
---@field joints? string[] # Expected joints; messages without names have them in this order.
---@field bones? table[] # Parents: a list of `{ parent, child }` or `{ parent, child, length }`, m.
---@field up? "x"|"y"|"z" # The vertical axis of the source; default "z", for files, VMC and PosiStageNet "y".
---@field handed? "right"|"left" # default "right", for VMC and PosiStageNet "left".
---@field unit? "m"|"cm"|"mm"|"in"|"ft"|number # default "m"; a number: length of a unit in meters.
---@field quaternion? "wxyz"|"xyzw" # Order of quaternions of `"osc"`; default "wxyz".
---@opts mocap

---A joint of a dancer.
---@class mocap_joint
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field mocap mocap # read-only. The dancer that it belongs to.
---@field parent? mocap_joint # read-only. The joint that it is attached to, or nil.
---@field length number # read-only. Distance from its parent, m: in the first frame of a file, or as declared in `bones` (default 0.25).
---@properties mocap_joint
---@see mocap:joint
---@example mocap
local mocap_joint_ = {}

---@page lists

---The sources of motion capture of the scene.
---@class mocap_list
---@field [integer] mocap
---@overload fun(self: sim, wanted?: string|mocap|(string|mocap)[]): fun(): mocap, integer
---@see sim.mocaps
---@example mocap

---The joints of a dancer.
---@class mocap_joint_list
---@field [integer] mocap_joint
---@overload fun(self: mocap, wanted?: string|mocap_joint|(string|mocap_joint)[]): fun(): mocap_joint, integer
---@see mocap.joints
---@example mocap
