// Runs Lua texts in separate scenes, compiled or interpreted, in child processes, because some would crash.
#pragma once

#include <string>
#include <vector>

namespace limber::script::test {

struct LuaRun {
  bool compiled = true;
  int hot_loop = 0;  ///< ScriptLimits::hot_loop.
};

/// Returns the values that each text passed to `out`, and how it ended. A text is a chunk that receives `out`, `dump`
/// (a table's entries) and `num` (1 if the argument is not a number). If a process crashes the list ends with "crashed
/// by signal N".
std::vector<std::string> run_texts(const std::vector<std::string>& texts, const LuaRun& run);

/// The same in a plain Lua state, without Limber's prelude; the text receives `out` only.
std::string run_plainly(const std::string& text, const LuaRun& run);

}  // namespace limber::script::test
