// CmaEs: the evolution strategy with covariance matrix adaptation, (mu/mu_w, lambda)-CMA-ES, as in Hansen, "The CMA
// Evolution Strategy: A Tutorial" (2016), with positive weights. It minimizes; the caller evaluates what ask() returns
// and passes the values to tell(). The same seed gives the same bits on every machine. [one thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/result.h"

namespace limber::experiments {

class CmaEs {
 public:
  using Vector = std::vector<double>;
  /// Maximum number of individuals per generation.
  static constexpr std::size_t kMaxPopulation = 100'000;

  /// `start`: the initial mean. `sigma`: the initial standard deviation along each axis. `population`: individuals per
  /// generation, at least 4; 0: 4 + floor(3 ln n).
  CmaEs(Vector start, double sigma, std::uint64_t seed, std::size_t population = 0);

  std::size_t population() const { return population_; }
  const Vector& mean() const { return mean_; }
  double sigma() const { return sigma_; }
  std::uint64_t generation() const { return generation_; }

  /// Returns the individuals of the next generation.
  std::vector<Vector> ask() const;
  /// Updates the distribution with the values of the individuals that ask() returned last; NaN is the worst value.
  void tell(std::span<const Vector> individuals, std::span<const double> values);
  /// True if the distribution is so small, or so badly conditioned, that no progress is possible.
  bool converged() const;

  /// Returns the state between tell() and ask() as text, and restores it.
  std::string save() const;
  static Result<CmaEs> restore(std::string_view text);

 private:
  CmaEs() = default;
  void set_weights();
  void update_paths(const Vector& step);
  void update_covariance(std::span<const Vector> individuals, std::span<const std::size_t> order,
                         const Vector& old_mean);
  void decompose();

  std::size_t population_ = 0;
  Vector mean_;
  double sigma_ = 1;
  std::uint64_t generation_ = 0;
  std::uint64_t seed_ = 1;
  Vector covariance_;  // n × n, by rows
  Vector path_c_;      // evolution path of the covariance
  Vector path_sigma_;  // evolution path of sigma

  // derived from the above
  Vector axes_;     // eigenvectors of the covariance as columns, n × n
  Vector lengths_;  // square roots of its eigenvalues
  Vector weights_;  // of the best half
  double mu_eff_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_c_ = 0, c_1_ = 0, c_mu_ = 0, chi_n_ = 0;
};

/// Eigenvalues (ascending order is not guaranteed) and eigenvectors (columns) of a symmetric n × n matrix, by Jacobi's
/// cyclic method.
void symmetric_eigen(std::vector<double> matrix, std::size_t n, std::vector<double>& values,
                     std::vector<double>& vectors);

}  // namespace limber::experiments
