// Reads policies from safetensors files: the length of a JSON header, the header with name, type, shape and place of
// each tensor, the numbers.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "model/policy/formats.h"

namespace limber::model::policy {

namespace {

using Json = nlohmann::json;
using Kind = PolicyStep::Kind;

constexpr std::size_t kMaxHeader = 1u << 20, kMaxTensors = 1000, kMaxDimensions = 8;
constexpr std::string_view kBadFile = "is not a safetensors file, or is damaged. Export it again.";

struct Tensor {
  std::string name;
  std::vector<std::size_t> shape;
  std::vector<float> values;
};
using Tensors = std::map<std::string, Tensor, std::less<>>;

std::string shape_text(const Tensor& tensor) { return fmt::format("[{}]", fmt::join(tensor.shape, ", ")); }
std::string tensor_label(std::string_view name) { return fmt::format("tensor '{}'", printable(name)); }

// A whole number of JSON in 0 .. max.
std::optional<std::size_t> whole_number(const Json& value, std::size_t max) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > max) return {};
  return static_cast<std::size_t>(value.get<std::uint64_t>());
}

struct NumberType {
  std::string_view name;
  std::size_t bytes;
  float (*read)(const char*);
};
constexpr NumberType kNumberTypes[] = {
    {"F32", 4, [](const char* at) { return little_endian<float>(at); }},
    {"F64", 8, [](const char* at) { return static_cast<float>(little_endian<double>(at)); }},
    {"F16", 2, [](const char* at) { return half_to_float(little_endian<std::uint16_t>(at)); }},
    {"BF16", 2,
     [](const char* at) {
       return std::bit_cast<float>(static_cast<std::uint32_t>(little_endian<std::uint16_t>(at)) << 16);
     }},
};

// Reads the shape of a tensor into `to`; returns the number of its elements, or nothing.
std::optional<std::size_t> read_shape(const Json& shape, Tensor& to) {
  std::size_t count = 1;
  for (const Json& side : shape) {
    const auto length = whole_number(side, PolicyNetwork::kMaxParameters);
    if (!length || to.shape.size() == kMaxDimensions || count * *length > PolicyNetwork::kMaxParameters) return {};
    to.shape.push_back(*length);
    count *= *length;
  }
  return count;
}

// The bytes of a tensor; empty if they are not within the data or have another size.
std::optional<std::string_view> bytes_at(const Json& offsets, std::size_t size, std::string_view data) {
  const auto begin = whole_number(offsets[0], data.size());
  const auto end = whole_number(offsets[1], data.size());
  if (!begin || !end || *end < *begin || *end - *begin != size) return {};
  return data.substr(*begin, size);
}

bool is_tensor_entry(const Json& entry) {
  if (!entry.is_object() || !entry.contains("dtype") || !entry.contains("shape") || !entry.contains("data_offsets"))
    return false;
  return entry["dtype"].is_string() && entry["shape"].is_array() && entry["data_offsets"].is_array() &&
         entry["data_offsets"].size() == 2;
}

Result<Tensor> read_tensor(const std::string& name, const Json& entry, std::string_view data) {
  const std::string subject = tensor_label(name);
  if (!is_tensor_entry(entry))
    return Error{fmt::format("{} needs dtype, shape and data_offsets. Export the file again.", subject)};
  const auto dtype = entry["dtype"].get<std::string>();
  const auto* const type = std::ranges::find(kNumberTypes, dtype, &NumberType::name);
  if (type == std::end(kNumberTypes))
    return Error{fmt::format("{} has the type {}; F32, F64, F16 and BF16 are read. Convert it to F32.", subject,
                             printable(shortened(dtype, 16)))};
  Tensor tensor{name, {}, {}};
  const std::optional<std::size_t> count = read_shape(entry["shape"], tensor);
  if (!count)
    return Error{fmt::format("{} has a shape that is not valid, or more than {} numbers. Train a smaller network.",
                             subject, PolicyNetwork::kMaxParameters)};
  const std::optional<std::string_view> bytes = bytes_at(entry["data_offsets"], *count * type->bytes, data);
  if (!bytes)
    return Error{fmt::format("{}: data_offsets don't fit its shape {} or the size of the file. Export it again.",
                             subject, shape_text(tensor))};
  tensor.values.reserve(*count);
  for (std::size_t i = 0; i < *count; i++) tensor.values.push_back(type->read(bytes->data() + i * type->bytes));
  return tensor;
}

// The tensors of a layer: one with weights and perhaps bias, or a GRU.
struct Layer {
  const Tensor* weight = nullptr;
  const Tensor* bias = nullptr;
  const Tensor* hidden_weight = nullptr;
  const Tensor* hidden_bias = nullptr;
  bool is_gru = false;
};
using Layers = std::map<std::string, Layer, std::less<>>;

