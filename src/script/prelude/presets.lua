-- `presets`: saved states of the show. Operations requested by a callback are carried out after the tick's callbacks.
local P = ...
local api, ctx = P.api, P.ctx
local fail, describe = P.fail, P.describe

local presets = {}
local members = { "store", "recall", "morph", "rename", "delete", "names" }
P.preset_members, P.preset_functions = members, presets

local function begin(self, operation)
  if self ~= P.presets then
    fail("%s is a method of presets: write presets:%s(…), with a colon", operation, operation)
  end
  P.needs_callback("presets:" .. operation)
  local address = "/preset/" .. operation
  api.message_begin(ctx, address, #address)
end

-- a preset by name or number
local function put_which(which, subject)
  if type(which) == "number" then return api.message_number(ctx, P.check_number(which, subject)) end
  if type(which) ~= "string" then
    fail("%s takes the name or the number of a preset, not %s", subject, describe(which))
  end
  api.message_text(ctx, which, #which)
end

local function finish(operation)
  if api.request_preset(ctx) ~= 0 then fail("presets:%s: %s", operation, P.text()) end
end

local store_opts = { rows = true, except = true, poses = true, velocities = true }
local function put_patterns(patterns, subject)
  for _, pattern in ipairs(type(patterns) == "table" and patterns or { patterns }) do
    P.check_text(pattern, subject)
    api.message_text(ctx, pattern, #pattern)
  end
end
local function put_flag(opts, key)
  local value = opts[key]
  if value ~= nil and type(value) ~= "boolean" then
    fail("presets:store: %s is true or false, not %s", key, describe(value))
  end
  if value then api.message_text(ctx, key, #key) end
end

function presets.store(self, name, opts)
  begin(self, "store")
  P.check_text(name, "presets:store: the name")
  P.check_opts({ setters = {} }, opts, store_opts, "presets:store")
  api.message_text(ctx, name, #name)
  if opts then
    if opts.rows == nil then api.message_text(ctx, "all", 3) end
    put_patterns(opts.rows, "presets:store: rows")
    put_flag(opts, "poses")
    put_flag(opts, "velocities")
    if opts.except ~= nil then
      api.message_text(ctx, "except", 6)
      put_patterns(opts.except, "presets:store: except")
    end
  end
  finish("store")
end

function presets.recall(self, which, seconds, easing)
  begin(self, "recall")
  put_which(which, "presets:recall")
  if seconds == nil and easing ~= nil then fail("presets:recall takes seconds before the easing") end
  if seconds ~= nil then api.message_number(ctx, P.check_number(seconds, "presets:recall: the seconds")) end
  if easing ~= nil then
    P.check_text(easing, "presets:recall: the easing")
    api.message_text(ctx, easing, #easing)
  end
  finish("recall")
end

function presets.morph(self, a, b, amount)
  begin(self, "morph")
  put_which(a, "presets:morph")
  put_which(b, "presets:morph")
  api.message_number(ctx, P.check_number(amount, "presets:morph: the amount"))
  finish("morph")
end

function presets.rename(self, which, name)
  begin(self, "rename")
  put_which(which, "presets:rename")
  P.check_text(name, "presets:rename: the new name")
  api.message_text(ctx, name, #name)
  finish("rename")
end

function presets.delete(self, which)
  begin(self, "delete")
  put_which(which, "presets:delete")
  finish("delete")
end

local function names()
  api.preset_names(ctx)
  local list = {}
  for name in P.text():gmatch("[^\n]+") do list[#list + 1] = name end
  return list
end

P.presets = setmetatable({}, {
  __index = function(_, key)
    if key == "names" then return names() end
    return presets[key] or fail("presets has no member '%s'%s", tostring(key), P.hint(key, members))
  end,
  __newindex = function(_, key) fail("presets: '%s' can't be set", tostring(key)) end,
  __tostring = function() return "presets" end,
  __metatable = "presets",
})
