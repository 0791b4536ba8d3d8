-- `osc`: handlers of incoming messages, outgoing messages, ports and streams declared by a scene.
local P = ...
local ffi, api, ctx, answer, istype = P.ffi, P.api, P.ctx, P.answer, P.ffi.istype
local fail, describe = P.fail, P.describe

local handlers = {}
local address_now, sender_now

local function check_address(address, subject)
  P.check_text(address, subject)
  if string.byte(address, 1) ~= 47 then fail("%s: '%s' is not an address; it must begin with /", subject, address) end
  if #address > 1024 or address:find("[%c\128-\255 ]") then
    fail("%s: an address is up to 1024 characters of plain ASCII without blanks", subject)
  end
  return address
end

local function put(value, subject)
  local kind = type(value)
  if kind == "number" then return api.message_number(ctx, P.check_number(value, subject)) end
  if kind == "boolean" then return api.message_flag(ctx, value and 1 or 0) end
  if kind == "string" then return api.message_text(ctx, value, #value) end
  local v = P.as_vec3(value)
  if not v then fail("%s sends numbers, text, booleans and vec3s, not %s", subject, describe(value)) end
  api.message_number(ctx, P.check_number(v.x, subject))
  api.message_number(ctx, P.check_number(v.y, subject))
  api.message_number(ctx, P.check_number(v.z, subject))
end

-- the message is complete before it is sent: an invalid value sends nothing
local function send(subject, route, to, address, ...)
  P.needs_callback(subject)
  check_address(address, subject)
  api.message_begin(ctx, address, #address)
  for i = 1, select("#", ...) do put((select(i, ...)), subject) end
  P.handle_result(api.message_send(ctx, route, to))
end

local osc = {}
local members = { "address", "sender", "on", "send", "reply", "listen", "stream_to", "to" }
P.osc_members, P.osc_functions = members, osc
local function check(self, subject)
  if self ~= P.osc then fail("%s is a method of osc: write osc:%s(…), with a colon", subject, subject) end
end

function osc.on(self, pattern, f)
  check(self, "on")
  check_address(pattern, "osc:on")
  P.check_function(f, "osc:on")
  if P.is_earlier_run("osc:on") then return end
  P.journal(handlers)
  handlers[#handlers + 1] = { pattern = pattern, f = f, in_callback = answer.top_level == 0 }
  api.osc_handlers(ctx, #handlers)
end
-- removes all handlers; returns the number of those registered by callbacks
function P.remove_handlers()
  local removed = 0
  for i = #handlers, 1, -1 do
    if handlers[i].in_callback then removed = removed + 1 end
    handlers[i] = nil
  end
  api.osc_handlers(ctx, 0)
  return removed
end
function osc.send(self, address, ...)
  check(self, "send")
  send("osc:send", 0, nil, address, ...)
end
function osc.reply(self, address, ...)
  check(self, "reply")
  send("osc:reply", 1, nil, address, ...)
end
function osc.listen(self, port)
  check(self, "listen")
  P.needs_top_level("osc:listen")
  P.check_number(port, "osc:listen")
  if port < 1 or port > 65535 or port % 1 ~= 0 then
    fail("osc:listen takes a port 1 .. 65535, not %s", tostring(port))
  end
  api.osc_listen(ctx, port)
end

local stream_bits = { pos = 1, rot = 2, relrot = 4, relpos = 8 }
local stream_opts = { rate = true, streams = true, bodies = true, bundle = true, errors = true, messages = true }
local function streams_of(streams)
  if streams == nil then return 7 end
  local bits, seen = 0, {}
  if type(streams) == "string" then
    local list = {}
    for name in streams:gmatch("[^+, ]+") do list[#list + 1] = name end
    streams = list
  end
  if type(streams) ~= "table" then fail("osc:stream_to: streams is a list such as { 'pos', 'rot' }") end
  for _, name in ipairs(streams) do
    local bit = stream_bits[name]
    if not bit then
      fail("osc:stream_to: there is no stream '%s'%s", tostring(name), P.hint(name, P.sorted_keys(stream_bits)))
    end
    if not seen[name] then bits, seen[name] = bits + bit, true end
  end
  return bits
end
local message_opts = { address = true, objects = true, values = true, scale = true, per = true }
local max_messages, max_values = 64, 64
local function check_value(value, subject)
  P.check_text(value, subject)
  if value:find("{", 1, true) then return end
  if value:find("^%-?[%w_]+$") or value:find("^%-?[%w_]+%.[xyzw]$") then return end
  fail("%s is a property, such as 'position', 'position.x' or '-position.y', or a text with {name}, {body} or {index}, not '%s'",
    subject, value)
end
-- checks a template; returns what osc_template needs
local function check_message(message, i)
  local subject = "osc:stream_to: message " .. i
  if type(message) ~= "table" then fail("%s is a table such as { address = …, objects = …, values = … }", subject) end
  P.check_opts({ setters = {} }, message, message_opts, subject)
  P.check_text(message.address, subject .. ": address")
  if message.address:sub(1, 1) ~= "/" then fail("%s: address begins with /, not '%s'", subject, message.address) end
  P.check_text(message.objects, subject .. ": objects")
  if message.objects:sub(1, 1) ~= "/" then fail("%s: objects begins with /, not '%s'", subject, message.objects) end
  local values, per = message.values, message.per or "object"
  if type(values) == "string" then values = { values } end
  if type(values) ~= "table" or #values == 0 or #values > max_values then
    fail("%s: values is a list of 1 to %d properties", subject, max_values)
  end
  for k, value in ipairs(values) do check_value(value, subject .. ": value " .. k) end
  if per ~= "object" and per ~= "body" then fail("%s: per is 'object' or 'body', not %s", subject, describe(per)) end
  local scale = message.scale == nil and 1 or P.check_number(message.scale, subject .. ": scale")
  local list = table.concat(values, "\n")
  return { address = message.address, objects = message.objects, list = list, scale = scale, per_body = per == "body" }
end
local function add_messages(messages)
  if messages == nil then return end
  if type(messages) ~= "table" or #messages > max_messages then
    fail("osc:stream_to: messages is a list of at most %d templates", max_messages)
  end
  local checked = {}
  for i, message in ipairs(messages) do checked[i] = check_message(message, i) end
  for _, m in ipairs(checked) do
    api.osc_template(ctx, m.address, #m.address, m.objects, #m.objects, m.list, #m.list, m.scale, m.per_body and 1 or 0)
  end
end
local function bundle_of(bundle)
  if bundle == nil then return -1 end
  if bundle == false or bundle == "off" or bundle == 0 then return 0 end
  if bundle == 1472 or bundle == 8192 or bundle == 65504 then return bundle end
  fail("osc:stream_to: bundle is 'off', 1472, 8192 or 65504, not %s", describe(bundle))
end
function osc.stream_to(self, target, opts)
  check(self, "stream_to")
  P.needs_top_level("osc:stream_to")
  P.check_text(target, "osc:stream_to")
  P.check_opts({ setters = {} }, opts, stream_opts, "osc:stream_to")
  opts = opts or {}
  local rate = opts.rate == nil and 60 or P.check_number(opts.rate, "osc:stream_to: rate")
  if rate < 0.1 or rate > 1000 then fail("osc:stream_to: rate is 0.1 .. 1000, not %s", tostring(rate)) end
  local bodies = opts.bodies == nil and "*" or opts.bodies
  if P.class_of(bodies) == P.classes.body then bodies = bodies.name end
  P.check_text(bodies, "osc:stream_to: bodies")
  if opts.errors ~= nil and type(opts.errors) ~= "boolean" then fail("osc:stream_to: errors is true or false") end
  add_messages(opts.messages)
  -- with messages of its own, a target gets only the streams that are named
  local streams = opts.streams == nil and opts.messages and {} or opts.streams
  P.handle_result(api.osc_target(ctx, target, #target, rate, streams_of(streams), bodies, #bodies,
    bundle_of(opts.bundle), opts.errors and 1 or 0))
end

local A = ffi.typeof("address")
local parsed = ffi.new("struct LimberAddress")
local address_methods = {
  send = function(to, address, ...)
    if not istype(A, to) then fail("send is a method: write osc:to(\"host:port\"):send(…)") end
    send("osc:to():send", 2, to.to_, address, ...)
  end,
}
ffi.metatype(A, {
  __index = function(_, key)
    return address_methods[key] or fail("an address has no member '%s'%s", tostring(key), P.hint(key, { "send" }))
  end,
  __newindex = function() fail("an address has nothing to set") end,
  __tostring = function(a)
    api.address_text(ctx, a.to_)
    return P.text()
  end,
})
function osc.to(self, target)
  check(self, "to")
  P.check_text(target, "osc:to")
  P.handle_result(api.osc_address(ctx, target, #target, parsed))
  return A(parsed)
end

P.osc = setmetatable({}, {
  __index = function(_, key)
    if key == "address" then return address_now end
    if key == "sender" then return sender_now end
    return osc[key] or fail("osc has no member '%s'%s", tostring(key), P.hint(key, members))
  end,
  __newindex = function(_, key) fail("osc: '%s' can't be set", tostring(key)) end,
  __tostring = function() return "osc" end,
  __metatable = "osc",
})

P.on_failure[#P.on_failure + 1] = function() api.osc_handlers(ctx, #handlers) end

-- Calls every handler with a matching pattern. A handler that fails or is stopped is reported and disabled; its
-- messages still count as handled.
function P.exports.message(address, sender, ...)
  local handled = false
  local previous_address, previous_sender = address_now, sender_now
  address_now, sender_now = address, sender
  for i = 1, #handlers do
    local handler = handlers[i]
    local pattern = handler.pattern
    if pattern == address or api.osc_matches(ctx, pattern, #pattern, address, #address) ~= 0 then
      handled = true
      if not handler.disabled and not P.guarded(handler.f, ...) then
        api.report(ctx)
        handler.disabled = api.disable_handler(ctx) ~= 0
      end
    end
  end
  address_now, sender_now = previous_address, previous_sender
  return handled
end
jit.off(P.exports.message)
