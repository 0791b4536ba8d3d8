// The sandbox: visible names, pairs in a fixed order, texts without addresses, load, require, coroutines.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <lua.hpp>

#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

TEST(Sandbox, HasExactlyTheListedGlobals) {
  std::ifstream golden(LIMBER_SOURCE_DIR "/tests/script/globals.txt");
  std::stringstream expected;
  expected << golden.rdbuf();
  ScriptFixture fixture;
  EXPECT_EQ(fixture.scene.names(), expected.str())
      << "tests/script/globals.txt lists every name; if the change is intended, copy the names above into it";
}

TEST(Sandbox, HasNoDangerousFunctions) {
  for (const char* name :
       {"os", "io", "ffi", "debug", "jit", "package", "module", "dofile", "loadfile", "getfenv", "setfenv", "newproxy",
        "gcinfo", "next", "_G", "string.dump", "string.buffer", "math.randomseed", "table.new"}) {
    const std::string result = value_of("pcall(function() return " + std::string(name) + " end)");
    const bool absent = result.find("there is no global '" + std::string(name) + "'") != std::string::npos;
    EXPECT_TRUE(absent || result == "true\tnil") << name << ": " << result;
  }
  EXPECT_EQ(error_of("require('ffi')").substr(0, 49), "scripts/scene.lua:1: there is no module 'ffi'; lo");
  EXPECT_EQ(
      value_of("getmetatable(''), getmetatable(vec3()), getmetatable(sim), getmetatable(osc), getmetatable(params)"),
      "string\tffi\tffi\tosc\tparams");
  EXPECT_EQ(value_of("pcall(setmetatable, osc, {})").substr(0, 5), "false");
  EXPECT_EQ(value_of("(''):rep(3), ('a'):upper(), #('abc'), ('x').dump"), "\tA\t3\tnil");
  EXPECT_EQ(value_of("collectgarbage('count') > 0"), "true");
  EXPECT_EQ(error_of("collectgarbage()"),
            "scripts/scene.lua:1: collectgarbage accepts only 'count'; Limber collects garbage after each tick");
}

TEST(Sandbox, AScriptCanChangeOnlyItsOwnLibraries) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run("math.sin = nil string.format = nil table.sort = nil math.clamp = nil quat.euler = nil "
                        "pairs = nil print(('%d'):format(3))"),
            "");
  EXPECT_EQ(fixture.host.printed, Lines{"3"});
  EXPECT_EQ(value_of("math.sin(0), string.format('%d', 3), quat.euler()"), "0\t3\tquat(0, 0, 0, 1)");
}

TEST(Sandbox, UndefinedGlobalsAreErrors) {
  EXPECT_EQ(error_of("\nlocal x = vec2(1, 2)"), "scripts/scene.lua:2: there is no global 'vec2'; did you mean 'vec3'?");
  EXPECT_EQ(error_of("if undefined_thing then end"), "scripts/scene.lua:1: there is no global 'undefined_thing'");
  EXPECT_EQ(value_of("mine", "mine = 3"), "3");
}