struct TensorRole {
  std::string_view end;
  bool is_gru;
  const Tensor* Layer::*tensor;
};
constexpr TensorRole kRoles[] = {
    {"weight", false, &Layer::weight},      {"bias", false, &Layer::bias},
    {"weight_ih_l0", true, &Layer::weight}, {"weight_hh_l0", true, &Layer::hidden_weight},
    {"bias_ih_l0", true, &Layer::bias},     {"bias_hh_l0", true, &Layer::hidden_bias},
};

class SafetensorsReader {
 public:
  Result<std::shared_ptr<PolicyNetwork>> read(std::string_view bytes) {
    if (const Result<void> read = read_header(bytes); !read) return Error{read.error()};
    if (const Result<void> built = build(); !built) return Error{built.error()};
    return builder_.finish();
  }

 private:
  Result<void> read_header(std::string_view bytes);
  Result<void> read_metadata(const Json& metadata);
  Result<void> build();
  void find_layers();
  Result<std::vector<std::string>> ordered_layers() const;
  Result<void> add_layers();
  Result<void> add_listed_layers(std::string_view list);
  Result<void> add_layer(const std::string& name, const Layer& layer);
  Result<void> add_gru(const std::string& name, const Layer& layer);
  Result<void> add_activation(std::string_view name, std::string_view key);
  Result<void> add_inputs();
  Result<void> add_vector(std::string_view name, Kind kind, float (*convert)(float));
  const std::string* metadata(std::string_view key) const {
    const auto found = metadata_.find(key);
    return found == metadata_.end() ? nullptr : &found->second;
  }

  Tensors tensors_;
  std::map<std::string, std::string, std::less<>> metadata_;
  Layers layers_;
  std::vector<std::string> unknown_;  // tensors that belong to no layer
  PolicyBuilder builder_;
};

Result<void> SafetensorsReader::read_header(std::string_view bytes) {
  constexpr std::size_t kLength = 8;
  if (bytes.size() < kLength) return Error{std::string(kBadFile)};
  const auto length = little_endian<std::uint64_t>(bytes.data());
  if (length > bytes.size() - kLength || bytes[kLength] != '{') return Error{std::string(kBadFile)};
  if (length > kMaxHeader)
    return Error{fmt::format("the header has {} bytes; the maximum is {}. Remove metadata.", length, kMaxHeader)};
  const Json header = Json::parse(bytes.substr(kLength, length), nullptr, false);
  if (!header.is_object()) return Error{"the header is not valid JSON. Export the file again."};
  const std::string_view data = bytes.substr(kLength + length);
  if (header.size() > kMaxTensors + 1)
    return Error{fmt::format("there are more than {} tensors. Train a smaller network.", kMaxTensors)};
  std::size_t total = 0;
  for (const auto& [name, entry] : header.items()) {
    if (name == "__metadata__") {
      if (Result<void> read = read_metadata(entry); !read) return read;
      continue;
    }
    Result<Tensor> tensor = read_tensor(name, entry, data);
    if (!tensor) return Error{tensor.error()};
    total += tensor->values.size();
    if (total > PolicyNetwork::kMaxParameters)
      return Error{fmt::format("the tensors have more than {} numbers. Train a smaller network.",
                               PolicyNetwork::kMaxParameters)};
    tensors_.emplace(name, std::move(*tensor));
  }
  return {};
}

Result<void> SafetensorsReader::read_metadata(const Json& metadata) {
  if (!metadata.is_object()) return Error{"__metadata__ is not an object of texts. Export the file again."};
  for (const auto& [key, value] : metadata.items()) {
    if (!value.is_string())
      return Error{fmt::format("__metadata__: {} is not a text. Write it in quotation marks.", printable(key))};
    metadata_.emplace(key, value.get<std::string>());
  }
  return {};
}

void SafetensorsReader::find_layers() {
  static constexpr std::string_view kVectors[] = {"input_mean", "input_std", "output_scale", "output_offset"};
  for (const auto& [name, tensor] : tensors_) {
    if (std::ranges::find(kVectors, std::string_view(name)) != std::end(kVectors)) continue;
    const std::size_t dot = name.rfind('.');
    const std::string_view end = std::string_view(name).substr(dot == std::string::npos ? 0 : dot + 1);
    const auto* const role = std::ranges::find(kRoles, end, &TensorRole::end);
    if (role == std::end(kRoles)) {
      unknown_.push_back(name);
      continue;
    }
    Layer& layer = layers_[dot == std::string::npos ? "" : name.substr(0, dot)];
    layer.is_gru = layer.is_gru || role->is_gru;
    layer.*(role->tensor) = &tensor;
  }
}

