// Time of one evaluation of policies.
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/check.h"
#include "base/system/clock.h"
#include "bench/measure/measures.h"
#include "bench/measure/times.h"
#include "model/policy/policy_file.h"
#include "support/policy_files.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;
using limber::test::random_tensor;
using limber::test::SafetensorsWriter;

constexpr std::size_t kObservations = 48, kActions = 12, kWidth = 256;

std::string mlp_file(const std::string& activation) {
  Random random(1, "mlp");
  SafetensorsWriter writer;
  std::size_t inputs = kObservations;
  for (const auto& [number, outputs] : {std::pair(0, kWidth), std::pair(2, kWidth), std::pair(4, kActions)}) {
    writer.add(fmt::format("{}.weight", number), random_tensor(random, {outputs, inputs}, 0.1));
    writer.add(fmt::format("{}.bias", number), random_tensor(random, {outputs}, 0.1));
    inputs = outputs;
  }
  writer.add_metadata("activation", activation);
  return writer.bytes();
}

std::string gru_file() {
  Random random(2, "gru");
  SafetensorsWriter writer;
  writer.add("weight_ih_l0", random_tensor(random, {3 * kWidth, kObservations}, 0.1));
  writer.add("weight_hh_l0", random_tensor(random, {3 * kWidth, kWidth}, 0.1));
  writer.add("bias_ih_l0", random_tensor(random, {3 * kWidth}, 0.1));
  writer.add("bias_hh_l0", random_tensor(random, {3 * kWidth}, 0.1));
  writer.add("0.weight", random_tensor(random, {kActions, kWidth}, 0.1));
  return writer.bytes();
}

Json policy_times(const std::string& bytes, int evaluations) {
  const auto network = model::parse_policy(bytes, "random.safetensors");
  LIMBER_CHECK(network.ok());
  const model::PolicyNetwork& policy = **network;
  std::vector<double> inputs(policy.inputs(), 0.3), outputs(policy.outputs());
  std::vector<float> hidden(policy.hidden()), workspace(policy.workspace());
  TimeSamples samples;
  for (int i = 0; i < evaluations; i++) {
    const double before = system::clock_seconds();
    LIMBER_CHECK(policy.evaluate(inputs, hidden, outputs, workspace).ok());
    samples.add(system::clock_seconds() - before);
    inputs[static_cast<std::size_t>(i) % inputs.size()] = outputs[0];
  }
  return samples.microseconds();
}

}  // namespace

nlohmann::ordered_json measure_policy(const MeasureOptions& options) {
  const int evaluations = options.ticks > 0 ? options.ticks : 2000;
  return {{"evaluations", evaluations},
          {"mlp 48-256-256-12, relu, us", policy_times(mlp_file("relu"), evaluations)},
          {"mlp 48-256-256-12, elu, us", policy_times(mlp_file("elu"), evaluations)},
          {"mlp 48-256-256-12, tanh, us", policy_times(mlp_file("tanh"), evaluations)},
          {"gru 48-256, linear 256-12, us", policy_times(gru_file(), evaluations)}};
}

}  // namespace limber
