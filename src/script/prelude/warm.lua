-- Compiles metamethods ahead of time. LuaJIT can't record a metamethod alone when a script's operator calls it, because
-- it does not return to a Lua function; after some thousand failed attempts it blacklists the callers, and a loop over
-- many parts would be interpreted permanently, some hundred times slower. Recorded here by plain calls, each metamethod
-- becomes a trace of its own, which compiled loops can include.
local P = ...
local V, Q, F, ffi = P.V, P.Q, P.F, P.ffi

local kCalls = 150  -- more than needed to make a function hot

-- interpreted, so that only the called functions are recorded
local function call_often(f, a, b, c)
  for _ = 1, kCalls do f(a, b, c) end
end
jit.off(call_often)

-- a class with trivial members; all classes share the code of their metamethods
local function nothing() return 0 end
local dummy = { name = "warm", getters = { x = nothing }, setters = { x = nothing }, methods = { m = nothing },
  properties = {}, ctype = ffi.typeof("struct { const int32_t slot_, generation_; }") }
P.finish_class(dummy)

local calls = {}
local function warm(ctype, name, ...)
  local f = P.metatables[tonumber(ctype)][name]
  calls[#calls + 1] = { f, ... }
end
local v, q, f, h = V(1, 2, 3), Q(0, 0, 0, 1), F(true, false, true), dummy.ctype(0, 0)
for _, name in ipairs { "__add", "__sub", "__mul", "__div", "__eq" } do warm(V, name, v, v) end
warm(V, "__unm", v)
warm(Q, "__mul", q, v)
warm(Q, "__eq", q, q)
warm(F, "__index", f, 1)
warm(F, "__len", f)
warm(dummy.ctype, "__index", h, "x")
warm(dummy.ctype, "__newindex", h, "x", 1)
warm(dummy.ctype, "__eq", h, h)
local list = P.list_of(P.sim, 0)
warm(P.L, "__len", list)
warm(P.L, "__index", list, 1)
local own = P.empty_list()
warm(P.S, "__len", own)
warm(P.S, "__index", own, 1)

function P.exports.warm()
  for _, call in ipairs(calls) do call_often(call[1], call[2], call[3], call[4]) end
end
