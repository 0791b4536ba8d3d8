// Stores, recalls and morphs presets through OSC messages.
#include "bench/measure/measures.h"

#include <fmt/format.h>

#include "base/check.h"
#include "bench/measure/arms.h"
#include "bench/measure/times.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// sends messages to the arms; measures processor time, which other programs don't affect
class ArmPresets {
 public:
  explicit ArmPresets(int arms) : arms_(arm_scene(arms)) {
    for (int i = 0; i < 3; i++) arms_.tick();
    send({"/transport/pause", {}});
    empty_ = ticks(8).quantile(0.5);
  }
  engine::Engine& engine() { return arms_.engine(); }

  TimeSamples ticks(int count) {
    TimeSamples all;
    for (int i = 0; i < count; i++) all.add(tick());
    return all;
  }
  /// Returns the seconds that the message adds to a tick while the simulation is paused, including changes in Bullet.
  double send(Message message) {
    arms_.link().command_queue.push({{std::move(message)}, {}});
    const double seconds = tick() - empty_;
    LIMBER_CHECK(arms_.link().counters.refused.load() == 0);
    return seconds;
  }
  /// Seconds of the last tick for scripts and on-change callbacks.
  double value_seconds() { return engine().times().scripts + engine().times().callbacks; }
  /// Stores a preset of the parts' properties only.
  double store_parts() { return send({"/preset/store", {Arg::of("parts"), Arg::of("/physics/body/*/part/*/*")}}); }
  double latest_value_count() { return static_cast<double>(engine().presets().list().back()->values.size()); }
  double preset(const char* action, const char* name) {
    return send({fmt::format("/preset/{}", action), {Arg::of(name)}});
  }

 private:
  double tick() {
    const double start = system::thread_seconds();
    arms_.tick();
    return system::thread_seconds() - start;
  }

  BenchArms arms_;
  double empty_ = 0;  // time of a tick without a message
};

Json min_and_median(const TimeSamples& samples) {
  return {{"min", rounded(samples.quantile(0) * 1e3, 2)}, {"median", rounded(samples.quantile(0.5) * 1e3, 2)}};
}

struct MorphCost {
  TimeSamples tick;  // without a morph
  double seconds = 0;
};

// alternates ticks with and without a morph: ticks get longer as the arms fall
MorphCost cost_of_morph(ArmPresets& bench, int count) {
  MorphCost cost;
  TimeSamples quiet, morphing;
  for (int i = 0; i < count; i++) {
    cost.tick.add(bench.ticks(1).quantile(0));
    quiet.add(bench.value_seconds());
    bench.send({"/preset/recall", {Arg::of("a"), Arg::of(60.0), Arg::of("linear")}});
    bench.ticks(1);
    morphing.add(bench.value_seconds());
    bench.send({"/preset/stop", {}});
  }
  cost.seconds = morphing.quantile(0) - quiet.quantile(0);
  return cost;
}

}  // namespace

Json measure_preset(const MeasureOptions& options) {
  const int count = options.ticks > 0 ? options.ticks : 8;
  ArmPresets bench(1000);
  bench.send({"/physics/part/restitution", {Arg::of(0.1)}});
  const double sudden_store = bench.preset("store", "sudden");
  (void)bench.store_parts();
  const double parts_numbers = bench.latest_value_count();
  // bodies were added, then nothing changes for a while: the next store is prepared in the background
  LIMBER_CHECK(bench.engine().world().add_body("more").ok());
  bench.ticks(200);
  const double first_store = bench.preset("store", "a");
  bench.ticks(200);
  TimeSamples soon, store, first_parts, parts, recall;
  for (int i = 0; i < count; i++) {
    // a body was added just before the store: nothing is prepared
    LIMBER_CHECK(bench.engine().world().add_body(fmt::format("soon{}", i)).ok());
    bench.ticks(2);
    soon.add(bench.preset("store", "soon"));
    // the same, and the patterns must be matched again
    LIMBER_CHECK(bench.engine().world().add_body(fmt::format("parts{}", i)).ok());
    bench.ticks(60);
    first_parts.add(bench.store_parts());
  }
  for (int i = 0; i < count; i++) store.add(bench.preset("store", "again"));
  for (int i = 0; i < count; i++) parts.add(bench.store_parts());

  double value = 0.1;
  for (const char* property :
       {"mass", "linear_damping", "angular_damping", "friction", "rolling_friction", "restitution"})
    bench.send({fmt::format("/physics/part/{}", property), {Arg::of(value += 0.05)}});
  bench.preset("store", "b");
  const double first_recall = bench.preset("recall", "a");
  for (int i = 0; i < count; i++) recall.add(bench.preset("recall", i % 2 == 0 ? "b" : "a"));

  bench.preset("recall", "b");
  bench.send({"/transport/play", {}});
  const MorphCost morph = cost_of_morph(bench, count);
  const engine::Preset& preset = *bench.engine().presets().list().front();
  return {{"things", preset.schema->nodes().size()},
          {"rows", preset.schema->property_count()},
          {"numbers", preset.values.size()},
          {"tick_ms", min_and_median(morph.tick)},
          {"sudden_store_ms", rounded(sudden_store * 1e3, 2)},
          {"first_store_ms", rounded(first_store * 1e3, 2)},
          {"soon_store_ms", min_and_median(soon)},
          {"store_ms", min_and_median(store)},
          {"parts_numbers", parts_numbers},
          {"first_parts_ms", min_and_median(first_parts)},
          {"parts_ms", min_and_median(parts)},
          {"first_recall_ms", rounded(first_recall * 1e3, 2)},
          {"recall_ms", min_and_median(recall)},
          {"morph_ms", rounded(morph.seconds * 1e3, 2)},
          {"morph_percent_of_tick", rounded(100 * morph.seconds / morph.tick.quantile(0), 2)}};
}

}  // namespace limber
