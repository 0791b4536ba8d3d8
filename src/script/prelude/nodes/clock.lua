-- Musical time: sim.clock, and sim:on_beat.
local P = ...
local api, ctx, number = P.api, P.ctx, P.answer.number
local clock = P.classes.clock

P.derive_members(clock)
clock.getters.alive = P.alive
P.finish_class(clock)

local handle = P.handle_of(P.clock_slot, P.clock_generation)
P.classes.sim.getters.clock = function() return handle end

-- the number of the newest multiple of `every` that was reached in the last tick, or nil
function P.beat_reached(every)
  if api.beat_reached(ctx, every) == 0 then return number[0] end
end
