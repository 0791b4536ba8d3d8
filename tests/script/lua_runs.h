// Lua texts run in scenes of their own, compiled or interpreted, in processes of their own: some would crash.
#pragma once

#include <string>
#include <vector>

namespace limber::script_test {

struct LuaRun {
  bool compiled = true;
  int hot_loop = 0;  ///< ScriptLimits::hot_loop.
};

/// What each text passed to `out`, and how it ended. A text is a chunk that receives `out`, `dump` (a table's entries)
/// and `num` (1 for what is no number). A process that crashes ends the list with "crashed by signal N".
std::vector<std::string> run_texts(const std::vector<std::string>& texts, const LuaRun& run);

/// The same in a plain Lua state, without Limber's prelude; the text receives `out` only.
std::string run_plainly(const std::string& text, const LuaRun& run);

}  // namespace limber::script_test
