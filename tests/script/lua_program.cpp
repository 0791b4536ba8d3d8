// Random Lua programs from a grammar. It favors constructs that LuaJIT has compiled to wrong code before: constructors
// in loops, tables with two names, nil stores, lengths, `...`, metamethods, -0, NaN, and integers near 2^31.
#include "lua_program.h"

#include <random>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace limber::script::test {

namespace {

using Nodes = std::vector<LuaNode>;

enum Needs : unsigned { nothing = 0, loop = 1, varargs = 2, object = 4, functions = 8 };

struct Rule {
  int weight;
  const char* text;  ///< `$` and a letter are replaced by another part: see Maker::part().
  unsigned needs = nothing;
};

// Variables: numbers n1 to n3, texts s0 and s1, b0 true or false, v0 and v1 anything; lists t0 to t2 without gaps, so
// that their length is defined; tables h0 and h1 with any keys; m0 with a metatable; i1, i2, … of loops.
constexpr Rule kConstants[] = {
    {1, "0"},          {1, "1"},          {1, "2"},           {2, "3"},     {1, "-1"},     {1, "-2"},      {1, "0.5"},
    {1, "-0.5"},       {1, "7"},          {1, "10"},          {1, "1e9"},   {1, "255"},    {1, "1/0"},     {1, "-1/0"},
    {1, "2147483647"}, {1, "2147483648"}, {1, "-2147483648"}, {1, "2^53"},  {1, "0/0"},    {1, "-0"},      {1, "0.1"},
    {1, "3.25"},       {1, "65536"},      {1, "100"},         {1, "1e300"}, {1, "1e-300"}, {1, "-(2^53)"},
};
constexpr Rule kTexts[] = {{1, "''"},     {1, "'a'"},           {1, "'b'"},  {1, "'xyz'"}, {1, "'10'"},
                           {1, "'0x10'"}, {1, "'hello world'"}, {1, "'-0'"}, {1, "'1e1'"}};
constexpr Rule kKeys[] = {{1, "a"}, {1, "b"}, {1, "c"}, {1, "x"}};
constexpr Rule kNumberNames[] = {{2, "$i", loop}, {1, "n1"}, {1, "n2"}, {1, "n3"}};
constexpr Rule kLists[] = {{1, "t0"}, {1, "t1"}, {1, "t2"}};
constexpr Rule kOpenTables[] = {{1, "h0"}, {1, "h1"}};
constexpr Rule kTables[] = {{2, "$l"}, {3, "$h"}};
constexpr Rule kNumbers[] = {
    {6, "($n + $n)"},
    {6, "($n - $n)"},
    {2, "($n * $n)"},
    {1, "($n / $n)"},
    {2, "($n % $n)"},
    {1, "($n ^ $n)"},
    {3, "(- $n)"},
    {1, "math.floor($n)"},
    {1, "math.ceil($n)"},
    {1, "math.abs($n)"},
    {1, "math.sqrt($n)"},
    {1, "math.sin($n)"},
    {1, "math.exp($n)"},
    {1, "math.min($n, $n)"},
    {1, "math.max($n, $n)"},
    {1, "math.fmod($n, $n)"},
    {1, "math.atan2($n, $n)"},
    {1, "math.min($n, $n, $n)"},
    {1, "math.max($n, $n, $n)"},
    {1, "math.clamp($n, $n, $n)"},
    {1, "(select(2, math.modf($n)))"},
    {1, "bit.band($n % 4294967296, $n % 4294967296)"},
    {1, "bit.bxor($n % 4294967296, $n % 4294967296)"},
    {1, "bit.lshift($n % 4294967296, $n % 64)"},
    {1, "bit.arshift($n % 4294967296, $n % 64)"},
    {1, "bit.rol($n % 4294967296, $n % 64)"},
    {1, "bit.tobit($n % 4294967296)"},
    {3, "#$l"},
    {1, "#$s"},
    {2, "num($t[$n])"},
    {2, "num($t[$4])"},
    {2, "num($t.$k)"},
    {2, "(type($t.$k) == 'number' and $t.$k or $N)"},
    {2, "($c and $n or $n)"},
    {2, "(tonumber($s) or 1)"},
    {3, "num(($f($A)))", functions},
    {1, "num((select('#', ...)))", varargs},
    {2, "num((select($4, ...)))", varargs},
    {2, "(string.byte($s, $N) or 0)"},
    {1, "vec3($n, $n, $N).y"},
    {1, "(vec3($n, 1, 2) + vec3($n, $N, 0)).x"},
    {1, "(vec3($n, 1, 2) - vec3($n, $N, 0)).x"},
    {3, "$x"},
};
constexpr Rule kTextParts[] = {
    {3, "($s .. $s)"},
    {3, "($s .. $N)"},
    {2, "($S .. $n .. $S)"},
    {1, "($S .. tostring($S .. m0) .. $S)", object},
    {2, "string.sub($s, $N, $N)"},
    {2, "tostring($a)"},
    {1, "string.format('%d', $n)"},
    {1, "string.format('%g %s', $n, $s)"},
    {1, "string.format('%5.2f', $n)"},
    {1, "string.format('%x', $n)"},
    {1, "string.format('%q', $s)"},
    {1, "string.upper($s)"},
    {1, "string.reverse($s)"},
    {1, "string.rep($S, $4)"},
    {2, "s0"},
    {2, "s1"},
};
constexpr Rule kConditions[] = {
    {2, "$n < $n"},    {2, "$n <= $n"},         {1, "$n > $n"},   {1, "$n >= $n"},
    {1, "$n == $n"},   {1, "$n ~= $n"},         {1, "$s < $s"},   {1, "$s <= $s"},
    {1, "$s == $s"},   {1, "$s ~= $s"},         {1, "$a == nil"}, {1, "$a ~= nil"},
    {2, "$t == $B"},   {1, "m0 == $B", object}, {2, "not ($a)"},  {4, "$i % $4 == 1", loop},
    {2, "(b0 or $B)"},
};
constexpr Rule kAny[] = {
    {3, "$n"},
    {2, "$s"},
    {1, "true"},
    {1, "false"},
    {1, "nil"},
    {1, "$t"},
    {1, "$t[$4]"},
    {1, "$t.$k"},
    {1, "$T"},
    {1, "$t[$N]"},
    {1, "v0"},
    {1, "v1"},
    {1, "b0"},
    {1, "($c)"},
    {2, "(...)", varargs},
    {1, "(m0 + $N)", object},
    {1, "($S .. m0)", object},
    {1, "($S .. $N .. m0)", object},
    {1, "(m0 - $N)", object},
    {1, "m0($B)", object},
    {1, "m0[$4]", object},
};
constexpr Rule kSimple[] = {{2, "$N"}, {2, "$S"}, {1, "true"}, {1, "false"}, {1, "nil"}, {1, "$t"}, {1, "v0"}};
constexpr Rule kValues[] = {{2, "$n"}, {1, "$s"}, {1, "$L"}, {1, "$l"}, {1, "true"}, {1, "false"}};
constexpr Rule kElements[] = {{4, "$N"}, {2, "$S"}, {1, "true"}, {1, "false"}, {1, "$n"}};
constexpr Rule kFields[] = {{4, "$N"}, {2, "$S"}, {1, "true"}, {1, "false"}, {1, "nil"}, {2, "$n"}, {1, "{ 1 }"}};
constexpr Rule kArguments[] = {{2, ""},           {2, "$a"},           {2, "$a, $a"},
                               {2, "$a, $a, $a"}, {2, "...", varargs}, {1, "$a, ...", varargs}};
constexpr Rule kStatements[] = {
    {6, "n1 = $n"},
    {6, "n2 = $n"},
    {6, "n3 = $n"},
    {3, "s0 = string.sub($s, 1, 40)"},
    {3, "s1 = string.sub($s, 1, 40)"},
    {2, "b0 = $c"},
    {3, "$l = $L"},
    {3, "$l = $c and $L or $L"},
    {3, "$h = $T"},
    {3, "$h = $c and $T or $T"},
    {2, "$l = $l"},
    {2, "$h = $h"},
    {2, "local v = $v if #t0 < 100 then t0[#t0 + 1] = v end"},
    {2, "local v = $v if #t1 < 100 then t1[#t1 + 1] = v end"},
    {2, "if #t1 < 100 then table.insert(t1, $v) end"},
    {2, "if #t2 < 100 then table.insert(t2, $n) end"},
    {1, "local v = $v if #t0 >= 2 then t0[2] = v end"},
    {1, "local v = $v if #t1 >= 1 then t1[1] = v end"},
    {2, "$h[$4] = $a"},
    {3, "$t.$k = $a"},
    {1, "t0[#t0] = nil"},
    {1, "t1[#t1] = nil"},
    {3, "$h[$4] = nil"},
    {1, "$h[$N] = nil"},
    {2, "$h[$n % 7] = $a"},
    {2, "v1 = table.remove($l)"},
    {3, "local t = $T t.$k = $a t.$k = $a v1 = t.$k"},
    {2, "local t = $T v0 = t.$k"},
    {2, "rawset($h, $4, $B)"},
    {4, "out($a)"},
    {4, "n3 = num(($f($A)))", functions},
    {4, "v0, v1 = $f($A)", functions},
    {2, "local g = function(x) n1 = x return n2 end n3 = g($n)"},
    {2, "local g = function(x) v0 = x return n1 end n2 = g($a)"},
    {8, "local c, d = ... n3 = num(c) + num(d)", varargs},
    {4, "n2 = select('#', ...) + n2 % 10", varargs},
    {3, "n1, n2, t0, t1, h0, h1 = n2, n1, t1, t0, h1, h0"},
    {3, "if $c then do break end end", loop},
    {2, "local co = coroutine.wrap(function(x) local y = coroutine.yield(x) n1 = y end) v1 = co($n) co($N)"},
};
constexpr Rule kMetamethods[] = {
    {2, "__index = function(_, k) return k == 'a' and 5 or nil end,"},
    {2, "__index = { 11, 12, 13, 14, a = 3, b = 'm', [0] = false },"},
    {2, "__newindex = function(t, k, v) n1 = n1 + 1 rawset(t, k, v) end,"},
    {2, "__newindex = h0,"},
    {1, "__eq = function() return b0 end,"},
};
constexpr Rule kConcats[] = {
    {1, "__concat = function(x, y) return 'joined' end,"},
    {1, "__concat = function(...) local _, y = ... return y end,"},
    {1, "__concat = pcall,"},
    {1, "__concat = function(x, y) return x end,"},
};
constexpr Rule kLoops[] = {
    {5, "for $j = 1, $r do"},
    {1, "for $j = $r, 1, -1 do"},
    {1, "for $j = -1, $r / 2, 0.5 do"},
    {1, "local $j = 0 while $j < $r do $j = $j + 1"},
};
constexpr Rule kIterations[] = {{1, "for $j, v in ipairs($l) do"},
                                {1, "for $j, v in pairs($t) do $j = tonumber($j) or 1"}};

// true if a rule's text contains tables or lengths
bool uses_tables(std::string_view text) {
  for (const std::string_view part : {"$t", "$l", "$h", "$T", "$L", "t0", "t1", "t2", "{ 1", "#$"})
    if (text.find(part) != text.npos) return true;
  return false;
}

class ProgramGenerator {
 public:
  explicit ProgramGenerator(std::uint64_t seed, bool tables) : random_(seed), tables_(tables) {}

