// Policies: evaluation against a computation in double precision, files, errors.
#include "model/policy/policy_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/policy_files.h"

namespace limber::model {
namespace {

using limber::test::linear_policy;
using limber::test::random_tensor;
using limber::test::SafetensorsWriter;
using limber::test::TestTensor;
using Vector = std::vector<double>;

std::shared_ptr<const PolicyNetwork> policy_of(const std::string& bytes) {
  const auto read = parse_policy(bytes, "walk.safetensors");
  EXPECT_TRUE(read.ok()) << (read ? "" : read.error());
  return read ? *read : nullptr;
}

std::string policy_error(const std::string& bytes, const std::string& file = "walk.safetensors") {
  const auto read = parse_policy(bytes, file);
  return read ? "no error" : read.error();
}

Vector evaluated(const PolicyNetwork& network, const Vector& inputs, std::vector<float>& hidden) {
  Vector outputs(network.outputs());
  std::vector<float> workspace(network.workspace());
  const Result<void> done = network.evaluate(inputs, hidden, outputs, workspace);
  EXPECT_TRUE(done.ok()) << (done ? "" : done.error());
  return outputs;
}
Vector evaluated(const PolicyNetwork& network, const Vector& inputs) {
  std::vector<float> hidden(network.hidden());
  return evaluated(network, inputs, hidden);
}

// matrix · x + bias in double precision
Vector product(const TestTensor& matrix, const TestTensor& bias, const Vector& x) {
  Vector y;
  for (std::size_t row = 0; row < matrix.shape[0]; row++) {
    double sum = static_cast<double>(bias.values[row]);
    for (std::size_t column = 0; column < matrix.shape[1]; column++) sum += matrix.at(row, column) * x[column];
    y.push_back(sum);
  }
  return y;
}

Vector random_inputs(Random& random, std::size_t count) {
  Vector inputs;
  for (std::size_t i = 0; i < count; i++) inputs.push_back(random.uniform(-2, 2));
  return inputs;
}

void expect_close(const Vector& a, const Vector& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); i++) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(Policy, EvaluatesLayersWithEachActivation) {
  const std::pair<const char*, std::function<double(double)>> activations[] = {
      {"relu", [](double x) { return std::max(x, 0.0); }},
      {"leaky_relu", [](double x) { return x < 0 ? 0.01 * x : x; }},
      {"elu", [](double x) { return x < 0 ? std::exp(x) - 1 : x; }},
      {"tanh", [](double x) { return std::tanh(x); }},
      {"sigmoid", [](double x) { return 1 / (1 + std::exp(-x)); }},
      {"softplus", [](double x) { return std::log1p(std::exp(x)); }},
      {"silu", [](double x) { return x / (1 + std::exp(-x)); }},
      {"none", [](double x) { return x; }},
  };
  Random random(1, "policy");
  for (const auto& [name, function] : activations) {
    SCOPED_TRACE(name);
    const TestTensor w0 = random_tensor(random, {37, 5}), b0 = random_tensor(random, {37});
    const TestTensor w2 = random_tensor(random, {3, 37}), b2 = random_tensor(random, {3});
    SafetensorsWriter writer;
    writer.add("2.bias", b2);
    writer.add("2.weight", w2);
    writer.add("0.weight", w0);
    writer.add("0.bias", b0);
    writer.add_metadata("activation", name);
    writer.add_metadata("output", "tanh");
    const auto network = policy_of(writer.bytes());
    ASSERT_NE(network, nullptr);
    ASSERT_EQ(network->inputs(), 5u);
    ASSERT_EQ(network->outputs(), 3u);
    EXPECT_EQ(network->hidden(), 0u);
    for (int i = 0; i < 20; i++) {
      const Vector inputs = random_inputs(random, 5);
      Vector x = product(w0, b0, inputs);
      for (double& v : x) v = function(v);
      x = product(w2, b2, x);
      for (double& v : x) v = std::tanh(v);
      expect_close(evaluated(*network, inputs), x, 3e-6);
    }
  }
}

// The sums are in the order of the inputs, so the exact bits are known.
TEST(Policy, AddsInTheOrderOfTheInputs) {
  const float third = 1.0f / 3;
  const auto network = policy_of(linear_policy({1, 4}, {1e8f, third, -1e8f, third}));
  ASSERT_NE(network, nullptr);
  const volatile float big = 1e8f;
  volatile float sum = 0;
  sum = sum + big;
  sum = sum + third;
  sum = sum - big;
  sum = sum + third;
  EXPECT_EQ(evaluated(*network, {1, 1, 1, 1})[0], static_cast<double>(sum));
}

// torch.nn.GRU: r, z = σ(…), n = tanh(W x + b + r (U h + c)), h' = (1 − z) n + z h
TEST(Policy, EvaluatesAGru) {
  constexpr std::size_t kHidden = 11, kInputs = 4;
  Random random(2, "policy");
  const TestTensor wi = random_tensor(random, {3 * kHidden, kInputs}), bi = random_tensor(random, {3 * kHidden});
  const TestTensor wh = random_tensor(random, {3 * kHidden, kHidden}), bh = random_tensor(random, {3 * kHidden});
  const TestTensor w = random_tensor(random, {2, kHidden}), b = random_tensor(random, {2});
  SafetensorsWriter writer;
  writer.add("head.weight", w);
  writer.add("head.bias", b);
  writer.add("memory.weight_ih_l0", wi);
  writer.add("memory.weight_hh_l0", wh);
  writer.add("memory.bias_ih_l0", bi);
  writer.add("memory.bias_hh_l0", bh);
  const auto network = policy_of(writer.bytes());
  ASSERT_NE(network, nullptr);
  ASSERT_EQ(network->hidden(), kHidden);
  const auto sigmoid = [](double x) { return 1 / (1 + std::exp(-x)); };
  std::vector<float> hidden(kHidden);
  Vector h(kHidden);
  for (int step = 0; step < 30; step++) {
    const Vector inputs = random_inputs(random, kInputs);
    const Vector from_inputs = product(wi, bi, inputs), from_hidden = product(wh, bh, h);
    for (std::size_t i = 0; i < kHidden; i++) {
      const double r = sigmoid(from_inputs[i] + from_hidden[i]);
      const double z = sigmoid(from_inputs[kHidden + i] + from_hidden[kHidden + i]);
      const double n = std::tanh(from_inputs[2 * kHidden + i] + r * from_hidden[2 * kHidden + i]);
      h[i] = (1 - z) * n + z * h[i];
    }
    expect_close(evaluated(*network, inputs, hidden), product(w, b, h), 5e-6);
  }
}

TEST(Policy, NormalizesInputsAndScalesOutputs) {
  SafetensorsWriter writer;
  writer.add("0.weight", {{2, 2}, {1, 0, 0, 1}});
  writer.add("input_mean", {{2}, {1, -1}});
  writer.add("input_std", {{2}, {2, 0.5f}});
  writer.add("output_scale", {{1}, {10}});
  writer.add("output_offset", {{2}, {0.5f, 0.25f}});
  writer.add_metadata("input_clip", "3");
  const auto network = policy_of(writer.bytes());
  ASSERT_NE(network, nullptr);
  EXPECT_EQ(evaluated(*network, {2, -0.5}), (Vector{5.5, 10.25}));
  EXPECT_EQ(evaluated(*network, {100, -100}), (Vector{30.5, -29.75}));
}

TEST(Policy, ReadsEachTypeOfNumbers) {
  const double numbers[] = {1.5, -0.25};
  const auto bytes_of = [](const auto& values) {
    return std::string(reinterpret_cast<const char*>(&values), sizeof values);
  };
  const std::uint16_t halves[] = {0x3e00, 0xb400}, brains[] = {0x3fc0, 0xbe80};
  const std::pair<const char*, std::string> types[] = {
      {"F64", bytes_of(numbers)}, {"F16", bytes_of(halves)}, {"BF16", bytes_of(brains)}};
  for (const auto& [type, bytes] : types) {
    SafetensorsWriter writer;
    writer.add_bytes("weight", {1, 2}, type, bytes);
    const auto network = policy_of(writer.bytes());
    ASSERT_NE(network, nullptr) << type;
    EXPECT_EQ(evaluated(*network, {2, 4}), Vector{2}) << type;
  }
}

TEST(Policy, FollowsAListOfLayers) {
  SafetensorsWriter writer;
  writer.add("value.weight", {{1, 1}, {9}});
  writer.add("body.weight", {{1, 1}, {-2}});
  writer.add("head.weight", {{1, 1}, {3}});
  writer.add("log_std", {{1}, {0}});
  EXPECT_NE(policy_error(writer.bytes()).find("tensor 'log_std' is not known"), std::string::npos);
  writer.add_metadata("layers", "body, relu, head");
  const auto network = policy_of(writer.bytes());
  ASSERT_NE(network, nullptr);
  EXPECT_EQ(evaluated(*network, {1}), Vector{0});
  EXPECT_EQ(evaluated(*network, {-1}), Vector{6});
}

TEST(Policy, AFailedEvaluationChangesNothing) {
  SafetensorsWriter writer;
  writer.add("weight_ih_l0", {{3, 1}, {1, 1, 1}});
  writer.add("weight_hh_l0", {{3, 1}, {1, 1, 1}});
  writer.add("0.weight", {{1, 1}, {3e38f}});
  writer.add("output_scale", {{1}, {10}});
  const auto network = policy_of(writer.bytes());
  ASSERT_NE(network, nullptr);
  std::vector<float> hidden{0.5f}, workspace(network->workspace());
  Vector outputs{7};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(network->evaluate(Vector{nan}, hidden, outputs, workspace).error(),
            "observation 1 is not finite, or larger than 3e38");
  EXPECT_EQ(network->evaluate(Vector{1e300}, hidden, outputs, workspace).error(),
            "observation 1 is not finite, or larger than 3e38");
  EXPECT_EQ(network->evaluate(Vector{1}, hidden, outputs, workspace).error(),
            "action 1 is not finite: the observations or the weights are too large");
  EXPECT_EQ(hidden[0], 0.5f);
  EXPECT_EQ(outputs[0], 7);
  const auto large = policy_of(linear_policy({2, 1}, {1, 3e38f}));
  ASSERT_NE(large, nullptr);
  Vector two{7, 7};
  EXPECT_EQ(large->evaluate(Vector{2}, {}, two, workspace).error(),
            "action 2 is not finite: the observations or the weights are too large");
  EXPECT_EQ(two, (Vector{7, 7}));
}

}  // namespace
}  // namespace limber::model
