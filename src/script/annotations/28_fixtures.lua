-- Lighting fixtures.

---@page fixtures

---Adds a lighting fixture. Without an `address` it gets the first channels of its universe that are free. Its values
---are sent to the lights only while the output is armed.
---@param name string # A name of your choice, unique among the fixtures.
---@param opts fixture_opts # `profile`, and properties such as `position` and `dimmer`.
---@return fixture
---@error sim:add_fixture("spot", {}) --> add_fixture: profile is the name of a profile, such as "moving_spot", or a file, such as "spot.fixture"
---@error sim:add_fixture("spot", { profile = "moving_spott" }) --> there is no fixture profile 'moving_spott'; did you mean 'moving_spot'?
---@error sim:add_fixture("spot", { profile = "dimmer", universe = 0 }) --> fixture 'spot': the universe must be a whole number from 1 to 32767, got 0
---@error sim:add_fixture("spot", { profile = "rgb_par", address = 511 }) --> fixture 'spot': has 3 channels, so its address must be a whole number from 1 to 510, got 511
---@error sim:add_fixture("spot", { profile = "dimmer", targets = { "tip" } }) --> add_fixture: target 1 is a part, as body:part(name), not 'tip'
---@see fixture, sim:fixture
---@example fixtures
function sim:add_fixture(name, opts) end

---Returns a fixture by name or number (-1: the last).
---@param key string|integer|fixture # Its name, its number from 1, or -1 for the last.
---@return fixture
---@error sim:fixture("spot") --> there is no fixture 'spot'; none exist
---@see sim.fixtures
---@example fixtures
function sim:fixture(key) end

---A lighting fixture. Created by sim:add_fixture.
---@class fixture
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field targets part[] # read-only. The parts that it can aim at and that exist now.
---@properties fixture
---@see sim:add_fixture
---@example fixtures
local fixture_ = {}

---@action fixture remove
---@example fixtures
function fixture_:remove() end

---@class fixture_opts
---@field profile string # The name of a profile of the program (dimmer, moving_beam, moving_spot, moving_wash, rgb_par, rgbw_par), or a file whose name ends with `.fixture`.
---@field targets? part|part[] # Up to 64 parts that it can aim at. With targets, the default of `aim` is "part".
---@opts fixture

---@page lists

---The lighting fixtures.
---@class fixture_list
---@field [integer] fixture
---@overload fun(self: sim, wanted?: string|fixture|(string|fixture)[]): fun(): fixture, integer
---@see sim.fixtures
---@example lists
