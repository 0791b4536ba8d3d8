// The parts of an ONNX file that policies use: nodes, constants, names of inputs and outputs. Included in this folder
// only.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::model::policy {

struct OnnxTensor {
  std::string name;
  std::vector<std::size_t> shape;
  std::vector<float> values;
  bool is_readable = true;  ///< False for types that are not numbers, and for values in other files.
};

struct OnnxAttribute {
  float number = 0;
  std::int64_t whole = 0;
  std::string text;
  std::optional<OnnxTensor> tensor;
  std::vector<float> numbers;
  std::vector<std::int64_t> wholes;
  std::vector<std::string> texts;
};

struct OnnxNode {
  std::string name, op, domain;
  std::vector<std::string> inputs, outputs;  ///< Names of values; empty for an input that is left out.
  std::map<std::string, OnnxAttribute, std::less<>> attributes;

  /// Returns the attribute, or null.
  const OnnxAttribute* attribute(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? nullptr : &found->second;
  }
  float number(std::string_view key, float initial) const {
    const OnnxAttribute* const found = attribute(key);
    return found == nullptr ? initial : found->number;
  }
  std::int64_t whole(std::string_view key, std::int64_t initial) const {
    const OnnxAttribute* const found = attribute(key);
    return found == nullptr ? initial : found->whole;
  }
};

struct OnnxModel {
  std::vector<OnnxNode> nodes;  ///< In the order of their evaluation.
  std::vector<OnnxTensor> constants;
  std::vector<std::string> inputs, outputs;
};

/// Decodes the file's Protocol Buffers. Errors have no place.
Result<OnnxModel> read_onnx_model(std::string_view bytes);

}  // namespace limber::model::policy
