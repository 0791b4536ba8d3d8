// LuaProgram: random Lua programs for comparing compiled with interpreted code. One seed always gives one program.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace limber::script::test {

/// A statement: lines around a block of statements.
struct LuaNode {
  std::string head;
  std::vector<LuaNode> body;
  std::string tail;  ///< Empty: no block.
};

struct LuaProgram {
  std::vector<LuaNode> nodes;

  /// A chunk that passes its results to the function that it receives as its argument.
  std::string text() const;
};

/// Number of consecutive seeds with the same kind of program: three series with tables are followed by one without.
inline constexpr std::uint64_t kSeriesLength = 200;

/// Returns the program of a seed. It runs for about a millisecond; errors that it raises are part of its results.
LuaProgram make_program(std::uint64_t seed);

/// Removes statements as long as `differs` holds. At most `tries` calls.
LuaProgram shrink(LuaProgram program, const std::function<bool(const LuaProgram&)>& differs, int tries);

}  // namespace limber::script::test
