// CMA-ES: sampling, adaptation of step size and covariance, eigendecomposition.
#include "experiments/cma_es.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/math/fixed_math.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

double squared(double x) { return x * x; }

double norm(const CmaEs::Vector& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// matrix · vector, or its transpose · vector
CmaEs::Vector product(const CmaEs::Vector& matrix, const CmaEs::Vector& v, bool transposed) {
  const std::size_t n = v.size();
  CmaEs::Vector out(n, 0.0);
  for (std::size_t i = 0; i < n; i++) {
    for (std::size_t j = 0; j < n; j++) out[i] += (transposed ? matrix[j * n + i] : matrix[i * n + j]) * v[j];
  }
  return out;
}

// rotates rows and columns p and q so that the element (p, q) becomes 0
void jacobi_rotation(std::vector<double>& a, std::vector<double>& v, std::size_t n, std::size_t p, std::size_t q) {
  const double apq = a[p * n + q];
  if (apq == 0) return;
  const double theta = (a[q * n + q] - a[p * n + p]) / (2 * apq);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (std::size_t k = 0; k < n; k++) {
    const double akp = a[k * n + p];
    const double akq = a[k * n + q];
    a[k * n + p] = c * akp - s * akq;
    a[k * n + q] = s * akp + c * akq;
  }
  for (std::size_t k = 0; k < n; k++) {
    const double apk = a[p * n + k];
    const double aqk = a[q * n + k];
    a[p * n + k] = c * apk - s * aqk;
    a[q * n + k] = s * apk + c * aqk;
    const double vkp = v[k * n + p];
    const double vkq = v[k * n + q];
    v[k * n + p] = c * vkp - s * vkq;
    v[k * n + q] = s * vkp + c * vkq;
  }
}

}  // namespace

void symmetric_eigen(std::vector<double> matrix, std::size_t n, std::vector<double>& values,
                     std::vector<double>& vectors) {
  constexpr int kMaxSweeps = 60;
  vectors.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; i++) vectors[i * n + i] = 1;
  for (int sweep = 0; sweep < kMaxSweeps; sweep++) {
    double outside = 0;
    double diagonal = 0;
    for (std::size_t i = 0; i < n; i++) {
      diagonal += squared(matrix[i * n + i]);
      for (std::size_t j = i + 1; j < n; j++) outside += squared(matrix[i * n + j]);
    }
    if (outside <= 1e-32 * diagonal) break;
    for (std::size_t p = 0; p < n; p++) {
      for (std::size_t q = p + 1; q < n; q++) jacobi_rotation(matrix, vectors, n, p, q);
    }
  }
  values.resize(n);
  for (std::size_t i = 0; i < n; i++) values[i] = matrix[i * n + i];
}

CmaEs::CmaEs(Vector start, double sigma, std::uint64_t seed, std::size_t population)
    : population_(population), mean_(std::move(start)), sigma_(sigma), seed_(seed) {
  const std::size_t n = mean_.size();
  covariance_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; i++) covariance_[i * n + i] = 1;
  path_c_.assign(n, 0.0);
  path_sigma_.assign(n, 0.0);
  set_weights();
  decompose();
}

// The default parameters of the tutorial's table 1, with positive weights.
void CmaEs::set_weights() {
  const auto n = static_cast<double>(mean_.size());
  if (population_ == 0) population_ = 4 + static_cast<std::size_t>(3 * fixed::log(n));
  population_ = std::max<std::size_t>(population_, 4);
  const std::size_t parents = population_ / 2;
  weights_.resize(parents);
  for (std::size_t i = 0; i < parents; i++)
    weights_[i] = fixed::log((static_cast<double>(population_) + 1) / 2) - fixed::log(static_cast<double>(i) + 1);
  const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  double squares = 0;
  for (double& weight : weights_) {
    weight /= sum;
    squares += weight * weight;
  }
  mu_eff_ = 1 / squares;
  c_sigma_ = (mu_eff_ + 2) / (n + mu_eff_ + 5);
  d_sigma_ = 1 + 2 * std::max(0.0, std::sqrt((mu_eff_ - 1) / (n + 1)) - 1) + c_sigma_;
  c_c_ = (4 + mu_eff_ / n) / (n + 4 + 2 * mu_eff_ / n);
  c_1_ = 2 / (squared(n + 1.3) + mu_eff_);
  c_mu_ = std::min(1 - c_1_, 2 * (mu_eff_ - 2 + 1 / mu_eff_) / (squared(n + 2) + mu_eff_));
  chi_n_ = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
}

void CmaEs::decompose() {
  const std::size_t n = mean_.size();
  Vector values;
  symmetric_eigen(covariance_, n, values, axes_);
  lengths_.resize(n);
  for (std::size_t i = 0; i < n; i++) lengths_[i] = std::sqrt(std::max(values[i], 0.0));
}

