// Writes ONNX files for tests, with the field numbers of onnx.proto.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/policy_files.h"

namespace limber::test {

/// A message of Protocol Buffers.
class ProtoWriter {
 public:
  ProtoWriter& whole(int field, std::int64_t value) {
    varint(static_cast<std::uint64_t>(field) << 3);
    varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  ProtoWriter& real(int field, float value) {
    varint(static_cast<std::uint64_t>(field) << 3 | 5u);
    append(&value, sizeof value);
    return *this;
  }
  ProtoWriter& text(int field, const std::string& value) {
    varint(static_cast<std::uint64_t>(field) << 3 | 2u);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtoWriter& message(int field, const ProtoWriter& value) { return text(field, value.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>((value & 0x7fu) | 0x80u);
    bytes_ += static_cast<char>(value);
  }
  void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }

  std::string bytes_;
};

/// A graph: nodes, constants, inputs, outputs.
class OnnxWriter {
 public:
  struct Node {
    std::string op;
    std::vector<std::string> inputs, outputs;
    std::vector<ProtoWriter> attributes = {};
    std::string domain = {};
  };

  static ProtoWriter attribute(const std::string& name, float value) {
    return ProtoWriter().text(1, name).real(2, value).whole(20, 1);
  }
  static ProtoWriter attribute(const std::string& name, int value) {
    return ProtoWriter().text(1, name).whole(3, value).whole(20, 2);
  }
  static ProtoWriter attribute(const std::string& name, const ProtoWriter& tensor) {
    return ProtoWriter().text(1, name).message(5, tensor).whole(20, 4);
  }
  /// raw: the numbers are in raw_data, else in float_data.
  static ProtoWriter tensor(const std::string& name, const TestTensor& from, bool raw = true) {
    ProtoWriter to;
    for (const std::size_t side : from.shape) to.whole(1, static_cast<std::int64_t>(side));
    to.whole(2, 1).text(8, name);
    const std::string data(reinterpret_cast<const char*>(from.values.data()), from.values.size() * sizeof(float));
    to.text(raw ? 9 : 4, data);
    return to;
  }

  void add(const Node& node) {
    ProtoWriter to;
    for (const std::string& name : node.inputs) to.text(1, name);
    for (const std::string& name : node.outputs) to.text(2, name);
    to.text(3, "/" + node.op + "_" + std::to_string(count_++)).text(4, node.op);
    for (const ProtoWriter& attribute : node.attributes) to.message(5, attribute);
    if (!node.domain.empty()) to.text(7, node.domain);
    graph_.message(1, to);
  }
  void add_constant(const std::string& name, const TestTensor& values, bool raw = true) {
    graph_.message(5, tensor(name, values, raw));
  }
  void add_input(const std::string& name) { graph_.message(11, ProtoWriter().text(1, name)); }
  void add_output(const std::string& name) { graph_.message(12, ProtoWriter().text(1, name)); }
  std::string bytes() const {
    return ProtoWriter().whole(1, 8).text(2, "test").message(7, graph_).message(8, ProtoWriter().whole(2, 17)).bytes();
  }

 private:
  ProtoWriter graph_;
  int count_ = 0;
};

}  // namespace limber::test