// The layers by the numbers at the end of their names, which must be equal before; a GRU first.
Result<std::vector<std::string>> SafetensorsReader::ordered_layers() const {
  constexpr std::string_view kFix =
      "List the layers and activations in __metadata__, such as {\"layers\": \"body.0, tanh, body.2, tanh, head\"}.";
  if (!unknown_.empty())
    return Error{
        fmt::format("{} is not known: the names of tensors end with weight, bias, or those of a GRU "
                    "(weight_ih_l0, weight_hh_l0, bias_ih_l0, bias_hh_l0). {}",
                    tensor_label(unknown_.front()), kFix)};
  std::vector<std::string> order;
  std::vector<std::pair<std::size_t, std::string>> numbered;
  std::optional<std::string_view> prefix;
  const auto linear_count = std::ranges::count_if(layers_, [](const auto& layer) { return !layer.second.is_gru; });
  for (const auto& [name, layer] : layers_) {
    if (layer.is_gru || linear_count == 1) {
      if (layer.is_gru && !order.empty())
        return Error{fmt::format("the order of the layers '{}' and '{}' is not known. {}", printable(order.front()),
                                 printable(name), kFix)};
      layer.is_gru ? void(order.push_back(name)) : void(numbered.emplace_back(0, name));
      continue;
    }
    const std::string_view text = name;
    const std::size_t digits = text.size() - std::min(text.size(), text.find_last_not_of("0123456789") + 1);
    const std::string_view before = text.substr(0, text.size() - digits);
    std::size_t number = 0;
    const auto parsed = std::from_chars(text.data() + before.size(), text.data() + text.size(), number);
    if (digits == 0 || parsed.ec != std::errc() || (prefix && *prefix != before))
      return Error{fmt::format("the order of the layer '{}' is not known. {}", printable(name), kFix)};
    prefix = before;
    numbered.emplace_back(number, name);
  }
  std::ranges::sort(numbered);
  for (auto& [number, name] : numbered) order.push_back(std::move(name));
  return order;
}

Result<void> SafetensorsReader::add_activation(std::string_view name, std::string_view key) {
  if (name == "none") return {};
  const std::optional<PolicyStep> step = policy_activation(name);
  if (step) return builder_.elementwise(name, step->kind, step->a, step->b);
  std::vector<std::string_view> names(policy_activations().begin(), policy_activations().end());
  names.emplace_back("none");
  return Error{
      fmt::format("__metadata__: {} has no value '{}'{}", key, printable(shortened(name, 60)), name_hint(name, names))};
}

Result<void> SafetensorsReader::add_gru(const std::string& name, const Layer& layer) {
  const std::string subject = fmt::format("GRU '{}'", printable(name));
  if (layer.weight == nullptr || layer.hidden_weight == nullptr)
    return Error{fmt::format("{} needs weight_ih_l0 and weight_hh_l0. Export the whole layer.", subject)};
  const Tensor& by_inputs = *layer.weight;
  const Tensor& by_hidden = *layer.hidden_weight;
  const bool flat = by_inputs.shape.size() == 2 && by_hidden.shape.size() == 2;
  const std::size_t hidden = flat ? by_hidden.shape[1] : 0;
  const bool fits = flat && by_hidden.shape[0] == 3 * hidden && by_inputs.shape[0] == 3 * hidden;
  if (!fits)
    return Error{
        fmt::format("{}: weight_ih_l0 has the shape {}, weight_hh_l0 {}; expected [3 N, inputs] and [3 N, N] "
                    "for N hidden values. Export an nn.GRU with one layer.",
                    subject, shape_text(by_inputs), shape_text(by_hidden))};
  for (const Tensor* bias : {layer.bias, layer.hidden_bias}) {
    if (bias != nullptr && bias->values.size() != 3 * hidden)
      return Error{fmt::format("{} has the shape {}; expected [{}]. Export it again.", tensor_label(bias->name),
                               shape_text(*bias), 3 * hidden)};
  }
  const auto values_of = [](const Tensor* tensor) {
    return tensor == nullptr ? std::span<const float>() : std::span<const float>(tensor->values);
  };
  return builder_.gru(subject, hidden, by_inputs.shape[1], by_inputs.values, by_hidden.values, values_of(layer.bias),
                      values_of(layer.hidden_bias));
}

