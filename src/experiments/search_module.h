// LimberSearchModule: the functions of limber-pagmo.so, which the program loads if a search uses an algorithm of pagmo,
// so the program itself doesn't depend on it. [one thread]
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct LimberModuleSearch;  // of the module

struct LimberSearchModule {
  int version;  ///< limber::experiments::kSearchModuleVersion
  /// Starts a search for the smallest costs, with positions 0 .. 1 along each axis. `algorithm`: gaco, pso (one
  /// objective), maco, nspso (several).
  LimberModuleSearch* (*create)(const char* algorithm, std::size_t axes, std::size_t objectives, std::size_t population,
                                std::uint32_t seed);
  /// Returns population × axes positions, one individual after the other, valid until tell(). Null: the algorithm
  /// failed, as error() says.
  const double* (*ask)(LimberModuleSearch* search);
  /// Passes the population × objectives costs of these individuals, finite numbers.
  void (*tell)(LimberModuleSearch* search, const double* costs);
  const char* (*error)(const LimberModuleSearch* search);
  void (*destroy)(LimberModuleSearch* search);
};

}  // extern "C"

namespace limber::experiments {

inline constexpr int kSearchModuleVersion = 1;
/// The function of the module that returns its functions: `const LimberSearchModule* limber_search_module()`.
inline constexpr const char* kSearchModuleFunction = "limber_search_module";

}  // namespace limber::experiments
