// PolicyNetwork: a small neural network that computes actions from observations, with the same bits on every machine.
// [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::model {

/// A matrix for products with vectors. Its rows are stored in blocks of 32, each column by column, so that a SIMD
/// vector has the sums of several rows. Each sum begins with the bias and adds the products in the order of the
/// columns, whatever the width of the vectors is.
class PolicyMatrix {
 public:
  PolicyMatrix() = default;
  /// `values`: row by row. `bias`: one number for each row, or none.
  PolicyMatrix(std::size_t rows, std::size_t columns, std::span<const float> values, std::span<const float> bias);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// y = matrix · x + bias. Writes padded(rows()) numbers.
  void multiply(const float* x, float* y) const;

  /// Number of elements of a buffer for `count` results.
  static constexpr std::size_t padded(std::size_t count) { return (count + kBlock - 1) / kBlock * kBlock; }

 private:
  static constexpr std::size_t kBlock = 32;

  std::size_t rows_ = 0, columns_ = 0;
  std::vector<float> values_, bias_;  // padded with zeros to whole blocks
};

/// One operation of a network. Elementwise operations change each number of the vector by itself.
struct PolicyStep {
  enum class Kind : std::uint8_t {
    linear,      ///< weights · x + bias
    gru,         ///< Gated recurrent unit (Cho et al. 2014), with the formulas of PyTorch.
    scale,       ///< x · vector; a vector of one number applies to all.
    shift,       ///< x + vector
    slice,       ///< The elements from `first` to first + count − 1.
    clip,        ///< clamped to a .. b
    relu,        ///< max(x, 0)
    leaky_relu,  ///< x, below 0: a x
    elu,         ///< x, below 0: a (e^x − 1)
    tanh,
    sigmoid,   ///< 1 / (1 + e^−x)
    softplus,  ///< ln(1 + e^x)
    silu,      ///< x sigmoid(x)
  };
  Kind kind = Kind::linear;
  float a = 0, b = 0;
  std::vector<float> vector;
  PolicyMatrix weights;         ///< Of a GRU: three gates by the inputs, in the order reset, update, new.
  PolicyMatrix hidden_weights;  ///< Of a GRU: the same by its hidden values.
  std::size_t first_hidden = 0;
  std::size_t first = 0, count = 0;

  std::size_t hidden() const { return kind == Kind::gru ? hidden_weights.columns() : 0; }
};

class PolicyNetwork {
 public:
  static constexpr std::size_t kMaxBytes = 64u << 20;     ///< Of a file.
  static constexpr std::size_t kMaxParameters = 4000000;  ///< Numbers in all steps.
  static constexpr std::size_t kMaxWidth = 4096;          ///< Of inputs, outputs and all between.
  static constexpr std::size_t kMaxSteps = 64;

  std::uint64_t content_hash = 0;  ///< Of its file.

  std::size_t inputs() const { return inputs_; }
  std::size_t outputs() const { return outputs_; }
  /// Number of values that a network with a GRU keeps between evaluations; they begin with 0.
  std::size_t hidden() const { return hidden_; }
  std::span<const PolicyStep> steps() const { return steps_; }

  /// Size of the workspace of evaluate().
  std::size_t workspace() const;
  /// Computes the outputs, and replaces the hidden values. Doesn't allocate. If a number is not finite, returns an
  /// error that names it, and changes nothing.
  Result<void> evaluate(std::span<const double> inputs, std::span<float> hidden, std::span<double> outputs,
                        std::span<float> workspace) const;

 private:
  friend class PolicyBuilder;

  std::vector<PolicyStep> steps_;
  std::size_t inputs_ = 0, outputs_ = 0, hidden_ = 0;
  std::size_t widest_ = 0;  // of all vectors, with three times the hidden values of a GRU
};

/// Builds a network step by step, and checks sizes and limits. `name`, the tensor or node, begins an error message.
class PolicyBuilder {
 public:
  /// `values`: a matrix of outputs by inputs, row by row. `bias`: may be empty.
  Result<void> linear(std::string_view name, std::size_t outputs, std::size_t inputs, std::span<const float> values,
                      std::span<const float> bias);
  /// The matrices have three times `hidden` rows, in the order reset, update, new; the biases may be empty.
  Result<void> gru(std::string_view name, std::size_t hidden, std::size_t inputs, std::span<const float> input_weights,
                   std::span<const float> hidden_weights, std::span<const float> input_bias,
                   std::span<const float> hidden_bias);
  /// A step with a vector: scale or shift.
  Result<void> vector(std::string_view name, PolicyStep::Kind kind, std::vector<float> values);
  /// Keeps `count` values from `first` on.
  Result<void> slice(std::string_view name, std::size_t first, std::size_t count);
  Result<void> elementwise(std::string_view name, PolicyStep::Kind kind, float a = 0, float b = 0);
  /// Ends the network.
  Result<std::shared_ptr<PolicyNetwork>> finish();
  /// Number of values after the last step; 0 if it is not known yet.
  std::size_t width() const { return width_; }

 private:
  Result<void> add(std::string_view name, PolicyStep step, std::size_t inputs, std::size_t outputs,
                   std::size_t parameters);

  std::shared_ptr<PolicyNetwork> network_ = std::make_shared<PolicyNetwork>();
  std::size_t width_ = 0, parameters_ = 0;
};

/// The names of activations in files ("relu", "tanh", …), in the order of Kind from relu on.
std::span<const std::string_view> policy_activations();
/// The step of an activation's name; empty if there is none. Its parameter is the usual one.
std::optional<PolicyStep> policy_activation(std::string_view name);

}  // namespace limber::model
