// Dense kernels of every vector width return the same as scalar loops, to the bit.
#include "sim/solver/lcp/dense_kernels.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace limber::sim {
namespace {

constexpr int kMaxCount = 45;  // more than two vectors of sixteen, with every remainder
constexpr int kStride = 50;    // distance of consecutive vectors

struct Case {
  std::string name;
  const solver::DenseKernels& kernels;
};

class Dense : public testing::TestWithParam<Case> {
 protected:
  std::vector<double> numbers(int count) {
    std::vector<double> out(static_cast<std::size_t>(count));
    for (double& number : out) number = std::uniform_real_distribution(-1.0, 1.0)(random_);
    return out;
  }
  const solver::DenseKernels& kernels = GetParam().kernels;

 private:
  std::mt19937_64 random_{7};
};

TEST_P(Dense, SubtractsAScaledVector) {
  for (int count = 0; count <= kMaxCount; count += 2) {
    const std::vector<double> y = numbers(kMaxCount + 1), a = numbers(kMaxCount);
    std::vector<double> expected = y, found = y;
    for (int i = 0; i < count; ++i) expected[i] = y[i] - a[i] * 0.7;
    kernels.subtract_scaled(found.data(), a.data(), 0.7, count);
    EXPECT_EQ(found, expected) << count;
  }
}

// groups of four vectors are added first, the remaining ones are subtracted one by one
TEST_P(Dense, SubtractsScaledVectors) {
  for (int vectors = 0; vectors < 10; ++vectors) {
    for (int count = 0; count <= kMaxCount; count += 2) {
      const std::vector<double> y = numbers(kMaxCount + 1), scales = numbers(vectors);
      std::vector<std::vector<double>> all(static_cast<std::size_t>(vectors));
      std::vector<solver::ScaledVector> scaled(all.size());
      for (std::size_t k = 0; k < all.size(); ++k) {
        all[k] = numbers(kMaxCount);
        scaled[k] = {all[k].data(), scales[k]};
      }
      std::vector<double> expected = y, found = y;
      for (int i = 0; i < count; ++i) {
        const auto part = [&](int k) { return all[k][i] * scales[k]; };
        int k = 0;
        for (; k + 3 < vectors; k += 4) expected[i] -= (part(k) + part(k + 1)) + (part(k + 2) + part(k + 3));
        for (; k < vectors; ++k) expected[i] -= part(k);
      }
      kernels.subtract_vectors(found.data(), scaled, count);
      EXPECT_EQ(found, expected) << vectors << " lines of " << count;
    }
  }
}

TEST_P(Dense, SubtractsVectorsInSequence) {
  for (int vectors = 0; vectors < 10; ++vectors) {
    for (int count = 0; count <= kMaxCount; ++count) {
      const std::vector<double> y = numbers(kMaxCount + 1), scales = numbers(vectors), all = numbers(10 * kStride);
      std::vector<double> expected = y, found = y;
      for (int k = 0; k < vectors; ++k) {
        for (int i = 0; i < count; ++i) expected[i] -= all[k * kStride + i] * scales[k];
      }
      kernels.subtract_sequence(found.data(), all.data(), kStride, scales, count);
      EXPECT_EQ(found, expected) << vectors << " lines of " << count;
    }
  }
}

// four partial sums of every fourth element each, added in the order of halved vectors
TEST_P(Dense, DotProductAddsFourPartialSums) {
  for (int count = 0; count <= kMaxCount; ++count) {
    const std::vector<double> a = numbers(kMaxCount), b = numbers(kMaxCount);
    double parts[4] = {};
    const int whole = count / 4 * 4;
    for (int i = 0; i < whole; ++i) parts[i % 4] += a[i] * b[i];
    double expected = (parts[0] + parts[2]) + (parts[1] + parts[3]);
    for (int i = whole; i < count; ++i) expected += a[i] * b[i];
    EXPECT_EQ(kernels.dot_product(a.data(), b.data(), count), expected) << count;
    EXPECT_EQ(solver::dot_product(a.data(), b.data(), count), expected) << count;
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Dense,
                         testing::Values(Case{"two", solver::DenseKernels::width_2()},
                                         Case{"widest", solver::DenseKernels::widest()}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace limber::sim