TEST(Sandbox, PairsHasAFixedOrder) {
  EXPECT_EQ(value_of("table.concat(seen, ' ')", R"(
local box = sim:add_sphere_shape("s", 1)
local one, two = sim:add_body("one"), sim:add_body("two")
local p, q = one:add_part("p", box), one:add_part("q", box, { position = { 5, 0, 0 } })
local t = { zebra = 1, [10] = 1, [2.5] = 1, ape = 1, [-1] = 1, [two] = 1, [q] = 1, [true] = 1, [one] = 1, [false] = 1,
  [p] = 1, Ape = 1, "first", [box] = 1 }
seen = {}
for key in pairs(t) do seen[#seen + 1] = tostring(key) end)"),
            "-1 1 2.5 10 Ape ape zebra false true body 'one' part 'one/p' part 'one/q' body 'two' shape 's'");
  // entries may be changed and removed during the iteration
  EXPECT_EQ(value_of("table.concat(seen, ' ')", R"(
local t = { a = 1, b = 2, c = 3 }
seen = {}
for key, value in pairs(t) do
  seen[#seen + 1] = key .. value
  t.b = nil
  t[key] = 9
end)"),
            "a1 c3");
  EXPECT_EQ(error_of("for k in pairs({ [{}] = 1 }) do end"),
            "scripts/scene.lua:1: pairs: a key of this table is a table, which can't be put in a fixed order; use "
            "numbers, text or objects");
  EXPECT_EQ(error_of("pairs()"), "scripts/scene.lua:1: pairs takes a table, not nothing");
}

TEST(Sandbox, PairsOfAThousandKeysIsSorted) {
  EXPECT_EQ(value_of("ok, count", R"(
local t = {}
for i = 1, 1000 do t["k" .. (i * 7919) % 10007] = i t[(i * 104729) % 1000003] = i end
ok, count = true, 0
local last
for key in pairs(t) do
  count = count + 1
  if last and type(last) == type(key) and not (last < key) then ok = false end
  if type(last) == "string" and type(key) == "number" then ok = false end
  last = key
end)"),
            "true\t2000");
}

TEST(Sandbox, TextsHaveNoAddresses) {
  EXPECT_EQ(value_of("print, {}, coroutine.create(print), tostring(print), sim, rng"),
            "function\ttable\tthread\tfunction\tsim\trng");
  EXPECT_EQ(value_of("string.format('%s %s %s %d %5.1f|%%', {}, print, vec3(1, 2, 3), 4, 2.5)"),
            "table function vec3(1, 2, 3) 4   2.5|%");
  EXPECT_EQ(value_of("('%s'):format({})"), "table");
  EXPECT_EQ(value_of("setmetatable({}, { __tostring = function() return 'mine' end })"), "mine");
  EXPECT_EQ(error_of("string.format('%p', {})"),
            "scripts/scene.lua:1: string.format: %p shows an address, which differs in each run");
  EXPECT_EQ(error_of("string.format('%-20p', {})"),
            "scripts/scene.lua:1: string.format: %p shows an address, which differs in each run");
}

TEST(Sandbox, LoadAcceptsOnlyText) {
  EXPECT_EQ(value_of("load('return 1 + 2')()"), "3");
  EXPECT_EQ(value_of("loadstring('x = 5')() or x"), "5");
  EXPECT_EQ(value_of("load('return y', 'n', 't', { y = 7 })()"), "7");
  EXPECT_EQ(value_of("load('return 1 +', 'name')"), "nil\tname:1: unexpected symbol near '<eof>'");
  EXPECT_EQ(value_of("load('\\27LJ\\2\\0\\0')").substr(0, 3), "nil");
  EXPECT_EQ(error_of("load(function() return nil end)"), "scripts/scene.lua:1: load takes text, not a function");
}

TEST(Sandbox, LoadRejectsBytecode) {
  // made by string.dump, which scripts don't have
  lua_State* const L = luaL_newstate();
  ASSERT_EQ(luaL_loadstring(L, "return 7"), 0);
  std::string code;
  lua_dump(
      L,
      [](lua_State*, const void* piece, std::size_t size, void* to) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(piece), size);
        return 0;
      },
      &code);
  ASSERT_EQ(luaL_loadbuffer(L, code.data(), code.size(), "code"), 0);
  lua_close(L);
  std::string text;
  for (const char c : code) text += fmt::format("\\{:03}", static_cast<int>(static_cast<unsigned char>(c)));
  EXPECT_EQ(value_of("load('" + text + "')").substr(0, 4), "nil\t");
  EXPECT_EQ(value_of("loadstring('" + text + "')").substr(0, 4), "nil\t");
}

TEST(Sandbox, LoadRejectsTextsThatCompileSlowly) {
  EXPECT_EQ(error_of("local t = {} for i = 1, 2001 do t[i] = 'if a then goto e end' end "
                     "assert(load(table.concat(t, ' ') .. ' ::e::', 'mine'))"),
            "scripts/scene.lua:1: mine:1: a text can have at most 2000 break, goto and elseif; split it");
  EXPECT_EQ(error_of("load('return 1', 'n', 't', 5)"), "scripts/scene.lua:1: load's environment is a table, not 5");
}

TEST(Sandbox, SharedObjectsAreReadOnly) {
  EXPECT_EQ(error_of("rawset(osc, 'send', 1)"), "scripts/scene.lua:1: rawset: osc can't be changed");
  EXPECT_EQ(error_of("rawset(params, 'wind', 1)"), "scripts/scene.lua:1: rawset: params can't be changed");
  EXPECT_EQ(value_of("rawset({}, 'a', 1).a"), "1");
}

TEST(Sandbox, SortingIsStableAndSafe) {
  // 5000 random keys with 50 values: sorted and stable
  EXPECT_EQ(value_of("ok", R"(
local t = {}
for i = 1, 5000 do t[i] = { key = math.random(50), place = i } end
table.sort(t, function(a, b) return a.key < b.key end)
ok = #t == 5000
for i = 2, #t do
  local a, b = t[i - 1], t[i]
  if a.key > b.key or (a.key == b.key and a.place > b.place) then ok = false end
end)"),
            "true");
  for (int n = 0; n < 40; n++) {
    EXPECT_EQ(value_of("ok", fmt::format(R"(
local t = {{}}
for i = 1, {} do t[i] = (i * 7919) % 31 end
table.sort(t, function(a, b) return a > b end)
ok = #t
for i = 2, #t do if t[i - 1] < t[i] then ok = 'not sorted' end end)",
                                         n)),
              std::to_string(n));
  }
  // if the comparison fails the table is unchanged; an inconsistent one does no harm
  EXPECT_EQ(value_of("table.concat(t, ' ')", R"(
t = { 3, 1, 2 }
pcall(table.sort, t, function() error('x') end))"),
            "3 1 2");
  EXPECT_EQ(value_of("#t", "t = {} for i = 1, 100 do t[i] = i end table.sort(t, function() return true end)"), "100");
}

TEST(Sandbox, TableInsertChecksThePosition) {
  EXPECT_EQ(
      value_of("table.concat(t, ' ')", "t = { 1, 2 } table.insert(t, 3) table.insert(t, 1, 0) table.insert(t, 5, 9)"),
      "0 1 2 3 9");
  EXPECT_EQ(error_of("table.insert({ 1 }, -2 ^ 31, 0)"),
            "scripts/scene.lua:1: table.insert: the place is 1 … 2 here, not -2147483648");
  EXPECT_EQ(error_of("table.insert({ 1 }, 0 / 0, 0)").substr(0, 60),
            "scripts/scene.lua:1: table.insert: the place is 1 … 2 here");
  EXPECT_EQ(error_of("table.concat({ 1, {} })").substr(0, 40), "scripts/scene.lua:1: table.concat: inval");
}

TEST(Sandbox, TextsHaveABoundedSize) {
  EXPECT_EQ(error_of("('x'):rep(1e9)"),
            "scripts/scene.lua:1: string.rep makes texts of up to 8 MB, not 1000000000 bytes");
  EXPECT_EQ(value_of("#('ab'):rep(3, ', '), ('x'):rep(-5), (''):rep(1e9)"), "10\t\t");
  EXPECT_EQ(error_of("('x'):rep(5e6):upper()"), "scripts/scene.lua:1: string.upper takes texts of up to 4 MB");
  EXPECT_EQ(value_of("tonumber(('1'):rep(2000)), tonumber('0x10'), tonumber('z', 36), tonumber(nil)"),
            "nil\t16\t35\tnil");
}

TEST(Sandbox, HasXpcallPcallSelectUnpack) {
  EXPECT_EQ(value_of("xpcall(function(...) return ... end, print, 1, nil, 3)"), "true\t1\tnil\t3");
  EXPECT_EQ(value_of("xpcall(function() error('x', 0) end, function(e) return e .. '!' end)"), "false\tx!");
  EXPECT_EQ(value_of("select('#', unpack({ 1, nil, 3 }, 1, 3))"), "3");
}

TEST(Sandbox, HasSortAndGsub) {
  EXPECT_EQ(value_of("table.concat(t, ' ')", "t = { 3, 1, 2 } table.sort(t)"), "1 2 3");
  EXPECT_EQ(value_of("table.concat(t, ' ')", "t = { 3, 1, 2 } table.sort(t, function(a, b) return a > b end)"),
            "3 2 1");
  EXPECT_EQ(value_of("('hello'):gsub('l', function(c) return c:upper() end)"), "heLLo\t2");
  EXPECT_EQ(value_of("string.gsub('abc', '%w', '%0%0')"), "aabbcc\t3");
  // without a line where the overflow ends a compiled trace
  const std::string overflow = error_of("local function f(x) return (('x'):gsub('x', f)) end f()");
  EXPECT_TRUE(overflow == "scripts/scene.lua:1: stack overflow" || overflow == "scripts/scene.lua: stack overflow")
      << overflow;
}

// Recursion through functions of the prelude with stack frames of different sizes.
TEST(Sandbox, AStackOverflowHasAPlace) {
  for (const char* text : {"local function f(x)\n  return math.min(1, f(x))\nend\nf('x')",
                           "local function f(x)\n  return (x .. 'a'):sub(1, -1) .. f(x)\nend\nf('x')",
                           "local function f(x)\n  return 1 + f(x, f)\nend\nf('x')"}) {
    EXPECT_EQ(error_of(text), "scripts/scene.lua:2: stack overflow") << text;
  }
  // without a line where the overflow ends a compiled trace
  const std::string overflow = error_of("local function f()\n  return (('ab'):gsub('(a)', f))\nend\nf()");
  EXPECT_TRUE(overflow == "scripts/scene.lua:2: stack overflow" || overflow == "scripts/scene.lua: stack overflow")
      << overflow;
}

TEST(Sandbox, CoroutinesHaveALimitedDepth) {
  EXPECT_EQ(value_of("table.concat(t, ' ')", R"(
t = {}
local next_one = coroutine.wrap(function(a) for i = a, a + 2 do coroutine.yield(i) end end)
for i = 1, 3 do t[i] = next_one(5) end)"),
            "5 6 7");
  EXPECT_EQ(value_of("coroutine.resume(coroutine.create(function(...) return select('#', ...), ... end), 1, nil)"),
            "true\t2\t1\tnil");
  EXPECT_NE(error_of("local function f() coroutine.wrap(f)() end f()").find("nested more than 100 deep"),
            std::string::npos);
  EXPECT_EQ(value_of("coroutine.wrap(function() return pcall(error, 'x', 0) end)()"), "false\tx");
}

TEST(Sandbox, RequireFindsModulesOfTheShow) {
  ScriptFixture fixture;
  fixture.write("scripts/lib/steps.lua", "local steps = { count = 3 }\nprint('loaded', ...)\nreturn steps");
  fixture.write("scripts/lib/deep/er.lua", "shared = (shared_before or 0) + 1 return require('steps').count");
  fixture.write("scripts/lib/nothing.lua", "local x = 1");
  ASSERT_EQ(fixture.run(R"(
shared_before = 5
local steps = require("steps")
print(steps.count, require("steps") == steps, require("deep.er"), shared, require("nothing"))
)"),
            "");
  EXPECT_EQ(fixture.host.printed, (Lines{"loaded\tsteps", "3\ttrue\t3\t6\ttrue"}));
}

TEST(Sandbox, RequireRejectsInvalidNames) {
  ScriptFixture fixture;
  fixture.write("scripts/lib/a.lua", "return require('b')");
  fixture.write("scripts/lib/b.lua", "return require('a')");
  fixture.write("secret.lua", "print('secret')");
  std::filesystem::create_symlink(fixture.folder / "secret.lua", fixture.folder / "scripts/lib/link.lua");
  const std::string fault = fixture.run("require('a')");
  EXPECT_NE(fault.find("circular require: a -> b -> a"), std::string::npos) << fault;
  for (const char* name : {"../secret", "/etc/passwd", "a..b", ".a", "a.", "", "a/b", "a b"}) {
    EXPECT_NE(error_of("require('" + std::string(name) + "')").find("require takes a name such as"), std::string::npos)
        << name;
  }
  ScriptFixture linked;
  linked.write("secret.lua", "print('secret')");
  std::filesystem::create_symlink(linked.folder / "secret.lua", linked.folder / "scripts/lib/link.lua");
  EXPECT_NE(linked.run("require('link')").find("leads out of"), std::string::npos);
  EXPECT_TRUE(linked.host.printed.empty());
  ScriptFixture wrong;
  wrong.write("scripts/lib/wrong.lua", "local wrong_table = {}\nlocal y = wrong_table.z.w\n");
  EXPECT_EQ(first_line(wrong.run("require('wrong')")),
            "scripts/lib/wrong.lua:2: attempt to index field 'z' (a nil value)");
  ScriptFixture broken;
  broken.write("scripts/lib/broken.lua", "local = 1");
  EXPECT_EQ(first_line(broken.run("require('broken')")).substr(0, 26), "scripts/lib/broken.lua:1: ");
}

TEST(Sandbox, HasPrintAndWarn) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run("print(1, 'two', nil, true) print() warn('careful', 3)"), "");
  EXPECT_EQ(fixture.host.printed, (Lines{"1\ttwo\tnil\ttrue", ""}));
  EXPECT_EQ(fixture.logged(), Lines{"careful\t3"});
}

