// Decodes ONNX files. Own code instead of protobuf and onnx: a few fields of eight messages, with bounded memory and
// without recursion.
#include "model/policy/onnx_model.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/policy/formats.h"

namespace limber::model::policy {

namespace {

constexpr std::size_t kMaxNodes = 1000, kMaxNames = 10000, kMaxOnnxDimensions = 8;
constexpr std::string_view kDamaged = "is not an ONNX file, or is damaged. Export it again.";

// A field of a message: a whole number (wire types 0, 1 and 5), or bytes (wire type 2).
struct ProtoField {
  std::uint32_t number = 0, wire = 0;
  std::uint64_t whole = 0;
  std::string_view bytes;

  float real() const { return std::bit_cast<float>(static_cast<std::uint32_t>(whole)); }
  std::string text() const { return std::string(bytes); }
};

// Reads the fields of a message one after the other.
class ProtoReader {
 public:
  explicit ProtoReader(std::string_view bytes) : rest_(bytes) {}

  /// Reads a field; false at the end, or if the message is damaged.
  bool next(ProtoField& field) {
    if (rest_.empty() || damaged_) return false;
    const std::uint64_t key = varint();
    field = {static_cast<std::uint32_t>(key >> 3), static_cast<std::uint32_t>(key & 7u), 0, {}};
    if (key >> 3 == 0 || key >> 32 != 0) damaged_ = true;
    switch (field.wire) {
      case 0:
        field.whole = varint();
        break;
      case 1:
        field.whole = fixed<std::uint64_t>();
        break;
      case 2:
        field.bytes = part(varint());
        break;
      case 5:
        field.whole = fixed<std::uint32_t>();
        break;
      default:
        damaged_ = true;
    }
    return !damaged_;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7fu) << shift;
      if (byte < 0x80) return value;
    }
    damaged_ = true;
    return 0;
  }
  bool at_end() const { return rest_.empty() || damaged_; }
  bool is_damaged() const { return damaged_; }

 private:
  std::string_view part(std::uint64_t size) {
    if (size > rest_.size()) {
      damaged_ = true;
      return {};
    }
    const std::string_view bytes = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(bytes.size());
    return bytes;
  }
  template <class T>
  T fixed() {
    const std::string_view bytes = part(sizeof(T));
    return damaged_ ? T{} : little_endian<T>(bytes.data());
  }

  std::string_view rest_;
  bool damaged_ = false;
};

class OnnxReader {
 public:
  Result<OnnxModel> read(std::string_view bytes) {
    bool has_graph = false;
    each_field(bytes, [&](const ProtoField& field) {
      if (field.number != 7) return;
      has_graph = true;
      read_graph(field.bytes);
    });
    if (!error_.empty()) return Error{error_};
    if (!has_graph) return Error{std::string(kDamaged)};
    return std::move(model_);
  }

 private:
  template <class Function>
  void each_field(std::string_view bytes, Function function) {
    ProtoReader reader(bytes);
    ProtoField field;
    while (error_.empty() && reader.next(field)) function(field);
    if (reader.is_damaged()) fail(std::string(kDamaged));
  }
  void fail(std::string text) {
    if (error_.empty()) error_ = std::move(text);
  }
  void add_name(std::vector<std::string>& list, std::string name) {
    if (++names_ > kMaxNames) return fail(fmt::format("has more than {} names. Export a smaller network.", kMaxNames));
    list.push_back(std::move(name));
  }

  void read_graph(std::string_view bytes) {
    each_field(bytes, [&](const ProtoField& field) {
      switch (field.number) {
        case 1:
          return read_node(field.bytes);
        case 5:
          model_.constants.push_back(read_tensor(field.bytes));
          return;
        case 11:
          return add_name(model_.inputs, read_name(field.bytes));
        case 12:
          return add_name(model_.outputs, read_name(field.bytes));
        default:
          return;
      }
    });
  }
  // The name of a ValueInfoProto.
  std::string read_name(std::string_view bytes) {
    std::string name;
    each_field(bytes, [&](const ProtoField& field) {
      if (field.number == 1) name = field.text();
    });
    return name;
  }
  void read_node(std::string_view bytes) {
    if (model_.nodes.size() >= kMaxNodes)
      return fail(fmt::format("has more than {} nodes. Export a smaller network.", kMaxNodes));
    OnnxNode node;
    each_field(bytes, [&](const ProtoField& field) {
      switch (field.number) {
        case 1:
          return add_name(node.inputs, field.text());
        case 2:
          return add_name(node.outputs, field.text());
        case 3:
          node.name = field.text();
          return;
        case 4:
          node.op = field.text();
          return;
        case 5:
          return read_attribute(node, field.bytes);
        case 7:
          node.domain = field.text();
          return;
        default:
          return;
      }
    });
    model_.nodes.push_back(std::move(node));
  }
  void read_attribute(OnnxNode& node, std::string_view bytes) {
    std::string name;
    OnnxAttribute attribute;
    each_field(bytes, [&](const ProtoField& field) {
      switch (field.number) {
        case 1:
          name = field.text();
          return;
        case 2:
          attribute.number = field.real();
          return;
        case 3:
          attribute.whole = static_cast<std::int64_t>(field.whole);
          return;
        case 4:
          attribute.text = field.text();
          return;
        case 5:
          attribute.tensor = read_tensor(field.bytes);
          return;
        case 7:
          return read_reals<float>(attribute.numbers, field);
        case 8:
          return read_whole_numbers(attribute.wholes, field);
        case 9:
          return add_name(attribute.texts, field.text());
        default:
          return;
      }
    });
    if (++names_ > kMaxNames) return fail(fmt::format("has more than {} names. Export a smaller network.", kMaxNames));
    node.attributes[name] = std::move(attribute);
  }