  LuaProgram program() {
    LuaProgram out;
    const auto line = [&](const char* text) { out.nodes.push_back({expand(text, 1), {}, ""}); };
    line("local n0, n1, n2, n3 = 0, 1, $0, $0");
    line("local s0, s1, b0 = 'a', $1, true");
    line("local v0, v1 = $0, $1");
    if (tables_) {
      line("local t0, t1, t2 = $L, $L, $L");
      line("local h0, h1 = $T, $T");
    }
    names_ = true;
    if (tables_ && chance(20)) line("t1 = t0");
    if (tables_ && chance(20)) line("h1 = h0");
    if (tables_ && chance(35)) {
      out.nodes.push_back(metatable());
      if (chance(40)) line("h1 = m0");
    }
    const int count = below(4);
    for (; functions_ < count; functions_++) out.nodes.push_back(function());
    const int loops = 1 + below(3);
    for (int i = 0; i < loops; i++) {
      out.nodes.push_back(loop_of(8 + below(20), 1));
      line("out(n1, n2, n3, s0, s1, b0, v0, v1)");
    }
    if (!tables_) return out;
    for (const char* name : {"dump(t0)", "dump(t1)", "dump(t2)", "dump(h0)", "dump(h1)", "dump(v0)"}) line(name);
    return out;
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool chance(int percent) { return below(100) < percent; }

  std::string choose(std::span<const Rule> rules, int depth) {
    const unsigned has = (depth_ > 0 ? loop : 0U) | (varargs_ ? varargs : 0U) | (object_ ? object : 0U) |
                         (functions_ > 0 ? functions : 0U);
    const auto fits = [&](const Rule& rule) {
      return (rule.needs & ~has) == 0 && (tables_ || !uses_tables(rule.text));
    };
    int sum = 0;
    for (const Rule& rule : rules) sum += fits(rule) ? rule.weight : 0;
    int left = below(sum);
    for (const Rule& rule : rules) {
      if (!fits(rule)) continue;
      left -= rule.weight;
      if (left < 0) return expand(rule.text, depth);
    }
    return "";
  }

  std::string expand(std::string_view text, int depth) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); at++) {
      if (text[at] == '$')
        out += part(text[++at], depth);
      else
        out += text[at];
    }
    return out;
  }

  // Returns the replacement of a letter; `depth`: remaining nesting depth of expressions.
  std::string part(char letter, int depth) {
    switch (letter) {
      case 'n':
        return depth > 0 ? choose(kNumbers, depth - 1) : part('N', 0);
      case 's':
        return depth > 0 ? choose(kTextParts, depth - 1) : part('S', 0);
      case 'N':
        return names_ && chance(60) ? part('x', 0) : choose(kConstants, 0);
      case 'S':
        return names_ && chance(50) ? (chance(50) ? "s0" : "s1") : choose(kTexts, 0);
      case '0':
        return choose(kConstants, 0);
      case '1':
        return choose(kTexts, 0);
      case 'c':
        return choose(kConditions, depth > 0 ? depth - 1 : 0);
      case 'a':
        return depth > 0 ? choose(kAny, depth - 1) : choose(kSimple, 0);
      case 'B':
        return choose(kSimple, 0);
      case 'v':
        return choose(kValues, depth > 0 ? depth - 1 : 0);
      case 'x':
        return choose(kNumberNames, 0);
      case 't':
        return choose(kTables, 0);
      case 'l':
        return choose(kLists, 0);
      case 'h':
        return choose(kOpenTables, 0);
      case 'k':
        return choose(kKeys, 0);
      case 'L':
        return constructor(kElements, 5, 1);
      case 'T':
        return constructor(kFields, 4, 3);
      case 'A':
        return choose(kArguments, depth > 0 ? depth - 1 : 0);
      case 'f':
        return fmt::format("f{}", below(functions_));
      case 'i':
        return fmt::format("i{}", 1 + below(depth_));
      case 'j':
        return fmt::format("i{}", depth_ + 1);
      case 'r':
        return std::to_string(rounds_);
      case '4':
        return std::to_string(1 + below(4));
      default:
        return "";
    }
  }

  std::string constructor(std::span<const Rule> elements, int max_elements, int fields) {
    const int depth = names_ ? 1 : 0;
    std::string out = "{ ";
    for (int i = below(max_elements); i > 0; i--) out += choose(elements, depth) + ", ";
    for (int i = below(fields + 1); i > 0; i--) out += choose(kKeys, 0) + " = " + choose(kFields, depth) + ", ";
    return out + "}";
  }

  LuaNode metatable() {
    LuaNode node{"local m0 = setmetatable(" + part('T', 1) + ", {", {}, "})"};
    for (const char* text : {"__add = function(x, y) return type(x) == 'table' and y or x end,",
                             "__sub = function(...) return select('#', ...) end,",
                             "__call = function(self, x, ...) return x or 4, ... end,"})
      node.body.push_back({text, {}, ""});
    node.body.push_back({choose(kConcats, 0), {}, ""});
    for (int i = below(3); i > 0; i--) node.body.push_back({choose(kMetamethods, 0), {}, ""});
    object_ = true;
    return node;
  }

  LuaNode function() {
    varargs_ = chance(45);
    LuaNode node{fmt::format("local function f{}({})", functions_,
                             !varargs_    ? "a, b"
                             : chance(50) ? "..."
                                          : "a, ..."),
                 {},
                 "end"};
    const bool recursive = chance(25);
    if (recursive) node.body.push_back({"n0 = n0 + 1 if n0 > 300 then return 1 end", {}, ""});
    if (varargs_) node.body.push_back({chance(60) ? "local a, b = ..." : "local a, b = 1, ...", {}, ""});
    for (int i = 1 + below(3); i > 0; i--) node.body.push_back(statement(1));
    if (recursive)
      node.body.push_back({fmt::format("if n0 % 7 > 0 then b = num((f{}(n1, a))) end", functions_), {}, ""});
    node.body.push_back({expand(chance(40) ? "do return n1, $a end" : "do return a, b end", 1), {}, ""});
    varargs_ = false;
    return node;
  }

  LuaNode loop_of(int rounds, int depth) {
    rounds_ = rounds;
    LuaNode node{rounds < 6 && tables_ && chance(40) ? choose(kIterations, 0) : choose(kLoops, 0), {}, "end"};
    depth_++;
    for (int i = 1 + below(5); i > 0; i--) node.body.push_back(statement(depth));
    depth_--;
    // the variable of a `while` is local to a block
    if (node.head.starts_with("local")) return {"do", {node}, "end"};
    return node;
  }

  LuaNode statement(int depth) {
    const int kind = below(20);
    if (kind < 2) return {"if " + choose(kConditions, 1) + " then", {statement(depth - 1)}, "end"};
    if (kind < 3) {
      return {"if " + choose(kConditions, 1) + " then",
              {statement(depth - 1), {"else", {}, ""}, statement(depth - 1)},
              "end"};
    }
    if (kind < 4 && depth > 0 && depth_ < 3) return loop_of(1 + below(5), depth - 1);
    if (kind < 5) {
      // `break` and `...` can't be used across it
      const int depth_before = std::exchange(depth_, 0);
      const bool varargs_before = std::exchange(varargs_, false);
      LuaNode node{"local ok, what = pcall(function(a)", {statement(depth - 1)}, "end, 1) out(ok, what)"};
      depth_ = depth_before;
      varargs_ = varargs_before;
      return node;
    }
    return {choose(kStatements, 2), {}, ""};
  }

  std::mt19937_64 random_;
  int functions_ = 0;     // that can be called
  int depth_ = 0;         // nesting depth of loops
  int rounds_ = 0;        // iterations of the loop being generated
  bool tables_ = true;    // whether there are t0, h0, …
  bool names_ = false;    // whether variables exist
  bool varargs_ = false;  // whether there is `...`
  bool object_ = false;   // whether there is m0
};

