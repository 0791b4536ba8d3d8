// The order in which the files of the prelude run, their bytecode, and calls of its functions.
#include "script/vm/prelude.h"

#include <array>
#include <memory>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/check.h"
#include "base/log/log.h"

namespace limber::script {

namespace {

int append_bytes(lua_State*, const void* bytes, std::size_t size, void* text) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), size);
  return 0;
}

std::vector<PreludeChunk> compile_prelude() {
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), lua_close);
  std::vector<PreludeChunk> chunks;
  for (const std::string_view file : prelude_order()) {
    const EmbeddedFile* const source = find_embedded(prelude_files(), file);
    LIMBER_CHECK(source != nullptr);
    PreludeChunk& chunk = chunks.emplace_back();
    chunk.name = fmt::format("=limber {}", file);
    const bool compiles =
        luaL_loadbuffer(state.get(), source->text.data(), source->text.size(), chunk.name.c_str()) == 0 &&
        lua_dump(state.get(), append_bytes, &chunk.bytecode) == 0;
    if (!compiles) log_error("script: {}", text_at(state.get(), -1));
    LIMBER_CHECK(compiles);
    lua_settop(state.get(), 0);
  }
  return chunks;
}

}  // namespace

const std::vector<PreludeChunk>& compiled_prelude() {
  static const std::vector<PreludeChunk> chunks = compile_prelude();
  return chunks;
}

std::span<const std::string_view> prelude_order() {
  static constexpr auto kOrder = std::to_array<std::string_view>({
      "core.lua",
      "library.lua",
      "syntax.lua",
      "compiled.lua",
      "fallback.lua",
      "values.lua",
      "math.lua",
      "objects.lua",
      "lists.lua",
      "solids.lua",
      "bodies.lua",
      "forces.lua",
      "behaviors/handles.lua",
      "sim.lua",
      "nodes/sensors.lua",
      "nodes/tendons.lua",
      "nodes/fixtures.lua",
      "nodes/mocap.lua",
      "nodes/routes.lua",
      "nodes/clock.lua",
      "policies.lua",
      "visuals.lua",
      "callbacks.lua",
      "results.lua",
      "osc.lua",
      "presets.lua",
      "params.lua",
      "plain.lua",
      "behaviors/types.lua",
      "behaviors/self.lua",
      "errors.lua",
      "behaviors/limits.lua",
      "strings.lua",
      "behaviors/neighbors.lua",
      "tables.lua",
      "state.lua",
      "reload.lua",
      "sandbox.lua",
      "console.lua",
      "warm.lua",
  });
  return kOrder;
}

std::string_view text_at(lua_State* state, int index) {
  std::size_t length = 0;
  const char* const text = lua_tolstring(state, index, &length);
  return text == nullptr ? std::string_view("an error without a message") : std::string_view(text, length);
}

bool call_export(lua_State* state, int arguments, int results) {
  const bool caught_all = lua_pcall(state, arguments, results, 0) == 0;
  if (caught_all) return true;
  log_error("script: {}", text_at(state, -1));
  LIMBER_CHECK(caught_all);
  lua_settop(state, 0);
  return false;
}

}  // namespace limber::script
