// Stores, recalls and glides, by messages as a performer does.
#include "app/bench_preset.h"

#include <fmt/format.h>

#include "app/bench_arms.h"
#include "app/bench_times.h"
#include "base/check.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// the arms with a hand; times are the processor's, so that other programs' turns do not count
class ArmPresets {
 public:
  explicit ArmPresets(int arms) : arms_(bench_arm_scene(arms)) {
    for (int i = 0; i < 3; i++) arms_.tick();
    send({"/transport/pause", {}});
    empty_ = ticks(8).at(0.5);
  }
  Engine& engine() { return arms_.engine(); }

  Samples ticks(int count) {
    Samples all;
    for (int i = 0; i < count; i++) all.add(tick());
    return all;
  }
  /// Seconds that the message takes of its tick, while time stands still: with what it sets off in Bullet.
  double send(Message message) {
    arms_.link().inbox.push({{std::move(message)}, {}});
    const double seconds = tick() - empty_;
    LIMBER_CHECK(arms_.link().counters.refused.load() == 0);
    return seconds;
  }
  /// Seconds of the last tick in which values went their way into Bullet.
  double of_values() { return engine().times().scripts + engine().times().effects; }
  /// The parts' rows alone.
  double store_parts() { return send({"/preset/store", {Arg::of("parts"), Arg::of("/physics/body/*/part/*/*")}}); }
  double newest_numbers() { return static_cast<double>(engine().presets().list().back()->values.size()); }
  double preset(const char* what, const char* name) { return send({fmt::format("/preset/{}", what), {Arg::of(name)}}); }

 private:
  double tick() {
    const double start = system::thread_seconds();
    arms_.tick();
    return system::thread_seconds() - start;
  }

  BenchArms arms_;
  double empty_ = 0;  // a tick without a message
};

Json least_and_median(const Samples& samples) {
  return {{"min", rounded(samples.at(0) * 1e3, 2)}, {"median", rounded(samples.at(0.5) * 1e3, 2)}};
}

struct MorphCost {
  Samples tick;  // without one
  double seconds = 0;
};

// ticks with a morph and without, by turns: they take longer as the arms fall
MorphCost cost_of_morph(ArmPresets& bench, int count) {
  MorphCost cost;
  Samples quiet, morphing;
  for (int i = 0; i < count; i++) {
    cost.tick.add(bench.ticks(1).at(0));
    quiet.add(bench.of_values());
    bench.send({"/preset/recall", {Arg::of("a"), Arg::of(60.0), Arg::of("linear")}});
    bench.ticks(1);
    morphing.add(bench.of_values());
    bench.send({"/preset/stop", {}});
  }
  cost.seconds = morphing.at(0) - quiet.at(0);
  return cost;
}

}  // namespace

Json bench_preset(const BenchOptions& options) {
  const int count = options.ticks > 0 ? options.ticks : 8;
  ArmPresets bench(1000);
  bench.send({"/physics/part/restitution", {Arg::of(0.1)}});
  const double sudden_store = bench.preset("store", "sudden");
  (void)bench.store_parts();
  const double parts_numbers = bench.newest_numbers();
  // something comes, and for a while nothing does: the next store has been made ready
  LIMBER_CHECK(bench.engine().world().add_body("more").ok());
  bench.ticks(200);
  const double first_store = bench.preset("store", "a");
  bench.ticks(200);
  Samples soon, store, first_parts, parts, recall;
  for (int i = 0; i < count; i++) {
    // something came, and there was no time to look at it
    LIMBER_CHECK(bench.engine().world().add_body(fmt::format("soon{}", i)).ok());
    bench.ticks(2);
    soon.add(bench.preset("store", "soon"));
    // again, and the patterns are new since then
    LIMBER_CHECK(bench.engine().world().add_body(fmt::format("parts{}", i)).ok());
    bench.ticks(60);
    first_parts.add(bench.store_parts());
  }
  for (int i = 0; i < count; i++) store.add(bench.preset("store", "again"));
  for (int i = 0; i < count; i++) parts.add(bench.store_parts());

  double value = 0.1;
  for (const char* row : {"mass", "linear_damping", "angular_damping", "friction", "rolling_friction", "restitution"})
    bench.send({fmt::format("/physics/part/{}", row), {Arg::of(value += 0.05)}});
  bench.preset("store", "b");
  const double first_recall = bench.preset("recall", "a");
  for (int i = 0; i < count; i++) recall.add(bench.preset("recall", i % 2 == 0 ? "b" : "a"));

  bench.preset("recall", "b");
  bench.send({"/transport/play", {}});
  const MorphCost morph = cost_of_morph(bench, count);
  const Preset& preset = *bench.engine().presets().list().front();
  return {{"things", preset.shape->things().size()},
          {"rows", preset.shape->row_count()},
          {"numbers", preset.values.size()},
          {"tick_ms", least_and_median(morph.tick)},
          {"sudden_store_ms", rounded(sudden_store * 1e3, 2)},
          {"first_store_ms", rounded(first_store * 1e3, 2)},
          {"soon_store_ms", least_and_median(soon)},
          {"store_ms", least_and_median(store)},
          {"parts_numbers", parts_numbers},
          {"first_parts_ms", least_and_median(first_parts)},
          {"parts_ms", least_and_median(parts)},
          {"first_recall_ms", rounded(first_recall * 1e3, 2)},
          {"recall_ms", least_and_median(recall)},
          {"morph_ms", rounded(morph.seconds * 1e3, 2)},
          {"morph_percent_of_tick", rounded(100 * morph.seconds / morph.tick.at(0), 2)}};
}

}  // namespace limber