void write_nodes(const Nodes& nodes, int indent, std::string& out) {
  for (const LuaNode& node : nodes) {
    const std::string margin(static_cast<std::size_t>(indent), ' ');
    out += margin + node.head + "\n";
    if (node.tail.empty()) continue;
    write_nodes(node.body, indent + 2, out);
    out += margin + node.tail + "\n";
  }
}

// Calls f(list, index) for every node, until it returns true.
bool each_node(Nodes& nodes, const std::function<bool(Nodes&, std::size_t)>& f) {
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (f(nodes, i)) return true;
    if (i < nodes.size() && each_node(nodes[i].body, f)) return true;
  }
  return false;
}

}  // namespace

std::string LuaProgram::text() const {
  std::string out = "local out, dump, num = ...\n";
  write_nodes(nodes, 0, out);
  return out;
}

LuaProgram make_program(std::uint64_t seed) {
  return ProgramGenerator(seed, (seed - 1) / kSeriesLength % 4 != 3).program();
}

LuaProgram shrink(LuaProgram program, const std::function<bool(const LuaProgram&)>& differs, int tries) {
  const auto make_smaller = [&](bool keep_body) {
    return each_node(program.nodes, [&](Nodes& list, std::size_t i) {
      if (tries <= 0 || (keep_body && list[i].body.empty())) return false;
      tries--;
      const Nodes saved = list;
      const Nodes body = list[i].body;
      const auto place = list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
      if (keep_body) list.insert(place, body.begin(), body.end());
      if (differs(program)) return true;
      list = saved;
      return false;
    });
  };
  while (make_smaller(false) || make_smaller(true)) {
  }
  return program;
}

}  // namespace limber::script::test
