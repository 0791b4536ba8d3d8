// Fuzzes scripts generated from a grammar, with random limits of time and memory. Checks that the program survives,
// that later scripts still run, and that a failing callback leaves the world unchanged, bit for bit.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/log/log.h"
#include "fuzz/target.h"
#include "script/api/script_context.h"
#include "script/scene/scene.h"
#include "script/vm/vm.h"
#include "support/world_objects.h"

namespace limber {
namespace {

struct SilentHost : script::ScriptHost {
  void send(Message) override {}
  void reply(const CommandOrigin&, Message) override {}
  void send_direct(const CommandOrigin&, Message) override {}
  void configure_osc(const OscConfig&) override {}
  void request_reset() override {}
  void script_error(std::string_view file, int line, std::string_view text) override {
    faults++;
    must(file == "fuzz.lua" && line > 0 && !text.empty() && text.size() < 20000);
  }
  void print(std::string_view) override {}
  int faults = 0;
};

// generates statements from bytes; after the last byte, every choice takes its first, simple alternative
class Writer {
 public:
  explicit Writer(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::string scene(bool all_fail) {
    if (all_fail) end_ = "error('end') ";
    std::string text = "local a, b, c, d = 1, 'x', {}, nil\n" + block(3);
    for (const char* where : {"sim:on_start", "sim:on_step", "sim:on_step"}) text += callback(where, "", 3);
    text += callback("sim:every", pick({"0.01, ", "1, ", "0.03, "}), 2);
    text += callback("osc:on", "'/go', ", 2);
    return text;
  }
  unsigned byte() {
    if (at_ == bytes_.size()) return 0;
    return bytes_[at_++];
  }

 private:
  // if all callbacks are to fail, this one raises an error at its end at the latest
  std::string callback(std::string_view where, std::string_view arguments, int depth) {
    return fmt::format("{}({}function(e) {} {}end)\n", where, arguments, block(depth), end_);
  }

  std::string pick(std::initializer_list<const char*> list) { return list.begin()[byte() % list.size()]; }

  std::string block(int depth) {
    std::string text;
    const unsigned count = 1 + byte() % 4;
    for (unsigned i = 0; i < count; i++) text += statement(depth) + " ";
    return text;
  }

  std::string statement(int depth) {
    if (depth <= 0) return fmt::format("{} = {}", name(), value(1));
    switch (byte() % 24) {
      case 1:
        return fmt::format("for i = 1, {} do {} end", pick({"3", "100", "1e5", "math.huge"}), block(depth - 1));
      case 2:
        return fmt::format("while {} do {} end", pick({"true", "a ~= b", "d"}), block(depth - 1));
      case 3:
        return fmt::format("repeat {} until {}", block(depth - 1), value(depth - 1));
      case 4:
        return fmt::format("if {} then {} else {} end", value(1), block(depth - 1), block(depth - 1));
      case 5:
        return fmt::format("pcall(function(e) {} end, {})", block(depth - 1), value(1));
      case 6:
        return fmt::format("{} = coroutine.wrap(function(e) {} coroutine.yield({}) {} end)", name(), block(depth - 1),
                           value(1), block(depth - 1));
      case 7:
        return fmt::format("{} = function(e) {} return {} end", name(), block(depth - 1), value(depth - 1));
      case 8:
        return fmt::format("{} = setmetatable({{}}, {{ {} = function(e, f) {} return {} end }})", name(),
                           pick({"__index", "__newindex", "__add", "__tostring", "__lt", "__call", "__concat", "__eq"}),
                           block(depth - 1), value(1));
      case 9:
        return fmt::format("table.sort({}, function(e, f) {} return {} end)", table(), block(depth - 1), value(1));
      case 10:
        return fmt::format("for k, v in pairs({}) do {} end", value(1), block(depth - 1));
      case 11:
        return fmt::format("xpcall(function() {} end, function(e) {} end)", block(depth - 1), block(depth - 1));
      case 12:
        return fmt::format("c[{}] = {}", value(1), value(depth - 1));
      case 13:
        return fmt::format("load({})", pick({"'a = 1'", "'while true do end'", "('a='):rep(9)", "b", "'\\27LJ'"}));
      case 14:
        return world(depth);
      case 15:
        return world(depth);
      case 16:
        return fmt::format("{} = ({}):gsub({}, {})", name(), text(), pattern(), value(1));
      case 17:
        return fmt::format("error({})", value(1));
      case 18:
        return fmt::format("osc:send('/out', {})", value(1));
      case 19:
        return callback(pick({"sim:on_step", "sim:on_start", "sim:on_contact"}), "", depth - 1);
      default:
        return fmt::format("{} = {}", name(), value(depth));
    }
  }

  std::string world(int depth) {
    const std::string body = pick({"sim.bodies[1]", "sim.bodies[#sim.bodies]", "sim:body('one')", "c"});
    switch (byte() % 14) {
      case 1:
        return fmt::format("sim:add_body({}):add_part('p', 'ball', {{ mass = {} }})", text(), number());
      case 2:
        return fmt::format("{}:copy({})", body, text());
      case 3:
        return fmt::format("{}:remove()", body);
      case 4:
        return fmt::format("{}.root:apply_force(vec3({}, {}, 1))", body, number(), number());
      case 5:
        return fmt::format("{}.position = vec3({}, 0, {})", body, number(), number());
      case 6:
        return fmt::format("{}.root.{} = {}", body, pick({"mass", "friction", "position", "nothing"}), value(1));
      case 7:
        return fmt::format("{}:reset()", body);
      case 8:
        return fmt::format("sim.gravity = vec3({}, 0, {})", number(), number());
      case 9:
        return callback("sim:after", number() + ", ", depth - 1);
      case 10:
        return fmt::format("{0}:add_joint({1}, {0}.parts[1], {0}:add_part({1}, 'ball'))", body, text());
      case 11:
        return fmt::format("{}.angular_velocity = vec3({}, 1, 0)", body, number());
      case 12:
        return fmt::format("{} = {}.root", name(), body);
      case 13:
        return fmt::format("sim:add_compound_shape({}):add_child('ball')", text());
      default:
        return fmt::format("{}.linear_velocity = vec3(0, 0, {})", body, number());
    }
  }

  std::string value(int depth) {
    switch (byte() % (depth <= 0 ? 6 : 18)) {
      case 1:
        return text();
      case 2:
        return pick({"nil", "true", "false", "print", "sim", "rng", "osc", "params", "string", "sim.bodies"});
      case 3:
        return table();
      case 4:
        return name();
      case 5:
        return name();
      case 6:
        return fmt::format("({} {} {})", value(depth - 1),
                           pick({"+", "-", "*", "/", "..", "==", "<", "and", "or", "%", "^", "~="}), value(depth - 1));
      case 7:
        return fmt::format("{}({})", name(), value(depth - 1));
      case 8:
        return fmt::format("string.{}({}, {})",
                           pick({"find", "match", "gsub", "rep", "format", "byte", "sub", "gmatch"}), value(depth - 1),
                           pattern());
      case 9:
        return fmt::format("table.{}({}, {})", pick({"concat", "insert", "remove", "maxn"}), value(depth - 1),
                           value(depth - 1));
      case 10:
        return fmt::format("vec3({}, {}, {})", number(), number(), number());
      case 11:
        return fmt::format("{}.{}", value(depth - 1),
                           pick({"x", "root", "position", "name", "parts", "motors", "__index"}));
      case 12:
        return fmt::format("#{}", value(depth - 1));
      case 13:
        return fmt::format("tostring({})", value(depth - 1));
      case 14:
        return fmt::format("select({}, unpack({}))", number(), table());
      case 15:
        return fmt::format("(function(...) return ... end)({})", value(depth - 1));
      case 16:
        return fmt::format("b:rep({}):rep({})", byte(), byte());
      case 17:
        return fmt::format("math.{}({})", pick({"random", "floor", "sqrt", "noise", "huge", "clamp"}),
                           value(depth - 1));
      default:
        return number();
    }
  }

  std::string name() { return pick({"a", "b", "c", "d", "e", "g"}); }
  std::string number() {
    return pick({"1", "0", "-1", "0.5", "(0/0)", "math.huge", "-math.huge", "2^31", "1e300", "-2^53", "7", "1e-9"});
  }
  std::string text() {
    return pick({"'x'", "''", "'one'", "('ab'):rep(1000)", "'%d+'", "'a b c'", "b", "tostring(a)"});
  }
  std::string pattern() {
    return pick(
        {"'.'", "'%w+'", "'(a*)*b'", "('a*'):rep(30) .. 'b'", "'%b()'", "'%f[%a]'", "'['", "'(.-)%1'", "'^'", "b"});
  }
  std::string table() {
    return pick({"{}", "{ 3, 1, 2 }", "{ a, b, c }", "{ x = 1, y = c }", "c", "{ [0.5] = 1, [sim] = 2 }"});
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string end_;
};

// checks that the VM still runs valid scripts
void check_vm_works(script::Vm& vm) {
  constexpr std::string_view kGood = "local n = 0 for i = 1, 100 do n = n + i end return n";
  for (int attempt = 0; attempt < 100; attempt++) {
    must(luaL_loadbuffer(vm.state(), kGood.data(), kGood.size(), "@good") == 0);
    if (!vm.guard().call(0, 1)) {
      must(vm.guard().fault().stopped);  // the limits may be too tight for this attempt
      continue;
    }
    must(lua_tonumber(vm.state(), -1) == 5050);
    lua_settop(vm.state(), 0);
    return;
  }
  must(false);
}

void play(std::span<const std::uint8_t> bytes) {
  static Store store;
  static sim::World world(store);
  world.clear();
  world.restart_time();
  Writer writer(bytes);
  script::SceneOptions options;
  options.limits.call_ms = 0.05 * (1 + writer.byte());
  options.limits.run_ms = 0.2 * (1 + writer.byte());
  options.limits.memory = (std::size_t{3} << 20u) + (std::size_t{writer.byte()} << 15u);
  const bool all_fail = writer.byte() % 4 != 1;
  SilentHost host;
  script::ScriptContext context(world, host, options);
  context.random.set_name("fuzz");
  script::Vm vm(context, writer.byte() % 8 == 1 ? script::VmMode::interpreted : script::VmMode::compiled);
  const std::string before =
      "local ball = sim:add_sphere_shape('ball', 0.1) "
      "for i, name in ipairs { 'one', 'two' } do "
      "sim:add_body(name):add_part('p', ball, { position = { i, 0, 1 }, report_contacts = true }) end ";
  context.answer.top_level = 1;
  script::ScriptPlace fault;
  (void)vm.run(before + writer.scene(all_fail), "fuzz.lua", "", fault);
  context.answer.top_level = 0;
  world.flush();
  world.step();
  for (int tick = 0; tick < 4; tick++) {
    const std::uint64_t hash = context.hash(world.state_hash());
    const std::size_t shapes = world.shapes().list().size();
    if (tick == 0) vm.start();
    vm.handle_message({"/go", {Arg::of(1.0)}}, {});
    vm.tick(1.0 / 60);
    if (all_fail) must(context.hash(world.state_hash()) == hash && world.shapes().list().size() == shapes);
    world.step();
    vm.collect_garbage();
  }
  check_vm_works(vm);
}

}  // namespace
}  // namespace limber

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::log_to_stderr(false);
  limber::play({data, size});
  return 0;
}
