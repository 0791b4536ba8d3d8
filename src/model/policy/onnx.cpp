// Reads policies from ONNX files whose graph is a chain of operations on the observations.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/policy/formats.h"
#include "model/policy/onnx_model.h"

namespace limber::model::policy {

namespace {

using Kind = PolicyStep::Kind;

// Operations that keep the numbers of a vector and their order.
constexpr std::string_view kReshaping[] = {"Identity",  "Flatten",   "Reshape", "Squeeze",
                                           "Unsqueeze", "Transpose", "Dropout"};
constexpr std::string_view kSupported =
    "Gemm, MatMul, Add, Sub, Mul, Div, Relu, LeakyRelu, Elu, Tanh, Sigmoid, Softplus, Clip, GRU, Split, Constant, "
    "Identity, Flatten, Reshape, Squeeze, Unsqueeze, Transpose, Dropout";

// The numbers of a matrix with rows and columns exchanged.
std::vector<float> transposed(const OnnxTensor& matrix) {
  const std::size_t rows = matrix.shape[0], columns = matrix.shape[1];
  std::vector<float> values(matrix.values.size());
  for (std::size_t i = 0; i < values.size(); i++) values[i] = matrix.values[i % rows * columns + i / rows];
  return values;
}

// "leaky_relu" for LeakyRelu.
std::string activation_name(std::string_view op) {
  std::string name;
  for (const char c : op) {
    const bool is_capital = c >= 'A' && c <= 'Z';
    if (is_capital && !name.empty()) name += '_';
    name += is_capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

class OnnxPolicy {
 public:
  explicit OnnxPolicy(const OnnxModel& model) : model_(model) {}

  Result<std::shared_ptr<PolicyNetwork>> build();

 private:
  struct Part {
    std::size_t first, count;
  };
  using Step = Result<void> (OnnxPolicy::*)(const OnnxNode& node);
  static Step step_of(std::string_view op);
  Result<void> find_inputs();
  Result<void> add_node(const OnnxNode& node);
  Result<void> add_constant(const OnnxNode& node);
  Result<void> add_reshaping(const OnnxNode& node);
  Result<void> add_product(const OnnxNode& node);
  Result<std::vector<float>> gemm_bias(const OnnxNode& node, std::size_t outputs) const;
  Result<void> add_arithmetic(const OnnxNode& node);
  Result<void> add_vector(const OnnxNode& node, bool is_first, std::vector<float> values);
  Result<void> add_activation(const OnnxNode& node);
  Result<void> add_clip(const OnnxNode& node);
  Result<void> add_split(const OnnxNode& node);
  Result<void> select_part(const OnnxNode& node);
  Result<void> add_gru(const OnnxNode& node);
  Result<void> check_gru(const OnnxNode& node) const;
  const OnnxNode* silu_product(const OnnxNode& sigmoid) const;

  const std::string& input(const OnnxNode& node, std::size_t index) const {
    static const std::string none;
    return index < node.inputs.size() ? node.inputs[index] : none;
  }
  bool is_current(const std::string& name) const { return !name.empty() && current_.contains(name); }
  // Returns the constant, or null.
  const OnnxTensor* constant(const std::string& name) const {
    const auto found = constants_.find(name);
    return found == constants_.end() || !found->second.is_readable ? nullptr : &found->second;
  }
  // The outputs of the node are the vector that the next one works on.
  void advance(const OnnxNode& node) {
    current_.clear();
    current_.insert(node.outputs.begin(), node.outputs.end());
  }
  static std::string node_label(const OnnxNode& node) {
    return fmt::format("node '{}' ({})", printable(node.name), printable(node.op));
  }
  Error wrong_inputs(const OnnxNode& node, std::string_view expected) const {
    return Error{
        fmt::format("{}: expected {}. Export a chain of layers with constant weights.", node_label(node), expected)};
  }

  const OnnxModel& model_;
  std::map<std::string, OnnxTensor, std::less<>> constants_;
  std::set<std::string, std::less<>> current_;      // names of the vector after the last step
  std::set<std::string, std::less<>> hidden_;       // names of hidden values from outside
  std::map<std::string, Part, std::less<>> parts_;  // of the vector, after a Split
  std::size_t at_ = 0;
  PolicyBuilder builder_;
};

OnnxPolicy::Step OnnxPolicy::step_of(std::string_view op) {
  static constexpr std::pair<std::string_view, Step> kSteps[] = {
      {"Gemm", &OnnxPolicy::add_product},       {"MatMul", &OnnxPolicy::add_product},
      {"Add", &OnnxPolicy::add_arithmetic},     {"Sub", &OnnxPolicy::add_arithmetic},
      {"Mul", &OnnxPolicy::add_arithmetic},     {"Div", &OnnxPolicy::add_arithmetic},
      {"Relu", &OnnxPolicy::add_activation},    {"LeakyRelu", &OnnxPolicy::add_activation},
      {"Elu", &OnnxPolicy::add_activation},     {"Tanh", &OnnxPolicy::add_activation},
      {"Sigmoid", &OnnxPolicy::add_activation}, {"Softplus", &OnnxPolicy::add_activation},
      {"Clip", &OnnxPolicy::add_clip},          {"GRU", &OnnxPolicy::add_gru},
      {"Split", &OnnxPolicy::add_split},        {"Constant", &OnnxPolicy::add_constant},
  };
  if (std::ranges::find(kReshaping, op) != std::end(kReshaping)) return &OnnxPolicy::add_reshaping;
  const auto* const found = std::ranges::find(kSteps, op, &std::pair<std::string_view, Step>::first);
  return found == std::end(kSteps) ? nullptr : found->second;
}

Result<std::shared_ptr<PolicyNetwork>> OnnxPolicy::build() {
  if (const Result<void> found = find_inputs(); !found) return Error{found.error()};
  for (; at_ < model_.nodes.size(); at_++) {
    if (const Result<void> added = add_node(model_.nodes[at_]); !added) return Error{added.error()};
  }
  OnnxNode end;
  end.op = "output";
  if (!model_.outputs.empty()) end.inputs = {model_.outputs.front()};
  if (const Result<void> selected = select_part(end); !selected) return Error{selected.error()};
  if (model_.outputs.empty() || !is_current(model_.outputs.front()))
    return Error{
        "the first output is not the end of a chain that begins with the first input. Export the layers that "
        "compute the actions alone."};
  return builder_.finish();
}

// The first input that is not a constant has the observations; others can be hidden values of a GRU.
Result<void> OnnxPolicy::find_inputs() {
  for (const OnnxTensor& tensor : model_.constants) constants_.emplace(tensor.name, tensor);
  for (const std::string& name : model_.inputs) {
    if (constants_.contains(name)) continue;
    (current_.empty() ? current_ : hidden_).insert(name);
  }
  if (current_.empty()) return Error{"the graph has no input. Export the whole policy."};
  return {};
}

Result<void> OnnxPolicy::add_node(const OnnxNode& node) {
  const Step step = node.domain.empty() || node.domain == "ai.onnx" ? step_of(node.op) : nullptr;
  if (step != nullptr && !node.outputs.empty()) {
    if (Result<void> selected = select_part(node); !selected) return selected;
    return (this->*step)(node);
  }
  return Error{fmt::format("{} is not supported; there are: {}. Export the layers that compute the actions alone.",
                           node_label(node), kSupported)};
}

Result<void> OnnxPolicy::add_constant(const OnnxNode& node) {
  OnnxTensor tensor;
  if (const OnnxAttribute* value = node.attribute("value"); value != nullptr && value->tensor) tensor = *value->tensor;
  if (const OnnxAttribute* value = node.attribute("value_float"); value != nullptr) tensor.values = {value->number};
  if (const OnnxAttribute* value = node.attribute("value_floats"); value != nullptr) {
    tensor.values = value->numbers;
    tensor.shape = {tensor.values.size()};
  }
  constants_[node.outputs.front()] = std::move(tensor);
  return {};
}

Result<void> OnnxPolicy::add_reshaping(const OnnxNode& node) {
  const std::string& from = input(node, 0);
  const std::string& to = node.outputs.front();
  if (is_current(from)) {
    current_.insert(to);
  } else if (hidden_.contains(from)) {
    hidden_.insert(to);
  } else if (const OnnxTensor* tensor = constant(from); tensor != nullptr) {
    OnnxTensor changed = *tensor;
    if (node.op == "Transpose" && tensor->shape.size() == 2) {
      changed.shape = {tensor->shape[1], tensor->shape[0]};
      changed.values = transposed(*tensor);
    } else if (node.op != "Identity" && tensor->shape.size() != 1) {
      return wrong_inputs(node, "the vector of the node before");
    }
    constants_[to] = std::move(changed);
  } else {
    return wrong_inputs(node, "the vector of the node before");
  }
  return {};
}

// beta C of a Gemm; empty without C.
Result<std::vector<float>> OnnxPolicy::gemm_bias(const OnnxNode& node, std::size_t outputs) const {
  if (input(node, 2).empty()) return std::vector<float>();
  const OnnxTensor* const added = constant(input(node, 2));
  if (added == nullptr || added->values.empty() || (added->values.size() != outputs && added->values.size() != 1))
    return wrong_inputs(node, "a constant bias with a number for each output");
  std::vector<float> bias = added->values;
  bias.resize(outputs, bias.front());
  const float beta = node.number("beta", 1);
  for (float& value : bias) value *= beta;
  return bias;
}

// Gemm: alpha x B + beta C; MatMul: x B.
Result<void> OnnxPolicy::add_product(const OnnxNode& node) {
  const bool is_gemm = node.op == "Gemm";
  const OnnxTensor* const matrix = constant(input(node, 1));
  if (!is_current(input(node, 0)) || matrix == nullptr || matrix->shape.size() != 2)
    return wrong_inputs(node, "the vector of the node before and a constant matrix");
  if (node.whole("transA", 0) != 0) return wrong_inputs(node, "transA 0");
  const bool by_outputs = is_gemm && node.whole("transB", 0) != 0;
  const std::size_t outputs = matrix->shape[by_outputs ? 0 : 1];
  const std::size_t inputs = matrix->shape[by_outputs ? 1 : 0];
  std::vector<float> values = by_outputs ? matrix->values : transposed(*matrix);
  const float alpha = is_gemm ? node.number("alpha", 1) : 1;
  for (float& value : values) value *= alpha;
  const Result<std::vector<float>> bias = is_gemm ? gemm_bias(node, outputs) : std::vector<float>();
  if (!bias) return Error{bias.error()};
  if (Result<void> added = builder_.linear(node_label(node), outputs, inputs, values, *bias); !added) return added;
  advance(node);
  return {};
}

Result<void> OnnxPolicy::add_arithmetic(const OnnxNode& node) {
  const bool is_first = is_current(input(node, 0));
  const OnnxTensor* const tensor = constant(input(node, is_first ? 1 : 0));
  if (tensor == nullptr || (!is_first && !is_current(input(node, 1))))
    return wrong_inputs(node, "the vector of the node before and a constant");
  std::vector<float> values = tensor->values;
  // its last dimension has a number for each value, the others are 1
  if (!tensor->shape.empty() && tensor->shape.back() != values.size())
    return wrong_inputs(node, "a constant number or vector");
  Result<void> added = add_vector(node, is_first, std::move(values));
  if (added) advance(node);
  return added;
}

// `is_first`: the vector of the node before is the first operand, else the constant.
Result<void> OnnxPolicy::add_vector(const OnnxNode& node, bool is_first, std::vector<float> values) {
  const std::string label = node_label(node);
  if (node.op == "Add") return builder_.vector(label, Kind::shift, std::move(values));
  if (node.op == "Mul") return builder_.vector(label, Kind::scale, std::move(values));
  if (node.op == "Div") {
    if (!is_first) return wrong_inputs(node, "the vector of the node before, divided by a constant");
    for (float& value : values) value = 1 / value;
    return builder_.vector(label, Kind::scale, std::move(values));
  }
  if (is_first) {
    for (float& value : values) value = -value;
  } else if (Result<void> negated = builder_.vector(label, Kind::scale, {-1}); !negated) {
    return negated;
  }
  return builder_.vector(label, Kind::shift, std::move(values));
}

// The node after a sigmoid, if it multiplies its input with its output: x · sigmoid(x). Else null.
const OnnxNode* OnnxPolicy::silu_product(const OnnxNode& sigmoid) const {
  if (at_ + 1 >= model_.nodes.size()) return nullptr;
  const OnnxNode& next = model_.nodes[at_ + 1];
  const bool has_sigmoid = input(next, 0) == sigmoid.outputs.front() || input(next, 1) == sigmoid.outputs.front();
  const bool has_input = is_current(input(next, 0)) || is_current(input(next, 1));
  return next.op == "Mul" && has_sigmoid && has_input && !next.outputs.empty() ? &next : nullptr;
}

Result<void> OnnxPolicy::add_activation(const OnnxNode& node) {
  if (!is_current(input(node, 0))) return wrong_inputs(node, "the vector of the node before");
  PolicyStep step = *policy_activation(activation_name(node.op));
  if (step.kind == Kind::elu || step.kind == Kind::leaky_relu) step.a = node.number("alpha", step.a);
  const OnnxNode* const product = step.kind == Kind::sigmoid ? silu_product(node) : nullptr;
  if (product != nullptr) {
    step.kind = Kind::silu;
    at_++;
  }
  Result<void> added = builder_.elementwise(node_label(node), step.kind, step.a);
  if (added) advance(product == nullptr ? node : *product);
  return added;
}

Result<void> OnnxPolicy::add_clip(const OnnxNode& node) {
  std::array<float, 2> limits = {node.number("min", -3e38f), node.number("max", 3e38f)};
  for (std::size_t i = 0; i < 2; i++) {
    if (input(node, i + 1).empty()) continue;
    const OnnxTensor* const limit = constant(input(node, i + 1));
    if (limit == nullptr || limit->values.size() != 1) return wrong_inputs(node, "constant limits");
    limits[i] = limit->values[0];
  }
  if (!is_current(input(node, 0)) || limits[0] > limits[1])
    return wrong_inputs(node, "the vector of the node before, and a minimum up to the maximum");
  if (Result<void> added = builder_.elementwise(node_label(node), Kind::clip, limits[0], limits[1]); !added)
    return added;
  advance(node);
  return {};
}

// The gates in ONNX: update, reset, new; here: reset, update, new.
std::vector<float> reordered_gates(std::span<const float> values) {
  const std::size_t gate = values.size() / 3;
  std::vector<float> to(values.begin(), values.end());
  std::swap_ranges(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(gate),
                   to.begin() + static_cast<std::ptrdiff_t>(gate));
  return to;
}

// The sizes of the parts are given, or equal. Later nodes use one of the parts.
Result<void> OnnxPolicy::add_split(const OnnxNode& node) {
  if (!is_current(input(node, 0))) return wrong_inputs(node, "the vector of the node before");
  std::vector<std::size_t> sizes(node.outputs.size(), builder_.width() / node.outputs.size());
  const OnnxTensor* const given = constant(input(node, 1));
  const OnnxAttribute* const listed = node.attribute("split");
  for (std::size_t i = 0; i < sizes.size(); i++) {
    if (given != nullptr && i < given->values.size()) {
      const float size = given->values[i];
      sizes[i] = size >= 0 && size <= static_cast<float>(PolicyNetwork::kMaxWidth) ? static_cast<std::size_t>(size) : 0;
    } else if (listed != nullptr && i < listed->wholes.size()) {
      sizes[i] = static_cast<std::size_t>(std::clamp<std::int64_t>(listed->wholes[i], 0, PolicyNetwork::kMaxWidth));
    }
  }
  parts_.clear();
  std::size_t first = 0;
  for (std::size_t i = 0; i < sizes.size(); i++) {
    parts_[node.outputs[i]] = {first, sizes[i]};
    first += sizes[i];
  }
  if (first != builder_.width()) return wrong_inputs(node, "parts that have the size of the vector");
  current_.clear();
  return {};
}

// If the node uses a part of a divided vector, that part is the vector from now on.
Result<void> OnnxPolicy::select_part(const OnnxNode& node) {
  for (const std::string& name : node.inputs) {
    const auto part = parts_.find(name);
    if (part == parts_.end()) continue;
    const Part selected = part->second;
    parts_.clear();
    current_ = {name};
    return builder_.slice(node_label(node), selected.first, selected.count);
  }
  return {};
}

// Checks attributes and initial hidden values.
Result<void> OnnxPolicy::check_gru(const OnnxNode& node) const {
  if (node.whole("linear_before_reset", 0) != 1)
    return wrong_inputs(node, "linear_before_reset 1, as PyTorch exports it");
  for (const char* key : {"activations", "clip"}) {
    if (node.attribute(key) != nullptr) return wrong_inputs(node, fmt::format("no attribute {}", key));
  }
  const OnnxAttribute* const direction = node.attribute("direction");
  if (direction != nullptr && direction->text != "forward") return wrong_inputs(node, "direction forward");
  const std::string& initial = input(node, 5);
  const OnnxTensor* const zeros = constant(initial);
  const bool starts_with_zeros = zeros != nullptr && std::ranges::all_of(zeros->values, [](float v) { return v == 0; });
  if (initial.empty() || hidden_.contains(initial) || starts_with_zeros) return {};
  return wrong_inputs(node, "hidden values from an input of the graph, or zeros");
}

Result<void> OnnxPolicy::add_gru(const OnnxNode& node) {
  const OnnxTensor* const by_inputs = constant(input(node, 1));
  const OnnxTensor* const by_hidden = constant(input(node, 2));
  const auto is_gates = [](const OnnxTensor* tensor) {
    return tensor != nullptr && tensor->shape.size() == 3 && tensor->shape[0] == 1;
  };
  if (!is_current(input(node, 0)) || !is_gates(by_inputs) || !is_gates(by_hidden))
    return wrong_inputs(node, "the vector of the node before, and constant weights of one direction");
  const std::size_t hidden = by_hidden->shape[2], inputs = by_inputs->shape[2];
  if (by_inputs->shape[1] != 3 * hidden || by_hidden->shape[1] != 3 * hidden)
    return wrong_inputs(node, "weights of three gates");
  if (Result<void> checked = check_gru(node); !checked) return checked;
  std::span<const float> biases;
  if (!input(node, 3).empty()) {
    const OnnxTensor* const added = constant(input(node, 3));
    if (added == nullptr || added->values.size() != 6 * hidden) return wrong_inputs(node, "constant biases");
    biases = added->values;
  }
  const std::size_t half = biases.size() / 2;
  Result<void> added = builder_.gru(node_label(node), hidden, inputs, reordered_gates(by_inputs->values),
                                    reordered_gates(by_hidden->values), reordered_gates(biases.first(half)),
                                    reordered_gates(biases.last(half)));
  if (added) advance(node);
  return added;
}

}  // namespace

Result<std::shared_ptr<PolicyNetwork>> read_onnx(std::string_view bytes) {
  const Result<OnnxModel> model = read_onnx_model(bytes);
  if (!model) return Error{model.error()};
  return OnnxPolicy(*model).build();
}

}  // namespace limber::model::policy
