// Runs scenes and plain Lua states in child processes, which send results through a pipe.
#include "lua_runs.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <lua.hpp>

#include "stage.h"

namespace limber::script::test {

namespace {

// `/run` runs a text and prints the values that it passed to `out`, and how it ended. It uses no length operator, so
// that programs without tables are compiled with all optimizations (src/script/prelude/compiled.lua).
constexpr const char* kScene = R"(
local concat = table.concat
local lines, count
local function shown(x)
  if type(x) ~= "number" then return tostring(x) end
  if x == 0 then return 1 / x < 0 and "-0" or "0" end
  return x == x and string.format("%.17g", x) or tostring(x)
end
local function out(...)
  local list = { ... }
  for i = 1, select("#", ...) do list[i] = shown(list[i]) end
  if count < 2000 then
    count = count + 1
    lines[count] = concat(list, " ")
  end
end
local function dump(t)
  if type(t) ~= "table" then return out(t) end
  local ok, what = pcall(function()
    for k, v in pairs(t) do out(k, v) end
  end)
  out(ok, what)
end
local function num(x) return type(x) == "number" and x or 1 end
osc:on("/run", function(text)
  lines, count = {}, 0
  local chunk, fault = load(text, "program")
  if not chunk then return print("rejected: " .. fault) end
  local ok, what = pcall(chunk, out, dump, num)
  out(ok, what)
  print(concat(lines, "\n"))
end)
)";

constexpr const char* kPlain = R"(
local text, lines = ..., {}
local function out(...)
  local list = { ... }
  for i = 1, select("#", ...) do
    local x = list[i]
    list[i] = x == 0 and (1 / x < 0 and "-0" or "0") or (tostring(x):gsub("0x%x+", "address"))
  end
  lines[#lines + 1] = table.concat(list, " ")
end
out(pcall(assert(loadstring(text, "=program")), out))
return table.concat(lines, "\n")
)";

// Calls f(send) in a child process. Returns the sent data, and how the process ended.
std::pair<std::string, std::string> in_child(
    const std::function<void(const std::function<bool(const std::string&)>&)>& f) {
  int ends[2] = {-1, -1};
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    f([&](const std::string& bytes) {
      return write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
    });
    _exit(0);
  }
  close(ends[1]);
  std::string all;
  std::vector<char> buffer(65536);
  for (ssize_t n = 0; (n = read(ends[0], buffer.data(), buffer.size())) > 0;)
    all.append(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return {all, fmt::format("crashed by signal {}", WTERMSIG(status))};
  return {all, WEXITSTATUS(status) == 0 ? "" : fmt::format("ended with {}", WEXITSTATUS(status))};
}

std::string result_of(ScriptFixture& fixture, const std::string& text) {
  fixture.host.printed.clear();
  fixture.host.faults.clear();
  fixture.scene.handle_message({"/run", {Arg::of(text)}}, {});
  fixture.scene.collect_garbage();
  if (!fixture.host.faults.empty()) return "fault: " + fixture.host.faults.back().text;
  return fixture.host.printed.empty() ? "no result" : fixture.host.printed.back();
}

}  // namespace

std::vector<std::string> run_texts(const std::vector<std::string>& texts, const LuaRun& run) {
  const auto [sent, end] = in_child([&](const auto& send) {
    SceneOptions options;
    options.limits.compiled = run.compiled;
    options.limits.hot_loop = run.hot_loop;
    options.limits.call_ms = 60000;
    options.limits.memory = std::size_t{1} << 30u;  // garbage of a call is collected after it
    std::optional<ScriptFixture> fixture;
    for (const std::string& text : texts) {
      // a handler that was stopped is disabled
      if (!fixture || !fixture->host.faults.empty()) {
        fixture.reset();
        if (!fixture.emplace(options, true).play(kScene).empty()) return;
      }
      const std::string result = result_of(*fixture, text);
      if (!send(fmt::format("{} {}", result.size(), result))) return;
    }
  });
  std::vector<std::string> results;
  for (std::size_t at = 0; at < sent.size();) {
    const std::size_t space = sent.find(' ', at);
    if (space == sent.npos) break;
    const std::size_t size = std::stoul(sent.substr(at, space - at));
    results.push_back(sent.substr(space + 1, size));
    at = space + 1 + size;
  }
  if (results.size() < texts.size()) results.push_back(end.empty() ? "nothing" : end);
  return results;
}

std::string run_plainly(const std::string& text, const LuaRun& run) {
  const auto [sent, end] = in_child([&](const auto& send) {
    lua_State* const L = luaL_newstate();
    luaL_openlibs(L);
    luaJIT_setmode(L, 0, LUAJIT_MODE_ENGINE | (run.compiled ? LUAJIT_MODE_ON : LUAJIT_MODE_OFF));
    const std::string options = fmt::format("jit.opt.start('hotloop={0}', 'hotexit={0}', 'tryside=1')", run.hot_loop);
    if (run.hot_loop > 0 && luaL_dostring(L, options.c_str()) != 0) return;
    if (luaL_loadstring(L, kPlain) != 0) return;
    lua_pushlstring(L, text.data(), text.size());
    lua_pcall(L, 1, 1, 0);
    (void)send(lua_tostring(L, -1));
  });
  return end.empty() ? sent : end;
}

}  // namespace limber::script::test
