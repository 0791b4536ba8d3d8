-- A detached run goes live: handles created in its own world get the ids that the same objects have in the live one.
-- Handles keep their identity, so variables and table keys stay valid.
local P = ...
local ffi, api, ctx = P.ffi, P.api, P.ctx

local gathered, object_count, pointers = {}, 0, nil

-- passes the addresses of slot and generation of each handle to the API
local function gather_handles()
  gathered = {}
  for _, handle in pairs(P.handles) do gathered[#gathered + 1] = handle end
  object_count = #gathered
  P.each_list(function(entry) gathered[#gathered + 1] = entry.list end)
  P.each_link(function(entry) gathered[#gathered + 1] = entry.handle end)
  pointers = ffi.new("int32_t*[?]", #gathered)
  for i, handle in ipairs(gathered) do pointers[i - 1] = ffi.cast("int32_t*", handle) end
  api.handles(ctx, pointers, #gathered)
end
P.exports.gather_handles = gather_handles

-- called after a successful run, not on the simulation thread
function P.exports.prepare()
  P.find_written()
  gather_handles()
end

-- indexes handles by their new slots
local function index_handles()
  local handles = P.handles
  for slot in pairs(handles) do handles[slot] = nil end
  for i = 1, object_count do
    local handle = gathered[i]
    if handle.slot_ >= 0 then handles[handle.slot_] = handle end
  end
  gathered, pointers = {}, nil
end

-- after the handles were remapped; `timers_at`: time of the last timer check of the live run, or nil
function P.exports.become_live(timers_at)
  index_handles()
  P.number_classes()
  P.reindex_lists()
  P.clear_relations()
  P.update_params_node()
  if timers_at then P.resume_timers(timers_at) end
end

-- in an earlier run: another run went live, and objects were rebuilt
function P.exports.handles_moved()
  index_handles()
  P.update_classes()
  P.reindex_lists()
  P.clear_relations()
  P.update_params()
end
