// ScriptLimits: how much time and memory scripts may take before they are stopped; and how a Lua state runs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/sanitized.h"

namespace limber {

/// Sanitizers slow our side of the door by about that.
inline constexpr double kBudgetScale = kSanitized ? 10 : 1;

/// How a Lua state runs. Only one in the process can be live: compiled code is stopped through LuaJIT's profiler.
enum class VmMode : std::uint8_t {
  draft,  ///< Interpreted only.
  live,   ///< Compiled while it runs.
};

struct ScriptLimits {
  double call_ms = 50 * kBudgetScale;           ///< CPU time of one callback, handler, or step of a behavior.
  double run_ms = 5000 * kBudgetScale;          ///< CPU time of a scene's top level.
  double again_ms = 1000 * kBudgetScale;        ///< CPU time of a call that a rewind makes again.
  std::size_t memory = std::size_t{64} << 20u;  ///< Bytes that all scripts together may hold.
  bool compiled = true;  ///< Whether LuaJIT compiles what runs often; interpreted it comes to the same results.
  int hot_loop = 0;      ///< Rounds after which a loop is compiled, for tests; 0: LuaJIT's own number.
  bool disable_failed_handlers = true;  ///< False: takes of earlier versions, in which they were called again.
  std::size_t things = 500'000;  ///< Nodes that a scene may have: about 100 000 parts with their joints and motors.
};

}  // namespace limber
