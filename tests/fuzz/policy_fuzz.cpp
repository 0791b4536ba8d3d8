// Fuzzes the readers of policies, and the evaluation of the networks that they accept. A header of JSON selects
// safetensors, as its ninth byte is a brace; other inputs are read as ONNX.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fuzz/target.h"
#include "model/policy/policy_file.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using limber::model::PolicyNetwork;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const bool is_safetensors = size > 8 && bytes[8] == '{';
  const auto read = limber::model::parse_policy(bytes, is_safetensors ? "fuzz.safetensors" : "fuzz.onnx");
  if (!read) {
    limber::must(read.error().find("fuzz.") == 0);
    return 0;
  }
  const PolicyNetwork& network = **read;
  limber::must(network.inputs() > 0 && network.inputs() <= PolicyNetwork::kMaxWidth);
  limber::must(network.outputs() > 0 && network.outputs() <= PolicyNetwork::kMaxWidth);
  std::vector<double> inputs(network.inputs(), 0.5), outputs(network.outputs(), 7);
  std::vector<float> hidden(network.hidden()), workspace(network.workspace());
  for (int i = 0; i < 3; i++) {
    const bool done = network.evaluate(inputs, hidden, outputs, workspace).ok();
    for (const double value : outputs) limber::must(std::isfinite(value));
    for (const float value : hidden) limber::must(std::isfinite(value));
    if (!done) break;
  }
  return 0;
}