Result<void> SafetensorsReader::add_layer(const std::string& name, const Layer& layer) {
  if (layer.is_gru) return add_gru(name, layer);
  if (layer.weight == nullptr)
    return Error{fmt::format("{} has no weight beside it. Export the whole layer.", tensor_label(layer.bias->name))};
  const Tensor& weight = *layer.weight;
  if (weight.shape.size() != 2)
    return Error{fmt::format("{} has the shape {}; expected [outputs, inputs]. Only linear layers and GRUs are read.",
                             tensor_label(weight.name), shape_text(weight))};
  if (layer.bias != nullptr && layer.bias->values.size() != weight.shape[0])
    return Error{fmt::format("{} has the shape {}; expected [{}]. Export it again.", tensor_label(layer.bias->name),
                             shape_text(*layer.bias), weight.shape[0])};
  const std::span<const float> bias = layer.bias == nullptr ? std::span<const float>() : layer.bias->values;
  return builder_.linear(tensor_label(weight.name), weight.shape[0], weight.shape[1], weight.values, bias);
}

// "body.0, tanh, head": names of layers and activations.
Result<void> SafetensorsReader::add_listed_layers(std::string_view list) {
  for (std::string_view word : split(list, ',')) {
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    const auto layer = layers_.find(word);
    Result<void> added = {};
    if (layer != layers_.end()) {
      added = add_layer(layer->first, layer->second);
    } else if (word == "none" || policy_activation(word)) {
      added = add_activation(word, "layers");
    } else {
      std::vector<std::string_view> names(policy_activations().begin(), policy_activations().end());
      for (const auto& [name, known] : layers_) names.emplace_back(name);
      return Error{fmt::format("__metadata__: layers has '{}', which is neither a layer nor an activation{}",
                               printable(shortened(word, 60)), name_hint(word, names))};
    }
    if (!added) return added;
  }
  return {};
}

Result<void> SafetensorsReader::add_layers() {
  if (const std::string* list = metadata("layers")) return add_listed_layers(*list);
  const Result<std::vector<std::string>> order = ordered_layers();
  if (!order) return Error{order.error()};
  const std::string* const activation = metadata("activation");
  for (std::size_t i = 0; i < order->size(); i++) {
    const std::string& name = (*order)[i];
    const Layer& layer = layers_.find(name)->second;
    if (Result<void> added = add_layer(name, layer); !added) return added;
    if (layer.is_gru || i + 1 == order->size()) continue;
    if (activation == nullptr)
      return Error{
          fmt::format("the activation between the layers is not given. Write __metadata__ {{\"activation\": "
                      "\"tanh\"}}; there are: {}, none.",
                      fmt::join(policy_activations(), ", "))};
    if (Result<void> added = add_activation(*activation, "activation"); !added) return added;
  }
  return {};
}

Result<void> SafetensorsReader::add_vector(std::string_view name, Kind kind, float (*convert)(float)) {
  const auto tensor = tensors_.find(name);
  if (tensor == tensors_.end()) return {};
  std::vector<float> values = tensor->second.values;
  std::ranges::transform(values, values.begin(), convert);
  return builder_.vector(tensor_label(name), kind, std::move(values));
}

// (x - input_mean) / input_std, clamped to ± input_clip
Result<void> SafetensorsReader::add_inputs() {
  if (Result<void> mean = add_vector("input_mean", Kind::shift, [](float v) { return -v; }); !mean) return mean;
  if (const auto std = tensors_.find("input_std"); std != tensors_.end()) {
    for (const float value : std->second.values) {
      if (!(value > 0))
        return Error{"tensor 'input_std' has a number that is not above 0. Add a small constant to it."};
    }
  }
  if (Result<void> std = add_vector("input_std", Kind::scale, [](float v) { return 1 / v; }); !std) return std;
  const std::string* const clip = metadata("input_clip");
  if (clip == nullptr) return {};
  const std::optional<double> limit = parse_number(*clip);
  if (!limit || !(*limit > 0 && *limit <= 1e6))
    return Error{fmt::format("__metadata__: input_clip is a number above 0 and at most 1e6, not '{}'.",
                             printable(shortened(*clip, 60)))};
  return builder_.elementwise("input_clip", Kind::clip, static_cast<float>(-*limit), static_cast<float>(*limit));
}

Result<void> SafetensorsReader::build() {
  find_layers();
  if (Result<void> added = add_inputs(); !added) return added;
  if (Result<void> added = add_layers(); !added) return added;
  if (const std::string* output = metadata("output")) {
    if (Result<void> added = add_activation(*output, "output"); !added) return added;
  }
  const auto same = [](float v) { return v; };
  if (Result<void> scale = add_vector("output_scale", Kind::scale, same); !scale) return scale;
  return add_vector("output_offset", Kind::shift, same);
}

}  // namespace

Result<std::shared_ptr<PolicyNetwork>> read_safetensors(std::string_view bytes) {
  return SafetensorsReader().read(bytes);
}

}  // namespace limber::model::policy
