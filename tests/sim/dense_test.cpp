// Lines of numbers: lanes of every width say what a loop over single numbers says, to the bit.
#include "sim/dense.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace limber {
namespace {

constexpr int kMost = 45;    // past lanes of sixteen, with every rest
constexpr int kStride = 50;  // of lines that follow each other

struct Case {
  std::string name;
  const DenseKernels& kernels;
};

class Dense : public testing::TestWithParam<Case> {
 protected:
  std::vector<double> numbers(int count) {
    std::vector<double> out(static_cast<std::size_t>(count));
    for (double& number : out) number = std::uniform_real_distribution(-1.0, 1.0)(random_);
    return out;
  }
  const DenseKernels& kernels = GetParam().kernels;

 private:
  std::mt19937_64 random_{7};
};

TEST_P(Dense, ALineIsTakenAway) {
  for (int count = 0; count <= kMost; count += 2) {
    const std::vector<double> y = numbers(kMost + 1), a = numbers(kMost);
    std::vector<double> expected = y, found = y;
    for (int i = 0; i < count; ++i) expected[i] = y[i] - a[i] * 0.7;
    kernels.subtract_scaled(found.data(), a.data(), 0.7, count);
    EXPECT_EQ(found, expected) << count;
  }
}

// four at a time are added up before, what is left goes line by line
TEST_P(Dense, LinesAreTakenAway) {
  for (int lines = 0; lines < 10; ++lines) {
    for (int count = 0; count <= kMost; count += 2) {
      const std::vector<double> y = numbers(kMost + 1), scales = numbers(lines);
      std::vector<std::vector<double>> all(static_cast<std::size_t>(lines));
      std::vector<ScaledLine> scaled(all.size());
      for (std::size_t k = 0; k < all.size(); ++k) {
        all[k] = numbers(kMost);
        scaled[k] = {all[k].data(), scales[k]};
      }
      std::vector<double> expected = y, found = y;
      for (int i = 0; i < count; ++i) {
        const auto part = [&](int k) { return all[k][i] * scales[k]; };
        int k = 0;
        for (; k + 3 < lines; k += 4) expected[i] -= (part(k) + part(k + 1)) + (part(k + 2) + part(k + 3));
        for (; k < lines; ++k) expected[i] -= part(k);
      }
      kernels.subtract_lines(found.data(), scaled, count);
      EXPECT_EQ(found, expected) << lines << " lines of " << count;
    }
  }
}

TEST_P(Dense, LinesAreTakenAwayInTurn) {
  for (int lines = 0; lines < 10; ++lines) {
    for (int count = 0; count <= kMost; ++count) {
      const std::vector<double> y = numbers(kMost + 1), scales = numbers(lines), all = numbers(10 * kStride);
      std::vector<double> expected = y, found = y;
      for (int k = 0; k < lines; ++k) {
        for (int i = 0; i < count; ++i) expected[i] -= all[k * kStride + i] * scales[k];
      }
      kernels.subtract_in_turn(found.data(), all.data(), kStride, scales, count);
      EXPECT_EQ(found, expected) << lines << " lines of " << count;
    }
  }
}

// every fourth number makes a part; the parts' order is that of lanes that are halved
TEST_P(Dense, AProductIsOfFourParts) {
  for (int count = 0; count <= kMost; ++count) {
    const std::vector<double> a = numbers(kMost), b = numbers(kMost);
    double parts[4] = {};
    const int whole = count / 4 * 4;
    for (int i = 0; i < whole; ++i) parts[i % 4] += a[i] * b[i];
    double expected = (parts[0] + parts[2]) + (parts[1] + parts[3]);
    for (int i = whole; i < count; ++i) expected += a[i] * b[i];
    EXPECT_EQ(kernels.product(a.data(), b.data(), count), expected) << count;
    EXPECT_EQ(product(a.data(), b.data(), count), expected) << count;
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, Dense,
                         testing::Values(Case{"two", DenseKernels::by_two()}, Case{"widest", DenseKernels::widest()}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace limber
