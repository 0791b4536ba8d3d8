// Files of policies for tests: a writer of safetensors, and networks of random numbers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/random.h"

namespace limber::test {

/// A matrix or vector of numbers with an exact value in single precision.
struct TestTensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;

  double at(std::size_t row, std::size_t column) const { return static_cast<double>(values[row * shape[1] + column]); }
};

inline TestTensor random_tensor(Random& random, std::vector<std::size_t> shape, double amplitude = 0.5) {
  TestTensor tensor{std::move(shape), {}};
  std::size_t count = 1;
  for (const std::size_t side : tensor.shape) count *= side;
  for (std::size_t i = 0; i < count; i++)
    tensor.values.push_back(static_cast<float>(random.uniform(-amplitude, amplitude)));
  return tensor;
}

/// Writes a safetensors file.
class SafetensorsWriter {
 public:
  void add(const std::string& name, const TestTensor& tensor, const std::string& type = "F32") {
    const std::string data(reinterpret_cast<const char*>(tensor.values.data()), tensor.values.size() * sizeof(float));
    add_bytes(name, tensor.shape, type, data);
  }
  void add_bytes(const std::string& name, const std::vector<std::size_t>& shape, const std::string& type,
                 const std::string& bytes) {
    entry(name, fmt::format(R"({{"dtype":"{}","shape":[{}],"data_offsets":[{},{}]}})", type, fmt::join(shape, ","),
                            data_.size(), data_.size() + bytes.size()));
    data_ += bytes;
  }
  void add_metadata(const std::string& key, const std::string& value) {
    metadata_ += fmt::format(R"({}"{}":"{}")", metadata_.empty() ? "" : ",", key, value);
  }
  /// An entry of the header, as JSON.
  void entry(const std::string& name, const std::string& json) {
    header_ += fmt::format(R"({}"{}":{})", header_.empty() ? "" : ",", name, json);
  }
  std::string bytes() const {
    std::string header = "{" + header_;
    if (!metadata_.empty()) header += fmt::format(R"({}"__metadata__":{{{}}})", header_.empty() ? "" : ",", metadata_);
    header += "}";
    std::string length;
    for (int i = 0; i < 8; i++) length += static_cast<char>(header.size() >> (8 * i) & 0xff);
    return length + header + data_;
  }

 private:
  std::string header_, metadata_, data_;
};

/// A policy with one matrix, as a safetensors file.
inline std::string linear_policy(std::vector<std::size_t> shape, std::vector<float> values) {
  SafetensorsWriter writer;
  writer.add("0.weight", {std::move(shape), std::move(values)});
  return writer.bytes();
}

}  // namespace limber::test