  OnnxTensor read_tensor(std::string_view bytes);
  // Numbers in a packed field, or one in a field of its own.
  template <class T>
  void read_reals(std::vector<float>& to, const ProtoField& field) {
    if (field.wire != 2) {
      reserve_numbers(1);
      to.push_back(sizeof(T) == 4 ? field.real() : static_cast<float>(std::bit_cast<double>(field.whole)));
    } else {
      append_numbers<T>(to, field.bytes, [](T value) { return static_cast<float>(value); });
    }
  }
  template <class T, class Convert>
  void append_numbers(std::vector<float>& to, std::string_view bytes, Convert convert) {
    if (bytes.size() % sizeof(T) != 0) return fail(std::string(kDamaged));
    const std::size_t count = bytes.size() / sizeof(T);
    reserve_numbers(count);
    if (!error_.empty()) return;
    for (std::size_t i = 0; i < count; i++) to.push_back(convert(little_endian<T>(bytes.data() + i * sizeof(T))));
  }
  void read_whole_numbers(std::vector<std::int64_t>& to, const ProtoField& field) {
    ProtoReader packed(field.bytes);
    if (field.wire != 2) to.push_back(static_cast<std::int64_t>(field.whole));
    while (!packed.at_end() && error_.empty()) {
      reserve_numbers(1);
      to.push_back(static_cast<std::int64_t>(packed.varint()));
    }
    if (packed.is_damaged()) fail(std::string(kDamaged));
  }
  void reserve_numbers(std::size_t count) {
    numbers_ += count;
    if (numbers_ > PolicyNetwork::kMaxParameters)
      fail(fmt::format("has more than {} numbers. Train a smaller network.", PolicyNetwork::kMaxParameters));
  }
  void read_shape(OnnxTensor& tensor, std::span<const std::int64_t> shape);
  void read_raw(OnnxTensor& tensor, std::int64_t type, std::string_view raw);

  OnnxModel model_;
  std::string error_;
  std::size_t names_ = 0, numbers_ = 0;
};

// Types of tensors, TensorProto.DataType.
constexpr std::int64_t kFloat = 1;
constexpr std::int64_t kInt64 = 7;
constexpr std::int64_t kHalf = 10;
constexpr std::int64_t kDouble = 11;
constexpr std::int64_t kBfloat16 = 16;

void OnnxReader::read_raw(OnnxTensor& tensor, std::int64_t type, std::string_view raw) {
  switch (type) {
    case kFloat:
      return append_numbers<float>(tensor.values, raw, [](float v) { return v; });
    case kDouble:
      return append_numbers<double>(tensor.values, raw, [](double v) { return static_cast<float>(v); });
    case kHalf:
      return append_numbers<std::uint16_t>(tensor.values, raw, &half_to_float);
    case kBfloat16:
      return append_numbers<std::uint16_t>(tensor.values, raw, [](std::uint16_t v) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(v) << 16);
      });
    case kInt64:
      return append_numbers<std::int64_t>(tensor.values, raw, [](std::int64_t v) { return static_cast<float>(v); });
    default:
      tensor.is_readable = false;
  }
}

OnnxTensor OnnxReader::read_tensor(std::string_view bytes) {
  OnnxTensor tensor;
  std::vector<std::int64_t> shape, wholes;
  std::string_view raw;
  std::int64_t type = 0;
  each_field(bytes, [&](const ProtoField& field) {
    switch (field.number) {
      case 1:
        return read_whole_numbers(shape, field);
      case 2:
        type = static_cast<std::int64_t>(field.whole);
        return;
      case 4:
        return read_reals<float>(tensor.values, field);
      case 7:
        return read_whole_numbers(wholes, field);
      case 8:
        tensor.name = field.text();
        return;
      case 9:
        raw = field.bytes;
        return;
      case 10:
        return read_reals<double>(tensor.values, field);
      case 14:
        tensor.is_readable = tensor.is_readable && field.whole == 0;
        return;
      default:
        return;
    }
  });
  read_raw(tensor, type, raw);
  for (const std::int64_t whole : wholes) tensor.values.push_back(static_cast<float>(whole));
  read_shape(tensor, shape);
  return tensor;
}

// Checks the shape against the numbers.
void OnnxReader::read_shape(OnnxTensor& tensor, std::span<const std::int64_t> shape) {
  std::size_t count = 1;
  for (const std::int64_t side : shape) {
    if (side < 0 || side > static_cast<std::int64_t>(PolicyNetwork::kMaxParameters) ||
        tensor.shape.size() == kMaxOnnxDimensions ||
        count * static_cast<std::size_t>(side) > PolicyNetwork::kMaxParameters)
      fail(fmt::format("constant '{}' has a shape that is not valid. Export the file again.", printable(tensor.name)));
    if (!error_.empty()) return;
    tensor.shape.push_back(static_cast<std::size_t>(side));
    count *= static_cast<std::size_t>(side);
  }
  if (tensor.is_readable && count != tensor.values.size())
    fail(fmt::format("constant '{}' has {} numbers; its shape [{}] needs {}. Export the file again.",
                     printable(tensor.name), tensor.values.size(), fmt::join(tensor.shape, ", "), count));
}

}  // namespace

Result<OnnxModel> read_onnx_model(std::string_view bytes) { return OnnxReader().read(bytes); }

}  // namespace limber::model::policy
