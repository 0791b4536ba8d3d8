-- A scene's own parameters and state, and OSC.

---@page params

---A parameter. Its default gives the type: number, boolean, vec3, or text with choices.
---@class param
---@field [1] string # Its name: letters, digits, _.
---@field [2] number|boolean|vec3like|string # Its default.
---@field min? number|vec3like # Smallest value.
---@field max? number|vec3like # Largest value.
---@field step? number # Change per mouse wheel step.
---@field unit? string # A unit such as "m" or "N·s", shown in the panel.
---@field doc? string # One sentence about its purpose.
---@field choices? string[] # The words to choose from.
---@field rerun? boolean # default false. True: a change runs the scene file again.
---@see params
---@example sliders

---The scene's own parameters: declared once with `params { … }`, shown in this order in the panel, /scene/<name> over
---OSC.
---@class params
---@field [string] any
---@overload fun(list: param[])
---@error params { { "my height", 1 } } --> params: entry 1 begins with a name of letters, digits and _, not 'my height'
---@error params { { "gait", "walk" } } --> params: 'gait' is text, so it needs choices = { … }
---@see param, state
---@example sliders
params = {}

---Plain data of the scene; survives a reload, emptied by a reset.
---@type table<string, any>
---@see params
---@example state
state = {}

---@page results

---@class result_opts
---@field min number # Smallest value of the range.
---@field max number # Largest value of the range.
---@field cells? integer # 1 .. 1000, default 10. Number of equal cells of the range, for `limber evolve --descriptor`.

---Declares a number that the run returns: f is called once, at the end of the run. Call it at the top level of the scene.
---@param name string # Its name: letters, digits, _; unique among results.
---@param f fun(): number|boolean # Returns the value.
---@param opts? result_opts # A range, if the result can be a descriptor.
---@error result("distance", 3) --> result 'distance' takes a function, not 3
---@error result("my distance", print) --> result takes a name of letters, digits and _, not 'my distance'
---@error result("speed", print, { min = 1, max = 1 }) --> result 'speed': min is below max
---@see sim:record
---@example results
function result(name, f, opts) end

---A column of sim:record.
---@class record_column
---@field [1] string # Its name: letters, digits, _; unique among columns, and neither tick nor time.
---@field [2] fun(): number|boolean # Returns the value.
---@see sim:record
---@example results

---@class record_opts
---@field [integer] record_column
---@field rate? number # Hz, 0.001 .. 10000, default 60. Rows per simulated second, at most one per tick.

---Declares columns that the run records with `--out`: in each row the tick, the time and the value of each function,
---which is called before the physics step. Call it once, at the top level of the scene.
---@param columns record_opts # The columns, in their order, and the rate.
---@error sim:record {} --> sim:record takes a list of columns { "name", function() return … end }
---@error sim:record { { "time", print } } --> sim:record: each row has the column 'time' already
---@error sim:record { rate = 0, { "height", print } } --> sim:record: rate is 0.001 .. 10000 Hz, not 0
---@see result()
---@example results
function sim:record(columns) end

---@page osc

---OSC messages: handlers, and messages that the scene sends.
---@class osc
---@field address? string # read-only. During a handler: the message's address.
---@field sender? string # read-only. During a handler: the sender, such as 127.0.0.1:4000.
---@see osc:on
---@example osc_handlers
osc = {}

---Registers a handler for messages whose address matches the pattern; its arguments are numbers, text and booleans.
---Note that 0 is true in Lua.
---@param pattern string # An address, or a pattern such as `/light/*`.
---@param f fun(...: any) # The function to call with the arguments.
---@error osc:on("kick", print) --> osc:on: 'kick' is not an address; it must begin with /
---@see osc:reply, osc.sender
---@example osc_handlers
function osc:on(pattern, f) end

---Sends a message to all targets.
---@param address string # Such as `/light/1`.
---@param ... number|string|boolean|vec3like
---@error osc:send("/ball", 1) --> osc:send acts on the running scene; at the top level use sim:on_start(function() … end)
---@see address:send, osc:stream_to
---@example osc_sending
function osc:send(address, ...) end

---Sends a message to the sender of the one being handled.
---@param address string # Such as `/light/1`.
---@param ... number|string|boolean|vec3like
---@see osc:on
---@example osc_handlers
function osc:reply(address, ...) end

---Listens for OSC on a port of this machine, instead of the default.
---@param port integer # 1 .. 65535
---@error osc:listen(0) --> osc:listen takes a port 1 .. 65535, not 0
---@example osc_ports
function osc:listen(port) end

---@class stream_opts
---@field rate? number # Hz, 0.1 .. 1000, default 60.
---@field streams? string|string[] # Of pos, rot, relrot, relpos; default pos+rot+relrot.
---@field bodies? string|body # A name or a pattern, default all.
---@field bundle? integer|false|"off" # 1472, 8192 or 65504 bytes, or "off".
---@field errors? boolean # default false. Send error messages to this target too.
---@field messages? stream_message[] # Messages of your own; then `streams` is empty unless it is set.

---A template of messages: the values of each object that a pattern matches, in each frame.
---@class stream_message
---@field address string # With `{name}`, `{body}` and `{index}`, which become those of the object.
---@field objects string # Address or pattern of objects, such as "/physics/body/*/part/*".
---@field values string|string[] # Properties, such as "position", "rotation.w" or "-position.y", or texts with `{name}`, `{body}` or `{index}`.
---@field scale? number # default 1. Factor of all numbers: 100 for cm.
---@field per? "object"|"body" # default "object". "body": one message with the values of all objects of a body.
---@see osc:stream_to
---@example osc_templates

---Streams the joints' poses to a host, instead of the default.
---@param target string # host:port
---@param opts? stream_opts
---@error osc:stream_to("127.0.0.1:9104", { streams = "positions" }) --> osc:stream_to: there is no stream 'positions'; there are: pos, relpos, relrot, rot
---@error osc:stream_to("127.0.0.1:9104", { messages = { { address = "p", objects = "/physics/sim", values = "time" } } }) --> osc:stream_to: message 1: address begins with /, not 'p'
---@error osc:stream_to("127.0.0.1") --> '127.0.0.1' is not an address; write "host:port", such as "127.0.0.1:9000"
---@see stream_opts
---@example osc_ports
function osc:stream_to(target, opts) end

---Returns an address to send to.
---@param target string # host:port
---@return address
---@error osc:to("somewhere") --> 'somewhere' is not an address; write "host:port", such as "127.0.0.1:9000"
---@see address:send
---@example osc_sending
function osc:to(target) end

---An address to send to, made by osc:to.
---@class address
---@see osc:to
---@example osc_sending
local address_ = {}

---Sends a message to this address only.
---@param address string # Such as `/light/1`.
---@param ... number|string|boolean|vec3like
---@see osc:send
---@example osc_sending
function address_:send(address, ...) end
