// Files of policies that can't be read: each error names the file, the tensor and a fix.
#include <gtest/gtest.h>

#include "model/policy/policy_file.h"
#include "support/policy_files.h"

namespace limber::model {
namespace {

using limber::test::linear_policy;
using limber::test::SafetensorsWriter;

std::string reading_error(const std::string& bytes, const std::string& file = "a.safetensors") {
  const auto read = parse_policy(bytes, file);
  return read ? "no error" : read.error();
}

// the error of a file with one entry of its header
std::string entry_error(const std::string& name, const std::string& json) {
  SafetensorsWriter writer;
  writer.entry(name, json);
  return reading_error(writer.bytes());
}

TEST(PolicyErrors, NameTheFile) {
  const std::string damaged = "a.safetensors: is not a safetensors file, or is damaged. Export it again.";
  EXPECT_EQ(reading_error(""), damaged);
  EXPECT_EQ(reading_error(std::string(8, '\0')), damaged);
  EXPECT_EQ(reading_error(std::string(8, '\xff') + "{}"), damaged);
  EXPECT_EQ(reading_error(std::string("\4\0\0\0\0\0\0\0{[}]", 12)),
            "a.safetensors: the header is not valid JSON. Export the file again.");
  EXPECT_EQ(reading_error(std::string("\2\0\0\0\0\0\0\0{}", 10)),
            "a.safetensors: there is no layer with weights. Export the whole policy.");
  const std::string good = linear_policy({1, 2}, {1, 2});
  EXPECT_EQ(reading_error(good), "no error");
  EXPECT_EQ(reading_error(good, "A.SAFETENSORS"), "no error");
  EXPECT_EQ(reading_error(good, "a.pt").find("a.pt: a policy is a .safetensors or .onnx file"), 0u);
  for (std::size_t size = 0; size < good.size(); size++) EXPECT_NE(reading_error(good.substr(0, size)), "no error");
}

TEST(PolicyErrors, NameTheTensor) {
  EXPECT_EQ(entry_error("0.weight", "{}"),
            "a.safetensors: tensor '0.weight' needs dtype, shape and data_offsets. Export the file again.");
  EXPECT_EQ(entry_error("0.weight", R"({"dtype":"I64","shape":[1],"data_offsets":[0,8]})"),
            "a.safetensors: tensor '0.weight' has the type I64; F32, F64, F16 and BF16 are read. Convert it to F32.");
  EXPECT_EQ(entry_error("0.weight", R"({"dtype":"F32","shape":[1,2],"data_offsets":[0,8]})"),
            "a.safetensors: tensor '0.weight': data_offsets don't fit its shape [1, 2] or the size of the file. Export "
            "it again.");
  for (const char* shape : {"[4000001]", "[3000,3000]", "[-1]", "[0.5]", "[1,1,1,1,1,1,1,1,1]"}) {
    const std::string json = fmt::format(R"({{"dtype":"F32","shape":{},"data_offsets":[0,0]}})", shape);
    EXPECT_NE(entry_error("0.weight", json).find("has a shape that is not valid, or more than 4000000 numbers"),
              std::string::npos)
        << shape;
  }
  EXPECT_EQ(reading_error(linear_policy({2}, {1, 2})),
            "a.safetensors: tensor '0.weight' has the shape [2]; expected [outputs, inputs]. Only linear layers and "
            "GRUs are read.");
  EXPECT_NE(reading_error(linear_policy({1, 1}, {std::numeric_limits<float>::infinity()}))
                .find("tensor '0.weight' has numbers that are not finite"),
            std::string::npos);
  EXPECT_NE(reading_error(linear_policy({0, 4}, {})).find("tensor '0.weight' is empty"), std::string::npos);
  EXPECT_NE(reading_error(linear_policy({1, 5000}, std::vector<float>(5000)))
                .find("tensor '0.weight' has 5000 values; the maximum is 4096"),
            std::string::npos);
}

TEST(PolicyErrors, NameTheLayer) {
  SafetensorsWriter writer;
  writer.add("0.weight", {{3, 2}, std::vector<float>(6)});
  writer.add("2.weight", {{1, 4}, std::vector<float>(4)});
  EXPECT_EQ(reading_error(writer.bytes()),
            "a.safetensors: the activation between the layers is not given. Write __metadata__ {\"activation\": "
            "\"tanh\"}; there are: relu, leaky_relu, elu, tanh, sigmoid, softplus, silu, none.");
  SafetensorsWriter misspelled = writer;
  misspelled.add_metadata("activation", "tan");
  EXPECT_EQ(reading_error(misspelled.bytes()),
            "a.safetensors: __metadata__: activation has no value 'tan'; did you mean 'tanh'?");
  writer.add_metadata("activation", "tanh");
  EXPECT_EQ(reading_error(writer.bytes()),
            "a.safetensors: tensor '2.weight' takes 4 inputs, but the step before it has 3 outputs. Check the order of "
            "the layers.");
  SafetensorsWriter listed = writer;
  listed.add_metadata("layers", "0, tanh, 3");
  EXPECT_NE(reading_error(listed.bytes()).find("layers has '3', which is neither a layer nor an activation"),
            std::string::npos);
  writer.add("head.weight", {{1, 1}, {1}});
  EXPECT_NE(reading_error(writer.bytes()).find("the order of the layer 'head' is not known. List the layers"),
            std::string::npos);
  SafetensorsWriter alone;
  alone.add("0.bias", {{2}, {1, 2}});
  EXPECT_EQ(reading_error(alone.bytes()),
            "a.safetensors: tensor '0.bias' has no weight beside it. Export the whole layer.");
  SafetensorsWriter gru;
  gru.add("weight_ih_l0", {{4, 1}, {1, 1, 1, 1}});
  gru.add("weight_hh_l0", {{3, 1}, {1, 1, 1}});
  EXPECT_NE(reading_error(gru.bytes()).find("GRU '': weight_ih_l0 has the shape [4, 1]"), std::string::npos);
}

TEST(PolicyErrors, NameTheMetadata) {
  SafetensorsWriter writer;
  writer.add("weight", {{1, 1}, {1}});
  SafetensorsWriter clip = writer;
  clip.add_metadata("input_clip", "-1");
  EXPECT_EQ(reading_error(clip.bytes()),
            "a.safetensors: __metadata__: input_clip is a number above 0 and at most 1e6, not '-1'.");
  SafetensorsWriter deviation = writer;
  deviation.add("input_std", {{1}, {0}});
  EXPECT_EQ(reading_error(deviation.bytes()),
            "a.safetensors: tensor 'input_std' has a number that is not above 0. Add a small constant to it.");
  writer.entry("__metadata__", R"({"activation":1})");
  EXPECT_EQ(reading_error(writer.bytes()),
            "a.safetensors: __metadata__: activation is not a text. Write it in quotation marks.");
}

}  // namespace
}  // namespace limber::model
