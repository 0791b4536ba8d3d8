// Arrays that are indexed by int, like the rows and columns of formulas: a vector, an array and a span. [any]
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "base/capacity.h"

namespace limber::sim::solver {

/// std::vector with int indices and sizes.
template <class T>
class IndexedArray : public std::vector<T> {
  using Base = std::vector<T>;
  static std::size_t count_of(int n) { return static_cast<std::size_t>(n); }

 public:
  using Base::assign;
  using Base::Base;
  explicit IndexedArray(int n, const T& value = {}) : Base(count_of(n), value) {}
  T& operator[](int i) { return Base::operator[](count_of(i)); }
  const T& operator[](int i) const { return Base::operator[](count_of(i)); }
  int size() const { return static_cast<int>(Base::size()); }
  void resize(int n) { Base::resize(count_of(n)); }
  void resize(int n, const T& value) { Base::resize(count_of(n), value); }
  void assign(int n, const T& value) { Base::assign(count_of(n), value); }
  /// The functions of base/capacity.h.
  void reserve_ahead(int n) { limber::reserve<T>(*this, count_of(n)); }
  void clear_and_reserve(int n) { limber::clear_and_reserve<T>(*this, count_of(n)); }
};

/// std::array with int indices.
template <class T, int N>
struct FixedArray : std::array<T, static_cast<std::size_t>(N)> {
  using Base = std::array<T, static_cast<std::size_t>(N)>;
  T& operator[](int i) { return Base::operator[](static_cast<std::size_t>(i)); }
  const T& operator[](int i) const { return Base::operator[](static_cast<std::size_t>(i)); }
};

/// std::span with int indices and sizes.
template <class T>
class IndexedSpan : public std::span<T> {
  using Base = std::span<T>;
  static std::size_t count_of(int n) { return static_cast<std::size_t>(n); }

 public:
  IndexedSpan() = default;
  template <std::convertible_to<Base> Range>
  IndexedSpan(Range&& range) : Base(range) {}  // NOLINT(bugprone-forwarding-reference-overload): copies alike
  IndexedSpan(T* first, int count) : Base(first, count_of(count)) {}
  T& operator[](int i) const { return Base::operator[](count_of(i)); }
  int size() const { return static_cast<int>(Base::size()); }
  IndexedSpan subspan(int first, int count) const { return Base::subspan(count_of(first), count_of(count)); }
  IndexedSpan last(int count) const { return Base::last(count_of(count)); }
};

}  // namespace limber::sim::solver
