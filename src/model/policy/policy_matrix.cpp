// PolicyMatrix: products of matrices with vectors. Additions are in a fixed order, and no multiply-add is fused, so
// that the results have the same bits with SIMD vectors of any width.
#include <algorithm>
#include <array>
#include <cstring>

#include "model/policy/policy_network.h"

namespace limber::model {

PolicyMatrix::PolicyMatrix(std::size_t rows, std::size_t columns, std::span<const float> values,
                           std::span<const float> bias)
    : rows_(rows), columns_(columns), values_(padded(rows) * columns, 0.0f), bias_(padded(rows), 0.0f) {
  for (std::size_t row = 0; row < rows; row++) {
    float* const block = values_.data() + row / kBlock * kBlock * columns;
    for (std::size_t column = 0; column < columns; column++)
      block[column * kBlock + row % kBlock] = values[row * columns + column];
  }
  std::ranges::copy(bias, bias_.begin());
}

void PolicyMatrix::multiply(const float* x, float* y) const {
  using Float4 [[gnu::vector_size(16)]] = float;
  constexpr std::size_t kVectors = kBlock / 4;
  const float* values = values_.data();
  for (std::size_t row = 0; row < rows_; row += kBlock) {
    std::array<Float4, kVectors> sums;
    std::memcpy(sums.data(), bias_.data() + row, sizeof sums);
    for (std::size_t column = 0; column < columns_; column++, values += kBlock) {
      const Float4 factor = {x[column], x[column], x[column], x[column]};
      for (std::size_t i = 0; i < kVectors; i++) {
        Float4 weights;
        std::memcpy(&weights, values + 4 * i, sizeof weights);
        sums[i] += weights * factor;
      }
    }
    std::memcpy(y + row, sums.data(), sizeof sums);
  }
}

}  // namespace limber::model