TEST(Sandbox, TablesAreNeverWeak) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.play("local weak = {}\n"
                         "for i = 1, 3 do\n"
                         "  setmetatable(weak, { __mode = 'v' })\n"
                         "end\n"
                         "local meta = getmetatable(weak)\n"
                         "rawset(meta, '__mode', 'k')\n"
                         "for i = 1, 100 do weak[i] = {} end\n"
                         "print(meta.__mode)\n"
                         "local n = 0\n"
                         "sim:on_step(function()\n"
                         "  local garbage = {}\n"
                         "  for i = 1, 20000 do garbage[i] = { i } end\n"
                         "  n = 0\n"
                         "  for _ in pairs(weak) do n = n + 1 end\n"
                         "end)\n"
                         "sim:after(0.5, function() print(n) end)\n",
                         40),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"nil", "100"}));
  const std::string warning =
      "__mode is ignored: entries of weak tables would disappear at a different tick in each run. Remove them with = "
      "nil";
  const std::vector<std::string> logged = fixture.logged();
  ASSERT_EQ(logged.size(), 2U);
  EXPECT_EQ(logged[0], "scripts/scene.lua:3: " + warning);
  EXPECT_EQ(logged[1], "scripts/scene.lua:6: " + warning);
}

TEST(Sandbox, LoopsThatAreNotCompiledAreReportedOnce) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.play("local sum = 0\n"
                         "sim:on_step(function()\n"
                         "  for i = 1, 2000 do sum = sum + i end\n"
                         "end)\n"
                         "sim:on_step(function()\n"
                         "  for i = 1, 2000 do\n"
                         "    local f = function() return sum end\n"
                         "    sum = sum + f()\n"
                         "  end\n"
                         "end)\n",
                         60),
            "");
  const std::vector<std::string> logged = fixture.logged();
  ASSERT_EQ(logged.size(), 1U);
  EXPECT_EQ(logged[0],
            "scripts/scene.lua:6: LuaJIT doesn't compile this loop, so it runs many times slower; create its functions "
            "outside of it");
}

}  // namespace
}  // namespace limber::script
