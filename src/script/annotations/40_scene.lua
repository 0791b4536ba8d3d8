-- A scene's own parameters and state, and OSC.

---A parameter. Its default gives the type: number, boolean, vec3, or text with choices.
---@class param
---@field [1] string # Its name: letters, digits, _.
---@field [2] number|boolean|vec3like|string # Its default.
---@field min? number|vec3like
---@field max? number|vec3like
---@field step? number # Change per mouse wheel step.
---@field unit? string
---@field doc? string
---@field choices? string[]

---The scene's own parameters: declared once with `params { … }`, shown in this order in the panel, /scene/<name> over
---OSC.
---@class params
---@field [string] any
---@overload fun(list: param[])
params = {}

---Plain data of the scene; survives a reload, emptied by a reset.
---@type table<string, any>
state = {}

---@class osc
---@field address? string # read-only. During a handler: the message's address.
---@field sender? string # read-only. During a handler: the sender, such as 127.0.0.1:4000.
osc = {}

---Registers a handler for messages whose address matches the pattern; its arguments are numbers, text and booleans.
---Note that 0 is true in Lua.
---@param pattern string
---@param f fun(...: any)
function osc:on(pattern, f) end

---Sends a message to all targets.
---@param address string
---@param ... number|string|boolean|vec3like
function osc:send(address, ...) end

---Sends a message to the sender of the one being handled.
---@param address string
---@param ... number|string|boolean|vec3like
function osc:reply(address, ...) end

---Listens for OSC on a port of this machine, instead of the default.
---@param port integer # 1 .. 65535
function osc:listen(port) end

---@class stream_opts
---@field rate? number # Hz, 0.1 .. 1000, default 60.
---@field streams? string|string[] # Of pos, rot, relrot, relpos; default pos+rot+relrot.
---@field bodies? string|body # A name or a pattern, default all.
---@field bundle? integer|false|"off" # 1472, 8192 or 65504 bytes, or "off".
---@field errors? boolean # default false. Send error messages to this target too.

---Streams the joints' poses to a host, instead of the default.
---@param target string # host:port
---@param opts? stream_opts
function osc:stream_to(target, opts) end

---Returns an address to send to.
---@param target string # host:port
---@return address
function osc:to(target) end

---@class address
local address_ = {}

---Sends a message to this address only.
---@param address string
---@param ... number|string|boolean|vec3like
function address_:send(address, ...) end
