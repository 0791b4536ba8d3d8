// Every writable property through every interface: the legacy message, the path, Lua. It is clamped, and NaN is
// rejected.
#include "engine/every_row.h"

#include <limits>

#include "base/log/log.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

struct Interface {
  const char* name;
  // returns the message that sets the property, or none if this interface can't set it
  std::optional<Message> (*set)(const Sample& sample, const Property& property, const std::vector<double>& values);
};

const Interface kInterfaces[] = {
    {"path",
     [](const Sample& sample, const Property& property, const std::vector<double>& values) {
       Message m{sample.path + "/" + property.name, {}};
       for (const double v : values) m.args.push_back(arg(v));
       return std::optional(m);
     }},
    {"legacy message",
     [](const Sample& sample, const Property& property, const std::vector<double>& values) -> std::optional<Message> {
       Message m{MessageDispatcher::legacy_address(*sample.table, property), {}};
       if (m.address.empty()) return std::nullopt;
       for (const std::string& name : sample.names) m.args.push_back(arg(name));
       for (const double v : values) m.args.push_back(arg(v));
       return m;
     }},
};

void expect_value(Show& show, const std::string& path, const std::vector<double>& values, const char* interface_name) {
  for (std::size_t i = 0; i < values.size(); i++)
    EXPECT_NEAR(show.read(path, i), values[i], 1e-9 * std::max(1.0, std::abs(values[i])))
        << path << " by " << interface_name;
  // the value that clients get
  show.sent_texts();
  show.send("/get", path);
  show.engine.tick();
  std::string text = path;
  for (std::size_t i = 0; i < values.size(); i++) text += " " + number_text(show.read(path, i));
  EXPECT_EQ(show.sent_texts(), std::vector<std::string>{text});
}

void send_now(Show& show, const Message& m) {
  show.link.command_queue.push({{m}, {}});
  show.engine.tick();
}

void check_bounds(Show& show, const Interface& access, const Sample& sample, const Property& property) {
  const std::string path = sample.path + "/" + property.name;
  for (const double bound : {property.max, property.min}) {
    if (!is_measure(property) || !std::isfinite(bound)) continue;
    const std::uint64_t clamped_before = show.link.counters.clamped.load();
    const double beyond = bound == property.max ? 2 * std::abs(bound) + 1 : -2 * std::abs(bound) - 1;
    send_now(show, *access.set(sample, property, std::vector<double>(property.width, beyond)));
    for (std::uint32_t i = 0; i < property.width; i++) EXPECT_EQ(show.read(path, i), bound) << path;
    EXPECT_EQ(show.link.counters.clamped.load(), clamped_before + 1) << path;
  }
  const double before = show.read(path);
  const std::uint64_t rejected_before = show.link.counters.refused.load();
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    send_now(show, *access.set(sample, property, std::vector<double>(property.width, wrong)));
  EXPECT_EQ(show.read(path), before) << path;
  EXPECT_EQ(show.link.counters.refused.load(), rejected_before + 2) << path;
}

TEST(EveryProperty, IsSetByMessage) {
  log_to_stderr(false);
  const SceneFile scene(kEverything);
  for (const Interface& access : kInterfaces) {
    // paused, so that nothing changes the value
    Show show(scene.path());
    show.send("/transport/pause");
    show.engine.tick();
    int count = 0;
    for (const Sample& sample : samples(show.engine.store())) {
      for (const Property& property : sample.table->properties()) {
        if (!property.writable() || !access.set(sample, property, {})) continue;
        const std::vector<double> value = non_default_value(property);
        send_now(show, *access.set(sample, property, value));
        expect_value(show, sample.path + "/" + property.name, value, access.name);
        check_bounds(show, access, sample, property);
        count++;
      }
    }
    EXPECT_GT(count, 45) << access.name;
  }
  log_to_stderr(true);
}

TEST(EveryProperty, IsSetInLua) {
  // each is set, read and sent; then NaN, which is an error without an effect
  const SceneFile plain(kEverything);
  std::string text = std::string(kEverything) + "sim:on_start(function()\n";
  std::vector<std::string> expected_texts;
  {
    Show show(plain.path());
    for (const Sample& sample : samples(show.engine.store())) {
      for (const Property& property : sample.table->properties()) {
        if (!property.writable()) continue;
        const std::string member = sample.lua + "." + property.name;
        const std::vector<double> value = non_default_value(property);
        const char* nan = property.type == PropertyType::vec3   ? "vec3(0, 0/0, 0)"
                          : property.type == PropertyType::quat ? "quat(0/0, 0, 0, 1)"
                                                                : "0/0";
        const std::string path = sample.path + "/" + property.name;
        text += fmt::format("  {0} = {1}\n  osc:send('{4}', (pcall(function() {0} = {2} end)), {3})\n", member,
                            lua_literal(property, value), nan, lua_numbers(property, member), path);
        std::string expected = path + " 0";
        for (const double v : value)
          expected += " " + (property.type == PropertyType::choice ? property.choices[static_cast<std::size_t>(v)]
                                                                   : number_text(v));
        expected_texts.push_back(expected);
      }
    }
  }
  const SceneFile scene(text + "end)\n");
  EngineLink link;
  EngineOptions options = fast_options(scene.path());
  options.scene_options.limits.call_ms = options.scene_options.limits.run_ms;  // one long callback
  Engine engine(link, options);
  const Result<void> started = engine.start();
  ASSERT_TRUE(started.ok()) << started.error();
  std::vector<Outgoing> out;
  link.output_queue.drain(out);
  ASSERT_EQ(out.size(), expected_texts.size()) << (out.empty() ? "" : text_of(out.back().message));
  EXPECT_GT(out.size(), 50U);
  for (std::size_t i = 0; i < out.size(); i++) EXPECT_EQ(text_of(out[i].message), expected_texts[i]);
}

TEST(EveryProperty, ReadoutsAreReadOnlyInEveryInterface) {
  const SceneFile plain(kEverything);
  Show show(plain.path());
  show.ticks(2);
  show.sent_texts();
  int count = 0;
  for (const Sample& sample : samples(show.engine.store())) {
    for (const Property& property : sample.table->properties()) {
      if (property.kind != PropertyKind::readout) continue;
      const std::string path = sample.path + "/" + property.name;
      send_now(show, message(path, 1));
      EXPECT_EQ(show.sent_texts(), std::vector<std::string>{fmt::format("/error {} this property is read-only", path)});
      count++;
    }
  }
  EXPECT_GT(count, 15);
}

}  // namespace
}  // namespace limber::engine::test
