-- Musical time.

---@page clock

---Musical time. Beats pass with simulated time at the tempo; another program or taps can lead it.
---@class clock
---@field alive boolean # read-only. Always true.
---@properties clock
---@error sim.clock.tempo = "fast" --> sim.clock: 'tempo' takes a number, not 'fast'
---@see sim.clock, sim:on_beat
---@example clock
local clock_ = {}

---@action clock start
---@example clock
function clock_:start() end

---@action clock sync
---@param beat number # The beat now.
---@param tempo number # Beats per minute.
---@example clock
function clock_:sync(beat, tempo) end

---@action clock tap
---@example clock
function clock_:tap() end
