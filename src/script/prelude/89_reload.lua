-- A run beside the show becomes the show: handles that it made in a world of its own are given the ids that the same
-- things have in the live one. Handles stay the same objects, so that variables and keys of tables still mean them.
local P = ...
local ffi, api, ctx = P.ffi, P.api, P.ctx

local gathered, thing_count, pointers = {}, 0, nil

-- where each handle keeps its slot and generation
local function gather()
  gathered = {}
  for _, handle in pairs(P.handles) do gathered[#gathered + 1] = handle end
  thing_count = #gathered
  P.each_list(function(entry) gathered[#gathered + 1] = entry.list end)
  P.each_link(function(entry) gathered[#gathered + 1] = entry.handle end)
  pointers = ffi.new("int32_t*[?]", #gathered)
  for i, handle in ipairs(gathered) do pointers[i - 1] = ffi.cast("int32_t*", handle) end
  api.handles(ctx, pointers, #gathered)
end
P.entry.gather = gather

-- off the simulation thread, after a good run
function P.entry.prepare()
  P.find_written()
  gather()
end

-- handles by their slots, which are others now
local function index_handles()
  local handles = P.handles
  for slot in pairs(handles) do handles[slot] = nil end
  for i = 1, thing_count do
    local handle = gathered[i]
    if handle.slot_ >= 0 then handles[handle.slot_] = handle end
  end
  gathered, pointers = {}, nil
end

-- the ids are others now; `timers_at`: when the show's timers were looked at last, nil when they never were
function P.entry.become_live(timers_at)
  index_handles()
  P.number_classes()
  P.lists_moved()
  P.relations_moved()
  P.params_moved()
  if timers_at then P.timers_moved(timers_at) end
end

-- Of an earlier run: another run has become the show, and things were made again.
function P.entry.things_moved()
  index_handles()
  P.renew_classes()
  P.lists_moved()
  P.relations_moved()
  P.params_renewed()
end
