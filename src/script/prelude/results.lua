-- `result` and `sim:record`: numbers that a run of the scene produces, for --out, sweeps and searches.
local P = ...
local ffi, api, ctx, answer, guarded = P.ffi, P.api, P.ctx, P.answer, P.guarded
local fail, describe, floor = P.fail, P.describe, math.floor

local kTolerance = 1e-9  -- as for timers: a sum of time steps misses a multiple by a few bits
local result_keys = { min = true, max = true, cells = true }

local function check_name(name, subject)
  if type(name) ~= "string" or not name:find("^[%a_][%w_]*$") or #name > 64 then
    fail("%s takes a name of letters, digits and _, not %s", subject, describe(name))
  end
end

-- the number that a function returned
local function number_of(value, subject, name)
  if type(value) == "boolean" then return value and 1 or 0 end
  if type(value) ~= "number" then fail("%s '%s': the function returns a number, not %s", subject, name, describe(value)) end
  return value
end

local results = {}
local kDefaultCells = 10

local function cells_of(opts, name)
  if not opts then return 0, 0, 0 end
  P.check_opts({ setters = {} }, opts, result_keys, "result '" .. name .. "'")
  local low = P.check_number(opts.min, "result '" .. name .. "': min")
  local high = P.check_number(opts.max, "result '" .. name .. "': max")
  if low >= high then fail("result '%s': min is below max", name) end
  local cells = opts.cells == nil and kDefaultCells or P.check_number(opts.cells, "result '" .. name .. "': cells")
  if cells < 1 or cells > 1000 or cells % 1 ~= 0 then
    fail("result '%s': cells is a whole number 1 .. 1000, not %s", name, tostring(cells))
  end
  return low, high, cells
end

function P.result(name, f, opts)
  P.needs_top_level("result")
  P.needs_scene("result")
  check_name(name, "result")
  P.check_function(f, "result '" .. name .. "'")
  local low, high, cells = cells_of(opts, name)
  P.handle_result(api.result_declare(ctx, name, #name, low, high, cells))
  local index = #results
  results[index + 1] = function() api.result_value(ctx, index, number_of(f(), "result", name)) end
end

-- computes all results; one that fails has an error instead of a value
function P.exports.results()
  for i, compute in ipairs(results) do
    if not guarded(compute) then api.result_fault(ctx, i - 1) end
  end
end
jit.off(P.exports.results)

local columns, last, disabled = nil, -1, false

local function columns_of(list)
  local functions = {}
  for key in pairs(list) do
    if key ~= "rate" and not (type(key) == "number" and key % 1 == 0 and key >= 1 and key <= #list) then
      fail("sim:record: '%s' is not a column; write { \"%s\", function() return … end }", tostring(key), tostring(key))
    end
  end
  if #list == 0 then fail("sim:record takes a list of columns { \"name\", function() return … end }") end
  for i, column in ipairs(list) do
    if type(column) ~= "table" then
      fail("sim:record: column %d is { \"name\", function() return … end }, not %s", i, describe(column))
    end
    check_name(column[1], "sim:record: column " .. i)
    P.check_function(column[2], "sim:record: column '" .. column[1] .. "'")
    P.handle_result(api.record_column(ctx, column[1], #column[1]))
    functions[i] = { name = column[1], f = column[2] }
  end
  return functions
end

P.sim_method("record", function(_, list)
  P.needs_top_level("sim:record")
  P.needs_scene("sim:record")
  if columns then fail("sim:record is called once, with all columns of the scene") end
  if type(list) ~= "table" then fail("sim:record takes a list of columns, not %s", describe(list)) end
  local rate = list.rate == nil and 60 or P.check_number(list.rate, "sim:record: rate")
  if rate < 0.001 or rate > 10000 then fail("sim:record: rate is 0.001 .. 10000 Hz, not %s", tostring(rate)) end
  columns = columns_of(list)
  local numbers = ffi.new("double[?]", #columns)
  local function sample()
    for i, column in ipairs(columns) do numbers[i - 1] = number_of(column.f(), "sim:record: column", column.name) end
    api.record_row(ctx, numbers)
  end
  -- called in each tick after all other callbacks
  function P.sample_row()
    local at = floor((P.sim.time + kTolerance) * rate)
    if at == last or disabled then return end
    last = at
    if guarded(sample) then return end
    disabled = true
    api.report(ctx)
  end
  jit.off(P.sample_row)
end)
