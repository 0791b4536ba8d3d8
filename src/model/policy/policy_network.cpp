// PolicyNetwork: its evaluation.
#include "model/policy/policy_network.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/math/fixed_math.h"

namespace limber::model {

namespace {

using Kind = PolicyStep::Kind;

float sigmoid_of(float x) { return static_cast<float>(1 / (1 + fixed::exp(-static_cast<double>(x)))); }

float softplus_of(float x) {
  const double wide = static_cast<double>(x);
  // e^x is below the precision of a float beside 1, or 1 beside e^x
  if (wide > 20) return x;
  return static_cast<float>(wide < -20 ? fixed::exp(wide) : fixed::log(1 + fixed::exp(wide)));
}

template <class Function>
void for_each(std::span<float> values, Function function) {
  for (float& x : values) x = function(x);
}

void apply_vector(const PolicyStep& step, std::span<float> x) {
  const bool single = step.vector.size() == 1;
  for (std::size_t i = 0; i < x.size(); i++) {
    const float value = step.vector[single ? 0 : i];
    x[i] = step.kind == Kind::scale ? x[i] * value : x[i] + value;
  }
}

void apply_elementwise(const PolicyStep& step, std::span<float> x) {
  const float a = step.a;
  switch (step.kind) {
    case Kind::clip:
      return for_each(x, [&](float v) { return std::clamp(v, a, step.b); });
    case Kind::relu:
      return for_each(x, [](float v) { return std::max(v, 0.0f); });
    case Kind::leaky_relu:
      return for_each(x, [a](float v) { return v < 0 ? a * v : v; });
    case Kind::elu:
      return for_each(x, [a](float v) { return v < 0 ? a * (fixed::expf(v) - 1) : v; });
    case Kind::tanh:
      return for_each(x, fixed::tanhf);
    case Kind::sigmoid:
      return for_each(x, sigmoid_of);
    case Kind::softplus:
      return for_each(x, softplus_of);
    case Kind::silu:
      return for_each(x, [](float v) { return v * sigmoid_of(v); });
    default:
      return apply_vector(step, x);
  }
}

// The next hidden values `to` from the products of the weights with the inputs and with the hidden values `from`.
void apply_gates(std::size_t count, const float* by_inputs, const float* by_hidden, const float* from, float* to) {
  for (std::size_t i = 0; i < count; i++) {
    const float reset = sigmoid_of(by_inputs[i] + by_hidden[i]);
    const float update = sigmoid_of(by_inputs[count + i] + by_hidden[count + i]);
    const float candidate = fixed::tanhf(by_inputs[2 * count + i] + reset * by_hidden[2 * count + i]);
    to[i] = (1 - update) * candidate + update * from[i];
  }
}

}  // namespace

std::size_t PolicyNetwork::workspace() const { return 3 * PolicyMatrix::padded(widest_) + hidden_; }

Result<void> PolicyNetwork::evaluate(std::span<const double> inputs, std::span<float> hidden, std::span<double> outputs,
                                     std::span<float> workspace) const {
  const std::size_t stride = PolicyMatrix::padded(widest_);
  float* x = workspace.data();
  float* y = x + stride;
  float* const by_hidden = y + stride;
  float* const next_hidden = by_hidden + stride;
  for (std::size_t i = 0; i < inputs_; i++) {
    x[i] = static_cast<float>(inputs[i]);
    if (!std::isfinite(x[i])) return Error{fmt::format("observation {} is not finite, or larger than 3e38", i + 1)};
  }
  std::size_t width = inputs_;
  for (const PolicyStep& step : steps_) {
    if (step.kind == Kind::linear) {
      step.weights.multiply(x, y);
      width = step.weights.rows();
      std::swap(x, y);
    } else if (step.kind == Kind::gru) {
      width = step.hidden();
      step.weights.multiply(x, y);
      step.hidden_weights.multiply(hidden.data() + step.first_hidden, by_hidden);
      float* const to = next_hidden + step.first_hidden;
      apply_gates(width, y, by_hidden, hidden.data() + step.first_hidden, to);
      std::copy_n(to, width, x);
    } else if (step.kind == Kind::slice) {
      width = step.count;
      std::copy_n(x + step.first, width, x);
    } else {
      apply_elementwise(step, {x, width});
    }
  }
  for (std::size_t i = 0; i < outputs_; i++) {
    if (!std::isfinite(x[i]))
      return Error{fmt::format("action {} is not finite: the observations or the weights are too large", i + 1)};
  }
  if (!std::all_of(next_hidden, next_hidden + hidden_, [](float v) { return std::isfinite(v); }))
    return Error{"a hidden value is not finite: the observations or the weights are too large"};
  std::copy_n(next_hidden, hidden_, hidden.data());
  for (std::size_t i = 0; i < outputs_; i++) outputs[i] = static_cast<double>(x[i]);
  return {};
}

std::span<const std::string_view> policy_activations() {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"relu", "leaky_relu", "elu", "tanh", "sigmoid", "softplus", "silu"});
  return kNames;
}

std::optional<PolicyStep> policy_activation(std::string_view name) {
  const std::span<const std::string_view> names = policy_activations();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  PolicyStep step;
  step.kind = static_cast<Kind>(static_cast<int>(Kind::relu) + static_cast<int>(found - names.begin()));
  // PyTorch's defaults
  if (step.kind == Kind::leaky_relu) step.a = 0.01f;
  if (step.kind == Kind::elu) step.a = 1;
  return step;
}

}  // namespace limber::model
