// PolicyBuilder: checks sizes and limits of the steps of a network.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "model/policy/policy_network.h"

namespace limber::model {

namespace {

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

Result<void> check_parameters(std::string_view name, std::initializer_list<std::span<const float>> lists) {
  if (std::all_of(lists.begin(), lists.end(), all_finite)) return {};
  return Error{
      fmt::format("{} has numbers that are not finite. Train again with smaller steps, and export a policy "
                  "that works.",
                  name)};
}

}  // namespace

Result<void> PolicyBuilder::add(std::string_view name, PolicyStep step, std::size_t inputs, std::size_t outputs,
                                std::size_t parameters) {
  if (width_ != 0 && inputs != 0 && inputs != width_)
    return Error{
        fmt::format("{} takes {} inputs, but the step before it has {} outputs. Check the order of the layers.", name,
                    inputs, width_)};
  for (const std::size_t width : {inputs, outputs}) {
    if (width > PolicyNetwork::kMaxWidth)
      return Error{fmt::format("{} has {} values; the maximum is {}. Train a smaller network.", name, width,
                               PolicyNetwork::kMaxWidth)};
  }
  parameters_ += parameters;
  if (parameters_ > PolicyNetwork::kMaxParameters)
    return Error{fmt::format("{}: the network has more than {} parameters. Train a smaller one.", name,
                             PolicyNetwork::kMaxParameters)};
  PolicyNetwork& network = *network_;
  if (network.steps_.size() >= PolicyNetwork::kMaxSteps)
    return Error{
        fmt::format("{}: the network has more than {} steps. Train a smaller one.", name, PolicyNetwork::kMaxSteps)};
  if (network.inputs_ == 0) network.inputs_ = inputs;
  if (outputs != 0) width_ = outputs;
  step.first_hidden = network.hidden_;
  network.hidden_ += step.hidden();
  network.widest_ = std::max({network.widest_, inputs, outputs, 3 * step.hidden()});
  network.steps_.push_back(std::move(step));
  return {};
}

Result<void> PolicyBuilder::linear(std::string_view name, std::size_t outputs, std::size_t inputs,
                                   std::span<const float> values, std::span<const float> bias) {
  if (outputs == 0 || inputs == 0) return Error{fmt::format("{} is empty. Export the policy again.", name)};
  if (Result<void> checked = check_parameters(name, {values, bias}); !checked) return checked;
  PolicyStep step;
  if (outputs <= PolicyNetwork::kMaxWidth && values.size() <= PolicyNetwork::kMaxParameters)
    step.weights = PolicyMatrix(outputs, inputs, values, bias);
  return add(name, std::move(step), inputs, outputs, values.size() + bias.size());
}

Result<void> PolicyBuilder::gru(std::string_view name, std::size_t hidden, std::size_t inputs,
                                std::span<const float> input_weights, std::span<const float> hidden_weights,
                                std::span<const float> input_bias, std::span<const float> hidden_bias) {
  if (hidden == 0 || inputs == 0) return Error{fmt::format("{} is empty. Export the policy again.", name)};
  if (Result<void> checked = check_parameters(name, {input_weights, hidden_weights, input_bias, hidden_bias}); !checked)
    return checked;
  PolicyStep step;
  step.kind = PolicyStep::Kind::gru;
  const std::size_t parameters = input_weights.size() + hidden_weights.size() + input_bias.size() + hidden_bias.size();
  if (hidden <= PolicyNetwork::kMaxWidth && parameters <= PolicyNetwork::kMaxParameters) {
    step.weights = PolicyMatrix(3 * hidden, inputs, input_weights, input_bias);
    step.hidden_weights = PolicyMatrix(3 * hidden, hidden, hidden_weights, hidden_bias);
  }
  return add(name, std::move(step), inputs, hidden, parameters);
}

Result<void> PolicyBuilder::vector(std::string_view name, PolicyStep::Kind kind, std::vector<float> values) {
  if (values.empty()) return Error{fmt::format("{} is empty. Export the policy again.", name)};
  if (Result<void> checked = check_parameters(name, {values}); !checked) return checked;
  const std::size_t width = values.size() == 1 ? width_ : values.size();
  const std::size_t parameters = values.size();
  PolicyStep step;
  step.kind = kind;
  step.vector = std::move(values);
  return add(name, std::move(step), width, width, parameters);
}

Result<void> PolicyBuilder::slice(std::string_view name, std::size_t first, std::size_t count) {
  if (count == 0 || first > width_ || count > width_ - first)
    return Error{
        fmt::format("{} divides {} values into parts of another size. Export the policy again.", name, width_)};
  PolicyStep step;
  step.kind = PolicyStep::Kind::slice;
  step.first = first;
  step.count = count;
  return add(name, std::move(step), width_, count, 0);
}

Result<void> PolicyBuilder::elementwise(std::string_view name, PolicyStep::Kind kind, float a, float b) {
  if (!std::isfinite(a) || !std::isfinite(b))
    return Error{fmt::format("{} has a parameter that is not finite. Export the policy again.", name)};
  PolicyStep step;
  step.kind = kind;
  step.a = a;
  step.b = b;
  return add(name, std::move(step), width_, width_, 0);
}

Result<std::shared_ptr<PolicyNetwork>> PolicyBuilder::finish() {
  if (width_ == 0) return Error{"there is no layer with weights. Export the whole policy."};
  network_->outputs_ = width_;
  return std::move(network_);
}

}  // namespace limber::model
