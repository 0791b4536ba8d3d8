// Hashes: agreement with the published algorithms; every changed number changes the hash.
#include "base/hash.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "base/random.h"

namespace limber {
namespace {

// Vigna's splitmix64.c started at 1234567.
TEST(Hash, SplitmixMatchesTheReference) {
  std::uint64_t state = 1234567;
  EXPECT_EQ(splitmix64(state), 6457827717110365317u);
  EXPECT_EQ(splitmix64(state), 3203168211198807973u);
  EXPECT_EQ(splitmix64(state), 9817491932198370423u);
}

// The test vectors of the FNV page.
TEST(Hash, BytesAreHashedByFnv1a) {
  EXPECT_EQ(hash_bytes(""), 0xcbf29ce484222325u);
  EXPECT_EQ(hash_bytes("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(hash_bytes("foobar"), 0x85944171f73967e8u);
  EXPECT_EQ(hash_bytes("bar", hash_bytes("foo")), hash_bytes("foobar"));
}

std::uint64_t hash_of(const std::vector<double>& numbers, std::uint64_t start = 1) {
  NumberHash hash(start);
  hash.add(numbers);
  return hash.value();
}

// An independent implementation of the header's description.
TEST(Hash, NumbersUseFourStatesInTurn) {
  const std::vector<double> numbers{1, -2.5, 0, 1e300, 7, -0.0};
  std::array<std::uint64_t, 4> states{};
  std::uint64_t seed = 42;
  for (auto& state : states) state = splitmix64(seed);
  for (std::size_t i = 0; i < numbers.size(); i++) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &numbers[i], sizeof bits);
    const std::uint64_t product = (states[i & 3u] ^ bits) * 11507291218515648293u;
    states[i & 3u] = product ^ (product / 0x100000000u);
  }
  std::uint64_t expected = 0;
  for (const auto state : states) {
    expected ^= state;
    expected = splitmix64(expected);
  }
  EXPECT_EQ(hash_of(numbers, 42), expected);
  NumberHash three(42);
  three.add(1, -2.5, 0);
  EXPECT_EQ(three.value(), hash_of({1, -2.5, 0}, 42));
  NumberHash words(42);
  words.add(std::array<std::uint64_t, 4>{std::bit_cast<std::uint64_t>(1.0), 0, 5, 9});
  NumberHash same(42);
  same.add(
      std::array<double, 4>{1, 0, std::bit_cast<double>(std::uint64_t{5}), std::bit_cast<double>(std::uint64_t{9})});
  EXPECT_EQ(words.value(), same.value());
}

// The hash depends on each bit of each number, the order, the sign of zero, the count, and the previous hash.
TEST(Hash, EveryChangeChangesTheHash) {
  Random random(3, "numbers");
  std::vector<double> numbers(18);
  for (double& number : numbers) number = random.normal();
  std::set<std::uint64_t> seen{hash_of(numbers), hash_of(numbers, 2)};
  std::size_t expected = 2;
  const auto expect_new = [&](const std::vector<double>& other) {
    seen.insert(hash_of(other));
    ASSERT_EQ(seen.size(), ++expected);
  };
  for (std::size_t i = 0; i < numbers.size(); i++) {
    for (unsigned bit = 0; bit < 64; bit++) {
      std::vector<double> other = numbers;
      other[i] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(other[i]) ^ (std::uint64_t{1} << bit));
      expect_new(other);
    }
    for (std::size_t j = 0; j < i; j++) {
      std::vector<double> other = numbers;
      std::swap(other[i], other[j]);
      expect_new(other);
    }
  }
  expect_new({0});
  expect_new({-0.0});
  expect_new({0, 0});
  expect_new({0, 0, 0, 0, 0});
  expect_new({std::numeric_limits<double>::quiet_NaN()});
}

}  // namespace
}  // namespace limber