std::vector<CmaEs::Vector> CmaEs::ask() const {
  const std::size_t n = mean_.size();
  // each generation has a generator of its own, so that the state needs none
  std::uint64_t mixed = seed_ ^ (generation_ + 1) * 0x9e3779b97f4a7c15u;
  Random random(splitmix64(mixed), "cma-es");
  std::vector<Vector> individuals(population_);
  Vector scaled(n);
  for (Vector& individual : individuals) {
    for (std::size_t i = 0; i < n; i++) scaled[i] = lengths_[i] * random.normal();
    individual = product(axes_, scaled, false);
    for (std::size_t i = 0; i < n; i++) individual[i] = mean_[i] + sigma_ * individual[i];
  }
  return individuals;
}

// The evolution paths; `step` is the movement of the mean in units of sigma.
void CmaEs::update_paths(const Vector& step) {
  const std::size_t n = mean_.size();
  Vector whitened = product(axes_, step, true);
  for (std::size_t i = 0; i < n; i++) whitened[i] = lengths_[i] > 0 ? whitened[i] / lengths_[i] : 0.0;
  whitened = product(axes_, whitened, false);
  const double share = std::sqrt(c_sigma_ * (2 - c_sigma_) * mu_eff_);
  for (std::size_t i = 0; i < n; i++) path_sigma_[i] = (1 - c_sigma_) * path_sigma_[i] + share * whitened[i];
  const double length = norm(path_sigma_);
  const double decay = fixed::pow(1 - c_sigma_, 2 * static_cast<double>(generation_ + 1));
  const bool advances = length / std::sqrt(1 - decay) < (1.4 + 2 / (static_cast<double>(n) + 1)) * chi_n_;
  const double c_share = advances ? std::sqrt(c_c_ * (2 - c_c_) * mu_eff_) : 0.0;
  for (std::size_t i = 0; i < n; i++) path_c_[i] = (1 - c_c_) * path_c_[i] + c_share * step[i];
  // while the path of sigma is too long, its contribution to the rank-one update is missing
  const double missing = advances ? 0.0 : c_1_ * c_c_ * (2 - c_c_);
  for (double& element : covariance_) element *= 1 - c_1_ - c_mu_ + missing;
  sigma_ *= fixed::exp(std::min(1.0, c_sigma_ / d_sigma_ * (length / chi_n_ - 1)));
}

void CmaEs::update_covariance(std::span<const Vector> individuals, std::span<const std::size_t> order,
                              const Vector& old_mean) {
  const std::size_t n = mean_.size();
  const double old_sigma = sigma_;
  Vector step(n);
  for (std::size_t i = 0; i < n; i++) step[i] = (mean_[i] - old_mean[i]) / old_sigma;
  update_paths(step);
  for (std::size_t i = 0; i < n; i++) {
    for (std::size_t j = 0; j <= i; j++) {
      double rank_mu = 0;
      for (std::size_t k = 0; k < weights_.size(); k++) {
        const Vector& x = individuals[order[k]];
        rank_mu += weights_[k] * (x[i] - old_mean[i]) / old_sigma * ((x[j] - old_mean[j]) / old_sigma);
      }
      covariance_[i * n + j] += c_1_ * path_c_[i] * path_c_[j] + c_mu_ * rank_mu;
      covariance_[j * n + i] = covariance_[i * n + j];
    }
  }
}

void CmaEs::tell(std::span<const Vector> individuals, std::span<const double> values) {
  std::vector<std::size_t> order(individuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (std::isnan(values[a]) || std::isnan(values[b])) return !std::isnan(values[a]) && std::isnan(values[b]);
    return values[a] < values[b];
  });
  const Vector old_mean = mean_;
  for (std::size_t i = 0; i < mean_.size(); i++) {
    mean_[i] = 0;
    for (std::size_t k = 0; k < weights_.size(); k++) mean_[i] += weights_[k] * individuals[order[k]][i];
  }
  update_covariance(individuals, order, old_mean);
  generation_++;
  decompose();
}

bool CmaEs::converged() const {
  const auto [shortest, longest] = std::ranges::minmax(lengths_);
  return !(sigma_ * longest > 1e-12) || !(shortest * 1e7 > longest);
}

std::string CmaEs::save() const {
  const Json json = {{"population", population_},
                     {"mean", mean_},
                     {"sigma", sigma_},
                     {"generation", generation_},
                     {"seed", seed_},
                     {"covariance", covariance_},
                     {"path_c", path_c_},
                     {"path_sigma", path_sigma_}};
  return json.dump();
}

Result<CmaEs> CmaEs::restore(std::string_view text) try {
  const Json json = Json::parse(text);
  CmaEs es;
  es.population_ = json.at("population");
  es.mean_ = json.at("mean").get<Vector>();
  es.sigma_ = json.at("sigma");
  es.generation_ = json.at("generation");
  es.seed_ = json.at("seed");
  es.covariance_ = json.at("covariance").get<Vector>();
  es.path_c_ = json.at("path_c").get<Vector>();
  es.path_sigma_ = json.at("path_sigma").get<Vector>();
  const std::size_t n = es.mean_.size();
  if (es.population_ > kMaxPopulation || n == 0 || es.covariance_.size() != n * n || es.path_c_.size() != n ||
      es.path_sigma_.size() != n)
    return Error{"the state of the search is damaged"};
  es.set_weights();
  es.decompose();
  return es;
} catch (const Json::exception&) {
  return Error{"the state of the search is damaged"};
}

}  // namespace limber::experiments
