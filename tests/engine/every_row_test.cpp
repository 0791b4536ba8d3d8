// Every row that can be set, through every face: the seed's message, the path, Lua. It clamps, and refuses NaN.
#include "engine/every_row.h"

#include <limits>

#include "base/log.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

struct Face {
  const char* name;
  // the message that sets the row, or none where this face does not reach it
  std::optional<Message> (*set)(const Sample& sample, const Row& row, const std::vector<double>& values);
};

const Face kFaces[] = {
    {"path",
     [](const Sample& sample, const Row& row, const std::vector<double>& values) {
       Message m{sample.path + "/" + row.name, {}};
       for (const double v : values) m.args.push_back(arg(v));
       return std::optional(m);
     }},
    {"seed",
     [](const Sample& sample, const Row& row, const std::vector<double>& values) -> std::optional<Message> {
       Message m{Dispatch::seed_address(*sample.table, row), {}};
       if (m.address.empty()) return std::nullopt;
       for (const std::string& name : sample.names) m.args.push_back(arg(name));
       for (const double v : values) m.args.push_back(arg(v));
       return m;
     }},
};

void expect_value(Show& show, const std::string& path, const std::vector<double>& values, const char* face) {
  for (std::size_t i = 0; i < values.size(); i++)
    EXPECT_NEAR(show.read(path, i), values[i], 1e-9 * std::max(1.0, std::abs(values[i]))) << path << " by " << face;
  // and as somebody outside reads it
  show.outbox();
  show.send("/get", path);
  show.engine.tick();
  std::string text = path;
  for (std::size_t i = 0; i < values.size(); i++) text += " " + number_text(show.read(path, i));
  EXPECT_EQ(show.outbox(), std::vector<std::string>{text});
}

void send_now(Show& show, const Message& m) {
  show.link.inbox.push({{m}, {}});
  show.engine.tick();
}

void check_bounds(Show& show, const Face& face, const Sample& sample, const Row& row) {
  const std::string path = sample.path + "/" + row.name;
  for (const double bound : {row.max, row.min}) {
    if (!is_measure(row) || !std::isfinite(bound)) continue;
    const std::uint64_t clamped = show.link.counters.clamped.load();
    const double beyond = bound == row.max ? 2 * std::abs(bound) + 1 : -2 * std::abs(bound) - 1;
    send_now(show, *face.set(sample, row, std::vector<double>(row.width, beyond)));
    for (std::uint32_t i = 0; i < row.width; i++) EXPECT_EQ(show.read(path, i), bound) << path;
    EXPECT_EQ(show.link.counters.clamped.load(), clamped + 1) << path;
  }
  const double before = show.read(path);
  const std::uint64_t refused = show.link.counters.refused.load();
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    send_now(show, *face.set(sample, row, std::vector<double>(row.width, wrong)));
  EXPECT_EQ(show.read(path), before) << path;
  EXPECT_EQ(show.link.counters.refused.load(), refused + 2) << path;
}

TEST(EveryRow, ByMessage) {
  log_to_stderr(false);
  const SceneFile scene(kEverything);
  for (const Face& face : kFaces) {
    // paused, so that nothing moves what was set
    Show show(scene.path());
    show.send("/transport/pause");
    show.engine.tick();
    int rows = 0;
    for (const Sample& sample : samples(show.engine.store())) {
      for (const Row& row : sample.table->rows()) {
        if (!row.writable() || !face.set(sample, row, {})) continue;
        const std::vector<double> value = other_value(row);
        send_now(show, *face.set(sample, row, value));
        expect_value(show, sample.path + "/" + row.name, value, face.name);
        check_bounds(show, face, sample, row);
        rows++;
      }
    }
    EXPECT_GT(rows, 45) << face.name;
  }
  log_to_stderr(true);
}

TEST(EveryRow, InLua) {
  // each is set, read, and told; then comes NaN, which is an error that changes nothing
  const SceneFile plain(kEverything);
  std::string text = std::string(kEverything) + "sim:on_start(function()\n";
  std::vector<std::string> wanted;
  {
    Show rig(plain.path());
    for (const Sample& sample : samples(rig.engine.store())) {
      for (const Row& row : sample.table->rows()) {
        if (!row.writable()) continue;
        const std::string member = sample.lua + "." + row.name;
        const std::vector<double> value = other_value(row);
        const char* nan = row.type == RowType::vec3   ? "vec3(0, 0/0, 0)"
                          : row.type == RowType::quat ? "quat(0/0, 0, 0, 1)"
                                                      : "0/0";
        const std::string path = sample.path + "/" + row.name;
        text += fmt::format("  {0} = {1}\n  osc:send('{4}', (pcall(function() {0} = {2} end)), {3})\n", member,
                            lua_literal(row, value), nan, lua_numbers(row, member), path);
        std::string want = path + " 0";
        for (const double v : value)
          want += " " + (row.type == RowType::choice ? row.choices[static_cast<std::size_t>(v)] : number_text(v));
        wanted.push_back(want);
      }
    }
  }
  const SceneFile scene(text + "end)\n");
  EngineLink link;
  Engine engine(link, fast_options(scene.path()));
  const Result<void> started = engine.start();
  ASSERT_TRUE(started.ok()) << started.error();
  std::vector<Outgoing> out;
  link.outbox.drain(out);
  ASSERT_EQ(out.size(), wanted.size()) << (out.empty() ? "" : text_of(out.back().message));
  EXPECT_GT(out.size(), 50U);
  for (std::size_t i = 0; i < out.size(); i++) EXPECT_EQ(text_of(out[i].message), wanted[i]);
}

TEST(EveryRow, ReadoutsAreReadOnlyInEveryFace) {
  const SceneFile plain(kEverything);
  Show show(plain.path());
  show.ticks(2);
  show.outbox();
  int rows = 0;
  for (const Sample& sample : samples(show.engine.store())) {
    for (const Row& row : sample.table->rows()) {
      if (row.kind != RowKind::readout) continue;
      const std::string path = sample.path + "/" + row.name;
      send_now(show, message(path, 1));
      EXPECT_EQ(show.outbox(), std::vector<std::string>{fmt::format("/error {} this can be read, not set", path)});
      rows++;
    }
  }
  EXPECT_GT(rows, 15);
}

}  // namespace
}  // namespace limber::engine_test
