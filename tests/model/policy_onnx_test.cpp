// Policies in ONNX files: the same network as a safetensors file has, each operation, errors that name the node.
#include <gtest/gtest.h>

#include <cmath>

#include "model/policy/policy_file.h"
#include "support/onnx_writer.h"

namespace limber::model {
namespace {

using limber::test::OnnxWriter;
using limber::test::random_tensor;
using limber::test::SafetensorsWriter;
using limber::test::TestTensor;

std::string onnx_error(const std::string& bytes) {
  const auto read = parse_policy(bytes, "a.onnx");
  return read ? "no error" : read.error();
}

std::vector<double> onnx_outputs(const std::string& bytes, const std::vector<double>& inputs, int times = 1,
                                 const std::string& file = "a.onnx") {
  const auto read = parse_policy(bytes, file);
  EXPECT_TRUE(read.ok()) << (read ? "" : read.error());
  if (!read || (*read)->inputs() != inputs.size()) return {};
  std::vector<double> outputs((*read)->outputs());
  std::vector<float> hidden((*read)->hidden()), workspace((*read)->workspace());
  for (int i = 0; i < times; i++) EXPECT_TRUE((*read)->evaluate(inputs, hidden, outputs, workspace).ok());
  return outputs;
}

TestTensor transposed(const TestTensor& from) {
  TestTensor to{{from.shape[1], from.shape[0]}, {}};
  for (std::size_t column = 0; column < from.shape[1]; column++) {
    for (std::size_t row = 0; row < from.shape[0]; row++)
      to.values.push_back(from.values[row * from.shape[1] + column]);
  }
  return to;
}

// a chain of one node on the input x with the constants a and b, and the output y
OnnxWriter chain(const OnnxWriter::Node& node, const TestTensor& a = {{1}, {2}}, const TestTensor& b = {{1}, {0.5f}}) {
  OnnxWriter writer;
  writer.add_input("x");
  writer.add_constant("one", {{1, 1}, {1}});
  writer.add_constant("a", a);
  writer.add_constant("b", b, false);
  writer.add({"MatMul", {"x", "one"}, {"x1"}});
  writer.add(node);
  writer.add_output("y");
  return writer;
}

TEST(PolicyOnnx, HasTheBitsOfASafetensorsFile) {
  Random random(3, "onnx");
  const TestTensor w0 = random_tensor(random, {40, 6}), b0 = random_tensor(random, {40});
  const TestTensor w2 = random_tensor(random, {3, 40}), b2 = random_tensor(random, {3});
  SafetensorsWriter tensors;
  tensors.add("0.weight", w0);
  tensors.add("0.bias", b0);
  tensors.add("2.weight", w2);
  tensors.add("2.bias", b2);
  tensors.add_metadata("activation", "tanh");
  OnnxWriter writer;
  writer.add_input("x");
  writer.add_input("w0");  // old exporters list constants as inputs as well
  writer.add_constant("w0", w0);
  writer.add_constant("b0", b0);
  writer.add_constant("w2", transposed(w2));
  writer.add_constant("b2", b2, false);
  writer.add({"Flatten", {"x"}, {"flat"}});
  writer.add({"Gemm", {"flat", "w0", "b0"}, {"h"}, {OnnxWriter::attribute("transB", 1)}});
  writer.add({"Tanh", {"h"}, {"t"}});
  writer.add({"Gemm", {"t", "w2", "b2"}, {"y"}});
  writer.add_output("y");
  const std::vector<double> inputs{0.1, -2, 0.3, 1.4, -0.5, 0.6};
  const std::vector<double> expected = onnx_outputs(tensors.bytes(), inputs, 1, "a.safetensors");
  ASSERT_EQ(expected.size(), 3u);
  EXPECT_EQ(onnx_outputs(writer.bytes(), inputs), expected);
}

TEST(PolicyOnnx, EvaluatesEachOperation) {
  using Node = OnnxWriter::Node;
  const auto real = [](const char* name, float value) { return OnnxWriter::attribute(name, value); };
  const double x = -0.75;
  const std::pair<Node, double> nodes[] = {
      {{"Add", {"x1", "a"}, {"y"}}, x + 2},
      {{"Add", {"a", "x1"}, {"y"}}, x + 2},
      {{"Sub", {"x1", "a"}, {"y"}}, x - 2},
      {{"Sub", {"a", "x1"}, {"y"}}, 2 - x},
      {{"Mul", {"a", "x1"}, {"y"}}, 2 * x},
      {{"Div", {"x1", "a"}, {"y"}}, x / 2},
      {{"Relu", {"x1"}, {"y"}}, 0},
      {{"LeakyRelu", {"x1"}, {"y"}, {real("alpha", 0.25f)}}, 0.25 * x},
      {{"Elu", {"x1"}, {"y"}, {real("alpha", 2)}}, 2 * (std::exp(x) - 1)},
      {{"Tanh", {"x1"}, {"y"}}, std::tanh(x)},
      {{"Sigmoid", {"x1"}, {"y"}}, 1 / (1 + std::exp(-x))},
      {{"Softplus", {"x1"}, {"y"}}, std::log1p(std::exp(x))},
      {{"Clip", {"x1", "", "b"}, {"y"}}, x},
      {{"Clip", {"x1", "b"}, {"y"}}, 0.5},
      {{"Clip", {"x1"}, {"y"}, {real("min", -0.5f), real("max", 1)}}, -0.5},
      {{"Unsqueeze", {"x1", "a"}, {"y"}}, x},
  };
  for (const auto& [node, expected] : nodes) {
    const std::vector<double> outputs = onnx_outputs(chain(node).bytes(), {x});
    ASSERT_EQ(outputs.size(), 1u) << node.op;
    EXPECT_NEAR(outputs[0], expected, 1e-6) << node.op << " " << node.inputs[0];
  }
}

TEST(PolicyOnnx, RecognizesSilu) {
  OnnxWriter writer = chain({"Sigmoid", {"x1"}, {"s"}});
  writer.add({"Mul", {"x1", "s"}, {"y"}});
  EXPECT_NEAR(onnx_outputs(writer.bytes(), {-1.5})[0], -1.5 / (1 + std::exp(1.5)), 1e-6);
}

TEST(PolicyOnnx, ReadsConstantNodesAndTransposedWeights) {
  OnnxWriter writer;
  writer.add_input("x");
  writer.add({"Constant", {}, {"w"}, {OnnxWriter::attribute("value", OnnxWriter::tensor("", {{1, 2}, {3, 5}}))}});
  writer.add({"Transpose", {"w"}, {"wt"}});
  writer.add({"MatMul", {"x", "wt"}, {"p"}});
  writer.add({"Constant", {}, {"c"}, {OnnxWriter::attribute("value_float", 0.5f)}});
  writer.add({"Add", {"p", "c"}, {"y"}});
  writer.add_output("y");
  EXPECT_EQ(onnx_outputs(writer.bytes(), {10, 1}), std::vector<double>{35.5});
}

// Brax exports means and deviations as one vector; the actions are one half of it.
TEST(PolicyOnnx, UsesOnePartOfASplit) {
  for (const auto& [part, expected] : {std::pair("mean", 4.0), std::pair("deviation", 5.0)}) {
    for (const bool with_sizes : {false, true}) {
      OnnxWriter writer;
      writer.add_input("x");
      writer.add_constant("w", {{1, 2}, {2, 2.5f}});
      writer.add_constant("sizes", {{2}, {1, 1}});
      writer.add({"MatMul", {"x", "w"}, {"both"}});
      std::vector<std::string> inputs{"both"};
      if (with_sizes) inputs.emplace_back("sizes");
      writer.add({"Split", inputs, {"mean", "deviation"}});
      if (with_sizes) writer.add({"Relu", {part}, {"y"}});
      writer.add_output(with_sizes ? "y" : part);
      EXPECT_EQ(onnx_outputs(writer.bytes(), {2}), std::vector<double>{expected}) << part;
    }
  }
}

// ONNX has the gates in the order update, reset, new; a safetensors file has reset, update, new.
TEST(PolicyOnnx, EvaluatesAGruLikeASafetensorsFile) {
  constexpr std::size_t kHidden = 5, kInputs = 3;
  Random random(4, "onnx");
  SafetensorsWriter tensors;
  OnnxWriter writer;
  writer.add_input("x");
  writer.add_input("h_in");
  TestTensor biases{{1, 6 * kHidden}, {}};
  for (const auto& [name, constant, columns] :
       {std::tuple("weight_ih_l0", "w", kInputs), std::tuple("weight_hh_l0", "r", kHidden),
        std::tuple("bias_ih_l0", "", std::size_t{1}), std::tuple("bias_hh_l0", "", std::size_t{1})}) {
    const bool is_bias = *constant == '\0';
    const TestTensor values = random_tensor(random, {3 * kHidden, columns});
    tensors.add(name, is_bias ? TestTensor{{3 * kHidden}, values.values} : values);
    std::vector<float> ordered;
    for (const std::size_t gate : {1u, 0u, 2u}) {
      const auto* const begin = values.values.data() + gate * kHidden * columns;
      ordered.insert(ordered.end(), begin, begin + kHidden * columns);
    }
    if (is_bias) {
      biases.values.insert(biases.values.end(), ordered.begin(), ordered.end());
    } else {
      writer.add_constant(constant, {{1, 3 * kHidden, columns}, ordered});
    }
  }
  writer.add_constant("b", biases);
  writer.add({"Unsqueeze", {"x"}, {"x3"}});
  writer.add({"Unsqueeze", {"h_in"}, {"h3"}});
  writer.add({"GRU",
              {"x3", "w", "r", "b", "", "h3"},
              {"all", "last"},
              {OnnxWriter::attribute("hidden_size", 5), OnnxWriter::attribute("linear_before_reset", 1)}});
  writer.add({"Squeeze", {"last"}, {"y"}});
  writer.add_output("y");
  writer.add_output("last");
  const std::vector<double> inputs{0.5, -1, 2};
  for (const int times : {1, 4}) {
    const std::vector<double> outputs = onnx_outputs(writer.bytes(), inputs, times);
    ASSERT_EQ(outputs.size(), kHidden);
    EXPECT_EQ(outputs, onnx_outputs(tensors.bytes(), inputs, times, "a.safetensors"));
  }
}

TEST(PolicyOnnx, ErrorsNameTheNode) {
  const auto error_of = [](const OnnxWriter::Node& node) { return onnx_error(chain(node).bytes()); };
  EXPECT_EQ(error_of({"Conv", {"x1", "a"}, {"y"}}).find("a.onnx: node '/Conv_1' (Conv) is not supported; there are: "),
            0u);
  EXPECT_NE(error_of({"Relu", {"x1"}, {"y"}, {}, "com.acme"}).find("is not supported"), std::string::npos);
  EXPECT_EQ(error_of({"Add", {"x1", "x1"}, {"y"}}),
            "a.onnx: node '/Add_1' (Add): expected the vector of the node before and a constant. Export a chain of "
            "layers with constant weights.");
  EXPECT_NE(error_of({"Tanh", {"x"}, {"y"}}).find("expected the vector of the node before"), std::string::npos);
  EXPECT_NE(error_of({"Div", {"a", "x1"}, {"y"}}).find("divided by a constant"), std::string::npos);
  EXPECT_NE(error_of({"GRU", {"x1", "a", "b"}, {"y"}}).find("constant weights of one direction"), std::string::npos);
  EXPECT_EQ(error_of({"Tanh", {"x1"}, {"z"}}),
            "a.onnx: the first output is not the end of a chain that begins with the first input. Export the layers "
            "that compute the actions alone.");
}

TEST(PolicyOnnx, ErrorsNameTheFile) {
  const std::string damaged = "a.onnx: is not an ONNX file, or is damaged. Export it again.";
  EXPECT_EQ(onnx_error(""), damaged);
  EXPECT_EQ(onnx_error("PK\3\4"), damaged);
  const std::string good = chain({"Tanh", {"x1"}, {"y"}}).bytes();
  EXPECT_EQ(onnx_error(good), "no error");
  for (std::size_t size = 0; size + 8 < good.size(); size++)
    EXPECT_EQ(onnx_error(good.substr(0, size)), damaged) << size;
  OnnxWriter wrong = chain({"Add", {"x1", "c"}, {"y"}});
  wrong.add_constant("c", {{3}, {1, 2}});
  EXPECT_EQ(onnx_error(wrong.bytes()),
            "a.onnx: constant 'c' has 2 numbers; its shape [3] needs 3. Export the file again.");
}

}  // namespace
}  // namespace limber::model
