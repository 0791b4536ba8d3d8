// ScriptLimits: time and memory limits of scripts; VmMode: how a Lua state runs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/sanitized.h"

namespace limber::script {

/// Factor for all time budgets: the approximate slowdown of C++ code by sanitizers.
inline constexpr double kBudgetScale = kSanitized ? 10 : 1;

/// Execution mode of a Lua state. Only one state in the process can use the JIT compiler, because compiled code is
/// stopped through LuaJIT's profiler.
enum class VmMode : std::uint8_t {
  interpreted,
  compiled,  ///< By the JIT compiler, unless ScriptLimits::compiled is false.
};

struct ScriptLimits {
  double call_ms = 50 * kBudgetScale;           ///< CPU time of one callback, handler or behavior step.
  double run_ms = 5000 * kBudgetScale;          ///< CPU time of a scene's top level.
  double replay_ms = 1000 * kBudgetScale;       ///< CPU time of a call repeated by a rewind.
  std::size_t memory = std::size_t{64} << 20u;  ///< Bytes that all scripts of a scene may use.
  bool compiled = true;                         ///< Enable the JIT compiler; results are the same without it.
  int hot_loop = 0;                     ///< Iterations after which a loop is compiled, for tests; 0: LuaJIT's default.
  bool disable_failed_handlers = true;  ///< False for takes of earlier versions, which called them again.
  std::size_t max_objects = 500'000;    ///< Max. number of nodes: about 100 000 parts with their joints and motors.
};

}  // namespace limber::script
